//! Passes over a picture: each follows as many bundles of paths as all before it, so that there is a whole picture soon
//! and a better one later.

use airlight::monte_carlo::BUNDLE;
use std::ops::Range;

/// Bundles of the first pass: two are the fewest that have a standard error.
const FIRST: u64 = 2;

/// Ranges of bundles, one a pass: the first 2, then as many as before, up to the goal.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Passes {
    done: u64,
    goal: u64,
}

impl Passes {
    /// Passes that together follow at least `paths` paths a pixel: whole bundles, two or more.
    pub fn new(paths: u64) -> Self {
        Self {
            done: 0,
            goal: paths.div_ceil(BUNDLE as u64).max(FIRST),
        }
    }

    /// Bundles of all passes together.
    pub fn goal(&self) -> u64 {
        self.goal
    }
}

impl Iterator for Passes {
    type Item = Range<u64>;

    fn next(&mut self) -> Option<Range<u64>> {
        let from = self.done;
        if from == self.goal {
            return None;
        }
        self.done = (2 * from).clamp(FIRST, self.goal);
        Some(from..self.done)
    }
}

/// Where in a pixel a bundle looks, each coordinate in `[0, 1)`: the two-dimensional sequence of M. Roberts (2018), which
/// fills the square evenly for any number of points.
pub fn pixel_offset(bundle: u64) -> [f64; 2] {
    const STEPS: [f64; 2] = [0.754_877_666_246_692_8, 0.569_840_290_998_053_3];
    STEPS.map(|step| (0.5 + bundle as f64 * step).fract())
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn passes_double_up_to_the_goal() {
        let until = |paths| -> Vec<u64> { Passes::new(paths).map(|pass| pass.end).collect() };
        let bundle = BUNDLE as u64;
        assert_eq!(until(11 * bundle), [2, 4, 8, 11]);
        assert_eq!(until(10 * bundle + 1), [2, 4, 8, 11]);
        assert_eq!(until(1), [2]);
        let passes: Vec<_> = Passes::new(11 * bundle).collect();
        assert!(passes.windows(2).all(|pair| pair[0].end == pair[1].start));
    }

    #[test]
    fn bundles_fill_a_pixel_evenly() {
        const COUNT: u64 = 1024;
        for axis in 0..2 {
            let mut quarters = [0; 4];
            for bundle in 0..COUNT {
                quarters[(4.0 * pixel_offset(bundle)[axis]) as usize] += 1;
            }
            assert!(
                quarters.iter().all(|n: &i32| (n - 256).abs() <= 2),
                "{quarters:?}"
            );
        }
    }
}
