//! Table of multiple scattering, assumed isotropic.
//!
//! S. Hillaire, "A Scalable and Production Ready Sky and Atmosphere Rendering Technique", Computer Graphics Forum 39(4),
//! 2020, section 5.5: second-order light with an isotropic phase function (eqs. 5 and 6), the fraction of it that the
//! surroundings return with each further order (eqs. 7 and 8), and the geometric series of all later orders (eqs. 9 and 10).

use super::{AirLanes, Steps, TransmittanceTable};
use crate::control::{Cancelled, Control};
use crate::math::interpolation::bilinear;
use crate::math::parallel;
use crate::transfer::ray::Ray;
use std::f64::consts::PI;

/// Resolution of the table.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct MultipleScatteringSettings {
    /// Sun angles and altitudes, at least 2 each.
    pub size: [usize; 2],
    /// Square root of the number of directions, at least 1.
    pub root_of_directions: usize,
    /// Number of steps along each ray, at least 1.
    pub steps: usize,
}

impl Default for MultipleScatteringSettings {
    /// Values of the paper (table 2): 32 x 32, 64 directions, 20 steps.
    fn default() -> Self {
        Self {
            size: [32, 32],
            root_of_directions: 8,
            steps: 20,
        }
    }
}

/// `Psi_ms` by cosine of the sun's zenith angle and altitude.
pub struct MultipleScatteringTable {
    ground_radius_m: f64,
    top_radius_m: f64,
    size: [usize; 2],
    lanes: usize,
    values: Vec<f32>,
}

impl MultipleScatteringTable {
    /// Computes the table for an atmosphere and its transmittance.
    ///
    /// # Errors
    /// [`Cancelled`].
    pub fn new(
        air: &AirLanes,
        transmittance: &TransmittanceTable,
        settings: &MultipleScatteringSettings,
        control: Control<'_>,
    ) -> Result<Self, Cancelled> {
        let (ground_radius_m, top_radius_m) = air.bounds_m();
        let size = settings.size;
        let lanes = air.lanes();
        let mut values = vec![0.0; size[0] * size[1] * lanes];
        parallel::try_for_each_chunk(&mut values, lanes, |index, out| {
            control.check()?;
            let mu_sun = 2.0 * (index % size[0]) as f64 / (size[0] - 1) as f64 - 1.0;
            let height = (index / size[0]) as f64 / (size[1] - 1) as f64;
            let radius_m = ground_radius_m + height * (top_radius_m - ground_radius_m);
            psi(air, transmittance, settings, (radius_m, mu_sun), out);
            Ok(())
        })?;
        Ok(Self {
            ground_radius_m,
            top_radius_m,
            size,
            lanes,
            values,
        })
    }

    /// Interpolates `Psi_ms` per unit solar irradiance, sr^-1, into `out`.
    pub fn look_up(&self, radius_m: f64, mu_sun: f64, out: &mut [f32]) {
        let height = (radius_m - self.ground_radius_m) / (self.top_radius_m - self.ground_radius_m);
        out.fill(0.0);
        for (index, weight) in bilinear(0.5 + 0.5 * mu_sun, height, self.size) {
            let sample = &self.values[index * self.lanes..][..self.lanes];
            for (o, s) in out.iter_mut().zip(sample) {
                *o += weight * s;
            }
        }
    }
}

/// `Psi_ms = L_2nd / (1 - f_ms)` at one point (eq. 10).
fn psi(
    air: &AirLanes,
    transmittance: &TransmittanceTable,
    settings: &MultipleScatteringSettings,
    (radius_m, mu_sun): (f64, f64),
    out: &mut [f32],
) {
    let lanes = air.lanes();
    let root = settings.root_of_directions;
    let isotropic = (0.25 / PI) as f32;
    let sin_sun = (1.0 - mu_sun * mu_sun).max(0.0).sqrt();
    let (mut second, mut returned) = (vec![0.0f32; lanes], vec![0.0f32; lanes]);
    let mut sunlight = vec![0.0f32; lanes];
    for i in 0..root {
        // Uniform over the sphere.
        let mu = 1.0 - 2.0 * (i as f64 + 0.5) / root as f64;
        let sine = (1.0 - mu * mu).sqrt();
        for j in 0..root {
            let azimuth = 2.0 * PI * (j as f64 + 0.5) / root as f64;
            let nu = mu * mu_sun + sine * sin_sun * azimuth.cos();
            let ray = Ray {
                radius_m,
                mu,
                mu_sun,
                nu,
            };
            let Some(segment) = air.segment(&ray, f64::INFINITY) else {
                continue;
            };
            let through = air.march(
                &ray,
                (segment.start_m, segment.end_m),
                Steps::Midpoints {
                    count: settings.steps,
                    power: 1,
                },
                |step| {
                    air.transmittance_to_sun(
                        transmittance,
                        step.here.radius_m,
                        step.here.mu_sun,
                        &mut sunlight,
                    );
                    for lane in 0..lanes {
                        let scattered = step.scattering_per_m[lane] * step.weight_m[lane];
                        second[lane] += scattered * sunlight[lane] * isotropic;
                        returned[lane] += scattered;
                    }
                },
            );
            if segment.meets_ground {
                air.ground_radiance(
                    transmittance,
                    ray.advanced(segment.end_m).mu_sun,
                    &mut sunlight,
                );
                for lane in 0..lanes {
                    second[lane] += through[lane] * sunlight[lane];
                }
            }
        }
    }
    let share = 1.0 / (root * root) as f32;
    for lane in 0..lanes {
        out[lane] = second[lane] * share / (1.0 - returned[lane] * share);
    }
}
