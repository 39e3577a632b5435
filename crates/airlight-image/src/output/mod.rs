//! Picture files: OpenEXR (RGB and spectral), Radiance HDR, PNG, JPEG.
//!
//! Every writer computes rows in parallel in bands, holds few bands at a time, polls for cancellation, and writes
//! beside its target: the target appears whole or not at all.

mod atomic;
mod bands;
mod deflate;
pub mod exr;
mod exr_header;
mod exr_stream;
pub mod hdr;
pub mod jpeg;
mod metadata;
pub mod png;
mod png_filter;
pub mod spectral;

pub use atomic::AtomicFile;
pub use metadata::{Chromaticities, Metadata};

use crate::{Control, ImageError, RowSource, Size, tone::ToneMapper};
use std::{
    io::{BufWriter, Write},
    path::Path,
};

/// Formats a picture can be written in.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash)]
pub enum PictureFormat {
    /// OpenEXR: linear, half or single precision.
    Exr,
    /// Radiance RGBE: linear, 8 bits and a shared exponent.
    Hdr,
    /// PNG: sRGB, 8 or 16 bits.
    Png,
    /// JPEG: sRGB, 8 bits, lossy.
    Jpeg,
}

impl PictureFormat {
    const ENDINGS: [(&'static str, Self); 6] = [
        ("exr", Self::Exr),
        ("hdr", Self::Hdr),
        ("pic", Self::Hdr),
        ("png", Self::Png),
        ("jpg", Self::Jpeg),
        ("jpeg", Self::Jpeg),
    ];

    /// The format that a file's ending names, in large or small letters.
    ///
    /// # Errors
    /// [`ImageError::UnknownFormat`], which lists the endings known.
    pub fn from_path(path: &Path) -> Result<Self, ImageError> {
        let ending = path.extension().map(|e| e.to_string_lossy().into_owned());
        let lower = ending.as_deref().unwrap_or("").to_ascii_lowercase();
        Self::ENDINGS
            .iter()
            .find(|(known, _)| *known == lower)
            .map(|&(_, format)| format)
            .ok_or_else(|| ImageError::UnknownFormat {
                path: path.to_owned(),
                ending: match ending {
                    Some(ending) => format!("`.{ending}` is not one it knows"),
                    None => "it has no ending".to_owned(),
                },
                known: Self::ENDINGS
                    .iter()
                    .map(|(known, _)| format!(".{known}"))
                    .collect::<Vec<_>>()
                    .join(", "),
            })
    }

    /// True for formats that hold linear light and need no tone mapping.
    pub fn is_linear(self) -> bool {
        matches!(self, Self::Exr | Self::Hdr)
    }
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

/// Settings of every format, of which [`write_picture`] uses those that apply.
#[derive(Clone, Debug, Default)]
pub struct PictureOptions {
    /// For OpenEXR.
    pub exr: exr::ExrOptions,
    /// For PNG.
    pub png: png::PngOptions,
    /// For JPEG.
    pub jpeg: jpeg::JpegOptions,
    /// For all.
    pub metadata: Metadata,
}

/// Writes linear RGB rows in the format that the ending of `path` names; `tone` makes PNG and JPEG of them, EXR and HDR
/// take them as they are.
///
/// # Errors
/// [`ImageError`]; nothing is left at `path`, or what was there before.
pub fn write_picture(
    path: &Path,
    size: Size,
    source: &dyn RowSource,
    tone: &ToneMapper,
    options: &PictureOptions,
    control: Control<'_>,
) -> Result<Written, ImageError> {
    let metadata = &options.metadata;
    match PictureFormat::from_path(path)? {
        PictureFormat::Exr => exr::write(
            path,
            size,
            &["R", "G", "B"],
            source,
            &options.exr,
            metadata,
            control,
        ),
        PictureFormat::Hdr => hdr::write(path, size, source, metadata, control),
        PictureFormat::Png => png::write(path, size, source, tone, &options.png, metadata, control),
        PictureFormat::Jpeg => {
            jpeg::write(path, size, source, tone, &options.jpeg, metadata, control)
        }
    }
}

/// Runs an encoder into a file beside `path`, then moves it there.
fn into_file(
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
fn expect_channels(
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
