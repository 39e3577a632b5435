//! Draws towers in ground mist under a raised layer of fog:
//! `cargo run --release -p airlight-gpu --example layers_of_fog -- OUT.png [SUN_DEG [HEIGHT_M [ELEVATION_DEG]]]`. The sun stands 50 degrees
//! beside the middle of the picture.

mod picture;

use airlight::fog::{DensityProfile, RgbLayer, droplets::Droplets, visibility};
use airlight::{atmosphere::Preset, axes, glam::Vec3};
use airlight_gpu::headless::{FORMAT, Frame, Geometry, Headless};
use airlight_gpu::{Fog, SkyRenderer, SkyRendererSettings};
use std::{error::Error, f32::consts::PI};

/// Towers: azimuth, degrees, distance and height, m.
const TOWERS: [[f32; 3]; 9] = [
    [-33.0, 260.0, 180.0],
    [-24.0, 420.0, 110.0],
    [-14.0, 180.0, 60.0],
    [-6.0, 700.0, 220.0],
    [3.0, 320.0, 130.0],
    [12.0, 1100.0, 240.0],
    [18.0, 240.0, 90.0],
    [27.0, 520.0, 200.0],
    [36.0, 150.0, 40.0],
];

fn main() -> Result<(), Box<dyn Error>> {
    let arguments: Vec<String> = std::env::args().skip(1).collect();
    let output = arguments.first().ok_or("expected OUT.png")?;
    let number = |k: usize, default: f64| arguments.get(k).map_or(Ok(default), |text| text.parse());
    let (sun_deg, height_m) = (number(1, 30.0)?, number(2, 2.0)?);
    let program = Headless::new()?;
    let settings = SkyRendererSettings::new(FORMAT);
    let air = Preset::Average.atmosphere();
    let mut sky = SkyRenderer::new(&program.device, &program.queue, &air, &settings)?;
    sky.set_fog(Some(fog()))?;
    sky.update(height_m, axes::direction(50.0, sun_deg))?;

    let light = sky.lighting().ok_or("expected light after an update")?;
    let level = light.sky_illuminance_lx(Vec3::Y) + light.sun_illuminance_lx * light.sun.y.max(0.0);
    let exposure = 0.8 / level.y;
    let frame = Frame::towards(axes::direction(0.0, number(3, 5.0)?).as_vec3(), 640);
    let distance_m = |x: u32, y: u32| {
        let direction = frame.direction(x, y);
        let azimuth = direction.x.atan2(-direction.z);
        let level = direction.x.hypot(direction.z);
        let covers = |&[at_deg, distance_m, top_m]: &[f32; 3]| {
            let beside_m = distance_m * (azimuth - at_deg.to_radians()).sin().abs();
            let hit_m = height_m as f32 + direction.y / level * distance_m;
            (beside_m < 12.0 && hit_m > 0.0 && hit_m < top_m).then_some(distance_m / level)
        };
        TOWERS
            .iter()
            .filter_map(covers)
            .fold(f32::INFINITY, f32::min)
    };
    let towers = Geometry {
        colour: (level * exposure * 0.04 / PI).as_dvec3().to_array(),
        distance_m: &distance_m,
    };
    let camera = frame.camera(exposure)?;
    let pixels = program.draw(&frame, Some(&towers), |encoder, target, depth| {
        sky.record(encoder, target, depth, &camera);
    })?;
    picture::write(output, &pixels, 2.0)
}

/// Mist that thins by e in 5 m, with a visibility of 150 m at the ground, and a layer of larger droplets from 80 to 130 m, with one of 400 m.
fn fog() -> Fog {
    let layer = |density: DensityProfile, visibility_m: f64, droplets: Droplets| {
        let extinction_per_m = visibility::extinction_per_m(visibility_m, Default::default());
        RgbLayer {
            density,
            extinction_per_m: [extinction_per_m as f32; 3],
            single_scattering_albedo: [1.0; 3],
            phase: droplets.phase(),
        }
    };
    let raised = DensityProfile::Layer {
        bottom_m: 80.0,
        top_m: 130.0,
    };
    let mist = DensityProfile::exponential(5.0);
    Fog {
        layers: vec![
            layer(mist, 150.0, Droplets::Radiation),
            layer(raised, 400.0, Droplets::Advection),
        ],
        ground_height_m: 0.0,
        ground_albedo: [0.05, 0.1, 0.03],
    }
}
