//! Settings of the picture formats.

use super::Metadata;

/// Settings of every format, of which [`write_picture`] uses those that apply.
#[derive(Clone, Debug, Default)]
pub struct PictureOptions {
    /// For OpenEXR.
    pub exr: ExrOptions,
    /// For PNG.
    pub png: PngOptions,
    /// For JPEG.
    pub jpeg: JpegOptions,
    /// For all.
    pub metadata: Metadata,
}

/// How samples are stored.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Hash)]
pub enum ExrSample {
    /// 16 bits: about 3 digits, up to 65504; brighter samples are brought to that and counted.
    #[default]
    Half,
    /// 32 bits; infinite samples stay infinite.
    Float,
}

/// How samples are packed. None of these loses anything.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Hash)]
pub enum ExrCompression {
    /// Not at all.
    None,
    /// Run lengths: fast, large.
    Rle,
    /// Zip over single lines.
    ZipLine,
    /// Zip over 16 lines; over single lines where those would take more than 16 MiB.
    #[default]
    Zip,
    /// Wavelets over 32 lines: small for grainy pictures; zip over single lines where they would take more than 16 MiB.
    Piz,
}

/// Settings of EXR files.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Hash)]
pub struct ExrOptions {
    /// How samples are stored.
    pub sample: ExrSample,
    /// How samples are packed.
    pub compression: ExrCompression,
}

/// Bits of a component.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Hash)]
pub enum PngDepth {
    /// 8 bits, dithered unless the tone mapper says otherwise.
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
    /// Effort of compression: 0 stores, 1 is fastest, 9 smallest; from 3 up little is gained.
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
    /// 1 (smallest) to 100 (best). From 90 up colour is kept at full resolution, below at half.
    pub quality: u8,
}

impl Default for JpegOptions {
    fn default() -> Self {
        Self { quality: 92 }
    }
}
