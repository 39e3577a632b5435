//! Phase functions: the angular distribution of scattered light.
//!
//! All are densities over the sphere, sr^-1, with integral 1, as functions of the cosine of the scattering angle, which is
//! 1 for forward scattering.

mod sample;

pub use sample::PhaseSampler;

use super::phase_error::PhaseError;
use super::rayleigh;
use super::tabulated::TabulatedPhase;
use crate::math::simd::vectorized;
use crate::spectrum::Spectrum;
use std::f64::consts::PI;

/// A phase function. The constructors check their parameters; [`PhaseFunction::validate`] checks a value built from its
/// variants.
#[derive(Clone, Debug, PartialEq)]
#[non_exhaustive]
pub enum PhaseFunction {
    /// Isotropic scattering: `1 / (4 pi)`.
    Isotropic,
    /// Rayleigh scattering by molecules: `3 / (16 pi (1 + 2 gamma)) (1 + 3 gamma + (1 - gamma) mu^2)`, `gamma = rho / (2 - rho)`
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
    /// Draine (Astrophys. J. 598, 1017, 2003, eq. 6): Henyey-Greenstein times `1 + alpha mu^2`, normalised. Equal to
    /// Henyey-Greenstein for `alpha = 0`, Cornette-Shanks for `alpha = 1`, Rayleigh for `g = 0`, `alpha = 1`.
    Draine {
        /// Parameter, `-1 < g < 1`.
        g: f64,
        /// Weight of the squared cosine, `>= 0`.
        alpha: f64,
    },
    /// A weighted sum of phase functions; the weights sum to 1.
    Mixture(Vec<(f64, PhaseFunction)>),
    /// A measured or computed table by angle and wavelength.
    Tabulated(TabulatedPhase),
}

/// Depolarization of light scattered by anisotropic molecules.
#[derive(Clone, Copy, Debug, PartialEq)]
#[non_exhaustive]
pub enum Depolarization {
    /// Isotropic molecules: `3 / (16 pi) (1 + mu^2)`.
    None,
    /// A constant depolarization ratio for natural light, in `[0, 6/7)`.
    Factor(f64),
    /// The ratio of dry air, by wavelength, from its King factor ([`rayleigh::king_factor`]).
    Air,
}

impl Depolarization {
    /// Depolarization ratio `rho_n` for natural light at a wavelength in nm.
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

impl PhaseFunction {
    /// Henyey-Greenstein phase function with mean cosine `g`.
    ///
    /// # Errors
    /// [`PhaseError::Asymmetry`] unless `-1 < g < 1`.
    pub fn henyey_greenstein(g: f64) -> Result<Self, PhaseError> {
        Self::HenyeyGreenstein { g }.validated()
    }

    /// Cornette-Shanks phase function with parameter `g`.
    ///
    /// # Errors
    /// [`PhaseError::Asymmetry`] unless `-1 < g < 1`.
    pub fn cornette_shanks(g: f64) -> Result<Self, PhaseError> {
        Self::CornetteShanks { g }.validated()
    }

    /// Draine's phase function with parameters `g` and `alpha`.
    ///
    /// # Errors
    /// [`PhaseError::Asymmetry`] unless `-1 < g < 1`, [`PhaseError::Alpha`] unless `alpha >= 0`.
    pub fn draine(g: f64, alpha: f64) -> Result<Self, PhaseError> {
        Self::Draine { g, alpha }.validated()
    }

    /// Rayleigh phase function with a constant depolarization ratio.
    ///
    /// # Errors
    /// [`PhaseError::Depolarization`] unless the ratio lies in `[0, 6/7)`.
    pub fn rayleigh(depolarization_ratio: f64) -> Result<Self, PhaseError> {
        Self::Rayleigh(Depolarization::Factor(depolarization_ratio)).validated()
    }

    /// Weighted sum of phase functions.
    ///
    /// # Errors
    /// [`PhaseError::Weight`]; [`PhaseError::WeightSum`] if the sum of the weights differs from 1 by more than 1e-9; the error of
    /// an invalid part.
    pub fn mixture(parts: Vec<(f64, PhaseFunction)>) -> Result<Self, PhaseError> {
        Self::Mixture(parts).validated()
    }

    fn validated(self) -> Result<Self, PhaseError> {
        self.validate()?;
        Ok(self)
    }

    /// Checks the parameters.
    ///
    /// # Errors
    /// The error of the first parameter outside its domain.
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

    /// Value in sr^-1 at the cosine of the scattering angle, in `[-1, 1]`.
    ///
    /// The relative error of the closed forms is a few 1e-16, also near the forward peak as `g` approaches 1: the denominator
    /// is computed as `(1 - g)^2 + 2 g (1 - mu)`, without cancellation. (What remains is the rounding of the cosine itself,
    /// 1e-16 in `1 - mu`.)
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

