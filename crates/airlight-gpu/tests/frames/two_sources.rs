//! Frames under two sources of light, against the sums of the solver's views under each.

use super::{SIDE, draw, reference, renderer_for_all_suns, rgb_of};
use airlight::atmosphere::Preset;
use airlight::axes;
use airlight::night::MoonState;
use airlight::sky::{LightSource, TableChannels, View};
use airlight::spectrum::RgbSpace;
use airlight::sun::SunState;
use airlight_gpu::headless::{Frame, Geometry, Headless};
use airlight_gpu::{Camera, Projection, SkyRenderer};
use glam::{DVec3, Mat4, Vec3};

const AIR: Preset = Preset::Average;
const HEIGHT_M: f64 = 200.0;

/// The moon at an elevation, degrees, 30 degrees from full.
fn moon(elevation_deg: f64) -> MoonState {
    let direction = axes::direction(110.0, elevation_deg);
    let moon = MoonState::lit_by(direction, axes::direction(280.0, -elevation_deg));
    moon.with_phase(30.0).unwrap()
}

fn sun(elevation_deg: f64) -> SunState {
    SunState::from(axes::direction(250.0, elevation_deg))
}

/// Pairs of sources, whose lights are of the same order: late twilight with the moon, and two suns.
fn pairs() -> [[LightSource; 2]; 2] {
    let far = sun(8.0).at_distance_ratio(1.5);
    [
        [moon(30.0).into(), sun(-12.0).into()],
        [
            SunState::from(axes::direction(100.0, 40.0)).into(),
            far.into(),
        ],
    ]
}

fn views(sources: &[LightSource; 2]) -> [View; 2] {
    sources.map(|source| {
        let elevation_deg = axes::elevation_deg(source.direction());
        reference(AIR, elevation_deg, HEIGHT_M, source)
    })
}

fn update(renderer: &mut SkyRenderer, [first, second]: [LightSource; 2]) {
    renderer.set_second_source(Some(second)).unwrap();
    renderer.update(HEIGHT_M, first).unwrap();
}

/// Root mean square and largest difference of colours, relative to the luminance that is right.
fn errors(pairs: impl Iterator<Item = (Vec3, [f64; 3])>) -> [f64; 2] {
    let (mut squares, mut worst, mut count) = (0.0, 0.0f64, 0.0);
    for (got, right) in pairs {
        let luminance = RgbSpace::Srgb.luminance(right);
        let off = (0..3).map(|c| ((f64::from(got[c]) - right[c]) / luminance).abs());
        let error = off.fold(0.0, f64::max);
        squares += error * error;
        worst = worst.max(error);
        count += 1.0;
    }
    [(squares / count).sqrt(), worst]
}

/// Sky and ground, black walls behind air, and light on surfaces.
#[test]
fn light_of_two_sources_is_the_sum_of_the_solvers() {
    let gpu = Headless::new().unwrap();
    let mut renderer = renderer_for_all_suns(&gpu, AIR);
    for sources in pairs() {
        update(&mut renderer, sources);
        let views = views(&sources);
        let grid = views[0].sky().grid();
        let sum = |light: &dyn Fn(&View) -> Vec<f32>| {
            let [first, second] = views.each_ref().map(light);
            let sum: Vec<f32> = first.iter().zip(second).map(|(a, b)| a + b).collect();
            rgb_of(grid, &sum)
        };
        // Between the sources.
        let frame = Frame::towards(axes::direction(180.0, 5.0).as_vec3(), SIDE / 2);
        let zenith = sum(&|view| view.along(DVec3::Y, None).radiance());
        let exposure = (1.0 / RgbSpace::Srgb.luminance(zenith)) as f32;
        let distance_m = |x: u32, y: u32| 1e3 * 50f32.powf(((5 * x + 3 * y) % 31) as f32 / 30.0);
        let walls = Geometry {
            colour: [0.0; 3],
            distance_m: &distance_m,
        };
        let mut compared = |geometry: Option<&Geometry<'_>>| {
            let pixels = draw(&gpu, &mut renderer, &frame, exposure, geometry);
            let pairs = pixels.into_iter().enumerate().filter_map(|(k, got)| {
                let (x, y) = (k as u32 % frame.side, k as u32 / frame.side);
                let direction = frame.direction(x, y).as_dvec3();
                let beside_horizon = (direction.y - views[0].horizon_elevation_rad().sin()).abs();
                let limit_m = geometry.map(|g| f64::from((g.distance_m)(x, y)));
                let right = sum(&|view| {
                    let light = view.along(direction, limit_m);
                    match limit_m {
                        Some(_) => light.path_radiance(),
                        None => light.radiance(),
                    }
                });
                (beside_horizon > 0.01).then_some((Vec3::from(got) / exposure, right))
            });
            errors(pairs)
        };
        let (sky, path) = (compared(None), compared(Some(&walls)));
        println!("sky {sky:.4?}, path {path:.4?}");
        assert!(sky[0] < 0.005 && sky[1] < 0.02, "{sky:?}");
        assert!(path[0] < 0.005 && path[1] < 0.02, "{path:?}");

        let lighting = *renderer.lighting().unwrap();
        let second = lighting.second.unwrap();
        for (view, direction, got) in [
            (&views[0], lighting.sun, lighting.sun_illuminance_lx),
            (&views[1], second.direction, second.illuminance_lx),
        ] {
            assert!(direction.distance(view.sun().as_vec3()) < 1e-6);
            let right = rgb_of(grid, &view.sun_irradiance());
            let right = Vec3::from(right.map(|v| v as f32));
            let error = (got - right).abs().max_element() / right.y.max(1e-9);
            assert!(error < 0.02, "{got} {right}");
        }
        let on_level = sum(&|view| view.table(TableChannels::Spectral).irradiance(DVec3::Y));
        let got = lighting.sky_illuminance_lx(Vec3::Y);
        let [error, _] = errors(std::iter::once((got, on_level)));
        println!("illuminance of level ground by both skies: {error:.4}");
        // Harmonics of degree 2 cannot follow light that comes from beside the horizon.
        assert!(error < 0.06, "{error}");
    }
}

