//! Wavelength grids, spectra, the solar spectrum, colour.

mod curve;
mod lanes;

pub use curve::{CurveError, SampledCurve, SpectralCurve};
pub use lanes::Spectrum;
