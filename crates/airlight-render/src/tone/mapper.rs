//! Whole rows from linear light to display bytes.

use super::{
    dither::RowDither,
    filmic::{Filmic, FilmicSettings, without_negatives},
    srgb,
    table::OctaveTable,
};
use crate::RenderError;

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

/// Below this sRGB is a straight line, and so is not tabulated.
const STRAIGHT: f32 = 0.003_130_8;

/// Exposed values beyond this are cut off: far above white, far below overflow.
const BRIGHTEST: f32 = 1e12;

impl ToneMapper {
    /// Multiplies by `exposure`, applies `curve`; 8-bit output is dithered.
    ///
    /// # Errors
    /// [`RenderError::Setting`] where `exposure` is negative or not finite, or a setting of the curve out of range.
    pub fn new(exposure: f32, curve: ToneCurve) -> Result<Self, RenderError> {
        if !(exposure.is_finite() && exposure >= 0.0) {
            return Err(RenderError::Setting {
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

    /// The same, with dither of 8-bit output on or off.
    pub fn with_dither(self, dither: bool) -> Self {
        Self { dither, ..self }
    }

    /// The factor by which linear values are multiplied.
    pub fn exposure(&self) -> f32 {
        self.exposure
    }

    /// The encoded sRGB colour, each component in `[0, 1]`, of a linear colour. Within 2e-6 of the formulas.
    #[inline(always)]
    pub fn map(&self, linear: [f32; 3]) -> [f32; 3] {
        let exposed = linear.map(|v| {
            let v = v * self.exposure;
            let v = if v.is_nan() { 0.0 } else { v };
            v.clamp(-BRIGHTEST, BRIGHTEST)
        });
        let shown = match &self.filmic {
            Some(filmic) => filmic.apply(without_negatives(exposed)),
            None => exposed.map(|v| v.clamp(0.0, 1.0)),
        };
        shown.map(|v| {
            if v <= STRAIGHT {
                12.92 * v
            } else {
                self.encode.at(v)
            }
        })
    }

    /// Row `y` of interleaved linear RGB as 8-bit sRGB; the dither depends on `y` and the column alone.
    pub fn row_to_u8(&self, y: u32, linear: &[f32], out: &mut [u8]) {
        let mut dither = RowDither::new(y);
        for (from, to) in linear
            .as_chunks::<3>()
            .0
            .iter()
            .zip(out.as_chunks_mut::<3>().0)
        {
            let encoded = self.map(*from);
            let noise = if self.dither {
                dither.next_pixel()
            } else {
                [0.0; 3]
            };
            for c in 0..3 {
                let level = encoded[c] * 255.0;
                // Full black and full white stay what they are, and no noise reaches beyond them.
                let room = level.min(255.0 - level).min(1.0);
                to[c] = (level + noise[c] * room + 0.5) as u8;
            }
        }
    }

    /// Interleaved linear RGB as 16-bit sRGB.
    pub fn row_to_u16(&self, linear: &[f32], out: &mut [u16]) {
        for (from, to) in linear
            .as_chunks::<3>()
            .0
            .iter()
            .zip(out.as_chunks_mut::<3>().0)
        {
            *to = self.map(*from).map(|v| (v * 65535.0 + 0.5) as u16);
        }
    }
}
