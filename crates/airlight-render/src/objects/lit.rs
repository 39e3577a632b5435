//! Objects lit by a view.

use super::surface::Shading;
use super::{Candidate, Hit, Object, Objects, Ray};
use crate::channels::{PixelChannels, RgbWeights};
use airlight::scene::{Channels, RadianceView, ResolvedScene, SceneError};
use airlight::spectrum::{RgbSpace, SpectralCurve, WavelengthGrid};
use glam::DVec3;
use std::f32::consts::PI;
use std::sync::Arc;

/// A ray from the eye that hits an object.
#[derive(Clone, Copy, Debug)]
pub struct ViewRay<'a> {
    /// The object, and the point that is hit.
    pub hit: Hit<'a>,
    /// Unit vector away from the eye.
    pub direction: DVec3,
    /// Width of the part of the picture that the ray represents, at a distance of 1.
    pub width: f64,
}

/// Largest relative difference of the lengths of rays that share the air in front of them.
const BESIDE: f64 = 0.05;

impl ViewRay<'_> {
    /// Whether both end on the same object at nearly the same distance.
    fn ends_beside(&self, other: &Self) -> bool {
        let (a, b) = (self.hit.distance_m, other.hit.distance_m);
        self.hit.index == other.hit.index && (a - b).abs() < BESIDE * a.min(b)
    }
}

/// Objects lit by a view. Their origin is the point of the ground below its eye.
#[derive(Clone, Debug)]
pub struct LitObjects {
    objects: Arc<Objects>,
    eye: DVec3,
    view: Arc<dyn RadianceView>,
    /// Views from increasing heights (m) above the ground, at least one, whose irradiance lights objects there.
    around: Vec<(f64, Arc<dyn RadianceView>)>,
    /// Reflectances of each object and of its checker, in the channels of the views.
    reflectances: Vec<[Vec<f32>; 2]>,
    /// Weights of the wavelengths if the views are spectral and the picture is RGB.
    weights: Option<RgbWeights>,
    shadows: bool,
}

impl LitObjects {
    /// Objects lit by `view`, whose eye is `eye_height_m` above the ground; `around` are views from increasing heights (m) above
    /// the ground, at least one, in the same channels.
    pub fn new(
        objects: Arc<Objects>,
        (eye_height_m, view): (f64, Arc<dyn RadianceView>),
        around: Vec<(f64, Arc<dyn RadianceView>)>,
        shadows: bool,
    ) -> Self {
        let reflectances = match (view.channels(), view.grid()) {
            (Channels::Rgb(space), _) => reflectances(&objects, reflectance_in_rgb(space)),
            (Channels::Spectral, grid) => {
                let nm = grid.map_or(&[][..], WavelengthGrid::wavelengths_nm);
                reflectances(&objects, |curve| {
                    nm.iter().map(|&nm| curve.at(nm) as f32).collect()
                })
            }
        };
        Self {
            objects,
            eye: DVec3::Y * eye_height_m,
            view,
            around,
            reflectances,
            weights: None,
            shadows,
        }
    }

    /// Objects in a scene; `view_at` is the view from an altitude (m above sea level). In fog, the ambient light of objects
    /// depends on height; otherwise it is that at half the height of the highest object.
    ///
    /// # Errors
    /// Errors of `view_at`.
    pub fn in_scene(
        objects: Arc<Objects>,
        scene: &ResolvedScene,
        view_at: impl Fn(f64) -> Result<Arc<dyn RadianceView>, SceneError>,
        shadows: bool,
    ) -> Result<Self, SceneError> {
        let ground_m = scene.atmosphere.planet.ground_altitude_m;
        let top_m = objects.top_m().max(1.0);
        let heights_m = match scene.fog {
            Some(_) => vec![0.0, top_m],
            None => vec![0.5 * top_m],
        };
        let around = heights_m
            .into_iter()
            .map(|height_m| Ok((height_m, view_at(ground_m + height_m)?)))
            .collect::<Result<_, SceneError>>()?;
        let eye_height_m = scene.observer_altitude_m - ground_m;
        let view = view_at(scene.observer_altitude_m)?;
        Ok(Self::new(objects, (eye_height_m, view), around, shadows))
    }

    /// The same objects in the channels of a picture: light of spectral views is converted for an RGB picture.
    pub fn in_picture(mut self, channels: &PixelChannels) -> Self {
        self.weights = match (channels.of_views(), self.view.grid()) {
            (Channels::Rgb(space), Some(grid)) => Some(grid.rgb_weights(space)),
            _ => None,
        };
        self
    }

