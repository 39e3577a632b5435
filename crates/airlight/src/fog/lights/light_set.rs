//! [`LightSet`] and [`RgbLightSet`]: lights in layers of fog.

use super::closed_form::airlight_isotropic_lanes;
use super::forms::LightForm;
use super::geometry::{LightRayGeometry, ViewRay};
use super::light::Light;
use super::march::{LitRay, Nodes, ScatteringLayer};
use crate::atmosphere::{Constituent, RaySegment};
use crate::fog::closed_forms::Lanes;
use crate::fog::closed_forms::OPAQUE;
use crate::fog::error::{FogError, check_light};
use crate::fog::layer::{LayerLanes, RgbLayer};
use crate::fog::lighting::Ground;
use crate::fog::spectral::{BLOCK, InBlocks, in_blocks, sampled, store};
use crate::math::slices::check_length;
use crate::spectrum::{Spectrum, WavelengthGrid};
use glam::DVec3;
use std::fmt::Debug;
use std::sync::Arc;

/// Settings of the light scattered from lights.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct LightSettings {
    /// Number of quadrature nodes in each panel of a ray: 4 to 256.
    pub nodes: usize,
    /// Lights that cannot add more than this to any channel of a ray are skipped, W m^-2 sr^-1 nm^-1 (or candela per square
    /// metre). The bound assumes the ray's maximum density without extinction, and the larger of the forward and backward values
    /// of the phase function; in uniform fog it includes extinction between eye and light.
    pub threshold: f32,
    /// Exact, or one of the published approximations.
    pub form: LightForm,
}

impl Default for LightSettings {
    /// 12 nodes, no threshold, the exact form.
    fn default() -> Self {
        Self {
            nodes: 12,
            threshold: 0.0,
            form: LightForm::Exact,
        }
    }
}

impl LightSettings {
    fn validate(&self) -> Result<(), FogError> {
        if !(4..=256).contains(&self.nodes) {
            return Err(FogError::Number {
                what: "number of nodes in a panel of a ray past a light",
                got: self.nodes as f64,
                expected: "a number from 4 to 256",
            });
        }
        check_light("threshold of lights", &[self.threshold][..])
    }
}

/// Lights in fog at the wavelengths of a grid: radiance that fog scatters once into view rays, and irradiance on surfaces. Cloning
/// is cheap.
///
/// Queries write one value for each wavelength of the grid; batch queries write the values of one ray after the other.
///
/// # Panics
/// Queries panic if an output slice does not have the documented length.
#[derive(Clone, Debug)]
pub struct LightSet {
    shared: Arc<Shared>,
}

#[derive(Debug)]
struct Shared {
    lights: Vec<Light>,
    grid: WavelengthGrid,
    blocks: Vec<Box<dyn LightBlock>>,
}

/// Lights in fog in red, green and blue. Cloning is cheap; queries do not allocate.
///
/// ```
/// use airlight::fog::lights::{Light, LightSettings, PointLight, RgbLightSet, ViewRay};
/// use airlight::fog::{DensityProfile, Ground, RgbLayer};
/// use airlight::optics::PhaseFunction;
/// use glam::DVec3;
///
/// let fog = RgbLayer {
///     density: DensityProfile::exponential(30.0),
///     extinction_per_m: [0.02; 3],
///     single_scattering_albedo: [1.0; 3],
///     phase: PhaseFunction::henyey_greenstein(0.85)?,
/// };
/// // A street light of about 100 cd, 5 m above the ground and 20 m ahead.
/// let street_light = PointLight::new(DVec3::new(0.0, 5.0, -20.0), [120.0, 100.0, 60.0], 0.05)?;
/// let settings = LightSettings::default();
/// let lights = RgbLightSet::new(vec![Light::Point(street_light)], &[fog], Ground::FLAT, settings)?;
/// let glow = lights.path_radiance(&ViewRay {
///     eye: DVec3::new(0.0, 1.7, 0.0),
///     direction: DVec3::new(0.02, 0.15, -1.0).normalize(),
///     length_m: 100.0,
/// });
/// assert!(glow[0] > glow[2]);
/// # Ok::<(), Box<dyn std::error::Error>>(())
/// ```
#[derive(Clone, Debug)]
pub struct RgbLightSet {
    lanes: Arc<LightSetLanes<3>>,
}

