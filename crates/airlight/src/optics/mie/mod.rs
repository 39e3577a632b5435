//! Lorenz-Mie theory: what a homogeneous sphere of any size and any refractive index does to light.
//!
//! **Conventions.** Time goes as `e^(-i omega t)`, so that a sphere that absorbs has the index `n + i k`, `k >= 0` (Bohren
//! & Huffman, *Absorption and Scattering of Light by Small Particles*, 1983; codes after van de Hulst and Wiscombe write
//! `n - i k`). The index is relative to the air around the sphere. The size parameter is `x = 2 pi r / lambda`, the length of
//! the sphere's edge in wavelengths. Equation numbers `BH` are those of Bohren & Huffman.
//!
//! From the ground up: `recurrence` (Riccati-Bessel functions), [`Sphere`] (coefficients, efficiencies), `angular`
//! (amplitudes at many angles at once), [`SizeDistribution`], [`Particles`] (many spheres of one kind: coefficients and
//! phase functions in bulk), [`droplets`] (published fogs and clouds), [`DropTable`] (their tables, built once).

mod angles;
mod angular;
pub mod droplets;
mod particles;
mod recurrence;
mod shared;
mod sizes;
mod sphere;

pub use num_complex::Complex64;
pub use particles::{BulkOptics, Particles};
pub use shared::DropTable;
pub use sizes::{SizeDistribution, SizeNode};
pub use sphere::{Efficiencies, ScatteringMatrix, Sphere};

/// The largest size parameter taken: a drop of 1 cm at 600 nm.
pub const LARGEST_SIZE_PARAMETER: f64 = 1e5;
/// The largest modulus of a refractive index taken.
pub const LARGEST_INDEX: f64 = 1e3;

/// Why numbers do not make a sphere, or many.
#[derive(Clone, Debug, PartialEq, thiserror::Error)]
pub enum MieError {
    /// The size parameter is out of range.
    #[error("the size parameter must lie above 0 and not above {LARGEST_SIZE_PARAMETER}, got {0}")]
    SizeParameter(f64),
    /// The refractive index is out of range.
    #[error(
        "the refractive index must be n + i k with n and k not below 0, not 0 and not above {LARGEST_INDEX}, got {real} + i {imaginary}"
    )]
    Index {
        /// Its real part.
        real: f64,
        /// Its imaginary part.
        imaginary: f64,
    },
    /// The wavelength is not positive.
    #[error("the wavelength must be finite and above 0 nm, got {0}")]
    Wavelength(f64),
    /// A number of the size distribution is out of range.
    #[error("{what} must be {right}, got {got}")]
    Sizes {
        /// Which number, with its unit.
        what: &'static str,
        /// What was given.
        got: f64,
        /// What would be right.
        right: &'static str,
    },
    /// The table of the phase function is refused.
    #[error(transparent)]
    Phase(#[from] super::phase::PhaseError),
}
