//! [`TerrainPoint`]: where a ray meets terrain, and the light there, on the processor: the functions of `terrain.wgsl`.

use crate::lighting::DirectLight;
use crate::terrain::{HeightField, SUN_TANGENT, TerrainView};
use airlight::glam::{DVec2, DVec3};
use glam::Vec3;
use std::f32::consts::PI;

/// Distance beyond which there is no ground, m.
const FARTHEST_M: f64 = 3e5;
/// Steps of a ray from the eye, and of one towards the sun.
const STEPS: usize = 400;
const SHADOW_STEPS: usize = 100;

/// A point of the ground of a [`HeightField`] that the eye sees.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct TerrainPoint {
    /// Distance from the eye, m.
    pub distance_m: f64,
    /// Height of the ground there above the ground of the planet, m.
    pub height_m: f64,
    /// Luminance of the ground in red, green and blue, before the air in front of it, cd/m^2.
    pub rgb: Vec3,
}

impl TerrainPoint {
    /// The point of the ground of these heights along a unit vector from the eye, as a [`TerrainPass`](crate::TerrainPass) draws it; `None`
    /// where it draws none.
    pub fn along(field: &HeightField, view: &TerrainView, direction: DVec3) -> Option<Self> {
        let march = March {
            field,
            eye: view.eye_m,
            planet_radius_m: view.planet_radius_m,
            highest_m: f64::from(field.highest_m()),
            steepest: f64::from(field.steepest()),
            spacing_m: field.spacing_m().into_iter().fold(f64::INFINITY, f64::min),
        };
        let distance_m = march.terrain_distance(direction)?;
        let point = view.eye_m + distance_m * direction;
        Some(Self {
            distance_m,
            height_m: field.height_m([point.x, point.z]),
            rgb: reflected(&march, view, point),
        })
    }
}

/// What rays over terrain need.
struct March<'a> {
    field: &'a HeightField,
    eye: DVec3,
    planet_radius_m: f64,
    highest_m: f64,
    steepest: f64,
    spacing_m: f64,
}

impl March<'_> {
    /// Height above the ground of the planet, which curves away below the horizontal plane of the eye, at a distance along a direction
    /// from a point.
    fn height_along(&self, from: DVec3, direction: DVec3, distance_m: f64) -> f64 {
        let point = from + distance_m * direction;
        let from_eye = DVec2::new(point.x - self.eye.x, point.z - self.eye.z);
        point.y + from_eye.length_squared() / (2.0 * self.planet_radius_m)
    }

    /// Height above the terrain.
    fn clearance(&self, from: DVec3, direction: DVec3, distance_m: f64) -> f64 {
        let point = from + distance_m * direction;
        self.height_along(from, direction, distance_m) - self.field.height_m([point.x, point.z])
    }

    /// Part of a clearance that a ray can go without meeting ground of the steepest slope.
    fn step_per_clearance(&self, direction: DVec3) -> f64 {
        1.0 / (self.steepest * direction.x.hypot(direction.z) - direction.y).max(0.05)
    }

    /// Distance of the ground along a direction from the eye, m.
    fn terrain_distance(&self, direction: DVec3) -> Option<f64> {
        let per_clearance = self.step_per_clearance(direction);
        let across_squared = direction.x * direction.x + direction.z * direction.z;
        let to_highest_m = (self.eye.y - self.highest_m).max(0.0) / (-direction.y).max(1e-4);
        // Above the terrain, the ground curves away from a ray by less than a ray that falls approaches it.
        let mut here_m = (0.5 * to_highest_m).min(FARTHEST_M);
        let mut before_m = 0.0;
        for _ in 0..STEPS {
            let above_m = self.clearance(self.eye, direction, here_m);
            if above_m < 0.0 {
                return Some(self.first_crossing(direction, before_m, here_m));
            }
            let falls = direction.y + here_m * across_squared / self.planet_radius_m < 0.0;
            let is_past = !falls && self.height_along(self.eye, direction, here_m) > self.highest_m;
            if is_past || here_m > FARTHEST_M {
                return None;
            }
            before_m = here_m;
            here_m += (above_m * per_clearance).max(0.05 * self.spacing_m + 1e-3 * here_m);
        }
        // A ray that keeps close to the ground.
        Some(here_m)
    }

    /// Where a ray enters the ground between two distances.
    fn first_crossing(&self, direction: DVec3, above_m: f64, below_m: f64) -> f64 {
        let (mut from_m, mut to_m) = (above_m, below_m);
        for _ in 0..40 {
            let middle_m = 0.5 * (from_m + to_m);
            match self.clearance(self.eye, direction, middle_m) < 0.0 {
                true => to_m = middle_m,
                false => from_m = middle_m,
            }
        }
        0.5 * (from_m + to_m)
    }

    /// Part of the disc of a source that a point of the ground sees.
    fn disc_visibility(&self, point: DVec3, towards: DVec3) -> f64 {
        let per_clearance = self.step_per_clearance(towards);
        let mut visible = 1.0f64;
        let mut here_m = 0.5 * self.spacing_m;
        for _ in 0..SHADOW_STEPS {
            let above_m = self.clearance(point, towards, here_m);
            visible = visible.min(0.5 + 0.5 * above_m / (here_m * SUN_TANGENT));
            if visible <= 0.0 {
                return 0.0;
            }
            if self.height_along(point, towards, here_m) > self.highest_m && towards.y > 0.0 {
                break;
            }
            here_m += (above_m * per_clearance).max(0.1 * self.spacing_m + 0.02 * here_m);
        }
        visible
    }

    /// Illuminance of a surface at a point by the disc of a source, lx.
    fn direct_illuminance_lx(&self, point: DVec3, normal: Vec3, light: &DirectLight) -> Vec3 {
        let cosine = normal.dot(light.direction);
        if cosine <= 0.0 || light.illuminance_lx.y <= 0.0 {
            return Vec3::ZERO;
        }
        let visible = self.disc_visibility(point, light.direction.as_dvec3()) as f32;
        light.illuminance_lx * (cosine * visible)
    }
}

/// Luminance of the ground at a point.
fn reflected(march: &March<'_>, view: &TerrainView, point: DVec3) -> Vec3 {
    let [east, south] = march.field.slope_at([point.x, point.z]);
    let normal = Vec3::new(-east, 1.0, -south).normalize();
    let steepness = ((east.hypot(south) - 0.5) / 0.5).clamp(0.0, 1.0);
    let steep = steepness * steepness * (3.0 - 2.0 * steepness);
    let [level, rock] = [view.level_albedo, view.steep_albedo].map(Vec3::from_array);
    let albedo = level + (rock - level) * steep;
    let light = &view.lighting;
    let discs = [Some(light.first()), light.second];
    let direct = discs.iter().flatten();
    let direct: Vec3 = direct
        .map(|disc| march.direct_illuminance_lx(point, normal, disc))
        .sum();
    albedo * (light.sky_illuminance_lx(normal) + direct) / PI
}
