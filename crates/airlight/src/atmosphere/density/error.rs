//! Errors of density profiles.

/// Why a density profile is invalid.
#[derive(Clone, Debug, PartialEq, thiserror::Error)]
#[non_exhaustive]
pub enum DensityError {
    /// A scale height that is not positive and finite.
    #[error(
        "scale height: expected a finite number of metres above 0, got {0}; try a layer for a sharp top, or uniform density"
    )]
    ScaleHeight(f64),
    /// A height that is not finite.
    #[error("{which}: expected a finite number of metres, got {got_m}")]
    Height {
        /// Name of the height.
        which: &'static str,
        /// Its value, m.
        got_m: f64,
    },
    /// Edges out of order, or not finite.
    #[error("edges of a layer: expected finite heights (m) in increasing order, got {0:?}")]
    Edges(Vec<f64>),
    /// Altitudes of a table that are not strictly increasing, or fewer than two.
    #[error(
        "altitudes of a table: expected two or more finite, strictly increasing numbers (m), got {value} at index {index}"
    )]
    Altitudes {
        /// Index of the entry.
        index: usize,
        /// Altitude of the entry (NaN if it is missing).
        value: f64,
    },
    /// Numbers of altitudes and densities that differ.
    #[error(
        "densities of a table: expected one for each of {altitudes} altitudes, got {densities}"
    )]
    Length {
        /// Number of altitudes.
        altitudes: usize,
        /// Number of densities.
        densities: usize,
    },
    /// A density or factor that is negative or not finite.
    #[error(
        "densities and factors: expected finite numbers not below 0, got {value} at index {index}"
    )]
    Negative {
        /// Index of the entry.
        index: usize,
        /// Its value.
        value: f64,
    },
}
