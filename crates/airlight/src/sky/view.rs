//! Looking out from one place under one sun.

use super::block::BlockLight;
use super::ray::Ray;
use super::solver::Sky;
use super::table::{SkyTable, TableChannels};
use crate::light::SunDisc;
use crate::path::PathOptics;
use crate::spectrum::Spectrum;
use glam::DVec3;

/// A prepared sky seen from one altitude under one sun.
#[derive(Clone)]
pub struct View<'a> {
    sky: &'a Sky,
    position: DVec3,
    sun: DVec3,
    /// Solar irradiance here over that at the planet's mean distance.
    irradiance_scale: f64,
    disc: SunDisc,
}

/// What arrives along a line of sight. Every list has one entry a wavelength of the sky's grid; radiances in
/// W m^-2 sr^-1 nm^-1. The sun's own disc is not included.
#[derive(Clone, Debug, PartialEq)]
pub struct LineOfSight {
    /// Transmittance to the end of the line: the given distance, the ground or space.
    pub transmittance: Vec<f32>,
    /// Sunlight scattered once on the way.
    pub single: Vec<f32>,
    /// Light scattered or reflected more than once, its last time on the way.
    pub multiple: Vec<f32>,
    /// What of the ground's own radiance arrives; zero where the line does not end on the ground.
    pub ground: Vec<f32>,
    /// Whether the line ends on the ground.
    pub meets_ground: bool,
}

impl LineOfSight {
    /// Radiance scattered into the line of sight: `single + multiple`.
    pub fn path_radiance(&self) -> Vec<f32> {
        self.single
            .iter()
            .zip(&self.multiple)
            .map(|(s, m)| s + m)
            .collect()
    }

    /// All that arrives: path radiance and ground.
    pub fn radiance(&self) -> Vec<f32> {
        self.path_radiance()
            .iter()
            .zip(&self.ground)
            .map(|(p, g)| p + g)
            .collect()
    }

    /// The affine map of the air on the line, for a grid of N wavelengths; `None` for a grid of another size.
    pub fn optics<const N: usize>(&self) -> Option<PathOptics<N>> {
        Some(PathOptics {
            transmittance: Spectrum(self.transmittance.as_slice().try_into().ok()?),
            path_radiance: Spectrum(self.path_radiance().try_into().ok()?),
        })
    }
}

impl<'a> View<'a> {
    pub(super) fn new(sky: &'a Sky, altitude_m: f64, sun: DVec3) -> Self {
        let radius_m = (sky.shell().planet_radius_m + altitude_m).max(sky.shell().ground_radius_m);
        Self {
            sky,
            position: DVec3::Y * radius_m,
            sun: sun.normalize(),
            irradiance_scale: 1.0,
            disc: sky.atmosphere().sun.clone(),
        }
    }

    /// The same view with the planet at `ratio` times its mean distance from the sun: irradiance falls by its square,
    /// the disc shrinks.
    pub fn at_sun_distance(mut self, ratio: f64) -> Self {
        self.irradiance_scale = 1.0 / (ratio * ratio);
        self.disc.angular_radius_rad =
            (self.sky.atmosphere().sun.angular_radius_rad.sin() / ratio).asin();
        self
    }

