//! The scene, and a picture of it.

use crate::{
    air::Air,
    ground::{Ground, TALLEST},
    light::Light,
    march::{self, Ray, Relief},
    noise,
};
use airlight_image::Frame;
use glam::DVec3;
use std::sync::atomic::{AtomicU32, Ordering};

/// How far the eye looks for ground, metres.
pub const FARTHEST: f64 = 150e3;

/// Everything that is seen, and from where.
pub struct Scene {
    pub ground: Ground,
    pub light: Light,
    /// The air between eye and ground, where it is drawn.
    pub air: Option<Air>,
    /// Place on the map, metres east and south of its middle.
    pub eye: [f64; 2],
    /// Metres above sea level.
    pub altitude: f64,
    pub frame: Frame,
    /// Unit vector along the camera's axis.
    pub axis: DVec3,
    /// Samples of colour along each side of a pixel.
    pub samples: u32,
}

/// Measured from the eye's place on the map.
impl Relief for Scene {
    fn bare(&self, x: f64, z: f64) -> f64 {
        let [east, south] = self.eye;
        self.ground.terrain(x + east, z + south)
    }

    fn cover(&self, x: f64, z: f64, footprint: f64) -> f64 {
        let [east, south] = self.eye;
        self.ground.cover(x + east, z + south, footprint)
    }

    fn tallest(&self) -> f64 {
        TALLEST
    }

    fn highest(&self) -> f64 {
        self.ground.highest()
    }
}

impl Scene {
    /// Red, green, blue and depth of every pixel, row after row. `progress` receives the number of rows done, from any thread.
    pub fn draw(&self, progress: impl Fn(u32) + Sync) -> Vec<f32> {
        use rayon::prelude::*;
        let width = self.frame.size().width();
        let done = AtomicU32::new(0);
        let row = |y| {
            let row: Vec<f32> = (0..width).flat_map(|x| self.pixel(x, y)).collect();
            progress(done.fetch_add(1, Ordering::Relaxed) + 1);
            row
        };
        (0..self.frame.size().height())
            .into_par_iter()
            .flat_map_iter(row)
            .collect()
    }

    fn pixel(&self, x: u32, y: u32) -> [f32; 4] {
        let n = self.samples;
        let mut colour = DVec3::ZERO;
        let mut middle = None;
        for i in 0..n * n {
            let within = |k: u32| (f64::from(k) + 0.5) / f64::from(n);
            let (px, py) = (f64::from(x) + within(i % n), f64::from(y) + within(i / n));
            let chance =
                |salt: u32| noise::hash(i64::from(x * n + i % n), i64::from(y * n + i / n), salt);
            if let Some(sight) = self.look(px, py) {
                colour += self.seen(&sight, px, py, [chance(50), chance(51)]);
                if n % 2 == 1 && i == n * n / 2 {
                    middle = Some(sight);
                }
            }
        }
        let colour = (colour / f64::from(n * n)).as_vec3();
        let depth = middle
            .or_else(|| self.look(f64::from(x) + 0.5, f64::from(y) + 0.5))
            .and_then(|(ray, hit)| hit.map(|t| t * ray.direction.dot(self.axis)))
            .unwrap_or(f64::INFINITY);
        [colour.x, colour.y, colour.z, depth as f32]
    }

    /// The line of sight at a place in the picture, and how far away it meets the ground.
    fn look(&self, px: f64, py: f64) -> Option<(Ray, Option<f64>)> {
        let direction = self.frame.direction(px, py)?;
        // Half a pixel on, towards the middle of the picture.
        let size = self.frame.size();
        let inward = |p: f64, n: u32| p + if 2.0 * p > f64::from(n) { -0.5 } else { 0.5 };
        let beside = self
            .frame
            .direction(inward(px, size.width()), inward(py, size.height()))?;
        let ray = Ray {
            origin: DVec3::new(0.0, self.altitude, 0.0),
            direction,
            // Samples share a pixel, and what is too fine for one may be right for their mean.
            footprint: [
                0.0,
                direction.distance(beside) / f64::from(self.samples).sqrt(),
            ],
        };
        Some((ray, march::first_hit(self, &ray, 0.0, FARTHEST)))
    }

    /// The luminance that a line of sight meets, cd/m^2; `chance` picks a point of the sun's disc.
    fn seen(&self, (ray, hit): &(Ray, Option<f64>), px: f64, py: f64, chance: [f64; 2]) -> DVec3 {
        let Some(t) = *hit else {
            return self.light.sky(ray.direction);
        };
        let light = self.reflected(ray.at(t), ray.footprint_at(t), chance);
        match &self.air {
            Some(air) => air.through(light, px, py, t),
            None => light,
        }
    }

    /// The luminance of a point of the ground, cd/m^2.
    fn reflected(&self, point: DVec3, footprint: f64, chance: [f64; 2]) -> DVec3 {
        let [east, south] = self.eye;
        let medium = self
            .ground
            .medium(point.x + east, point.z + south, footprint);
        let sun = self.point_of_sun(chance);
        let slant = medium.normal.dot(sun);
        let sunlit = if slant > 0.0 && !self.shadowed(point, footprint, sun) {
            slant * medium.open_to_sun * self.light.sun_illuminance(march::altitude(point))
        } else {
            DVec3::ZERO
        };
        // What the mountains hide of the sky they make up for by half of what they would reflect.
        let sky = self.light.sky_illuminance(medium.normal)
            * (medium.open_to_sky + (1.0 - medium.open_to_sky) * 0.5 * medium.albedo);
        medium.albedo / std::f64::consts::PI * (sunlit + sky)
    }

    fn shadowed(&self, point: DVec3, footprint: f64, sun: DVec3) -> bool {
        let ray = Ray {
            origin: point,
            direction: sun,
            footprint: [footprint, self.light.sun_radius],
        };
        march::first_hit(self, &ray, 0.3 + 0.7 * footprint, FARTHEST).is_some()
    }

    fn point_of_sun(&self, [a, b]: [f64; 2]) -> DVec3 {
        let sun = self.light.sun;
        let across = sun.any_orthonormal_vector();
        let (sin, cos) = (std::f64::consts::TAU * a).sin_cos();
        let away = self.light.sun_radius * b.sqrt();
        (sun + away * (cos * across + sin * sun.cross(across))).normalize()
    }
}
