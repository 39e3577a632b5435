//! The solver for a spherical, multiply scattering atmosphere.
pub mod air;
pub mod columns;
pub mod field;
pub mod harmonics;
pub mod march;
pub mod orders;
pub mod quadrature;
pub mod ray;
pub mod shell;
pub mod trace;

/// Why a sky cannot be prepared.
#[derive(Clone, Debug, PartialEq, thiserror::Error)]
pub enum SkyError {
    /// More constituents than the solver handles.
    #[error("the sky solver handles at most {max} constituents: this atmosphere has {0}", max = shell::MAX_CONSTITUENTS)]
    TooManyConstituents(usize),
}
