//! Closed forms for a point light in uniform, isotropically scattering fog: exact in f64, and fast in lanes.
//!
//! All functions return `int T(t) / (4 pi r^2) dt` in 1/m. Multiply by radiant intensity and scattering coefficient for the path
//! radiance. Derivation: `docs/src/lights.md`.

use super::geometry::LightRayGeometry;
use super::march::Nodes;
use crate::fog::closed_forms::Lanes;
use crate::math::quadrature::FixedRule;
use crate::spectrum::Spectrum;
use std::f64::consts::{LN_2, PI};

/// Without extinction: `theta / (4 pi h)`, with the angle `theta` that the ray subtends at the light (after Macklin 2010, whose
/// arctangent is wrong by pi for some rays).
///
/// Exact to rounding (a few 1e-16) for any geometry: light ahead, passed, behind or beside the eye, finite or infinite ray.
#[inline]
pub fn airlight_without_extinction(geometry: &LightRayGeometry) -> f64 {
    geometry.angle() / (4.0 * PI * geometry.nearest_m)
}

/// With extinction (1/m, not negative) between light, fog and eye:
///
/// `e^-(sigma r_0) / (2 pi h) int_(w_0)^(w_1) e^-(x (w - w_0)) / (1 + w^2) dw`, `x = sigma h`, `w = tan v`
/// (the integral that Sun, Ramamoorthi, Narasimhan and Nayar 2005 tabulate, in closed form).
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
    dimmed / (2.0 * PI * h) * finite(x, first, rise, 0.5 * geometry.angle())
}

/// `int_0^rise e^-(x s) / (1 + (first + s)^2) ds`, `angle = atan(first + rise) - atan(first)`.
fn finite(x: f64, first: f64, rise: f64, angle: f64) -> f64 {
    let last = first + rise;
    // The difference of two infinite integrals cancels only for thin segments that are short compared with what lies beyond.
    // There the integrand is nearly a polynomial of the angle.
    if x * rise < LN_2 && angle <= (1.0 / last).atan() {
        return short(x, first, angle);
    }
    let beyond = if rise.is_finite() {
        (-x * rise).exp() * infinite(x, last)
    } else {
        0.0
    };
    infinite(x, first) - beyond
}

/// `e^(x w) int_w^inf e^-(x w') / (1 + w'^2) dw' = Im(e^z E1(z))`, `z = x (w - i)`.
fn infinite(x: f64, w: f64) -> f64 {
    scaled_exponential_integral(x * w, -x).1
}

/// Gauss-Legendre quadrature in the angle: with 16 points the error is below 1e-16 if the singularity at a right angle is at least
/// one interval away and the optical depth at most ln 2.
fn short(x: f64, first: f64, angle: f64) -> f64 {
    static RULE: FixedRule<16> = FixedRule::fixed();
    RULE.integrate(0.0, angle, |part| {
        let tan = part.tan();
        let rise = tan * (1.0 + first * first) / (1.0 - first * tan);
        (-x * rise).exp()
    })
}

/// Approximation of [`airlight_isotropic`] by quadrature: an error below 5e-6 with 12 nodes, in a fraction of the time.
pub fn airlight_isotropic_fast(
    geometry: &LightRayGeometry,
    extinction_per_m: f64,
    nodes: &Nodes,
) -> f64 {
    airlight_isotropic_lanes(geometry, extinction_per_m, nodes)
}

/// Number types with a cube root.
pub(super) trait CubeRoot: Lanes {
    /// Cube root of numbers that are not negative.
    fn cube_root(self) -> Self;
}

impl CubeRoot for f64 {
    #[inline(always)]
    fn cube_root(self) -> Self {
        self.cbrt()
    }
}

impl<const N: usize> CubeRoot for Spectrum<N> {
    #[inline(always)]
    fn cube_root(self) -> Self {
        (self.ln() * (1.0 / 3.0)).exp()
    }
}

