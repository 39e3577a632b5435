//! Legendre moments of tabulated phase functions.

use super::{PANEL_POINTS, TabulatedPhase};
use crate::math::interpolation::lerp;
use crate::math::simd::vectorized;

impl TabulatedPhase {
    /// Legendre moments, see [`crate::optics::PhaseFunction::legendre_moments`].
    pub fn legendre_moments(&self, count: usize, wavelength_nm: f64) -> Vec<f64> {
        let (row, t) = self.bracket_wavelength(wavelength_nm);
        let mut moments = self.moments_of_row(row, count);
        if t > 0.0 {
            for (moment, other) in moments.iter_mut().zip(self.moments_of_row(row + 1, count)) {
                *moment = lerp(*moment, other, t);
            }
        }
        moments
    }

    fn moments_of_row(&self, row: usize, count: usize) -> Vec<f64> {
        // P_l oscillates by at most about a quarter turn over each panel.
        let max_width = (1.6 / count as f64).min(0.4);
        let mut moments = vec![0.0; count];
        for interval in 0..self.angles_rad.len() - 1 {
            let to = self.angles_rad[interval + 1];
            self.visit_panels(row, interval, to, max_width, |angles, measures| {
                let parts =
                    std::array::from_fn(|i| measures[i] * self.at_row(row, interval, angles[i]));
                vectorized(
                    #[inline(always)]
                    || add_legendre(&mut moments, &angles.map(f64::cos), &parts),
                );
            });
        }
        moments
    }
}

/// Adds `sum over i of p_i P_l(mu_i)` to each moment.
#[inline(always)]
fn add_legendre(moments: &mut [f64], mu: &[f64; PANEL_POINTS], p: &[f64; PANEL_POINTS]) {
    let mut before = [0.0; PANEL_POINTS];
    let mut now = *p;
    for (l, moment) in moments.iter_mut().enumerate() {
        *moment += now.iter().sum::<f64>();
        let x = l as f64;
        let (a, b) = ((2.0 * x + 1.0) / (x + 1.0), x / (x + 1.0));
        for i in 0..PANEL_POINTS {
            (before[i], now[i]) = (now[i], a * mu[i] * now[i] - b * before[i]);
        }
    }
}
