//! Draws a misty valley between sun and moon, and the moon in its phase:
//! `cargo run --release -p airlight-gpu --example moonlight -- OUT.png [SUN_DEG [MOON_DEG]]`.

mod picture;

use airlight::{atmosphere::Preset, axes, glam::Vec3, night::MoonState};
use airlight_gpu::headless::{FORMAT, Frame, Geometry, Headless};
use airlight_gpu::{Fog, SkyRenderer, SkyRendererSettings};
use std::{error::Error, f32::consts::PI};

const HEIGHT_M: f64 = 300.0;

fn main() -> Result<(), Box<dyn Error>> {
    let arguments: Vec<String> = std::env::args().skip(1).collect();
    let output = arguments.first().ok_or("expected OUT.png")?;
    let angle = |k: usize, default: f64| arguments.get(k).map_or(Ok(default), |text| text.parse());
    let sun = axes::direction(300.0, angle(1, -14.0)?);
    let moon = MoonState::lit_by(axes::direction(135.0, angle(2, 14.0)?), sun);
    let program = Headless::new()?;
    let settings = SkyRendererSettings::new(FORMAT);
    let air = Preset::Average.atmosphere();
    let mut sky = SkyRenderer::new(&program.device, &program.queue, &air, &settings)?;
    sky.set_fog(Some(Fog::new(2000.0, 60.0)))?;
    // The brighter source first.
    sky.set_second_source(Some(sun.into()))?;
    sky.update(HEIGHT_M, moon)?;

    let light = sky.lighting().ok_or("expected light after an update")?;
    let level = light.sky_illuminance_lx(Vec3::Y) + light.sun_illuminance_lx * light.sun.y.max(0.0);
    let exposure = 0.6 / level.y;
    let colour = (level * exposure * Vec3::new(0.05, 0.07, 0.03) / PI).as_dvec3();
    let frame = Frame::towards(axes::direction(135.0, 8.0).as_vec3(), 640);
    let distance_m = |x: u32, y: u32| {
        let d = frame.direction(x, y);
        let azimuth = d.z.atan2(d.x);
        let ridges = [(2e3, 120.0, 5.0), (6e3, 350.0, 8.0), (2.5e4, 1100.0, 11.0)];
        let covers = |&(distance_m, height_m, waves): &(f32, f32, f32)| {
            let wave = 1.0 + 0.3 * (azimuth * waves).sin() + 0.15 * (azimuth * 2.7 * waves).sin();
            HEIGHT_M as f32 + d.y * distance_m < height_m * wave
        };
        let ridge = ridges.into_iter().find(covers);
        ridge.map_or(f32::INFINITY, |(distance_m, ..)| distance_m)
    };
    let hills = Geometry {
        colour: colour.to_array(),
        distance_m: &distance_m,
    };
    let camera = frame.camera(exposure)?;
    let pixels = program.draw(&frame, Some(&hills), |encoder, target, depth| {
        sky.record(encoder, target, depth, &camera);
    })?;
    picture::write(output, &pixels, 2.0)
}
