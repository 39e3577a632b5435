//! Sunlight outside the atmosphere.

use super::constants as c;
use crate::spectrum::{RgbSpace, WavelengthGrid};

/// Normalisation of the sunlight.
#[derive(Clone, Copy, Debug, PartialEq)]
#[non_exhaustive]
pub enum Sunlight {
    /// White on the ground for a sun at the zenith, with this illuminance there (lx, or [`UNIT_ILLUMINANCE`](super::UNIT_ILLUMINANCE) for colours
    /// without a unit).
    WhiteAtZenith(f64),
    /// Colour and illuminance of the measured solar spectrum (ASTM G173).
    SolarSpectrum,
}

impl Sunlight {
    /// Illuminances of the three channels outside the atmosphere on a surface that faces the sun, lx.
    pub fn illuminance_outside(self) -> [f64; 3] {
        match self {
            Self::WhiteAtZenith(lx) => zenith_depths(c::EYE_ALTITUDE_M).map(|tau| lx * tau.exp()),
            Self::SolarSpectrum => solar_rgb(),
        }
    }
}

/// Linear sRGB of the measured solar spectrum outside the atmosphere, lx.
pub fn solar_rgb() -> [f64; 3] {
    let grid = WavelengthGrid::standard();
    let spectrum: Vec<f32> = grid.solar_irradiance().iter().map(|&e| e as f32).collect();
    RgbSpace::Srgb.from_xyz(grid.to_xyz(&spectrum))
}

/// Optical depths from an altitude (m) to the zenith as printed: without the factor 1.11 of haze.
fn zenith_depths(eye_altitude_m: f64) -> [f64; 3] {
    let top = c::TOP_RADIUS_M - c::PLANET_RADIUS_M;
    let column = |h: f64| h * ((-eye_altitude_m / h).exp() - (-top / h).exp());
    let (air, haze) = (
        column(c::RAYLEIGH_SCALE_HEIGHT_M),
        column(c::MIE_SCALE_HEIGHT_M),
    );
    [0, 1, 2].map(|i| {
        (c::RAYLEIGH_PER_MEGAMETRE[i] * 1e-6 + c::OZONE[i] * 0.06e-5) * air
            + c::MIE_PER_MEGAMETRE * 1e-6 * haze
    })
}
