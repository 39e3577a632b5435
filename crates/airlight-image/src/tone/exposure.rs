//! Exposure: from a camera's exposure value, or metered from the scene.

use crate::ImageError;

/// Linear value of middle grey.
pub const MIDDLE_GREY: f64 = 0.18;

/// Factor from linear light to display scale.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Exposure {
    factor: f64,
}

impl Exposure {
    /// An exposure that multiplies linear values by `factor`.
    ///
    /// # Errors
    /// [`ImageError::Setting`] where `factor` is negative or not finite.
    pub fn from_factor(factor: f64) -> Result<Self, ImageError> {
        if factor.is_finite() && factor >= 0.0 && (factor as f32).is_finite() {
            Ok(Self { factor })
        } else {
            Err(ImageError::Setting {
                what: "the exposure (a factor)",
                got: factor.to_string(),
                right: "a finite number, 0 or above",
            })
        }
    }

    /// The exposure of a camera's exposure value at ISO 100, for linear values in cd/m^2: the luminance `1.2 * 2^ev100` saturates
    /// the sensor (ISO 12232, saturation-based speed, lens transmittance 0.65) and becomes 1.
    ///
    /// # Errors
    /// [`ImageError::Setting`] where `ev100` is outside `[-40, 60]`.
    pub fn from_ev100(ev100: f64) -> Result<Self, ImageError> {
        if (-40.0..=60.0).contains(&ev100) {
            Ok(Self {
                factor: 1.0 / (1.2 * ev100.exp2()),
            })
        } else {
            Err(ImageError::Setting {
                what: "the exposure value (EV at ISO 100)",
                got: ev100.to_string(),
                right: "between -40 and 60",
            })
        }
    }

    /// An exposure metered from luminances, such as those of a coarse grid of pixels: scales their typical value to the key of the
    /// metering. `None` where no luminance is positive or the key is negative or NaN.
    ///
    /// `samples` are pairs of luminance and weight (solid angle, or 1); NaN, infinite and non-positive luminances and weights are
    /// ignored. The typical value is the weighted geometric mean between two percentiles, so that the sun's disc or a black
    /// ground have no influence. The order of the samples changes the result only by rounding.
    pub fn metered(samples: &[(f32, f32)], metering: Metering) -> Option<Self> {
        let typical = metering.typical_luminance(samples)?;
        let factor = metering.key * metering.compensation_stops.exp2() / typical;
        Self::from_factor(factor).ok()
    }

    /// Factor for linear values.
    pub fn factor(self) -> f64 {
        self.factor
    }

    /// Equivalent exposure value at ISO 100, for linear values in cd/m^2.
    pub fn ev100(self) -> f64 {
        -(1.2 * self.factor).log2()
    }

    /// The same exposure, brighter by a number of stops (darker where negative).
    ///
    /// # Errors
    /// [`ImageError::Setting`] where the result is out of range.
    pub fn brighter_by(self, stops: f64) -> Result<Self, ImageError> {
        Self::from_factor(self.factor * stops.exp2())
    }
}

/// Settings of [`Exposure::metered`].
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Metering {
    /// Exposed value of the typical luminance; 0.18, middle grey, by default.
    pub key: f64,
    /// Fraction of the darkest luminances ignored, 0 to 1.
    pub low_percentile: f64,
    /// Fraction of luminances above which the brightest are ignored, 0 to 1.
    pub high_percentile: f64,
    /// Stops added to the result.
    pub compensation_stops: f64,
}

impl Default for Metering {
    fn default() -> Self {
        Self {
            key: MIDDLE_GREY,
            low_percentile: 0.1,
            high_percentile: 0.95,
            compensation_stops: 0.0,
        }
    }
}

impl Metering {
    /// Weighted geometric mean of the luminances between the percentiles; `None` where no luminance is positive.
    pub fn typical_luminance(&self, samples: &[(f32, f32)]) -> Option<f64> {
        let counts = |v: f32| v.is_finite() && v > 0.0;
        let mut lit: Vec<(f32, f32)> = samples
            .iter()
            .copied()
            .filter(|&(luminance, weight)| counts(luminance) && counts(weight))
            .collect();
        lit.sort_by(|a, b| a.0.total_cmp(&b.0).then(a.1.total_cmp(&b.1)));
        let total: f64 = lit.iter().map(|&(_, weight)| f64::from(weight)).sum();
        let low = self.low_percentile.clamp(0.0, 1.0) * total;
        let high = (self.high_percentile.clamp(0.0, 1.0) * total).max(low);
        let (mut passed, mut sum, mut weights) = (0.0, 0.0, 0.0);
        for &(luminance, weight) in &lit {
            let next = passed + f64::from(weight);
            let share = next.min(high) - passed.max(low);
            if share > 0.0 {
                sum += share * f64::from(luminance).ln();
                weights += share;
            }
            passed = next;
        }
        if weights > 0.0 {
            Some((sum / weights).exp())
        } else {
            // Nothing lies between the percentiles: the luminance at the lower one.
            let mut passed = 0.0;
            lit.iter()
                .find(|&&(_, weight)| {
                    passed += f64::from(weight);
                    passed >= low
                })
                .map(|&(luminance, _)| f64::from(luminance))
        }
    }
}
