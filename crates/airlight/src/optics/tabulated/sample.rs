//! Sampling of directions from tabulated phase functions.

use super::TabulatedPhase;
use crate::math::interpolation::interval_of;

/// Maximum number of Newton steps; two or three usually suffice.
const STEPS: usize = 30;

impl TabulatedPhase {
    /// Cosine of the scattering angle below which the fraction `share`, in `[0, 1]`, of the light is scattered, counted from
    /// the forward direction: for a uniform share in `[0, 1)`, a sample with the density
    /// [`evaluate`](TabulatedPhase::evaluate) over the sphere.
    ///
    /// Between two wavelengths the share also selects the wavelength whose distribution is inverted, so that the density is
    /// that of `evaluate` there too; the cosine is then not monotone in the share. The fraction of the light within the
    /// returned angle is the share to 1e-9.
    pub fn sample(&self, share: f64, wavelength_nm: f64) -> f64 {
        let (row, t) = self.bracket_wavelength(wavelength_nm);
        let share = share.clamp(0.0, 1.0);
        match share < t {
            true => self.sample_row(row + 1, share / t),
            false => self.sample_row(row, (share - t) / (1.0 - t)),
        }
    }

    fn sample_row(&self, row: usize, share: f64) -> f64 {
        let count = self.angles_rad.len();
        let running = &self.integrals.cumulative[row * count..(row + 1) * count];
        let interval = interval_of(running, share);
        let target = share - running[interval];
        let whole = running[interval + 1] - running[interval];
        let (mut low, mut high) = (self.angles_rad[interval], self.angles_rad[interval + 1]);
        if whole <= 0.0 {
            return high.cos();
        }
        // The cumulative distribution grows with the square of the angle near 0, elsewhere about linearly.
        let part = (target / whole).clamp(0.0, 1.0);
        let mut angle = match interval {
            0 => high * part.sqrt(),
            _ => low + (high - low) * part,
        };
        for _ in 0..STEPS {
            let excess = self.mass(row, interval, angle) - target;
            if excess.abs() <= 1e-10 * whole.max(1e-6) {
                break;
            }
            match excess > 0.0 {
                true => high = angle,
                false => low = angle,
            }
            let slope = std::f64::consts::TAU * angle.sin() * self.at_row(row, interval, angle);
            let next = angle - excess / slope;
            angle = match next > low && next < high {
                true => next,
                false => 0.5 * (low + high),
            };
        }
        angle.cos()
    }

    /// Fraction of the light scattered into an interval of the table, up to the angle `to`.
    pub(super) fn mass(&self, row: usize, interval: usize, to: f64) -> f64 {
        let mut sum = 0.0;
        self.visit_panels(row, interval, to, 0.4, |angles, measures| {
            for (angle, measure) in angles.iter().zip(measures) {
                sum += measure * self.at_row(row, interval, *angle);
            }
        });
        sum
    }
}

#[cfg(test)]
mod tests {
    use super::interval_of;
    use crate::optics::{PhaseFunction, TabulatedPhase};

    /// Two wavelengths: a peak of six decades, and a fog bow.
    fn table() -> TabulatedPhase {
        let angles: Vec<f64> = (0..=180).map(f64::from).collect();
        let peak = PhaseFunction::HenyeyGreenstein { g: 0.99 };
        let peaked = angles
            .iter()
            .map(|a| peak.evaluate(a.to_radians().cos(), 550.0));
        let bow = angles
            .iter()
            .map(|a| 1.0 + (-((a - 140.0) / 3.0).powi(2)).exp());
        let values = peaked.chain(bow).collect();
        TabulatedPhase::new(angles.clone(), vec![400.0, 700.0], values).unwrap()
    }

    #[test]
    fn sampling_inverts_the_cumulative_distribution() {
        let table = table();
        let count = table.angles_rad().len();
        for (row, nm) in [(0, 400.0), (1, 700.0)] {
            let mut before = 1.0;
            for i in 0..=2000 {
                let share = f64::from(i) / 2000.0;
                let mu = table.sample(share, nm);
                assert!(mu <= before, "{share}");
                before = mu;
                let angle = mu.acos();
                let interval = interval_of(table.angles_rad(), angle);
                let within = table.integrals.cumulative[row * count + interval]
                    + table.mass(row, interval, angle);
                assert!((within - share).abs() < 1e-7, "{nm} {share}: {within}");
            }
            assert_eq!((table.sample(0.0, nm), table.sample(1.0, nm)), (1.0, -1.0));
        }
    }

    /// The means of `mu` and `mu^2` over uniform shares are those of the density, also between wavelengths.
    #[test]
    fn samples_have_the_moments_of_the_density() {
        let table = table();
        for nm in [400.0, 500.0, 650.0, 700.0] {
            let count = 40_000;
            let (mut first, mut second) = (0.0, 0.0);
            for i in 0..count {
                let mu = table.sample((f64::from(i) + 0.5) / f64::from(count), nm);
                first += mu / f64::from(count);
                second += 0.5 * (3.0 * mu * mu - 1.0) / f64::from(count);
            }
            // One sample more or less at either wavelength changes the mean by 2.5e-5.
            let moments = table.legendre_moments(3, nm);
            assert!(
                (first - moments[1]).abs() < 5e-5,
                "{nm}: {first} {moments:?}"
            );
            assert!(
                (second - moments[2]).abs() < 5e-5,
                "{nm}: {second} {moments:?}"
            );
        }
    }
}
