//! Rows of an overlay for an output of another kind than its picture: light of a display as linear light, and the reverse.

use super::Overlay;
use airlight_image::RowSource;
use airlight_image::input::{LightReference, Picture};
use airlight_image::output::PictureFormat;
use glam::{Mat3, Vec3};

/// Rows of an overlay, converted for the conventions of a format.
#[derive(Debug)]
pub(super) struct OutputRows<'a> {
    overlay: &'a Overlay<'a>,
    to_srgb: Option<Mat3>,
    opacity: Opacity,
}

/// What becomes of colours that have opacity.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
enum Opacity {
    None,
    /// They are multiplied by it, as in linear files.
    Multiply,
    /// They are divided by it, as in display files.
    Divide,
}

impl<'a> OutputRows<'a> {
    /// The rows of an overlay of a picture; `None` where they need no conversion.
    pub fn new(overlay: &'a Overlay<'a>, picture: &Picture, format: PictureFormat) -> Option<Self> {
        let has_opacity = picture.alpha.is_some();
        let is_scene = picture.reference == LightReference::Scene;
        if is_scene == format.is_linear() {
            return None;
        }
        Some(Self {
            overlay,
            to_srgb: match is_scene {
                true => picture.to_linear_srgb().map(|matrix| matrix.as_mat3()),
                false => None,
            },
            opacity: match (has_opacity, is_scene) {
                (false, _) => Opacity::None,
                (true, true) => Opacity::Divide,
                (true, false) => Opacity::Multiply,
            },
        })
    }
}

impl RowSource for OutputRows<'_> {
    fn channels(&self) -> usize {
        self.overlay.channels()
    }

    fn fill_row(&self, y: u32, out: &mut [f32]) {
        self.overlay.fill_row(y, out);
        for pixel in out.chunks_exact_mut(self.channels()) {
            let opacity = pixel.last().copied().unwrap_or(1.0);
            let factor = match self.opacity {
                Opacity::None => 1.0,
                Opacity::Multiply => opacity,
                Opacity::Divide if opacity > 0.0 => 1.0 / opacity,
                Opacity::Divide => 0.0,
            };
            let mut colour = Vec3::new(pixel[0], pixel[1], pixel[2]) * factor;
            if let Some(matrix) = self.to_srgb {
                colour = matrix * colour;
            }
            pixel[..3].copy_from_slice(&colour.to_array());
        }
    }
}
