//! Integrals over a tabulated phase function, shared by all copies of the table.

use std::sync::OnceLock;

/// Integrals of each wavelength.
#[derive(Debug)]
pub(super) struct Integrals {
    /// Fraction of the light scattered by less than each angle, with the angle varying fastest.
    pub cumulative: Vec<f64>,
    /// The first Legendre moments, computed when they are first used.
    moments: Vec<OnceLock<Vec<f64>>>,
}

impl Integrals {
    /// Integrals of this number of wavelengths.
    pub fn new(cumulative: Vec<f64>, wavelengths: usize) -> Self {
        Self {
            cumulative,
            moments: (0..wavelengths).map(|_| OnceLock::new()).collect(),
        }
    }

    /// The first moments by index of the wavelength.
    pub fn moments(&self, row: usize, compute: impl FnOnce() -> Vec<f64>) -> &[f64] {
        self.moments[row].get_or_init(compute)
    }
}

/// Tables are equal whether or not their moments have been computed.
impl PartialEq for Integrals {
    fn eq(&self, other: &Self) -> bool {
        self.cumulative == other.cumulative
    }
}
