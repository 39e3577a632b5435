//! Draws a sky behind black hills at 5, 20 and 60 km without a window:
//! `cargo run --release -p airlight-gpu --example draw_png -- OUT.png ATMOSPHERE SUN_DEG HEIGHT_M [AZIMUTH_DEG [ELEVATION_DEG
//! [VISIBILITY_M]]]`. The sun is in the south (180); the visibility is that of a fog that thins by e in 100 m.

mod picture;

use airlight::spectrum::RgbSpace;
use airlight::{Named, atmosphere::Preset, axes, sky::SkySettings, sky::SunCoverage};
use airlight_gpu::headless::{FORMAT, Frame, Geometry, Headless};
use airlight_gpu::{Fog, SkyRenderer, SkyRendererSettings};
use airlight_image::tone::{Exposure, Metering};
use std::{error::Error, time::Instant};

const SIDE: u32 = 640;

fn main() -> Result<(), Box<dyn Error>> {
    let arguments: Vec<String> = std::env::args().skip(1).collect();
    let [output, air, sun_deg, height_m, look @ ..] = arguments.as_slice() else {
        return Err(
            "expected OUT.png ATMOSPHERE SUN_DEG HEIGHT_M [AZIMUTH_DEG [ELEVATION_DEG [VISIBILITY_M]]]"
                .into(),
        );
    };
    let (sun_deg, height_m): (f64, f64) = (sun_deg.parse()?, height_m.parse()?);
    let angle = |k: usize, default: f64| look.get(k).map_or(Ok(default), |text| text.parse());
    let towards = axes::direction(angle(0, 180.0)?, angle(1, 10.0)?).as_vec3();
    let gpu = Headless::new()?;
    let settings = SkyRendererSettings {
        solver: SkySettings {
            suns: SunCoverage::near(sun_deg, height_m),
            ..Default::default()
        },
        ..SkyRendererSettings::new(FORMAT)
    };
    let atmosphere = Preset::from_name(air)?.atmosphere();
    let mut renderer = SkyRenderer::new(&gpu.device, &gpu.queue, &atmosphere, &settings)?;
    if look.len() > 2 {
        renderer.set_fog(Some(Fog::new(angle(2, 0.0)?, 100.0)))?;
    }
    let start = Instant::now();
    renderer.update(height_m, axes::direction(180.0, sun_deg))?;
    println!(
        "{}: tables in {:.2} s",
        gpu.name,
        start.elapsed().as_secs_f64()
    );
    let frame = Frame::towards(towards, SIDE);
    let radius_m = atmosphere.planet.radius_m;
    let horizon = -(2.0 * height_m.max(0.0) / radius_m).sqrt() as f32;
    let hills = |x: u32, y: u32| {
        let direction = frame.direction(x, y);
        let azimuth = direction.x.atan2(direction.z);
        let ridge = |distance_m: f32, peak_m: f32, waves: f32| {
            let shape = (azimuth * waves).sin() + 0.5 * (azimuth * waves * 2.7 + 1.0).sin();
            let top_m = peak_m * (0.6 + 0.25 * shape) - height_m as f32;
            // Below the horizon is the ground of the planet.
            let covers = direction.y > horizon && direction.y * distance_m < top_m;
            if covers { distance_m } else { f32::INFINITY }
        };
        let nearest = ridge(5e3, 300.0, 5.0).min(ridge(2e4, 1500.0, 8.0));
        nearest.min(ridge(6e4, 4500.0, 11.0))
    };
    // In the dark of twilight half floats need light.
    let frame_exposure = if sun_deg > 0.0 { 1e-4 } else { 1.0 };
    let geometry = Geometry {
        colour: [0.0; 3],
        distance_m: &hills,
    };
    let camera = frame.camera(frame_exposure)?;
    let pixels = gpu.draw(&frame, Some(&geometry), |encoder, target, depth| {
        renderer.record(encoder, target, depth, &camera);
    })?;
    let luminance = |rgb: &[f32; 3]| {
        let light = rgb.map(|v| f64::from(v / frame_exposure));
        (RgbSpace::Srgb.luminance(light) as f32, 1.0)
    };
    let luminances: Vec<(f32, f32)> = pixels.iter().map(luminance).collect();
    let exposure = Exposure::metered(&luminances, Metering::default())
        .ok_or("expected a picture with light, got a black one")?;
    // The pixels hold light times the exposure of the frame.
    picture::write(output, &pixels, exposure.factor() as f32 / frame_exposure)
}
