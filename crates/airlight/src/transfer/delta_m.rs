//! Delta-M: the forward peak of a phase function, which a solver's moments cannot resolve, counts as unscattered.
//!
//! Wiscombe (J. Atmos. Sci. 34, 1408, 1977): with `f` the moment of the first degree that the solver leaves out, the fraction
//! `f` of the scattering continues straight on, the scattering coefficient shrinks by `1 - f`, and the moments become
//! `(chi_l - f) / (1 - f)`. Sunlight scattered once beyond the peak is then computed with the exact phase function, attenuated
//! as if the peak did not scatter (TMS: Nakajima & Tanaka, J. Quant. Spectrosc. Radiat. Transfer 40, 51, 1988).
//!
//! That is right where the phase function beyond the moments, the *residual* `q`, changes little over the width of the peak:
//! not towards the sun. There light scattered n times by the peak has the width of `q` convolved n times with itself, `q_n`
//! (moments `chi_l^n`): how much of `q` is lost to further scattering and not replaced depends on the angle. Over a scattering
//! optical depth `t` along collinear paths the exact series is `exp(-t) sum t^n / n! q_n`. Expressed as single scattering with an
//! extinction of its own, `t q exp(-(1 - r) t)`, it gives the fraction of the scattering that replaces its own loss,
//!
//! ```text
//! r = ln( sum_l (2 l + 1) / (4 pi) (exp(t chi_l) - 1) P_l / (t q) ) / t,    sum over the degrees left out
//! ```
//!
//! which is `q_2 / (2 q)` in thin fog and `f` in thick fog.

use crate::math::interpolation::Place;
use crate::math::legendre::legendre_series;
use crate::math::real::Real;
use crate::optics::PhaseFunction;

/// Number of moments summed for the convolved phase functions.
const MOMENTS: usize = 800;
/// Scattering optical depth below which the fog is thin, and that beyond which the peak no longer changes.
const DEPTHS: (f64, f64) = (1e-3, 60.0);
/// Number of intervals of the table in the sine of half the angle.
const INTERVALS: usize = 128;

/// The fraction of the scattering in the forward peak: the moment of the first degree left out, at most `most`.
#[inline(always)]
pub fn peak_fraction<T: Real>(first_moment_left_out: T, most: f64) -> T {
    let (none, most) = (T::of(0.0), T::of(most));
    match first_moment_left_out {
        moment if moment < none => none,
        moment if moment > most => most,
        moment => moment,
    }
}

/// A phase function at one wavelength, divided into a forward peak and the moments of degrees below `DEGREES`.
#[derive(Clone, Debug)]
pub struct ForwardPeak<const DEGREES: usize> {
    /// Legendre moments, the peak included.
    pub moments: [f64; DEGREES],
    /// Fraction of the scattering that counts as unscattered, `f`.
    pub fraction: f64,
    /// Sine of half the angle at which the residual first vanishes.
    edge: f64,
    /// Fraction that counts as unscattered for the residual, at even steps from 0 to the edge.
    table: Vec<f32>,
}

