//! Things in the light of one solver.

use airlight::models::klassen1987::WAVELENGTHS;
use airlight::scene::{IrradianceMap, SceneLighting};
use airlight::spectrum::{RgbSpace, SpectralCurve, Spectrum, WavelengthGrid};
use airlight_render::objects::{Hit, Objects};
use glam::DVec3;
use std::f32::consts::PI;

/// What a line of sight meets.
pub struct ViewRay<'a> {
    /// Which thing, and where.
    pub hit: Hit<'a>,
    /// Unit vector away from the eye.
    pub direction: DVec3,
    /// Width of what the line stands for, at a distance of 1.
    pub width: f64,
}

/// Lines of sight end side by side where their lengths differ by less than this part.
const BESIDE: f64 = 0.05;

impl ViewRay<'_> {
    /// Whether both end on the same thing, about equally far away.
    fn ends_beside(&self, other: &Self) -> bool {
        let (a, b) = (self.hit.distance_m, other.hit.distance_m);
        self.hit.index == other.hit.index && (a - b).abs() < BESIDE * a.min(b)
    }
}

/// Light of things in the channels of a picture.
pub trait Shader: Sync {
    /// The sum of the light along the lines of sight of a pixel, which all meet things, with what the air before them does.
    fn paint(&self, objects: &Objects, sights: &[ViewRay<'_>], values: &mut [f32]);
}

/// Things in the light of one solver, in N lanes.
pub struct LitThings<const N: usize> {
    /// Sun, and what lies between eye and things.
    pub air: Box<dyn SceneLighting<N>>,
    /// Light from around at heights (m), rising: one or more.
    pub around: Vec<(f64, IrradianceMap<N>)>,
    /// Reflectance of each thing, and of its checker.
    pub reflectances: Vec<[Spectrum<N>; 2]>,
    /// Whether things shade each other.
    pub shadows: bool,
}

impl<const N: usize> LitThings<N> {
    /// The sum of radiances along lines of sight that meet things. The air is reckoned once for those that end side by side.
    fn radiance(&self, objects: &Objects, sights: &[ViewRay<'_>]) -> Spectrum<N> {
        sights
            .chunk_by(|a, b| a.ends_beside(b))
            .fold(Spectrum::ZERO, |sum, beside| {
                let count = beside.len() as f32;
                let mean = |of: fn(&Hit<'_>) -> f64| {
                    beside.iter().map(|sight| of(&sight.hit)).sum::<f64>() / f64::from(count)
                };
                let sunlight = self.air.sunlight(mean(|hit| hit.point.y));
                let light = beside.iter().fold(Spectrum::ZERO, |light, sight| {
                    light + self.reflected(objects, sight, sunlight)
                });
                let direction = beside[beside.len() / 2].direction;
                let air = self.air.before(direction, mean(|hit| hit.distance_m));
                sum + air.transmittance * light + air.path_radiance * count
            })
    }

    /// Radiance that a surface sends to the eye, where the sun has this irradiance outside shadows.
    fn reflected(
        &self,
        objects: &Objects,
        sight: &ViewRay<'_>,
        sunlight: Spectrum<N>,
    ) -> Spectrum<N> {
        let ViewRay { hit, direction, .. } = sight;
        let sun = self.air.sun();
        let dark = hit.normal.dot(sun) <= 0.0 || self.shadows && objects.shadowed(hit, sun);
        let height_m = hit.point.y;
        let shading = hit.surface.shading(hit.normal, -*direction, sun);
        let sunlight = if dark { Spectrum::ZERO } else { sunlight };
        let mirrored = match hit.surface.gloss {
            None => Spectrum::ZERO,
            Some(_) => {
                let mirror = direction - 2.0 * direction.dot(hit.normal) * hit.normal;
                self.even(height_m, mirror) / PI
            }
        };
        let diffuse = sunlight * shading.sun + self.even(height_m, hit.normal) * shading.ambient;
        self.reflectance(sight) / PI * diffuse
            + sunlight * shading.sun_mirrored
            + mirrored * shading.mirrored
    }

    fn reflectance(&self, sight: &ViewRay<'_>) -> Spectrum<N> {
        let ViewRay { hit, direction, .. } = sight;
        let [own, other] = self.reflectances[hit.index];
        let Some(checker) = &hit.surface.checker else {
            return own;
        };
        // The footprint is long where the line grazes the surface, and has no extent across it.
        let across = sight.width * hit.distance_m;
        let slant = hit.normal.dot(*direction).abs().max(1e-6);
        let footprint = (DVec3::ONE + direction.abs() / slant)
            * across
            * (DVec3::ONE - hit.normal * hit.normal);
        // Just inside, as squares begin on the surface of a block.
        let inside = hit.point - 1e-3 * checker.size_m * hit.normal;
        let share = hit.surface.checker_share(inside, footprint);
        own * (1.0 - share) + other * share
    }

    /// Irradiance from around of a surface at a height, by its normal.
    fn even(&self, height_m: f64, normal: DVec3) -> Spectrum<N> {
        let above = self
            .around
            .iter()
            .position(|(at_m, _)| *at_m >= height_m)
            .unwrap_or(self.around.len() - 1);
        let below = above.saturating_sub(1);
        let (low, high) = (&self.around[below], &self.around[above]);
        let span_m = high.0 - low.0;
        if span_m <= 0.0 {
            return high.1.irradiance(normal);
        }
        let t = ((height_m - low.0) / span_m).clamp(0.0, 1.0) as f32;
        low.1.irradiance(normal) * (1.0 - t) + high.1.irradiance(normal) * t
    }
}

impl Shader for LitThings<3> {
    fn paint(&self, objects: &Objects, sights: &[ViewRay<'_>], values: &mut [f32]) {
        values.copy_from_slice(&self.radiance(objects, sights).0);
    }
}

/// Wavelength after wavelength, so many in a piece; lanes beyond the last repeat it.
pub struct Pieces<const N: usize>(pub Vec<LitThings<N>>);

impl<const N: usize> Shader for Pieces<N> {
    fn paint(&self, objects: &Objects, sights: &[ViewRay<'_>], values: &mut [f32]) {
        for (lit, values) in self.0.iter().zip(values.chunks_mut(N)) {
            let light = lit.radiance(objects, sights);
            values.copy_from_slice(&light.0[..values.len()]);
        }
    }
}

/// The wavelengths of the model of 1987, in red, green and blue.
pub struct Summed {
    /// The light.
    pub lit: LitThings<WAVELENGTHS>,
    /// Weights of each wavelength.
    pub weights: Vec<[f32; 3]>,
}

impl Shader for Summed {
    fn paint(&self, objects: &Objects, sights: &[ViewRay<'_>], values: &mut [f32]) {
        let light = self.lit.radiance(objects, sights);
        values.fill(0.0);
        for (radiance, weights) in light.0.iter().zip(&self.weights) {
            for (value, weight) in values.iter_mut().zip(weights) {
                *value += weight * radiance;
            }
        }
    }
}

/// Reflectances of things and their checkers, by what tells a curve in lanes.
pub fn reflectances<const N: usize>(
    objects: &Objects,
    lanes: impl Fn(&SpectralCurve) -> Spectrum<N>,
) -> Vec<[Spectrum<N>; 2]> {
    let of = |object: &airlight_render::objects::Object| {
        let own = &object.surface.reflectance;
        let other = object.surface.checker.as_ref().map(|c| &c.reflectance);
        [lanes(own), lanes(other.unwrap_or(own))]
    };
    objects.all().iter().map(of).collect()
}

/// Reflectance in red, green and blue: the colour of sunlight reflected over that of sunlight. Exact under the sun outside the
/// air, and for greys under any light; a strong red in the light of a sun 20 degrees high is off by 4 % (the test
/// `spectral_things_sum_to_their_colour`).
pub fn in_rgb(space: RgbSpace) -> impl Fn(&SpectralCurve) -> Spectrum<3> {
    let grid = WavelengthGrid::one_nanometre();
    let colour = move |curve: &SpectralCurve| {
        let light: Vec<f32> = grid
            .wavelengths_nm()
            .iter()
            .zip(grid.solar_irradiance())
            .map(|(nm, sun)| (sun * curve.at(*nm)) as f32)
            .collect();
        space.from_xyz(grid.to_xyz(&light))
    };
    let white = colour(&SpectralCurve::Constant(1.0));
    move |curve| {
        let lit = colour(curve);
        Spectrum::from_fn(|lane| (lit[lane] / white[lane]).max(0.0) as f32)
    }
}

/// Reflectance at wavelengths (nm) from the place `first` on; lanes beyond the last repeat it.
pub fn at_wavelengths<const N: usize>(
    nm: &[f64],
    first: usize,
) -> impl Fn(&SpectralCurve) -> Spectrum<N> {
    move |curve| Spectrum::from_fn(|lane| curve.at(nm[place(first + lane, nm.len())]) as f32)
}

/// The place of a lane among so many: the last for lanes beyond it.
pub fn place(lane: usize, count: usize) -> usize {
    lane.min(count - 1)
}
