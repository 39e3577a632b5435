//! Quadrature nodes on a ray, weighted by the light that a fog removes.

use crate::atmosphere::RaySegment;
use crate::fog::FogLanes;
use crate::math::quadrature::FixedRule;

/// Gauss-Legendre nodes and weights on `[0, 1]`.
static RULE: FixedRule<3> = FixedRule::fixed();
/// Tolerance of a node, in the logarithm of the optical depth up to it.
const TOLERANCE: f64 = 5e-3;

/// Number of nodes.
pub(super) const PLACES: usize = RULE.pairs().len();

/// Distances (m) on a ray of finite length, with weights: the mean of a smooth `f(s)` over the light that the fog removes,
/// `int f(s) dT / (T - 1)`, is the weighted sum of `f`. They are Gauss-Legendre nodes in the fraction of light removed, for
/// the fog's middle lane. `None` for an optical depth below `1e-5`.
#[inline]
pub(super) fn of<const N: usize>(
    fog: &FogLanes<N>,
    line: &RaySegment,
) -> Option<[(f64, f64); PLACES]> {
    let lane = N / 2;
    let depth_to = |s: f64| {
        let part = RaySegment {
            length_m: s,
            ..*line
        };
        f64::from(fog.optical_depth(&part)[lane])
    };
    let whole = depth_to(line.length_m);
    if whole < 1e-5 {
        return None;
    }
    let lost = -(-whole).exp_m1();
    let extinction = |s: f64| f64::from(fog.extinction_per_m(line.height_at(s))[lane]);
    let mut from = (0.0, 0.0);
    Some(RULE.pairs().map(|(part, weight)| {
        let wanted = -(-part * lost).ln_1p();
        let s = place(&depth_to, &extinction, from, (line.length_m, whole), wanted);
        from = (s, wanted * (1.0 - 2.0 * TOLERANCE));
        (s, weight)
    }))
}

/// Distance at which the optical depth reaches `wanted`, between two pairs of distance and optical depth: Newton's method
/// in the logarithm of the depth, which converges in one step in uniform fog (from the eye) and in fog whose density
/// increases exponentially; bisection where a step leaves the interval.
#[inline]
fn place(
    depth_to: &impl Fn(f64) -> f64,
    extinction: &impl Fn(f64) -> f64,
    mut low: (f64, f64),
    mut high: (f64, f64),
    wanted: f64,
) -> f64 {
    let near = extinction(low.0);
    let mut s = low.0 + (wanted - low.1) / near;
    for _ in 0..24 {
        if !(s > low.0 && s < high.0) {
            s = 0.5 * (low.0 + high.0);
        }
        let depth = depth_to(s);
        let off = (depth / wanted).ln();
        if off.abs() < TOLERANCE {
            break;
        }
        match off < 0.0 {
            true => low = (s, depth),
            false => high = (s, depth),
        }
        s -= off * depth / extinction(s);
    }
    s
}
