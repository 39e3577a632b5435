//! Where the integrals along a line are sampled.

use crate::math::quadrature::GaussRule;

/// A Gauss-Legendre rule on `[0, 1]`, made once.
#[derive(Clone, Debug, PartialEq)]
pub struct Nodes {
    rule: GaussRule,
}

impl Nodes {
    /// A rule of `count` nodes; at least 1.
    pub fn new(count: usize) -> Self {
        Self {
            rule: GaussRule::new(count.max(1)),
        }
    }

    /// How many nodes.
    pub fn count(&self) -> usize {
        self.rule.len()
    }

    /// Place and weight of each node.
    #[inline]
    pub(super) fn iter(&self) -> impl Iterator<Item = (f64, f64)> + '_ {
        self.rule.iter()
    }

    /// The optical depth after which an integral is cut off: what is left out, `e^-depth`, is less than what the rule is
    /// wrong by.
    #[inline]
    pub(super) fn spent(&self) -> f64 {
        10.0 + self.count() as f64 / 3.0
    }

    /// Nodes for `int_0^end f(s) ds` of a function that is smooth over the scale `scale` at 0 and over ever larger ones
    /// beyond: `s = scale (1 - p) / p` with `p = q^3`, and Gauss's nodes in `q`, from 1 at `s = 0` to 0 at infinity. Calls
    /// `visit(s, ds)`.
    #[inline(always)]
    pub(super) fn visit(&self, scale: f64, end: f64, mut visit: impl FnMut(f64, f64)) {
        // 1 / (end / scale) is 0 for an endless line.
        let inverse = scale / end;
        let covered = 1.0 / (1.0 + inverse);
        let last = (inverse * covered).cbrt();
        let span = covered / (1.0 + last + last * last);
        for (place, weight) in self.rule.iter() {
            let z = span * place;
            let q = 1.0 - z;
            let p = q * q * q;
            let s = scale * z * (3.0 - 3.0 * z + z * z) / p;
            visit(s, 3.0 * weight * span * scale / (q * p));
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn what_falls_off_over_its_scale_is_integrated_well() {
        let nodes = Nodes::new(12);
        for scale in [1e-6, 1.0, 1e5] {
            for end in [1e-9, 1e-3, 1.0, 1e4, 1e12, f64::INFINITY] {
                let mut sum = 0.0;
                nodes.visit(scale, end * scale, |s, ds| {
                    sum += ds / (scale * (1.0 + (s / scale).powi(2)));
                });
                let exact = end.atan();
                assert!((sum / exact - 1.0).abs() < 1e-5, "{scale}, {end}: {sum}");
            }
        }
    }
}
