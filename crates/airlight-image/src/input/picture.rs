//! Pictures in memory: linear red, green and blue.

use crate::{Size, output::Chromaticities};
use airlight::spectrum::rgb::srgb_decode;
use std::sync::LazyLock;

/// Meaning of a value of 1.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash)]
pub enum LightReference {
    /// Light in the scene, in the unit of the file: OpenEXR and HDR.
    Scene,
    /// Light from a display, relative to its white: PNG and JPEG.
    Display,
}

/// Sample format of a file.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash)]
#[non_exhaustive]
pub enum SampleBits {
    /// Integers of 8 bits or fewer.
    U8,
    /// 16-bit integers.
    U16,
    /// Integers of 32 bits or more.
    U32,
    /// 16-bit floating point.
    Half,
    /// Floating point of 32 bits or more; also Radiance HDR, for its range.
    Float,
}

/// A picture in memory.
#[derive(Clone, Debug, PartialEq)]
pub struct Picture {
    /// Width and height in pixels.
    pub size: Size,
    /// Linear red, green and blue of each pixel, row by row from the upper left; finite and not negative.
    pub rgb: Vec<f32>,
    /// Opacity of each pixel in `[0, 1]`, where the file has it. By the conventions of the formats, colours of an EXR file
    /// are premultiplied by it, those of a PNG file are not.
    pub alpha: Option<Vec<f32>>,
    /// Meaning of a value of 1.
    pub reference: LightReference,
    /// Sample format of the colours in the file.
    pub bits: SampleBits,
    /// Primaries and white of the colours, where the file states them; sRGB otherwise.
    pub chromaticities: Option<Chromaticities>,
    /// Luminance of a value of 1, cd/m^2, where an EXR file states it (`whiteLuminance`).
    pub white_luminance_cd_m2: Option<f32>,
    /// The file has an ICC colour profile that does not name itself sRGB. It is not applied: the colours are read as sRGB.
    pub profile_ignored: bool,
    /// Number of repaired samples: NaN and negative ones became 0, infinite ones 65504 (1 in opacity).
    pub repaired_samples: u64,
}

/// Largest finite half-precision number.
const MAX_HALF: f32 = 65504.0;

/// Repairs colours in place; returns the number of repaired samples.
pub(super) fn repair_colours(samples: &mut [f32]) -> u64 {
    repair(samples, MAX_HALF)
}

/// Repairs opacities in place; returns the number of repaired samples.
pub(super) fn repair_opacity(samples: &mut [f32]) -> u64 {
    repair(samples, 1.0)
}

fn repair(samples: &mut [f32], for_infinity: f32) -> u64 {
    let mut repaired = 0;
    // In blocks whose count fits 32 bits, so that the loop is vectorised.
    for block in samples.chunks_mut(4096) {
        let mut count = 0u32;
        for v in block {
            let valid = *v >= 0.0 && *v < f32::INFINITY;
            count += u32::from(!valid);
            let replacement = if *v > 0.0 { for_infinity } else { 0.0 };
            *v = if valid { *v } else { replacement };
        }
        repaired += u64::from(count);
    }
    repaired
}

/// True for an ICC profile that does not name itself sRGB.
pub(super) fn is_foreign_profile(profile: &[u8]) -> bool {
    // Names are ASCII in old profiles, UTF-16 in new ones.
    let letters: Vec<u8> = profile.iter().copied().filter(|&b| b != 0).collect();
    !letters.windows(4).any(|four| four == b"sRGB")
}

/// Linear light of every 8-bit sRGB value.
pub(super) static SRGB_8: LazyLock<Vec<f32>> = LazyLock::new(|| decoding_table(256, srgb_decode));
/// Linear light of every 16-bit sRGB value.
pub(super) static SRGB_16: LazyLock<Vec<f32>> =
    LazyLock::new(|| decoding_table(65_536, srgb_decode));

/// Linear light of `count` encoded values that cover `[0, 1]` evenly.
pub(super) fn decoding_table(count: u32, decode: impl Fn(f64) -> f64) -> Vec<f32> {
    let scale = 1.0 / f64::from(count - 1);
    (0..count)
        .map(|n| decode(f64::from(n) * scale) as f32)
        .collect()
}
