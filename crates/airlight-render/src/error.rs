//! [`RenderError`]: why something could not be drawn.

use crate::objects::file::ObjectsError;
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
        matches!(self, Self::Image(error) if error.is_cancelled())
    }
}