    /// The sky that is looked at.
    pub fn sky(&self) -> &'a Sky {
        self.sky
    }

    /// Unit vector towards the sun.
    pub fn sun(&self) -> DVec3 {
        self.sun
    }

    /// The sun's disc as seen from this distance.
    pub fn disc(&self) -> &SunDisc {
        &self.disc
    }

    /// Distance of the eye from the planet's centre, m.
    pub fn radius_m(&self) -> f64 {
        self.position.y
    }

    /// Solar irradiance outside the atmosphere on a surface that faces the sun, W m^-2 nm^-1.
    pub fn solar_irradiance(&self) -> Vec<f32> {
        self.sky
            .grid()
            .solar_irradiance()
            .iter()
            .map(|e| (e * self.irradiance_scale) as f32)
            .collect()
    }

    pub(super) fn ray(&self, direction: DVec3) -> Ray {
        Ray::new(self.position, direction, self.sun)
    }

    /// The light along the unit vector `direction`, over at most `limit_m` metres (to the ground or to space if
    /// `None`).
    pub fn along(&self, direction: DVec3, limit_m: Option<f64>) -> LineOfSight {
        let ray = self.ray(direction.normalize());
        let blocks: Vec<BlockLight> = self
            .sky
            .blocks
            .iter()
            .map(|b| b.trace(&ray, limit_m.unwrap_or(f64::INFINITY)))
            .collect();
        let solar = self.solar_irradiance();
        let join = |part: fn(&BlockLight) -> &Vec<f32>| -> Vec<f32> {
            blocks
                .iter()
                .flat_map(|b| part(b).iter().copied())
                .collect()
        };
        let lit = |part: fn(&BlockLight) -> &Vec<f32>| -> Vec<f32> {
            join(part).iter().zip(&solar).map(|(l, e)| l * e).collect()
        };
        LineOfSight {
            transmittance: join(|b| &b.transmittance),
            single: lit(|b| &b.single),
            multiple: lit(|b| &b.multiple),
            ground: lit(|b| &b.ground),
            meets_ground: blocks.iter().any(|b| b.meets_ground),
        }
    }

    /// Transmittance from the eye to space along `direction`; 0 where the planet is in the way.
    pub fn transmittance_to_space(&self, direction: DVec3) -> Vec<f32> {
        let ray = self.ray(direction.normalize());
        self.sky
            .blocks
            .iter()
            .flat_map(|b| b.transmittance_to_space(ray.radius_m, ray.mu))
            .collect()
    }

    /// Irradiance of the sun's disc on a surface that faces it, W m^-2 nm^-1: dimmed by the air strip by strip, and
    /// cut off by the horizon.
    pub fn sun_irradiance(&self) -> Vec<f32> {
        let strips = 16;
        let radius = self.disc.angular_radius_rad;
        // Horizontal strips of equal height; in each the mean of the darkened radiance goes by its length.
        let across = self.sun.cross(DVec3::Y);
        let up = if across.length() > 1e-9 {
            across.normalize().cross(self.sun).normalize()
        } else {
            DVec3::X
        };
        let mut sum = vec![0.0f64; self.sky.grid().len()];
        let mut total = vec![0.0f64; sum.len()];
        for strip in 0..strips {
            let height = (2.0 * (f64::from(strip) + 0.5) / f64::from(strips) - 1.0) * radius;
            let direction = (self.sun + up * height.tan()).normalize();
            let transmittance = self.transmittance_to_space(direction);
            let half_length = (radius * radius - height * height).sqrt();
            for (lane, &nm) in self.sky.grid().wavelengths_nm().iter().enumerate() {
                let mean = (0..8)
                    .map(|k| {
                        let along = (f64::from(k) + 0.5) / 8.0 * half_length;
                        self.disc.radiance_per_irradiance(along.hypot(height), nm)
                    })
                    .sum::<f64>()
                    * half_length;
                total[lane] += mean;
                sum[lane] += mean * f64::from(transmittance[lane]);
            }
        }
        self.solar_irradiance()
            .iter()
            .zip(sum.iter().zip(&total))
            .map(|(e, (s, t))| (f64::from(*e) * s / t) as f32)
            .collect()
    }

    /// Radiance of the sun's disc as it arrives along `direction`, W m^-2 sr^-1 nm^-1; zero beside the disc and where
    /// the planet hides it.
    pub fn sun_disc_radiance(&self, direction: DVec3) -> Vec<f32> {
        let direction = direction.normalize();
        let angle = direction.angle_between(self.sun);
        if angle >= self.disc.angular_radius_rad {
            return vec![0.0; self.sky.grid().len()];
        }
        let transmittance = self.transmittance_to_space(direction);
        self.solar_irradiance()
            .iter()
            .zip(&transmittance)
            .zip(self.sky.grid().wavelengths_nm())
            .map(|((e, t), &nm)| e * t * self.disc.radiance_per_irradiance(angle, nm) as f32)
            .collect()
    }

    /// Tabulates the whole sphere of directions for fast look-up.
    pub fn table(&self, channels: TableChannels) -> SkyTable {
        SkyTable::new(self, channels)
    }
}
