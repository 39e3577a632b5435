//! The tables of a sky on the device.

use crate::frame_tables::FrameTables;
use crate::gpu_tables::{self, FLAT, SOLID};
use airlight_shaders::twins::colour::RgbWeights;

/// Layout of the tables.
pub fn layout(device: &wgpu::Device) -> wgpu::BindGroupLayout {
    gpu_tables::layout(device, &[FLAT, FLAT, SOLID, SOLID, FLAT, FLAT, FLAT])
}

/// Uploads the tables of a frame.
pub fn upload(
    device: (&wgpu::Device, &wgpu::Queue),
    layout: &wgpu::BindGroupLayout,
    frame: &FrameTables,
) -> wgpu::BindGroup {
    let tables = &frame.sky;
    let textures = [
        &tables.sky_smooth,
        &tables.sky_haze,
        &tables.aerial_smooth,
        &tables.aerial_haze,
        &tables.extinction,
        &tables.phase,
        &frame.disc,
    ];
    gpu_tables::group(device, layout, &numbers(frame), &textures)
}

/// The numbers of the shader's struct `Sky`.
fn numbers(frame: &FrameTables) -> Vec<f32> {
    let tables = &frame.sky;
    let mut all = tables.view.sun.to_array().to_vec();
    all.extend([
        tables.view.height_m,
        tables.view.ground_radius_m,
        tables.view.air_height_m,
        tables.view.horizon_rad,
        tables.view.highest_rad,
    ]);
    all.extend(tables.scales.smooth_light.to_array());
    all.extend(tables.scales.haze.to_array());
    let mut add = |weights: &RgbWeights| {
        for channel in [weights.red, weights.green, weights.blue] {
            all.extend(channel.to_array());
        }
    };
    add(&tables.radiance_weights);
    add(&tables.transmittance_weights);
    add(&tables.disc_weights);
    all.extend([frame.disc_one_minus_cos, 0.0, 0.0, 0.0]);
    all
}
