//! Interpolation of functions of the azimuth that are mirror-symmetric about 0 and half a turn.

use crate::spectrum::Spectrum;
use std::f64::consts::PI;

/// Interpolation between values at few evenly spaced azimuths.
///
/// By series of cosines it is exact for those of the multiples of the azimuth below the number of values, and its error falls faster than
/// any power of that number where the function is smooth. Where it falls by orders of magnitude, as in twilight away from the sun, the
/// error beside the sun would be felt in the dark: there it is local, by polynomials.
#[derive(Clone, Debug)]
pub struct BetweenAzimuths {
    few: usize,
    /// For each of the azimuths, the first of the values with a weight, and the weights from there on.
    weights: Vec<(usize, Vec<f32>)>,
}

impl BetweenAzimuths {
    /// By cosines to `many` azimuths in the middle of equal intervals of half a turn, from `few` such azimuths.
    pub fn middles(few: usize, many: usize) -> Self {
        let middle = |k: usize, count: usize| PI * (k as f64 + 0.5) / count as f64;
        Self::new(few, many, |to, from| {
            let (to, from) = (middle(to, many), middle(from, few));
            let terms = (1..few).map(|m| (m as f64 * to).cos() * (m as f64 * from).cos());
            (1.0 + 2.0 * terms.sum::<f64>()) / few as f64
        })
    }

    /// By cosines to the ends of `steps` equal steps of half a turn, from every `stride`-th of them.
    ///
    /// # Panics
    /// If `stride` does not divide `steps`.
    pub fn ends(steps: usize, stride: usize) -> Self {
        assert!(steps.is_multiple_of(stride), "{steps} steps by {stride}");
        let last = steps / stride;
        let cosine = |k: usize| (PI * k as f64 / steps as f64).cos();
        let cosines: Vec<f64> = (0..2 * steps).map(cosine).collect();
        let half_at_ends = |k: usize| if k == 0 || k == last { 0.5 } else { 1.0 };
        Self::new(last + 1, steps + 1, |to, from| {
            let term = |m: usize| {
                let [to, from] = [to, from * stride].map(|k| cosines[m * k % (2 * steps)]);
                half_at_ends(m) * to * from
            };
            let sum: f64 = (0..=last).map(term).sum();
            2.0 * half_at_ends(from) * sum / last as f64
        })
    }

    /// By polynomials of the seventh degree to the ends of `steps` equal steps of half a turn, from every second of them.
    ///
    /// # Panics
    /// If `steps` is odd.
    pub fn halfway(steps: usize) -> Self {
        assert!(steps.is_multiple_of(2), "{steps} steps");
        /// Weights of the values at a distance of 1, 3, 5 and 7 steps.
        const WEIGHTS: [f64; 4] = [
            1225.0 / 2048.0,
            -245.0 / 2048.0,
            49.0 / 2048.0,
            -5.0 / 2048.0,
        ];
        Self::new(steps / 2 + 1, steps + 1, |to, from| {
            // A value is used at its place, and mirrored about both ends.
            let place = 2 * from as isize;
            let mut places = vec![place, -place, 2 * steps as isize - place];
            places.sort_unstable();
            places.dedup();
            let weight = |place: isize| match place.abs_diff(to as isize) {
                0 => 1.0,
                distance if to % 2 == 1 => WEIGHTS.get(distance / 2).copied().unwrap_or(0.0),
                _ => 0.0,
            };
            places.into_iter().map(weight).sum()
        })
    }

    fn new(few: usize, many: usize, weight: impl Fn(usize, usize) -> f64) -> Self {
        let weights = |to: usize| {
            let all: Vec<f32> = (0..few).map(|from| weight(to, from) as f32).collect();
            let first = all.iter().position(|&w| w != 0.0).unwrap_or(0);
            let last = all.iter().rposition(|&w| w != 0.0).unwrap_or(0);
            (first, all[first..=last].to_vec())
        };
        Self {
            few,
            weights: (0..many).map(weights).collect(),
        }
    }

    /// Number of azimuths between which it interpolates.
    pub fn few(&self) -> usize {
        self.few
    }

    /// Values at all azimuths, from those at the few of them. None is negative.
    #[inline(always)]
    pub fn of<'a, const N: usize>(
        &'a self,
        few: &'a [Spectrum<N>],
    ) -> impl Iterator<Item = Spectrum<N>> + 'a {
        self.weights.iter().map(
            #[inline(always)]
            move |(first, weights)| {
                let mut sum = Spectrum::ZERO;
                for (value, weight) in few[*first..].iter().zip(weights) {
                    sum = sum.scale_acc(*value, *weight);
                }
                sum.max_scalar(0.0)
            },
        )
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    /// Sampled values of a positive function whose cosines fall fast.
    fn at(azimuths: impl Iterator<Item = f64>) -> Vec<Spectrum<1>> {
        let value = |azimuth: f64| (2.0 * azimuth.cos()).exp();
        azimuths
            .map(|azimuth| Spectrum::from_fn(|_| value(azimuth) as f32))
            .collect()
    }

    fn assert_close(between: &BetweenAzimuths, few: &[Spectrum<1>], many: &[Spectrum<1>]) {
        assert_eq!(between.few(), few.len());
        let got: Vec<_> = between.of(few).collect();
        assert_eq!(got.len(), many.len());
        for (got, exact) in got.iter().zip(many) {
            assert!((got[0] / exact[0] - 1.0).abs() < 2e-5, "{got:?} {exact:?}");
        }
    }

    #[test]
    fn smooth_functions_are_interpolated_to_rounding() {
        let ends = |steps: usize| at((0..=steps).map(move |k| PI * k as f64 / steps as f64));
        assert_close(&BetweenAzimuths::ends(64, 4), &ends(16), &ends(64));
        assert_close(&BetweenAzimuths::halfway(64), &ends(32), &ends(64));
        let middles =
            |count: usize| at((0..count).map(move |k| PI * (k as f64 + 0.5) / count as f64));
        assert_close(
            &BetweenAzimuths::middles(12, 30),
            &middles(12),
            &middles(30),
        );
    }
}
