//! [`FogPatches`], [`PatchField`]: a random factor on the density of fog.

use super::error::FogError;
use crate::math::random::Random;
use glam::DVec3;
use std::f64::consts::{PI, TAU};

/// Number of octaves of wavelengths.
pub(super) const OCTAVES: usize = 3;
/// Number of plane waves of an octave.
pub(super) const WAVES: usize = 16;
/// Ratio of the variances of successive octaves: a scalar in turbulence varies by the 2/3 power of the distance (Obukhov 1949,
/// Corrsin 1951), so that an octave has `2^(-2/3)` of the variance of the longer one.
const VARIANCE_RATIO: f64 = 0.629_960_524_947_436_6;
/// Stream of the random numbers.
const STREAM: u64 = 0x7061_7463_6865_7301;
/// Greatest strength.
const STRONGEST: f64 = 2.0;

/// Patches in fog: a random factor on its density, with a mean of 1 at every point, the same for all layers.
///
/// The visibility of patchy fog is that of its mean extinction.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct FogPatches {
    /// Standard deviation of the density relative to its mean, 0 to 2. Fog with 0 is even.
    pub strength: f64,
    /// Width of a typical patch, m, above 0: half of the longest wavelength.
    pub size_m: f64,
    /// Height of a typical patch, m, above 0.
    pub height_m: f64,
    /// Selects one field of many.
    pub seed: u64,
    /// Displacement of the field by wind to the east and to the north, m.
    pub drift_m: [f64; 2],
}

impl Default for FogPatches {
    /// Patches 30 m wide and 10 m high, of strength 0.5.
    fn default() -> Self {
        Self {
            strength: 0.5,
            size_m: 30.0,
            height_m: 10.0,
            seed: 0,
            drift_m: [0.0; 2],
        }
    }
}

impl FogPatches {
    /// Checks all values.
    ///
    /// # Errors
    /// [`FogError::Number`] for the first value out of range.
    pub fn validate(&self) -> Result<(), FogError> {
        let length = |what, got: f64| match got > 0.0 && got <= 1e9 {
            true => Ok(()),
            false => Err(FogError::Number {
                what,
                got,
                expected: "a number above 0 and at most 1e9, such as 30",
            }),
        };
        if !(0.0..=STRONGEST).contains(&self.strength) {
            return Err(FogError::Number {
                what: "strength of fog patches",
                got: self.strength,
                expected: "a number from 0 to 2, such as 0.5",
            });
        }
        length("size of fog patches (m)", self.size_m)?;
        length("height of fog patches (m)", self.height_m)?;
        match self.drift_m.iter().find(|metres| !metres.is_finite()) {
            Some(&got) => Err(FogError::Number {
                what: "drift of fog patches (m)",
                got,
                expected: "finite numbers, such as 0",
            }),
            None => Ok(()),
        }
    }
}

/// The density factor of [`FogPatches`] at every point of the world ([`crate::axes`]).
///
/// The logarithm of the factor is a sum of plane waves in three octaves of wavelengths, 16 to an octave, with random directions
/// and phases: close to a Gaussian random field, so that the factor is close to lognormal,
///
/// ```text
/// f(x) = exp(sum_i a_i cos(k_i . x + phi_i)) / prod_i I_0(a_i)
/// ```
///
/// `I_0`, the mean of `e^(a cos phi)` over the phase, makes the mean over all seeds exactly 1 at every point; the amplitudes make
/// the standard deviation exactly the strength. Each octave has `2^(-2/3)` of the variance of the longer one, as in turbulence.
#[derive(Clone, Debug, PartialEq)]
pub struct PatchField {
    pub(super) patches: FogPatches,
    /// From the longest wavelengths to the shortest.
    pub(super) octaves: [Octave; OCTAVES],
}

/// Waves of equal amplitude whose wavelengths lie within a factor of 2.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(super) struct Octave {
    pub waves: [Wave; WAVES],
    /// Amplitude of a wave in the logarithm of the factor.
    pub amplitude: f64,
}

/// A plane wave.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(super) struct Wave {
    /// Wave vector, rad/m.
    pub vector: DVec3,
    /// Phase at the origin, rad.
    pub phase: f64,
}