impl<const DEGREES: usize> ForwardPeak<DEGREES> {
    /// Divides a phase function, for light that passes a scattering optical depth.
    pub fn new(phase: &PhaseFunction, wavelength_nm: f64, depth: f64) -> Self {
        let chi = phase.legendre_moments(MOMENTS, wavelength_nm);
        let moments = std::array::from_fn(|l| chi[l]);
        let fraction = peak_fraction(chi[DEGREES], 0.9999);
        let mut peak = Self {
            moments,
            fraction,
            edge: 0.0,
            table: Vec::new(),
        };
        if fraction < 1e-6 {
            return peak;
        }
        let depth = depth.clamp(DEPTHS.0, DEPTHS.1);
        // Moments of all orders of collinear scattering, per unit of optical depth.
        let orders: Vec<f64> = chi.iter().map(|c| (depth * c).exp_m1() / depth).collect();
        let residual =
            |mu: f64| phase.evaluate(mu, wavelength_nm) - legendre_series(&chi[..DEGREES], mu);
        // The first zero of the residual, outwards from the sun.
        let cosine = |half_sine: f64| 1.0 - 2.0 * half_sine * half_sine;
        let step = 1.0 / 512.0;
        peak.edge = (1..512)
            .map(|k| f64::from(k) * step)
            .find(|&s| residual(cosine(s)) <= 0.0)
            .unwrap_or(1.0);
        peak.table = (0..=INTERVALS)
            .map(|k| {
                let mu = cosine(peak.edge * k as f64 / INTERVALS as f64);
                let once = residual(mu);
                let beyond = legendre_series(&orders, mu) - legendre_series(&orders[..DEGREES], mu);
                let low = legendre_series(&[1.0; DEGREES], mu);
                let (f, t) = (fraction, depth);
                // exp(-t f) - 1 + t f, without cancellation in thin fog.
                let solved = if t * f < 1e-2 {
                    0.5 * (t * f).powi(2)
                } else {
                    (-t * f).exp_m1() + t * f
                };
                let all = (-t * f).exp() * beyond - solved / t * low;
                match once > 0.0 && all > 0.0 {
                    true => (f + (all / once).ln() / t).clamp(0.0, f) as f32,
                    false => 0.0,
                }
            })
            .collect();
        peak
    }

    /// The phase function of the moments, without the residual, 1/sr.
    #[inline]
    pub fn smooth(&self, mu: f64) -> f64 {
        legendre_series(&self.moments, mu)
    }

    /// Whether the residual at an angle has an extinction of its own.
    #[inline]
    pub fn in_lobe(&self, mu: f64) -> bool {
        0.5 * (1.0 - mu) < self.edge * self.edge
    }

    /// Fraction of the scattering that counts as unscattered for the residual at an angle; `fraction` outside the peak.
    #[inline]
    pub fn residual_fraction(&self, mu: f64) -> f32 {
        let half_sine = (0.5 * (1.0 - mu)).max(0.0).sqrt();
        if half_sine >= self.edge {
            return self.fraction as f32;
        }
        Place::evenly(half_sine / self.edge, INTERVALS + 1).value_in_f32(&self.table)
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    const DEGREES: usize = 8;
    type Peak = ForwardPeak<DEGREES>;

    #[test]
    fn the_self_convolved_peak_is_that_of_the_squared_asymmetry() {
        let g = 0.85;
        let phase = PhaseFunction::HenyeyGreenstein { g };
        let twice = PhaseFunction::HenyeyGreenstein { g: g * g };
        let peak = Peak::new(&phase, 550.0, 0.0);
        assert!((peak.fraction - g.powi(DEGREES as i32)).abs() < 1e-12);
        let low = |x: f64, mu: f64| {
            let chi: Vec<f64> = (0..DEGREES).map(|l| x.powi(l as i32)).collect();
            legendre_series(&chi, mu)
        };
        for mu in [1.0, 0.999, 0.99] {
            let q = phase.evaluate(mu, 550.0) - low(g, mu);
            let q2 = twice.evaluate(mu, 550.0) - low(g * g, mu);
            // Second order: moments (chi_l - f)^2, whose constant part is that of a delta function without its low degrees.
            let f = peak.fraction;
            let exact = (0.5 * (q2 - f * f * low(1.0, mu)) / q).clamp(0.0, f);
            let got = f64::from(peak.residual_fraction(mu));
            assert!((got - exact).abs() < 2e-3, "{mu}: {got} {exact}");
        }
        assert_eq!(peak.residual_fraction(-0.5), peak.fraction as f32);
        let even = Peak::new(&PhaseFunction::Isotropic, 550.0, 1.0);
        assert_eq!((even.fraction, even.residual_fraction(1.0)), (0.0, 0.0));
        let fractions = [-0.1f32, 0.3, 1.0].map(|moment| peak_fraction(moment, 0.99));
        assert_eq!(fractions, [0.0, 0.3, 0.99]);
    }
}
