//! [`RenderedImage`]: a picture in memory.

use crate::illuminance::Illuminances;
use airlight::scene::SunAngles;
use airlight::spectrum::RgbSpace;
use airlight_image::Frame;
use airlight_image::tone::ToneMapper;
use std::time::Duration;

/// A picture in memory.
#[derive(Clone, Debug)]
pub struct RenderedImage {
    /// Projection and size.
    pub frame: Frame,
    /// RGB space of the pixels.
    pub space: RgbSpace,
    /// Linear red, green and blue, cd/m^2, row by row.
    pub rgb: Vec<[f32; 3]>,
    /// Position of the sun.
    pub sun: SunAngles,
    /// Illuminances at the eye.
    pub light: Illuminances,
    /// Tone mapper to display values.
    pub tone: ToneMapper,
    /// Time to solve and draw.
    pub time: Duration,
}

impl RenderedImage {
    /// Display values, three bytes for each pixel, row by row.
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
