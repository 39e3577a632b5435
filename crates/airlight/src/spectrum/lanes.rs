//! [`Spectrum`]: a fixed-size array of values, one for each wavelength, with lane-by-lane arithmetic.
//!
//! Every operation is a plain loop over a fixed-size array, without branches and without fused multiply-add, so that the
//! compiler vectorises it and all machines produce the same bits.

use crate::math::exponentials::count_exponentials;
use std::ops::{Add, AddAssign, Div, Index, IndexMut, Mul, MulAssign, Sub, SubAssign};

/// Values at `N` wavelengths (or, with `N = 3`, red, green and blue).
#[derive(Clone, Copy, Debug, PartialEq)]
#[repr(C, align(16))]
pub struct Spectrum<const N: usize>(pub [f32; N]);

impl<const N: usize> Spectrum<N> {
    /// All lanes zero.
    pub const ZERO: Self = Self([0.0; N]);
    /// All lanes one.
    pub const ONE: Self = Self([1.0; N]);

    /// The same value in every lane.
    #[inline(always)]
    pub const fn splat(value: f32) -> Self {
        Self([value; N])
    }

    /// Spectrum with `f(lane)` in each lane.
    #[inline(always)]
    pub fn from_fn(mut f: impl FnMut(usize) -> f32) -> Self {
        // A loop, not `array::from_fn`: calls in the latter are not always inlined, which prevents vectorisation.
        let mut lanes = [0.0; N];
        for (i, lane) in lanes.iter_mut().enumerate() {
            *lane = f(i);
        }
        Self(lanes)
    }

    /// Applies `f` to each lane.
    #[inline(always)]
    pub fn map(self, f: impl Fn(f32) -> f32) -> Self {
        Self::from_fn(|i| f(self.0[i]))
    }

    /// `self + a * b`, rounded twice: no fused multiply-add, so that all machines produce the same bits.
    #[inline(always)]
    pub fn mul_acc(self, a: Self, b: Self) -> Self {
        Self::from_fn(|i| self.0[i] + a.0[i] * b.0[i])
    }

    /// `self + a * b` with a scalar `b`, rounded twice.
    #[inline(always)]
    pub fn scale_acc(self, a: Self, b: f32) -> Self {
        Self::from_fn(|i| self.0[i] + a.0[i] * b)
    }

    /// `e^x` of each lane: relative error below 3e-7 for -87 < x < 88; the argument is clamped to that range.
    #[inline(always)]
    pub fn exp(self) -> Self {
        count_exponentials(N);
        self.map(exp_lane)
    }

    /// Natural logarithm of each lane: absolute error below 3e-7 + 2e-7 |ln x| for normal positive x; smaller arguments are
    /// clamped to the smallest normal number.
    #[inline(always)]
    pub fn ln(self) -> Self {
        count_exponentials(N);
        self.map(ln_lane)
    }

    /// Sine and cosine of each lane: absolute error below 2e-7 + 1e-7 |x| for |x| < 1000.
    #[inline(always)]
    pub fn sin_cos(self) -> (Self, Self) {
        let (mut sin, mut cos) = (Self::ZERO, Self::ZERO);
        for lane in 0..N {
            (sin.0[lane], cos.0[lane]) = sin_cos_lane(self.0[lane]);
        }
        (sin, cos)
    }

    /// Maximum of each lane and `floor`.
    #[inline(always)]
    pub fn max_scalar(self, floor: f32) -> Self {
        self.map(|v| if v > floor { v } else { floor })
    }

    /// Largest lane.
    #[inline(always)]
    pub fn max_element(self) -> f32 {
        self.0.iter().fold(f32::NEG_INFINITY, |m, &v| m.max(v))
    }

    /// Smallest lane.
    #[inline(always)]
    pub fn min_element(self) -> f32 {
        self.0.iter().fold(f32::INFINITY, |m, &v| m.min(v))
    }

    /// True if all lanes are finite.
    pub fn is_finite(self) -> bool {
        self.0.iter().all(|v| v.is_finite())
    }
}

