//! Real spherical harmonics of fields that are mirror-symmetric about the sun's vertical plane.
//!
//! Such fields need only the cosine harmonics `Y_lm(theta, phi)` with `0 <= m <= l`, here orthonormal over the whole
//! sphere: `Y_lm = N_lm P_lm(cos theta) cos(m phi)`. They are evaluated from `mu = cos(theta)` and
//! `a = sin(theta) cos(phi)`, both polynomials of the direction's components, so no angles are needed and the zenith is not
//! a special case.

use crate::math::legendre::associated_recurrence;
use std::ops::RangeInclusive;

/// Number of harmonics of degree up to `l_max`.
const fn count(l_max: usize) -> usize {
    (l_max + 1) * (l_max + 2) / 2
}

/// Harmonics up to a degree: normalisation and recurrence coefficients.
#[derive(Clone, Debug)]
pub struct Harmonics {
    degree: usize,
    /// For each `(l, m)`: the coefficients `(p, q)` of `Y_lm = p mu Y_(l-1)m - q Y_(l-2)m`, for `l > m`.
    recurrence: Vec<(f32, f32)>,
    /// Normalised `P_mm / sin^m(theta)`.
    diagonal: Vec<f32>,
}

impl Harmonics {
    /// Harmonics up to `degree`, at most [`Harmonics::MAX_DEGREE`].
    pub fn new(degree: usize) -> Self {
        assert!(degree <= Self::MAX_DEGREE);
        let mut recurrence = vec![(0.0, 0.0); count(degree)];
        for l in 1..=degree {
            for m in 0..l {
                let (p, q) = associated_recurrence(l, m);
                recurrence[Self::index(l, m)] = (p as f32, q as f32);
            }
        }
        // N_mm P_mm / sin^m = sqrt((2 - d_m0) (2m + 1) / (4 pi (2m)!)) (2m - 1)!!
        let mut diagonal = Vec::with_capacity(degree + 1);
        let mut norm = 1.0 / (4.0 * std::f64::consts::PI);
        for m in 0..=degree {
            let mf = m as f64;
            if m > 0 {
                // (2m - 1)!!^2 / (2m)! = prod (2k - 1) / (2k)
                norm *= (2.0 * mf - 1.0) / (2.0 * mf);
            }
            let doubled = if m == 0 { 1.0 } else { 2.0 };
            diagonal.push((norm * doubled * (2.0 * mf + 1.0)).sqrt() as f32);
        }
        Self {
            degree,
            recurrence,
            diagonal,
        }
    }

    /// Largest supported degree.
    pub const MAX_DEGREE: usize = 20;
    /// Largest number of harmonics, the size of arrays for [`Harmonics::evaluate`].
    pub const MAX_COUNT: usize = count(Self::MAX_DEGREE);

    /// Index of `Y_lm` in a list of harmonics.
    #[inline(always)]
    pub const fn index(l: usize, m: usize) -> usize {
        l * (l + 1) / 2 + m
    }

    /// Number of harmonics.
    #[inline(always)]
    pub fn count(&self) -> usize {
        count(self.degree)
    }

    /// Highest degree.
    #[inline(always)]
    pub fn degree(&self) -> usize {
        self.degree
    }

    /// Indices of the harmonics of degree `l`.
    #[inline(always)]
    pub fn span(&self, l: usize) -> RangeInclusive<usize> {
        Self::index(l, 0)..=Self::index(l, l)
    }

    /// Evaluates the harmonics in the direction with `mu = cos(theta)` and `toward_sun = sin(theta) cos(phi)` into `out`.
    #[inline(always)]
    pub fn evaluate(&self, mu: f32, toward_sun: f32, out: &mut [f32]) {
        let sin2 = (1.0 - mu * mu).max(0.0);
        // sin^m cos(m phi) by the Chebyshev recurrence.
        let (mut azimuthal_below, mut azimuthal) = (toward_sun, 1.0f32);
        for m in 0..=self.degree {
            out[Self::index(m, m)] = self.diagonal[m] * azimuthal;
            let mut below = 0.0;
            let mut here = out[Self::index(m, m)];
            for l in m + 1..=self.degree {
                let (p, q) = self.recurrence[Self::index(l, m)];
                let next = p * mu * here - q * below;
                below = here;
                here = next;
                out[Self::index(l, m)] = next;
            }
            let next = if m == 0 {
                toward_sun
            } else {
                2.0 * toward_sun * azimuthal - sin2 * azimuthal_below
            };
            azimuthal_below = azimuthal;
            azimuthal = next;
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::math::legendre::legendre;
    use crate::math::quadrature::GaussRule;
    use std::f64::consts::PI;

    #[test]
    fn harmonics_are_orthonormal_over_the_sphere() {
        let l_max = 10;
        let harmonics = Harmonics::new(l_max);
        let n = harmonics.count();
        let mut gram = vec![0.0f64; n * n];
        let azimuths = 32;
        for (mu, w) in GaussRule::new(16).on(-1.0, 1.0) {
            for k in 0..azimuths {
                let phi = 2.0 * PI * (k as f64 + 0.3) / f64::from(azimuths);
                let mut y = vec![0.0; n];
                let a = (1.0 - mu * mu).sqrt() * phi.cos();
                harmonics.evaluate(mu as f32, a as f32, &mut y);
                for i in 0..n {
                    for j in 0..n {
                        gram[i * n + j] +=
                            f64::from(y[i]) * f64::from(y[j]) * w * 2.0 * PI / f64::from(azimuths);
                    }
                }
            }
        }
        for i in 0..n {
            for j in 0..n {
                let want = if i == j { 1.0 } else { 0.0 };
                assert!(
                    (gram[i * n + j] - want).abs() < 1e-5,
                    "{i} {j} {}",
                    gram[i * n + j]
                );
            }
        }
    }

    #[test]
    fn harmonics_satisfy_the_addition_theorem() {
        // sum_m Y_lm(a) Y_lm(b) = (2l + 1) / (4 pi) P_l(a.b), for both directions in the sun's plane.
        let harmonics = Harmonics::new(8);
        let (mut ya, mut yb, mut p) = ([0.0; 45], [0.0; 45], [0.0; 9]);
        let (ta, tb) = (0.7f64, 1.9f64);
        harmonics.evaluate(ta.cos() as f32, ta.sin() as f32, &mut ya);
        harmonics.evaluate(tb.cos() as f32, tb.sin() as f32, &mut yb);
        legendre((ta - tb).cos(), &mut p);
        for l in 0..=8 {
            let sum: f32 = (0..=l)
                .map(|m| ya[Harmonics::index(l, m)] * yb[Harmonics::index(l, m)])
                .sum();
            let want = (2 * l + 1) as f64 / (4.0 * PI) * p[l];
            assert!(
                (f64::from(sum) - want).abs() < 1e-5,
                "l = {l}: {sum} against {want}"
            );
        }
    }
}
