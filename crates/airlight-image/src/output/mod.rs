//! Picture files: OpenEXR (RGB and spectral), Radiance HDR, PNG, JPEG; [`PictureFormat`] lists them.
//!
//! Writers compute rows in parallel in bands, hold few bands in memory, check for cancellation, and write a temporary file that
//! replaces the target when it is complete.

mod atomic;
mod bands;
mod carried;
mod deflate;
pub mod exr;
mod exr_join;
mod format;
pub mod hdr;
pub mod jpeg;
mod metadata;
mod options;
pub mod png;
mod run_huffman;
pub mod spectral;

pub use atomic::AtomicFile;
pub use carried::Carried;
pub use format::Written;
pub use metadata::{Chromaticities, Metadata, RowBand};
pub use options::PictureOptions;

use crate::{Control, ImageError, RowSource, Size, tone::ToneMapper};
use format::{FormatEntry, Rgb};
use std::path::Path;

/// A picture format with a writer.
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
    /// All formats.
    pub const ALL: [Self; 4] = [Self::EXR, Self::HDR, Self::PNG, Self::JPEG];

    /// The format of a file ending, in any case.
    ///
    /// # Errors
    /// [`ImageError::UnknownFormat`], which lists the known endings.
    pub fn from_path(path: &Path) -> Result<Self, ImageError> {
        let ending = path.extension().map(|e| e.to_string_lossy().into_owned());
        let lower = ending.as_deref().unwrap_or("").to_ascii_lowercase();
        Self::ALL
            .into_iter()
            .find(|format| format.endings().contains(&lower.as_str()))
            .ok_or_else(|| ImageError::UnknownFormat {
                path: path.to_owned(),
                ending: match ending {
                    Some(ending) => format!("its ending is `.{ending}`"),
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

    /// Name, such as "OpenEXR".
    pub fn name(self) -> &'static str {
        self.0.name
    }

    /// Name with the relevant settings, such as "float EXR".
    pub fn describe(self, options: &PictureOptions) -> String {
        (self.0.describe)(options)
    }

    /// Endings of file names, the usual one first.
    pub fn endings(self) -> &'static [&'static str] {
        self.0.endings
    }

    /// Whether the format stores linear light, without tone mapping.
    pub fn is_linear(self) -> bool {
        self.0.is_linear
    }

    /// Whether the format stores opacity.
    pub fn holds_alpha(self) -> bool {
        self.0.holds_alpha
    }

    /// Whether the format stores any number of named channels: spectra, depth, layers.
    pub fn holds_channels(self) -> bool {
        self.0.holds_channels
    }

    /// What the writer does to the samples counted in [`Written::clamped_samples`], as a predicate: "lay below 0, ...".
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

impl std::fmt::Display for PictureFormat {
    fn fmt(&self, f: &mut std::fmt::Formatter<'_>) -> std::fmt::Result {
        f.pad(self.0.name)
    }
}

/// Writes linear RGB rows in the format of the ending of `path`. PNG and JPEG are tone mapped by `tone`; EXR and HDR stay
/// linear.
///
/// # Errors
/// [`ImageError`]; `path` is then unchanged.
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
