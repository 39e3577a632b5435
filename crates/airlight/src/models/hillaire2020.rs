//! The sky of S. Hillaire: "A Scalable and Production Ready Sky and Atmosphere Rendering Technique", Computer Graphics
//! Forum 39(4), 2020, on the CPU and at any wavelengths.
//!
//! A line of sight is marched in few steps. Sunlight scattered once takes its way through a table of transmittances
//! (eqs. 1 to 4); light scattered more often is taken to come evenly from all sides and from a geometric series (eqs. 5
//! to 10), kept in a second table and added at each step (eq. 11). The published engine also keeps the sky itself in a
//! table of 200 x 100 directions and the air before the scene in another: here each line is marched.
//!
//! Steps lie closer near the eye, step k of n beginning at `(k / n)^2` of the way, as in the author's published shaders; the
//! paper says nothing of it. Samples are taken in the middle of steps. The ground is lit by the sun alone, and black to later
//! orders, as there.

use super::PublishedModel;
use super::lut::{
    AirLanes, MultipleScatteringSettings, MultipleScatteringTable, TransmittanceTable,
};
use crate::atmosphere::{Atmosphere, AtmosphereError};
use crate::sky::LineOfSight;
use crate::spectrum::WavelengthGrid;
use crate::sun::SunDisc;
use crate::transfer::ray::Ray;
use glam::DVec3;

/// Sizes and steps.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Settings {
    /// Zenith angles and heights of the transmittance table, at least 2 of each.
    pub transmittance_size: [usize; 2],
    /// Steps on each ray of the transmittance table, at least 1.
    pub transmittance_steps: usize,
    /// The table of multiple scattering; none for light scattered once.
    pub multiple: Option<MultipleScatteringSettings>,
    /// Steps on each line of sight, at least 1.
    pub steps: usize,
}

impl Default for Settings {
    /// The paper's (table 2): 256 x 64 transmittances of 40 steps, 32 x 32 of multiple scattering, lines of 30 steps.
    fn default() -> Self {
        Self {
            transmittance_size: [256, 64],
            transmittance_steps: 40,
            multiple: Some(MultipleScatteringSettings::default()),
            steps: 30,
        }
    }
}

/// Why a sky cannot be made.
#[derive(Clone, Debug, PartialEq, thiserror::Error)]
pub enum HillaireError {
    /// The eye is not on or above the ground.
    #[error(
        "the eye must be at a finite height, not below the ground at {ground_m} m, got {altitude_m} m"
    )]
    EyeAltitude {
        /// What was given, m.
        altitude_m: f64,
        /// Where the ground is, m.
        ground_m: f64,
    },
    /// The sun has no direction.
    #[error("the sun's direction must be finite and not zero, got {0}")]
    Sun(DVec3),
    /// A size or a number of steps is out of range.
    #[error(
        "tables need at least 2 entries each way, marches at least 1 step, spheres at least 1 direction"
    )]
    Settings,
    /// The atmosphere is refused.
    #[error(transparent)]
    Atmosphere(#[from] AtmosphereError),
}

/// The sky for one eye and one sun.
pub struct Hillaire2020 {
    grid: WavelengthGrid,
    air: AirLanes,
    transmittance: TransmittanceTable,
    multiple: Option<MultipleScatteringTable>,
    steps: usize,
    disc: SunDisc,
    solar: Vec<f32>,
    eye: DVec3,
    sun: DVec3,
}

/// How the steps of a line of sight widen.
const STEP_POWER: f64 = 2.0;

impl Hillaire2020 {
    /// The sky of `atmosphere` at the wavelengths of `grid` (under the atmosphere's own sun), with the paper's sizes, seen
    /// from a height (m) with the sun in a direction.
    ///
    /// # Errors
    /// [`HillaireError`] for an eye, a sun or an atmosphere out of their domain.
    pub fn new(
        atmosphere: &Atmosphere,
        grid: &WavelengthGrid,
        eye_altitude_m: f64,
        sun_direction: DVec3,
    ) -> Result<Self, HillaireError> {
        Self::with_settings(
            atmosphere,
            grid,
            eye_altitude_m,
            sun_direction,
            &Settings::default(),
        )
    }

    /// The same with other sizes.
    ///
    /// # Errors
    /// As [`Self::new`], and for settings out of their range.
    pub fn with_settings(
        atmosphere: &Atmosphere,
        grid: &WavelengthGrid,
        eye_altitude_m: f64,
        sun_direction: DVec3,
        settings: &Settings,
    ) -> Result<Self, HillaireError> {
        atmosphere.validate()?;
        let ground_m = atmosphere.planet.ground_altitude_m;
        if !(eye_altitude_m.is_finite() && eye_altitude_m >= ground_m) {
            return Err(HillaireError::EyeAltitude {
                altitude_m: eye_altitude_m,
                ground_m,
            });
        }
        let sun = sun_direction
            .try_normalize()
            .ok_or(HillaireError::Sun(sun_direction))?;
        let multiple_fits = settings.multiple.is_none_or(|m| {
            m.size.iter().all(|&n| n >= 2) && m.root_of_directions >= 1 && m.steps >= 1
        });
        if settings.transmittance_size.iter().any(|&n| n < 2)
            || settings.transmittance_steps == 0
            || settings.steps == 0
            || !multiple_fits
        {
            return Err(HillaireError::Settings);
        }
        let grid = grid.clone().with_solar(&atmosphere.solar_irradiance);
        let air = AirLanes::new(atmosphere, grid.wavelengths_nm());
        let transmittance =
            air.transmittance_table(settings.transmittance_size, settings.transmittance_steps);
        let multiple = settings
            .multiple
            .map(|m| MultipleScatteringTable::new(&air, &transmittance, &m));
        Ok(Self {
            eye: DVec3::Y * (air.planet_radius_m() + eye_altitude_m),
            solar: grid.solar_irradiance().iter().map(|&e| e as f32).collect(),
            grid,
            air,
            transmittance,
            multiple,
            steps: settings.steps,
            disc: atmosphere.sun.clone(),
            sun,
        })
    }

