//! Closed forms of single scattering, and functions of optical depth that all fog solvers share.
//!
//! Let `t` be the optical depth from the eye, and let the light that arrives at each point be attenuated by the optical depth
//! `d(t)` between the point and the top of the fog. If `d(t) = d_near + slope t` is linear, a unit source contributes
//!
//! ```text
//! int_0^tau e^-(d(t) + t) dt = tau (e^-a - e^-b) / (b - a),    a = d_near,  b = d_far + tau
//! ```
//!
//! the divided difference of `e^-x` times the optical depth. Over flat ground `d` is linear in `t` for every density profile
//! that depends on height only: `d` is the vertical optical depth divided by the sine of the sun's elevation, and `t` changes
//! as the vertical optical depth divided by the sine of the ray's elevation. For the exponential profile this is Ishiyama's
//! integral (2018, eq. 20) with attenuated sunlight. There are no special cases: level rays and rays that rise as steeply as
//! the sun (`a = b`) are included.

use crate::spectrum::Spectrum;
use crate::transfer::PathOptics;
use std::ops::{Add, Div, Mul, Sub};

/// Upper bound of columns and optical depths: opaque, and far below the largest f32.
pub(super) const OPAQUE: f64 = 1e25;

/// Number type of the closed forms: `f64` or the lanes of a [`Spectrum`].
pub(crate) trait Lanes:
    Copy + Add<Output = Self> + Sub<Output = Self> + Mul<Output = Self> + Div<Output = Self>
{
    /// The same value in every lane.
    fn splat(value: f64) -> Self;

    /// `e^-x`; 0 where it underflows (`x > 87` for f32).
    fn exp_neg(self) -> Self;

    /// `(1 - e^-x) / x` for `x >= 0`, 1 at 0: mean transmittance over optical depths from 0 to `x`. Relative error below
    /// 1e-15 in f64, 2e-7 in f32, also for large `x`.
    fn mean_transmittance(self) -> Self;

    /// `((1 - e^-x) / x - e^-x) / x` for `x >= 0`, 1/2 at 0: mean of `e^-t t / x` over optical depths from 0 to `x`.
    /// Relative error below 1e-13 in f64, 1e-6 in f32.
    fn ramp_transmittance(self) -> Self;

    /// The smaller of each lane of two.
    fn smaller(self, other: Self) -> Self;

    /// The larger of each lane of two.
    fn larger(self, other: Self) -> Self;

    /// The absolute value.
    fn abs(self) -> Self;
}

impl Lanes for f64 {
    #[inline(always)]
    fn splat(value: f64) -> Self {
        value
    }

    #[inline(always)]
    fn exp_neg(self) -> Self {
        (-self).exp()
    }

    #[inline(always)]
    fn mean_transmittance(self) -> Self {
        if self < 1e-8 {
            1.0 - 0.5 * self
        } else {
            -(-self).exp_m1() / self
        }
    }

    #[inline(always)]
    fn ramp_transmittance(self) -> Self {
        if self < 0.5 {
            // The k-th term is (-x)^k (k + 1) / (k + 2)!.
            let mut term = 0.5;
            let mut sum = term;
            for k in 1..16 {
                let k = f64::from(k);
                term *= -self * (k + 1.0) / (k * (k + 2.0));
                sum += term;
            }
            sum
        } else {
            (self.mean_transmittance() - (-self).exp()) / self
        }
    }

    #[inline(always)]
    fn smaller(self, other: Self) -> Self {
        self.min(other)
    }

    #[inline(always)]
    fn larger(self, other: Self) -> Self {
        self.max(other)
    }

    #[inline(always)]
    fn abs(self) -> Self {
        f64::abs(self)
    }
}

impl<const N: usize> Lanes for Spectrum<N> {
    #[inline(always)]
    fn splat(value: f64) -> Self {
        Spectrum::splat(value as f32)
    }

    #[inline(always)]
    fn exp_neg(self) -> Self {
        // The exponential of lanes is clamped at e^-87.
        let e = self.map(|x| -x).exp();
        Self::from_fn(|i| if self[i] < 87.0 { e[i] } else { 0.0 })
    }

    #[inline(always)]
    fn mean_transmittance(self) -> Self {
        let e = self.map(|x| -x).exp();
        Self::from_fn(|i| {
            let x = self[i];
            // Taylor series to x^7 / 8!. Both branches are evaluated, so that the loop vectorizes.
            let series = 1.0
                + x * (-1.0 / 2.0
                    + x * (1.0 / 6.0
                        + x * (-1.0 / 24.0
                            + x * (1.0 / 120.0
                                + x * (-1.0 / 720.0 + x * (1.0 / 5040.0 - x / 40320.0))))));
            let direct = (1.0 - e[i]) / x;
            if x < 0.75 { series } else { direct }
        })
    }

