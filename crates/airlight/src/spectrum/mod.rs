//! Wavelength grids, spectra, the solar spectrum, colour.
//!
//! - [`Spectrum`]: the lanes that transport runs on.
//! - [`WavelengthGrid`]: which wavelengths, the sun's irradiance there, and the way to XYZ ([`grid`]).
//! - [`SpectralCurve`], [`SampledCurve`]: quantities over wavelength, before they are sampled.
//! - [`solar`], [`cie`]: the sun outside the air and the standard observer.
//! - [`rgb`], [`difference`]: linear RGB spaces, and how different two colours look.

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
pub use grid::{GridError, WavelengthGrid};
pub use lanes::Spectrum;
pub use rgb::RgbSpace;
pub(crate) use table::embedded as embedded_table;
