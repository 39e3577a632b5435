//! Moments that are computed once for all copies of a table.

use std::sync::{Arc, OnceLock};

/// The first moments of each wavelength, computed when they are first used.
#[derive(Clone, Debug)]
pub(super) struct MomentCache(Arc<[OnceLock<Vec<f64>>]>);

impl MomentCache {
    /// An empty cache.
    pub fn new(wavelengths: usize) -> Self {
        Self((0..wavelengths).map(|_| OnceLock::new()).collect())
    }

    /// Moments by index of the wavelength.
    pub fn get(&self, row: usize, compute: impl FnOnce() -> Vec<f64>) -> &[f64] {
        self.0[row].get_or_init(compute)
    }
}

/// Tables are equal whether or not their moments have been computed.
impl PartialEq for MomentCache {
    fn eq(&self, _: &Self) -> bool {
        true
    }
}
