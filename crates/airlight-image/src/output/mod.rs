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
mod format;
pub mod hdr;
pub mod jpeg;
mod metadata;
mod options;
pub mod png;
mod png_filter;
pub mod spectral;

pub use atomic::AtomicFile;
pub use format::Written;
pub use metadata::{Chromaticities, Metadata};
pub use options::PictureOptions;

use crate::{Control, ImageError, RowSource, Size, tone::ToneMapper};
use format::{FormatEntry, Rgb};
use std::path::Path;

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
