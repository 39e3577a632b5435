//! Passes over a picture. Each traces as many bundles of paths as all earlier passes together, so that a first complete picture
//! is available early.

use airlight::monte_carlo::BUNDLE;
use std::fmt;
use std::ops::Range;

/// Bundles of the first pass, at least two for a standard error.
const FIRST: u64 = 2;

/// Passes over a picture: the first adds 2 bundles to each pixel, every other as many as all earlier ones, up to the goal.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Passes {
    done: u64,
    goal: u64,
}

/// One pass over a picture. `Display` writes the number of paths after it: "256 of 1024 paths per pixel".
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Pass {
    /// Bundles of paths that the pass adds to each pixel.
    pub bundles: Range<u64>,
    /// Number of bundles of all passes.
    pub goal: u64,
}

impl Passes {
    /// Passes that together trace at least `paths` paths for each pixel, in whole bundles, at least two.
    pub fn new(paths: u64) -> Self {
        Self {
            done: 0,
            goal: paths.div_ceil(BUNDLE as u64).max(FIRST),
        }
    }

    /// A single pass with the bundles of all passes.
    pub fn at_once(self) -> Pass {
        Pass {
            bundles: self.done..self.goal,
            goal: self.goal,
        }
    }
}

impl Pass {
    /// Number of paths for each pixel after this pass.
    pub fn paths(&self) -> u64 {
        self.bundles.end * BUNDLE as u64
    }

    /// Whether it is the last pass.
    pub fn is_last(&self) -> bool {
        self.bundles.end == self.goal
    }
}

impl fmt::Display for Pass {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        let goal = self.goal * BUNDLE as u64;
        write!(f, "{} of {goal} paths per pixel", self.paths())
    }
}

impl Iterator for Passes {
    type Item = Pass;

    fn next(&mut self) -> Option<Pass> {
        let from = self.done;
        if from == self.goal {
            return None;
        }
        self.done = (2 * from).clamp(FIRST, self.goal);
        Some(Pass {
            bundles: from..self.done,
            goal: self.goal,
        })
    }
}

/// Position of a bundle's rays in a pixel, each coordinate in `[0, 1)`: the two-dimensional low-discrepancy sequence of
/// M. Roberts (2018), which fills the square evenly for any number of points.
pub fn pixel_offset(bundle: u64) -> [f64; 2] {
    const STEPS: [f64; 2] = [0.754_877_666_246_692_8, 0.569_840_290_998_053_3];
    STEPS.map(|step| (0.5 + bundle as f64 * step).fract())
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn passes_double_up_to_the_goal() {
        let until =
            |paths| -> Vec<u64> { Passes::new(paths).map(|pass| pass.bundles.end).collect() };
        let bundle = BUNDLE as u64;
        assert_eq!(until(11 * bundle), [2, 4, 8, 11]);
        assert_eq!(until(10 * bundle + 1), [2, 4, 8, 11]);
        assert_eq!(until(1), [2]);
        let passes: Vec<Pass> = Passes::new(11 * bundle).collect();
        for pair in passes.windows(2) {
            assert_eq!(pair[0].bundles.end, pair[1].bundles.start);
            assert!(!pair[0].is_last());
        }
        let last = &passes[3];
        assert!(last.is_last() && last.paths() == 11 * bundle);
        assert_eq!(passes[1].to_string(), "256 of 704 paths per pixel");
        assert_eq!(Passes::new(11 * bundle).at_once().bundles, 0..11);
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
