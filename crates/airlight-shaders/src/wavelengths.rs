//! The four wavelengths of sky tables.

use airlight::spectrum::WavelengthGrid;

/// Wavelengths of the tables, nm: with weights fitted to each view, the four that reproduce the colours of skies best.
///
/// Found by coordinate descent in steps of 5 nm over views in clear and hazy air from 2 m and 10 km, with the sun from 60 to -5
/// degrees: CIEDE2000 0.08 rms. The best four for weights that are fitted once (445, 525, 575 and 640 nm) reach 0.16 there, the best
/// five (435, 480, 530, 605, 660 nm) 0.05 and the best six (410, 455, 500, 550, 600, 645 nm) 0.02.
pub const WAVELENGTHS_NM: [f64; 4] = [440.0, 495.0, 560.0, 625.0];

/// Wavelength grid to solve skies with for [`crate::SkyTables`].
pub fn wavelength_grid() -> WavelengthGrid {
    WavelengthGrid::from_wavelengths_nm(WAVELENGTHS_NM.to_vec()).expect("increasing wavelengths")
}
