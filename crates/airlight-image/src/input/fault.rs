//! What a decoder complains of, before the name of the file is known.

use crate::{ImageError, Size};
use std::{io, path::Path};

/// Why the contents of a file cannot be read.
#[derive(Debug)]
pub(super) enum Fault {
    /// The system refused.
    Io(io::Error),
    /// The contents are wrong, or not of the kind needed.
    Bad(String),
    /// Bytes are missing at the end.
    Early(String),
    /// A channel is not there, or cannot be told from others.
    NoChannel { wanted: String, there: String },
}

impl Fault {
    pub(super) fn bad(reason: impl Into<String>) -> Self {
        Self::Bad(reason.into())
    }

    /// With the name of the file; `ended` where the decoder asked for more than the file holds.
    pub(super) fn at(self, path: &Path, ended: bool) -> ImageError {
        let path = path.to_owned();
        match self {
            Self::Io(error) if error.kind() == io::ErrorKind::UnexpectedEof => {
                ImageError::EndsEarly {
                    path,
                    reason: "bytes are missing".to_owned(),
                }
            }
            Self::Io(source) => ImageError::File {
                action: "read",
                path,
                source,
            },
            Self::Bad(reason) if ended => ImageError::EndsEarly { path, reason },
            Self::Bad(reason) => ImageError::Read { path, reason },
            Self::Early(reason) => ImageError::EndsEarly { path, reason },
            Self::NoChannel { wanted, there } => ImageError::NoChannel {
                path,
                wanted,
                there,
            },
        }
    }
}

impl From<io::Error> for Fault {
    fn from(error: io::Error) -> Self {
        Self::Io(error)
    }
}

/// The most pixels a picture may have.
const MOST_PIXELS: u64 = 1 << 30;

/// Refuses sizes that are empty or too large.
pub(super) fn checked_size(width: u64, height: u64) -> Result<Size, Fault> {
    let refused = || {
        Fault::Bad(format!(
            "it is {width} x {height} pixels, which must be 1 to {} a side and at most {MOST_PIXELS} in all",
            Size::MAX
        ))
    };
    let side = |n: u64| u32::try_from(n).map_err(|_| refused());
    let size = Size::new(side(width)?, side(height)?).map_err(|_| refused())?;
    if width.saturating_mul(height) > MOST_PIXELS {
        return Err(refused());
    }
    Ok(size)
}

/// Number of pixels, times `each`.
pub(super) fn samples(size: Size, each: usize) -> usize {
    size.width() as usize * size.height() as usize * each
}

/// An empty vector with room for `count` samples.
pub(super) fn room(count: usize) -> Result<Vec<f32>, Fault> {
    let mut samples = Vec::new();
    samples.try_reserve_exact(count).map_err(|_| {
        let megabytes = (count as u64 * 4) >> 20;
        Fault::Bad(format!(
            "there is no memory for its {megabytes} MiB of samples"
        ))
    })?;
    Ok(samples)
}

/// That many zeros, which take no memory before they are written to.
pub(super) fn zeros(count: usize) -> Result<Vec<f32>, Fault> {
    drop(room(count)?);
    Ok(vec![0.0; count])
}
