//! The tables of a sky on the device.

use crate::frame_tables::SourceTables;
use crate::gpu_tables::{self, FLAT, SOLID, Tables};
use airlight_shaders::twins::colour::RgbWeights;
use airlight_shaders::twins::sky_tables::SkyScales;

/// Layout of the tables.
pub fn layout(device: &wgpu::Device) -> wgpu::BindGroupLayout {
    gpu_tables::layout(device, &[FLAT, FLAT, SOLID, SOLID, FLAT, FLAT, FLAT])
}

/// Place of the smooth aerial perspective among the textures.
const AERIAL_SMOOTH: usize = 2;

/// Uploads the tables of a source: for all of its light in the air, and, with its table, for what the air scatters once.
pub fn upload(
    (device, queue): (&wgpu::Device, &wgpu::Queue),
    layout: &wgpu::BindGroupLayout,
    source: &SourceTables,
) -> (wgpu::BindGroup, Option<wgpu::BindGroup>) {
    let tables = &source.sky;
    let textures = [
        &tables.sky_smooth,
        &tables.sky_haze,
        &tables.aerial_smooth,
        &tables.aerial_haze,
        &tables.extinction,
        &tables.phase,
        &source.disc.texture(),
    ];
    let textures = Tables::new((device, queue), &textures);
    let numbers = |scales| numbers(source, scales);
    let all = textures.group(device, layout, &numbers(tables.scales));
    let once = source.single.as_ref().map(|single| {
        let smooth = gpu_tables::upload(device, queue, &single.smooth);
        let scales = SkyScales {
            smooth_light: single.scale,
            ..tables.scales
        };
        let textures = textures.with(AERIAL_SMOOTH, smooth);
        textures.group(device, layout, &numbers(scales))
    });
    (all, once)
}

/// The numbers of the shader's struct `Sky`.
fn numbers(source: &SourceTables, scales: SkyScales) -> Vec<f32> {
    let tables = &source.sky;
    let mut all = tables.view.sun.to_array().to_vec();
    all.extend([
        tables.view.height_m,
        tables.view.ground_radius_m,
        tables.view.air_height_m,
        tables.view.horizon_rad,
        tables.view.highest_rad,
        tables.view.kink_rad,
        tables.view.kink_place,
        tables.view.dense_share,
        tables.view.dense_azimuth,
        tables.view.dense_width,
        tables.view.even_below,
        tables.view.jump_height_m,
        tables.view.jump_place,
        tables.view.jump_part,
        0.0,
        0.0,
        0.0,
    ]);
    all.extend(tables.view.extinction_above.to_array());
    all.extend(tables.view.smooth_above.to_array());
    all.extend(tables.view.haze_above.to_array());
    all.extend(scales.smooth_light.to_array());
    all.extend(scales.haze.to_array());
    let mut add = |weights: &RgbWeights| {
        for channel in [weights.red, weights.green, weights.blue] {
            all.extend(channel.to_array());
        }
    };
    add(&tables.radiance_weights);
    add(&tables.transmittance_weights);
    add(&tables.disc_weights);
    all.extend(source.disc.numbers());
    all
}
