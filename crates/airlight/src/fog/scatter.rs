//! Light scattered once into a line of sight, in closed form.
//!
//! Let `t` be the optical depth walked from the eye and let light arrive at each point dimmed by the optical depth `d(t)`
//! between the point and the top of the fog. Where both fall in step, `d(t) = d_near + (slope) t`, what reaches the eye of
//! a unit source is
//!
//! ```text
//! int_0^tau e^-(d(t) + t) dt = tau (e^-a - e^-b) / (b - a),    a = d_near,  b = d_far + tau
//! ```
//!
//! the divided difference of `e^-x`, times the optical depth. In air whose density depends on height alone over flat ground
//! the two do fall in step, whatever the profile: `d` is the vertical optical depth over the sine of the sun's elevation,
//! and `t` changes as the vertical optical depth over the climb. For the exponential profile this is Ishiyama's integral
//! (2018, eq. 20) with the sun's own dimming, and it needs no special case: not where the line is level (climb 0), not
//! where it climbs as the sun does (`a = b`).

use super::lanes::Lanes;

/// `int_0^along e^-(near + slope t) e^-t dt` with `growth = (1 + slope) along`, the growth of the whole exponent from the
/// near to the far end: what of a unit source arrives. Relative error of rounding only; any argument may be huge (up to
/// 1e30), `near` and `along` must not be negative, nor may `near + growth`.
#[inline(always)]
pub fn once<L: Lanes>(near: L, growth: L, along: L) -> L {
    along * mean_once(near, growth)
}

/// [`once`] for each unit of optical depth: the mean of `e^-(d + t)` along the line.
#[inline(always)]
pub fn mean_once<L: Lanes>(near: L, growth: L) -> L {
    (near + growth.min_zero()).exp_neg() * growth.abs().mean_transmittance()
}

/// The same for a source that is not dimmed: `1 - e^-along`, exact where `along` is tiny.
#[inline(always)]
pub fn constant_source<L: Lanes>(along: L) -> L {
    along * along.mean_transmittance()
}

/// The two weights of a source that changes linearly with optical depth from the near end to the far end of a stretch, for
/// each unit of its optical depth: `1/tau int_0^tau e^-t (near (1 - t/tau) + far t/tau) dt = w_near near + w_far far`.
#[inline(always)]
pub fn linear_source_mean<L: Lanes>(along: L) -> (L, L) {
    let far = along.ramp_transmittance();
    (along.mean_transmittance() - far, far)
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::math::quadrature::GaussRule;
    use crate::spectrum::Spectrum;

    /// `int_0^tau f(t) e^-t dt` by quadrature in stretches that crowd to both ends.
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
    fn sunlight_scattered_once_matches_quadrature() {
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
                    let growth = (1.0 + slope) * tau;
                    let got = once(near, growth, tau);
                    assert!(
                        (got / exact - 1.0).abs() < 1e-9,
                        "{tau} {near} {slope}: {got} {exact}"
                    );
                    let lane = Spectrum::<4>::splat;
                    let lane = once(lane(near as f32), lane(growth as f32), lane(tau as f32))[1];
                    assert!(
                        (f64::from(lane) / exact - 1.0).abs() < 1e-5,
                        "f32: {tau} {near} {slope}: {lane} {exact}"
                    );
                }
            }
        }
    }

    #[test]
    fn a_source_that_changes_linearly_matches_quadrature() {
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
    fn the_thickest_fog_is_finite() {
        assert!((once(0.0, 1e30, 1e30) - 1.0).abs() < 1e-12);
        assert!((once(0.0, 0.5e30, 1e30) - 2.0).abs() < 1e-12);
        let lane = Spectrum::<2>::splat;
        assert!((once(lane(0.0), lane(1e30), lane(1e30))[0] - 1.0).abs() < 1e-6);
        assert_eq!(once(lane(1e30), lane(1e30), lane(1e30))[0], 0.0);
        assert!((constant_source(lane(1e30))[0] - 1.0).abs() < 1e-6);
    }
}
