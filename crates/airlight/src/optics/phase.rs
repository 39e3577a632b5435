//! Phase functions: where a particle sends the light that it scatters.
//!
//! All are densities over the sphere, sr^-1, whose integral is 1; the cosine is 1 for light that goes straight on.

mod sample;

pub use sample::PhaseSampler;

use super::rayleigh;
use super::tabulated::TabulatedPhase;
use std::f64::consts::PI;

/// A phase function. The checked constructors refuse what the variants cannot mean; [`PhaseFunction::validate`] checks
/// one built by hand.
#[derive(Clone, Debug, PartialEq)]
pub enum PhaseFunction {
    /// The same in all directions: `1 / (4 pi)`.
    Isotropic,
    /// Molecules: `3 / (16 pi (1 + 2 gamma)) (1 + 3 gamma + (1 - gamma) mu^2)`, `gamma = rho / (2 - rho)`
    /// (Bucholtz, Appl. Opt. 34, 2765, 1995, eqs. 10 and 12).
    Rayleigh(Depolarization),
    /// Henyey & Greenstein (1941): `(1 - g^2) / (4 pi (1 + g^2 - 2 g mu)^(3/2))`, mean cosine `g`.
    HenyeyGreenstein {
        /// Mean cosine, `-1 < g < 1`.
        g: f64,
    },
    /// Cornette & Shanks (Appl. Opt. 31, 3152, 1992, eq. 8): Henyey-Greenstein times `1 + mu^2`, normalised.
    CornetteShanks {
        /// Parameter, `-1 < g < 1`; the mean cosine is `3 g (4 + g^2) / (5 (2 + g^2))`.
        g: f64,
    },
    /// Draine (Astrophys. J. 598, 1017, 2003, eq. 6): Henyey-Greenstein times `1 + alpha mu^2`, normalised. It is
    /// Henyey-Greenstein for `alpha = 0`, Cornette-Shanks for `alpha = 1`, Rayleigh for `g = 0`, `alpha = 1`.
    Draine {
        /// Parameter, `-1 < g < 1`.
        g: f64,
        /// Weight of the cosine squared, `>= 0`.
        alpha: f64,
    },
    /// Several, each with its weight; the weights sum to 1.
    Mixture(Vec<(f64, PhaseFunction)>),
    /// Measured or computed, by angle and wavelength.
    Tabulated(TabulatedPhase),
}

/// How far molecules depart from spheres.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum Depolarization {
    /// Isotropic molecules: `3 / (16 pi) (1 + mu^2)`.
    None,
    /// A depolarization ratio for natural light, in `[0, 6/7)`.
    Factor(f64),
    /// That of dry air, by wavelength, from its King factor ([`rayleigh::king_factor`]).
    Air,
}

impl Depolarization {
    /// The depolarization ratio `rho_n` at a wavelength.
    pub fn ratio(self, wavelength_nm: f64) -> f64 {
        match self {
            Self::None => 0.0,
            Self::Factor(ratio) => ratio,
            Self::Air => rayleigh::depolarization_of_king_factor(rayleigh::king_factor(
                wavelength_nm,
                rayleigh::CO2_PPM,
            )),
        }
    }

    fn gamma(self, wavelength_nm: f64) -> f64 {
        let ratio = self.ratio(wavelength_nm);
        ratio / (2.0 - ratio)
    }
}

/// Why numbers do not make a phase function.
#[derive(Clone, Debug, PartialEq, thiserror::Error)]
pub enum PhaseError {
    /// The asymmetry parameter is out of range.
    #[error("the asymmetry parameter g must lie strictly between -1 and 1, got {0}")]
    Asymmetry(f64),
    /// Draine's alpha is out of range.
    #[error("alpha must be finite and not negative, got {0}")]
    Alpha(f64),
    /// The depolarization ratio is out of range.
    #[error("the depolarization ratio must lie in [0, 6/7), got {0}")]
    Depolarization(f64),
    /// A mixture without parts, or with a weight that is negative or not finite.
    #[error(
        "a mixture needs at least one part, with finite weights not below 0; part {index} has weight {weight}"
    )]
    Weight {
        /// Which part, counted from 0.
        index: usize,
        /// Its weight (not a number where there are no parts).
        weight: f64,
    },
    /// The weights do not sum to 1.
    #[error("the weights of a mixture must sum to 1, got {0}")]
    WeightSum(f64),
    /// A table whose angles do not run from 0 to 180 degrees, strictly increasing.
    #[error("angles must rise strictly from 0 to 180 degrees: entry {index} is {value}")]
    Angles {
        /// Which entry, counted from 0.
        index: usize,
        /// Its angle, degrees.
        value: f64,
    },
    /// A table whose wavelengths are not positive and strictly increasing.
    #[error("wavelengths must be positive and strictly increasing: entry {index} is {value} nm")]
    Wavelengths {
        /// Which entry, counted from 0.
        index: usize,
        /// Its wavelength, nm.
        value: f64,
    },
    /// A table whose number of values is wrong.
    #[error("a table of {wavelengths} wavelengths and {angles} angles needs {expected} values, got {got}", expected = wavelengths * angles)]
    Length {
        /// Number of wavelengths.
        wavelengths: usize,
        /// Number of angles.
        angles: usize,
        /// Number of values given.
        got: usize,
    },
    /// An element of a scattering matrix that none has.
    #[error(
        "elements of a scattering matrix over the phase function must lie in [-1, 1]: of entry {index} one is {value}"
    )]
    Matrix {
        /// Which entry, counted from 0, wavelength by wavelength.
        index: usize,
        /// Its value.
        value: f64,
    },
    /// A value that is not positive and finite.
    #[error("tabulated values must be positive and finite: entry {index} is {value}")]
    Value {
        /// Which entry, counted from 0, wavelength by wavelength.
        index: usize,
        /// Its value.
        value: f64,
    },
}

