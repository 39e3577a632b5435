//! Mean and standard error of a sampled colour.

/// Sums of red, green and blue and of their squares over the bundles of paths of a pixel.
#[derive(Clone, Copy, Debug, Default)]
pub struct ColorMoments {
    sum: [f64; 3],
    square: [f64; 3],
}

impl ColorMoments {
    /// Adds the colour of one bundle.
    pub fn add(&mut self, rgb: [f64; 3]) {
        for (component, value) in rgb.into_iter().enumerate() {
            self.sum[component] += value;
            self.square[component] += value * value;
        }
    }

    /// Mean and standard error of a component after a number of bundles, at least two.
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
    fn moments_match_their_definition() {
        let mut color = ColorMoments::default();
        for value in [1.0, 2.0, 3.0] {
            color.add([value, 5.0, 0.0]);
        }
        let (mean, error) = color.moments(0, 3);
        assert_eq!(mean, 2.0);
        assert!((error - (1.0f64 / 3.0).sqrt()).abs() < 1e-15);
        assert_eq!(color.moments(1, 3), (5.0, 0.0));
    }
}
