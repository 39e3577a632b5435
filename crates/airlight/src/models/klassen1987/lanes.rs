//! Wavelengths of the model, and spectra at them.

use crate::spectrum::{Spectrum, WavelengthGrid};

/// Number of wavelengths.
pub const WAVELENGTHS: usize = 33;
/// First wavelength, nm; the others follow every 10 nm up to 700 nm.
pub const FIRST_NM: f64 = 380.0;

/// A spectrum of the model.
pub(super) type Lanes = Spectrum<WAVELENGTHS>;

/// The wavelengths, nm.
pub(super) fn wavelengths_nm() -> impl Iterator<Item = f64> {
    (0..WAVELENGTHS).map(|i| FIRST_NM + 10.0 * i as f64)
}

/// The wavelengths as a grid with the Earth's solar spectrum.
pub fn wavelength_grid() -> WavelengthGrid {
    WavelengthGrid::from_wavelengths_nm(wavelengths_nm().collect())
        .expect("the model's wavelengths are in order")
}

/// Transmittance `e^-depth` of an optical depth.
pub(super) fn exp_neg(depth: Lanes) -> Lanes {
    (depth * -1.0).exp()
}

/// XYZ of a radiance, Y in cd/m^2.
pub(super) fn to_xyz(grid: &WavelengthGrid, radiance: &Lanes) -> [f64; 3] {
    grid.to_xyz(&radiance.0)
}

/// The values of a spectrum in double precision.
pub(super) fn f64s(lanes: &Lanes) -> Vec<f64> {
    lanes.0.iter().map(|&v| f64::from(v)).collect()
}