    /// The first object along a ray from the eye that represents a part of the picture of this width at a distance of 1.
    pub fn hit(&self, direction: DVec3, width: f64) -> Option<ViewRay<'_>> {
        let ray = Ray {
            origin: self.eye,
            direction,
        };
        self.objects.hit(&ray).map(|hit| ViewRay {
            hit,
            direction,
            width,
        })
    }

    /// [`Self::hit`] of all rays of a pixel that hit an object, in their order. `width` is only called if one may.
    pub fn hits<'s>(
        &'s self,
        directions: &[DVec3],
        width: impl FnOnce() -> f64,
        scratch: &mut Scratch,
        out: &mut Vec<ViewRay<'s>>,
    ) {
        out.clear();
        let candidates = &mut scratch.candidates;
        self.objects.candidates(self.eye, directions, candidates);
        if candidates.is_empty() {
            return;
        }
        let width = width();
        out.extend(directions.iter().filter_map(|&direction| {
            let ray = Ray {
                origin: self.eye,
                direction,
            };
            let hit = self.objects.hit_among(candidates, &ray)?;
            Some(ViewRay {
                hit,
                direction,
                width,
            })
        }));
    }

    /// Buffers for the values of a pixel.
    pub fn scratch(&self) -> Scratch {
        let values = || vec![0.0; self.view.channel_count()];
        Scratch {
            sum: values(),
            light: values(),
            sunlight: values(),
            moonlight: values(),
            ambient: values(),
            mirrored: values(),
            other: values(),
            transmittance: values(),
            path_radiance: values(),
            candidates: Vec::new(),
            sun_shadows: Vec::new(),
            moon_shadows: Vec::new(),
        }
    }

    /// Sum of the radiances along the rays of a pixel that hit objects, including the air in front of them.
    pub fn radiance<'s>(&self, rays: &[ViewRay<'_>], scratch: &'s mut Scratch) -> &'s [f32] {
        scratch.sum.fill(0.0);
        // The air is computed once for rays of nearly equal length.
        for beside in rays.chunk_by(|a, b| a.ends_beside(b)) {
            let count = beside.len() as f64;
            let mean = |of: fn(&Hit<'_>) -> f64| {
                beside.iter().map(|ray| of(&ray.hit)).sum::<f64>() / count
            };
            let height_m = mean(|hit| hit.point.y);
            self.view.sunlight(height_m, &mut scratch.sunlight);
            if let Some(moon) = self.view.moon() {
                moon.sunlight(height_m, &mut scratch.moonlight);
            }
            scratch.light.fill(0.0);
            self.find_shadows(beside, scratch);
            let mut before = None;
            for ray in beside {
                self.add_reflected(ray, before, scratch);
                before = Some(ray);
            }
            self.view.path(
                beside[beside.len() / 2].direction,
                mean(|hit| hit.distance_m),
                &mut scratch.transmittance,
                &mut scratch.path_radiance,
            );
            for (lane, sum) in scratch.sum.iter_mut().enumerate() {
                *sum += scratch.transmittance[lane] * scratch.light[lane]
                    + scratch.path_radiance[lane] * count as f32;
            }
        }
        if let Some(weights) = &self.weights {
            scratch.light.fill(0.0);
            for (radiance, weights) in scratch.sum.iter().zip(weights) {
                for (color, weight) in scratch.light.iter_mut().zip(weights) {
                    *color += weight * radiance;
                }
            }
            return &scratch.light[..3];
        }
        &scratch.sum
    }

    /// Finds the objects that may hide the sun and the moon from the ends of rays.
    fn find_shadows(&self, rays: &[ViewRay<'_>], scratch: &mut Scratch) {
        if !self.shadows {
            return;
        }
        let find = |source: DVec3, out: &mut Vec<Candidate>| {
            let lit = rays.iter().map(|ray| &ray.hit);
            let lit = lit.filter(|hit| hit.normal.dot(source) > 0.0);
            self.objects.shadow_candidates(lit, source, out);
        };
        find(self.view.sun(), &mut scratch.sun_shadows);
        if let Some(moon) = self.view.moon() {
            find(moon.sun(), &mut scratch.moon_shadows);
        }
    }

    /// Adds the radiance that a surface reflects to the eye. `before` is the ray of the previous call, if its ambient light may be
    /// used again.
    fn add_reflected(
        &self,
        ray: &ViewRay<'_>,
        before: Option<&ViewRay<'_>>,
        scratch: &mut Scratch,
    ) {
        let ViewRay { hit, direction, .. } = ray;
        let height_m = hit.point.y;
        let Scratch {
            light,
            sunlight,
            moonlight,
            ambient,
            mirrored,
            other,
            sun_shadows,
            moon_shadows,
            ..
        } = scratch;
        let same = |other: &ViewRay<'_>| {
            other.hit.normal == hit.normal
                && (self.around.len() == 1 || other.hit.point.y == height_m)
        };
        if !before.is_some_and(same) {
            self.ambient(height_m, hit.normal, ambient, other);
        }
        if hit.surface.gloss.is_some() {
            let mirror = direction - 2.0 * direction.dot(hit.normal) * hit.normal;
            self.ambient(height_m, mirror, mirrored, other);
        }
        let shading = self.shading(ray, self.view.sun(), sun_shadows);
        let moon = self.view.moon();
        let moonlit = moon.map_or((0.0, 0.0), |moon| {
            let shading = self.shading(ray, moon.sun(), moon_shadows);
            (shading.sun, shading.sun_mirrored)
        });
        let share = checker_share(ray);
        let [own, checker] = &self.reflectances[hit.index];
        for lane in 0..light.len() {
            let reflectance = own[lane] * (1.0 - share) + checker[lane] * share;
            let diffuse = sunlight[lane] * shading.sun
                + moonlight[lane] * moonlit.0
                + ambient[lane] * shading.ambient;
            light[lane] += reflectance / PI * diffuse
                + sunlight[lane] * shading.sun_mirrored
                + moonlight[lane] * moonlit.1
                + mirrored[lane] / PI * shading.mirrored;
        }
    }

    /// Reflection at the end of a ray under a distant source, whose light is 0 in the shadow of objects.
    fn shading(&self, ray: &ViewRay<'_>, source: DVec3, objects: &[Candidate]) -> Shading {
        let hit = &ray.hit;
        let shading = hit.surface.shading(hit.normal, -ray.direction, source);
        let dark = hit.normal.dot(source) <= 0.0
            || self.shadows && self.objects.shadowed_by(objects, hit, source);
        match dark {
            true => Shading {
                sun: 0.0,
                sun_mirrored: 0.0,
                ..shading
            },
            false => shading,
        }
    }

    /// Irradiance of a surface at a height (m) by all light except the sun's disc.
    fn ambient(&self, height_m: f64, normal: DVec3, out: &mut [f32], other: &mut [f32]) {
        let above = self
            .around
            .iter()
            .position(|(at_m, _)| *at_m >= height_m)
            .unwrap_or(self.around.len() - 1);
        let below = above.saturating_sub(1);
        let (low, high) = (&self.around[below], &self.around[above]);
        high.1.irradiance(&[normal], out);
        let span_m = high.0 - low.0;
        if span_m > 0.0 {
            let t = ((height_m - low.0) / span_m).clamp(0.0, 1.0) as f32;
            low.1.irradiance(&[normal], other);
            for (high, low) in out.iter_mut().zip(other) {
                *high = *low * (1.0 - t) + *high * t;
            }
        }
    }
}

