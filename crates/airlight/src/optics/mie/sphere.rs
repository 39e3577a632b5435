//! A single sphere: efficiencies, amplitudes and scattering matrix.

use super::coefficients::Coefficients;
use super::matrix::ScatteringMatrix;
use super::{LARGEST_INDEX, LARGEST_SIZE_PARAMETER, MieError, angular};
use num_complex::Complex64;
use std::f64::consts::PI;

/// A homogeneous sphere in a plane wave.
#[derive(Clone, Debug)]
pub struct Sphere {
    size_parameter: f64,
    coefficients: Coefficients,
}

/// Efficiencies, the cross-sections divided by the geometric cross-section `pi r^2`, and the mean cosine of scattering.
#[derive(Clone, Copy, Debug, PartialEq)]
#[non_exhaustive]
pub struct Efficiencies {
    /// Extinction: scattering plus absorption.
    pub extinction: f64,
    /// Scattering.
    pub scattering: f64,
    /// Absorption.
    pub absorption: f64,
    /// Radar backscattering: `4 pi` times the differential scattering cross-section at 180 degrees.
    pub backscattering: f64,
    /// Mean cosine of the scattering angle `g`.
    pub asymmetry: f64,
}

impl Sphere {
    /// Sphere with a size parameter (above 0, at most 1e5) and an index `n + i k`.
    ///
    /// For size parameters from 0.001 to 20000, transparent or absorbing, efficiencies are accurate to 1e-13 (relative; including
    /// absorption, however small) and amplitudes to 3e-11 (test `corners_agree_with_sixty_digits`). Time and memory grow with
    /// the size parameter.
    ///
    /// # Errors
    /// [`MieError`] if an argument is outside its domain.
    pub fn new(size_parameter: f64, index: Complex64) -> Result<Self, MieError> {
        if !(size_parameter > 0.0 && size_parameter <= LARGEST_SIZE_PARAMETER) {
            return Err(MieError::SizeParameter(size_parameter));
        }
        check_index(index)?;
        let mut coefficients = Coefficients::default();
        coefficients.fill(size_parameter, index);
        Ok(Self {
            size_parameter,
            coefficients,
        })
    }

    /// Efficiencies and asymmetry (BH eqs. 4.61, 4.62 and sec. 4.5).
    pub fn efficiencies(&self) -> Efficiencies {
        let Coefficients {
            a,
            b,
            scattered,
            absorbed,
            ..
        } = &self.coefficients;
        let scale = 2.0 / (self.size_parameter * self.size_parameter);
        let mut back = Complex64::ZERO;
        for i in 0..a.len() {
            let weight = (2 * i + 3) as f64;
            back += (a[i] - b[i]) * if i % 2 == 0 { -weight } else { weight };
        }
        Efficiencies {
            extinction: scale * (scattered + absorbed),
            scattering: scale * scattered,
            absorption: scale * absorbed,
            backscattering: 0.5 * scale * back.norm_sqr(),
            asymmetry: 2.0 * self.coefficients.forward() / scattered,
        }
    }

    /// Amplitudes `S_1` (perpendicular to the scattering plane) and `S_2` (parallel to it) at the cosine of the scattering angle
    /// (BH eq. 4.74).
    pub fn amplitudes(&self, cos_angle: f64) -> [Complex64; 2] {
        angular::amplitudes(&self.coefficients, cos_angle)
    }

    /// Scattering matrix at the cosine of the scattering angle.
    pub fn matrix(&self, cos_angle: f64) -> ScatteringMatrix {
        let amplitudes = self.amplitudes(cos_angle);
        ScatteringMatrix::of(amplitudes).scaled(0.5 / (PI * self.coefficients.scattered))
    }

    /// Phase function for natural light, sr^-1, normalised to 1 over the sphere.
    pub fn phase(&self, cos_angle: f64) -> f64 {
        self.matrix(cos_angle).f11
    }
}

/// # Errors
/// [`MieError::Index`] for an unsupported index.
pub(super) fn check_index(index: Complex64) -> Result<(), MieError> {
    let right = index.re >= 0.0 && index.im >= 0.0 && index.norm() > 0.0;
    match right && index.norm() <= LARGEST_INDEX {
        true => Ok(()),
        false => Err(MieError::Index {
            real: index.re,
            imaginary: index.im,
        }),
    }
}

#[cfg(test)]
mod tests;
