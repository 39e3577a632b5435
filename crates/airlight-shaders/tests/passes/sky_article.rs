//! [`Pass::SkyArticle`].

use crate::frame::{Drawn, both_forms};
use crate::vulkan;
use airlight::axes;
use airlight::models::single_scattering::{Settings, SkyArticle, Variant};
use airlight_shaders::Pass;
use airlight_shaders::twins::article::article_sky;
use airlight_shaders::twins::{colour::srgb_encode, dither::dithered, tone::camera_tone};
use glam::{Mat4, Vec2, Vec3, Vec4};

const SIZE: u32 = 64;
const ALTITUDE_M: f64 = 1500.0;
const SUN_DEG: f64 = 8.0;

/// North, from 4 to 64 degrees above the horizon.
fn direction_from_clip() -> Mat4 {
    let (sin, cos) = 34f32.to_radians().sin_cos();
    let tangent = 30f32.to_radians().tan();
    Mat4::from_cols(
        Vec4::new(tangent, 0.0, 0.0, 0.0),
        Vec4::new(0.0, tangent * cos, tangent * sin, 0.0),
        Vec4::new(0.0, sin, -cos, 0.0),
        Vec4::W,
    )
}

#[test]
fn the_pass_draws_the_sky_of_the_article() {
    let (_, device, queue) = vulkan::open();
    let sun = axes::direction(10.0, SUN_DEG);
    let exposure = 2e-5;
    let sky = article_sky(ALTITUDE_M as f32, 120_000.0);
    let mut numbers = direction_from_clip().to_cols_array().to_vec();
    let mut row = |vector: Vec3, last: f32| numbers.extend(vector.extend(last).to_array());
    row(sky.eye, sky.sun_radius_rad);
    row(sky.outer_space, sky.sun_solid_angle);
    row(sun.as_vec3(), exposure);
    let uniform: Vec<u8> = numbers.iter().flat_map(|x| x.to_ne_bytes()).collect();
    let settings = Settings {
        variant: Variant::PrintedF64,
        eye_altitude_m: ALTITUDE_M,
        ..Settings::default()
    };
    let exact = SkyArticle::new(&settings, sun).expect("a sky");
    let mut compared = 0;
    for source in both_forms(Pass::SkyArticle) {
        let drawn = Drawn::new((&device, &queue), source, "draw_sky", SIZE, &uniform, &[]);
        let frame = drawn.frame(device.create_command_encoder(&Default::default()));
        for (pixel, got) in frame.as_chunks::<4>().0.iter().enumerate() {
            let (column, row) = (pixel as u32 % SIZE, pixel as u32 / SIZE);
            let clip = Vec2::new(column as f32 + 0.5, row as f32 + 0.5) * 2.0 / SIZE as f32 - 1.0;
            let at = direction_from_clip() * Vec4::new(clip.x, -clip.y, 1.0, 1.0);
            let view = at.truncate().as_dvec3().normalize();
            if view.dot(sun) > 0.9999 {
                continue;
            }
            let light = exact.luminance(view).map(|v| v as f32 * exposure);
            let signal = srgb_encode(camera_tone(Vec3::from(light), 1.2, 1.0));
            let right = dithered(signal, 255.0, column, row);
            let apart = (Vec3::from_slice(got) - right).abs().max_element();
            // Half a level: the 0.2 % that f32 costs.
            assert!(apart < 0.5 / 255.0, "{column} {row}: {got:?}, not {right}");
            assert_eq!(got[3], 1.0);
            compared += 1;
        }
    }
    assert!(compared > 8000, "{compared}");
}
