//! Optical coefficients of an atmosphere at any number of wavelengths, and ray marching through it.

use super::TransmittanceTable;
use crate::atmosphere::{Atmosphere, DensityProfile};
use crate::fog::Lanes;
use crate::optics::PhaseFunction;
use crate::spectrum::Spectrum;
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

/// How a march divides a ray into steps, and where each step samples the air.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum Steps {
    /// Step k begins at the fraction `(k / count)^power` of the ray and samples its midpoint.
    Midpoints {
        /// Number of steps, at least 1.
        count: usize,
        /// Exponent, at least 1.
        power: i32,
    },
    /// Step k ends at its sample, at the fraction `(k + place) / count`, and begins at the sample before; behind the last sample
    /// the ray is not marched.
    Ends {
        /// Number of steps, at least 1.
        count: usize,
        /// Fraction of the distance between samples, from 0 to 1.
        place: f64,
    },
}

impl Steps {
    /// Number of steps.
    pub fn count(self) -> usize {
        match self {
            Self::Midpoints { count, .. } | Self::Ends { count, .. } => count,
        }
    }

    /// Fractions of the ray at which a step begins, ends and samples the air.
    fn step(self, k: usize) -> [f64; 3] {
        match self {
            Self::Midpoints { count, power } => {
                let edge = |k: usize| (k as f64 / count as f64).powi(power);
                let (from, to) = (edge(k), edge(k + 1));
                [from, to, 0.5 * (from + to)]
            }
            Self::Ends { count, place } => {
                let sample = |k: f64| (k + place) / count as f64;
                let here = sample(k as f64);
                [sample(k as f64 - 1.0).max(0.0), here, here]
            }
        }
    }
}

/// A step of a march.
pub struct Step<'a> {
    /// The ray relative to the sample of the step.
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

    /// Marches from `start_m` to `end_m` in steps. Within a step the source function is constant and extinction is integrated
    /// exactly. Returns the transmittances.
    pub fn march(
        &self,
        ray: &Ray,
        (start_m, end_m): (f64, f64),
        steps: Steps,
        mut visit: impl FnMut(&Step<'_>),
    ) -> Vec<f32> {
        let lanes = self.lanes();
        let mut throughput = vec![1.0f32; lanes];
        let (mut scattering, mut weight) = (vec![0.0f32; lanes], vec![0.0f32; lanes]);
        let mut extinction = vec![0.0f32; lanes];
        let mut densities = vec![0.0; self.densities.len()];
        for k in 0..steps.count() {
            let [from, to, sample] = steps.step(k).map(|part| start_m + (end_m - start_m) * part);
            let altitude = ray.radius_m - self.planet_radius_m + ray.climb_at(sample);
            scattering.fill(0.0);
            extinction.fill(0.0);
            for (part, density) in densities.iter_mut().enumerate() {
                *density = self.densities[part].at(altitude);
                let d = *density as f32;
                add_scaled(
                    &mut scattering,
                    &self.coefficients.scattering_per_m[part],
                    d,
                );
                add_scaled(
                    &mut extinction,
                    &self.coefficients.extinction_per_m[part],
                    d,
                );
            }
            attenuate(
                &extinction,
                (to - from) as f32,
                &mut throughput,
                &mut weight,
            );
            visit(&Step {
                here: ray.advanced(sample),
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
                    add_scaled(out, extinction, (density.at(altitude) * step) as f32);
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

/// Adds `factor * values` to a sum.
pub fn add_scaled(sum: &mut [f32], values: &[f32], factor: f32) {
    for (sum, value) in sum.iter_mut().zip(values) {
        *sum += factor * value;
    }
}

/// Attenuates `throughput` over `length_m` of a constant extinction; `weight_m` receives the throughput integrated over the
/// length.
fn attenuate(
    extinction_per_m: &[f32],
    length_m: f32,
    throughput: &mut [f32],
    weight_m: &mut [f32],
) {
    /// Wavelengths that are computed together by vector instructions.
    const TOGETHER: usize = 8;
    let extinction = extinction_per_m.chunks(TOGETHER);
    let out = throughput
        .chunks_mut(TOGETHER)
        .zip(weight_m.chunks_mut(TOGETHER));
    for (extinction, (throughput, weight)) in extinction.zip(out) {
        let mut depth = Spectrum::<TOGETHER>::ZERO;
        for (depth, extinction) in depth.0.iter_mut().zip(extinction) {
            *depth = extinction * length_m;
        }
        let mean = depth.mean_transmittance();
        let lost = mean * depth;
        for (((throughput, weight), mean), lost) in
            throughput.iter_mut().zip(weight).zip(mean.0).zip(lost.0)
        {
            *weight = *throughput * mean * length_m;
            *throughput *= 1.0 - lost;
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn steps_follow_one_another() {
        let parts = |steps: Steps| (0..steps.count()).map(move |k| steps.step(k));
        for steps in [
            Steps::Midpoints { count: 7, power: 2 },
            Steps::Ends {
                count: 16,
                place: 0.3,
            },
        ] {
            let mut end = 0.0;
            for [from, to, sample] in parts(steps) {
                assert_eq!(from, end);
                assert!(to > from && (from..=to).contains(&sample));
                end = to;
            }
            let marched = match steps {
                Steps::Midpoints { .. } => 1.0,
                Steps::Ends { .. } => 15.3 / 16.0,
            };
            assert!((end - marched).abs() < 1e-12);
        }
    }

    #[test]
    fn light_is_attenuated_exactly_in_every_lane() {
        let extinction: Vec<f32> = (0..11).map(|i| 1e-9 * 10f32.powi(i)).collect();
        let (mut throughput, mut weight) = (vec![0.5; 11], vec![0.0; 11]);
        attenuate(&extinction, 30.0, &mut throughput, &mut weight);
        for ((extinction, throughput), weight) in extinction.iter().zip(throughput).zip(weight) {
            let extinction = f64::from(*extinction);
            let lost = -(-30.0 * extinction).exp_m1();
            assert!((f64::from(throughput) - 0.5 * (1.0 - lost)).abs() < 1e-7);
            assert!((f64::from(weight) / (0.5 * lost / extinction) - 1.0).abs() < 1e-6);
        }
    }
}
