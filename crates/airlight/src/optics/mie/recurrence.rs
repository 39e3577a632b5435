//! Riccati-Bessel functions by stable recurrences.

use num_complex::Complex64;

/// Number of terms of the Mie series for a size parameter.
///
/// Wiscombe (Appl. Opt. 19, 1505, 1980, eq. 6) stops at `x + 4.05 x^(1/3) + 2`, where the coefficients have fallen to about
/// 1e-8 of the first (1e-14 in intensity); a few more bring amplitudes near directions of cancellation to 1e-12.
pub(super) fn terms(x: f64) -> usize {
    (x + 6.0 * x.cbrt() + 6.0).ceil() as usize
}

/// Logarithmic derivatives `D_n(z) = psi_n'(z) / psi_n(z)`, `n = 0 ..= last`, by downward recurrence (BH eq. 4.89)
///
/// `D_(n-1) = n / z - 1 / (D_n + n / z)`
///
/// from 0 far above both `last` and `|z|`: stable for any complex `z`, unlike the upward recurrence, which fails as `|Im z|`
/// grows.
pub(super) fn log_derivatives(z: Complex64, last: usize, into: &mut Vec<Complex64>) {
    // Above the turning point |z|, errors fall by a factor e every |z|^(1/3) terms or faster.
    let modulus = z.norm();
    let start = (modulus + 8.0 * modulus.cbrt()).ceil() as usize;
    let start = start.max(last) + 16;
    into.clear();
    into.resize(last + 1, Complex64::ZERO);
    let reciprocal = z.inv();
    let mut derivative = Complex64::ZERO;
    for n in (1..=start).rev() {
        let ratio = reciprocal * n as f64;
        derivative = ratio - (derivative + ratio).inv();
        if n <= last + 1 {
            into[n - 1] = derivative;
        }
    }
}

/// `psi_n(x) = x j_n(x)` and `chi_n(x) = -x y_n(x)`, `n = 0 ..= last`.
///
/// `chi` grows beyond the turning point `n = x`, so its upward recurrence is stable. `psi` decreases there: it is computed
/// upwards to the turning point, then by the ratio `psi_n / psi_(n-1) = 1 / (D_n + n / x)`, so all terms keep their relative
/// accuracy, however small the sphere.
pub(super) fn riccati_bessel(x: f64, last: usize, psi: &mut Vec<f64>, chi: &mut Vec<f64>) {
    psi.clear();
    chi.clear();
    let (sin, cos) = x.sin_cos();
    psi.push(sin);
    chi.push(cos);
    let (mut psi_before, mut chi_before) = (cos, -sin);
    let turning = (x as usize).min(last);
    for n in 1..=last {
        let factor = (2 * n - 1) as f64 / x;
        let next = factor * chi[n - 1] - chi_before;
        chi_before = chi[n - 1];
        chi.push(next);
        if n <= turning {
            let next = factor * psi[n - 1] - psi_before;
            psi_before = psi[n - 1];
            psi.push(next);
        }
    }
    // D_n + n / x downwards, from an order where it equals (2 n + 1) / x to rounding.
    let start = last + 16 + (4.0 * x.cbrt()) as usize;
    let mut ratios = vec![0.0; last + 1];
    let mut sum = (2 * start + 1) as f64 / x;
    for n in (turning + 1..=start).rev() {
        if n <= last {
            ratios[n] = sum;
        }
        sum = (2 * n - 1) as f64 / x - 1.0 / sum;
    }
    for n in turning + 1..=last {
        psi.push(psi[n - 1] / ratios[n]);
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    /// The Wronskian `psi_(n-1) chi_n - psi_n chi_(n-1) = 1` relates the two functions at every order.
    #[test]
    fn psi_and_chi_satisfy_the_wronskian() {
        let (mut psi, mut chi) = (Vec::new(), Vec::new());
        for x in [1e-3, 0.1, 1.0, 3.0, 10.0, 31.4, 100.0, 1e3, 2e4] {
            riccati_bessel(x, terms(x), &mut psi, &mut chi);
            for n in 1..psi.len() {
                let wronskian = psi[n - 1] * chi[n] - psi[n] * chi[n - 1];
                let size = (psi[n - 1] * chi[n]).abs().max(1.0);
                assert!(
                    (wronskian - 1.0).abs() < 1e-12 * size * x.max(1.0).sqrt(),
                    "x = {x}, n = {n}: {wronskian}"
                );
            }
        }
    }

    /// `psi_2(x) = (3 / x^2 - 1) sin x - 3 cos x / x`, whose terms cancel at small x, leaving `x^3 / 15`.
    #[test]
    fn small_arguments_keep_relative_accuracy() {
        let (mut psi, mut chi) = (Vec::new(), Vec::new());
        let x: f64 = 1e-3;
        riccati_bessel(x, 3, &mut psi, &mut chi);
        assert!((psi[1] / (x * x / 3.0 * (1.0 - x * x / 10.0)) - 1.0).abs() < 1e-13);
        assert!((psi[2] / (x.powi(3) / 15.0 * (1.0 - x * x / 14.0)) - 1.0).abs() < 1e-13);
    }

    /// `D_0(z) = cot z`.
    #[test]
    fn logarithmic_derivative_of_order_zero_is_the_cotangent() {
        let mut all = Vec::new();
        for z in [
            Complex64::new(1.33, 0.0),
            Complex64::new(100.0, 1e-7),
            Complex64::new(15.0, 15.0),
            Complex64::new(2e3, 300.0),
        ] {
            log_derivatives(z, 20, &mut all);
            let cotangent = match z.im > 20.0 {
                true => -Complex64::I,
                false => z.cos() / z.sin(),
            };
            assert!(
                (all[0] - cotangent).norm() < 1e-11 * cotangent.norm(),
                "{z}"
            );
        }
    }
}
