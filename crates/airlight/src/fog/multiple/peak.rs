//! The forward peak of a phase function, which the moments of the solver cannot hold.
//!
//! Delta-M (Wiscombe 1977): the part `f = chi_N` of the scattering goes on as if nothing had happened; the light inside the
//! fog is solved for without it. Sunlight that is scattered once by more than `f` is then taken with the exact phase
//! function, dimmed as if the peak did not count (TMS; Nakajima & Tanaka 1988). That is right where the phase function
//! beyond the moments, the *residual* `q`, changes little over the width of the peak: not towards the sun. There light
//! scattered twice by the peak has the width of `q` convolved with itself: what of `q` is lost to further scattering and
//! not replaced depends on the angle. With the residual of the self-convolved phase function, `q2` (moments `chi_l^2`), the
//! part of the peak that replaces what it takes is `q2 / (2 q)`: the second term of the exact series of collinear
//! scatterings, made an extinction.

use super::legendre::STREAMS;
use crate::math::interpolation::Place;
use crate::math::legendre::legendre_series;
use crate::optics::PhaseFunction;

/// Moments summed for the self-convolved phase function.
const MOMENTS: usize = 800;

/// Entries of the table in the sine of half the angle.
const ENTRIES: usize = 128;

/// A phase function split for the solver, at one wavelength.
#[derive(Clone, Debug)]
pub struct Peak {
    /// Legendre moments below [`STREAMS`].
    pub moments: [f64; STREAMS],
    /// The part of the scattering that counts as none, `f`.
    pub fraction: f64,
    /// Sine of half the angle where the residual first vanishes.
    edge: f64,
    /// The part of the peak that counts as none for the residual, at even steps from 0 to the edge.
    table: Vec<f32>,
}

impl Peak {
    /// Splits a phase function.
    pub fn new(phase: &PhaseFunction, wavelength_nm: f64) -> Self {
        let chi = phase.legendre_moments(MOMENTS, wavelength_nm);
        let moments = std::array::from_fn(|l| chi[l]);
        let fraction = chi[STREAMS].clamp(0.0, 0.9999);
        let mut peak = Self {
            moments,
            fraction,
            edge: 0.0,
            table: Vec::new(),
        };
        if fraction < 1e-6 {
            return peak;
        }
        let squared: Vec<f64> = chi.iter().map(|c| c * c).collect();
        let residual =
            |mu: f64| phase.evaluate(mu, wavelength_nm) - legendre_series(&chi[..STREAMS], mu);
        // The residual's first zero, from the sun outwards.
        let cosine = |half_sine: f64| 1.0 - 2.0 * half_sine * half_sine;
        let step = 1.0 / 512.0;
        peak.edge = (1..512)
            .map(|k| f64::from(k) * step)
            .find(|&s| residual(cosine(s)) <= 0.0)
            .unwrap_or(1.0);
        peak.table = (0..=ENTRIES)
            .map(|k| {
                let mu = cosine(peak.edge * k as f64 / ENTRIES as f64);
                let (once, twice) = (
                    residual(mu),
                    legendre_series(&squared, mu) - legendre_series(&squared[..STREAMS], mu),
                );
                match once > 0.0 {
                    true => (0.5 * twice / once).clamp(0.0, fraction) as f32,
                    false => fraction as f32,
                }
            })
            .collect();
        peak
    }

    /// The phase function's part below [`STREAMS`] moments, 1/sr.
    #[inline]
    pub fn smooth(&self, mu: f64) -> f64 {
        legendre_series(&self.moments, mu)
    }

    /// Whether the residual is to be dimmed in its own way at an angle.
    #[inline]
    pub fn in_lobe(&self, mu: f64) -> bool {
        0.5 * (1.0 - mu) < self.edge * self.edge
    }

    /// The part of the scattering that counts as none for the residual at an angle; `fraction` outside the peak.
    #[inline]
    pub fn residual_fraction(&self, mu: f64) -> f32 {
        let half_sine = (0.5 * (1.0 - mu)).max(0.0).sqrt();
        if half_sine >= self.edge {
            return self.fraction as f32;
        }
        Place::evenly(half_sine / self.edge, ENTRIES + 1).value_in_f32(&self.table)
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_self_convolved_peak_is_that_of_the_squared_asymmetry() {
        let g = 0.85;
        let phase = PhaseFunction::HenyeyGreenstein { g };
        let twice = PhaseFunction::HenyeyGreenstein { g: g * g };
        let peak = Peak::new(&phase, 550.0);
        assert!((peak.fraction - g.powi(STREAMS as i32)).abs() < 1e-12);
        let low = |x: f64, mu: f64| {
            let chi: Vec<f64> = (0..STREAMS).map(|l| x.powi(l as i32)).collect();
            legendre_series(&chi, mu)
        };
        for mu in [1.0, 0.999, 0.99] {
            let q = phase.evaluate(mu, 550.0) - low(g, mu);
            let q2 = twice.evaluate(mu, 550.0) - low(g * g, mu);
            let exact = (0.5 * q2 / q).clamp(0.0, peak.fraction);
            let got = f64::from(peak.residual_fraction(mu));
            assert!((got - exact).abs() < 2e-3, "{mu}: {got} {exact}");
        }
        assert_eq!(peak.residual_fraction(-0.5), peak.fraction as f32);
        let even = Peak::new(&PhaseFunction::Isotropic, 550.0);
        assert_eq!((even.fraction, even.residual_fraction(1.0)), (0.0, 0.0));
    }
}
