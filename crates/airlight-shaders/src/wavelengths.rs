//! The four wavelengths of sky tables.

use airlight::spectrum::WavelengthGrid;

/// Wavelengths of the tables, nm: with fitted weights, the four that reproduce the colours of skies best.
pub const WAVELENGTHS_NM: [f64; 4] = [445.0, 525.0, 575.0, 640.0];

/// Wavelength grid to solve skies with for [`crate::SkyTables`].
pub fn wavelength_grid() -> WavelengthGrid {
    WavelengthGrid::from_wavelengths_nm(WAVELENGTHS_NM.to_vec()).expect("increasing wavelengths")
}
