//! Whole rows from linear light to display bytes.

use super::{
    dither::RowDither,
    filmic::{Filmic, FilmicSettings},
    planes::{Planes, greatest, least, without_negatives},
    srgb,
    table::OctaveTable,
};
use crate::ImageError;

/// How exposed light becomes display light.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum ToneCurve {
    /// The filmic curve: highlights roll off, bright saturated colours go to white.
    Filmic(FilmicSettings),
    /// None: each component is cut off at 0 and 1.
    Clip,
}

impl Default for ToneCurve {
    fn default() -> Self {
        Self::Filmic(FilmicSettings::default())
    }
}

/// Exposure, tone curve, sRGB encoding and dither, made ready for use on rows of linear sRGB from many threads.
///
/// Takes any input without panic: not-a-number counts as 0, infinite as very bright, and colours with negative
/// components are drawn to grey of their luminance until they lie in the gamut.
#[derive(Clone, Debug)]
pub struct ToneMapper {
    exposure: f32,
    dither: bool,
    filmic: Option<Filmic>,
    encode: OctaveTable,
}

/// Pixels worked on together, so that the compiler can use vector instructions.
const BLOCK: usize = 64;

/// Below this sRGB is a straight line, and so is not tabulated.
const STRAIGHT: f32 = 0.003_130_8;

/// Exposed values beyond this are cut off: far above white, far below overflow.
const BRIGHTEST: f32 = 1e12;

impl ToneMapper {
    /// Multiplies by `exposure`, applies `curve`; 8-bit output is dithered.
    ///
    /// # Errors
    /// [`ImageError::Setting`] where `exposure` is negative or not finite, or a setting of the curve out of range.
    pub fn new(exposure: f32, curve: ToneCurve) -> Result<Self, ImageError> {
        if !(exposure.is_finite() && exposure >= 0.0) {
            return Err(ImageError::Setting {
                what: "the exposure (a factor)",
                got: exposure.to_string(),
                right: "a finite number, 0 or above",
            });
        }
        Ok(Self {
            exposure,
            dither: true,
            filmic: match curve {
                ToneCurve::Filmic(settings) => Some(Filmic::new(settings)?),
                ToneCurve::Clip => None,
            },
            encode: OctaveTable::new(STRAIGHT, 1.0, srgb::encode),
        })
    }

    /// For light that a display is to show as it is, 1 being its white: cut off at 0 and 1, encoded as sRGB and rounded,
    /// without dither. A picture read from an sRGB file of 8 or 16 bits comes out bit for bit the same.
    pub fn as_displayed() -> Self {
        Self {
            exposure: 1.0,
            dither: false,
            filmic: None,
            encode: OctaveTable::new(STRAIGHT, 1.0, srgb::encode),
        }
    }

    /// The same, with dither of 8-bit output on or off.
    pub fn with_dither(self, dither: bool) -> Self {
        Self { dither, ..self }
    }

    /// The factor by which linear values are multiplied.
    pub fn exposure(&self) -> f32 {
        self.exposure
    }

    /// The encoded sRGB colour, each component in `[0, 1]`, of a linear colour. Within 2e-6 of the formulas.
    pub fn map(&self, linear: [f32; 3]) -> [f32; 3] {
        let mut planes = linear.map(|v| [v]);
        self.map_planes(&mut planes);
        planes.map(|[v]| v)
    }

    /// Row `y` of interleaved linear RGB as 8-bit sRGB; the dither depends on `y` and the column alone.
    pub fn row_to_u8(&self, y: u32, linear: &[f32], out: &mut [u8]) {
        let mut dither = RowDither::new(y);
        for (from, to) in linear.chunks(BLOCK * 3).zip(out.chunks_mut(BLOCK * 3)) {
            let mut planes = self.encoded(from);
            let noise: Planes<BLOCK> = if self.dither {
                dither.next_pixels()
            } else {
                [[0.0; BLOCK]; 3]
            };
            for (plane, noise) in planes.iter_mut().zip(&noise) {
                for (value, noise) in plane.iter_mut().zip(noise) {
                    let level = *value * 255.0;
                    // Full black and full white stay what they are, and no noise reaches beyond them.
                    let room = least(least(level, 255.0 - level), 1.0);
                    *value = level + noise * room + 0.5;
                }
            }
            for (i, to) in to.as_chunks_mut::<3>().0.iter_mut().enumerate() {
                *to = [planes[0][i] as u8, planes[1][i] as u8, planes[2][i] as u8];
            }
        }
    }

    /// Interleaved linear RGB as 16-bit sRGB.
    pub fn row_to_u16(&self, linear: &[f32], out: &mut [u16]) {
        for (from, to) in linear.chunks(BLOCK * 3).zip(out.chunks_mut(BLOCK * 3)) {
            let planes = self.encoded(from);
            for (i, to) in to.as_chunks_mut::<3>().0.iter_mut().enumerate() {
                let level = |c: usize| (planes[c][i] * 65535.0 + 0.5) as u16;
                *to = [level(0), level(1), level(2)];
            }
        }
    }

    /// The encoded colours of up to a block of interleaved pixels.
    fn encoded(&self, linear: &[f32]) -> Planes<BLOCK> {
        let mut planes = [[0.0; BLOCK]; 3];
        for (i, pixel) in linear.as_chunks::<3>().0.iter().enumerate().take(BLOCK) {
            for (plane, value) in planes.iter_mut().zip(pixel) {
                plane[i] = *value;
            }
        }
        self.map_planes(&mut planes);
        planes
    }

    #[inline(always)]
    fn map_planes<const N: usize>(&self, planes: &mut Planes<N>) {
        for v in planes.as_flattened_mut() {
            let exposed = *v * self.exposure;
            let exposed = if exposed.is_nan() { 0.0 } else { exposed };
            *v = greatest(least(exposed, BRIGHTEST), -BRIGHTEST);
        }
        match &self.filmic {
            Some(filmic) => {
                without_negatives(planes);
                filmic.apply(planes);
            }
            None => {
                for v in planes.as_flattened_mut() {
                    *v = greatest(least(*v, 1.0), 0.0);
                }
            }
        }
        for v in planes.as_flattened_mut() {
            let curved = self.encode.at(*v);
            *v = if *v <= STRAIGHT { 12.92 * *v } else { curved };
        }
    }
}
