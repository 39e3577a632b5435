//! A quantity as a function of wavelength, before it is sampled on a grid.

use crate::math::interpolation::piecewise_linear;

/// A quantity that depends on wavelength.
#[derive(Clone, Debug, PartialEq)]
pub enum SpectralCurve {
    /// The same at every wavelength.
    Constant(f64),
    /// Piecewise linear between samples, constant beyond the ends.
    Table(SampledCurve),
    /// `value_at_550_nm * (wavelength / 550 nm)^(-exponent)`: the Angstrom law, and Rayleigh's with exponent 4.
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
    /// The value at a wavelength in nanometres.
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

    /// A piecewise linear curve. Errors as [`SampledCurve::new`].
    pub fn table(wavelengths_nm: Vec<f64>, values: Vec<f64>) -> Result<Self, CurveError> {
        SampledCurve::new(wavelengths_nm, values).map(Self::Table)
    }
}

/// Samples of a function at strictly increasing abscissae, joined by straight lines and constant beyond the ends.
#[derive(Clone, Debug, PartialEq)]
pub struct SampledCurve {
    abscissae: Vec<f64>,
    values: Vec<f64>,
}

/// Why samples do not make a curve.
#[derive(Clone, Debug, PartialEq, thiserror::Error)]
pub enum CurveError {
    /// No samples, or not one value for each abscissa.
    #[error(
        "a table needs as many values as abscissae, and at least one: got {abscissae} abscissae and {values} values"
    )]
    Length {
        /// Number of abscissae.
        abscissae: usize,
        /// Number of values.
        values: usize,
    },
    /// Abscissae not strictly increasing, or not finite.
    #[error("abscissae must be finite and strictly increasing: entry {index} is {value}")]
    Order {
        /// Which entry, counted from 0.
        index: usize,
        /// Its abscissa.
        value: f64,
    },
    /// A value that is not finite.
    #[error("values must be finite: entry {index} is {value}")]
    Value {
        /// Which entry, counted from 0.
        index: usize,
        /// Its value.
        value: f64,
    },
}

impl SampledCurve {
    /// Checks and takes the samples.
    ///
    /// # Errors
    /// [`CurveError`] where the lengths differ or are 0, an abscissa is not above its predecessor, or a number is not
    /// finite.
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

    /// The value at `x`.
    pub fn at(&self, x: f64) -> f64 {
        piecewise_linear(&self.abscissae, &self.values, x)
    }

    /// Where the samples lie.
    pub fn abscissae(&self) -> &[f64] {
        &self.abscissae
    }

    /// The samples.
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
    fn bad_tables_are_refused() {
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
