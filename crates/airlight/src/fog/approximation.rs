//! Two short cuts for the light scattered into a line of sight, and what they assume.
//!
//! With transmittance `T` and optical depth `tau = -ln T`, exactly: `S = int_0^tau e^-t J(t) dt`, where the source function
//! `J` is the radiance that each unit of optical depth scatters towards the eye. Neither short cut needs to know where along
//! the line `J` is large; both are exact where it is not larger anywhere. The book's chapter on fog says where they hold.

use super::lanes::Lanes;
use super::scatter;
use crate::spectrum::Spectrum;
use crate::transfer::PathOptics;

/// Constant source: `S = (1 - T) J`. Exact where `J` is the same all along the line, as in exponential fog lit evenly.
pub fn constant_source<const N: usize>(
    optical_depth: Spectrum<N>,
    source: Spectrum<N>,
) -> PathOptics<N> {
    PathOptics {
        transmittance: optical_depth.exp_neg(),
        path_radiance: source * scatter::constant_source(optical_depth),
    }
}

/// Split sum: `S = (1 - T) (1 / tau) int_0^tau J dt`, the mean of a product as the product of the means.
///
/// `mean_source` is averaged over optical depth (in uniform fog: over distance). Exact for a constant source, and to first
/// order in thin fog, where `T` is nearly 1 all along. In thick fog it forgets that the far part is dimmed more than the
/// near part: too bright where the source grows with distance, too dark where it falls.
pub fn split_sum<const N: usize>(
    optical_depth: Spectrum<N>,
    mean_source: Spectrum<N>,
) -> PathOptics<N> {
    constant_source(optical_depth, mean_source)
}

/// Relative error of the split sum for a source that falls as `e^-(k t)` with optical depth `t` from the eye (rises for
/// `k < 0`): the closed form of `split sum / exact - 1`, over a line of optical depth `tau`.
///
/// For small `tau` it is `-k tau^2 / 12`, so the split sum is good to 1 % where `|k| tau^2 < 0.12`.
pub fn split_sum_error(tau: f64, k: f64) -> f64 {
    // int e^-kt dt / tau, for either sign of k.
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

    #[test]
    fn both_are_exact_for_a_constant_source() {
        for tau in [0.0f32, 1e-6, 0.3, 4.0, 300.0] {
            let tau = Spectrum([tau; 3]);
            let source = Spectrum([0.2, 0.3, 0.4]);
            let got = constant_source(tau, source);
            assert_eq!(got, split_sum(tau, source));
            let exact = source.0.map(|j| j * (1.0 - (-tau[0]).exp()));
            for lane in 0..3 {
                assert!((got.path_radiance[lane] - exact[lane]).abs() < 1e-7);
            }
        }
        assert_eq!(split_sum_error(2.0, 0.0), 0.0);
    }

    #[test]
    fn the_error_of_the_split_sum_is_what_quadrature_says() {
        let rule = GaussRule::new(40);
        for (tau, k) in [(0.1, 1.0), (0.5, -1.0), (2.0, 0.5), (3.0, -0.3), (1.0, 5.0)] {
            let exact = rule.integrate(0.0, tau, |t| (-(1.0 + k) * t).exp());
            let mean = rule.integrate(0.0, tau, |t| (-k * t).exp()) / tau;
            let split = (1.0 - (-tau).exp()) * mean;
            assert!((split_sum_error(tau, k) - (split / exact - 1.0)).abs() < 1e-12);
        }
        // The rule of thumb, on both sides of the 1 % line.
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
