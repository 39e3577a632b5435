//! Pictures in memory.

use crate::{Size, output::Chromaticities};

/// What a value of 1 stands for.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash)]
pub enum LightReference {
    /// Light in the scene, in the unit of the file: OpenEXR and HDR.
    Scene,
    /// Light from a display, of which 1 is its white: PNG and JPEG.
    Display,
}

/// How a file stores each sample.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash)]
pub enum SampleBits {
    /// Whole numbers of 8 bits or fewer.
    U8,
    /// Whole numbers of 16 bits.
    U16,
    /// Whole numbers of 32 bits or more.
    U32,
    /// Floating point, 16 bits.
    Half,
    /// Floating point, 32 bits or more. Radiance HDR counts as such for its range.
    Float,
}

/// A picture in memory.
#[derive(Clone, Debug, PartialEq)]
pub struct Picture {
    /// Width and height in pixels.
    pub size: Size,
    /// Linear red, green and blue of each pixel, row by row from the upper left; finite and not negative.
    pub rgb: Vec<f32>,
    /// Opacity of each pixel in `[0, 1]`, where the file holds it. By the custom of the formats, colours of an EXR file
    /// are already multiplied by it, those of a PNG file are not.
    pub alpha: Option<Vec<f32>>,
    /// What a value of 1 stands for.
    pub reference: LightReference,
    /// How the file stores its colours.
    pub bits: SampleBits,
    /// Primaries and white of the colours, where the file states them; else take sRGB's.
    pub chromaticities: Option<Chromaticities>,
    /// Luminance of a value of 1, cd/m^2, where an EXR file states it (`whiteLuminance`).
    pub white_luminance_cd_m2: Option<f32>,
    /// The file holds a colour profile (ICC) that does not call itself sRGB. It was not applied: the colours were taken
    /// for sRGB.
    pub profile_ignored: bool,
    /// Samples that were mended: not-a-number and negative ones became 0, infinite ones 65504 (1 in opacity).
    pub repaired_samples: u64,
}

/// The largest finite half.
const BRIGHTEST: f32 = 65504.0;

/// Mends colours; the number of those that needed it.
pub(super) fn mend_colours(samples: &mut [f32]) -> u64 {
    mend(samples, BRIGHTEST)
}

pub(super) fn mend_opacity(samples: &mut [f32]) -> u64 {
    mend(samples, 1.0)
}

fn mend(samples: &mut [f32], for_infinity: f32) -> u64 {
    // Blocks whose count fits 32 bits, so that the compiler makes vector code of this.
    let mut mended = 0;
    for block in samples.chunks_mut(4096) {
        let mut count = 0u32;
        for v in block {
            let fine = *v >= 0.0 && *v < f32::INFINITY;
            count += u32::from(!fine);
            let other = if *v > 0.0 { for_infinity } else { 0.0 };
            *v = if fine { *v } else { other };
        }
        mended += u64::from(count);
    }
    mended
}

/// True for a colour profile that does not call itself sRGB.
pub(super) fn is_foreign(profile: &[u8]) -> bool {
    // Names are plain letters in old profiles, two bytes a letter in new ones.
    let letters: Vec<u8> = profile.iter().copied().filter(|&b| b != 0).collect();
    !letters.windows(4).any(|four| four == b"sRGB")
}
