//! Angles of points in the plane, without branches: loops over many points run in vector registers.

use super::real::Real;
use std::f64::consts::PI;

/// Coefficients of `atan(u) / u` in powers of `u^2`, for `u` up to `tan(pi / 8)`: the polynomial that interpolates it at 8
/// Chebyshev points, with an error of 8e-13.
const SERIES: [f64; 8] = [
    0.9999999999992443,
    -0.33333333276900745,
    0.19999993051885528,
    -0.14285386503682784,
    0.11103456183632707,
    -0.08992547457129763,
    0.06974177205840795,
    -0.03765480113107223,
];

/// Angle of the point `(x, y)` from the positive x axis, from -pi to pi, as [`f64::atan2`], with an error of 4e-12 (`f32`: 5e-7); `norm`
/// is the distance of the point from the origin. 0 at the origin.
#[inline(always)]
pub(crate) fn arctangent<T: Real>(y: T, x: T, norm: T) -> T {
    let one = T::of(1.0);
    // The tangents of half and of a quarter of the angle to the nearer end of the x axis.
    let half = y / (norm + x.abs()).max(T::of(f32::MIN_POSITIVE.into()));
    let quarter = half / (one + (one + half * half).sqrt());
    let square = quarter * quarter;
    let terms = SERIES.iter().rev();
    let series = terms.fold(T::of(0.0), |sum, &c| sum * square + T::of(c));
    let angle = T::of(4.0) * quarter * series;
    match x < T::of(0.0) {
        true => T::of(PI).copysign(y) - angle,
        false => angle,
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn angles_match_the_library_in_all_directions() {
        for i in -1800..=1800 {
            let angle = f64::from(i).to_radians() / 10.0;
            for radius in [1e-9, 1.0, 3e5] {
                let (y, x) = (radius * angle.sin(), radius * angle.cos());
                let got = arctangent(y, x, y.hypot(x));
                assert!((got - y.atan2(x)).abs() < 4e-12, "{angle}: {got}");
                let (y, x) = (y as f32, x as f32);
                let got = f64::from(arctangent(y, x, y.hypot(x)));
                let exact = f64::from(y).atan2(x.into());
                assert!((got - exact).abs() < 5e-7, "{angle}: {got}");
            }
        }
        for tiny in [1e-3, 1e-8, 1e-100] {
            assert!((arctangent(tiny, 1.0, 1.0) / tiny - 1.0).abs() < 1e-6);
        }
        for tiny in [1e-3f32, 1e-8, 1e-30] {
            assert!((arctangent(tiny, 1.0, 1.0) / tiny - 1.0).abs() < 1e-6);
        }
    }

    #[test]
    fn axes_and_the_origin_are_exact() {
        assert_eq!(arctangent(0.0, 1.0, 1.0), 0.0);
        assert_eq!(arctangent(0.0, -1.0, 1.0), PI);
        assert_eq!(arctangent(0.0, 0.0, 0.0), 0.0);
    }
}
