//! [`RenderError`]: why something could not be drawn.

use crate::objects::file::ObjectsError;
use airlight::Cancelled;
use airlight::scene::SceneError;
use airlight_image::ImageError;

/// Why something could not be drawn.
#[derive(Debug, thiserror::Error)]
#[non_exhaustive]
pub enum RenderError {
    /// A file or a frame: it cannot be set up, read or written; or the caller asked to stop.
    #[error(transparent)]
    Image(#[from] ImageError),
    /// The light of the scene cannot be computed.
    #[error(transparent)]
    Scene(#[from] SceneError),
    /// The text of an objects file describes no objects.
    #[error(transparent)]
    Objects(#[from] ObjectsError),
    /// A value or a combination of values that cannot be drawn; the sentence says what would be right.
    #[error("{0}")]
    Setting(String),
}

impl RenderError {
    /// A value of a scene that cannot be drawn: its key, what would be right, what was given, what to try instead.
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

    /// A value or a combination of values that cannot be drawn; the sentence says what would be right.
    pub fn setting(sentence: impl Into<String>) -> Self {
        Self::Setting(sentence.into())
    }

    /// Whether what was requested is refused, so that the same request fails again; otherwise a file or the system failed.
    pub fn is_refusal(&self) -> bool {
        match self {
            Self::Image(error) => matches!(
                error,
                ImageError::Size { .. }
                    | ImageError::Setting { .. }
                    | ImageError::UnknownFormat { .. }
            ),
            _ => true,
        }
    }

    /// True where the caller asked to stop.
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
