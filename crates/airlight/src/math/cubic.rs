//! Third-degree Lagrange interpolation among evenly spaced nodes.

/// First node and weights at `x` in `[0, 1]` among `count` nodes.
#[inline(always)]
pub fn among(x: f64, count: usize) -> (usize, [f64; 4]) {
    let position = x * (count - 1) as f64;
    let first = (position as usize).saturating_sub(1).min(count - 4);
    (first, weights(position - first as f64))
}

/// Weights of four nodes a step apart, at `t` steps from the first.
#[inline(always)]
pub fn weights(t: f64) -> [f64; 4] {
    let (a, b, c, d) = (t, t - 1.0, t - 2.0, t - 3.0);
    [
        -b * c * d / 6.0,
        a * c * d / 2.0,
        -a * b * d / 2.0,
        a * b * c / 6.0,
    ]
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn polynomials_of_third_degree_are_reproduced_at_both_ends_and_between() {
        let cube = |x: f64| 2.0 * x * x * x - x * x + 3.0 * x - 0.5;
        let count = 9;
        for x in [0.0, 0.01, 0.3, 0.5, 0.77, 0.999, 1.0] {
            let (first, weights) = among(x, count);
            let node = |k: usize| (first + k) as f64 / (count - 1) as f64;
            let got: f64 = (0..4).map(|k| weights[k] * cube(node(k))).sum();
            assert!((got - cube(x)).abs() < 1e-12, "{x}: {got}");
        }
    }
}
