//! Sampling of collisions on rays that are partly in the planet's shadow.

use super::chord::Chord;
use super::lanes::Lanes;
use super::layers::Layers;
use crate::spectrum::Spectrum;

/// Probability of sampling the collision in the sunlit part of a ray that is partly in shadow.
const LIT_PROBABILITY: f64 = 0.5;
/// Smallest sampled absorption of the sunlit part: below it single precision cannot resolve the density.
const MIN_ABSORPTION: f32 = 1e-24;

/// A sunlit segment of a ray.
#[derive(Clone, Copy, Debug)]
pub struct LitSegment<const N: usize> {
    /// Coordinate of its start, m.
    pub from: f64,
    /// Coordinate of its end, m.
    pub to: f64,
    /// Fraction of the light at the start of the ray that is lost on the segment.
    pub absorbed: Spectrum<N>,
}

/// Sunlit segments of a ray that is partly in shadow; empty for other rays.
#[derive(Clone, Copy, Debug)]
pub struct Lit<const N: usize> {
    /// The segments, of which [`Lit::count`] are valid.
    pub segments: [LitSegment<N>; 2],
    /// Number of segments.
    pub count: usize,
}

impl<const N: usize> Default for Lit<N> {
    fn default() -> Self {
        Self {
            segments: [LitSegment {
                from: 0.0,
                to: 0.0,
                absorbed: Spectrum::ZERO,
            }; 2],
            count: 0,
        }
    }
}

impl<const N: usize> Lit<N> {
    /// Draws the coordinate of a collision for the lane `hero`. Also returns, for each lane, the factor of
    /// `extinction * transmittance` in its probability density.
    #[inline(always)]
    pub fn draw(
        &self,
        lanes: &Lanes<N>,
        (layers, chord): (&Layers, &Chord),
        hero: usize,
        choice: f64,
        absorbed: &Spectrum<N>,
    ) -> (f64, Spectrum<N>) {
        let lit = &self.segments[..self.count];
        let lit_absorbed = lit
            .iter()
            .fold(Spectrum::ZERO, |sum, segment| sum + segment.absorbed);
        let chance = lit_absorbed.map(|lit| {
            if lit > MIN_ABSORPTION {
                LIT_PROBABILITY as f32
            } else {
                0.0
            }
        });
        let extinction = lanes.extinction_of(hero);
        let depth_to = |t: f64| -> f64 {
            let columns = chord.columns_to(layers, t);
            extinction.iter().zip(columns).map(|(e, c)| e * c).sum()
        };
        // Coordinate between two points by which the fraction `choice` of the light lost between them is lost.
        let sample_between = |from: f64, to: f64, choice: f64| {
            let before = depth_to(from);
            let share = choice * (before - depth_to(to)).exp_m1();
            chord
                .at_depth(layers, extinction, before - share.ln_1p())
                .clamp(from, to)
        };
        let mut choice = choice;
        let t = if choice < f64::from(chance[hero]) {
            choice /= f64::from(chance[hero]);
            let mut picked = &lit[0];
            let first = f64::from(picked.absorbed[hero] / lit_absorbed[hero]);
            if lit.len() > 1 && choice >= first {
                picked = &lit[1];
                choice = (choice - first) / (1.0 - first);
            } else if first > 0.0 {
                choice /= first;
            }
            sample_between(picked.from, picked.to, choice)
        } else {
            choice = (choice - f64::from(chance[hero])) / f64::from(1.0 - chance[hero]);
            sample_between(chord.start(), chord.end(), choice)
        };
        let in_light = lit
            .iter()
            .any(|segment| t >= segment.from && t <= segment.to);
        let share = Spectrum::from_fn(|i| {
            let everywhere = match absorbed[i] > 0.0 {
                true => (1.0 - chance[i]) / absorbed[i],
                false => 0.0,
            };
            let there = match in_light && chance[i] > 0.0 {
                true => chance[i] / lit_absorbed[i],
                false => 0.0,
            };
            everywhere + there
        });
        (t, share)
    }
}
