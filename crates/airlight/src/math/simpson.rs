//! Adaptive Simpson quadrature of scalars and vectors.

use std::ops::{Add, AddAssign, Mul, Sub};

/// Simpson's rule for the values at both ends and the middle of an interval of the given width.
#[inline]
pub fn simpson<V>(values: &[V; 3], width: f64) -> V
where
    V: Copy + Add<Output = V> + Mul<f32, Output = V>,
{
    (values[0] + values[1] * 4.0 + values[2]) * (width / 6.0) as f32
}

/// Adds the integral of `f` over `[from, to]` to `sum`. Halves intervals, at most `depth` times, until
/// `agree(both, whole, sum)` accepts the rule on two halves compared with that on the whole, given the sum so far; accepted
/// halves get Richardson's correction. `values` are those of `f` at both ends and in the middle, `whole` is the rule on them.
pub fn adaptive_simpson<V>(
    f: &impl Fn(f64) -> V,
    (from, to): (f64, f64),
    values: &[V; 3],
    whole: &V,
    sum: &mut V,
    depth: u32,
    agree: &impl Fn(&V, &V, &V) -> bool,
) where
    V: Copy + Add<Output = V> + Sub<Output = V> + Mul<f32, Output = V> + AddAssign,
{
    let width = to - from;
    let middle = from + 0.5 * width;
    let inner = [f(from + 0.25 * width), f(from + 0.75 * width)];
    let left = [values[0], inner[0], values[1]];
    let right = [values[1], inner[1], values[2]];
    let (a, b) = (simpson(&left, 0.5 * width), simpson(&right, 0.5 * width));
    let both = a + b;
    if depth == 0 || agree(&both, whole, sum) {
        *sum += both + (both - *whole) * (1.0 / 15.0);
        return;
    }
    adaptive_simpson(f, (from, middle), &left, &a, sum, depth - 1, agree);
    adaptive_simpson(f, (middle, to), &right, &b, sum, depth - 1, agree);
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn peaks_are_refined_and_smooth_parts_are_not() {
        let evaluations = std::cell::Cell::new(0);
        let f = |x: f64| {
            evaluations.set(evaluations.get() + 1);
            (1.0 / (1e-4 + x * x)) as f32
        };
        let ends = [f(0.0), f(0.5), f(1.0)];
        let mut sum = 0.0f32;
        let agree = |both: &f32, whole: &f32, _: &f32| (both - whole).abs() <= 1e-4 * both;
        let whole = simpson(&ends, 1.0);
        adaptive_simpson(&f, (0.0, 1.0), &ends, &whole, &mut sum, 20, &agree);
        let exact = 100.0 * 100f64.atan();
        assert!((f64::from(sum) / exact - 1.0).abs() < 1e-5, "{sum}");
        assert!(evaluations.get() < 120, "{evaluations:?}");
    }
}
