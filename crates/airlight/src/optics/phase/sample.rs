//! Exact sampling of directions from phase functions: the density of the samples is [`PhaseFunction::evaluate`].

use super::{Depolarization, PhaseFunction};
use crate::optics::TabulatedPhase;

/// Sampler of scattering-angle cosines from a phase function at one wavelength.
///
/// Isotropic, Rayleigh and Henyey-Greenstein invert their cumulative distributions in closed form, tables numerically (to
/// 1e-9); Cornette-Shanks and Draine use rejection sampling from Henyey-Greenstein.
#[derive(Clone, Debug)]
pub enum PhaseSampler {
    /// Isotropic scattering.
    Isotropic,
    /// Rayleigh scattering: solves `mu^3 + 3 A mu = B`, where `B` is uniform.
    Rayleigh {
        /// The coefficient `A = (1 + 3 gamma) / (1 - gamma)`.
        linear: f64,
        /// The largest `B`, at `mu = 1`: `(4 + 8 gamma) / (1 - gamma)`.
        end: f64,
    },
    /// Henyey-Greenstein times `1 + alpha mu^2` (Henyey-Greenstein for `alpha = 0`).
    Draine {
        /// Asymmetry parameter of the Henyey-Greenstein factor.
        g: f64,
        /// Weight of the squared cosine.
        alpha: f64,
    },
    /// A table, and the wavelength in nm.
    Table(TabulatedPhase, f64),
    /// Running sums of the weights of a mixture, and its parts.
    Mixture(Vec<(f64, PhaseSampler)>),
}

impl PhaseSampler {
    /// Prepares sampling of `phase` at a wavelength in nm.
    pub fn new(phase: &PhaseFunction, wavelength_nm: f64) -> Self {
        match phase {
            PhaseFunction::Isotropic => Self::Isotropic,
            PhaseFunction::Rayleigh(depolarization) => {
                Self::rayleigh(*depolarization, wavelength_nm)
            }
            PhaseFunction::HenyeyGreenstein { g } => Self::Draine { g: *g, alpha: 0.0 },
            PhaseFunction::CornetteShanks { g } => Self::Draine { g: *g, alpha: 1.0 },
            PhaseFunction::Draine { g, alpha } => Self::Draine {
                g: *g,
                alpha: *alpha,
            },
            PhaseFunction::Tabulated(table) => Self::Table(table.clone(), wavelength_nm),
            PhaseFunction::Mixture(parts) => {
                let mut running = 0.0;
                Self::Mixture(
                    parts
                        .iter()
                        .map(|(weight, part)| {
                            running += weight;
                            (running, Self::new(part, wavelength_nm))
                        })
                        .collect(),
                )
            }
        }
    }

    fn rayleigh(depolarization: Depolarization, wavelength_nm: f64) -> Self {
        let gamma = depolarization.gamma(wavelength_nm);
        Self::Rayleigh {
            linear: (1.0 + 3.0 * gamma) / (1.0 - gamma),
            end: (4.0 + 8.0 * gamma) / (1.0 - gamma),
        }
    }

    /// Draws the cosine of a scattering angle; `random` returns independent uniform numbers in `(0, 1)`.
    pub fn sample(&self, random: &mut impl FnMut() -> f64) -> f64 {
        match self {
            Self::Isotropic => 2.0 * random() - 1.0,
            // The cumulative distribution of (1 + 3 gamma) + (1 - gamma) mu^2 is a cubic with one real root:
            // mu = 2 sqrt(A) sinh(asinh(B / (2 A^(3/2))) / 3).
            Self::Rayleigh { linear, end } => {
                let right = end * (2.0 * random() - 1.0);
                let root = linear.sqrt();
                let third = (0.5 * right / (linear * root)).asinh() / 3.0;
                (2.0 * root * third.sinh()).clamp(-1.0, 1.0)
            }
            Self::Draine { g, alpha } => loop {
                let mu = henyey_greenstein(*g, random());
                if *alpha == 0.0 || random() * (1.0 + alpha) < 1.0 + alpha * mu * mu {
                    return mu;
                }
            },
            Self::Table(table, wavelength_nm) => table.sample(random(), *wavelength_nm),
            Self::Mixture(parts) => {
                let last = parts.len() - 1;
                let choice = random() * parts[last].0;
                let part = parts.partition_point(|(running, _)| *running <= choice);
                parts[part.min(last)].1.sample(random)
            }
        }
    }
}

/// Cosine at which the cumulative distribution of Henyey-Greenstein is `xi` (Witt, Astrophys. J. Suppl. 35, 1, 1977),
/// expanded so that nothing cancels as `g` goes to 0.
fn henyey_greenstein(g: f64, xi: f64) -> f64 {
    let s = 2.0 * xi - 1.0;
    let d = 1.0 + g * s;
    let numerator = 2.0 * s + g * (s * s + 3.0) + g * g * (2.0 * s + g * (s * s - 1.0));
    (numerator / (2.0 * d * d)).clamp(-1.0, 1.0)
}

#[cfg(test)]
mod tests {
    use super::super::tests::kinds;
    use super::*;
    use crate::math::quadrature::GaussRule;
    use crate::math::random::Random;
    use std::f64::consts::PI;

    /// The Legendre moments of the samples match those of the function, and their histogram over 40 bins matches its integral:
    /// chi squared within the 99.99 % limit of 39 degrees of freedom.
    #[test]
    fn samples_follow_the_phase_function() {
        const DRAWS: usize = 200_000;
        const BINS: usize = 40;
        let breaks: Vec<f64> = (1..360)
            .map(|i| (0.5 * f64::from(i)).to_radians().cos())
            .collect();
        for (number, phase) in kinds().into_iter().enumerate() {
            for nm in [400.0, 520.0] {
                let sampler = PhaseSampler::new(&phase, nm);
                let mut random = Random::new(7, number as u64, nm as u64);
                let mut counts = [0.0f64; BINS];
                let mut sums = [0.0f64; 4];
                for _ in 0..DRAWS {
                    let mu = sampler.sample(&mut || random.unit());
                    assert!((-1.0..=1.0).contains(&mu));
                    counts[(((mu + 1.0) * 0.5 * BINS as f64) as usize).min(BINS - 1)] += 1.0;
                    let (mut before, mut now) = (1.0, mu);
                    for (l, sum) in (1..).zip(&mut sums) {
                        *sum += now;
                        let x = f64::from(l);
                        (before, now) =
                            (now, ((2.0 * x + 1.0) * mu * now - x * before) / (x + 1.0));
                    }
                }
                let chi: f64 = (0..BINS)
                    .map(|bin| {
                        let edge = |k: usize| 2.0 * k as f64 / BINS as f64 - 1.0;
                        let share = 2.0
                            * PI
                            * GaussRule::new(16).integrate_between(
                                edge(bin),
                                edge(bin + 1),
                                &breaks,
                                |mu| phase.evaluate(mu, nm),
                            );
                        let expected = share * DRAWS as f64;
                        (counts[bin] - expected).powi(2) / expected
                    })
                    .sum();
                assert!(chi < 83.0, "{phase:?} at {nm} nm: chi squared {chi}");
                let moments = phase.legendre_moments(5, nm);
                for (got, want) in sums.iter().zip(&moments[1..]) {
                    let got = got / DRAWS as f64;
                    // No Legendre polynomial exceeds 1 in magnitude.
                    let sigma = (1.0 / DRAWS as f64).sqrt();
                    assert!(
                        (got - want).abs() < 4.5 * sigma,
                        "{phase:?}: {got} for {want}"
                    );
                }
            }
        }
    }
}