impl LightSet {
    /// Lights in layers of fog. The ground is at height 0 below the eye.
    ///
    /// # Errors
    /// [`FogError`] for invalid layers or settings, and for lights and layers for which the form is not valid.
    pub fn new(
        lights: Vec<Light>,
        layers: &[Constituent],
        ground: Ground,
        settings: LightSettings,
        grid: &WavelengthGrid,
    ) -> Result<Self, FogError> {
        let inputs = LightInputs {
            lights: &lights,
            layers,
            ground,
            settings,
        };
        let blocks = in_blocks(grid.wavelengths_nm(), &inputs)?;
        Ok(Self {
            shared: Arc::new(Shared {
                blocks,
                lights,
                grid: grid.clone(),
            }),
        })
    }

    /// The lights.
    pub fn lights(&self) -> &[Light] {
        &self.shared.lights
    }

    /// Wavelengths of the outputs.
    pub fn grid(&self) -> &WavelengthGrid {
        &self.shared.grid
    }

    /// Distance (m) and index of the first sphere light that a ray hits.
    pub fn hit(&self, eye: DVec3, direction: DVec3) -> Option<(f64, usize)> {
        hit(self.lights(), eye, direction)
    }

    /// Radiance that fog scatters once from the lights into a view ray, W m^-2 sr^-1 nm^-1, one value for each wavelength. Add it
    /// to the path radiance of the fog without the lights. The ray ends at the first sphere light that it hits.
    pub fn path_radiance(&self, ray: &ViewRay, out: &mut [f32]) {
        check_length(out, self.shared.grid.len());
        for (block, out) in self.shared.blocks.iter().zip(out.chunks_mut(BLOCK)) {
            block.path_radiance(ray, out);
        }
    }

    /// [`LightSet::path_radiance`] for many rays.
    pub fn path_radiances(&self, rays: &[ViewRay], out: &mut [f32]) {
        let width = self.shared.grid.len();
        check_length(out, width * rays.len());
        for (ray, out) in rays.iter().zip(out.chunks_mut(width)) {
            self.path_radiance(ray, out);
        }
    }

    /// Irradiance by a light on a small surface at `point` that faces it, W m^-2 nm^-1, one value for each wavelength; see
    /// [`RgbLightSet::irradiance`].
    pub fn irradiance(&self, light: usize, point: DVec3, out: &mut [f32]) {
        check_length(out, self.shared.grid.len());
        for (block, out) in self.shared.blocks.iter().zip(out.chunks_mut(BLOCK)) {
            block.irradiance(light, point, out);
        }
    }
}

impl RgbLightSet {
    /// Lights in layers of fog. The ground is at height 0 below the eye.
    ///
    /// # Errors
    /// [`FogError`] for invalid layers or settings, and for lights and layers for which the form is not valid.
    pub fn new(
        lights: Vec<Light<[f32; 3]>>,
        layers: &[RgbLayer],
        ground: Ground,
        settings: LightSettings,
    ) -> Result<Self, FogError> {
        let lights = lights.iter().map(|light| light.map(|&rgb| Spectrum(rgb)));
        let layers: Vec<LayerLanes<3>> = layers.iter().map(LayerLanes::rgb).collect();
        let lanes = LightSetLanes::new(lights.collect(), &layers, ground, settings)?;
        Ok(Self {
            lanes: Arc::new(lanes),
        })
    }

