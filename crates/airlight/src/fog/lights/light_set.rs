//! Many lamps.

use super::fast::airlight_isotropic_lanes;
use super::geometry::LightRayGeometry;
use super::march::{Haze, Ray};
use super::medium::{ParticipatingMedium, ViewRay};
use super::nodes::Nodes;
use super::{Light, check};
use crate::fog::lanes::Lanes;
use crate::fog::layer::FogError;
use crate::spectrum::Spectrum;
use glam::DVec3;

/// How carefully the light of lamps is summed.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct LightSettings {
    /// Nodes in each panel of a line: at least 4.
    pub nodes: usize,
    /// A lamp that cannot add more than this to any lane of a line is left out, W m^-2 sr^-1 nm^-1 (or candela per square
    /// metre). The bound is that of the line's densest fog without extinction, under the larger of the phase function's
    /// values forward and backward; in uniform fog it is dimmed by what lies between eye and lamp.
    pub threshold: f32,
}

impl Default for LightSettings {
    /// 12 nodes, no threshold.
    fn default() -> Self {
        Self {
            nodes: 12,
            threshold: 0.0,
        }
    }
}

/// Lamps in fog.
#[derive(Clone, Debug, PartialEq)]
pub struct LightSet<const N: usize> {
    lights: Vec<Light<N>>,
    settings: LightSettings,
    nodes: Nodes,
}

impl<const N: usize> LightSet<N> {
    /// Lamps and how to sum them.
    ///
    /// # Errors
    /// [`FogError`] for fewer than 4 nodes or more than 256, or a threshold below 0 or not finite.
    pub fn new(lights: Vec<Light<N>>, settings: LightSettings) -> Result<Self, FogError> {
        if !(4..=256).contains(&settings.nodes) {
            return Err(FogError::Number {
                what: "the number of nodes in a panel of a line past a lamp",
                got: settings.nodes as f64,
                right: "from 4 to 256",
            });
        }
        check::light("the threshold of lamps", Spectrum([settings.threshold]))?;
        Ok(Self {
            lights,
            settings,
            nodes: Nodes::new(settings.nodes),
        })
    }

    /// The lamps themselves, for their direct light ([`Light::illumination`]).
    pub fn lights(&self) -> &[Light<N>] {
        &self.lights
    }

    /// The first glowing ball that a line meets: how far away, and its radiance (not yet dimmed by the fog before it).
    pub fn hit(&self, eye: DVec3, direction: DVec3) -> Option<(f64, Spectrum<N>)> {
        let balls = self.lights.iter().filter_map(|light| match light {
            Light::Sphere(ball) => Some((ball.hit(eye, direction)?, ball.radiance)),
            _ => None,
        });
        balls.min_by(|a, b| a.0.total_cmp(&b.0))
    }

    /// The light of all lamps that fog scatters once into a line of sight, W m^-2 sr^-1 nm^-1: to be added to the path
    /// radiance that the fog has without them. The line ends at the first glowing ball that it meets.
    ///
    /// Where the fog is uniform and scatters evenly, [`super::airlight_isotropic_lanes`]; elsewhere quadrature in the same
    /// variable, with [`LightSettings::nodes`] in each panel. Errors: the book's chapter on lamps.
    pub fn path_radiance(
        &self,
        medium: &ParticipatingMedium<N>,
        view_ray: &ViewRay,
    ) -> Spectrum<N> {
        let Some(haze) = Haze::new(medium) else {
            return Spectrum::ZERO;
        };
        let mut view_ray = *view_ray;
        if let Some((distance, _)) = self.hit(view_ray.eye, view_ray.direction) {
            view_ray.length_m = view_ray.length_m.min(distance);
        }
        if view_ray.length_m <= 0.0 {
            return Spectrum::ZERO;
        }
        let mut sum = Spectrum::ZERO;
        for light in &self.lights {
            sum += self.of_one(light, &haze, &view_ray);
        }
        sum
    }

    fn of_one(&self, light: &Light<N>, haze: &Haze<N>, view_ray: &ViewRay) -> Spectrum<N> {
        let ray = Ray::new(light, haze, view_ray);
        if self.settings.threshold > 0.0 && bound(&ray, haze) < self.settings.threshold {
            return Spectrum::ZERO;
        }
        let medium = haze.medium;
        match light {
            Light::Point(_)
                if haze.isotropic && medium.profile.is_uniform() && medium.others.is_empty() =>
            {
                let extinction = medium.medium.extinction_per_m;
                evenly(&ray.geometry, extinction, &self.nodes)
                    * haze.scattering_per_m
                    * ray.intensity
            }
            _ => ray.path_radiance(&self.nodes),
        }
    }
}

/// [`airlight_isotropic_lanes`], with a fourth lane for company where there are three: the machine likes that better.
#[inline]
fn evenly<const N: usize>(
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

/// What a lamp adds to no lane more than.
fn bound<const N: usize>(ray: &Ray<N>, haze: &Haze<N>) -> f32 {
    let medium = haze.medium;
    let [forward, backward] = [1.0, -1.0].map(|cos| {
        medium
            .medium
            .phase_lanes(cos, medium.wavelengths_nm)
            .max_element()
    });
    let mut light = haze.scattering_per_m * ray.intensity;
    let density = match medium.profile.is_uniform() {
        true => {
            let between = (ray.geometry.distance_m(0.0) - 2.0 * ray.geometry.nearest_m).max(0.0);
            let depth = medium.medium.extinction_per_m * between as f32;
            light *= depth.exp_neg();
            1.0
        }
        false => medium.profile.max_above(ray.line.lowest_height_m()),
    };
    // 4: twice for a ball's closeness, twice for its line moved out to its radius.
    let glow = 4.0 * density * ray.geometry.angle() / ray.geometry.nearest_m;
    light.max_element() * forward.max(backward) * glow.min(f64::from(f32::MAX)) as f32
}

#[cfg(test)]
mod tests;
