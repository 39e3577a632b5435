//! [`RenderError`].

use crate::manifest::ManifestError;
use crate::objects::file::ObjectsError;
use airlight::Cancelled;
use airlight::scene::SceneError;
use airlight_image::ImageError;

/// Error of drawing a scene.
#[derive(Debug, thiserror::Error)]
#[non_exhaustive]
pub enum RenderError {
    /// An invalid frame, a file that cannot be read or written, or cancellation by the caller.
    #[error(transparent)]
    Image(#[from] ImageError),
    /// An invalid scene, or an error of its solver.
    #[error(transparent)]
    Scene(#[from] SceneError),
    /// Invalid objects.
    #[error(transparent)]
    Objects(#[from] ObjectsError),
    /// A manifest that is not usable, or existing pictures with other settings.
    #[error(transparent)]
    Manifest(#[from] ManifestError),
    /// An error with a complete message.
    #[error("{0}")]
    Setting(String),
}

impl RenderError {
    /// An error for a value of a scene: key, values allowed, value given, and what to try instead.
    pub fn value(
        key: impl Into<String>,
        expected: impl Into<String>,
        got: impl Into<String>,
        try_instead: impl Into<String>,
    ) -> Self {
        Self::Scene(SceneError::Value {
            key: key.into(),
            expected: expected.into(),
            got: got.into(),
            try_instead: try_instead.into(),
        })
    }

    /// An error with a complete message.
    pub fn setting(sentence: impl Into<String>) -> Self {
        Self::Setting(sentence.into())
    }

    /// Whether the request is invalid, so that it would fail again; otherwise a file or the system failed.
    pub fn is_refusal(&self) -> bool {
        match self {
            Self::Image(error) => matches!(
                error,
                ImageError::Size { .. }
                    | ImageError::Setting { .. }
                    | ImageError::UnknownFormat { .. }
            ),
            Self::Manifest(error) => error.is_refusal(),
            _ => true,
        }
    }

    /// Whether the caller cancelled.
    pub fn is_cancelled(&self) -> bool {
        match self {
            Self::Image(error) => error.is_cancelled(),
            Self::Scene(error) => error.is_cancelled(),
            _ => false,
        }
    }
}

impl From<Cancelled> for RenderError {
    fn from(_: Cancelled) -> Self {
        Self::Image(ImageError::Cancelled)
    }
}
