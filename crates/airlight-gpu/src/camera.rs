//! [`Camera`].

use glam::Mat4;

/// Place of the factor of the sun's disc among the numbers.
const DISC: usize = 18;

/// Where the pixels of a frame look.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Camera {
    /// From clip space to the world around the eye: the inverse of projection times rotation. World axes: y up at the eye, the unit
    /// is the metre.
    pub world_from_clip: Mat4,
    /// What luminances in cd/m^2 are multiplied by before they reach the target, which a half float holds up to 65504.
    pub exposure: f32,
    /// Depth of a pixel without geometry: 0 with reversed depth, otherwise 1.
    pub far_depth: f32,
}

impl Camera {
    /// The numbers of the shader's struct `Camera`.
    pub(crate) fn numbers(&self) -> Vec<f32> {
        let mut numbers = self.world_from_clip.to_cols_array().to_vec();
        numbers.extend([self.exposure, self.far_depth, 1.0, 0.0]);
        numbers
    }

    /// The same for a frame without the sun's disc.
    pub(crate) fn numbers_without_disc(&self) -> Vec<f32> {
        let mut numbers = self.numbers();
        numbers[DISC] = 0.0;
        numbers
    }
}
