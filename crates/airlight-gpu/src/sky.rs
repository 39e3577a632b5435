//! The tables of a sky on the device.

use crate::gpu_tables::{self, FLAT, SOLID};
use airlight::sky::View;
use airlight_shaders::twins::colour::RgbWeights;
use airlight_shaders::twins::texture::Texture;
use airlight_shaders::{SkyTables, WAVELENGTHS_NM};
use glam::Vec4;

/// Texels of the table of the sun's disc.
const DISC_TEXELS: usize = 64;

/// Layout of the tables.
pub fn layout(device: &wgpu::Device) -> wgpu::BindGroupLayout {
    gpu_tables::layout(device, &[FLAT, FLAT, SOLID, SOLID, FLAT, FLAT, FLAT])
}

/// Uploads the tables of a view.
pub fn upload(
    device: (&wgpu::Device, &wgpu::Queue),
    layout: &wgpu::BindGroupLayout,
    tables: &SkyTables,
    view: &View,
) -> wgpu::BindGroup {
    let textures = [
        &tables.sky_smooth,
        &tables.sky_haze,
        &tables.aerial_smooth,
        &tables.aerial_haze,
        &tables.extinction,
        &tables.phase,
        &disc(view),
    ];
    gpu_tables::group(device, layout, &numbers(tables, view), &textures)
}

/// The numbers of the shader's struct `Sky`.
fn numbers(tables: &SkyTables, view: &View) -> Vec<f32> {
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
    let half_sine = (0.5 * view.disc().angular_radius_rad).sin();
    all.extend([(2.0 * half_sine * half_sine) as f32, 0.0, 0.0, 0.0]);
    all
}

/// Radiance of the sun's disc outside the air, W m^-2 sr^-1 nm^-1, by the cosine at the sun's surface, 0 at the limb.
fn disc(view: &View) -> Texture {
    let solar = view.solar_irradiance();
    let disc = view.disc();
    let texels = (0..DISC_TEXELS).map(|k| {
        let mu = k as f64 / (DISC_TEXELS - 1) as f64;
        // The edge itself is outside the disc.
        let angle = disc.angular_radius_rad * (1.0 - mu * mu).sqrt().min(1.0 - 1e-9);
        Vec4::from_array(std::array::from_fn(|lane| {
            let relative = disc.radiance_per_irradiance(angle, WAVELENGTHS_NM[lane]);
            solar[lane] * relative as f32
        }))
    });
    Texture::new([DISC_TEXELS, 1, 1], texels.collect())
}
