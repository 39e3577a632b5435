//! Radiative transfer shared by sky, fog, published models and Monte Carlo.
//!
//! [`PathOptics`] is the affine map of a ray segment; [`ray`], [`shell`] and [`columns`] are the geometry of a spherical
//! atmosphere; [`march`] integrates along a ray; [`air`] is an atmosphere at N wavelengths.

pub(crate) mod air;
pub(crate) mod columns;
pub(crate) mod march;
mod path_optics;
pub(crate) mod ray;
pub(crate) mod shell;

pub use path_optics::PathOptics;
