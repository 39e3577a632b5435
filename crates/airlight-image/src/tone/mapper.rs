//! Tone mapping of rows, from linear light to display bytes.

use super::{
    agx::{Agx, AgxSettings},
    blocks::{LevelTable, OctaveTable, Planes, into_gamut, max, min},
    camera::{Camera, CameraSettings},
    dither::RowDither,
    scotopic,
    white_balance::WhiteBalance,
};
use crate::ImageError;
use airlight::spectrum::rgb::{srgb_decode, srgb_encode};

/// Curve from exposed light to display light.
#[derive(Clone, Copy, Debug, PartialEq)]
#[non_exhaustive]
pub enum ToneCurve {
    /// Camera curve: contrast, highlights that roll off to white, hue kept.
    Camera(CameraSettings),
    /// AgX: highlights roll off, bright saturated colours turn white early.
    Agx(AgxSettings),
    /// Linear: each component is clipped at 0 and 1.
    Clip,
}

impl Default for ToneCurve {
    fn default() -> Self {
        Self::Camera(CameraSettings::default())
    }
}

/// Exposure, tone curve, sRGB encoding and dither for rows of linear sRGB.
///
/// Any input is valid: NaN counts as 0, infinity as very bright, and colours with negative components move towards grey of the
/// same luminance until they are in the gamut.
#[derive(Clone, Debug)]
pub struct ToneMapper {
    exposure: f32,
    dither: bool,
    scotopic: bool,
    white_balance: Option<WhiteBalance>,
    curve: Curve,
    encode: OctaveTable,
    levels: LevelTable,
}

/// A tone curve, tabulated.
#[derive(Clone, Debug)]
enum Curve {
    Camera(Camera),
    Agx(Agx),
    Clip,
}

/// Pixels processed together, for vector instructions.
const BLOCK: usize = 64;

/// End of the linear part of sRGB, which is not tabulated.
const LINEAR_END: f32 = 0.003_130_8;

/// Limit of exposed values: far above white, far below overflow.
const MAX_EXPOSED: f32 = 1e12;

impl ToneMapper {
    /// A mapper with an exposure factor and a tone curve; 8-bit output is dithered.
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
            scotopic: false,
            white_balance: None,
            curve: match curve {
                ToneCurve::Camera(settings) => Curve::Camera(Camera::new(settings)?),
                ToneCurve::Agx(settings) => Curve::Agx(Agx::new(settings)?),
                ToneCurve::Clip => Curve::Clip,
            },
            encode: OctaveTable::new(LINEAR_END, 1.0, srgb_encode),
            levels: LevelTable::new(srgb_decode),
        })
    }

    /// A mapper for display light relative to white: clipped at 0 and 1, encoded as sRGB and rounded without dither. A picture
    /// read from an sRGB file of 8 or 16 bits is reproduced exactly.
    pub fn as_displayed() -> Self {
        Self {
            exposure: 1.0,
            dither: false,
            scotopic: false,
            white_balance: None,
            curve: Curve::Clip,
            encode: OctaveTable::new(LINEAR_END, 1.0, srgb_encode),
            levels: LevelTable::new(srgb_decode),
        }
    }

    /// The same with dither of 8-bit output on or off.
    pub fn with_dither(self, dither: bool) -> Self {
        Self { dither, ..self }
    }

    /// The same with light of a colour temperature neutral; `None` leaves colours as they are, under which daylight (D65) is.
    pub fn with_white_balance(self, white_balance: Option<WhiteBalance>) -> Self {
        Self {
            white_balance,
            ..self
        }
    }

    /// The same with or without night vision: dark colours, in cd/m^2, as rods see them. See the book, "Pictures".
    pub fn with_scotopic(self, scotopic: bool) -> Self {
        Self { scotopic, ..self }
    }

    /// Factor for linear values.
    pub fn exposure(&self) -> f32 {
        self.exposure
    }

    /// Encoded sRGB colour, each component in `[0, 1]`, of a linear colour. Error below 2e-6.
    pub fn map(&self, linear: [f32; 3]) -> [f32; 3] {
        let mut planes = linear.map(|v| [v]);
        self.map_planes(&mut planes);
        planes.map(|[v]| v)
    }

    /// Converts row `y` of interleaved linear RGB to 8-bit sRGB. The dither depends only on `y` and the column.
    pub fn row_to_u8(&self, y: u32, linear: &[f32], out: &mut [u8]) {
        if self.is_plain() && !self.dither {
            for (to, value) in out.iter_mut().zip(linear) {
                *to = self.levels.at(*value * self.exposure);
            }
            return;
        }
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
                    // Black and white stay unchanged, and no noise exceeds them.
                    let room = min(min(level, 255.0 - level), 1.0);
                    *value = level + noise * room + 0.5;
                }
            }
            for (i, to) in to.as_chunks_mut::<3>().0.iter_mut().enumerate() {
                *to = [planes[0][i] as u8, planes[1][i] as u8, planes[2][i] as u8];
            }
        }
    }

    /// Converts interleaved linear RGB to 16-bit sRGB.
    pub fn row_to_u16(&self, linear: &[f32], out: &mut [u16]) {
        for (from, to) in linear.chunks(BLOCK * 3).zip(out.chunks_mut(BLOCK * 3)) {
            let planes = self.encoded(from);
            for (i, to) in to.as_chunks_mut::<3>().0.iter_mut().enumerate() {
                let level = |c: usize| (planes[c][i] * 65535.0 + 0.5) as u16;
                *to = [level(0), level(1), level(2)];
            }
        }
    }

    /// Whether components are only exposed, clipped and encoded, each on its own.
    fn is_plain(&self) -> bool {
        matches!(self.curve, Curve::Clip) && !self.scotopic && self.white_balance.is_none()
    }

    /// Encoded colours of at most one block of interleaved pixels.
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
        if self.scotopic {
            scotopic::apply(planes);
        }
        if let Some(balance) = &self.white_balance {
            balance.apply(planes);
        }
        for v in planes.as_flattened_mut() {
            let exposed = *v * self.exposure;
            let exposed = if exposed.is_nan() { 0.0 } else { exposed };
            *v = max(min(exposed, MAX_EXPOSED), -MAX_EXPOSED);
        }
        match &self.curve {
            Curve::Camera(camera) => {
                into_gamut(planes);
                camera.apply(planes);
            }
            Curve::Agx(agx) => {
                into_gamut(planes);
                agx.apply(planes);
            }
            Curve::Clip => {
                for v in planes.as_flattened_mut() {
                    *v = max(min(*v, 1.0), 0.0);
                }
            }
        }
        for v in planes.as_flattened_mut() {
            let curved = self.encode.at(*v);
            *v = if *v <= LINEAR_END { 12.92 * *v } else { curved };
        }
    }
}
