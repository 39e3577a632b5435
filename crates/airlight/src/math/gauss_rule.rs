//! Gauss-Legendre rules, with the running integral up to each node.

use crate::math::quadrature::gauss_legendre;

/// A Gauss-Legendre rule on `[0, 1]`.
#[derive(Clone, Debug)]
pub struct GaussRule {
    /// Nodes in increasing order.
    pub nodes: Vec<f64>,
    /// Weights, adding up to 1.
    pub weights: Vec<f64>,
    /// `running[k][j]`: the weight of the integrand at node `j` in the integral from 0 to node `k`. Exact for
    /// polynomials of degree below the number of nodes.
    pub running: Vec<Vec<f64>>,
}

impl GaussRule {
    /// The rule with `count` nodes.
    pub fn new(count: usize) -> Self {
        let (nodes, weights) = gauss_legendre(count);
        let nodes: Vec<f64> = nodes.iter().map(|x| 0.5 + 0.5 * x).collect();
        let weights: Vec<f64> = weights.iter().map(|w| 0.5 * w).collect();
        let running = nodes
            .iter()
            .map(|&end| {
                (0..count)
                    .map(|j| integrate_cardinal(&nodes, &weights, j, end))
                    .collect()
            })
            .collect();
        Self {
            nodes,
            weights,
            running,
        }
    }

    /// Nodes and weights of this rule on `[from, to]`.
    pub fn on(&self, from: f64, to: f64) -> impl Iterator<Item = (f64, f64)> + '_ {
        let length = to - from;
        self.nodes
            .iter()
            .zip(&self.weights)
            .map(move |(&x, &w)| (from + x * length, w * length))
    }
}

/// Integral from 0 to `end` of the polynomial that is 1 at node `j` and 0 at the others.
fn integrate_cardinal(nodes: &[f64], weights: &[f64], j: usize, end: f64) -> f64 {
    let cardinal = |x: f64| -> f64 {
        (0..nodes.len())
            .filter(|&k| k != j)
            .map(|k| (x - nodes[k]) / (nodes[j] - nodes[k]))
            .product()
    };
    nodes
        .iter()
        .zip(weights)
        .map(|(&x, &w)| w * end * cardinal(x * end))
        .sum()
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn rules_integrate_polynomials_exactly() {
        for count in 1..=20 {
            let rule = GaussRule::new(count);
            for degree in 0..2 * count {
                let got: f64 = rule
                    .on(0.0, 1.0)
                    .map(|(x, w)| w * x.powi(degree as i32))
                    .sum();
                assert!(
                    (got - 1.0 / (degree as f64 + 1.0)).abs() < 1e-13,
                    "{count} {degree}"
                );
            }
        }
    }

    #[test]
    fn running_integrals_are_exact_below_the_number_of_nodes() {
        let rule = GaussRule::new(4);
        for degree in 0..4 {
            for (k, row) in rule.running.iter().enumerate() {
                let got: f64 = row
                    .iter()
                    .zip(&rule.nodes)
                    .map(|(w, x)| w * x.powi(degree))
                    .sum();
                let want = rule.nodes[k].powi(degree + 1) / f64::from(degree + 1);
                assert!((got - want).abs() < 1e-13);
            }
        }
    }
}
