//! Adaptive Simpson quadrature over all wavelengths, which reuses the previous result (section 8).

use super::lanes::Lanes;
use crate::math::simpson::{adaptive_simpson, simpson};

/// Relative tolerance of each wavelength (relative to at least [`DIM`] times the brightest); 16 times that where the integrand jumps.
const TOLERANCE: f32 = 1e-4;
/// Largest number of halvings, reached where the integrand jumps at the edge of the planet's shadow.
const MAX_DEPTH: u32 = 18;
/// Smallest value relative to the brightest wavelength for which the tolerance is relative: at sunset blue vanishes.
const DIM: f32 = 1e-3;

/// An integrator that stores its last integral.
#[derive(Clone, Debug)]
pub(super) struct Simpson {
    /// Relative difference of first estimates up to which the previous result is reused; 0 to disable.
    alike: f32,
    /// First estimate and result.
    last: Option<(Lanes, Lanes)>,
}

impl Simpson {
    /// Integrator that reuses the previous result if first estimates differ by at most `alike` (relative).
    pub fn new(alike: f32) -> Self {
        Self { alike, last: None }
    }

    /// Integral over `[0, 1]`, or the previous result if Simpson's rule on the whole interval is nearly unchanged.
    pub fn integrate(&mut self, f: impl Fn(f64) -> Lanes) -> Lanes {
        let ends = [f(0.0), f(0.5), f(1.0)];
        let first = simpson(&ends, 1.0);
        if let Some((known, result)) = &self.last
            && close(known, &first, self.alike)
        {
            return *result;
        }
        let mut result = Lanes::ZERO;
        adaptive_simpson(
            &f,
            (0.0, 1.0),
            &ends,
            &first,
            &mut result,
            MAX_DEPTH,
            &accurate,
        );
        self.last = Some((first, result));
        result
    }
}

/// True if Simpson's rule on two halves agrees with that on the whole to 15 times the tolerance, relative to the sum so far or
/// to the panel itself: integrands here are brightest near the eye, where the sum begins.
fn accurate(both: &Lanes, whole: &Lanes, sum: &Lanes) -> bool {
    let floor = DIM * sum.max_element().max(both.max_element());
    (0..both.0.len()).all(|i| {
        let measure = both.0[i].max(sum.0[i]).max(floor);
        (both.0[i] - whole.0[i]).abs() <= 15.0 * TOLERANCE * measure
    })
}

/// True if all wavelengths agree.
fn close(a: &Lanes, b: &Lanes, part: f32) -> bool {
    let floor = DIM * b.max_element();
    part > 0.0 && (0..a.0.len()).all(|i| (a.0[i] - b.0[i]).abs() <= part * b.0[i].max(floor))
}

#[cfg(test)]
mod tests {
    use super::*;
    use std::cell::Cell;

    #[test]
    fn exponentials_of_any_depth_are_integrated_accurately() {
        for deepest in [0.1f64, 3.0, 30.0, 300.0] {
            let rate = |i: usize| deepest * (i as f64 + 1.0) / 33.0;
            let got =
                Simpson::new(0.0).integrate(|x| Lanes::from_fn(|i| (-rate(i) * x).exp() as f32));
            for i in 0..33 {
                let want = -(-rate(i)).exp_m1() / rate(i);
                let error = f64::from(got.0[i]) / want - 1.0;
                assert!(error.abs() < 3e-4, "{deepest}, lane {i}: {error}");
            }
        }
    }

    #[test]
    fn jumps_stop_at_the_largest_depth() {
        let evaluations = Cell::new(0);
        let got = Simpson::new(0.0).integrate(|x| {
            evaluations.set(evaluations.get() + 1);
            Lanes::splat(if x < 0.3 { 1.0 } else { 0.0 })
        });
        // 15 times the tolerance, and a fifteenth from Richardson's correction.
        let error = (got.0[0] / 0.3 - 1.0).abs();
        assert!(error < 16.0 * TOLERANCE, "{error}");
        assert!(evaluations.get() < 100, "{evaluations:?}");
    }

    #[test]
    fn previous_result_is_reused_for_nearly_equal_integrands() {
        let mut simpson = Simpson::new(1e-3);
        let evaluations = Cell::new(0);
        let of = |rate: f64| {
            let evaluations = &evaluations;
            move |x: f64| {
                evaluations.set(evaluations.get() + 1);
                Lanes::splat((-rate * x).exp() as f32)
            }
        };
        let first = simpson.integrate(of(1.0));
        let before = evaluations.get();
        assert_eq!(simpson.integrate(of(1.001)), first);
        assert_eq!(evaluations.get(), before + 3);
        assert_ne!(simpson.integrate(of(1.1)), first);
    }
}
