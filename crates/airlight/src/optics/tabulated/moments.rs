//! Legendre moments of tabulated phase functions.

use super::{PANEL_POINTS, TabulatedPhase};
use crate::math::interpolation::lerp;
use crate::math::simd::vectorized;

/// Number of moments of each wavelength that are computed once.
const CACHED: usize = 800;

impl TabulatedPhase {
    /// Legendre moments, see [`crate::optics::PhaseFunction::legendre_moments`].
    pub fn legendre_moments(&self, count: usize, wavelength_nm: f64) -> Vec<f64> {
        let (row, t) = self.bracket_wavelength(wavelength_nm);
        let mut moments = self.first_moments(row, count);
        if t > 0.0 {
            for (moment, other) in moments.iter_mut().zip(self.first_moments(row + 1, count)) {
                *moment = lerp(*moment, other, t);
            }
        }
        moments
    }

    fn first_moments(&self, row: usize, count: usize) -> Vec<f64> {
        if count > CACHED {
            return self.moments_of_row(row, count);
        }
        let cached = self
            .integrals
            .moments(row, || self.moments_of_row(row, CACHED));
        cached[..count].to_vec()
    }

    fn moments_of_row(&self, row: usize, count: usize) -> Vec<f64> {
        // P_l oscillates by at most about one turn over each panel.
        let max_width = (6.0 / count as f64).min(0.4);
        // Sums over all panels, for each point of the rule.
        let mut sums = vec![[0.0; PANEL_POINTS]; count];
        for interval in 0..self.angles_rad.len() - 1 {
            let to = self.angles_rad[interval + 1];
            self.visit_panels(row, interval, to, max_width, |angles, measures| {
                let parts =
                    std::array::from_fn(|i| measures[i] * self.at_row(row, interval, angles[i]));
                vectorized(
                    #[inline(always)]
                    || add_legendre(&mut sums, &angles.map(f64::cos), parts),
                );
            });
        }
        sums.iter().map(|points| points.iter().sum()).collect()
    }
}

/// Adds `p_i P_l(mu_i)` to the sums of each degree `l`.
#[inline(always)]
fn add_legendre(
    sums: &mut [[f64; PANEL_POINTS]],
    mu: &[f64; PANEL_POINTS],
    p: [f64; PANEL_POINTS],
) {
    let mut before = [0.0; PANEL_POINTS];
    let mut now = p;
    for (l, sums) in sums.iter_mut().enumerate() {
        let x = l as f64;
        let (a, b) = ((2.0 * x + 1.0) / (x + 1.0), x / (x + 1.0));
        for i in 0..PANEL_POINTS {
            sums[i] += now[i];
            (before[i], now[i]) = (now[i], a * mu[i] * now[i] - b * before[i]);
        }
    }
}
