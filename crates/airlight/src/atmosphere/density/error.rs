//! Errors of density profiles.

/// Why numbers do not make a density profile.
#[derive(Clone, Debug, PartialEq, thiserror::Error)]
#[non_exhaustive]
pub enum DensityError {
    /// A scale height that is not positive and finite.
    #[error(
        "scale height: expected a finite number of metres above 0, got {0}; try a layer for a sharp top, or a uniform profile"
    )]
    ScaleHeight(f64),
    /// A height that is not finite.
    #[error("{which}: expected a finite number of metres, got {got_m}")]
    Height {
        /// Which height.
        which: &'static str,
        /// Its value, m.
        got_m: f64,
    },
    /// Edges out of order, or not finite.
    #[error(
        "edges of a layer: expected finite heights (m) that rise from bottom to top, got {0:?}"
    )]
    Edges(Vec<f64>),
    /// Altitudes of a table not strictly increasing, or fewer than two.
    #[error(
        "altitudes of a table: expected two or more finite, strictly rising numbers (m), got {value} at index {index}"
    )]
    Altitudes {
        /// Which entry, counted from 0.
        index: usize,
        /// Its altitude (not a number where it is missing).
        value: f64,
    },
    /// Not one density for each altitude.
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
        /// Which entry, counted from 0.
        index: usize,
        /// Its value.
        value: f64,
    },
}
