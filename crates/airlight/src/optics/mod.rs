//! What one particle does to light.

pub mod ozone;
pub mod phase;
pub mod rayleigh;
mod tabulated;

pub use phase::{Depolarization, PhaseError, PhaseFunction, PhaseSampler};
pub use tabulated::TabulatedPhase;
