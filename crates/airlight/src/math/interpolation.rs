//! Interpolation in tables: linear, bilinear, cubic Lagrange and cubic Hermite.
//!
//! A table look-up has two steps: [`interval_of`] and [`Place`] locate a coordinate among uniform or non-uniform nodes;
//! [`lerp`], [`cubic_weights`] and [`hermite_weights`] weight the neighbouring values.

use super::real::Real;
use std::ops::{Add, Mul};

/// Linear interpolation `a + t (b - a)`, exact at both ends.
#[inline(always)]
pub fn lerp<V, T: Real>(a: V, b: V, t: T) -> V
where
    V: Add<Output = V> + Mul<T, Output = V>,
{
    a * (T::of(1.0) - t) + b * t
}

/// Index of the lower end of the interval of strictly increasing `nodes` (two or more) that contains `x`; the first or last
/// interval if `x` lies beyond the ends.
#[inline(always)]
pub fn interval_of(nodes: &[f64], x: f64) -> usize {
    interval_by_key(nodes, x, |node| *node)
}

/// As [`interval_of`], for entries that contain their node, returned by `node`.
#[inline(always)]
pub fn interval_by_key<E>(entries: &[E], x: f64, node: impl Fn(&E) -> f64) -> usize {
    entries
        .partition_point(|entry| node(entry) <= x)
        .clamp(1, entries.len() - 1)
        - 1
}

/// Piecewise linear interpolation at `x` through points with strictly increasing abscissae (one or more), constant beyond
/// the ends.
pub fn piecewise_linear(abscissae: &[f64], values: &[f64], x: f64) -> f64 {
    match abscissae {
        [_] => values[0],
        _ => Place::among(abscissae, x).value_in(values),
    }
}

/// Position of a coordinate among nodes: `fraction` of the way from node `below` to the next.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Place {
    /// Index of the node below; never the last one.
    pub below: usize,
    /// Fraction of the interval, in `[0, 1]`.
    pub fraction: f64,
}

impl Place {
    /// Position among strictly increasing nodes (two or more); `x` is clamped to their range.
    #[inline(always)]
    pub fn among(nodes: &[f64], x: f64) -> Self {
        let below = interval_of(nodes, x);
        let fraction = (x - nodes[below]) / (nodes[below + 1] - nodes[below]);
        Self {
            below,
            fraction: fraction.clamp(0.0, 1.0),
        }
    }

    /// Position among `count` (two or more) uniform nodes from 0 to 1; `x` is clamped to `[0, 1]`.
    #[inline(always)]
    pub fn evenly(x: f64, count: usize) -> Self {
        let position = x.clamp(0.0, 1.0) * (count - 1) as f64;
        let below = (position as usize).min(count - 2);
        Self {
            below,
            fraction: position - below as f64,
        }
    }

    /// Linear interpolation of a list with one value per node.
    #[inline(always)]
    pub fn value_in<V>(self, values: &[V]) -> V
    where
        V: Copy + Add<Output = V> + Mul<f64, Output = V>,
    {
        lerp(values[self.below], values[self.below + 1], self.fraction)
    }

    /// [`Place::value_in`] in single precision.
    #[inline(always)]
    pub fn value_in_f32<V>(self, values: &[V]) -> V
    where
        V: Copy + Add<Output = V> + Mul<f32, Output = V>,
    {
        lerp(
            values[self.below],
            values[self.below + 1],
            self.fraction as f32,
        )
    }
}

/// Indices and bilinear weights of the four samples around a point in a row-major table of `[columns, rows]`; `u` runs along
/// rows and `v` across them, both in `[0, 1]`.
pub fn bilinear(u: f64, v: f64, [columns, rows]: [usize; 2]) -> [(usize, f32); 4] {
    let (across, down) = (Place::evenly(u, columns), Place::evenly(v, rows));
    let (s, t) = (across.fraction as f32, down.fraction as f32);
    let first = down.below * columns + across.below;
    [
        (first, (1.0 - s) * (1.0 - t)),
        (first + 1, s * (1.0 - t)),
        (first + columns, (1.0 - s) * t),
        (first + columns + 1, s * t),
    ]
}

