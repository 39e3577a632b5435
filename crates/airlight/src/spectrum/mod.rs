//! Wavelength grids, spectra, the solar spectrum and colour.
//!
//! - [`WavelengthGrid`]: the wavelengths, the solar irradiance at each, and the conversion to XYZ.
//! - [`SpectralCurve`], [`SampledCurve`]: quantities as functions of wavelength, before they are sampled on a grid.
//! - [`solar`], [`color_matching`]: the extraterrestrial solar spectrum and the standard observer.
//! - [`rgb`], [`difference`]: linear RGB spaces and colour differences.

mod cie;
#[cfg(test)]
mod colour_cost;
mod curve;
pub mod difference;
mod grid;
mod interpolant;
mod lanes;
pub mod rgb;
pub mod solar;
mod table;

pub use cie::color_matching;
pub use curve::{CurveError, SampledCurve, SpectralCurve};
pub use grid::{GridError, GridPreset, WavelengthGrid};
pub(crate) use lanes::Spectrum;
pub use rgb::RgbSpace;
pub(crate) use table::embedded as embedded_table;
