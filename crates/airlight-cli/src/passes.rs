//! Random paths pass by pass, each of as many as all before it; and the sums that tell how far they scatter.

use crate::progress::RowsBar;
use airlight::monte_carlo::{BUNDLE, MonteCarloSettings};

/// Bundles of the first pass: two are the fewest that have a spread.
const FIRST: u64 = 2;

/// Bundles of all passes together.
pub fn goal(settings: &MonteCarloSettings) -> u64 {
    settings.paths.div_ceil(BUNDLE as u64).max(FIRST)
}

/// Bundles after the next pass, where so many are done.
pub fn next(done: u64, goal: u64) -> u64 {
    (2 * done).clamp(FIRST, goal)
}

/// Shows the progress of a pass over so many rows.
pub fn bar(rows: u64, until: u64, goal: u64) -> RowsBar {
    let bar = RowsBar::new(rows);
    bar.say(format!(
        "{} of {} paths a pixel",
        until * BUNDLE as u64,
        goal * BUNDLE as u64
    ));
    bar
}

/// Sums of red, green and blue over the bundles of paths of a pixel, and of their squares.
#[derive(Clone, Copy, Default)]
pub struct Colour {
    sum: [f64; 3],
    square: [f64; 3],
}

impl Colour {
    /// Adds what a bundle found.
    pub fn add(&mut self, rgb: [f64; 3]) {
        for (component, value) in rgb.into_iter().enumerate() {
            self.sum[component] += value;
            self.square[component] += value * value;
        }
    }

    /// Mean and standard error of a component after so many bundles, two or more.
    pub fn moments(&self, component: usize, bundles: u64) -> (f64, f64) {
        let n = bundles as f64;
        let mean = self.sum[component] / n;
        let variance = (self.square[component] - n * mean * mean) / (n - 1.0);
        (mean, (variance.max(0.0) / n).sqrt())
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn passes_double_up_to_the_goal() {
        let until = |goal| {
            let mut all = vec![next(0, goal)];
            while all[all.len() - 1] < goal {
                all.push(next(all[all.len() - 1], goal));
            }
            all
        };
        assert_eq!(until(11), [2, 4, 8, 11]);
        assert_eq!(until(2), [2]);
    }

    #[test]
    fn moments_are_those_of_the_bundles() {
        let mut colour = Colour::default();
        for value in [1.0, 2.0, 3.0] {
            colour.add([value, 5.0, 0.0]);
        }
        let (mean, error) = colour.moments(0, 3);
        assert_eq!(mean, 2.0);
        assert!((error - (1.0f64 / 3.0).sqrt()).abs() < 1e-15);
        assert_eq!(colour.moments(1, 3), (5.0, 0.0));
    }
}