    #[inline(always)]
    fn ramp_transmittance(self) -> Self {
        let e = self.map(|x| -x).exp();
        Self::from_fn(|i| {
            let x = self[i];
            let series = 1.0 / 2.0
                + x * (-1.0 / 3.0
                    + x * (1.0 / 8.0
                        + x * (-1.0 / 30.0
                            + x * (1.0 / 144.0
                                + x * (-1.0 / 840.0 + x * (1.0 / 5760.0 - x / 45360.0))))));
            let direct = ((1.0 - e[i]) / x - e[i]) / x;
            if x < 0.75 { series } else { direct }
        })
    }

    #[inline(always)]
    fn smaller(self, other: Self) -> Self {
        Self::from_fn(|i| {
            if self[i] < other[i] {
                self[i]
            } else {
                other[i]
            }
        })
    }

    #[inline(always)]
    fn larger(self, other: Self) -> Self {
        Self::from_fn(|i| {
            if self[i] > other[i] {
                self[i]
            } else {
                other[i]
            }
        })
    }

    #[inline(always)]
    fn abs(self) -> Self {
        self.map(f32::abs)
    }
}

/// Mean of `e^-(d + t)` along a ray: the contribution of a unit source per unit of optical depth. `near` is `d` at the near end,
/// `far` is `d` at the far end plus the optical depth along the ray. Exact to rounding for arguments from 0 to 1e30, as no
/// exponent is a difference.
#[inline(always)]
pub(crate) fn mean_attenuated_source<L: Lanes>(near: L, far: L) -> L {
    near.smaller(far).exp_neg() * (far - near).abs().mean_transmittance()
}

/// Path optics of a constant source function `J` (radiance scattered towards the eye per unit of optical depth):
/// `S = (1 - T) J`. Exact if `J` is constant along the ray, as in uniformly lit exponential fog.
///
/// With the mean of `J` over optical depth it is the split sum, which replaces the mean of a product by the product of the
/// means: exact to first order in thin fog. In thick fog it neglects that the far part is attenuated more than the near part
/// ([`split_sum_error`]).
pub(crate) fn constant_source<const N: usize>(
    optical_depth: Spectrum<N>,
    source: Spectrum<N>,
) -> PathOptics<N> {
    PathOptics {
        transmittance: optical_depth.exp_neg(),
        path_radiance: source * (optical_depth * optical_depth.mean_transmittance()),
    }
}

/// Weights of the near and the far end of a segment for a source that is linear in optical depth, per unit of optical depth:
/// `1/tau int_0^tau e^-t (near (1 - t/tau) + far t/tau) dt = w_near near + w_far far`.
#[inline(always)]
pub(crate) fn linear_source_mean<L: Lanes>(along: L) -> (L, L) {
    let far = along.ramp_transmittance();
    (along.mean_transmittance() - far, far)
}

