//! Legendre polynomials and Legendre series.

#[cfg(test)]
use std::f64::consts::PI;

/// Legendre polynomials `P_l(x)` for `l` below `out.len()`.
#[inline(always)]
pub fn legendre(x: f64, out: &mut [f64]) {
    for l in 0..out.len() {
        out[l] = match l {
            0 => 1.0,
            1 => x,
            _ => {
                let n = l as f64;
                ((2.0 * n - 1.0) * x * out[l - 1] - (n - 1.0) * out[l - 2]) / n
            }
        };
    }
}

/// Coefficients `(p, q)` of the recurrence `P_lm = p x P_(l-1)m - q P_(l-2)m`, `l > m`, of associated Legendre functions whose squares
/// have equal integrals for all degrees; `q` is 0 for `l = m + 1`.
pub fn associated_recurrence(l: usize, m: usize) -> (f64, f64) {
    let (lf, mf) = (l as f64, m as f64);
    let p = ((4.0 * lf * lf - 1.0) / (lf * lf - mf * mf)).sqrt();
    let below = lf - 1.0;
    let q = match l >= 2 {
        true => ((below * below - mf * mf) / (4.0 * below * below - 1.0))
            .max(0.0)
            .sqrt(),
        false => 0.0,
    };
    (p, p * q)
}

/// Legendre series `sum over l of (2 l + 1) / (4 pi) moments[l] P_l(x)`: a phase function (1/sr) from its moments.
#[cfg(test)]
pub fn legendre_series(moments: &[f64], x: f64) -> f64 {
    let (mut before, mut now) = (0.0, 1.0);
    let mut sum = 0.0;
    for (l, moment) in moments.iter().enumerate() {
        let l = l as f64;
        sum += (2.0 * l + 1.0) * moment * now;
        (before, now) = (now, ((2.0 * l + 1.0) * x * now - l * before) / (l + 1.0));
    }
    sum / (4.0 * PI)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn series_of_one_moment_is_its_polynomial() {
        for x in [-1.0, -0.3, 0.0, 0.8, 1.0] {
            let mut p = [0.0; 7];
            legendre(x, &mut p);
            assert!((p[2] - (1.5 * x * x - 0.5)).abs() < 1e-15);
            for l in 0..7 {
                let mut moments = [0.0; 7];
                moments[l] = 4.0 * PI / (2 * l + 1) as f64;
                assert!((legendre_series(&moments, x) - p[l]).abs() < 1e-14);
            }
        }
    }
}
