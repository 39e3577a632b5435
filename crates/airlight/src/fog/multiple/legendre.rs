//! Associated Legendre functions, normalized such that the addition theorem has no factors:
//! `P_l(cos angle) = sum over m of (2 - delta_m0) Y_lm(mu) Y_lm(mu') cos(m azimuth)`.

use std::sync::LazyLock;

/// Number of polar angles in both hemispheres, and of Legendre moments.
pub const DEGREES: usize = 8;

/// Number of pairs `l < DEGREES`, `m <= l`.
pub const COUNT: usize = DEGREES * (DEGREES + 1) / 2;

/// Index of the pair `(l, m)`: all `l` of `m = 0` first.
#[inline(always)]
pub const fn index(l: usize, m: usize) -> usize {
    m * DEGREES - m * (m + 1) / 2 + l
}

/// Factors `(a, b)` of the recurrence `Y_l = a mu Y_(l-1) - b Y_(l-2)` at fixed `m`, and of `Y_mm = a sine Y_(m-1)(m-1)`.
static FACTORS: LazyLock<[(f64, f64); COUNT]> = LazyLock::new(|| {
    let mut factors = [(0.0, 0.0); COUNT];
    for m in 0..DEGREES {
        if m > 0 {
            factors[index(m, m)].0 = diagonal_factor(m);
        }
        for l in m + 1..DEGREES {
            factors[index(l, m)] = factors_of(l, m);
        }
    }
    factors
});

/// Factors of the recurrence for `l > m`.
fn factors_of(l: usize, m: usize) -> (f64, f64) {
    let (x, y) = (l as f64, m as f64);
    let norm = (x * x - y * y).sqrt();
    let back = ((x - 1.0) * (x - 1.0) - y * y).max(0.0).sqrt();
    ((2.0 * x - 1.0) / norm, back / norm)
}

/// Factor of the recurrence for `l = m > 0`.
fn diagonal_factor(m: usize) -> f64 {
    let y = m as f64;
    ((2.0 * y - 1.0) / (2.0 * y)).sqrt()
}

/// The functions of one `m` of all degrees below `count`, divided by the `m`-th power of the sine of the polar angle.
pub fn degrees_of_mode(mu: f64, m: usize, count: usize) -> Vec<f64> {
    let mut values = vec![0.0; count];
    values[m] = (1..=m).map(diagonal_factor).product();
    for l in m + 1..count {
        let (a, b) = factors_of(l, m);
        let before = if l > m + 1 { values[l - 2] } else { 0.0 };
        values[l] = a * mu * values[l - 1] - b * before;
    }
    values
}

/// `sqrt((l - m)! / (l + m)!) P_l^m(mu)` for all pairs, without the sign `(-1)^m`.
#[inline]
pub fn evaluate(mu: f64) -> [f64; COUNT] {
    with_sine(mu, (1.0 - mu * mu).max(0.0).sqrt())
}

/// [`evaluate`] for the pairs of one `m`, divided by the `m`-th power of the sine of the polar angle: polynomials in `mu`
/// without a root at the poles. All other pairs are 0.
pub fn of_mode(mu: f64, m: usize) -> [f32; COUNT] {
    let all = with_sine(mu, 1.0);
    let mut values = [0.0; COUNT];
    for l in m..DEGREES {
        values[index(l, m)] = all[index(l, m)] as f32;
    }
    values
}

#[inline(always)]
fn with_sine(mu: f64, sine: f64) -> [f64; COUNT] {
    let factors = &*FACTORS;
    let mut values = [0.0; COUNT];
    let mut diagonal = 1.0;
    for m in 0..DEGREES {
        if m > 0 {
            diagonal *= sine * factors[index(m, m)].0;
        }
        let (mut before, mut now) = (0.0, diagonal);
        values[index(m, m)] = now;
        for l in m + 1..DEGREES {
            let (a, b) = factors[index(l, m)];
            (before, now) = (now, a * mu * now - b * before);
            values[index(l, m)] = now;
        }
    }
    values
}

/// `c^m cos(m azimuth)` for each mode `m`, from `c cos(azimuth)` and `c^2`, where `c` is the sine of the polar angle.
#[inline(always)]
pub fn azimuth_factors(across: f32, square: f32) -> [f32; DEGREES] {
    let mut factors = [1.0; DEGREES];
    factors[1] = across;
    for m in 2..DEGREES {
        factors[m] = 2.0 * across * factors[m - 1] - square * factors[m - 2];
    }
    factors
}

/// [`evaluate`] times `cos(m azimuth)`: weight of each moment in a direction.
#[inline]
pub fn in_direction(mu: f64, cos_azimuth: f64) -> [f32; COUNT] {
    let polar = evaluate(mu);
    let mut values = [0.0f32; COUNT];
    let (mut before, mut now) = (cos_azimuth, 1.0);
    for m in 0..DEGREES {
        for l in m..DEGREES {
            values[index(l, m)] = (polar[index(l, m)] * now) as f32;
        }
        (before, now) = (now, 2.0 * cos_azimuth * now - before);
    }
    values
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn indices_are_consecutive() {
        let mut next = 0;
        for m in 0..DEGREES {
            for l in m..DEGREES {
                assert_eq!(index(l, m), next);
                next += 1;
            }
        }
        assert_eq!(next, COUNT);
    }

    #[test]
    fn more_degrees_continue_the_first_ones() {
        for m in [0, 3, 7] {
            let few = of_mode(-0.4, m);
            for (l, y) in degrees_of_mode(-0.4, m, DEGREES).into_iter().enumerate() {
                let few = if l < m { 0.0 } else { few[index(l, m)] };
                assert!((y as f32 - few).abs() < 1e-5, "{l} {m}");
            }
        }
        // P_20(0.5), Abramowitz & Stegun 22.3.8.
        let p = degrees_of_mode(0.5, 0, 21)[20];
        assert!((p + 0.048_358_381).abs() < 1e-8, "{p}");
    }

    #[test]
    fn the_addition_theorem_holds() {
        let legendre = |l: usize, x: f64| {
            let (mut before, mut now) = (0.0, 1.0);
            for k in 1..=l {
                let k = k as f64;
                (before, now) = (now, ((2.0 * k - 1.0) * x * now - (k - 1.0) * before) / k);
            }
            now
        };
        for (a, b, azimuth) in [
            (0.3f64, -0.8f64, 0.5f64),
            (1.0, 0.2, 2.0),
            (-0.95, -0.4, 3.0),
        ] {
            let sines = ((1.0 - a * a) * (1.0 - b * b)).sqrt();
            let cos_angle = a * b + sines * azimuth.cos();
            let (from, to) = (evaluate(b), in_direction(a, azimuth.cos()));
            for l in 0..DEGREES {
                let sum: f64 = (0..=l)
                    .map(|m| {
                        let twice = if m == 0 { 1.0 } else { 2.0 };
                        twice * from[index(l, m)] * f64::from(to[index(l, m)])
                    })
                    .sum();
                assert!((sum - legendre(l, cos_angle)).abs() < 1e-6, "{l}");
            }
        }
    }
}
