//! Quantities as functions of wavelength, before they are sampled on a grid.

use crate::math::interpolation::piecewise_linear;

/// A quantity as a function of wavelength.
#[derive(Clone, Debug, PartialEq)]
#[non_exhaustive]
pub enum SpectralCurve {
    /// The same at every wavelength.
    Constant(f64),
    /// Piecewise linear between samples, constant beyond the ends.
    Table(SampledCurve),
    /// `value_at_550_nm * (wavelength / 550 nm)^(-exponent)`: the Angstrom law, or a Rayleigh law with exponent 4.
    PowerLaw {
        /// Value at 550 nm.
        value_at_550_nm: f64,
        /// Angstrom exponent: positive where the quantity falls with wavelength.
        exponent: f64,
    },
    /// `factor * curve`.
    Scaled(f64, Box<SpectralCurve>),
}

impl SpectralCurve {
    /// Value at a wavelength in nm.
    pub fn at(&self, wavelength_nm: f64) -> f64 {
        match self {
            Self::Constant(value) => *value,
            Self::Table(table) => table.at(wavelength_nm),
            Self::PowerLaw {
                value_at_550_nm,
                exponent,
            } => value_at_550_nm * (wavelength_nm / 550.0).powf(-exponent),
            Self::Scaled(factor, curve) => factor * curve.at(wavelength_nm),
        }
    }

    /// This curve times `factor`.
    pub fn scaled(self, factor: f64) -> Self {
        match self {
            Self::Scaled(inner, curve) => Self::Scaled(inner * factor, curve),
            curve => Self::Scaled(factor, Box::new(curve)),
        }
    }

    /// A piecewise linear curve through `values` at `wavelengths_nm`.
    ///
    /// # Errors
    /// As [`SampledCurve::new`].
    pub fn table(wavelengths_nm: Vec<f64>, values: Vec<f64>) -> Result<Self, CurveError> {
        SampledCurve::new(wavelengths_nm, values).map(Self::Table)
    }
}

/// A piecewise linear function through samples at strictly increasing abscissae, constant beyond the ends.
#[derive(Clone, Debug, PartialEq)]
pub struct SampledCurve {
    abscissae: Vec<f64>,
    values: Vec<f64>,
}

/// Error of [`SampledCurve::new`] and [`SpectralCurve::table`].
#[derive(Clone, Debug, PartialEq, thiserror::Error)]
#[non_exhaustive]
pub enum CurveError {
    /// No samples, or different numbers of abscissae and values.
    #[error(
        "expected as many values as abscissae, and at least one; got {abscissae} abscissae and {values} values"
    )]
    Length {
        /// Number of abscissae.
        abscissae: usize,
        /// Number of values.
        values: usize,
    },
    /// An abscissa that is not finite or not above its predecessor.
    #[error(
        "expected finite, strictly increasing abscissae; got {value} at index {index}; try sorting the samples"
    )]
    Order {
        /// Index of the abscissa, from 0.
        index: usize,
        /// Value of the abscissa.
        value: f64,
    },
    /// A value that is not finite.
    #[error("expected finite values, got {value} at index {index}")]
    Value {
        /// Index of the value, from 0.
        index: usize,
        /// The value that is not finite.
        value: f64,
    },
}

impl SampledCurve {
    /// Creates a curve from samples.
    ///
    /// # Errors
    /// [`CurveError`] if the lengths differ or are 0, the abscissae are not strictly increasing, or a number is not finite.
    pub fn new(abscissae: Vec<f64>, values: Vec<f64>) -> Result<Self, CurveError> {
        if abscissae.len() != values.len() || abscissae.is_empty() {
            return Err(CurveError::Length {
                abscissae: abscissae.len(),
                values: values.len(),
            });
        }
        for (index, &value) in abscissae.iter().enumerate() {
            if !value.is_finite() || (index > 0 && value <= abscissae[index - 1]) {
                return Err(CurveError::Order { index, value });
            }
        }
        if let Some(index) = values.iter().position(|v| !v.is_finite()) {
            return Err(CurveError::Value {
                index,
                value: values[index],
            });
        }
        Ok(Self { abscissae, values })
    }

    /// Interpolated value at `x`.
    pub fn at(&self, x: f64) -> f64 {
        piecewise_linear(&self.abscissae, &self.values, x)
    }

    /// Abscissae of the samples, strictly increasing.
    pub fn abscissae(&self) -> &[f64] {
        &self.abscissae
    }

    /// Values of the samples, one for each abscissa.
    pub fn values(&self) -> &[f64] {
        &self.values
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn tables_are_linear_inside_and_constant_outside() {
        let curve = SpectralCurve::table(vec![400.0, 500.0, 700.0], vec![1.0, 3.0, -1.0]).unwrap();
        for (x, y) in [
            (300.0, 1.0),
            (400.0, 1.0),
            (450.0, 2.0),
            (600.0, 1.0),
            (900.0, -1.0),
        ] {
            assert_eq!(curve.at(x), y);
        }
        assert_eq!(curve.scaled(2.0).scaled(3.0).at(450.0), 12.0);
    }

    #[test]
    fn invalid_tables_are_refused() {
        assert!(matches!(
            SampledCurve::new(vec![], vec![]),
            Err(CurveError::Length { .. })
        ));
        assert!(matches!(
            SampledCurve::new(vec![1.0, 1.0], vec![0.0, 0.0]),
            Err(CurveError::Order { index: 1, .. })
        ));
        assert!(matches!(
            SampledCurve::new(vec![1.0, 2.0], vec![0.0, f64::NAN]),
            Err(CurveError::Value { index: 1, .. })
        ));
    }
}
