//! Optical coefficients of an atmosphere at any number of wavelengths, and ray marching through it.

use super::TransmittanceTable;
use crate::atmosphere::{Atmosphere, DensityProfile};
use crate::optics::PhaseFunction;
use crate::transfer::coefficients::Coefficients;
use crate::transfer::ray::{AirSegment, Ray, in_shadow};

/// An atmosphere at some wavelengths; all lists have one entry per wavelength.
pub struct AirLanes {
    wavelengths_nm: Vec<f64>,
    planet_radius_m: f64,
    ground_radius_m: f64,
    top_radius_m: f64,
    coefficients: Coefficients<Vec<f32>>,
    densities: Vec<DensityProfile>,
    phases: Vec<PhaseFunction>,
}

/// A step of a march.
pub struct Step<'a> {
    /// The ray relative to the midpoint of the step.
    pub here: Ray,
    /// Relative densities of the constituents.
    pub densities: &'a [f64],
    /// Scattering coefficients, 1/m.
    pub scattering_per_m: &'a [f32],
    /// Light at the start of the ray per unit source function, assumed constant over the step, m.
    pub weight_m: &'a [f32],
}

impl AirLanes {
    /// Samples `atmosphere` at wavelengths (nm, in any order).
    pub fn new(atmosphere: &Atmosphere, wavelengths_nm: &[f64]) -> Self {
        let planet = &atmosphere.planet;
        let parts = &atmosphere.constituents;
        Self {
            wavelengths_nm: wavelengths_nm.to_vec(),
            planet_radius_m: planet.radius_m,
            ground_radius_m: planet.radius_m + planet.ground_altitude_m,
            top_radius_m: planet.radius_m + planet.top_altitude_m,
            coefficients: Coefficients::sample(atmosphere, |f| {
                wavelengths_nm.iter().map(|&nm| f(nm) as f32).collect()
            }),
            densities: parts.iter().map(|part| part.density.clone()).collect(),
            phases: parts.iter().map(|part| part.phase.clone()).collect(),
        }
    }

    /// Number of wavelengths.
    pub fn lanes(&self) -> usize {
        self.wavelengths_nm.len()
    }

    /// Radii of the ground and of the top of the atmosphere, m.
    pub fn bounds_m(&self) -> (f64, f64) {
        (self.ground_radius_m, self.top_radius_m)
    }

    /// Radius at altitude 0, m.
    pub fn planet_radius_m(&self) -> f64 {
        self.planet_radius_m
    }

    /// Scattering coefficient times phase function of each constituent at density 1, `[constituent][wavelength]`, 1/(m sr);
    /// `nu` is the cosine of the angle to the sun.
    pub fn scattered(&self, nu: f64) -> Vec<Vec<f32>> {
        let of = |(scattering, phase): (&Vec<f32>, &PhaseFunction)| {
            let lanes = scattering.iter().zip(&self.wavelengths_nm);
            lanes
                .map(|(s, &nm)| s * phase.evaluate(nu, nm) as f32)
                .collect()
        };
        let scattering = self.coefficients.scattering_per_m.iter();
        scattering.zip(&self.phases).map(of).collect()
    }

    /// Segment of a ray inside the atmosphere, over at most `limit_m` metres; `None` if it misses the atmosphere.
    pub fn segment(&self, ray: &Ray, limit_m: f64) -> Option<AirSegment> {
        ray.segment_in_air(self.ground_radius_m, self.top_radius_m, limit_m)
    }

