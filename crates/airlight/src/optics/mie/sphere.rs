//! A single sphere: Mie coefficients, efficiencies and scattering matrix.

use super::recurrence::{log_derivatives, riccati_bessel, terms};
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

/// The four independent elements of a sphere's scattering matrix (BH eq. 4.77), scaled so that `f11` is the phase function.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct ScatteringMatrix {
    /// Phase function for natural light, sr^-1.
    pub f11: f64,
    /// Natural light to linear polarisation: `-f12 / f11` is the degree of polarisation, positive perpendicular to the scattering
    /// plane.
    pub f12: f64,
    /// Linear polarisation at 45 degrees, and circular polarisation, to themselves.
    pub f33: f64,
    /// Circular to linear polarisation at 45 degrees.
    pub f34: f64,
}

/// Mie's `a_n` and `b_n` (`n = 1, 2 ..` at index 0, 1 ..) and sums over them.
#[derive(Clone, Debug, Default)]
pub(super) struct Coefficients {
    pub a: Vec<Complex64>,
    pub b: Vec<Complex64>,
    /// `sum (2 n + 1) (|a_n|^2 + |b_n|^2)`.
    pub scattered: f64,
    /// `sum (2 n + 1) (Re a_n - |a_n|^2 + Re b_n - |b_n|^2)`.
    pub absorbed: f64,
    scratch: Scratch,
}

#[derive(Clone, Debug, Default)]
struct Scratch {
    derivatives: Vec<Complex64>,
    psi: Vec<f64>,
    chi: Vec<f64>,
}

impl Coefficients {
    /// Computes the coefficients of a sphere, replacing the previous ones. The arguments must have been checked.
    ///
    /// With `A = D_n(m x) / m + n / x` (BH eq. 4.88), `N = A psi_n - psi_(n-1)` and `M = A chi_n - chi_(n-1)`,
    /// `a_n = N / (N - i M)`; likewise `b_n` with `B = m D_n(m x) + n / x`. Then `|a|^2 = |N|^2 / |N - i M|^2`, and
    /// `Re a - |a|^2 = -Im(N M*) / |N - i M|^2 = -Im(A) / |N - i M|^2`, because the Wronskian of `psi` and `chi` is 1.
    /// Scattering and absorption are thus sums of terms of one sign, and neither cancels the other.
    pub fn fill(&mut self, x: f64, m: Complex64) {
        let last = terms(x);
        let Scratch {
            derivatives,
            psi,
            chi,
        } = &mut self.scratch;
        log_derivatives(m * x, last, derivatives);
        riccati_bessel(x, last, psi, chi);
        self.a.clear();
        self.b.clear();
        (self.scattered, self.absorbed) = (0.0, 0.0);
        let inverse = m.inv();
        for n in 1..=last {
            let weight = (2 * n + 1) as f64;
            let ratio = n as f64 / x;
            let mut coefficient = |factor: Complex64| {
                let numerator = factor * psi[n] - psi[n - 1];
                let other = factor * chi[n] - chi[n - 1];
                let denominator = Complex64::new(numerator.re + other.im, numerator.im - other.re);
                let squared = denominator.norm_sqr();
                self.scattered += weight * numerator.norm_sqr() / squared;
                self.absorbed -= weight * factor.im / squared;
                numerator * denominator.conj() / squared
            };
            let electric = coefficient(derivatives[n] * inverse + ratio);
            let magnetic = coefficient(derivatives[n] * m + ratio);
            self.a.push(electric);
            self.b.push(magnetic);
        }
        self.absorbed = self.absorbed.max(0.0);
    }

    /// Sum over `n` of the interference terms of the mean cosine (BH, sec. 4.5): `g` is twice this divided by `scattered`.
    pub fn forward(&self) -> f64 {
        let (a, b) = (&self.a, &self.b);
        let mut sum = 0.0;
        for i in 0..a.len() {
            let n = (i + 1) as f64;
            sum += (2.0 * n + 1.0) / (n * (n + 1.0)) * (a[i] * b[i].conj()).re;
            if i + 1 < a.len() {
                sum += n * (n + 2.0) / (n + 1.0)
                    * (a[i] * a[i + 1].conj() + b[i] * b[i + 1].conj()).re;
            }
        }
        sum
    }
}

impl Sphere {
    /// Sphere with a size parameter (above 0, at most [`LARGEST_SIZE_PARAMETER`]) and an index `n + i k`.
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

impl ScatteringMatrix {
    /// The zero matrix.
    pub(super) const ZERO: Self = Self {
        f11: 0.0,
        f12: 0.0,
        f33: 0.0,
        f34: 0.0,
    };

    /// Elements `S_11, S_12, S_33, S_34` for the amplitudes.
    pub(super) fn of([s1, s2]: [Complex64; 2]) -> Self {
        let (across, along) = (s1.norm_sqr(), s2.norm_sqr());
        let mixed = s2 * s1.conj();
        Self {
            f11: 0.5 * (along + across),
            f12: 0.5 * (along - across),
            f33: mixed.re,
            f34: mixed.im,
        }
    }

    pub(super) fn scaled(self, factor: f64) -> Self {
        Self {
            f11: self.f11 * factor,
            f12: self.f12 * factor,
            f33: self.f33 * factor,
            f34: self.f34 * factor,
        }
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