/// `e^x` by splitting off the power of two, then a polynomial of degree 6 on `|r| <= ln(2)/2`; branch-free so that loops
/// over lanes are vectorised.
#[inline(always)]
fn exp_lane(x: f32) -> f32 {
    const LN2_HI: f32 = 0.693_359_4;
    const LN2_LO: f32 = -2.121_944_4e-4;
    // 1.5 * 2^23: adding and subtracting it rounds to the nearest integer.
    const ROUND: f32 = 12_582_912.0;
    // Plain comparisons compile to min/max instructions; `f32::max` adds NaN handling.
    let x = if x < -87.0 { -87.0 } else { x };
    let x = if x > 88.0 { 88.0 } else { x };
    let shifted = x * std::f32::consts::LOG2_E + ROUND;
    let n = shifted - ROUND;
    let r = (x - n * LN2_HI) - n * LN2_LO;
    let p = 1.987_569_1e-4;
    let p = p * r + 1.398_199_9e-3;
    let p = p * r + 8.333_452e-3;
    let p = p * r + 4.166_579_6e-2;
    let p = p * r + 1.666_666_5e-1;
    let p = p * r + 0.5;
    let e = (p * r) * r + r + 1.0;
    // The low bits of `shifted` hold n; move them into the exponent field.
    let scale = f32::from_bits(
        (shifted
            .to_bits()
            .wrapping_sub(ROUND.to_bits())
            .wrapping_add(127))
            << 23,
    );
    e * scale
}

/// Natural logarithm by exponent extraction and a polynomial on `[sqrt(1/2), sqrt(2))`; branch-free.
#[inline(always)]
fn ln_lane(x: f32) -> f32 {
    // Offset so that the mantissa falls in [sqrt(1/2), sqrt(2)).
    const SQRT_HALF_BITS: u32 = 0x3f35_04f3;
    let x = if x < f32::MIN_POSITIVE {
        f32::MIN_POSITIVE
    } else {
        x
    };
    let shifted = x.to_bits().wrapping_sub(SQRT_HALF_BITS);
    let exponent = (shifted as i32) >> 23;
    let m = f32::from_bits((shifted & 0x007f_ffff).wrapping_add(SQRT_HALF_BITS)) - 1.0;
    let z = m * m;
    let p = 7.037_683_6e-2;
    let p = p * m - 1.151_461e-1;
    let p = p * m + 1.167_699_9e-1;
    let p = p * m - 1.242_014_1e-1;
    let p = p * m + 1.424_932_3e-1;
    let p = p * m - 1.666_805_8e-1;
    let p = p * m + 2.000_071_5e-1;
    let p = p * m - 2.499_999_4e-1;
    let p = p * m + 3.333_333e-1;
    let e = exponent as f32;
    let y = p * m * z + e * -2.121_944_4e-4 - 0.5 * z;
    m + y + e * 0.693_359_4
}

/// Sine and cosine by reduction to an eighth of the circle, then polynomials; branch-free.
#[inline(always)]
fn sin_cos_lane(x: f32) -> (f32, f32) {
    // pi / 2 in three parts, whose products with small whole numbers are exact.
    const QUARTER: [f32; 3] = [1.570_312_5, 4.837_513e-4, 7.549_79e-8];
    // As in `exp_lane`.
    const ROUND: f32 = 12_582_912.0;
    let shifted = x * std::f32::consts::FRAC_2_PI + ROUND;
    let n = shifted - ROUND;
    let r = ((x - n * QUARTER[0]) - n * QUARTER[1]) - n * QUARTER[2];
    let z = r * r;
    let p = -1.951_529_6e-4;
    let p = p * z + 8.332_161e-3;
    let p = p * z - 1.666_665_5e-1;
    let sin = p * z * r + r;
    let p = 2.443_315_7e-5;
    let p = p * z - 1.388_731_6e-3;
    let p = p * z + 4.166_664_6e-2;
    let cos = p * z * z - 0.5 * z + 1.0;
    let quadrant = shifted.to_bits();
    let (sin, cos) = match quadrant & 1 {
        0 => (sin, cos),
        _ => (cos, sin),
    };
    let negative = |quadrant: u32| (quadrant & 2) << 30;
    (
        f32::from_bits(sin.to_bits() ^ negative(quadrant)),
        f32::from_bits(cos.to_bits() ^ negative(quadrant.wrapping_add(1))),
    )
}