/// The disc of a waning moon against the library's: its phase, its brightness, its place.
#[test]
fn the_moon_shows_its_phase() {
    let gpu = Headless::new().unwrap();
    let moon = moon(30.0).with_phase(70.0).unwrap();
    let mut renderer = renderer_for_all_suns(&gpu, AIR);
    renderer.update(HEIGHT_M, moon).unwrap();
    let view = reference(AIR, 30.0, HEIGHT_M, moon);
    let grid = view.sky().grid();
    // A telescope: 2 degrees.
    let half_width = 0.0175;
    let frame = Frame::towards(moon.direction.as_vec3(), 96);
    let narrow = Mat4::from_scale(Vec3::new(half_width, half_width, 1.0));
    let telescope = Projection::Perspective {
        world_from_clip: frame.clip_from_world.inverse() * narrow,
        far_depth: 0.0,
    };
    let camera = Camera::new(telescope, 1e-3).unwrap();
    let pixels = gpu.draw(&frame, None, |encoder, target, depth| {
        renderer.record(encoder, target, depth, &camera);
    });
    let pixels = pixels.unwrap();
    let direction = |x: f64, y: f64| {
        let clip = |p: f64| (2.0 * p / f64::from(frame.side) - 1.0) as f32 * half_width;
        let near = Vec3::new(clip(x), -clip(y), 1.0);
        let near = frame.clip_from_world.inverse().project_point3(near);
        near.as_dvec3().normalize()
    };
    let luminance = |rgb: [f64; 3]| RgbSpace::Srgb.luminance(rgb);
    let sky = luminance(rgb_of(grid, &view.along(moon.direction, None).radiance()));
    const PARTS: u32 = 8;
    let (mut worst, mut sums, mut dark) = (0.0f64, [0.0; 2], 0);
    let mut brightest = 0.0f64;
    for (k, pixel) in pixels.iter().enumerate() {
        let (x, y) = (k as u32 % frame.side, k as u32 / frame.side);
        let parts = (0..PARTS * PARTS).map(|k| {
            let at = |p: u32, k: u32| f64::from(p) + (f64::from(k) + 0.5) / f64::from(PARTS);
            let direction = direction(at(x, k % PARTS), at(y, k / PARTS));
            luminance(rgb_of(grid, &view.sun_disc_radiance(direction)))
        });
        let right = parts.sum::<f64>() / f64::from(PARTS * PARTS);
        let got = luminance(pixel.map(|v| f64::from(v / camera.exposure()))) - sky;
        worst = worst.max((got - right).abs());
        brightest = brightest.max(right);
        sums = [sums[0] + got, sums[1] + right];
        let on_disc = direction(f64::from(x) + 0.5, f64::from(y) + 0.5)
            .angle_between(moon.direction)
            < 0.9 * moon.angular_radius_rad();
        dark += u32::from(on_disc && right == 0.0);
    }
    let [worst, light] = [worst / brightest, sums[0] / sums[1] - 1.0];
    println!("worst pixel {worst:.4} of the brightest, all light {light:.4}, {dark} dark pixels");
    assert!(worst < 0.015 && light.abs() < 0.01, "{worst} {light}");
    assert!(dark > 50, "{dark}");
}

/// What the second source adds is what it lights alone; without it, frames are those of one source.
#[test]
fn a_second_source_adds_its_light_in_fog_and_reflections() {
    let gpu = Headless::new().unwrap();
    let mut renderer = renderer_for_all_suns(&gpu, AIR);
    let [first, second] = pairs()[1];
    let frame = Frame::towards(axes::direction(180.0, 0.0).as_vec3(), SIDE / 2);
    renderer.set_fog(Some(super::valley_fog())).unwrap();
    let mut drawn = |sources: (LightSource, Option<LightSource>)| {
        renderer.set_second_source(sources.1).unwrap();
        renderer.update(20.0, sources.0).unwrap();
        let frame = draw(&gpu, &mut renderer, &frame, 1e-4, None);
        let mut map = renderer.environment_map(32).unwrap();
        let mut encoder = gpu.device.create_command_encoder(&Default::default());
        renderer
            .record_environment(&mut encoder, &mut map, 1e-4)
            .unwrap();
        gpu.queue.submit([encoder.finish()]);
        let directions: Vec<Vec3> = super::scattered().collect();
        let cube = super::sample_cube(&gpu, map.view(), &directions, 0.0);
        frame.into_iter().map(Vec3::from).chain(cube).collect()
    };
    let alone: [Vec<Vec3>; 2] = [first, second].map(|source| drawn((source, None)));
    let both: Vec<Vec3> = drawn((first, Some(second)));
    let again: Vec<Vec3> = drawn((first, None));
    assert_eq!(again, alone[0]);
    // Off the discs, which are the only light above this.
    let mut compared = 0;
    for (k, both) in both.iter().enumerate() {
        let sum = alone[0][k] + alone[1][k];
        let error = ((*both - sum) / sum).abs().max_element();
        assert!(error < 4e-3, "{k}: {both} {sum}");
        compared += u32::from(alone[1][k].y > 0.05 * sum.y);
    }
    assert!(compared > 500, "{compared}");
}
