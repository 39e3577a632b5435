//! Adds sky, aerial perspective and fog to a wgpu program that draws hills, and writes its frame:
//! `cargo run --release -p airlight-gpu --example add_sky -- OUT.png`.

mod picture;

use airlight::{atmosphere::Preset, axes, glam::Vec3};
// The program: a device, and frames with a target and a depth.
use airlight_gpu::headless::{FORMAT, Frame, Geometry, Headless};
use airlight_gpu::{Fog, SkyRenderer, SkyRendererSettings};
use std::{error::Error, f32::consts::PI};

const EXPOSURE: f32 = 6e-5;

fn main() -> Result<(), Box<dyn Error>> {
    let output = std::env::args().nth(1).ok_or("expected OUT.png")?;
    let program = Headless::new()?;

    // Once: solves for the light in the air. The fog has a visibility of 3 km and thins by e in 60 m.
    let settings = SkyRendererSettings::new(FORMAT);
    let air = Preset::Average.atmosphere();
    let mut sky = SkyRenderer::new(&program.device, &program.queue, &air, &settings)?;
    sky.set_fog(Some(Fog::new(3000.0, 60.0)))?;

    // Each frame: fills tables only when the eye or the sun has moved, and lights the program's own surfaces.
    sky.update(150.0, axes::direction(150.0, 12.0))?;
    let light = sky.lighting().ok_or("expected light after an update")?;
    let slope = axes::direction(150.0, 45.0).as_vec3();
    let sunlit = light.sun_illuminance_lx * light.sun.dot(slope).max(0.0);
    let luminance = (sunlit + light.sky_illuminance_lx(slope)) * Vec3::new(0.06, 0.1, 0.04) / PI;
    let colour = (EXPOSURE * luminance).as_dvec3().to_array();

    // The program draws its hills at four distances; the sky draws over them.
    let frame = Frame::towards(axes::direction(110.0, 0.0).as_vec3(), 512);
    let distance_m = |x: u32, y: u32| {
        let d = frame.direction(x, y);
        let ridges = [(1e3, 40.0), (4e3, 250.0), (1.5e4, 900.0), (5e4, 3000.0)];
        let covers = |&(distance_m, height_m): &(f32, f32)| {
            let wave = 1.0 + 0.4 * (8.0 * d.z.atan2(d.x) + distance_m).sin();
            150.0 + d.y * distance_m < height_m * wave
        };
        let ridge = ridges.into_iter().find(covers);
        ridge.map_or(f32::INFINITY, |(distance_m, _)| distance_m)
    };
    let camera = frame.camera(EXPOSURE)?;
    let hills = Geometry {
        colour,
        distance_m: &distance_m,
    };
    let pixels = program.draw(&frame, Some(&hills), |encoder, target, depth| {
        sky.record(encoder, target, depth, &camera);
    })?;
    picture::write(&output, &pixels, 1.0)
}