macro_rules! lane_operator {
    ($trait:ident, $method:ident, $op:tt) => {
        impl<const N: usize> $trait for Spectrum<N> {
            type Output = Self;
            #[inline(always)]
            fn $method(self, other: Self) -> Self {
                Self::from_fn(|i| self.0[i] $op other.0[i])
            }
        }
        impl<const N: usize> $trait<f32> for Spectrum<N> {
            type Output = Self;
            #[inline(always)]
            fn $method(self, other: f32) -> Self {
                Self::from_fn(|i| self.0[i] $op other)
            }
        }
    };
}

lane_operator!(Add, add, +);
lane_operator!(Sub, sub, -);
lane_operator!(Mul, mul, *);
lane_operator!(Div, div, /);

impl<const N: usize> AddAssign for Spectrum<N> {
    #[inline(always)]
    fn add_assign(&mut self, other: Self) {
        *self = *self + other;
    }
}

impl<const N: usize> SubAssign for Spectrum<N> {
    #[inline(always)]
    fn sub_assign(&mut self, other: Self) {
        *self = *self - other;
    }
}

impl<const N: usize> MulAssign for Spectrum<N> {
    #[inline(always)]
    fn mul_assign(&mut self, other: Self) {
        *self = *self * other;
    }
}

impl<const N: usize> Index<usize> for Spectrum<N> {
    type Output = f32;
    #[inline(always)]
    fn index(&self, lane: usize) -> &f32 {
        &self.0[lane]
    }
}

impl<const N: usize> IndexMut<usize> for Spectrum<N> {
    #[inline(always)]
    fn index_mut(&mut self, lane: usize) -> &mut f32 {
        &mut self.0[lane]
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn exp_matches_the_standard_library() {
        let mut x = -86.9f32;
        while x < 87.9 {
            let got = Spectrum([x; 4]).exp()[2] as f64;
            let want = (x as f64).exp();
            assert!(
                (got / want - 1.0).abs() < 3e-7,
                "exp({x}): {got} against {want}"
            );
            x += 0.013;
        }
        assert_eq!(Spectrum([0.0f32; 3]).exp(), Spectrum::ONE);
        assert!(Spectrum([-1e30f32; 3]).exp()[0] < 1e-37);
        assert!(Spectrum([1e30f32; 3]).exp()[0].is_finite());
    }

    #[test]
    fn ln_matches_the_standard_library() {
        let mut x = 1e-37f32;
        while x < 1e37 {
            let got = Spectrum([x; 4]).ln()[1] as f64;
            let want = (x as f64).ln();
            assert!(
                (got - want).abs() < 3e-7 + 2e-7 * want.abs(),
                "ln({x}): {got} against {want}"
            );
            x *= 1.07;
        }
        assert!(Spectrum([0.0f32; 2]).ln()[0] < -80.0);
    }

    #[test]
    fn sin_and_cos_match_the_standard_library() {
        let mut x = -1000.0f32;
        while x < 1000.0 {
            let (sin, cos) = Spectrum([x; 4]).sin_cos();
            let limit = 2e-7 + 1e-7 * x.abs() as f64;
            for (got, want) in [(sin[3], (x as f64).sin()), (cos[0], (x as f64).cos())] {
                assert!((got as f64 - want).abs() < limit, "{x}: {got} {want}");
            }
            x += 0.0371;
        }
        assert_eq!(
            Spectrum([0.0f32; 2]).sin_cos(),
            (Spectrum::ZERO, Spectrum::ONE)
        );
    }
}
