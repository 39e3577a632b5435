//! What a picture format is, and what its writers share.

use super::atomic::AtomicFile;
use super::options::PictureOptions;
use crate::{Control, ImageError, RowSource, Size, tone::ToneMapper};
use std::{
    io::{BufWriter, Write},
    path::Path,
};

/// What a format is and how it is written: one in the file of each writer, all of them listed in [`PictureFormat::ALL`].
pub(super) struct FormatEntry {
    pub(super) name: &'static str,
    /// Endings of file names in small letters, the usual one first.
    pub(super) endings: &'static [&'static str],
    /// Linear light, without tone mapping.
    pub(super) is_linear: bool,
    pub(super) holds_alpha: bool,
    /// Channels of any number and name besides red, green and blue.
    pub(super) holds_channels: bool,
    /// What the writer did to samples that the format cannot hold; empty where there are none such.
    pub(super) clamping: &'static str,
    /// The name with the settings that matter.
    pub(super) describe: fn(&PictureOptions) -> String,
    /// Writes rows of red, green and blue.
    pub(super) write:
        fn(&Path, &Rgb<'_>, &PictureOptions, Control<'_>) -> Result<Written, ImageError>,
}

/// Rows of linear red, green and blue, and what makes display values of them.
pub(super) struct Rgb<'a> {
    pub(super) size: Size,
    pub(super) source: &'a dyn RowSource,
    pub(super) tone: &'a ToneMapper,
}

/// What a writer reports of a file it finished.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub struct Written {
    /// Size of the file in bytes.
    pub bytes: u64,
    /// Samples beyond what the format holds, brought to its nearest value: for instance a sun's disc above 65504 in a
    /// half-precision EXR. Always 0 for PNG and JPEG, where the tone curve sees to it.
    pub clamped_samples: u64,
    /// Samples that were not a number, written as 0. Always 0 for PNG and JPEG.
    pub nan_samples: u64,
}

/// Runs an encoder into a file beside `path`, then moves it there.
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