    /// Spectral radiance along a unit vector, W m^-2 sr^-1 nm^-1: the sky, or the air before the ground and the ground.
    pub fn radiance(&self, direction: DVec3) -> Vec<f32> {
        self.along(direction, None).radiance()
    }

    /// The light along a unit vector over at most `limit_m` metres (to the ground or to space if `None`), in its parts. A
    /// shorter line is marched in as many steps.
    pub fn along(&self, direction: DVec3, limit_m: Option<f64>) -> LineOfSight {
        let lanes = self.air.lanes();
        let dark = || vec![0.0f32; lanes];
        let mut line = LineOfSight {
            transmittance: vec![1.0; lanes],
            single: dark(),
            multiple: dark(),
            ground: dark(),
            meets_ground: false,
        };
        let ray = Ray::new(self.eye, direction, self.sun);
        let limit_m = limit_m.unwrap_or(f64::INFINITY);
        let Some((start, end, on_ground)) = self.air.stretch_m(&ray) else {
            return line;
        };
        if limit_m <= start {
            return line;
        }
        line.meets_ground = on_ground && end <= limit_m;
        let scattered = self.air.scattered(ray.nu);
        let (mut sunlight, mut psi) = (dark(), dark());
        let stretch = (start, end.min(limit_m));
        line.transmittance = self
            .air
            .march(&ray, stretch, (self.steps, STEP_POWER), |step| {
                let here = &step.here;
                self.air.sunlight(
                    &self.transmittance,
                    here.radius_m,
                    here.mu_sun,
                    &mut sunlight,
                );
                if let Some(table) = &self.multiple {
                    table.look_up(here.radius_m, here.mu_sun, &mut psi);
                }
                for lane in 0..lanes {
                    let once: f32 = step
                        .densities
                        .iter()
                        .zip(&scattered)
                        .map(|(&density, s)| density as f32 * s[lane])
                        .sum();
                    let weight = step.weight_m[lane] * self.solar[lane];
                    line.single[lane] += weight * once * sunlight[lane];
                    line.multiple[lane] += weight * step.scattering_per_m[lane] * psi[lane];
                }
            });
        if line.meets_ground {
            self.air
                .ground_radiance(&self.transmittance, ray.advanced(end).mu_sun, &mut sunlight);
            for lane in 0..lanes {
                line.ground[lane] = line.transmittance[lane] * sunlight[lane] * self.solar[lane];
            }
        }
        line
    }

    /// Spectral radiance of the sun's disc as it arrives along a unit vector, W m^-2 sr^-1 nm^-1.
    pub fn disc_radiance(&self, direction: DVec3) -> Vec<f32> {
        let mut light = vec![0.0f32; self.air.lanes()];
        let angle = direction.angle_between(self.sun);
        let ray = Ray::new(self.eye, direction, self.sun);
        let (ground_m, top_m) = self.air.bounds_m();
        if angle >= self.disc.angular_radius_rad || ray.distance_to_ground(ground_m).is_some() {
            return light;
        }
        // From above the air the line enters at its top, or misses it.
        let inside = match self.air.stretch_m(&ray) {
            Some((start, _, _)) if ray.radius_m > top_m => Some(ray.advanced(start)),
            Some(_) => Some(ray),
            None => None,
        };
        match inside {
            Some(ray) => self.transmittance.look_up(ray.radius_m, ray.mu, &mut light),
            None => light.fill(1.0),
        }
        let lanes = self.solar.iter().zip(self.grid.wavelengths_nm());
        for (light, (e, &nm)) in light.iter_mut().zip(lanes) {
            *light *= e * self.disc.radiance_per_irradiance(angle, nm) as f32;
        }
        light
    }
}

impl PublishedModel for Hillaire2020 {
    fn sun(&self) -> DVec3 {
        self.sun
    }

    fn disc_edge_rad(&self) -> f64 {
        self.disc.angular_radius_rad
    }

    fn has_ground(&self) -> bool {
        true
    }

    fn sky_xyz(&self, direction: DVec3) -> [f64; 3] {
        self.grid.to_xyz(&self.radiance(direction))
    }

    fn disc_xyz(&self, direction: DVec3) -> [f64; 3] {
        self.grid.to_xyz(&self.disc_radiance(direction))
    }

    fn grid(&self) -> Option<&WavelengthGrid> {
        Some(&self.grid)
    }

    fn sky_spectrum(&self, direction: DVec3) -> Vec<f64> {
        f64s(self.radiance(direction))
    }

    fn disc_spectrum(&self, direction: DVec3) -> Vec<f64> {
        f64s(self.disc_radiance(direction))
    }

    fn line(&self, direction: DVec3, limit_m: Option<f64>) -> Option<LineOfSight> {
        Some(self.along(direction, limit_m))
    }
}

fn f64s(light: Vec<f32>) -> Vec<f64> {
    light.into_iter().map(f64::from).collect()
}

#[cfg(test)]
mod tests;
