//! Tables of published drops: built once in a process, and shared.

use super::droplets::Drops;
use super::{BulkOptics, MieError, Particles};
use crate::optics::TabulatedPhase;
use std::collections::HashMap;
use std::sync::{Arc, LazyLock, Mutex, PoisonError};

/// Optical properties of one kind of drops at several wavelengths.
#[derive(Clone, Debug, PartialEq)]
pub struct DropTable {
    /// Phase function with the scattering matrix.
    pub phase: TabulatedPhase,
    /// Cross-sections and asymmetry at each wavelength, in increasing order.
    pub bulk: Vec<BulkOptics>,
    /// Cross-sections and asymmetry at 550 nm, the wavelength for which visibility is defined.
    pub green: BulkOptics,
}

/// Drops, and the bits of the wavelengths.
type Key = (Drops, Vec<u64>);

/// No lock is held while a table is built, because building waits for other threads, which may need the cache too. Two
/// threads that request the same table at the same time may both build it, with equal results.
static TABLES: LazyLock<Mutex<HashMap<Key, Arc<DropTable>>>> = LazyLock::new(Mutex::default);

impl Drops {
    /// Table at wavelengths (nm, increasing), built once in a process and cached. Building takes 0.1 to 0.5 s per wavelength on
    /// two cores, 1.5 s for rain (example `spheres`).
    ///
    /// # Errors
    /// As [`Particles::table`].
    pub fn table(self, wavelengths_nm: &[f64]) -> Result<Arc<DropTable>, MieError> {
        let tables = || TABLES.lock().unwrap_or_else(PoisonError::into_inner);
        let bits = wavelengths_nm.iter().map(|nm| nm.to_bits()).collect();
        let key = (self, bits);
        if let Some(table) = tables().get(&key).cloned() {
            return Ok(table);
        }
        let water = Particles::water(self.sizes())?;
        let (phase, bulk) = water.table(wavelengths_nm)?;
        let green = water.bulk(550.0)?;
        let built = Arc::new(DropTable { phase, bulk, green });
        Ok(tables().entry(key).or_insert(built).clone())
    }
}
