//! Lorenz-Mie theory: scattering and absorption by homogeneous spheres of any size and refractive index.
//!
//! **Conventions.** The time dependence is `e^(-i omega t)`, so an absorbing sphere has the index `n + i k`, `k >= 0` (Bohren
//! & Huffman, *Absorption and Scattering of Light by Small Particles*, 1983; codes after van de Hulst and Wiscombe use
//! `n - i k`). The index is relative to the air around the sphere. The size parameter is `x = 2 pi r / lambda`, the
//! circumference in wavelengths. Equation numbers `BH` are those of Bohren & Huffman.
//!
//! Modules: `recurrence` (Riccati-Bessel functions), [`Sphere`] (coefficients, efficiencies), `angular` (amplitudes at many
//! angles), [`SizeDistribution`], [`Particles`] (bulk coefficients and phase functions of many spheres), [`droplets`]
//! (published fogs and clouds), [`DropTable`] (their tables, cached), `stored` (embedded tables).

mod angles;
mod angular;
mod coefficients;
pub mod droplets;
mod matrix;
mod particles;
mod recurrence;
mod shared;
mod sizes;
mod sphere;
mod stored;

pub use matrix::ScatteringMatrix;
pub use num_complex::Complex64;
pub use particles::{BulkOptics, Particles};
pub use shared::DropTable;
pub use sizes::{SizeDistribution, SizeNode};
pub use sphere::{Efficiencies, Sphere};

use crate::control::Cancelled;

/// Largest supported size parameter: a drop of 1 cm at 600 nm.
pub(crate) const LARGEST_SIZE_PARAMETER: f64 = 1e5;
/// Largest supported modulus of a refractive index.
pub(crate) const LARGEST_INDEX: f64 = 1e3;

/// Error of a sphere or a distribution of spheres.
#[derive(Clone, Debug, PartialEq, thiserror::Error)]
#[non_exhaustive]
pub enum MieError {
    /// The size parameter is out of range.
    #[error("expected a size parameter above 0 and at most {LARGEST_SIZE_PARAMETER}, got {0}")]
    SizeParameter(f64),
    /// The refractive index is out of range.
    #[error(
        "expected a refractive index n + i k with n and k of at least 0 and a modulus above 0 and at most {LARGEST_INDEX}, got {real} + i {imaginary}"
    )]
    Index {
        /// Real part of the index.
        real: f64,
        /// Imaginary part of the index.
        imaginary: f64,
    },
    /// The wavelength is not positive.
    #[error("expected a finite wavelength above 0 nm, got {0}")]
    Wavelength(f64),
    /// A parameter of the size distribution is out of range.
    #[error("expected {what} to be {right}, got {got}")]
    Sizes {
        /// The parameter, with its unit.
        what: &'static str,
        /// Value of the parameter.
        got: f64,
        /// The valid range.
        right: &'static str,
    },
    /// The wavelengths do not make a table of a phase function.
    #[error(transparent)]
    Phase(#[from] super::phase_error::PhaseError),
    /// The caller cancelled the computation.
    #[error(transparent)]
    Cancelled(#[from] Cancelled),
}