    /// The lights.
    pub fn lights(&self) -> impl ExactSizeIterator<Item = Light<[f32; 3]>> + '_ {
        self.lanes
            .lights
            .iter()
            .map(|light| light.map(|lanes| lanes.0))
    }

    /// Distance (m) and radiance (without attenuation by the fog) of the first sphere light that a ray hits.
    pub fn hit(&self, eye: DVec3, direction: DVec3) -> Option<(f64, [f32; 3])> {
        let (distance_m, light) = hit(&self.lanes.lights, eye, direction)?;
        Some((distance_m, self.lanes.lights[light].emission().0))
    }

    /// Radiance that fog scatters once from the lights into a view ray, W m^-2 sr^-1 nm^-1 (or candela per square metre). Add it to
    /// the path radiance of the fog without the lights. The ray ends at the first sphere light that it hits.
    ///
    /// Closed form for point lights in uniform, isotropically scattering fog; otherwise quadrature in the same variable, with
    /// [`LightSettings::nodes`] in each panel. Errors: `docs/src/lights.md`.
    pub fn path_radiance(&self, ray: &ViewRay) -> [f32; 3] {
        self.lanes.path_radiance(ray).0
    }

    /// [`RgbLightSet::path_radiance`] for many rays.
    ///
    /// # Panics
    /// If the slices differ in length.
    pub fn path_radiances(&self, rays: &[ViewRay], out: &mut [[f32; 3]]) {
        check_length(out, rays.len());
        for (ray, out) in rays.iter().zip(out) {
            *out = self.path_radiance(ray);
        }
    }

    /// Irradiance by a light on a small surface at `point` that faces it, W m^-2 nm^-1: `I / r^2`, attenuated by the fog. For other
    /// orientations multiply by the cosine between the normal and the direction to the light. Exact for all kinds of light, except
    /// that distances are clamped to the light's radius, and that light of a sphere is attenuated up to its nearest point.
    pub fn irradiance(&self, light: usize, point: DVec3) -> [f32; 3] {
        self.lanes.irradiance(light, point).0
    }
}

/// Distance and index of the first sphere light that a ray hits.
fn hit<C>(lights: &[Light<C>], eye: DVec3, direction: DVec3) -> Option<(f64, usize)> {
    let hits = lights
        .iter()
        .enumerate()
        .filter_map(|(i, light)| match light {
            Light::Sphere(sphere) => Some((sphere.hit(eye, direction)?, i)),
            _ => None,
        });
    hits.min_by(|a, b| a.0.total_cmp(&b.0))
}

/// Lights in fog in N lanes.
#[derive(Clone, Debug)]
struct LightSetLanes<const N: usize> {
    lights: Vec<Light<Spectrum<N>>>,
    layers: Vec<LayerLanes<N>>,
    scattering_layers: Vec<ScatteringLayer<N>>,
    ground_radius_m: f64,
    settings: LightSettings,
    nodes: Nodes,
}

impl<const N: usize> LightSetLanes<N> {
    fn new(
        lights: Vec<Light<Spectrum<N>>>,
        layers: &[LayerLanes<N>],
        ground: Ground,
        settings: LightSettings,
    ) -> Result<Self, FogError> {
        settings.validate()?;
        ground.validate()?;
        for layer in layers {
            layer.validate()?;
        }
        for light in &lights {
            check_light("emission of a light", light.emission())?;
        }
        let layers: Vec<LayerLanes<N>> = layers.iter().flat_map(LayerLanes::terms).collect();
        settings.form.check(&lights, &layers)?;
        let scattering_layers = layers
            .iter()
            .enumerate()
            .filter_map(|(i, layer)| {
                let others = [&layers[..i], &layers[i + 1..]].concat();
                ScatteringLayer::new(layer.clone(), &others, ground.radius_m)
            })
            .collect();
        Ok(Self {
            lights,
            layers,
            scattering_layers,
            ground_radius_m: ground.radius_m,
            settings,
            nodes: Nodes::new(settings.nodes),
        })
    }

    fn path_radiance(&self, ray: &ViewRay) -> Spectrum<N> {
        let mut ray = *ray;
        if let Some((distance_m, _)) = hit(&self.lights, ray.eye, ray.direction) {
            ray.length_m = ray.length_m.min(distance_m);
        }
        let mut sum = Spectrum::ZERO;
        if ray.length_m <= 0.0 {
            return sum;
        }
        for fog in &self.scattering_layers {
            for light in &self.lights {
                sum += self.path_radiance_of(light, fog, &ray);
            }
        }
        sum
    }

