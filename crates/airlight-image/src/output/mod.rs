//! Picture files: OpenEXR (RGB and spectral), Radiance HDR, PNG, JPEG; [`PictureFormat`] lists them.
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

/// What a format is and how it is written: one in the file of each writer, all of them listed in [`PictureFormat::ALL`].
struct FormatEntry {
    name: &'static str,
    /// Endings of file names in small letters, the usual one first.
    endings: &'static [&'static str],
    /// Linear light, without tone mapping.
    is_linear: bool,
    holds_alpha: bool,
    /// Channels of any number and name besides red, green and blue.
    holds_channels: bool,
    /// What the writer did to samples that the format cannot hold; empty where there are none such.
    clamping: &'static str,
    /// The name with the settings that matter.
    describe: fn(&PictureOptions) -> String,
    /// Writes rows of red, green and blue.
    write: fn(&Path, &Rgb<'_>, &PictureOptions, Control<'_>) -> Result<Written, ImageError>,
}

/// Rows of linear red, green and blue, and what makes display values of them.
struct Rgb<'a> {
    size: Size,
    source: &'a dyn RowSource,
    tone: &'a ToneMapper,
}

/// A format that pictures can be written in.
#[derive(Clone, Copy)]
pub struct PictureFormat(&'static FormatEntry);

impl PictureFormat {
    /// OpenEXR: linear, half or single precision.
    pub const EXR: Self = Self(&exr::ENTRY);
    /// Radiance RGBE: linear, 8 bits and a shared exponent.
    pub const HDR: Self = Self(&hdr::ENTRY);
    /// PNG: sRGB, 8 or 16 bits.
    pub const PNG: Self = Self(&png::ENTRY);
    /// JPEG: sRGB, 8 bits, lossy.
    pub const JPEG: Self = Self(&jpeg::ENTRY);
    /// All of them.
    pub const ALL: [Self; 4] = [Self::EXR, Self::HDR, Self::PNG, Self::JPEG];

    /// The format that a file's ending names, in large or small letters.
    ///
    /// # Errors
    /// [`ImageError::UnknownFormat`], which lists the endings known.
    pub fn from_path(path: &Path) -> Result<Self, ImageError> {
        let ending = path.extension().map(|e| e.to_string_lossy().into_owned());
        let lower = ending.as_deref().unwrap_or("").to_ascii_lowercase();
        Self::ALL
            .into_iter()
            .find(|format| format.endings().contains(&lower.as_str()))
            .ok_or_else(|| ImageError::UnknownFormat {
                path: path.to_owned(),
                ending: match ending {
                    Some(ending) => format!("`.{ending}` is not one it knows"),
                    None => "it has no ending".to_owned(),
                },
                known: Self::ALL
                    .iter()
                    .flat_map(|format| format.endings())
                    .map(|known| format!(".{known}"))
                    .collect::<Vec<_>>()
                    .join(", "),
            })
    }

    /// Its name: "OpenEXR".
    pub fn name(self) -> &'static str {
        self.0.name
    }

    /// Its name with the settings that matter: "float EXR".
    pub fn describe(self, options: &PictureOptions) -> String {
        (self.0.describe)(options)
    }

    /// Endings of file names, the usual one first.
    pub fn endings(self) -> &'static [&'static str] {
        self.0.endings
    }

    /// Whether it holds linear light and needs no tone mapping.
    pub fn is_linear(self) -> bool {
        self.0.is_linear
    }

    /// Whether it holds opacity.
    pub fn holds_alpha(self) -> bool {
        self.0.holds_alpha
    }

    /// Whether it holds channels of any number and name: spectra, depth, layers.
    pub fn holds_channels(self) -> bool {
        self.0.holds_channels
    }

    /// What its writer did to the samples of [`Written::clamped_samples`], to follow their number.
    pub fn clamping(self) -> &'static str {
        self.0.clamping
    }
}

impl PartialEq for PictureFormat {
    fn eq(&self, other: &Self) -> bool {
        self.0.name == other.0.name
    }
}

impl Eq for PictureFormat {}

impl std::fmt::Debug for PictureFormat {
    fn fmt(&self, f: &mut std::fmt::Formatter<'_>) -> std::fmt::Result {
        f.write_str(self.0.name)
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
    let rgb = Rgb { size, source, tone };
    (PictureFormat::from_path(path)?.0.write)(path, &rgb, options, control)
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