impl PhaseFunction {
    /// Henyey-Greenstein.
    ///
    /// # Errors
    /// [`PhaseError::Asymmetry`] unless `-1 < g < 1`.
    pub fn henyey_greenstein(g: f64) -> Result<Self, PhaseError> {
        Self::HenyeyGreenstein { g }.validated()
    }

    /// Cornette-Shanks.
    ///
    /// # Errors
    /// [`PhaseError::Asymmetry`] unless `-1 < g < 1`.
    pub fn cornette_shanks(g: f64) -> Result<Self, PhaseError> {
        Self::CornetteShanks { g }.validated()
    }

    /// Draine.
    ///
    /// # Errors
    /// [`PhaseError::Asymmetry`] unless `-1 < g < 1`, [`PhaseError::Alpha`] unless `alpha >= 0`.
    pub fn draine(g: f64, alpha: f64) -> Result<Self, PhaseError> {
        Self::Draine { g, alpha }.validated()
    }

    /// Rayleigh with a constant depolarization ratio.
    ///
    /// # Errors
    /// [`PhaseError::Depolarization`] unless it lies in `[0, 6/7)`.
    pub fn rayleigh(depolarization_ratio: f64) -> Result<Self, PhaseError> {
        Self::Rayleigh(Depolarization::Factor(depolarization_ratio)).validated()
    }

    /// A mixture of phase functions.
    ///
    /// # Errors
    /// [`PhaseError::Weight`] or [`PhaseError::WeightSum`] (beyond 1e-9), or what a part is refused for.
    pub fn mixture(parts: Vec<(f64, PhaseFunction)>) -> Result<Self, PhaseError> {
        Self::Mixture(parts).validated()
    }

    fn validated(self) -> Result<Self, PhaseError> {
        self.validate()?;
        Ok(self)
    }

    /// Checks the parameters of a phase function built by hand.
    ///
    /// # Errors
    /// The first parameter out of its domain.
    pub fn validate(&self) -> Result<(), PhaseError> {
        let asymmetry = |g: f64| match g.abs() < 1.0 {
            true => Ok(()),
            false => Err(PhaseError::Asymmetry(g)),
        };
        match self {
            Self::Isotropic | Self::Tabulated(_) => Ok(()),
            Self::Rayleigh(Depolarization::Factor(ratio)) => match (0.0..6.0 / 7.0).contains(ratio)
            {
                true => Ok(()),
                false => Err(PhaseError::Depolarization(*ratio)),
            },
            Self::Rayleigh(_) => Ok(()),
            Self::HenyeyGreenstein { g } | Self::CornetteShanks { g } => asymmetry(*g),
            Self::Draine { g, alpha } => {
                asymmetry(*g)?;
                match alpha.is_finite() && *alpha >= 0.0 {
                    true => Ok(()),
                    false => Err(PhaseError::Alpha(*alpha)),
                }
            }
            Self::Mixture(parts) => {
                if parts.is_empty() {
                    return Err(PhaseError::Weight {
                        index: 0,
                        weight: f64::NAN,
                    });
                }
                for (index, (weight, part)) in parts.iter().enumerate() {
                    if !(weight.is_finite() && *weight >= 0.0) {
                        return Err(PhaseError::Weight {
                            index,
                            weight: *weight,
                        });
                    }
                    part.validate()?;
                }
                let sum: f64 = parts.iter().map(|part| part.0).sum();
                match (sum - 1.0).abs() < 1e-9 {
                    true => Ok(()),
                    false => Err(PhaseError::WeightSum(sum)),
                }
            }
        }
    }