impl Wave {
    /// Phase at a point, from 0 to 2 pi.
    pub fn phase_at(&self, position: DVec3) -> f64 {
        (self.vector.dot(position) + self.phase).rem_euclid(TAU)
    }
}

impl PatchField {
    /// Draws the waves of patches.
    ///
    /// # Errors
    /// [`FogError::Number`] for values out of range.
    pub fn new(patches: &FogPatches) -> Result<Self, FogError> {
        patches.validate()?;
        let amplitudes = amplitudes(patches.strength);
        let mut random = Random::new(patches.seed, STREAM, 0);
        let [east, north] = patches.drift_m;
        let drift = DVec3::new(east, 0.0, -north);
        let octaves = std::array::from_fn(|octave| Octave {
            waves: std::array::from_fn(|wave| {
                let mut within = |stratum: usize| (stratum as f64 + random.unit()) / WAVES as f64;
                // Directions and wavelengths are stratified, each in another order; phases are independent, for the mean of 1. A
                // wave and its opposite are the same, so that a hemisphere has all directions.
                let up = within(wave);
                let azimuth = TAU * within(wave * 5 % WAVES);
                let wavelength_m = 2.0 * patches.size_m * libm::exp2(-(octave as f64));
                let wavelength_m = wavelength_m * libm::exp2(-within(wave * 7 % WAVES));
                let phase = TAU * random.unit();
                let across = (1.0 - up * up).sqrt();
                let direction = DVec3::new(
                    across * libm::cos(azimuth),
                    up * patches.size_m / patches.height_m,
                    across * libm::sin(azimuth),
                );
                let vector = direction * (TAU / wavelength_m);
                Wave {
                    vector,
                    phase: (phase - vector.dot(drift)).rem_euclid(TAU),
                }
            }),
            amplitude: amplitudes[octave],
        });
        Ok(Self {
            patches: *patches,
            octaves,
        })
    }

    /// The patches of which this is the field.
    pub fn patches(&self) -> &FogPatches {
        &self.patches
    }

    /// Factor on the density at a point, m: x east, y up, z south.
    pub fn density(&self, position: DVec3) -> f64 {
        let octaves = self.octaves.iter().map(|octave| {
            let waves = octave.waves.iter();
            let sum: f64 = waves.map(|wave| libm::cos(wave.phase_at(position))).sum();
            octave.amplitude * sum - ln_mean(octave.amplitude)
        });
        libm::exp(octaves.sum())
    }

    /// Shortest wavelength of an octave along a unit vector, m, or less.
    pub(super) fn shortest_wavelength_m(&self, octave: usize, direction: DVec3) -> f64 {
        let flat = self.patches.size_m / self.patches.height_m;
        let stretched = DVec3::new(direction.x, direction.y * flat, direction.z).length();
        self.patches.size_m * libm::exp2(-(octave as f64)) / stretched
    }

    /// Typical shortest wavelength of an octave across a view, m.
    pub(super) fn wavelength_across_m(&self, octave: usize) -> f64 {
        let size_m = (self.patches.size_m * self.patches.height_m).sqrt();
        size_m * libm::exp2(-(octave as f64))
    }
}

/// Logarithm of the mean over random phases of the product of an octave's `e^(a cos phi)`.
pub(super) fn ln_mean(amplitude: f64) -> f64 {
    WAVES as f64 * libm::log(bessel_i0(amplitude))
}

/// Modified Bessel function of the first kind and order 0, by its power series, for arguments below 10.
fn bessel_i0(x: f64) -> f64 {
    let quarter = 0.25 * x * x;
    let (mut sum, mut term, mut k) = (1.0, 1.0, 1.0);
    while term > 1e-17 * sum {
        term *= quarter / (k * k);
        sum += term;
        k += 1.0;
    }
    sum
}

