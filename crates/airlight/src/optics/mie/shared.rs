//! Tables of published drops: embedded or built once in a process, and shared.

use super::droplets::Drops;
use super::{BulkOptics, MieError, Particles};
use crate::control::Control;
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

/// The wavelength for which visibility is defined, nm.
pub(super) const GREEN_NM: f64 = 550.0;

/// Drops, and the bits of the wavelengths.
type Key = (Drops, Vec<u64>);

/// No lock is held while a table is built, because building waits for other threads, which may need the cache too. Two
/// threads that request the same table at the same time may both build it, with equal results.
static TABLES: LazyLock<Mutex<HashMap<Key, Arc<DropTable>>>> = LazyLock::new(Mutex::default);

impl Drops {
    /// Table at wavelengths (nm, increasing), built once in a process and cached.
    ///
    /// At the wavelengths of the grids `rgb`, `fast` and `standard` it is read from embedded tables, which are sums over 20 times (rain: 5)
    /// as many sizes as [`Particles::table`]'s, and are stored with errors below 2e-4 of the phase function and 0.004 of the other
    /// elements of the scattering matrix relative to it. Building a table for other wavelengths takes 0.1 to 0.5 s per wavelength
    /// on two cores, 1.5 s for rain (example `spheres`).
    ///
    /// # Errors
    /// As [`Particles::table`].
    pub fn table(self, wavelengths_nm: &[f64]) -> Result<Arc<DropTable>, MieError> {
        self.table_with(wavelengths_nm, Control::default())
    }

    /// As [`Drops::table`], with cancellation.
    ///
    /// # Errors
    /// As [`Drops::table`], and if the caller cancelled.
    pub fn table_with(
        self,
        wavelengths_nm: &[f64],
        control: Control<'_>,
    ) -> Result<Arc<DropTable>, MieError> {
        let tables = || TABLES.lock().unwrap_or_else(PoisonError::into_inner);
        let bits = wavelengths_nm.iter().map(|nm| nm.to_bits()).collect();
        let key = (self, bits);
        if let Some(table) = tables().get(&key).cloned() {
            return Ok(table);
        }
        let table = match self.stored_table(wavelengths_nm) {
            Some(table) => table,
            None => self.computed_table_with(wavelengths_nm, control)?,
        };
        Ok(tables().entry(key).or_insert(Arc::new(table)).clone())
    }

    /// Table from theory, neither embedded nor cached.
    ///
    /// # Errors
    /// As [`Particles::table`].
    pub fn computed_table(self, wavelengths_nm: &[f64]) -> Result<DropTable, MieError> {
        self.computed_table_with(wavelengths_nm, Control::default())
    }

    fn computed_table_with(
        self,
        wavelengths_nm: &[f64],
        control: Control<'_>,
    ) -> Result<DropTable, MieError> {
        let water = Particles::water(self.sizes())?;
        let (phase, bulk) = water.table_with(wavelengths_nm, control)?;
        let green = water.bulk_with(GREEN_NM, control)?;
        Ok(DropTable { phase, bulk, green })
    }
}
