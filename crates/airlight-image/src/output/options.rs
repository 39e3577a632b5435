//! Settings of the picture formats.

use super::Metadata;
pub use airlight::scene::{ExrCompression, SamplePrecision};

/// Settings of all formats; [`write_picture`](super::write_picture) uses those that apply.
#[derive(Clone, Debug, Default)]
pub struct PictureOptions {
    /// Settings of OpenEXR.
    pub exr: ExrOptions,
    /// Settings of PNG.
    pub png: PngOptions,
    /// Settings of JPEG.
    pub jpeg: JpegOptions,
    /// Metadata, for all formats.
    pub metadata: Metadata,
}

/// Settings of EXR files.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Hash)]
pub struct ExrOptions {
    /// Sample format.
    pub precision: SamplePrecision,
    /// Compression method.
    pub compression: ExrCompression,
}

/// Bits of a component of a PNG file.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Hash)]
pub enum PngDepth {
    /// 8 bits, dithered unless the tone mapper disables it.
    #[default]
    Eight,
    /// 16 bits.
    Sixteen,
}

/// Settings of PNG files.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct PngOptions {
    /// Bits of a component.
    pub depth: PngDepth,
    /// Compression level: 0 (none), 1 (fastest: repetitions of a byte only) to 9 (smallest); above 3 files shrink little. At 1, photographs
    /// and noise are about as small as at 3, drawings larger. On web pages all levels are 1.
    pub compression_level: u8,
}

impl PngDepth {
    /// Bytes of a component.
    pub(super) fn bytes(self) -> usize {
        match self {
            Self::Eight => 1,
            Self::Sixteen => 2,
        }
    }
}

impl Default for PngOptions {
    fn default() -> Self {
        Self {
            depth: PngDepth::Eight,
            compression_level: 3,
        }
    }
}

/// Settings of JPEG files.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct JpegOptions {
    /// 1 (smallest) to 100 (best). Below 90, colour has half the resolution.
    pub quality: u8,
}

impl Default for JpegOptions {
    fn default() -> Self {
        Self { quality: 92 }
    }
}
