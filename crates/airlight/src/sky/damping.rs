//! Damping of corrections that alternate at single points.
//!
//! Where little light comes from much, at the edge of a shadow, a correction of [`super::orders`] can be twice too large and the next one
//! as large with the other sign. The secant through the last two corrections at a point gives the fraction that settles them
//! there, each point and wavelength by itself.

use super::light::Light;
use crate::spectrum::Spectrum;

/// Fractions of the corrections to take.
pub struct Damping<const N: usize> {
    /// The last correction of the intensity at each point and of the irradiance on the ground, and the fraction of it that was taken.
    last: Vec<[Spectrum<N>; 2]>,
}

impl<const N: usize> Damping<N> {
    /// No earlier corrections.
    pub fn new() -> Self {
        Self { last: Vec::new() }
    }

    /// Multiplies a correction with the fractions.
    pub fn limit(&mut self, correction: &mut Light<N>) {
        if self.last.is_empty() {
            let points = correction.moments.len() / correction.count + correction.ground.len();
            self.last = vec![[Spectrum::ZERO, Spectrum::ONE]; points];
        }
        let points = correction.moments.chunks_exact_mut(correction.count);
        let ground = correction.ground.chunks_exact_mut(1);
        for (point, [before, fraction]) in points.chain(ground).zip(&mut self.last) {
            let now = point[0];
            *fraction = Spectrum::from_fn(|k| next_fraction(before[k], now[k], fraction[k]));
            *before = now;
            for value in point {
                *value *= *fraction;
            }
        }
    }
}

/// Fraction of a correction to take after a fraction of the last was.
fn next_fraction(before: f32, now: f32, fraction: f32) -> f32 {
    /// Smallest fraction.
    const LEAST: f32 = 0.1;
    /// Ratio of a correction to the last above which whole corrections converge fast enough.
    const ALTERNATING: f32 = -0.5;
    let ratio = now / before;
    let falls = ratio >= ALTERNATING && fraction == 1.0;
    if falls || ratio >= 1.0 || !ratio.is_finite() {
        return 1.0;
    }
    (fraction / (1.0 - ratio)).clamp(LEAST, 1.0)
}

#[cfg(test)]
mod tests {
    use super::*;

    /// A correction at one point.
    fn correction(intensity: f32) -> Light<4> {
        Light {
            count: 1,
            moments: vec![Spectrum::splat(intensity)],
            ground: vec![Spectrum::ZERO],
        }
    }

    #[test]
    fn corrections_that_alternate_and_grow_settle() {
        for overshoot in [1.6, 2.0, 2.5, 5.0] {
            let (mut damping, mut light) = (Damping::new(), 0.0);
            for _ in 0..6 {
                let mut step = correction(overshoot * (1.0 - light));
                damping.limit(&mut step);
                light += step.moments[0][0];
            }
            assert!((light - 1.0).abs() < 1e-4, "{overshoot}: {light}");
        }
    }

    #[test]
    fn corrections_that_fall_stay_whole() {
        let mut damping = Damping::new();
        for value in [1.0, 0.5, -0.1, 0.04, 0.03] {
            let mut step = correction(value);
            damping.limit(&mut step);
            assert_eq!(step.moments[0][0], value);
        }
    }
}
