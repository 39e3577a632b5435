//! Ray marching in panels with a Gauss rule in each.

use crate::math::quadrature::RunningRule;
use crate::transfer::ray::{Ray, in_shadow};
use crate::transfer::shell::{MAX_CONSTITUENTS, PerConstituent, Shell};
use std::ops::ControlFlow;

/// Largest number of nodes in a panel.
pub const MAX_NODES: usize = 4;

/// Largest number of pieces of a panel; light is extinguished long before the last of them.
const MAX_PIECES: usize = 1 << 16;

/// A quadrature node on a ray.
#[derive(Clone, Copy, Debug)]
pub struct Node {
    /// Distance from the eye, m.
    pub t: f64,
    /// Quadrature weight, m.
    pub dt: f64,
    /// The ray relative to this point.
    pub here: Ray,
    /// Relative densities.
    pub densities: PerConstituent,
    /// Columns from the eye to the node, m.
    pub columns_m: PerConstituent,
    /// True if the sun is above the planet's limb.
    pub lit: bool,
}

impl Default for Node {
    fn default() -> Self {
        Self {
            t: 0.0,
            dt: 0.0,
            here: Ray {
                radius_m: 1.0,
                mu: 1.0,
                mu_sun: 1.0,
                nu: 1.0,
            },
            densities: [0.0; MAX_CONSTITUENTS],
            columns_m: [0.0; MAX_CONSTITUENTS],
            lit: true,
        }
    }
}

/// A step of a march: a panel, or a piece of one.
#[derive(Clone, Copy, Debug)]
pub struct Step<'a> {
    /// Distances from the eye to its ends, m.
    pub from_m: f64,
    pub to_m: f64,
    /// Columns from the eye to the step, m.
    pub columns_m: PerConstituent,
    /// Quadrature nodes in the step.
    pub nodes: &'a [Node],
}

impl Step<'_> {
    /// Columns from the eye to the end of the step, m.
    #[inline(always)]
    pub fn columns_behind_m(&self) -> PerConstituent {
        let mut columns_m = self.columns_m;
        for node in self.nodes {
            for (column, density) in columns_m.iter_mut().zip(&node.densities) {
                *column += node.dt * density;
            }
        }
        columns_m
    }
}

/// Step size and quadrature of a march.
#[derive(Clone, Debug)]
pub struct Marcher<'a> {
    /// Boundaries of panels.
    radii_m: &'a [f64],
    rule: RunningRule,
    /// Largest optical depth of a panel in any lane.
    max_panel_depth: f64,
    /// Largest extinction of each constituent over the wavelengths, 1/m at density 1.
    max_extinction_per_m: PerConstituent,
}

impl<'a> Marcher<'a> {
    /// Marcher with panels between these radii, of at most `max_panel_depth` optical depth, and `nodes` nodes (1 to 4).
    pub fn new(
        radii_m: &'a [f64],
        nodes: usize,
        max_panel_depth: f64,
        max_extinction_per_m: PerConstituent,
    ) -> Self {
        assert!((1..=MAX_NODES).contains(&nodes));
        Self {
            radii_m,
            rule: RunningRule::new(nodes),
            max_panel_depth,
            max_extinction_per_m,
        }
    }

    /// Calls `visit` with each step from `start_m` to `end_m`, until it breaks; returns the columns up to there.
    /// `edges` is scratch space.
    #[inline(always)]
    pub fn march(
        &self,
        shell: &Shell,
        ray: &Ray,
        (start_m, end_m): (f64, f64),
        edges: &mut Vec<f64>,
        mut visit: impl FnMut(&Step<'_>) -> ControlFlow<()>,
    ) -> PerConstituent {
        panel_edges(shell, self.radii_m, ray, (start_m, end_m), edges);
        let mut columns = [0.0; MAX_CONSTITUENTS];
        for window in edges.windows(2) {
            let pieces = self.pieces(shell, ray, window[0], window[1]);
            let length = (window[1] - window[0]) / pieces as f64;
            for piece in 0..pieces {
                let from = window[0] + piece as f64 * length;
                let mut nodes = [Node::default(); MAX_NODES];
                let step = self.step(shell, ray, (from, from + length), &columns, &mut nodes);
                columns = step.columns_behind_m();
                if visit(&step).is_break() {
                    return columns;
                }
            }
        }
        columns
    }

    /// One step behind these columns; `nodes` receives its nodes.
    #[inline(always)]
    pub fn step<'n>(
        &self,
        shell: &Shell,
        ray: &Ray,
        (from_m, to_m): (f64, f64),
        columns_m: &PerConstituent,
        nodes: &'n mut [Node; MAX_NODES],
    ) -> Step<'n> {
        let RunningRule { rule, running } = &self.rule;
        let nodes = &mut nodes[..rule.len()];
        for (node, (t, dt)) in nodes.iter_mut().zip(rule.on(from_m, to_m)) {
            let here = ray.advanced(t);
            *node = Node {
                t,
                dt,
                here,
                densities: shell.densities_at(here.radius_m),
                columns_m: *columns_m,
                lit: !in_shadow(here.radius_m, here.mu_sun, shell.ground_radius_m),
            };
        }
        for k in 0..nodes.len() {
            for c in 0..shell.constituents() {
                let inside: f64 = (0..nodes.len())
                    .map(|j| running[k][j] * nodes[j].densities[c])
                    .sum();
                nodes[k].columns_m[c] += (to_m - from_m) * inside;
            }
        }
        Step {
            from_m,
            to_m,
            columns_m: *columns_m,
            nodes,
        }
    }

    /// Number of pieces into which a panel is divided to limit its optical depth.
    #[inline(always)]
    fn pieces(&self, shell: &Shell, ray: &Ray, from: f64, to: f64) -> usize {
        let extinction = |t: f64| -> f64 {
            let densities = shell.densities_at(ray.radius_at(t));
            (0..shell.constituents())
                .map(|c| densities[c] * self.max_extinction_per_m[c])
                .sum()
        };
        let mean = (extinction(from) + 4.0 * extinction(0.5 * (from + to)) + extinction(to)) / 6.0;
        ((mean * (to - from) / self.max_panel_depth).ceil() as usize).clamp(1, MAX_PIECES)
    }
}

/// Fills `edges` with increasing distances from `start_m` to `end_m`: where a density has a kink or has changed enough, the
/// lowest point of the ray, and where the sunlight changes abruptly.
#[inline(always)]
pub(super) fn panel_edges(
    shell: &Shell,
    radii_m: &[f64],
    ray: &Ray,
    (start_m, end_m): (f64, f64),
    edges: &mut Vec<f64>,
) {
    edges.clear();
    edges.push(start_m);
    let mut add = |t: f64| {
        if t > start_m && t < end_m {
            edges.push(t);
        }
    };
    let closest = ray.closest_approach_m();
    let tangent = ray.tangent_radius_m();
    add(closest);
    for &radius in radii_m {
        if radius > tangent {
            let half_chord = ((radius - tangent) * (radius + tangent)).sqrt();
            add(closest - half_chord);
            add(closest + half_chord);
        }
    }
    for &radius_m in &shell.shadow_radii_m {
        for edge in ray.shadow_edges(radius_m).into_iter().flatten() {
            add(edge);
        }
    }
    edges.push(end_m);
    edges.sort_unstable_by(f64::total_cmp);
}