    /// Marches from `start_m` to `end_m` in `steps` steps with the density of their midpoints; step k of n begins at the fraction
    /// `(k / n)^power`. Within a step the source function is constant and extinction is integrated exactly. Returns the
    /// transmittances.
    pub fn march(
        &self,
        ray: &Ray,
        (start_m, end_m): (f64, f64),
        (steps, power): (usize, f64),
        mut visit: impl FnMut(&Step<'_>),
    ) -> Vec<f32> {
        let lanes = self.lanes();
        let mut throughput = vec![1.0f32; lanes];
        let (mut scattering, mut weight) = (vec![0.0f32; lanes], vec![0.0f32; lanes]);
        let mut extinction = vec![0.0f32; lanes];
        let mut densities = vec![0.0; self.densities.len()];
        let edge = |k: usize| start_m + (end_m - start_m) * (k as f64 / steps as f64).powf(power);
        for k in 0..steps {
            let (from, to) = (edge(k), edge(k + 1));
            let middle = 0.5 * (from + to);
            let altitude = ray.radius_m - self.planet_radius_m + ray.climb_at(middle);
            scattering.fill(0.0);
            extinction.fill(0.0);
            for (part, density) in densities.iter_mut().enumerate() {
                *density = self.densities[part].at(altitude);
                let d = *density as f32;
                for lane in 0..lanes {
                    scattering[lane] += d * self.coefficients.scattering_per_m[part][lane];
                    extinction[lane] += d * self.coefficients.extinction_per_m[part][lane];
                }
            }
            let dt = (to - from) as f32;
            for lane in 0..lanes {
                let tau = extinction[lane] * dt;
                let lost = -(-tau).exp_m1();
                // (1 - e^-tau) / sigma_t, with the limit dt for small tau.
                let mean = if tau > 1e-6 {
                    lost / extinction[lane]
                } else {
                    dt
                };
                weight[lane] = throughput[lane] * mean;
                throughput[lane] *= 1.0 - lost;
            }
            visit(&Step {
                here: ray.advanced(middle),
                densities: &densities,
                scattering_per_m: &scattering,
                weight_m: &weight,
            });
        }
        throughput
    }

    /// Transmittance table of `size` (zenith angles, altitudes), each ray marched in `steps` equal steps.
    pub fn transmittance_table(&self, size: [usize; 2], steps: usize) -> TransmittanceTable {
        TransmittanceTable::new(self.bounds_m(), size, self.lanes(), |radius_m, mu, out| {
            let ray = Ray {
                radius_m,
                mu,
                mu_sun: 0.0,
                nu: 0.0,
            };
            let end_m = ray.crossings(self.top_radius_m).map_or(0.0, |(_, far)| far);
            out.fill(0.0);
            let step = end_m / steps as f64;
            for k in 0..steps {
                let altitude =
                    ray.radius_m - self.planet_radius_m + ray.climb_at((k as f64 + 0.5) * step);
                let extinction = self.coefficients.extinction_per_m.iter();
                for (density, extinction) in self.densities.iter().zip(extinction) {
                    let column = (density.at(altitude) * step) as f32;
                    for (tau, sigma) in out.iter_mut().zip(extinction) {
                        *tau += column * sigma;
                    }
                }
            }
        })
    }

    /// Transmittance to the sun at the zenith cosine `mu_sun` from the table; 0 in the planet's shadow.
    pub fn transmittance_to_sun(
        &self,
        table: &TransmittanceTable,
        radius_m: f64,
        mu_sun: f64,
        out: &mut [f32],
    ) {
        if in_shadow(radius_m, mu_sun, self.ground_radius_m) {
            out.fill(0.0);
        } else {
            table.look_up(radius_m, mu_sun, out);
        }
    }

    /// Radiance of the sunlit ground per unit solar irradiance at the sun cosine `mu_sun`, into `out`.
    pub fn ground_radiance(&self, table: &TransmittanceTable, mu_sun: f64, out: &mut [f32]) {
        if mu_sun <= 0.0 {
            out.fill(0.0);
            return;
        }
        table.look_up(self.ground_radius_m, mu_sun, out);
        for (o, albedo) in out.iter_mut().zip(&self.coefficients.ground_albedo) {
            *o *= albedo * (mu_sun * std::f64::consts::FRAC_1_PI) as f32;
        }
    }
}
