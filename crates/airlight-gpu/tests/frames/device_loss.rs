//! Lost devices are errors, and renderers go on with another device, or in other air.

use crate::{SIDE, draw, renderer, settings, valley_fog};
use airlight::atmosphere::Preset;
use airlight::axes;
use airlight::fog::lights::{Light, PointLight};
use airlight::glam::{DVec3, Vec3};
use airlight_gpu::headless::{FORMAT, Frame, Geometry, Headless};
use airlight_gpu::{
    HeightField, PassTimers, SkyPasses, SkyRenderer, SkyRendererError, SkyRendererSettings,
    TerrainPass, TerrainView, TonePass, ToneSettings, is_device_lost,
};

#[test]
fn lost_devices_are_errors_and_others_draw_the_same() {
    let lost =
        Headless::with_features(SkyPasses::OPTIONAL_FEATURES | PassTimers::FEATURES).unwrap();
    let mut renderer = renderer(&lost, Preset::Clear, 30.0, 2.0);
    let sun = axes::direction(140.0, 30.0);
    let light = PointLight::new(DVec3::new(30.0, 2.0, 5.0), [1e4; 3], 0.1).unwrap();
    renderer.set_fog(Some(valley_fog())).unwrap();
    renderer.set_lights(&[Light::Point(light)]).unwrap();
    renderer.set_discs(false);
    renderer.update(2.0, sun).unwrap();
    let frame = Frame::towards(sun.as_vec3(), SIDE);
    let before = draw(&lost, &mut renderer, &frame, 1e-4, None);
    let mut map = renderer.environment_map(16).unwrap();
    let mut terrain = TerrainPass::new(&lost.device, &lost.queue, FORMAT).unwrap();
    let tone = TonePass::new(&lost.device, wgpu::TextureFormat::Rgba8Unorm).unwrap();
    let mut timers = PassTimers::new(&lost.device, &lost.queue, 1);
    assert!(!is_device_lost(&lost.device));

    lost.device.destroy();
    assert!(is_device_lost(&lost.device));
    let refused = renderer.update(2.0, sun).unwrap_err();
    assert_eq!(refused, SkyRendererError::DeviceLost);
    let refused = renderer.update_in_background(2.0, sun).unwrap_err();
    assert_eq!(refused, SkyRendererError::DeviceLost);
    let refused = SkyPasses::new(&lost.device, &lost.queue, FORMAT).unwrap_err();
    assert_eq!(refused, SkyRendererError::DeviceLost);
    // What a program may do before its next update has no effect, and no panic; pixels cannot be read.
    renderer.set_lights(&[Light::Point(light)]).unwrap();
    let heights = HeightField::new([2, 2], [100.0; 2], vec![0.0; 4]).unwrap();
    terrain.set_heights(&heights);
    let lighting = *renderer.lighting().unwrap();
    let view = TerrainView::new(DVec3::Y * 2.0, 6.36e6, lighting, [[0.1; 3]; 2]).unwrap();
    let walls = Geometry {
        colour: [1.0; 3],
        distance_m: &|_, _| 100.0,
    };
    let display = lost.device.create_texture(&wgpu::TextureDescriptor {
        label: None,
        size: wgpu::Extent3d {
            width: SIDE,
            height: SIDE,
            depth_or_array_layers: 1,
        },
        mip_level_count: 1,
        sample_count: 1,
        dimension: wgpu::TextureDimension::D2,
        format: wgpu::TextureFormat::Rgba8Unorm,
        usage: wgpu::TextureUsages::RENDER_ATTACHMENT,
        view_formats: &[],
    });
    let display = display.create_view(&wgpu::TextureViewDescriptor::default());
    let camera = frame.camera(1e-4).unwrap();
    let read = lost.draw(&frame, Some(&walls), |encoder, target, depth| {
        if let Some(timers) = &timers {
            timers.stamp(encoder, 0);
            timers.stamp(encoder, 1);
        }
        terrain.record(encoder, target, depth, &camera, &view);
        let shadows = terrain.shadows(encoder, &view);
        renderer.record_shadowed(encoder, target, depth, &camera, shadows.as_ref());
        renderer
            .record_environment(encoder, &mut map, 1e-4)
            .unwrap();
        tone.record(encoder, target, &display, &ToneSettings::default());
    });
    assert!(read.is_err());
    if let Some(timers) = &mut timers {
        timers.read();
        assert_eq!(timers.take(&lost.device), None);
    }

    let gpu = Headless::new().unwrap();
    renderer.recreate(&gpu.device, &gpu.queue).unwrap();
    assert_eq!(draw(&gpu, &mut renderer, &frame, 1e-4, None), before);
    renderer.update(2.0, sun).unwrap();
    assert_eq!(renderer.work().tables, 2);
}

#[test]
fn other_air_is_drawn_by_the_same_renderer() {
    let gpu = Headless::new().unwrap();
    let sun = axes::direction(140.0, 30.0);
    let frame = Frame::towards(Vec3::X, SIDE);
    let with_shadows = |air: Preset| {
        let settings = SkyRendererSettings {
            solver: settings(30.0, 2.0),
            shadows: true,
            ..SkyRendererSettings::new(FORMAT)
        };
        SkyRenderer::new(&gpu.device, &gpu.queue, &air.atmosphere(), &settings).unwrap()
    };
    let drawn = |renderer: &mut SkyRenderer| draw(&gpu, renderer, &frame, 1e-4, None);
    let mut right = with_shadows(Preset::Hazy);
    right.update(2.0, sun).unwrap();
    let hazy = drawn(&mut right);
    let mut renderer = with_shadows(Preset::Clear);
    renderer.update(2.0, sun).unwrap();
    let clear = drawn(&mut renderer);
    assert_ne!(clear, hazy);
    renderer.set_atmosphere(&Preset::Hazy.atmosphere()).unwrap();
    // With the last tables until the next update.
    assert_eq!(drawn(&mut renderer), clear);
    renderer.update(2.0, sun).unwrap();
    assert_eq!(drawn(&mut renderer), hazy);
    assert_eq!((renderer.work().tables, renderer.work().frames), (2, 3));
}