/// Relative error `split sum / exact - 1` over a ray of optical depth `tau`, for a source `e^-(k t)` at optical depth `t` from
/// the eye. Closed form.
///
/// For small `tau` it is `-k tau^2 / 12`, so the error of the split sum is below 1 % if `|k| tau^2 < 0.12`.
pub fn split_sum_error(tau: f64, k: f64) -> f64 {
    // (1 - e^-x) / x for either sign of x.
    let mean = |x: f64| {
        if x.abs() < 1e-8 {
            1.0 - 0.5 * x
        } else {
            -(-x).exp_m1() / x
        }
    };
    mean(tau) * mean(k * tau) / mean((1.0 + k) * tau) - 1.0
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::math::quadrature::GaussRule;

    /// `int_0^tau f(t) e^-t dt` by quadrature in intervals that shrink towards both ends.
    fn weighted(tau: f64, f: impl Fn(f64) -> f64) -> f64 {
        let breaks: Vec<f64> = (0..120)
            .flat_map(|k| {
                let step = tau * 0.75f64.powi(k);
                [step, tau - step]
            })
            .collect();
        let mut breaks = breaks;
        breaks.sort_by(f64::total_cmp);
        GaussRule::new(16).integrate_between(0.0, tau, &breaks, f)
    }

    #[test]
    fn attenuated_sources_match_quadrature() {
        for tau in [1e-9, 1e-4, 0.1, 1.0, 7.0, 40.0] {
            for near in [0.0, 1e-6, 0.3, 5.0, 30.0] {
                for slope in [
                    -1.0 + 1e-12,
                    -1.0 - 1e-9,
                    -1.0,
                    -0.5,
                    0.0,
                    1e-9,
                    3.0,
                    -4.0,
                    200.0,
                ] {
                    if near + slope * tau < 0.0 {
                        continue;
                    }
                    let exact = weighted(tau, |t| (-(near + slope * t) - t).exp());
                    let far = near + (1.0 + slope) * tau;
                    let got = tau * mean_attenuated_source(near, far);
                    assert!(
                        (got / exact - 1.0).abs() < 1e-9,
                        "{tau} {near} {slope}: {got} {exact}"
                    );
                    let lane = Spectrum::<4>::splat;
                    let lane =
                        mean_attenuated_source(lane(near as f32), lane(far as f32))[1] * tau as f32;
                    assert!(
                        (f64::from(lane) / exact - 1.0).abs() < 1e-5,
                        "f32: {tau} {near} {slope}: {lane} {exact}"
                    );
                }
            }
        }
    }

    #[test]
    fn linear_sources_match_quadrature() {
        for tau in [1e-9, 1e-4, 1e-2, 0.3, 1.0, 7.0, 40.0] {
            let exact = weighted(tau, |t| (-t).exp() * t / tau);
            let opaque = weighted(tau, |t| (-t).exp());
            let (near, far) = linear_source_mean(tau);
            let (near, far) = (tau * near, tau * far);
            assert!((far / exact - 1.0).abs() < 1e-9, "{tau}: {far} {exact}");
            assert!(((near + far) / opaque - 1.0).abs() < 1e-12);
            let (_, far) = linear_source_mean(Spectrum::<4>::splat(tau as f32));
            let far = tau * f64::from(far[0]);
            assert!((far / exact - 1.0).abs() < 1e-5, "{tau}: {far} {exact}");
        }
    }

    #[test]
    fn opaque_fog_is_finite() {
        assert!((1e30 * mean_attenuated_source(0.0, 1e30) - 1.0).abs() < 1e-12);
        assert!((1e30 * mean_attenuated_source(0.0, 0.5e30) - 2.0).abs() < 1e-12);
        let lane = Spectrum::<2>::splat;
        assert!((mean_attenuated_source(lane(0.0), lane(1e30))[0] * 1e30 - 1.0).abs() < 1e-6);
        assert_eq!(mean_attenuated_source(lane(1e30), lane(2e30))[0], 0.0);
        // Sunlight that enters at the far end through thick fog.
        let entering = mean_attenuated_source(lane(1e9), lane(5.0))[0];
        assert!((f64::from(entering) / (1e-9 * (-5f64).exp()) - 1.0).abs() < 1e-6);
        let opaque = constant_source(lane(1e30), Spectrum::ONE).path_radiance;
        assert!((opaque[0] - 1.0).abs() < 1e-6);
    }

    #[test]
    fn the_mean_transmittance_is_exact_from_clear_to_opaque() {
        let mut x = 1e-12f64;
        while x < 1e30 {
            // exp_m1 is exact to an ulp. Round x to f32 first.
            let lane = x as f32;
            let rounded = f64::from(lane);
            let exact = -(-rounded).exp_m1() / rounded;
            let got = f64::from(Spectrum([lane; 4]).mean_transmittance()[3]);
            assert!(
                (got / exact - 1.0).abs() < 4e-7,
                "{x}: {got} against {exact}"
            );
            assert!((x.mean_transmittance() / (-(-x).exp_m1() / x) - 1.0).abs() < 1e-14);
            x *= 1.37;
        }
        assert_eq!(0.0.mean_transmittance(), 1.0);
        assert_eq!(Spectrum::<2>::ZERO.mean_transmittance(), Spectrum::ONE);
        assert_eq!(Spectrum::<2>::splat(100.0).exp_neg(), Spectrum::ZERO);
    }

    #[test]
    fn a_constant_source_is_exact() {
        for tau in [0.0f32, 1e-6, 0.3, 4.0, 300.0] {
            let tau = Spectrum([tau; 3]);
            let source = Spectrum([0.2, 0.3, 0.4]);
            let got = constant_source(tau, source);
            let exact = source.0.map(|j| j * (1.0 - (-tau[0]).exp()));
            for lane in 0..3 {
                assert!((got.path_radiance[lane] - exact[lane]).abs() < 1e-7);
            }
        }
        assert_eq!(split_sum_error(2.0, 0.0), 0.0);
    }

    #[test]
    fn the_error_of_the_split_sum_matches_quadrature() {
        let rule = GaussRule::new(40);
        for (tau, k) in [(0.1, 1.0), (0.5, -1.0), (2.0, 0.5), (3.0, -0.3), (1.0, 5.0)] {
            let exact = rule.integrate(0.0, tau, |t| (-(1.0 + k) * t).exp());
            let mean = rule.integrate(0.0, tau, |t| (-k * t).exp()) / tau;
            let split = (1.0 - (-tau).exp()) * mean;
            assert!((split_sum_error(tau, k) - (split / exact - 1.0)).abs() < 1e-12);
        }
        // The rule for 1 %.
        for k in [-0.9, -0.2, 0.2, 0.9] {
            let tau = (0.12 / f64::abs(k)).sqrt();
            assert!(
                (split_sum_error(tau, k).abs() - 0.01).abs() < 0.0015,
                "{k}: {}",
                split_sum_error(tau, k)
            );
        }
    }
}
