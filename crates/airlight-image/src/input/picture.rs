//! Pictures: linear red, green and blue from OpenEXR, Radiance HDR, PNG and JPEG files.

use super::{
    exr, exr_names,
    fault::Fault,
    hdr, jpeg, png,
    source::{Kind, Source, with_source},
};
use crate::{ImageError, Size, output::Chromaticities};
use std::path::Path;

/// The formats that pictures are read from, as errors name them.
const KNOWN: &str = "OpenEXR, Radiance HDR, PNG, JPEG";

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

/// Reads a picture.
///
/// `layer` names a layer of an EXR file: channels `LAYER.R`, `LAYER.G`, `LAYER.B` (and `LAYER.A`), or the part of that
/// name. Without it, plain `R`, `G`, `B` are taken, else those of the only layer that has them. A layer that has only a
/// luminance `Y` gives grey. The picture is as large as the display window; where the data window leaves it uncovered, it
/// is black.
///
/// Of PNG files, all colour types and depths are read; their colours are decoded as sRGB, or by a `gAMA` chunk where that
/// says otherwise and nothing says sRGB. Turning by EXIF is not applied.
///
/// # Errors
/// [`ImageError::File`] where the system refuses, [`ImageError::EndsEarly`] for empty and truncated files,
/// [`ImageError::NoChannel`] where the layer has no colours, and [`ImageError::Read`] for anything else: an unknown
/// format, corrupt contents, CMYK, more than 65536 pixels a side or 2^30 in all.
pub fn read_picture(path: &Path, layer: Option<&str>) -> Result<Picture, ImageError> {
    with_source(path, KNOWN, |source| decode(source, layer))
}

fn decode(source: Source, layer: Option<&str>) -> Result<Picture, Fault> {
    if let Some(layer) = layer
        && source.kind != Kind::Exr
    {
        return Err(Fault::Bad(format!(
            "layer `{layer}` was asked for, but only EXR files have layers"
        )));
    }
    match source.kind {
        Kind::Exr => from_exr(source, layer),
        Kind::Hdr => hdr::read(source),
        Kind::Png => png::read(source),
        Kind::Jpeg => jpeg::read(source),
        Kind::Npy | Kind::Pfm => Err(Fault::Bad(format!(
            "it is a file of numbers (NPY or PFM), not a picture ({KNOWN})"
        ))),
    }
}

fn from_exr(source: Source, layer: Option<&str>) -> Result<Picture, Fault> {
    let file = exr::ExrFile::open(source)?;
    let pick = exr_names::colours(file.headers(), layer)?;
    let bits = file.bits(pick.part, &pick.rgb);
    let chromaticities = file.chromaticities(pick.part);
    let white_luminance_cd_m2 = file.white_luminance_cd_m2(pick.part);
    let mut groups: Vec<&[usize]> = vec![&pick.rgb];
    groups.extend(pick.alpha.as_ref().map(std::slice::from_ref));
    let loaded = file.load(pick.part, &groups, |group, samples| match group {
        0 => mend_colours(samples),
        _ => mend_opacity(samples),
    })?;
    let mut buffers = loaded.groups.into_iter();
    Ok(Picture {
        size: loaded.size,
        rgb: buffers.next().unwrap_or_default(),
        alpha: buffers.next(),
        reference: LightReference::Scene,
        bits,
        chromaticities,
        white_luminance_cd_m2,
        profile_ignored: false,
        repaired_samples: loaded.mended,
    })
}

/// The largest finite half.
const BRIGHTEST: f32 = 65504.0;

/// Mends colours; the number of those that needed it.
pub(super) fn mend_colours(samples: &mut [f32]) -> u64 {
    mend(samples, BRIGHTEST)
}

fn mend_opacity(samples: &mut [f32]) -> u64 {
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
