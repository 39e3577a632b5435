//! Radiative transfer shared by sky, fog, published models and Monte Carlo.
//!
//! [`RgbPathOptics`]: transmittance and path radiance of a ray segment, and their composition; `ray`, `shell` and `columns`: geometry of a
//! spherical atmosphere, and columns from any point to space; `coefficients`: optical coefficients at some wavelengths;
//! `march`: integration along a ray; `delta_m`: separation of the forward peak of a phase function; `residual`: sunlight scattered
//! by the rest of it that moments cannot represent.

pub(crate) mod coefficients;
pub(crate) mod columns;
pub(crate) mod delta_m;
pub(crate) mod march;
mod path_optics;
pub(crate) mod ray;
pub(crate) mod residual;
pub(crate) mod shell;

pub use crate::math::exponentials::{count_exponentials, exponentials};
pub(crate) use path_optics::PathOptics;
pub use path_optics::RgbPathOptics;
pub use shell::medium_evaluations;
