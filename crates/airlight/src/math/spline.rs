//! Quadrature weights for the product of a smooth function, known at some nodes, and a kernel that is not smooth.

/// Smallest number of nodes for a spline; fewer are interpolated linearly.
const SPLINE_NODES: usize = 5;

/// Weights `w_k` such that `sum_k w_k r(node_k)` is the integral over `first..=last` of `kernel(x) r(x)`, with `r`
/// interpolated between the nodes (natural cubic spline from 5 nodes on, linearly below) and constant beyond the end nodes.
/// Trapezoidal rule in steps of `step`.
///
/// Linear interpolation gives weights with the kernel's sign; a spline through 3 or 4 nodes does not. `nodes` must be
/// strictly increasing and not empty.
pub fn product_weights(
    nodes: &[f64],
    (first, last): (f64, f64),
    step: f64,
    kernel: impl Fn(f64) -> [f64; 3],
) -> Vec<[f64; 3]> {
    let n = nodes.len();
    let spline = n >= SPLINE_NODES;
    // The interpolant is linear in the values r_k and in the second derivatives m_k: accumulate the integrals that multiply
    // each, then express those of m_k through the r_k.
    let mut values = vec![[0.0; 3]; n];
    let mut curvatures = vec![[0.0; 3]; n];
    let steps = ((last - first) / step).round() as usize;
    for i in 0..=steps {
        let x = first + i as f64 * step;
        let end = if i == 0 || i == steps { 0.5 } else { 1.0 };
        let k = kernel(x).map(|v| v * step * end);
        let above = nodes.partition_point(|&node| node <= x);
        if above == 0 || above == n {
            add(&mut values[above.min(n - 1)], k, 1.0);
            continue;
        }
        let h = nodes[above] - nodes[above - 1];
        let t = (x - nodes[above - 1]) / h;
        let s = 1.0 - t;
        add(&mut values[above - 1], k, s);
        add(&mut values[above], k, t);
        if spline {
            add(&mut curvatures[above - 1], k, (s * s * s - s) * h * h / 6.0);
            add(&mut curvatures[above], k, (t * t * t - t) * h * h / 6.0);
        }
    }
    if spline {
        absorb_curvatures(nodes, &mut values, curvatures);
    }
    values
}

fn add(sum: &mut [f64; 3], term: [f64; 3], factor: f64) {
    for (s, t) in sum.iter_mut().zip(term) {
        *s += t * factor;
    }
}

/// Adds the weights of the second derivatives to those of the values.
///
/// The second derivatives of the natural spline are `m = A^-1 B r` with A symmetric and tridiagonal, so
/// `c . m = (B^T A^-1 c) . r`: one tridiagonal solve gives the weights of all nodes.
fn absorb_curvatures(nodes: &[f64], values: &mut [[f64; 3]], mut c: Vec<[f64; 3]>) {
    let last = nodes.len() - 1;
    let h: Vec<f64> = nodes.windows(2).map(|pair| pair[1] - pair[0]).collect();
    // Elimination over the inner nodes 1..last; the second derivative is 0 at the end nodes.
    let mut diagonal = vec![0.0; last];
    for i in 1..last {
        diagonal[i] = 2.0 * (h[i - 1] + h[i]);
        if i > 1 {
            let factor = h[i - 1] / diagonal[i - 1];
            diagonal[i] -= factor * h[i - 1];
            let before = c[i - 1];
            add(&mut c[i], before, -factor);
        }
    }
    for i in (1..last).rev() {
        if i + 1 < last {
            let after = c[i + 1];
            add(&mut c[i], after, -h[i]);
        }
        c[i] = c[i].map(|v| v / diagonal[i]);
    }
    for i in 1..last {
        let (left, right) = (6.0 / h[i - 1], 6.0 / h[i]);
        add(&mut values[i - 1], c[i], left);
        add(&mut values[i], c[i], -left - right);
        add(&mut values[i + 1], c[i], right);
    }
}

