//! Wavelength grids, spectra, the solar spectrum and colour.
//!
//! - [`Spectrum`]: a fixed number of wavelength lanes, the value type of radiative transfer.
//! - [`WavelengthGrid`]: the wavelengths, the solar irradiance at each, and the conversion to XYZ ([`grid`]).
//! - [`SpectralCurve`], [`SampledCurve`]: quantities as functions of wavelength, before they are sampled on a grid.
//! - [`solar`], [`cie`]: the extraterrestrial solar spectrum and the standard observer.
//! - [`rgb`], [`difference`]: linear RGB spaces and colour differences.

pub mod cie;
#[cfg(test)]
mod colour_cost;
mod curve;
pub mod difference;
pub mod grid;
mod lanes;
pub mod rgb;
pub mod solar;
mod table;

pub use curve::{CurveError, SampledCurve, SpectralCurve};
pub use grid::{GridError, GridPreset, WavelengthGrid};
pub use lanes::Spectrum;
pub use rgb::RgbSpace;
pub(crate) use table::embedded as embedded_table;
