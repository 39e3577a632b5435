//! Mie coefficients of a sphere.

use super::recurrence::{log_derivatives, riccati_bessel, terms};
use num_complex::Complex64;

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
