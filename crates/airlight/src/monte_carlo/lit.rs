//! The lit part of a line that runs partly in the planet's shadow, and where to be scattered on such a line.

use super::chord::Chord;
use super::path::PathScene;
use crate::spectrum::Spectrum;

/// With this probability a path that runs partly in the planet's shadow is scattered in its lit part.
const IN_LIGHT: f64 = 0.5;
/// A lit part of which less than this share arrives is not looked for: single precision could not tell its density.
const FARTHEST: f32 = 1e-24;

/// A stretch in the light, and how much of each lane is taken out of the line on it.
#[derive(Clone, Copy, Debug)]
pub struct Stretch<const N: usize> {
    /// Where it begins.
    pub from: f64,
    /// Where it ends.
    pub to: f64,
    /// What is taken out on it, of what the line began with.
    pub absorbed: Spectrum<N>,
}

/// The lit stretches of a line that is partly in shadow; none of a line that is not.
#[derive(Clone, Copy, Debug)]
pub struct Lit<const N: usize> {
    /// The first [`Lit::count`] of them.
    pub stretches: [Stretch<N>; 2],
    /// How many there are.
    pub count: usize,
}

impl<const N: usize> Default for Lit<N> {
    fn default() -> Self {
        Self {
            stretches: [Stretch {
                from: 0.0,
                to: 0.0,
                absorbed: Spectrum::ZERO,
            }; 2],
            count: 0,
        }
    }
}

impl<const N: usize> Lit<N> {
    /// Draws where to be scattered for the lane `hero`; the factor of `extinction * transmittance` in the density with
    /// which each lane draws that place.
    #[inline(always)]
    pub fn draw(
        &self,
        scene: &PathScene<'_, N>,
        chord: &Chord,
        hero: usize,
        choice: f64,
        absorbed: &Spectrum<N>,
    ) -> (f64, Spectrum<N>) {
        let lit = &self.stretches[..self.count];
        let lit_absorbed = lit
            .iter()
            .fold(Spectrum::ZERO, |sum, stretch| sum + stretch.absorbed);
        let chance = lit_absorbed.map(|lit| if lit > FARTHEST { IN_LIGHT as f32 } else { 0.0 });
        let extinction = scene.lanes.extinction_of(hero);
        let depth_to = |t: f64| -> f64 {
            let columns = chord.columns_to(scene.layers, t);
            extinction.iter().zip(columns).map(|(e, c)| e * c).sum()
        };
        // Where the share `choice` of what is taken out between two places is taken out.
        let place = |from: f64, to: f64, choice: f64| {
            let before = depth_to(from);
            let share = choice * (before - depth_to(to)).exp_m1();
            chord
                .at_depth(scene.layers, extinction, before - share.ln_1p())
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
            place(picked.from, picked.to, choice)
        } else {
            choice = (choice - f64::from(chance[hero])) / f64::from(1.0 - chance[hero]);
            place(chord.start(), chord.end(), choice)
        };
        let in_light = lit
            .iter()
            .any(|stretch| t >= stretch.from && t <= stretch.to);
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
