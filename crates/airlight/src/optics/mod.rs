//! Optical properties of single particles: refractive indices, cross-sections, phase functions, polarisation.

mod index;
pub mod mie;
pub mod ozone;
mod phase;
mod phase_error;
mod polarisation;
pub mod rayleigh;
mod tabulated;

pub use index::RefractiveIndex;
pub(crate) use phase::PhaseSampler;
pub use phase::{Depolarization, PhaseFunction};
pub use phase_error::PhaseError;
pub use polarisation::MatrixRatios;
pub(crate) use polarisation::{PolarisedMoments, plane_of_polarisation_deg};
pub use tabulated::TabulatedPhase;
