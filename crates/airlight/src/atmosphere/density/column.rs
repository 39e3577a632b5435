//! Integrals of density along rays.

use crate::atmosphere::ray_segment::RaySegment;
use crate::math::exponentials::count_exponentials;
use crate::math::quadrature::FixedRule;

/// Quadrature rule for each part of a ray.
pub(super) static RULE: FixedRule<8> = FixedRule::fixed();

/// Natural logarithm of the largest density of an exponential profile.
pub(super) const MAX_LN_DENSITY: f64 = 57.0;

/// Density that has decayed over `heights` scale heights (negative: increased), at most `e^57`.
#[inline]
pub(super) fn decayed(heights: f64) -> f64 {
    count_exponentials(1);
    (-heights).min(MAX_LN_DENSITY).exp()
}

/// Column of a layer of density 1 between two heights; `bottom_m` may be minus infinity.
#[inline]
pub(super) fn layer(ray: &RaySegment, bottom_m: f64, top_m: f64) -> f64 {
    let (first, last) = ray.below(top_m);
    if bottom_m == f64::NEG_INFINITY {
        return last - first;
    }
    let (enter, leave) = ray.below(bottom_m);
    if enter == leave {
        return last - first;
    }
    let beyond = if leave < last { last - leave } else { 0.0 };
    (enter - first).max(0.0) + beyond
}

/// Column of a density that is 1 up to the base and falls exponentially above.
#[inline]
pub(super) fn clamped(ray: &RaySegment, base_height_m: f64, scale_height_m: f64) -> f64 {
    let (first, last) = ray.below(base_height_m);
    if first == last {
        return exponential(ray, base_height_m, scale_height_m);
    }
    let mut column = last - first;
    if first > 0.0 {
        column += exponential(&ray.part(0.0, first), base_height_m, scale_height_m);
    }
    if last < ray.length_m {
        let beyond = ray.part(last, ray.length_m);
        column += exponential(&beyond, base_height_m, scale_height_m);
    }
    column
}

/// The integral of `e^-((y - reference) / scale)` along a ray.
#[inline]
pub(super) fn exponential(ray: &RaySegment, reference_height_m: f64, scale_height_m: f64) -> f64 {
    let slope = ray.sin_elevation / scale_height_m;
    let curvature = ray.curvature_per_m / scale_height_m;
    let start = (ray.height_m - reference_height_m) / scale_height_m;
    let length = ray.length_m;
    if curvature == 0.0 && length.is_finite() {
        // Flat ground: start from the denser end to avoid overflow.
        let rise = slope * length;
        let densest = start + rise.min(0.0);
        let rise = rise.abs();
        let mean = if rise < 1e-8 {
            1.0 - 0.5 * rise
        } else {
            -(-rise).exp_m1() / rise
        };
        return decayed(densest) * length * mean;
    }
    if curvature == 0.0 {
        return match slope > 0.0 {
            true => decayed(start) / slope,
            false => f64::INFINITY,
        };
    }
    // Round ground: the exponent is a parabola, integrated away from its lowest point.
    let lowest = -0.5 * slope / curvature;
    let exponent_at = |s: f64| start + s * (slope + s * curvature);
    let column = if lowest <= 0.0 {
        decayed(start) * falling(slope, curvature, length)
    } else if lowest >= length {
        let back = -(slope + 2.0 * curvature * length);
        decayed(exponent_at(length)) * falling(back, curvature, length)
    } else {
        decayed(exponent_at(lowest))
            * (falling(0.0, curvature, lowest) + falling(0.0, curvature, length - lowest))
    };
    column.min(f64::MAX)
}

/// `int_0^length e^-(a s + b s^2) ds` for `a >= 0`, `b > 0`, by the scaled complementary error function, or by Gauss-Legendre
/// quadrature if its two values would nearly cancel.
fn falling(a: f64, b: f64, length: f64) -> f64 {
    const HALF_SQRT_PI: f64 = 0.886_226_925_452_758;
    let fall = length * (a + b * length);
    if fall < 0.5 {
        return RULE.integrate(0.0, length, |s| (-s * (a + b * s)).exp());
    }
    let root = b.sqrt();
    let near = 0.5 * a / root;
    if near > 1e7 {
        return -(-fall).exp_m1() / a;
    }
    let far = if length.is_finite() {
        (-fall).exp() * scaled_erfc(near + root * length)
    } else {
        0.0
    };
    HALF_SQRT_PI / root * (scaled_erfc(near) - far)
}

/// `e^(z^2) erfc(z)` for `z >= 0`; relative error below 1e-12.
fn scaled_erfc(z: f64) -> f64 {
    const SQRT_PI: f64 = 1.772_453_850_905_516;
    if z < 25.0 {
        (z * z).exp() * libm::erfc(z)
    } else {
        let w = 0.5 / (z * z);
        (1.0 - w * (1.0 - 3.0 * w * (1.0 - 5.0 * w * (1.0 - 7.0 * w)))) / (z * SQRT_PI)
    }
}
