//! Ray marching in panels with a Gauss rule in each.

use crate::math::exponentials::count_exponentials;
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

/// Densities inside a step, interpolated between its nodes: for rays that cross the same heights and divide the step at distances of their
/// own. Of a density and its logarithm, the one is interpolated of which the polynomial through the nodes has the smaller highest term:
/// air decays exponentially, layers begin linearly.
#[derive(Clone, Copy, Debug)]
pub struct StepDensities {
    from_m: f64,
    per_m: f64,
    constituents: usize,
    /// Places of the nodes in the step, from 0 to 1; [`StepDensities::nodes`] of them.
    places: [f64; MAX_NODES],
    nodes: usize,
    /// Divided differences of the densities, or of their logarithms, by order.
    differences: [PerConstituent; MAX_NODES],
    is_logarithm: [bool; MAX_CONSTITUENTS],
}

impl StepDensities {
    /// Densities between two distances, m, through those at nodes, by distance: at most [`MAX_NODES`].
    fn new(
        (from_m, to_m): (f64, f64),
        nodes: impl Iterator<Item = (f64, PerConstituent)>,
        constituents: usize,
    ) -> Self {
        let mut out = Self {
            from_m,
            per_m: (to_m - from_m).recip(),
            constituents,
            places: [0.0; MAX_NODES],
            nodes: 0,
            differences: [[0.0; MAX_CONSTITUENTS]; MAX_NODES],
            is_logarithm: [false; MAX_CONSTITUENTS],
        };
        for (t, densities) in nodes {
            out.places[out.nodes] = (t - from_m) * out.per_m;
            out.differences[out.nodes] = densities;
            out.nodes += 1;
        }
        let (places, differences) = (&out.places[..out.nodes], &mut out.differences[..out.nodes]);
        for c in 0..constituents {
            let mut densities = [0.0; MAX_NODES];
            for (density, at_node) in densities.iter_mut().zip(&*differences) {
                *density = at_node[c];
            }
            let densities = &mut densities[..places.len()];
            let most = densities.iter().copied().fold(0.0, f64::max);
            let mut logarithms = [0.0; MAX_NODES];
            let logarithms = &mut logarithms[..places.len()];
            if densities.iter().all(|&density| density > 0.0) {
                count_exponentials(densities.len());
                for (logarithm, density) in logarithms.iter_mut().zip(&*densities) {
                    *logarithm = density.ln();
                }
                divide(places, logarithms);
            } else {
                logarithms.fill(f64::INFINITY);
            }
            divide(places, densities);
            let highest = places.len() - 1;
            out.is_logarithm[c] = logarithms[highest].abs() * most < densities[highest].abs();
            let chosen = if out.is_logarithm[c] {
                logarithms
            } else {
                densities
            };
            for (at_node, chosen) in differences.iter_mut().zip(chosen) {
                at_node[c] = *chosen;
            }
        }
        out
    }

    /// Relative densities at a distance in the step, m.
    #[inline(always)]
    pub fn at(&self, t: f64) -> PerConstituent {
        let place = (t - self.from_m) * self.per_m;
        let mut out = self.differences[self.nodes - 1];
        for k in (0..self.nodes - 1).rev() {
            for (value, difference) in out.iter_mut().zip(&self.differences[k]) {
                *value = difference + (place - self.places[k]) * *value;
            }
        }
        let is_logarithm = &self.is_logarithm[..self.constituents];
        for (value, is_logarithm) in out.iter_mut().zip(is_logarithm) {
            if *is_logarithm {
                count_exponentials(1);
                *value = value.exp();
            } else {
                *value = value.max(0.0);
            }
        }
        out
    }
}

