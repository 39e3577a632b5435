//! Draws a street of lights in fog at dusk, a spot light and a glowing sphere:
//! `cargo run --release -p airlight-gpu --example lights_in_fog -- OUT.png`.

mod picture;

use airlight::fog::lights::{Light, PointLight, SphereLight, SpotLight};
use airlight::{atmosphere::Preset, axes, glam::DVec3, sky::SkySettings, sky::SunCoverage};
use airlight_gpu::headless::{FORMAT, Frame, Geometry, Headless};
use airlight_gpu::{Fog, SkyRenderer, SkyRendererSettings};
use std::error::Error;

const HEIGHT_M: f64 = 2.0;
const SUN_DEG: f64 = -5.0;
const EXPOSURE: f32 = 0.08;

fn main() -> Result<(), Box<dyn Error>> {
    let output = std::env::args().nth(1).ok_or("expected OUT.png")?;
    let program = Headless::new()?;
    let settings = SkyRendererSettings {
        solver: SkySettings {
            suns: SunCoverage::near(SUN_DEG, HEIGHT_M),
            ..Default::default()
        },
        ..SkyRendererSettings::new(FORMAT)
    };
    let air = Preset::Average.atmosphere();
    let mut sky = SkyRenderer::new(&program.device, &program.queue, &air, &settings)?;
    // The fog has a visibility of 150 m and thins by e in 20 m.
    sky.set_fog(Some(Fog::new(150.0, 20.0)))?;
    sky.update(HEIGHT_M, axes::direction(200.0, SUN_DEG))?;
    sky.set_lights(&lights()?)?;
    // A wall 120 m away, up to a height of 6 m.
    let frame = Frame::towards(DVec3::X.as_vec3(), 640);
    let distance_m = |x: u32, y: u32| {
        let direction = frame.direction(x, y);
        let distance_m = 120.0 / direction.x;
        let height_m = HEIGHT_M as f32 + direction.y * distance_m;
        match (0.0..6.0).contains(&height_m) {
            true => distance_m,
            false => f32::INFINITY,
        }
    };
    let wall = Geometry {
        colour: [0.0; 3],
        distance_m: &distance_m,
    };
    let camera = frame.camera(EXPOSURE)?;
    let pixels = program.draw(&frame, Some(&wall), |encoder, target, depth| {
        sky.record(encoder, target, depth, &camera);
    })?;
    picture::write(&output, &pixels, 1.0)
}

/// Lights around the eye: x ahead, y up, m.
fn lights() -> Result<Vec<Light<[f32; 3]>>, Box<dyn Error>> {
    let sodium = [900.0, 420.0, 60.0];
    let street = (1..=5).flat_map(|k| [-6.0, 6.0].map(|z| DVec3::new(12.0 * f64::from(k), 3.0, z)));
    let mut all = Vec::new();
    for position in street {
        all.push(Light::Point(PointLight::new(position, sodium, 0.1)?));
    }
    let up = DVec3::new(0.2, 1.0, -0.15);
    let (place, cool) = (DVec3::new(20.0, -1.5, 9.0), [4e4, 5e4, 6e4]);
    all.push(Light::Spot(SpotLight::new(place, up, cool, 0.1, 0.2, 0.1)?));
    let red = [3e3, 300.0, 200.0];
    all.push(Light::Sphere(SphereLight::new(
        DVec3::new(25.0, 0.5, -14.0),
        0.5,
        red,
    )?));
    Ok(all)
}
