//! Quadrature nodes on a ray through exponentially thinning air.
//!
//! From the lowest point of a segment, density falls as `exp(-climb / H)` and light is lost within a mean free path; both are
//! smooth functions of the logarithm of the distance. So a segment is mapped by `d = c (e^(k s) - 1)`, with `d` the distance
//! from its lowest point and `c` the smaller of a mean free path and the distance over which the ray climbs the scale height
//! of haze, and integrated by one Gauss-Legendre rule over `s`.

use super::constants as c;
use crate::math::quadrature::{GaussRule, RunningRule};
use crate::transfer::columns::slant_columns;
use crate::transfer::ray::Ray;

/// Largest step next to the densest point, m: a mean free path of blue light at sea level.
const MEAN_FREE_PATH_M: f64 = 15e3;

/// Columns in metres at sea-level density: with a scale height of 8 km, and of haze.
pub type Columns = [f64; 2];

/// A quadrature node on the view ray.
pub struct Node {
    /// The ray relative to this point.
    pub here: Ray,
    /// Quadrature weight, m.
    pub dt: f64,
    /// Relative densities.
    pub densities: [f64; 2],
    /// Columns from the eye to the node.
    pub columns: Columns,
}

/// Relative densities at an altitude.
pub fn densities(altitude_m: f64) -> [f64; 2] {
    [c::RAYLEIGH_SCALE_HEIGHT_M, c::MIE_SCALE_HEIGHT_M].map(|h| (-altitude_m / h).exp())
}

/// Parameters `c` and `k` of the map of a segment of `length` that ascends from its lowest point at `radius_m` with zenith
/// cosine `mu >= 0`.
fn log_map(radius_m: f64, mu: f64, length: f64) -> (f64, f64) {
    let (b, h) = (radius_m * mu, c::MIE_SCALE_HEIGHT_M);
    let climb = h * (2.0 * radius_m + h) / (b + (b * b + h * (2.0 * radius_m + h)).sqrt());
    let scale = climb.min(MEAN_FREE_PATH_M);
    (scale, (length / scale).ln_1p())
}

/// Columns from `radius_m` to space along an ascending ray (`mu >= 0`).
pub fn columns_up(rule: &GaussRule, radius_m: f64, mu: f64) -> Columns {
    let ray = Ray {
        radius_m,
        mu,
        mu_sun: 0.0,
        nu: 0.0,
    };
    let Some((_, length)) = ray.crossings(c::TOP_RADIUS_M) else {
        return [0.0; 2];
    };
    let (scale, k) = log_map(radius_m, mu, length);
    let mut columns = [0.0; 2];
    for (s, w) in rule.iter() {
        let growth = (k * s).exp();
        let altitude = radius_m - c::PLANET_RADIUS_M + ray.climb_at(scale * (growth - 1.0));
        let dt = w * scale * k * growth;
        for (column, density) in columns.iter_mut().zip(densities(altitude)) {
            *column += dt * density;
        }
    }
    columns
}

/// Columns from `radius_m` to space along a ray that misses the ground.
pub fn columns_to_space(rule: &GaussRule, radius_m: f64, mu: f64) -> Columns {
    slant_columns((radius_m, mu), c::PLANET_RADIUS_M, |radius_m, mu| {
        columns_up(rule, radius_m, mu)
    })
}

/// Calls `visit` with the nodes of the view ray from the eye to `end_m`; returns the columns of the whole ray. The ray is
/// split at its lowest point and at the edges of the planet's shadow.
pub fn march(
    RunningRule { rule, running }: &RunningRule,
    ray: &Ray,
    end_m: f64,
    mut visit: impl FnMut(&Node),
) -> Columns {
    let closest = ray.closest_approach_m();
    let mut edges = vec![0.0];
    let [first, second] = ray.shadow_edges(c::PLANET_RADIUS_M);
    for t in [Some(closest), first, second].into_iter().flatten() {
        if t > 0.0 && t < end_m {
            edges.push(t);
        }
    }
    edges.push(end_m);
    edges.sort_by(f64::total_cmp);
    let mut before = [0.0; 2];
    let count = rule.len();
    let mut nodes: Vec<Node> = Vec::with_capacity(count);
    for edge in edges.windows(2) {
        let (from, to) = (edge[0], edge[1]);
        let climbs = 0.5 * (from + to) >= closest;
        let low = ray.advanced(if climbs { from } else { to });
        let (scale, k) = log_map(low.radius_m, low.mu.abs(), to - from);
        nodes.clear();
        for (s, _) in rule.iter() {
            let growth = (k * s).exp();
            let d = scale * (growth - 1.0);
            let t = if climbs { from + d } else { to - d };
            let altitude = ray.radius_m - c::PLANET_RADIUS_M + ray.climb_at(t);
            nodes.push(Node {
                here: ray.advanced(t),
                // Multiplied by the quadrature weight below.
                dt: scale * k * growth,
                densities: densities(altitude),
                columns: [0.0; 2],
            });
        }
        let whole: Columns = [0, 1].map(|i| {
            let terms = nodes.iter().zip(rule.iter());
            terms.map(|(n, (_, w))| w * n.dt * n.densities[i]).sum()
        });
        for at in 0..count {
            for i in 0..2 {
                let low_to_here: f64 = (0..count)
                    .map(|j| running[at][j] * nodes[j].dt * nodes[j].densities[i])
                    .sum();
                nodes[at].columns[i] = before[i]
                    + if climbs {
                        low_to_here
                    } else {
                        whole[i] - low_to_here
                    };
            }
        }
        for (node, (_, w)) in nodes.iter_mut().zip(rule.iter()) {
            node.dt *= w;
            visit(node);
        }
        before = [0, 1].map(|i| before[i] + whole[i]);
    }
    before
}