/// Replaces values at places by their divided differences, by order.
fn divide(places: &[f64], values: &mut [f64]) {
    for order in 1..places.len() {
        for k in (order..places.len()).rev() {
            values[k] = (values[k] - values[k - 1]) / (places[k] - places[k - order]);
        }
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
    fn step<'n>(
        &self,
        shell: &Shell,
        ray: &Ray,
        span_m: (f64, f64),
        columns_m: &PerConstituent,
        nodes: &'n mut [Node; MAX_NODES],
    ) -> Step<'n> {
        let densities = |_, radius_m| shell.densities_at(radius_m);
        self.step_through(shell, ray, span_m, columns_m, densities, nodes)
    }

    /// As [`Marcher::step`], through air of the densities at a distance and a radius, m.
    #[inline(always)]
    pub fn step_through<'n>(
        &self,
        shell: &Shell,
        ray: &Ray,
        (from_m, to_m): (f64, f64),
        columns_m: &PerConstituent,
        densities: impl Fn(f64, f64) -> PerConstituent,
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
                densities: densities(t, here.radius_m),
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

    /// Densities between the nodes of a step, by their distances; `None` if there are fewer than [`MAX_NODES`], and in air that is too thin for
    /// its panel to resolve it.
    pub fn densities_between(
        &self,
        shell: &Shell,
        ends_m: (f64, f64),
        nodes: impl Iterator<Item = (f64, PerConstituent)> + Clone,
    ) -> Option<StepDensities> {
        /// Largest factor between the extinctions at the nodes of a panel that follows the air.
        const LARGEST_FACTOR: f64 = 7.0;
        let extinctions = nodes
            .clone()
            .map(|(_, at_node)| self.extinction(shell, &at_node));
        let least = extinctions.clone().fold(f64::INFINITY, f64::min);
        let most = extinctions.fold(0.0, f64::max);
        let is_resolved = nodes.clone().count() == MAX_NODES && most <= LARGEST_FACTOR * least;
        is_resolved.then(|| StepDensities::new(ends_m, nodes, shell.constituents()))
    }

    /// Largest extinction of these densities over the wavelengths, 1/m.
    #[inline(always)]
    fn extinction(&self, shell: &Shell, densities: &PerConstituent) -> f64 {
        (0..shell.constituents())
            .map(|c| densities[c] * self.max_extinction_per_m[c])
            .sum()
    }

    /// Number of pieces into which a panel is divided to limit its optical depth.
    #[inline(always)]
    fn pieces(&self, shell: &Shell, ray: &Ray, from: f64, to: f64) -> usize {
        let extinction = |t: f64| self.extinction(shell, &shell.densities_at(ray.radius_at(t)));
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

#[cfg(test)]
mod tests {
    use super::*;

    /// Of air that decays, along the level and upwards, by as much as in the panels of a sky and by more, and of a layer that begins, densities
    /// between the nodes are those of the profiles.
    #[test]
    fn densities_between_nodes_are_those_of_the_air() {
        const RADIUS_M: f64 = 6.36e6;
        let rule = RunningRule::new(4).rule;
        for (sine, length_m) in [(0.0, 4.4e5), (0.0, 5e5), (0.02, 3e5), (1.0, 1.36e4)] {
            let squared_m2 = |t: f64| RADIUS_M.powi(2) + 2.0 * RADIUS_M * sine * t + t * t;
            let height_m = |t: f64| squared_m2(t).sqrt() - RADIUS_M;
            let of = |t: f64| {
                let mut densities = [0.0; MAX_CONSTITUENTS];
                densities[0] = (-height_m(t) / 8e3).exp();
                densities[1] = t / length_m;
                densities
            };
            let ends_m = (1e3, 1e3 + length_m);
            let nodes = rule.on(0.0, length_m).map(|(t, _)| (1e3 + t, of(t)));
            let between = StepDensities::new(ends_m, nodes, 2);
            for k in 0..=20 {
                let t = f64::from(k) / 20.0 * length_m;
                let (got, right) = (between.at(1e3 + t), of(t));
                assert!((got[0] / right[0] - 1.0).abs() < 1e-4, "{got:?} {right:?}");
                assert!((got[1] - right[1]).abs() < 1e-12, "{got:?} {right:?}");
                assert_eq!(got[2..], right[2..]);
            }
        }
    }
}