/// [`airlight_isotropic`] for `f64` or the lanes of a [`Spectrum`], each with its own extinction (1/m).
///
/// With `m^2 = h^2 + a^2` and `c = a / m` it is `e^-(sigma r_0) / (2 pi m) int_0^(E / m) e^-(X s) / (1 + 2 c s + s^2) ds`,
/// `X = sigma m`. Besides `1 / X` the only scale of the integrand is 1, so that Gauss nodes in `q`, with `s = (1 - q^3) / q^3`, suit
/// all cases. The integral of each lane ends where its light is negligible.
///
/// Largest relative error with 8, 10, 12, 16, 20 nodes: 1.25e-4, 2e-5, 5e-6, 1.1e-6, 3.5e-7 (f64; h, start and length from 1e-6 m
/// to 1e7 m and infinite, optical depths from 1e-6 to 600: test `errors_of_the_fast_form`). In f32 rounding adds 2e-6 plus 1e-7
/// times the optical depth, and light attenuated below `e^-87` is 0.
#[inline]
pub(super) fn airlight_isotropic_lanes<V: CubeRoot>(
    geometry: &LightRayGeometry,
    extinction_per_m: V,
    nodes: &Nodes,
) -> V {
    let ahead = geometry.ahead_at_start();
    let scale = geometry.nearest_m.hypot(ahead);
    let spread = V::splat(2.0 * ahead / scale);
    let one = V::splat(1.0);
    let x = extinction_per_m * V::splat(scale);
    // Inverse of the end of the integral: end of the ray, or where e^-(X s) is negligible.
    // Bounded by the range of f32, for very short rays.
    let inverse = V::splat((scale / geometry.excess_m()).min(1e30))
        .larger(x * V::splat(1.0 / nodes.cutoff_depth()));
    let covered = one / (one + inverse);
    let last = (inverse * covered).cube_root();
    let span = covered / (one + last + last * last);
    let mut sum = V::splat(0.0);
    for (place, weight) in nodes.iter() {
        let z = span * V::splat(place);
        let q = one - z;
        let p = q * q * q;
        let y = z * (V::splat(3.0) + z * (z - V::splat(3.0)));
        let fall = p * p + y * (spread * p + y);
        let both = one / (p * fall);
        let dimmed = (x * y * fall * both).exp_neg();
        sum = sum + V::splat(3.0 * weight) * q * q * p * both * dimmed;
    }
    let arriving = (extinction_per_m * V::splat(geometry.distance_m(0.0))).exp_neg();
    V::splat(0.5 / (PI * scale)) * arriving * span * sum
}

/// Euler's constant.
const EULER: f64 = 0.577_215_664_901_532_9;

/// Real and imaginary part of `e^z E1(z)`, `E1(z) = int_z^inf e^-y / y dy`, for `z = re + i im` in the right half plane,
/// `re >= 0`, `z != 0` (Abramowitz & Stegun 1964, 5.1.11 below `|z| = 2`, 5.1.22 in its even form elsewhere).
///
/// Relative error below 1e-13 for each part separately, even if the imaginary part is 1e13 times smaller.
fn scaled_exponential_integral(re: f64, im: f64) -> (f64, f64) {
    if re * re + im * im <= 4.0 {
        series(re, im)
    } else {
        fraction(re, im)
    }
}

/// `E1(z) = -gamma - ln z - sum_(k>=1) (-z)^k / (k k!)`, times `e^z`.
fn series(re: f64, im: f64) -> (f64, f64) {
    let mut power = (1.0, 0.0);
    let mut sum = (0.0, 0.0);
    for k in 1..=32 {
        let k = f64::from(k);
        power = (
            -(power.0 * re - power.1 * im) / k,
            -(power.0 * im + power.1 * re) / k,
        );
        sum = (sum.0 + power.0 / k, sum.1 + power.1 / k);
    }
    let e1 = (-EULER - re.hypot(im).ln() - sum.0, -im.atan2(re) - sum.1);
    let (sin, cos) = im.sin_cos();
    let size = re.exp();
    (
        size * (cos * e1.0 - sin * e1.1),
        size * (sin * e1.0 + cos * e1.1),
    )
}

/// Continued fraction `1 / (z + 1 - 1 / (z + 3 - 4 / (z + 5 - 9 / (z + 7 - ...))))`, evaluated backwards. The error after n terms is
/// about `e^(-4 sqrt(n |z|) cos(arg z / 2))`; the number of terms is chosen for 1e-15.
fn fraction(re: f64, im: f64) -> (f64, f64) {
    let terms = 6 + (160.0 / (re.hypot(im) + re)) as u32;
    let mut rest = (0.0, 0.0);
    for n in (1..=terms).rev() {
        let n = f64::from(n);
        let below = (re + 2.0 * n + 1.0 - rest.0, im - rest.1);
        let square = n * n / (below.0 * below.0 + below.1 * below.1);
        rest = (below.0 * square, -below.1 * square);
    }
    let below = (re + 1.0 - rest.0, im - rest.1);
    let square = below.0 * below.0 + below.1 * below.1;
    (below.0 / square, -below.1 / square)
}

#[cfg(test)]
mod tests;