    /// [`Self::evaluate`] at N wavelengths (nm) in single precision.
    #[inline]
    pub(crate) fn in_lanes<const N: usize>(
        &self,
        cos_angle: f64,
        wavelengths_nm: &[f64; N],
    ) -> Spectrum<N> {
        match self {
            Self::Tabulated(table) => Spectrum(
                table
                    .evaluate_all(cos_angle, wavelengths_nm)
                    .map(|p| p as f32),
            ),
            phase if phase.depends_on_wavelength() => {
                Spectrum(wavelengths_nm.map(|nm| phase.evaluate(cos_angle, nm) as f32))
            }
            phase => Spectrum::splat(phase.evaluate(cos_angle, wavelengths_nm[0]) as f32),
        }
    }

    /// [`Self::in_lanes`] at several cosines: for each wavelength, the values at the cosines.
    pub(crate) fn along_rays<const R: usize, const N: usize>(
        &self,
        cos_angles: &[f64; R],
        wavelengths_nm: &[f64; N],
    ) -> [Spectrum<R>; N] {
        let narrow = |values: [f64; R]| Spectrum(values.map(|p| p as f32));
        if self.depends_on_wavelength() {
            let by_ray = cos_angles.map(|cosine| self.in_lanes(cosine, wavelengths_nm));
            return std::array::from_fn(|lane| Spectrum::from_fn(|ray| by_ray[ray][lane]));
        }
        [narrow(self.at_all(cos_angles, wavelengths_nm[0])); N]
    }

    /// [`Self::evaluate`] at several cosines.
    fn at_all<const R: usize>(&self, cos_angles: &[f64; R], wavelength_nm: f64) -> [f64; R] {
        let mut out = [0.0; R];
        match self {
            Self::HenyeyGreenstein { g } => vectorized(
                #[inline(always)]
                || {
                    for (out, mu) in out.iter_mut().zip(cos_angles) {
                        *out = henyey_greenstein(*g, *mu);
                    }
                },
            ),
            Self::Draine { g, alpha } => vectorized(
                #[inline(always)]
                || {
                    for (out, mu) in out.iter_mut().zip(cos_angles) {
                        *out = draine(*g, *alpha, *mu);
                    }
                },
            ),
            Self::Mixture(parts) => {
                for (weight, part) in parts {
                    let values = part.at_all(cos_angles, wavelength_nm);
                    for (out, value) in out.iter_mut().zip(values) {
                        *out += weight * value;
                    }
                }
            }
            other => {
                for (out, mu) in out.iter_mut().zip(cos_angles) {
                    *out = other.evaluate(*mu, wavelength_nm);
                }
            }
        }
        out
    }

    /// Legendre moments `chi_l`, `l = 0 .. count`, of `p(mu) = sum (2 l + 1) / (4 pi) chi_l P_l(mu)`; `chi_0 = 1` and `chi_1`
    /// is the mean cosine.
    ///
    /// Closed forms, except for tables, which use Gauss-Legendre quadrature in panels that resolve both the table and `P_l`
    /// (absolute error below 1e-9).
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

    /// Mean cosine of the scattering angle.
    pub fn asymmetry(&self, wavelength_nm: f64) -> f64 {
        self.legendre_moments(2, wavelength_nm)[1]
    }

    /// True if the function depends on wavelength.
    pub(crate) fn depends_on_wavelength(&self) -> bool {
        match self {
            Self::Rayleigh(depolarization) => *depolarization == Depolarization::Air,
            Self::Mixture(parts) => parts.iter().any(|(_, part)| part.depends_on_wavelength()),
            Self::Tabulated(table) => table.wavelengths_nm().len() > 1,
            _ => false,
        }
    }
}

/// Henyey-Greenstein phase function without cancellation at either peak.
#[inline(always)]
fn henyey_greenstein(g: f64, mu: f64) -> f64 {
    let a = g.abs();
    let from_peak = 1.0 - mu.clamp(-1.0, 1.0).copysign(mu * g);
    let d = (1.0 - a) * (1.0 - a) + 2.0 * a * from_peak;
    (1.0 - a) * (1.0 + a) / (4.0 * PI * d * d.sqrt())
}

#[inline(always)]
fn draine(g: f64, alpha: f64, mu: f64) -> f64 {
    let norm = 1.0 + alpha * (1.0 + 2.0 * g * g) / 3.0;
    henyey_greenstein(g, mu) * (1.0 + alpha * mu * mu) / norm
}

/// Legendre moments of Draine's function: those of Henyey-Greenstein, `g^l`, with the recurrence of `mu^2 P_l` applied.
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
