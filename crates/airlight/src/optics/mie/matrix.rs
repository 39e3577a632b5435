//! Scattering matrix of spheres.

use num_complex::Complex64;

/// The four independent elements of a sphere's scattering matrix (BH eq. 4.77), scaled so that `f11` is the phase function.
#[derive(Clone, Copy, Debug, PartialEq)]
#[non_exhaustive]
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
