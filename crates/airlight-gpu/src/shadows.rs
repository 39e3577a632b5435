//! [`TerrainShadows`]: shadows of ground in air and fog.

use crate::gpu_tables::{self, FLAT};
use crate::terrain::Heights;
use airlight::glam::DVec3;

/// Shadows of the ground of a [`TerrainPass`](crate::TerrainPass) under one sun, for [`SkyPasses::record_shadowed`](crate::SkyPasses::record_shadowed): how far up they reach above
/// each place.
#[derive(Debug)]
pub struct TerrainShadows {
    group: wgpu::BindGroup,
}

impl TerrainShadows {
    /// Shadows by the height of their surface, for an eye at a place of the grid, m.
    pub(crate) fn new(
        device: &wgpu::Device,
        (heights, sampler): (&Heights, &wgpu::Sampler),
        surface: &wgpu::TextureView,
        (eye_m, planet_radius_m): (DVec3, f64),
    ) -> Self {
        let mut numbers = eye_m.as_vec3().to_array().to_vec();
        numbers.push(planet_radius_m as f32);
        numbers.extend(heights.extent_m);
        numbers.extend([heights.highest_m, 0.0]);
        let views = std::slice::from_ref(surface);
        Self {
            group: gpu_tables::bind(device, &layout(device), &numbers, sampler, views),
        }
    }

    pub(crate) fn group(&self) -> &wgpu::BindGroup {
        &self.group
    }
}

/// Layout of the group of shadows.
pub fn layout(device: &wgpu::Device) -> wgpu::BindGroupLayout {
    gpu_tables::layout(device, &[FLAT])
}

/// The pass of shadows in air, behind the passes of the sky.
pub fn in_air(sky_shader: String) -> String {
    sky_shader + SHADOW + "
fn once_to(direction: vec3<f32>, distance_m: f32) -> vec3<f32> {
    return rgb_from_spectrum(sky.radiance_weights, air_to(Pixel(direction, distance_m)).path_radiance);
}
"
}

/// The pass of shadows in fog, behind the passes of the fog.
pub fn in_fog(fog_shader: String) -> String {
    fog_shader
        + SHADOW
        + "
fn once_to(direction: vec3<f32>, distance_m: f32) -> vec3<f32> {
    return fog_to(Pixel(direction, distance_m)).path_radiance;
}
"
}

const SHADOW: &str = include_str!("shadow.wgsl");