/// Amplitudes of the waves of each octave for a standard deviation of the factor.
fn amplitudes(strength: f64) -> [f64; OCTAVES] {
    let shares: [f64; OCTAVES] = std::array::from_fn(|k| VARIANCE_RATIO.powi(k as i32));
    let whole: f64 = shares.iter().sum();
    // A wave of amplitude a has a variance of a^2 / 2.
    let relative = shares.map(|share| (2.0 * share / whole / WAVES as f64).sqrt());
    // The mean square of the factor is 1 + strength^2.
    let wanted = libm::log1p(strength * strength);
    let mean_square = |deviation: f64| -> f64 {
        let octaves = relative.iter().map(|a| deviation * a);
        octaves.map(|a| ln_mean(2.0 * a) - 2.0 * ln_mean(a)).sum()
    };
    let (mut low, mut high) = (0.0, PI);
    for _ in 0..64 {
        let middle = 0.5 * (low + high);
        match mean_square(middle) < wanted {
            true => low = middle,
            false => high = middle,
        }
    }
    relative.map(|a| low * a)
}

#[cfg(test)]
mod tests {
    use super::*;

    fn field(strength: f64, seed: u64) -> PatchField {
        PatchField::new(&FogPatches {
            strength,
            seed,
            ..Default::default()
        })
        .unwrap()
    }

    /// Mean and mean square over seeds, at one point far away.
    #[test]
    fn densities_have_a_mean_of_one_and_the_given_deviation() {
        const SEEDS: u64 = 4000;
        let point = DVec3::new(4321.0, 7.0, -98_765.0);
        for strength in [0.2, 0.8] {
            let values: Vec<f64> = (0..SEEDS)
                .map(|seed| field(strength, seed).density(point))
                .collect();
            let moment = |power: i32| {
                let powers: Vec<f64> = values.iter().map(|v| v.powi(power)).collect();
                let mean = powers.iter().sum::<f64>() / SEEDS as f64;
                let squares: f64 = powers.iter().map(|v| (v - mean).powi(2)).sum();
                (mean, squares.sqrt() / SEEDS as f64)
            };
            for (power, expected) in [(1, 1.0), (2, 1.0 + strength * strength)] {
                let (got, error) = moment(power);
                assert!(
                    (got - expected).abs() < 4.0 * error,
                    "{power}: {got} +- {error}"
                );
            }
            assert!(values.iter().all(|v| *v > 0.0));
        }
    }

    /// Half a patch away the density is alike, ten patches away it is not; vertically the same at a third of the distance.
    #[test]
    fn patches_have_the_given_size() {
        const SEEDS: u64 = 1500;
        let correlation = |away: DVec3| {
            let pairs = (0..SEEDS).map(|seed| {
                let field = field(0.3, seed);
                (field.density(DVec3::ZERO) - 1.0) * (field.density(away) - 1.0)
            });
            pairs.sum::<f64>() / SEEDS as f64 / 0.09
        };
        for up in [false, true] {
            let away = |patches: f64| match up {
                true => DVec3::Y * (10.0 * patches),
                false => DVec3::X * (30.0 * patches),
            };
            let all = [0.1, 0.8, 10.0].map(|patches| correlation(away(patches)));
            assert!(
                all[0] > 0.7 && all[1] < 0.3 && all[2].abs() < 0.12,
                "{all:?}"
            );
        }
    }

    #[test]
    fn wind_moves_the_field() {
        let still = field(0.7, 3);
        let moved = PatchField::new(&FogPatches {
            drift_m: [12.0, -5.0],
            ..still.patches
        })
        .unwrap();
        for x in [0.0, 31.0, -800.0] {
            let point = DVec3::new(x, 2.0, 9.0);
            let shifted = point + DVec3::new(12.0, 0.0, 5.0);
            let (a, b) = (still.density(point), moved.density(shifted));
            assert!((a / b - 1.0).abs() < 1e-10, "{a} {b}");
        }
    }

    #[test]
    fn values_out_of_range_are_refused() {
        let refused = |change: fn(&mut FogPatches)| {
            let mut patches = FogPatches::default();
            change(&mut patches);
            PatchField::new(&patches).unwrap_err().to_string()
        };
        for (said, part) in [
            (refused(|p| p.strength = -0.1), "from 0 to 2"),
            (refused(|p| p.strength = f64::NAN), "from 0 to 2"),
            (refused(|p| p.size_m = 0.0), "above 0"),
            (refused(|p| p.height_m = f64::INFINITY), "above 0"),
            (refused(|p| p.drift_m[1] = f64::NAN), "finite"),
        ] {
            assert!(said.contains(part), "{said}");
        }
    }
}
