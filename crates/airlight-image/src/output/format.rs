//! Registry entry of a picture format, and functions that all writers share.

use super::atomic::AtomicFile;
use super::options::PictureOptions;
use crate::{Control, ImageError, RowSource, Size, tone::ToneMapper};
use std::{
    io::{BufWriter, Write},
    path::Path,
};

/// Registry entry of a format: one per writer, listed in [`super::PictureFormat::ALL`].
pub(super) struct FormatEntry {
    pub(super) name: &'static str,
    /// Endings of file names in lower case, the usual one first.
    pub(super) endings: &'static [&'static str],
    /// Linear light, without tone mapping.
    pub(super) is_linear: bool,
    pub(super) holds_alpha: bool,
    /// Any number of named channels besides red, green and blue.
    pub(super) holds_channels: bool,
    /// What the writer does to samples that the format cannot represent; empty where it represents all.
    pub(super) clamping: &'static str,
    /// Name with the relevant settings.
    pub(super) describe: fn(&PictureOptions) -> String,
    /// Writes linear RGB rows.
    pub(super) write:
        fn(&Path, &Rgb<'_>, &PictureOptions, Control<'_>) -> Result<Written, ImageError>,
}

/// Linear RGB rows and their tone mapping.
pub(super) struct Rgb<'a> {
    pub(super) size: Size,
    pub(super) source: &'a dyn RowSource,
    pub(super) tone: &'a ToneMapper,
}

/// Report on a written file.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
#[non_exhaustive]
pub struct Written {
    /// Size of the file in bytes.
    pub bytes: u64,
    /// Number of samples outside the range of the format, clamped to it: for instance a sun's disc above 65504 in a
    /// half-precision EXR. Always 0 for PNG and JPEG, whose range is that of the tone curve.
    pub clamped_samples: u64,
    /// Number of NaN samples, written as 0. Always 0 for PNG and JPEG.
    pub nan_samples: u64,
}

/// Encodes to a temporary file beside `path`, then moves it there.
pub(super) fn into_file(
    path: &Path,
    control: Control<'_>,
    encode: impl FnOnce(&mut BufWriter<&std::fs::File>) -> Result<Written, ImageError>,
) -> Result<Written, ImageError> {
    control.check()?;
    let file = AtomicFile::create(path)?;
    let mut buffered = BufWriter::with_capacity(1 << 20, file.file());
    let written = encode(&mut buffered).map_err(|e| e.at(path))?;
    let failed = |source| ImageError::File {
        action: "write",
        path: path.to_owned(),
        source,
    };
    buffered.flush().map_err(failed)?;
    drop(buffered);
    let bytes = file.file().metadata().map_err(failed)?.len();
    control.check()?;
    file.commit()?;
    Ok(Written { bytes, ..written })
}

/// Refuses a source with the wrong number of channels.
pub(super) fn expect_channels(
    format: &'static str,
    source: &dyn RowSource,
    expected: usize,
) -> Result<(), ImageError> {
    let got = source.channels();
    if got == expected {
        Ok(())
    } else {
        Err(ImageError::Channels {
            format,
            expected,
            got,
        })
    }
}
