//! Gauss-Legendre quadrature.

use std::f64::consts::PI;

/// A Gauss-Legendre rule on `[0, 1]`: (node, weight) pairs with increasing nodes and weights that sum to 1. Exact for
/// polynomials of degree below twice the number of nodes. [`FixedRule`] if the number of nodes is a constant.
#[derive(Clone, Debug, PartialEq)]
pub struct GaussRule<S = Vec<(f64, f64)>> {
    pairs: S,
}

/// A rule computed at compile time.
pub type FixedRule<const N: usize> = GaussRule<[(f64, f64); N]>;

impl GaussRule {
    /// Rule with `count` (one or more) nodes, by Newton iteration from Tricomi's initial guess; accurate to about 1e-15 up to a
    /// few hundred nodes.
    pub fn new(count: usize) -> Self {
        let mut pairs = vec![(0.5, 0.0); count];
        for i in 0..count.div_ceil(2) {
            let angle = PI * (4.0 * i as f64 + 3.0) / (4.0 * count as f64 + 2.0);
            let (x, w) = legendre_root(i, count, tricomi(count, angle.cos()));
            pairs[i] = (0.5 - 0.5 * x, 0.5 * w);
            pairs[count - 1 - i] = (0.5 + 0.5 * x, 0.5 * w);
        }
        Self { pairs }
    }
}

impl<const N: usize> FixedRule<N> {
    /// Rule with N (one or more) nodes, for constants.
    pub const fn fixed() -> Self {
        let mut pairs = [(0.5, 0.0); N];
        let mut i = 0;
        while i < N.div_ceil(2) {
            let angle = PI * (4.0 * i as f64 + 3.0) / (4.0 * N as f64 + 2.0);
            let (x, w) = legendre_root(i, N, tricomi(N, near_cosine(angle)));
            pairs[i] = (0.5 - 0.5 * x, 0.5 * w);
            pairs[N - 1 - i] = (0.5 + 0.5 * x, 0.5 * w);
            i += 1;
        }
        Self { pairs }
    }

    /// The (node, weight) pairs.
    pub const fn pairs(&self) -> &[(f64, f64); N] {
        &self.pairs
    }
}

impl<S: AsRef<[(f64, f64)]>> GaussRule<S> {
    /// Number of nodes.
    #[inline(always)]
    pub fn len(&self) -> usize {
        self.pairs.as_ref().len()
    }

    /// Nodes and weights on `[0, 1]`.
    #[inline(always)]
    pub fn iter(&self) -> impl Iterator<Item = (f64, f64)> + '_ {
        self.pairs.as_ref().iter().copied()
    }

    /// Nodes and weights on `[from, to]`.
    #[inline(always)]
    pub fn on(&self, from: f64, to: f64) -> impl Iterator<Item = (f64, f64)> + '_ {
        let length = to - from;
        self.iter()
            .map(move |(x, w)| (from + x * length, w * length))
    }

    /// Integral of `f` from `from` to `to`.
    #[inline(always)]
    pub fn integrate(&self, from: f64, to: f64, f: impl Fn(f64) -> f64) -> f64 {
        let length = to - from;
        let sum: f64 = self.iter().map(|(x, w)| w * f(from + x * length)).sum();
        sum * length
    }

    /// Integral of `f` from `from` to `to`, with this rule in each interval between those of `breaks` that lie inside.
    pub fn integrate_between(
        &self,
        from: f64,
        to: f64,
        breaks: &[f64],
        f: impl Fn(f64) -> f64,
    ) -> f64 {
        let inside = breaks.iter().copied().filter(|&b| b > from && b < to);
        let mut edges: Vec<f64> = inside.chain([from, to]).collect();
        edges.sort_by(f64::total_cmp);
        edges
            .windows(2)
            .map(|edge| self.integrate(edge[0], edge[1], &f))
            .sum()
    }
}

/// A Gauss-Legendre rule with the weights of the running integral up to each node.
#[derive(Clone, Debug, PartialEq)]
pub struct RunningRule {
    /// The rule.
    pub rule: GaussRule,
    /// Weights of the running integral: `[k][j]` is the weight of the integrand at node `j` in the integral from 0 to node `k`.
    /// Exact for polynomials of degree below the number of nodes.
    pub running: Vec<Vec<f64>>,
}

