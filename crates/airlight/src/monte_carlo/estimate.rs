//! Means of Monte Carlo samples and their standard errors.

use super::path::ORDERS;

/// Mean over the paths of a bundle: one value for each order and wavelength.
pub type Sample = [Vec<f64>; ORDERS];

/// Accumulated independent samples: mean and variance of each order, and of their sum, at each wavelength.
#[derive(Clone, Debug, PartialEq)]
pub struct Tally {
    count: u64,
    /// The orders, then their sum.
    parts: [Vec<Moments>; ORDERS + 1],
}

/// Running mean and sum of squared deviations (Welford, Technometrics 4, 419, 1962).
#[derive(Clone, Copy, Debug, Default, PartialEq)]
struct Moments {
    mean: f64,
    squares: f64,
}

impl Moments {
    fn add(&mut self, value: f64, count: f64) {
        let off = value - self.mean;
        self.mean += off / count;
        self.squares += off * (value - self.mean);
    }

    fn standard_error(&self, count: f64) -> f64 {
        match count > 1.0 {
            true => (self.squares / (count * (count - 1.0))).sqrt(),
            false => f64::INFINITY,
        }
    }
}

/// A value at each wavelength of a grid, with its standard error.
#[derive(Clone, Debug, Default, PartialEq)]
#[non_exhaustive]
pub struct Measured {
    /// Mean over all paths.
    pub mean: Vec<f64>,
    /// Standard error of the mean.
    pub standard_error: Vec<f64>,
}

/// Radiance along a view ray, W m^-2 sr^-1 nm^-1, at each wavelength of the grid, without the direct light of the sun's disc.
#[derive(Clone, Debug, PartialEq)]
#[non_exhaustive]
pub struct Estimate {
    /// Mean over all paths.
    pub mean: Vec<f64>,
    /// Standard error of the mean, from the spread of independent bundles of paths. The mean is within two standard errors of
    /// the true value in 95 % of cases.
    pub standard_error: Vec<f64>,
    /// Light scattered or reflected once, twice, three and four times, and five times or more.
    pub orders: Vec<Measured>,
    /// Number of paths.
    pub paths: u64,
}

impl Estimate {
    /// Of it, the light scattered or reflected once.
    pub(crate) fn first_order(&self) -> Self {
        Self {
            mean: self.orders[0].mean.clone(),
            standard_error: self.orders[0].standard_error.clone(),
            orders: (0..ORDERS)
                .map(|order| match order {
                    0 => self.orders[0].clone(),
                    _ => {
                        let dark = vec![0.0; self.mean.len()];
                        Measured {
                            mean: dark.clone(),
                            standard_error: dark,
                        }
                    }
                })
                .collect(),
            paths: self.paths,
        }
    }
}

impl Tally {
    /// An empty tally for a number of wavelengths.
    pub fn new(wavelengths: usize) -> Self {
        Self {
            count: 0,
            parts: std::array::from_fn(|_| vec![Moments::default(); wavelengths]),
        }
    }

    /// Adds a sample.
    pub fn add(&mut self, sample: &Sample) {
        self.count += 1;
        let count = self.count as f64;
        for (moments, values) in self.parts.iter_mut().zip(sample) {
            for (moment, value) in moments.iter_mut().zip(values) {
                moment.add(*value, count);
            }
        }
        for (lane, moment) in self.parts[ORDERS].iter_mut().enumerate() {
            moment.add(sample.iter().map(|order| order[lane]).sum(), count);
        }
    }

    /// Number of samples.
    pub fn count(&self) -> u64 {
        self.count
    }

    /// Means and standard errors, multiplied by `factors`, one for each wavelength.
    pub(super) fn estimate(&self, factors: &[f64], paths: u64) -> Estimate {
        let measured = |part: usize| {
            let of = |value: &dyn Fn(&Moments) -> f64| -> Vec<f64> {
                self.parts[part]
                    .iter()
                    .zip(factors)
                    .map(|(moment, factor)| value(moment) * factor)
                    .collect()
            };
            Measured {
                mean: of(&|m| m.mean),
                standard_error: of(&|m| m.standard_error(self.count as f64)),
            }
        };
        let Measured {
            mean,
            standard_error,
        } = measured(ORDERS);
        Estimate {
            mean,
            standard_error,
            orders: (0..ORDERS).map(measured).collect(),
            paths,
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn means_and_standard_errors_match_the_definition() {
        let mut tally = Tally::new(1);
        let values = [1.0, 4.0, 2.0, 7.0];
        for value in values {
            tally.add(&std::array::from_fn(|order| {
                vec![if order < 2 { value } else { 0.0 }]
            }));
        }
        let estimate = tally.estimate(&[2.0], 4);
        let mean = values.iter().sum::<f64>() / 4.0;
        let variance = values.iter().map(|v| (v - mean).powi(2)).sum::<f64>() / 3.0;
        // Two equal orders, times the factor.
        assert!((estimate.mean[0] - 4.0 * mean).abs() < 1e-12);
        assert!((estimate.standard_error[0] - 4.0 * (variance / 4.0).sqrt()).abs() < 1e-12);
        assert!((estimate.orders[1].mean[0] - 2.0 * mean).abs() < 1e-12);
        assert_eq!(estimate.orders[2].mean[0], 0.0);
        assert_eq!(
            Tally::new(1).estimate(&[1.0], 0).standard_error[0],
            f64::INFINITY
        );
    }
}