    /// Radiance that one layer scatters from one light.
    fn path_radiance_of(
        &self,
        light: &Light<Spectrum<N>>,
        fog: &ScatteringLayer<N>,
        ray: &ViewRay,
    ) -> Spectrum<N> {
        if self.settings.form != LightForm::Exact {
            let ViewRay { eye, direction, .. } = *ray;
            let (position, radius_m) = (light.position(), light.radius_m());
            let geometry = LightRayGeometry::new(eye, direction, ray.length_m, position, radius_m);
            return self
                .settings
                .form
                .path_radiance(&fog.layer, &geometry, light.intensity());
        }
        let lit = LitRay::new(light, fog, ray);
        if self.settings.threshold > 0.0 && lit.bound() < self.settings.threshold {
            return Spectrum::ZERO;
        }
        match light {
            Light::Point(_) if fog.has_closed_form() => {
                let layer = &fog.layer;
                closed_form(&lit.geometry, layer.extinction_per_m, &self.nodes)
                    * layer.scattering_per_m
                    * lit.intensity
            }
            _ => lit.path_radiance(&self.nodes),
        }
    }

    fn irradiance(&self, light: usize, point: DVec3) -> Spectrum<N> {
        let light = &self.lights[light];
        let to_light = light.position() - point;
        let distance = to_light.length().max(light.radius_m());
        let towards = to_light / distance;
        let (part, path_m) = match light {
            Light::Point(_) => (1.0, distance),
            Light::Spot(spot) => (spot.falloff(-towards), distance),
            Light::Sphere(sphere) => (1.0, distance - sphere.radius_m),
        };
        let ray = RaySegment::new(point.y, towards.y, path_m, self.ground_radius_m);
        let depth = self.layers.iter().fold(Spectrum::ZERO, |sum, layer| {
            let column = layer.density.column_along_m(&ray).min(OPAQUE);
            sum.scale_acc(layer.extinction_per_m, column as f32)
        });
        light.intensity() * depth.exp_neg() * (part / (distance * distance)) as f32
    }
}

/// [`airlight_isotropic_lanes`]. Three lanes are padded to four, which is faster in vector instructions.
#[inline]
fn closed_form<const N: usize>(
    geometry: &LightRayGeometry,
    extinction_per_m: Spectrum<N>,
    nodes: &Nodes,
) -> Spectrum<N> {
    if N == 3 {
        let four = Spectrum::<4>::from_fn(|lane| extinction_per_m[lane.min(2)]);
        let light = airlight_isotropic_lanes(geometry, four, nodes);
        Spectrum::from_fn(|lane| light[lane])
    } else {
        airlight_isotropic_lanes(geometry, extinction_per_m, nodes)
    }
}

/// Inputs of a set of lights.
struct LightInputs<'a> {
    lights: &'a [Light],
    layers: &'a [Constituent],
    ground: Ground,
    settings: LightSettings,
}

impl InBlocks for LightInputs<'_> {
    type Block = dyn LightBlock;

    fn block<const N: usize>(
        &self,
        wavelengths_nm: [f64; N],
        _lanes: usize,
    ) -> Result<Box<dyn LightBlock>, FogError> {
        let lights = self
            .lights
            .iter()
            .map(|light| light.map(|curve| sampled(curve, &wavelengths_nm)));
        let layers: Vec<LayerLanes<N>> = self
            .layers
            .iter()
            .map(|layer| LayerLanes::new(layer, &wavelengths_nm))
            .collect();
        let set = LightSetLanes::new(lights.collect(), &layers, self.ground, self.settings)?;
        Ok(Box::new(set))
    }
}

/// A block of lanes of a set of lights. Slices have the length of the used lanes.
trait LightBlock: Debug + Send + Sync {
    fn path_radiance(&self, ray: &ViewRay, out: &mut [f32]);
    fn irradiance(&self, light: usize, point: DVec3, out: &mut [f32]);
}

impl<const N: usize> LightBlock for LightSetLanes<N> {
    fn path_radiance(&self, ray: &ViewRay, out: &mut [f32]) {
        store(LightSetLanes::path_radiance(self, ray), out);
    }

    fn irradiance(&self, light: usize, point: DVec3, out: &mut [f32]) {
        store(LightSetLanes::irradiance(self, light, point), out);
    }
}

#[cfg(test)]
mod tests;
