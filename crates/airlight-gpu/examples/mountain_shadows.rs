//! Draws mountains under a low sun, whose shadows lie in the air and in the fog of the valleys:
//! `cargo run --release -p airlight-gpu --example mountain_shadows -- OUT.png [SUN_DEG [AZIMUTH_DEG [VISIBILITY_M [shadows|none]]]]`. The
//! sun is in the east.

mod picture;

use airlight::glam::{DVec3, Vec3};
use airlight::{atmosphere::Preset, axes};
use airlight_gpu::headless::{FORMAT, Frame, Headless};
use airlight_gpu::{Fog, HeightField, SkyRenderer, SkyRendererSettings, TerrainPass, TerrainView};
use std::error::Error;

const SIDE: u32 = 640;

fn main() -> Result<(), Box<dyn Error>> {
    let arguments: Vec<String> = std::env::args().skip(1).collect();
    let output = arguments.first().ok_or("expected OUT.png")?;
    let number = |k: usize, default: f64| arguments.get(k).map_or(Ok(default), |text| text.parse());
    let sun = axes::direction(90.0, number(1, 7.0)?);
    let look = axes::direction(number(2, 60.0)?, 4.0).as_vec3();
    let program = Headless::new()?;
    let air = Preset::Average.atmosphere();
    let settings = SkyRendererSettings {
        shadows: true,
        ..SkyRendererSettings::new(FORMAT)
    };
    let mut sky = SkyRenderer::new(&program.device, &program.queue, &air, &settings)?;
    sky.set_fog(Some(Fog::new(number(3, 3000.0)?, 120.0)))?;
    let ground = mountains()?;
    let eye_m = DVec3::new(0.0, ground.height_m([0.0; 2]) + 60.0, 0.0);
    sky.update(eye_m.y, sun)?;
    let mut terrain = TerrainPass::new(&program.device, &program.queue, FORMAT)?;
    terrain.set_heights(&ground);
    let lighting = *sky.lighting().ok_or("expected light after an update")?;
    let albedos = [[0.05, 0.07, 0.03], [0.16, 0.15, 0.13]];
    let view = TerrainView::new(eye_m, air.planet.radius_m, lighting, albedos)?;
    let exposure = 1.0 / lighting.sky_illuminance_lx(Vec3::Y).y;
    let frame = Frame::towards(look, SIDE);
    let camera = frame.camera(exposure)?;
    let has_shadows = arguments.get(4).is_none_or(|text| text == "shadows");
    let depth = depth_texture(&program.device);
    let pixels = program.draw(&frame, None, |encoder, target, _| {
        terrain.record(encoder, target, &depth, &camera, &view);
        let shadows = terrain.shadows(encoder, &view).filter(|_| has_shadows);
        sky.record_shadowed(encoder, target, &depth, &camera, shadows.as_ref());
    })?;
    picture::write(output, &pixels, 1.0)
}

/// Ridges and peaks around a valley.
fn mountains() -> Result<HeightField, Box<dyn Error>> {
    const COUNT: usize = 512;
    const SPACING_M: f64 = 60.0;
    let height = |k: usize| {
        let [x, z] = [k % COUNT, k / COUNT].map(|n| (n as f64 - 255.5) * SPACING_M * 1e-3);
        let ridges = (0..6).map(|octave| {
            let scale = 0.35 * 1.9f64.powi(octave);
            let (u, v) = (scale * (0.8 * x + 0.6 * z), scale * (0.8 * z - 0.6 * x));
            let fold = (u + 0.7 * (1.3 * v).sin()).sin() * (v + 0.6 * u.sin()).cos();
            (1.0 - fold.abs()).powi(2) / 1.9f64.powi(octave)
        });
        let valley = 1.0 - 0.75 * (-(x * x + 0.3 * z * z) / 9.0).exp();
        (900.0 * valley * ridges.sum::<f64>()) as f32
    };
    let heights_m = (0..COUNT * COUNT).map(height).collect();
    Ok(HeightField::new([COUNT; 2], [SPACING_M; 2], heights_m)?)
}

/// A depth that the terrain can draw into, 0 without ground.
fn depth_texture(device: &wgpu::Device) -> wgpu::TextureView {
    let texture = device.create_texture(&wgpu::TextureDescriptor {
        label: Some("depth"),
        size: wgpu::Extent3d {
            width: SIDE,
            height: SIDE,
            depth_or_array_layers: 1,
        },
        mip_level_count: 1,
        sample_count: 1,
        dimension: wgpu::TextureDimension::D2,
        format: wgpu::TextureFormat::R32Float,
        usage: wgpu::TextureUsages::RENDER_ATTACHMENT | wgpu::TextureUsages::TEXTURE_BINDING,
        view_formats: &[],
    });
    texture.create_view(&wgpu::TextureViewDescriptor::default())
}
