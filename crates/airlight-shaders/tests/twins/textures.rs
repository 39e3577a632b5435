//! Textures that the functions are called with: smooth, with values that half floats hold exactly.

use airlight_shaders::twins::texture::Texture;
use airlight_shaders::twins::{fog_table, sky_tables};
use glam::Vec4;
use std::collections::HashMap;
use std::sync::LazyLock;

/// Names of all textures, as of `ComputeTexture::name`.
const NAMES: [&str; 9] = [
    "smooth_table_2d",
    "haze_table_2d",
    "phase_table_2d",
    "smooth_table_3d",
    "haze_table_3d",
    "extinction_table_2d",
    "diffuse_table_3d",
    "stream_table_3d",
    "stream_phase_table_2d",
];

static ALL: LazyLock<HashMap<&str, Texture>> = LazyLock::new(|| {
    let made = NAMES.iter().enumerate();
    made.map(|(seed, &name)| (name, wavy(size(name), seed as f32)))
        .collect()
});

/// The texture of a name.
pub fn named(name: &str) -> &'static Texture {
    &ALL[name]
}

fn size(name: &str) -> [usize; 3] {
    let sky_rows = sky_tables::SKY_ROWS_ABOVE + sky_tables::SKY_ROWS_BELOW;
    let rows = sky_tables::AERIAL_ROWS_ABOVE + sky_tables::AERIAL_ROWS_BELOW;
    match name {
        "smooth_table_2d" | "haze_table_2d" => [sky_tables::SKY_AZIMUTHS, sky_rows, 1.0],
        "phase_table_2d" => [sky_tables::PHASE_ANGLES, 1.0, 1.0],
        "extinction_table_2d" => [sky_tables::AERIAL_DISTANCES, rows, 1.0],
        "diffuse_table_3d" => [
            fog_table::FOG_AZIMUTHS,
            2.0 * fog_table::FOG_ROWS,
            2.0 * fog_table::FOG_DISTANCES,
        ],
        // Two layers, of two phase functions.
        "stream_table_3d" => [fog_table::FOG_DISTANCES, 2.0 * fog_table::FOG_ROWS, 12.0],
        "stream_phase_table_2d" => [sky_tables::PHASE_ANGLES, 6.0, 1.0],
        _ => [
            sky_tables::AERIAL_AZIMUTHS,
            rows,
            sky_tables::AERIAL_DISTANCES,
        ],
    }
    .map(|n| n as usize)
}

/// Values from 1/16 to 1 in steps of 1/1024, whose waves span dozens of texels.
fn wavy(size: [usize; 3], seed: f32) -> Texture {
    let mut texels = Vec::new();
    for z in 0..size[2] {
        for y in 0..size[1] {
            for x in 0..size[0] {
                let wave = |channel: f32| {
                    let phase = 0.05 * x as f32 + 0.07 * y as f32 + 0.09 * z as f32;
                    let value = 0.53125 + 0.46875 * (phase + seed + channel).sin();
                    (value * 1024.0).round() / 1024.0
                };
                texels.push(Vec4::new(wave(0.0), wave(1.0), wave(2.0), wave(3.0)));
            }
        }
    }
    Texture::new(size, texels)
}