impl RunningRule {
    /// Rule with `count` (one or more) nodes.
    pub fn new(count: usize) -> Self {
        let rule = GaussRule::new(count);
        let pairs = &rule.pairs;
        // Lagrange polynomial that is 1 at node j and 0 at the others.
        let cardinal = |j: usize, x: f64| -> f64 {
            (0..pairs.len())
                .filter(|&k| k != j)
                .map(|k| (x - pairs[k].0) / (pairs[j].0 - pairs[k].0))
                .product()
        };
        let up_to = |end: f64| -> Vec<f64> {
            (0..pairs.len())
                .map(|j| {
                    let terms = pairs.iter();
                    terms.map(|&(x, w)| w * end * cardinal(j, x * end)).sum()
                })
                .collect()
        };
        let running = pairs.iter().map(|&(end, _)| up_to(end)).collect();
        Self { rule, running }
    }
}

/// Tricomi's initial guess of a root of `P_n`, from `cos(pi (4 i + 3) / (4 n + 2))`.
const fn tricomi(count: usize, cosine: f64) -> f64 {
    let n = count as f64;
    (1.0 - (n - 1.0) / (8.0 * n * n * n)) * cosine
}

/// The `i`-th largest root of `P_count` and its weight in an integral over `[-1, 1]`, by Newton iteration.
const fn legendre_root(i: usize, count: usize, guess: f64) -> (f64, f64) {
    let n = count as f64;
    let mut x = guess;
    let mut slope = 1.0;
    let mut round = 0;
    while round < 20 {
        let (mut before, mut now) = (1.0, x);
        let mut k = 2;
        while k <= count {
            let degree = k as f64;
            (before, now) = (
                now,
                ((2.0 * degree - 1.0) * x * now - (degree - 1.0) * before) / degree,
            );
            k += 1;
        }
        slope = n * (x * now - before) / (x * x - 1.0);
        let step = now / slope;
        x -= step;
        if step.abs() < 1e-15 {
            break;
        }
        round += 1;
    }
    if 2 * i + 1 == count {
        x = 0.0;
    }
    (x, 2.0 / ((1.0 - x * x) * slope * slope))
}

/// Cosine of an angle in `[0, pi / 2]` to 1e-6 in constant evaluation, where `f64::cos` is not available.
const fn near_cosine(angle: f64) -> f64 {
    let x = angle * angle;
    1.0 - x / 2.0 * (1.0 - x / 12.0 * (1.0 - x / 30.0 * (1.0 - x / 56.0 * (1.0 - x / 90.0))))
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn rules_are_exact_for_polynomials_of_their_degree() {
        for count in [1usize, 2, 3, 8, 12, 20, 33] {
            let rule = GaussRule::new(count);
            assert_eq!(rule.len(), count);
            for degree in 0..2 * count as i32 {
                let (got, want) = (
                    rule.integrate(-1.0, 2.0, |x| x.powi(degree)),
                    (2f64.powi(degree + 1) - (-1f64).powi(degree + 1)) / f64::from(degree + 1),
                );
                assert!(
                    (got - want).abs() < 1e-13 * 2f64.powi(degree),
                    "{count} points, degree {degree}: {got}"
                );
            }
            let nodes: Vec<f64> = rule.iter().map(|(x, _)| x).collect();
            assert!(nodes.windows(2).all(|pair| pair[0] < pair[1]));
        }
    }

    #[test]
    fn compile_time_rules_match_run_time_rules() {
        fn differ<const N: usize>() {
            let (fixed, rule) = (FixedRule::<N>::fixed(), GaussRule::new(N));
            for ((x, w), (x2, w2)) in fixed.iter().zip(rule.iter()) {
                assert!((x - x2).abs() < 3e-16 && (w - w2).abs() < 1e-15, "{N}");
            }
        }
        differ::<1>();
        differ::<3>();
        differ::<8>();
        differ::<16>();
        differ::<33>();
    }

    #[test]
    fn breaks_split_the_interval() {
        let jump = |x: f64| if x < 0.3 { 1.0 } else { 5.0 };
        let got = GaussRule::new(3).integrate_between(0.0, 1.0, &[0.3, 7.0], jump);
        assert!((got - 3.8).abs() < 1e-14);
    }

    #[test]
    fn running_integrals_are_exact_below_the_number_of_nodes() {
        let RunningRule { rule, running } = RunningRule::new(4);
        for degree in 0..4 {
            for ((end, _), row) in rule.iter().zip(&running) {
                let terms = row.iter().zip(rule.iter());
                let got: f64 = terms.map(|(w, (x, _))| w * x.powi(degree)).sum();
                let want = end.powi(degree + 1) / f64::from(degree + 1);
                assert!((got - want).abs() < 1e-13);
            }
        }
    }
}
