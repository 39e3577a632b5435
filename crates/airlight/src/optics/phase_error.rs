//! Errors of phase functions.

/// Error of a phase function's constructor or of [`PhaseFunction::validate`](super::PhaseFunction::validate).
#[derive(Clone, Debug, PartialEq, thiserror::Error)]
#[non_exhaustive]
pub enum PhaseError {
    /// The asymmetry parameter is out of range.
    #[error("expected an asymmetry parameter g strictly between -1 and 1, got {0}")]
    Asymmetry(f64),
    /// Draine's alpha is out of range.
    #[error("expected a finite alpha of at least 0, got {0}")]
    Alpha(f64),
    /// The depolarization ratio is out of range.
    #[error("expected a depolarization ratio in [0, 6/7), got {0}")]
    Depolarization(f64),
    /// A mixture without parts, or with a weight that is negative or not finite.
    #[error(
        "expected at least one part in a mixture, with finite weights of at least 0; got the weight {weight} at index {index}"
    )]
    Weight {
        /// Index of the part, from 0.
        index: usize,
        /// Weight of the part (NaN if there are no parts).
        weight: f64,
    },
    /// The weights of a mixture do not sum to 1.
    #[error(
        "expected the weights of a mixture to sum to 1, got {0}; try dividing each by their sum"
    )]
    WeightSum(f64),
    /// The angles of a table do not increase strictly from 0 to 180 degrees.
    #[error(
        "expected angles that increase strictly from 0 to 180 degrees, got {value} at index {index}"
    )]
    Angles {
        /// Index of the angle, from 0.
        index: usize,
        /// The angle, degrees.
        value: f64,
    },
    /// The wavelengths of a table are not positive or not strictly increasing.
    #[error("expected positive, strictly increasing wavelengths, got {value} nm at index {index}")]
    Wavelengths {
        /// Index of the wavelength, from 0.
        index: usize,
        /// The wavelength, nm.
        value: f64,
    },
    /// The number of values differs from the number of wavelengths times the number of angles.
    #[error("expected {expected} values for {wavelengths} wavelengths and {angles} angles, got {got}", expected = wavelengths * angles)]
    Length {
        /// Number of wavelengths.
        wavelengths: usize,
        /// Number of angles.
        angles: usize,
        /// Number of values.
        got: usize,
    },
    /// An element of a scattering matrix is out of range.
    #[error(
        "expected elements of the scattering matrix relative to the phase function in [-1, 1], got {value} at index {index}"
    )]
    Matrix {
        /// Index of the entry, from 0, with the angle varying fastest.
        index: usize,
        /// The element.
        value: f64,
    },
    /// A tabulated value is not positive and finite.
    #[error("expected positive, finite values, got {value} at index {index}")]
    Value {
        /// Index of the value, from 0, with the angle varying fastest.
        index: usize,
        /// The value.
        value: f64,
    },
}