/// A whole number from 0 to 2^23 - 1 as an integer. Without the checks of `as`, loops over many run in vector registers.
#[inline(always)]
pub fn whole(number: f32) -> i32 {
    /// From here on, single precision has whole numbers only, and their last bits count them.
    const FIRST: f32 = (1 << 23) as f32;
    ((number + FIRST).to_bits() - FIRST.to_bits()) as i32
}

/// Weights of cubic Lagrange interpolation among four nodes with spacing 1, at `t` from the first.
#[inline(always)]
pub fn cubic_weights<T: Real>(t: T) -> [T; 4] {
    let (a, b, c, d) = (t, t - T::of(1.0), t - T::of(2.0), t - T::of(3.0));
    [
        -b * c * d * T::of(1.0 / 6.0),
        a * c * d * T::of(0.5),
        -a * b * d * T::of(0.5),
        a * b * c * T::of(1.0 / 6.0),
    ]
}

/// First node and weights of cubic interpolation at `x` in `[0, 1]` among `count` (four or more) uniform nodes.
#[inline(always)]
pub fn cubic(x: f64, count: usize) -> (usize, [f64; 4]) {
    let position = x * (count - 1) as f64;
    let first = (position as usize).saturating_sub(1).min(count - 4);
    (first, cubic_weights(position - first as f64))
}

/// As [`cubic`], with weights in single precision.
#[inline(always)]
pub fn cubic_f32(x: f64, count: usize) -> (usize, [f32; 4]) {
    let (first, weights) = cubic(x, count);
    (first, weights.map(|w| w as f32))
}

/// Weights of Hermite interpolation at the fraction `t` of an interval: of the two values, and of the two slopes times the
/// width of the interval.
#[inline(always)]
pub fn hermite_weights(t: f64) -> ([f64; 2], [f64; 2]) {
    let u = 1.0 - t;
    (
        [u * u * (1.0 + 2.0 * t), t * t * (1.0 + 2.0 * u)],
        [u * u * t, -t * t * u],
    )
}

/// Piecewise cubic Hermite interpolation at `x`, in the interval that begins at node `below`; [`monotone_slopes`] computes
/// suitable slopes.
#[inline]
pub fn hermite(nodes: &[f64], values: &[f64], slopes: &[f64], below: usize, x: f64) -> f64 {
    let width = nodes[below + 1] - nodes[below];
    let ([v0, v1], [s0, s1]) = hermite_weights((x - nodes[below]) / width);
    v0 * values[below]
        + v1 * values[below + 1]
        + s0 * (slopes[below] * width)
        + s1 * (slopes[below + 1] * width)
}

/// Slopes of the monotone piecewise cubic through points, 0 at the first and last: zero at local extrema, otherwise the
/// weighted harmonic mean of the neighbouring secants (Fritsch & Butland, SIAM J. Sci. Stat. Comput. 5, 300, 1984).
pub fn monotone_slopes(x: &[f64], y: &[f64]) -> Vec<f64> {
    let last = x.len() - 1;
    let secant = |i: usize| (y[i + 1] - y[i]) / (x[i + 1] - x[i]);
    (0..=last)
        .map(|i| {
            if i == 0 || i == last {
                return 0.0;
            }
            let (left, right) = (secant(i - 1), secant(i));
            if left * right <= 0.0 {
                return 0.0;
            }
            let (h0, h1) = (x[i] - x[i - 1], x[i + 1] - x[i]);
            let (w0, w1) = (2.0 * h1 + h0, h1 + 2.0 * h0);
            (w0 + w1) / (w0 / left + w1 / right)
        })
        .collect()
}

#[cfg(test)]
mod tests {
    use super::*;

    const NODES: [f64; 4] = [-1.0, 0.5, 2.0, 7.0];

    fn cube(x: f64) -> f64 {
        2.0 * x * x * x - x * x + 3.0 * x - 0.5
    }

