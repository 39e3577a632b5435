//! [`Camera`].

use glam::Mat4;

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
        numbers.extend([self.exposure, self.far_depth, 0.0, 0.0]);
        numbers
    }
}
