//! Errors of the libraries as Python exceptions, with the libraries' sentences.

use airlight::atmosphere::ConfigError;
use airlight::fog::FogError;
use airlight::optics::mie::MieError;
use airlight::scene::SceneError;
use airlight::sky::SkyError;
use airlight::spectrum::GridError;
use airlight::sun::{EphemerisError, MomentError};
use airlight::{Cancelled, UnknownName};
use airlight_image::ImageError;
use airlight_render::RenderError;
use airlight_render::batch::BatchError;
use airlight_validation::RunError;
use pyo3::PyErr;
use pyo3::exceptions::{PyKeyboardInterrupt, PyOSError, PyValueError};

/// An error of a library on its way to Python.
#[derive(Debug)]
pub enum Failure {
    /// An invalid argument: `ValueError`.
    Invalid(String),
    /// A file or the system: `OSError`.
    System(String),
    /// The caller cancelled: `KeyboardInterrupt`.
    Cancelled,
}

impl Failure {
    /// An invalid argument: what is expected, what was given, and what to try.
    pub fn invalid(sentence: impl Into<String>) -> Self {
        Self::Invalid(sentence.into())
    }
}

impl From<Failure> for PyErr {
    fn from(failure: Failure) -> Self {
        match failure {
            Failure::Invalid(sentence) => PyValueError::new_err(sentence),
            Failure::System(sentence) => PyOSError::new_err(sentence),
            Failure::Cancelled => PyKeyboardInterrupt::new_err(()),
        }
    }
}

impl From<Cancelled> for Failure {
    fn from(_: Cancelled) -> Self {
        Self::Cancelled
    }
}

impl From<RenderError> for Failure {
    fn from(error: RenderError) -> Self {
        match error {
            RenderError::Image(error) => error.into(),
            error if error.is_cancelled() => Self::Cancelled,
            error if error.is_refusal() => Self::Invalid(error.to_string()),
            error => Self::System(error.to_string()),
        }
    }
}

impl From<ImageError> for Failure {
    fn from(error: ImageError) -> Self {
        let sentence = error.to_string();
        match error {
            ImageError::Cancelled => Self::Cancelled,
            // Of files and of arrays alike.
            ImageError::NegativeDepth { .. }
            | ImageError::SizesDiffer { .. }
            | ImageError::Read { .. } => Self::Invalid(sentence),
            error => match RenderError::from(error).is_refusal() {
                true => Self::Invalid(sentence),
                false => Self::System(sentence),
            },
        }
    }
}

impl From<RunError> for Failure {
    fn from(error: RunError) -> Self {
        match error {
            RunError::Cancelled(_) => Self::Cancelled,
            error => Self::Invalid(error.to_string()),
        }
    }
}

impl From<BatchError> for Failure {
    fn from(error: BatchError) -> Self {
        match (error.is_cancelled(), error.is_refusal()) {
            (true, _) => Self::Cancelled,
            (false, true) => Self::Invalid(error.to_string()),
            (false, false) => Self::System(error.to_string()),
        }
    }
}

impl From<SceneError> for Failure {
    fn from(error: SceneError) -> Self {
        match error.is_cancelled() {
            true => Self::Cancelled,
            false => Self::Invalid(error.to_string()),
        }
    }
}

/// Errors about an argument, unless the caller cancelled.
macro_rules! cancelled_or_invalid {
    ($($error:ident),+) => {$(
        impl From<$error> for Failure {
            fn from(error: $error) -> Self {
                match error {
                    $error::Cancelled(_) => Self::Cancelled,
                    _ => Self::Invalid(error.to_string()),
                }
            }
        }
    )+};
}

cancelled_or_invalid!(FogError, MieError, SkyError);

/// Errors that are always about an argument.
macro_rules! invalid {
    ($($error:ty),+) => {$(
        impl From<$error> for Failure {
            fn from(error: $error) -> Self {
                Self::Invalid(error.to_string())
            }
        }
    )+};
}

invalid!(
    ConfigError,
    EphemerisError,
    GridError,
    MomentError,
    UnknownName
);
