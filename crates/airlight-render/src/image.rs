//! A picture in memory.

use crate::illuminance::Illuminances;
use airlight::scene::SunAngles;
use airlight::spectrum::RgbSpace;
use airlight_image::Frame;
use airlight_image::tone::ToneMapper;
use std::time::Duration;

/// A picture in memory.
#[derive(Clone, Debug)]
pub struct RenderedImage {
    /// Where its pixels look.
    pub frame: Frame,
    /// Their RGB space.
    pub space: RgbSpace,
    /// Linear, cd/m^2, row after row.
    pub rgb: Vec<[f32; 3]>,
    /// Position of the sun.
    pub sun: SunAngles,
    /// Illuminances at the eye.
    pub light: Illuminances,
    /// What makes display values of it.
    pub tone: ToneMapper,
    /// Time to solve and to draw.
    pub time: Duration,
}

impl RenderedImage {
    /// Display values, three bytes a pixel, row after row.
    pub fn displayed(&self, tone: &ToneMapper) -> Vec<u8> {
        let width = self.frame.size().width() as usize;
        let mut rgb = vec![0; 3 * self.rgb.len()];
        for ((y, row), out) in (0..)
            .zip(self.rgb.chunks_exact(width))
            .zip(rgb.chunks_exact_mut(3 * width))
        {
            tone.row_to_u8(y, row.as_flattened(), out);
        }
        rgb
    }
}
