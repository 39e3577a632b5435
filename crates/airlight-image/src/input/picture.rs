//! Pictures in memory: linear red, green and blue.

use super::{ExrLayer, Orientation};
use crate::{
    ImageError, Notes, Size,
    output::{Carried, Chromaticities},
};
use airlight::spectrum::rgb::srgb_decode;
use glam::DMat3;
use rayon::prelude::*;
use std::sync::{Arc, LazyLock};

/// Meaning of a value of 1.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash)]
pub enum LightReference {
    /// Light in the scene, in the unit of the file: OpenEXR, HDR and floats of TIFF.
    Scene,
    /// Light from a display, relative to its white: PNG, JPEG and integers of TIFF.
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
    /// Linear red, green and blue of each pixel, row by row from the upper left; finite.
    pub rgb: Vec<f32>,
    /// Opacity of each pixel in `[0, 1]`, where the file has it. By the conventions of the formats, colours of light in
    /// the scene are premultiplied by it, those of a display are not.
    pub alpha: Option<Vec<f32>>,
    /// Meaning of a value of 1.
    pub reference: LightReference,
    /// Sample format of the colours in the file.
    pub bits: SampleBits,
    /// Primaries and white of the colours, where a file of light in the scene states them; sRGB otherwise. Display colours are
    /// converted to sRGB.
    pub chromaticities: Option<Chromaticities>,
    /// Luminance of a value of 1, cd/m^2, where an EXR file (`whiteLuminance`) or an HDR file of this program states it.
    pub white_luminance_cd_m2: Option<f32>,
    /// Width of a pixel over its height.
    pub pixel_aspect: f32,
    /// Layer of an EXR file from which the colours were read.
    pub layer: Option<ExrLayer>,
    /// What an EXR file holds besides the colours and their opacity.
    pub carried: Option<Arc<Carried>>,
    /// How the picture lay in the file; it is turned upright.
    pub orientation: Orientation,
    /// What was converted, repaired or passed over.
    pub notes: Notes,
}

impl Picture {
    /// An opaque picture in linear sRGB about which nothing else is known.
    pub fn new(size: Size, rgb: Vec<f32>, reference: LightReference, bits: SampleBits) -> Self {
        Self {
            size,
            rgb,
            alpha: None,
            reference,
            bits,
            chromaticities: None,
            white_luminance_cd_m2: None,
            pixel_aspect: 1.0,
            layer: None,
            carried: None,
            orientation: Orientation::UPRIGHT,
            notes: Notes::default(),
        }
    }

    /// An opaque picture from sRGB values of 8 bits, as they are in PNG and JPEG files: red, green and blue, row by row.
    ///
    /// # Errors
    /// [`ImageError::Setting`] if there are not three values for each pixel.
    pub fn from_srgb_u8(size: Size, values: &[u8]) -> Result<Self, ImageError> {
        let linear = |value: &u8| SRGB_8[usize::from(*value)];
        Self::from_values(size, values.par_iter().map(linear), SampleBits::U8)
    }

    /// An opaque picture from sRGB values of 16 bits: red, green and blue, row by row.
    ///
    /// # Errors
    /// As [`Self::from_srgb_u8`].
    pub fn from_srgb_u16(size: Size, values: &[u16]) -> Result<Self, ImageError> {
        let linear = |value: &u16| SRGB_16[usize::from(*value)];
        Self::from_values(size, values.par_iter().map(linear), SampleBits::U16)
    }

    /// An opaque picture from linear light in sRGB primaries, in any unit, repaired as that of a file is.
    ///
    /// # Errors
    /// As [`Self::from_srgb_u8`].
    pub fn from_linear(size: Size, values: &[f32]) -> Result<Self, ImageError> {
        let mut picture = Self::from_values(size, values.par_iter().copied(), SampleBits::Float)?;
        picture.reference = LightReference::Scene;
        let repaired = repair_colours(&mut picture.rgb);
        picture.notes.count(repaired, REPAIRED);
        Ok(picture)
    }

    fn from_values(
        size: Size,
        linear: impl IndexedParallelIterator<Item = f32>,
        bits: SampleBits,
    ) -> Result<Self, ImageError> {
        let samples = 3 * size.width() as usize * size.height() as usize;
        ImageError::require(
            linear.len() == samples,
            "the number of colours",
            linear.len() as f64,
            "three for each pixel",
        )?;
        let rgb = linear.collect();
        Ok(Self::new(size, rgb, LightReference::Display, bits))
    }

    /// Matrix from the colours to linear sRGB, white to white; `None` where they are sRGB.
    pub fn to_linear_srgb(&self) -> Option<DMat3> {
        let stated = self.chromaticities.filter(|stated| !stated.are_srgb())?;
        stated.to_linear_srgb()
    }

    /// Turns a picture upright that lies in its file by an orientation.
    pub(super) fn turned(mut self, orientation: Orientation) -> Self {
        if orientation != Orientation::UPRIGHT {
            self.rgb = orientation.apply(self.size, 3, self.rgb);
            self.alpha = self
                .alpha
                .map(|alpha| orientation.apply(self.size, 1, alpha));
            self.size = orientation.turned(self.size);
            if orientation.swaps_sides() {
                self.pixel_aspect = 1.0 / self.pixel_aspect;
            }
            self.orientation = orientation;
            self.notes.add(format!(
                "turned upright (EXIF orientation {})",
                orientation.exif()
            ));
        }
        self
    }

    /// Width of a pixel over its height, if that is within reason.
    pub(super) fn checked_aspect(aspect: f32) -> f32 {
        match (1e-3..=1e3).contains(&aspect) {
            true => aspect,
            false => 1.0,
        }
    }

    /// Notes the name of the colour space from which display colours were converted.
    pub(super) fn note_conversion(&mut self, from: Option<&str>) {
        if let Some(from) = from {
            let text = format!("colours converted from {from} to sRGB");
            self.notes.add(text);
        }
    }
}

/// Largest finite half-precision number.
const MAX_HALF: f32 = 65504.0;

/// Note about samples changed by [`repair_colours`] and [`repair_opacity`].
pub(super) const REPAIRED: &str = "NaN or infinite samples repaired";

/// Repairs colours in place: NaN becomes 0, infinity the largest half-precision number of its sign. Negative colours, outside
/// the gamut of their primaries, are kept. Returns the number of repaired samples.
pub(super) fn repair_colours(samples: &mut [f32]) -> u64 {
    repair(samples, f32::NEG_INFINITY, |v| match v.is_nan() {
        true => 0.0,
        false => v.clamp(-MAX_HALF, MAX_HALF),
    })
}

/// Repairs opacities in place, to numbers from 0 to 1; returns the number of repaired samples.
pub(super) fn repair_opacity(samples: &mut [f32]) -> u64 {
    repair(samples, -f32::MIN_POSITIVE, |v| match v > 0.0 {
        true => 1.0,
        false => 0.0,
    })
}

/// Replaces samples that are not above `least` and finite; returns their number.
fn repair(samples: &mut [f32], least: f32, replacement: impl Fn(f32) -> f32) -> u64 {
    let mut repaired = 0;
    // In blocks whose count fits 32 bits, so that the loop is vectorised.
    for block in samples.chunks_mut(4096) {
        let mut count = 0u32;
        for v in block {
            let valid = *v > least && *v < f32::INFINITY;
            count += u32::from(!valid);
            *v = if valid { *v } else { replacement(*v) };
        }
        repaired += u64::from(count);
    }
    repaired
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
