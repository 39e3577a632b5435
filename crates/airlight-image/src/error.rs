//! What can go wrong, in sentences that say what, where, and what would be right.

use airlight::Cancelled;
use std::{io, path::PathBuf};

/// Why a picture could not be set up, written or read.
#[derive(Debug, thiserror::Error)]
pub enum ImageError {
    /// A width or height outside `1..=65536`.
    #[error("a picture must be 1 to 65536 pixels wide and high: {width} x {height} was asked for")]
    Size {
        /// Pixels in a row.
        width: u32,
        /// Rows.
        height: u32,
    },
    /// A setting that makes no sense.
    #[error("{what} must be {right}: got {got}")]
    Setting {
        /// Which setting, with its unit.
        what: &'static str,
        /// What was given.
        got: String,
        /// What would be right.
        right: &'static str,
    },
    /// A file ending that names no known picture format.
    #[error("cannot tell the picture format of `{path}`: {ending}. Known endings: {known}", path = .path.display())]
    UnknownFormat {
        /// The file asked for.
        path: PathBuf,
        /// What its ending is, or that there is none.
        ending: String,
        /// The endings that are known.
        known: String,
    },
    /// The rows have the wrong number of channels for the format.
    #[error("{format} needs rows of {expected} channels: these have {got}")]
    Channels {
        /// The format or layout.
        format: &'static str,
        /// Channels it holds.
        expected: usize,
        /// Channels of the row source.
        got: usize,
    },
    /// The folder a file should go to is not there.
    #[error("cannot write `{path}`: there is no folder `{folder}`", path = .path.display(), folder = .folder.display())]
    NoFolder {
        /// The file asked for.
        path: PathBuf,
        /// The missing folder.
        folder: PathBuf,
    },
    /// The name given for a file cannot be one.
    #[error("cannot write `{path}`: {reason}", path = .path.display())]
    Target {
        /// The file asked for.
        path: PathBuf,
        /// Why not.
        reason: &'static str,
    },
    /// The operating system refused.
    #[error("cannot {action} `{path}`: {source}", path = .path.display())]
    File {
        /// What was tried, as a verb.
        action: &'static str,
        /// On which file.
        path: PathBuf,
        /// What the system said.
        source: io::Error,
    },
    /// Bytes could not be written to a stream that is not a file with a name.
    #[error("cannot write the {format} picture: {source}")]
    Stream {
        /// The format being written.
        format: &'static str,
        /// What the system said.
        source: io::Error,
    },
    /// The encoder refused the picture.
    #[error("cannot encode the picture as {format}: {reason}")]
    Encode {
        /// The format being written.
        format: &'static str,
        /// What the encoder said.
        reason: String,
    },
    /// What a file holds cannot be read, or is not what it should be.
    #[error("cannot read `{path}`: {reason}", path = .path.display())]
    Read {
        /// The file.
        path: PathBuf,
        /// What is wrong with it.
        reason: String,
    },
    /// A file breaks off before all is there that its beginning promises.
    #[error("`{path}` ends too early: {reason}", path = .path.display())]
    EndsEarly {
        /// The file.
        path: PathBuf,
        /// What is missing.
        reason: String,
    },
    /// A file lacks a channel that is needed, or has several that could be meant.
    #[error("`{path}` has no {wanted}. Its channels: {there}", path = .path.display())]
    NoChannel {
        /// The file.
        path: PathBuf,
        /// What was looked for.
        wanted: String,
        /// The channels that are there, with commas between them.
        there: String,
    },
    /// Depth below 0, where a mistake of sign is likelier than a hole.
    #[error(
        "`{path}` has negative depth in {count} of its pixels, the first at x {x}, y {y}: {value}. Depth must grow away from \
         the camera; where negative numbers mean that nothing is known, 0 should stand",
        path = .path.display()
    )]
    NegativeDepth {
        /// The file.
        path: PathBuf,
        /// How many pixels.
        count: u64,
        /// Column of the first, from 0.
        x: u32,
        /// Row of the first, from 0 at the top.
        y: u32,
        /// What the file says there, before any scale.
        value: f32,
    },
    /// A depth map that is not as large as its picture.
    #[error(
        "the depth map is {} x {} pixels, the picture {} x {}: both must be the same",
        .depth.0, .depth.1, .picture.0, .picture.1
    )]
    SizesDiffer {
        /// Width and height of the depth map.
        depth: (u32, u32),
        /// Width and height of the picture.
        picture: (u32, u32),
    },
    /// The caller cancelled; nothing was left behind.
    #[error("cancelled; no file was left behind")]
    Cancelled,
}

impl From<Cancelled> for ImageError {
    fn from(_: Cancelled) -> Self {
        Self::Cancelled
    }
}

impl ImageError {
    /// The same error with the name of the file, where it lacked one.
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