/// Buffers for a pixel: values of each channel of the views, and objects that its rays may hit.
#[derive(Clone, Debug)]
pub struct Scratch {
    sum: Vec<f32>,
    light: Vec<f32>,
    sunlight: Vec<f32>,
    moonlight: Vec<f32>,
    ambient: Vec<f32>,
    mirrored: Vec<f32>,
    other: Vec<f32>,
    transmittance: Vec<f32>,
    path_radiance: Vec<f32>,
    candidates: Vec<Candidate>,
    sun_shadows: Vec<Candidate>,
    moon_shadows: Vec<Candidate>,
}

/// Share of the checker's second reflectance in the footprint of a ray, 0 to 1.
fn checker_share(ray: &ViewRay<'_>) -> f32 {
    let ViewRay { hit, direction, .. } = ray;
    let Some(checker) = &hit.surface.checker else {
        return 0.0;
    };
    // The footprint is long at grazing incidence, and has no extent along the normal.
    let across = ray.width * hit.distance_m;
    let slant = hit.normal.dot(*direction).abs().max(1e-6);
    let footprint =
        (DVec3::ONE + direction.abs() / slant) * across * (DVec3::ONE - hit.normal * hit.normal);
    // Just inside the object, as squares begin at the surface of a block.
    let inside = hit.point - 1e-3 * checker.size_m * hit.normal;
    hit.surface.checker_share(inside, footprint)
}

/// Reflectances of objects and of their checkers, with curves converted by `to_channels`.
fn reflectances(
    objects: &Objects,
    channels: impl Fn(&SpectralCurve) -> Vec<f32>,
) -> Vec<[Vec<f32>; 2]> {
    let of = |object: &Object| {
        let own = &object.surface.reflectance;
        let other = object.surface.checker.as_ref().map(|c| &c.reflectance);
        [channels(own), channels(other.unwrap_or(own))]
    };
    objects.all().iter().map(of).collect()
}

/// Reflectance in red, green and blue: the colour of reflected sunlight relative to that of sunlight. Exact for sunlight outside
/// the air, and for greys in any light; the error of a saturated red with the sun at 20 degrees is 4 %.
fn reflectance_in_rgb(space: RgbSpace) -> impl Fn(&SpectralCurve) -> Vec<f32> {
    let grid = WavelengthGrid::one_nanometre();
    let color = move |curve: &SpectralCurve| {
        let light: Vec<f32> = grid
            .wavelengths_nm()
            .iter()
            .zip(grid.solar_irradiance())
            .map(|(nm, sun)| (sun * curve.at(*nm)) as f32)
            .collect();
        space.from_xyz(grid.to_xyz(&light))
    };
    let white = color(&SpectralCurve::Constant(1.0));
    move |curve| {
        let lit = color(curve);
        (0..3)
            .map(|lane| (lit[lane] / white[lane]).max(0.0) as f32)
            .collect()
    }
}
