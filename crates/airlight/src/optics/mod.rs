//! Optical properties of single particles: refractive indices, cross-sections, phase functions, polarisation.

mod index;
pub mod mie;
pub mod ozone;
pub mod phase;
mod polarisation;
pub mod rayleigh;
mod tabulated;

pub use index::RefractiveIndex;
pub use phase::{Depolarization, PhaseError, PhaseFunction, PhaseSampler};
pub use polarisation::MatrixRatios;
pub use tabulated::TabulatedPhase;
