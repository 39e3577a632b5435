//! Textures of the twins.

use glam::{Vec2, Vec3, Vec4};
use half::f16;

/// The sampler of the twins: linear, clamped to the edge.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub struct LinearSampler;

/// A texture of two or three dimensions with four channels.
#[derive(Clone, Debug, PartialEq)]
pub struct Texture {
    size: [usize; 3],
    texels: Vec<Vec4>,
}

/// A texture of two dimensions.
pub type Texture2d = Texture;

/// A texture of three dimensions.
pub type Texture3d = Texture;

impl Texture {
    /// A texture of the size in x, y and z (1 for two dimensions), from its texels with x varying fastest.
    ///
    /// # Panics
    /// Where the number of texels is another.
    pub fn new(size: [usize; 3], texels: Vec<Vec4>) -> Self {
        let count: usize = size.iter().product();
        assert_eq!(texels.len(), count, "texels of a texture of {size:?}");
        Self { size, texels }
    }

    /// Number of texels in x, y and z.
    pub fn size(&self) -> [usize; 3] {
        self.size
    }

    /// The texels, with x varying fastest.
    pub fn texels(&self) -> &[Vec4] {
        &self.texels
    }

    /// The texels as half floats in the byte order of the machine, for upload; larger values become the largest.
    pub fn half_float_bytes(&self) -> Vec<u8> {
        let largest = f16::MAX.to_f32();
        let values = self.texels.iter().flat_map(|texel| texel.to_array());
        let halves = values.map(|value| f16::from_f32(value.clamp(-largest, largest)));
        halves.flat_map(f16::to_ne_bytes).collect()
    }

    /// Interpolated texels at coordinates from 0 to 1.
    pub fn sample(&self, _: LinearSampler, uv: Vec2) -> Vec4 {
        self.sample_3d(LinearSampler, uv.extend(0.5))
    }

    /// Interpolated texels at coordinates from 0 to 1.
    pub fn sample_3d(&self, _: LinearSampler, uvw: Vec3) -> Vec4 {
        let axes: [([usize; 2], f32); 3] = std::array::from_fn(|axis| {
            let last = self.size[axis] - 1;
            let place = (uvw[axis] * self.size[axis] as f32 - 0.5).clamp(0.0, last as f32);
            let below = (place as usize).min(last);
            ([below, (below + 1).min(last)], place - below as f32)
        });
        let [(x, fx), (y, fy), (z, fz)] = axes;
        let at = |i: usize, j: usize, k: usize| {
            self.texels[(z[k] * self.size[1] + y[j]) * self.size[0] + x[i]]
        };
        let row = |j: usize, k: usize| at(0, j, k).lerp(at(1, j, k), fx);
        let slice = |k: usize| row(0, k).lerp(row(1, k), fy);
        slice(0).lerp(slice(1), fz)
    }
}
