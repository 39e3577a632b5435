//! The exponential integral of a complex number, scaled so that it neither overflows nor underflows.

/// Euler's constant.
const EULER: f64 = 0.577_215_664_901_532_9;

/// Real and imaginary part of `e^z E1(z)`, `E1(z) = int_z^inf e^-y / y dy`, for `z = re + i im` in the right half plane,
/// `re >= 0`, `z != 0` (Abramowitz & Stegun 1964, 5.1.11 below `|z| = 2`, 5.1.22 in its even form elsewhere).
///
/// Relative error below 1e-13, of each part on its own: where the imaginary part is 1e13 times the smaller, it is still
/// exact to 1e-13 (neither form subtracts in it).
pub(super) fn scaled(re: f64, im: f64) -> (f64, f64) {
    if re * re + im * im <= 4.0 {
        series(re, im)
    } else {
        fraction(re, im)
    }
}

/// `E1(z) = -gamma - ln z - sum_(k>=1) (-z)^k / (k k!)`, times `e^z`.
fn series(re: f64, im: f64) -> (f64, f64) {
    let mut power = (1.0, 0.0);
    let mut sum = (0.0, 0.0);
    for k in 1..=32 {
        let k = f64::from(k);
        power = (
            -(power.0 * re - power.1 * im) / k,
            -(power.0 * im + power.1 * re) / k,
        );
        sum = (sum.0 + power.0 / k, sum.1 + power.1 / k);
    }
    let e1 = (-EULER - re.hypot(im).ln() - sum.0, -im.atan2(re) - sum.1);
    let (sin, cos) = im.sin_cos();
    let size = re.exp();
    (
        size * (cos * e1.0 - sin * e1.1),
        size * (sin * e1.0 + cos * e1.1),
    )
}

/// `1 / (z + 1 - 1 / (z + 3 - 4 / (z + 5 - 9 / (z + 7 - ...))))`, from its far end, which stands where the rest is below
/// 1e-15: the error after n terms is about `e^(-4 sqrt(n |z|) cos(arg z / 2))`.
fn fraction(re: f64, im: f64) -> (f64, f64) {
    let terms = 6 + (160.0 / (re.hypot(im) + re)) as u32;
    let mut rest = (0.0, 0.0);
    for n in (1..=terms).rev() {
        let n = f64::from(n);
        let below = (re + 2.0 * n + 1.0 - rest.0, im - rest.1);
        let square = n * n / (below.0 * below.0 + below.1 * below.1);
        rest = (below.0 * square, -below.1 * square);
    }
    let below = (re + 1.0 - rest.0, im - rest.1);
    let square = below.0 * below.0 + below.1 * below.1;
    (below.0 / square, -below.1 / square)
}

#[cfg(test)]
mod tests {
    use super::*;

    include!("exponential_integral_values.rs");

    #[test]
    fn both_parts_agree_with_forty_digits() {
        for (re, im, want_re, want_im) in VALUES {
            let got = scaled(re, im);
            assert!(
                (got.0 / want_re - 1.0).abs() < 1e-13,
                "({re}, {im}): {got:?}"
            );
            assert!(
                (got.1 - want_im).abs() <= 1e-13 * f64::abs(want_im),
                "({re}, {im}): {got:?}"
            );
        }
    }

    #[test]
    fn the_two_forms_meet() {
        for step in 0..=40 {
            let (sin, cos) = (f64::from(step) / 40.0 * std::f64::consts::FRAC_PI_2).sin_cos();
            let (a, b) = (
                series(2.0 * cos, -2.0 * sin),
                fraction(2.0 * cos, -2.0 * sin),
            );
            assert!((a.0 / b.0 - 1.0).abs() < 5e-14, "{step}: {a:?} {b:?}");
            assert!((a.1 - b.1).abs() <= 5e-14 * b.1, "{step}: {a:?} {b:?}");
        }
    }
}
