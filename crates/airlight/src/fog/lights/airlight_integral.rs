//! The light of a lamp that uniform fog scatters equally in all directions into a line of sight: exact, in f64.
//!
//! All functions give `int T(t) / (4 pi r^2) dt` in 1/m: times the lamp's radiant intensity and the scattering coefficient
//! that is the path radiance. Derivation: `docs/src/lights.md`.

use super::exponential_integral::scaled;
use super::geometry::LightRayGeometry;
use crate::math::quadrature::FixedRule;
use std::f64::consts::{LN_2, PI};

/// Without extinction: `theta / (4 pi h)`, with the angle `theta` under which the lamp sees the line (after Macklin 2010,
/// whose arctangent is off by pi where the lamp is passed).
///
/// Exact to rounding (a few 1e-16) for any passage: lamp ahead, passed, behind, beside the eye; line finite or endless.
#[inline]
pub fn airlight_without_extinction(geometry: &LightRayGeometry) -> f64 {
    geometry.angle() / (4.0 * PI * geometry.nearest_m)
}

/// With extinction on both legs, from the lamp to the fog and from the fog to the eye (1/m, not below 0):
///
/// `e^-(sigma r_0) / (2 pi h) int_(w_0)^(w_1) e^-(x (w - w_0)) / (1 + w^2) dw`, `x = sigma h`, `w = tan v`
/// (the integral of Sun, Ramamoorthi, Narasimhan and Nayar 2005, with a closed form for what they tabulate).
///
/// Relative error below 1e-13 plus 1e-16 times the optical depth.
pub fn airlight_isotropic(geometry: &LightRayGeometry, extinction_per_m: f64) -> f64 {
    if extinction_per_m == 0.0 {
        return airlight_without_extinction(geometry);
    }
    let h = geometry.nearest_m;
    let x = extinction_per_m * h;
    let first = geometry.ahead_at_start() / h;
    let rise = geometry.excess_m() / h;
    let dimmed = (-extinction_per_m * geometry.distance_m(0.0)).exp();
    dimmed / (2.0 * PI * h) * stretch(x, first, rise, 0.5 * geometry.angle())
}

/// `int_0^rise e^-(x s) / (1 + (first + s)^2) ds`, `angle = atan(first + rise) - atan(first)`.
fn stretch(x: f64, first: f64, rise: f64, angle: f64) -> f64 {
    let last = first + rise;
    // Two endless integrals nearly cancel only where the stretch is thin and short against what lies beyond; there the
    // integrand is all but a polynomial of the angle.
    if x * rise < LN_2 && angle <= (1.0 / last).atan() {
        return short(x, first, angle);
    }
    let beyond = if rise.is_finite() {
        (-x * rise).exp() * endless(x, last)
    } else {
        0.0
    };
    endless(x, first) - beyond
}

/// `e^(x w) int_w^inf e^-(x w') / (1 + w'^2) dw' = Im(e^z E1(z))`, `z = x (w - i)`.
fn endless(x: f64, w: f64) -> f64 {
    scaled(x * w, -x).1
}

/// Gauss-Legendre in the angle: 16 points leave less than 1e-16 where the singularity at a right angle is at least a whole
/// interval away and the optical depth at most ln 2.
fn short(x: f64, first: f64, angle: f64) -> f64 {
    static RULE: FixedRule<16> = FixedRule::fixed();
    RULE.integrate(0.0, angle, |part| {
        let tan = part.tan();
        let rise = tan * (1.0 + first * first) / (1.0 - first * tan);
        (-x * rise).exp()
    })
}

#[cfg(test)]
mod tests;
