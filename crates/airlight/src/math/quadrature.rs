//! Numerical integration used by several rooms.

use std::f64::consts::PI;

/// Nodes and weights of the Gauss-Legendre rule of `count` points on `[-1, 1]`, nodes rising: Newton's method on `P_n`
/// from Tricomi's first guess. Exact to about 1e-15 up to some hundreds of points.
pub(crate) fn gauss_legendre(count: usize) -> (Vec<f64>, Vec<f64>) {
    let n = count as f64;
    let mut nodes = vec![0.0; count];
    let mut weights = vec![0.0; count];
    for i in 0..count.div_ceil(2) {
        let mut x = (1.0 - (n - 1.0) / (8.0 * n * n * n))
            * (PI * (4.0 * i as f64 + 3.0) / (4.0 * n + 2.0)).cos();
        let mut slope = 1.0;
        for _ in 0..20 {
            let (mut before, mut now) = (1.0, x);
            for k in 2..=count {
                let k = k as f64;
                (before, now) = (now, ((2.0 * k - 1.0) * x * now - (k - 1.0) * before) / k);
            }
            slope = n * (x * now - before) / (x * x - 1.0);
            let step = now / slope;
            x -= step;
            if step.abs() < 1e-15 {
                break;
            }
        }
        if 2 * i + 1 == count {
            x = 0.0;
        }
        let weight = 2.0 / ((1.0 - x * x) * slope * slope);
        (nodes[count - 1 - i], weights[count - 1 - i]) = (x, weight);
        (nodes[i], weights[i]) = (-x, weight);
    }
    (nodes, weights)
}

/// [`integrate_by`] with a rule of `points` made for it.
#[cfg(test)]
pub(crate) fn integrate(
    points: usize,
    from: f64,
    to: f64,
    breaks: &[f64],
    f: impl Fn(f64) -> f64,
) -> f64 {
    integrate_by(&gauss_legendre(points), from, to, breaks, f)
}

/// Integral of `f` from `from` to `to`: one Gauss-Legendre rule in each stretch between `breaks`.
pub(crate) fn integrate_by(
    rule: &(Vec<f64>, Vec<f64>),
    from: f64,
    to: f64,
    breaks: &[f64],
    f: impl Fn(f64) -> f64,
) -> f64 {
    let (nodes, weights) = rule;
    let mut edges: Vec<f64> = breaks
        .iter()
        .copied()
        .filter(|&b| b > from && b < to)
        .collect();
    edges.push(from);
    edges.push(to);
    edges.sort_by(f64::total_cmp);
    edges
        .windows(2)
        .map(|edge| {
            let half = 0.5 * (edge[1] - edge[0]);
            let sum: f64 = nodes
                .iter()
                .zip(weights)
                .map(|(x, w)| w * f(edge[0] + half * (1.0 + x)))
                .sum();
            half * sum
        })
        .sum()
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn rules_are_exact_for_polynomials_up_to_their_degree() {
        for count in [1usize, 2, 3, 8, 12, 33] {
            let (nodes, weights) = gauss_legendre(count);
            for degree in 0..2 * count as i32 {
                let sum: f64 = nodes
                    .iter()
                    .zip(&weights)
                    .map(|(x, w)| w * x.powi(degree))
                    .sum();
                let want = if degree % 2 == 0 {
                    2.0 / (degree as f64 + 1.0)
                } else {
                    0.0
                };
                assert!(
                    (sum - want).abs() < 1e-14,
                    "{count} points, degree {degree}: {sum}"
                );
            }
            assert!(nodes.windows(2).all(|w| w[0] < w[1]));
        }
    }

    #[test]
    fn breaks_split_the_interval() {
        let jump = |x: f64| if x < 0.3 { 1.0 } else { 5.0 };
        assert!((integrate(3, 0.0, 1.0, &[0.3, 7.0], jump) - 3.8).abs() < 1e-14);
    }
}