/// Mean of `curve` about each node, weighted by a symmetric triangle that extends half-way to the nearer neighbour, at most
/// `max_half_width`. A single node uses `max_half_width`.
pub fn local_means(nodes: &[f64], max_half_width: f64, curve: impl Fn(f64) -> f64) -> Vec<f64> {
    const INTERVALS: i32 = 80;
    (0..nodes.len())
        .map(|k| {
            let below = k
                .checked_sub(1)
                .map_or(f64::INFINITY, |b| nodes[k] - nodes[b]);
            let above = nodes.get(k + 1).map_or(f64::INFINITY, |a| a - nodes[k]);
            let half_width = (below.min(above) / 2.0).min(max_half_width);
            let (mut sum, mut total) = (0.0, 0.0);
            for j in -INTERVALS..=INTERVALS {
                let offset = j as f64 / INTERVALS as f64;
                let weight = 1.0 - offset.abs();
                sum += weight * curve(nodes[k] + offset * half_width);
                total += weight;
            }
            sum / total
        })
        .collect()
}

#[cfg(test)]
mod tests {
    use super::*;

    const STEP: f64 = 0.5;
    const NODES: [f64; 7] = [370.0, 400.0, 437.5, 505.0, 560.0, 633.0, 810.0];

    fn kernel(nm: f64) -> [f64; 3] {
        [1.0, nm / 500.0, (nm / 30.0).sin()]
    }

    fn integral(f: impl Fn(f64) -> f64) -> [f64; 3] {
        let mut sum = [0.0; 3];
        for step in 0..=940 {
            let nm = 360.0 + step as f64 * STEP;
            let end = if step % 940 == 0 { 0.5 } else { 1.0 };
            add(&mut sum, kernel(nm), f(nm) * end * STEP);
        }
        sum
    }

    fn close(got: [f64; 3], want: [f64; 3]) {
        for i in 0..3 {
            assert!(
                (got[i] - want[i]).abs() < 1e-9 * want[1].abs(),
                "{got:?} against {want:?}"
            );
        }
    }

    fn weighted(nodes: &[f64], r: impl Fn(f64) -> f64) -> [f64; 3] {
        let mut sum = [0.0; 3];
        for (&node, w) in nodes
            .iter()
            .zip(product_weights(nodes, (360.0, 830.0), STEP, kernel))
        {
            add(&mut sum, w, r(node));
        }
        sum
    }

    #[test]
    fn linear_responses_are_integrated_exactly() {
        for nodes in [&NODES[2..3], &NODES[2..5], &NODES[1..6], &NODES[..]] {
            let (first, last) = (nodes[0], nodes[nodes.len() - 1]);
            let line = |nm: f64| 3.0 - nm.clamp(first, last) / 400.0;
            close(weighted(nodes, line), integral(line));
        }
    }

    #[test]
    fn weights_integrate_the_natural_spline() {
        // Second derivatives by relaxation of the spline equations: slow, but independent of the adjoint solve.
        let r = |nm: f64| (nm / 90.0).sin() + 2.0;
        let y: Vec<f64> = NODES.iter().map(|&x| r(x)).collect();
        let mut m = [0.0; 7];
        for _ in 0..400 {
            for i in 1..6 {
                let (a, b) = (NODES[i] - NODES[i - 1], NODES[i + 1] - NODES[i]);
                let rhs = 6.0 * ((y[i + 1] - y[i]) / b - (y[i] - y[i - 1]) / a);
                m[i] = (rhs - a * m[i - 1] - b * m[i + 1]) / (2.0 * (a + b));
            }
        }
        let spline = |nm: f64| {
            let x = nm.clamp(NODES[0], NODES[6]);
            let i = NODES.partition_point(|&node| node <= x).clamp(1, 6);
            let h = NODES[i] - NODES[i - 1];
            let (p, q) = (NODES[i] - x, x - NODES[i - 1]);
            (m[i - 1] * p.powi(3) + m[i] * q.powi(3)) / (6.0 * h)
                + (y[i - 1] / h - m[i - 1] * h / 6.0) * p
                + (y[i] / h - m[i] * h / 6.0) * q
        };
        close(weighted(&NODES, r), integral(spline));
    }

    #[test]
    fn local_means_preserve_linear_functions_and_stay_local() {
        let means = local_means(&NODES, 20.0, |nm| 2.0 * nm);
        for (mean, node) in means.iter().zip(NODES) {
            assert!((mean - 2.0 * node).abs() < 1e-9);
        }
        // Half-way between 370 and 400 is 385.
        assert_eq!(
            local_means(&NODES, 20.0, |nm| if nm < 385.0 { 1.0 } else { 0.0 })[1],
            0.0
        );
        assert!(
            (local_means(&[500.0], 20.0, |nm| (nm - 500.0).abs())[0] - 20.0 / 3.0).abs() < 0.01
        );
    }
}