    /// The phase function at the cosine of the scattering angle, in `[-1, 1]`, sr^-1.
    ///
    /// Relative error a few 1e-16 for the closed forms, also near the forward peak as `g` goes to 1: the denominator
    /// is formed as `(1 - g)^2 + 2 g (1 - mu)`, in which nothing cancels. (What remains is the rounding of the cosine
    /// itself, 1e-16 in `1 - mu`.)
    pub fn evaluate(&self, cos_angle: f64, wavelength_nm: f64) -> f64 {
        match self {
            Self::Isotropic => 0.25 / PI,
            Self::Rayleigh(depolarization) => {
                let gamma = depolarization.gamma(wavelength_nm);
                3.0 / (16.0 * PI * (1.0 + 2.0 * gamma))
                    * (1.0 + 3.0 * gamma + (1.0 - gamma) * cos_angle * cos_angle)
            }
            Self::HenyeyGreenstein { g } => henyey_greenstein(*g, cos_angle),
            Self::CornetteShanks { g } => draine(*g, 1.0, cos_angle),
            Self::Draine { g, alpha } => draine(*g, *alpha, cos_angle),
            Self::Mixture(parts) => parts
                .iter()
                .map(|(weight, part)| weight * part.evaluate(cos_angle, wavelength_nm))
                .sum(),
            Self::Tabulated(table) => table.evaluate(cos_angle, wavelength_nm),
        }
    }

    /// The Legendre moments `chi_l`, `l = 0 .. count`, of `p(mu) = sum (2 l + 1) / (4 pi) chi_l P_l(mu)`; `chi_0 = 1`
    /// and `chi_1` is the mean cosine.
    ///
    /// Closed forms, except for tables (Gauss-Legendre quadrature in panels that resolve both the table and `P_l`;
    /// absolute error below 1e-9).
    pub fn legendre_moments(&self, count: usize, wavelength_nm: f64) -> Vec<f64> {
        match self {
            Self::Isotropic => (0..count).map(|l| if l == 0 { 1.0 } else { 0.0 }).collect(),
            Self::Rayleigh(depolarization) => {
                let gamma = depolarization.gamma(wavelength_nm);
                let second = (1.0 - gamma) / (10.0 * (1.0 + 2.0 * gamma));
                (0..count)
                    .map(|l| match l {
                        0 => 1.0,
                        2 => second,
                        _ => 0.0,
                    })
                    .collect()
            }
            Self::HenyeyGreenstein { g } => draine_moments(*g, 0.0, count),
            Self::CornetteShanks { g } => draine_moments(*g, 1.0, count),
            Self::Draine { g, alpha } => draine_moments(*g, *alpha, count),
            Self::Mixture(parts) => {
                let mut sum = vec![0.0; count];
                for (weight, part) in parts {
                    for (total, moment) in sum
                        .iter_mut()
                        .zip(part.legendre_moments(count, wavelength_nm))
                    {
                        *total += weight * moment;
                    }
                }
                sum
            }
            Self::Tabulated(table) => table.legendre_moments(count, wavelength_nm),
        }
    }

    /// The mean cosine of the scattering angle.
    pub fn asymmetry(&self, wavelength_nm: f64) -> f64 {
        self.legendre_moments(2, wavelength_nm)[1]
    }

    /// Whether the wavelength makes a difference.
    pub fn depends_on_wavelength(&self) -> bool {
        match self {
            Self::Rayleigh(depolarization) => *depolarization == Depolarization::Air,
            Self::Mixture(parts) => parts.iter().any(|(_, part)| part.depends_on_wavelength()),
            Self::Tabulated(table) => table.wavelengths_nm().len() > 1,
            _ => false,
        }
    }
}

/// Henyey-Greenstein without cancellation at either peak.
fn henyey_greenstein(g: f64, mu: f64) -> f64 {
    let a = g.abs();
    let from_peak = 1.0 - mu.clamp(-1.0, 1.0).copysign(mu * g);
    let d = (1.0 - a) * (1.0 - a) + 2.0 * a * from_peak;
    (1.0 - a) * (1.0 + a) / (4.0 * PI * d * d.sqrt())
}

fn draine(g: f64, alpha: f64, mu: f64) -> f64 {
    let norm = 1.0 + alpha * (1.0 + 2.0 * g * g) / 3.0;
    henyey_greenstein(g, mu) * (1.0 + alpha * mu * mu) / norm
}

/// Moments of Draine's function: those of Henyey-Greenstein, `g^l`, sent through the recurrence of `mu^2 P_l`.
fn draine_moments(g: f64, alpha: f64, count: usize) -> Vec<f64> {
    let norm = 1.0 + alpha * (1.0 + 2.0 * g * g) / 3.0;
    (0..count)
        .map(|l| {
            let power = g.powi(l as i32);
            if alpha == 0.0 {
                return power;
            }
            let x = l as f64;
            let up = (x + 1.0) * (x + 2.0) / ((2.0 * x + 1.0) * (2.0 * x + 3.0));
            let below = x * x / ((2.0 * x + 1.0) * (2.0 * x - 1.0));
            let same = (x + 1.0) * (x + 1.0) / ((2.0 * x + 1.0) * (2.0 * x + 3.0)) + below;
            let down = match l {
                0 | 1 => 0.0,
                _ => x * (x - 1.0) / ((2.0 * x + 1.0) * (2.0 * x - 1.0)) * g.powi(l as i32 - 2),
            };
            (power + alpha * (up * power * g * g + same * power + down)) / norm
        })
        .collect()
}

#[cfg(test)]
mod tests;
