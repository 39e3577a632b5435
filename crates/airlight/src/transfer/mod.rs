//! Radiative transfer shared by sky, fog, published models and Monte Carlo.
//!
//! [`PathOptics`]: transmittance and path radiance of a ray segment; `ray`, `shell` and `columns`: geometry of a
//! spherical atmosphere; `march`: integration along a ray; `air`: optical coefficients at N wavelengths.

pub(crate) mod air;
pub(crate) mod columns;
pub(crate) mod march;
mod path_optics;
pub(crate) mod ray;
pub(crate) mod shell;

pub use path_optics::{PathOptics, RgbPathOptics};