    #[test]
    fn positions_among_non_uniform_nodes_reproduce_the_coordinate() {
        for x in [-1.0, -0.2, 0.5, 1.9, 6.999, 7.0] {
            let place = Place::among(&NODES, x);
            assert!((place.value_in(&NODES) - x).abs() < 1e-15, "{place:?}");
        }
        let (before, beyond) = (Place::among(&NODES, -9.0), Place::among(&NODES, 9.0));
        assert_eq!((before.below, before.fraction), (0, 0.0));
        assert_eq!((beyond.below, beyond.fraction), (2, 1.0));
        assert_eq!(interval_by_key(&[(0.0, 'a'), (1.0, 'b')], 3.0, |e| e.0), 0);
    }

    #[test]
    fn positions_among_uniform_nodes_reproduce_the_coordinate() {
        let values = [0.0, 0.25, 0.5, 0.75, 1.0];
        for x in [0.0, 0.1, 0.25, 0.6, 1.0] {
            assert!((Place::evenly(x, 5).value_in(&values) - x).abs() < 1e-15);
        }
        assert_eq!(Place::evenly(-3.0, 5), Place::evenly(0.0, 5));
        let last = Place::evenly(3.0, 5);
        assert_eq!((last.below, last.fraction), (3, 1.0));
    }

    #[test]
    fn piecewise_linear_is_constant_beyond_the_ends() {
        assert_eq!(piecewise_linear(&[4.0], &[3.0], 99.0), 3.0);
        for (x, y) in [(-5.0, -1.0), (1.25, 1.25), (80.0, 7.0)] {
            assert_eq!(piecewise_linear(&NODES, &NODES, x), y);
        }
    }

    #[test]
    fn bilinear_weights_reproduce_planes() {
        let size = [3, 4];
        for (u, v) in [(0.0, 0.0), (0.3, 0.9), (1.0, 1.0)] {
            let sum: f32 = bilinear(u, v, size)
                .iter()
                .map(|&(index, weight)| {
                    let (column, row) = (index % size[0], index / size[0]);
                    weight * (column as f32 / 2.0 + 10.0 * row as f32 / 3.0)
                })
                .sum();
            assert!((f64::from(sum) - (u + 10.0 * v)).abs() < 1e-5);
        }
    }

    #[test]
    fn cubic_interpolation_reproduces_cubics() {
        let count = 9;
        for x in [0.0, 0.01, 0.3, 0.5, 0.77, 0.999, 1.0] {
            let (first, weights) = cubic(x, count);
            let node = |k: usize| (first + k) as f64 / (count - 1) as f64;
            let got: f64 = (0..4).map(|k| weights[k] * cube(node(k))).sum();
            assert!((got - cube(x)).abs() < 1e-12, "{x}: {got}");
        }
    }

    #[test]
    fn hermite_interpolation_reproduces_cubics() {
        let values = NODES.map(cube);
        let slopes = NODES.map(|x| 6.0 * x * x - 2.0 * x + 3.0);
        for x in [-1.0, 0.0, 0.5, 1.3, 5.0, 7.0] {
            let got = hermite(&NODES, &values, &slopes, interval_of(&NODES, x), x);
            assert!((got / cube(x) - 1.0).abs() < 1e-13, "{x}: {got}");
        }
    }

    #[test]
    fn monotone_slopes_do_not_overshoot() {
        let values = [0.0, 0.1, 5.0, 5.1];
        let slopes = monotone_slopes(&NODES, &values);
        assert_eq!((slopes[0], slopes[3]), (0.0, 0.0));
        let mut before = 0.0;
        for i in 0..=800 {
            let x = -1.0 + 0.01 * f64::from(i);
            let now = hermite(&NODES, &values, &slopes, interval_of(&NODES, x), x);
            assert!(now >= before - 1e-12 && now <= 5.1 + 1e-12, "{x}: {now}");
            before = now;
        }
        assert_eq!(monotone_slopes(&NODES, &[0.0, 1.0, 0.0, 1.0]), [0.0; 4]);
    }
}
