//! Error type.

use airlight::Cancelled;
use std::{io, path::PathBuf};

/// Why a picture could not be set up, written or read.
#[derive(Debug, thiserror::Error)]
#[non_exhaustive]
pub enum ImageError {
    /// A width or height outside `1..=65536`.
    #[error("expected a picture of 1 to 65536 pixels a side, got {width} x {height}")]
    Size {
        /// Pixels in a row.
        width: u32,
        /// Rows.
        height: u32,
    },
    /// A setting out of range.
    #[error("{what} must be {right}, got {got}")]
    Setting {
        /// The setting, with its unit.
        what: &'static str,
        /// The given value.
        got: String,
        /// Valid values.
        right: &'static str,
    },
    /// A file ending of no known picture format.
    #[error("unknown picture format of `{path}`: {ending}. Known endings: {known}", path = .path.display())]
    UnknownFormat {
        /// The path.
        path: PathBuf,
        /// The ending, or that there is none.
        ending: String,
        /// Known endings.
        known: String,
    },
    /// The rows have the wrong number of channels for the format.
    #[error("expected rows of {expected} channels for {format}, got {got}")]
    Channels {
        /// The format or layout.
        format: &'static str,
        /// Channels of the format.
        expected: usize,
        /// Channels of the row source.
        got: usize,
    },
    /// The folder of a file to be written does not exist.
    #[error("cannot write `{path}`: there is no folder `{folder}`", path = .path.display(), folder = .folder.display())]
    NoFolder {
        /// The path.
        path: PathBuf,
        /// The missing folder.
        folder: PathBuf,
    },
    /// A path that cannot be written to.
    #[error("cannot write `{path}`: {reason}", path = .path.display())]
    Target {
        /// The path.
        path: PathBuf,
        /// The reason.
        reason: &'static str,
    },
    /// The operating system refused.
    #[error("cannot {action} `{path}`: {source}", path = .path.display())]
    File {
        /// The operation, as a verb.
        action: &'static str,
        /// The file.
        path: PathBuf,
        /// Error of the system.
        source: io::Error,
    },
    /// A stream without a name could not be written to.
    #[error("cannot write the {format} picture: {source}")]
    Stream {
        /// Format being written.
        format: &'static str,
        /// Error of the system.
        source: io::Error,
    },
    /// The encoder refused the picture.
    #[error("cannot encode the picture as {format}: {reason}")]
    Encode {
        /// Format being written.
        format: &'static str,
        /// Error of the encoder.
        reason: String,
    },
    /// The contents of a file are corrupt or of the wrong kind.
    #[error("cannot read `{path}`: {reason}", path = .path.display())]
    Read {
        /// The file.
        path: PathBuf,
        /// What is wrong.
        reason: String,
    },
    /// A file is shorter than its header states.
    #[error("`{path}` ends too early: {reason}", path = .path.display())]
    EndsEarly {
        /// The file.
        path: PathBuf,
        /// What is missing.
        reason: String,
    },
    /// A required channel is missing or ambiguous.
    #[error("`{path}` has no {wanted}. Its channels: {available}", path = .path.display())]
    NoChannel {
        /// The file.
        path: PathBuf,
        /// The required channel.
        wanted: String,
        /// Channels of the file, separated by commas.
        available: String,
    },
    /// Negative depth, which is more likely a wrong sign than unknown depth.
    #[error(
        "expected depth of 0 or more in `{path}`, got negative depth in {count} of its pixels, the first at x {x}, y {y}: {value}; \
         try 0 where the depth is unknown, or negative unknown",
        path = .path.display()
    )]
    NegativeDepth {
        /// The file.
        path: PathBuf,
        /// Number of negative pixels.
        count: u64,
        /// Column of the first, from 0.
        x: u32,
        /// Row of the first, from 0 at the top.
        y: u32,
        /// Its number in the file, before scaling.
        value: f32,
    },
    /// A depth map of another aspect ratio than its picture.
    #[error(
        "depth: expected the size or the aspect ratio of the picture, got {} x {} pixels for a picture of {} x {}{}; try a depth map of \
         {2} x {3}",
        .depth.0, .depth.1, .picture.0, .picture.1,
        match .exif_orientation {
            Some(value) => format!(" (after turning the picture upright by its EXIF orientation, {value})"),
            None => String::new(),
        }
    )]
    SizesDiffer {
        /// Width and height of the depth map.
        depth: (u32, u32),
        /// Width and height of the picture.
        picture: (u32, u32),
        /// EXIF orientation by which the picture was turned, if it was.
        exif_orientation: Option<u8>,
    },
    /// The caller cancelled; no file was written.
    #[error("cancelled; no file was left behind")]
    Cancelled,
}

impl From<Cancelled> for ImageError {
    fn from(_: Cancelled) -> Self {
        Self::Cancelled
    }
}

impl ImageError {
    /// [`ImageError::Setting`] where a setting is not valid.
    pub(crate) fn require(
        valid: bool,
        what: &'static str,
        got: f64,
        right: &'static str,
    ) -> Result<(), Self> {
        match valid {
            true => Ok(()),
            false => Err(Self::Setting {
                what,
                got: got.to_string(),
                right,
            }),
        }
    }

    /// Adds the name of the file to an error of a stream.
    pub fn at(self, path: &std::path::Path) -> Self {
        match self {
            Self::Stream { source, .. } => Self::File {
                action: "write",
                path: path.to_owned(),
                source,
            },
            other => other,
        }
    }

    /// True where the caller cancelled.
    pub fn is_cancelled(&self) -> bool {
        matches!(self, Self::Cancelled)
    }
}
