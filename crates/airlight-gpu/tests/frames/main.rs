//! Frames of a device against the library. The crate `airlight-validation` compares whole skies.

mod changing_air;
mod cube;
mod device_loss;
mod far_origin;
mod flight;
mod fog_in_air;
mod late_twilight;
mod planets;
mod shadows;
mod two_sources;

use airlight::atmosphere::{AerosolMixture, AerosolType, DensityProfile, Preset};
use airlight::axes;
use airlight::fog::lights::{
    Light, LightSettings, PointLight, RgbLightSet, SphereLight, SpotLight, ViewRay,
};
use airlight::fog::{DirectionalLight, FogLighting, FogScattering, Ground, RgbFog, RgbLayer};
use airlight::night::MoonState;
use airlight::optics::PhaseFunction;
use airlight::sky::{LightSource, Sky, SkySettings, SunCoverage, TableChannels, View};
use airlight::spectrum::{RgbSpace, WavelengthGrid};
use airlight::sun::SunState;
use airlight::transfer::{exponentials, medium_evaluations};
use airlight_gpu::headless::{FORMAT, Frame, Geometry, Headless};
use airlight_gpu::{
    Fog, MOST_FOG_LAYERS, SkyPasses, SkyRenderer, SkyRendererError, SkyRendererSettings, SkySolver,
};
use airlight_shaders::{ColourFit, SkyTables};
use cube::sample_cube;
use glam::{DVec3, Vec3};

fn settings(sun_deg: f64, height_m: f64) -> SkySettings {
    SkySettings {
        suns: SunCoverage::near(sun_deg, height_m),
        ..Default::default()
    }
}

fn renderer(gpu: &Headless, air: Preset, sun_deg: f64, height_m: f64) -> SkyRenderer {
    let settings = SkyRendererSettings {
        solver: settings(sun_deg, height_m),
        ..SkyRendererSettings::new(FORMAT)
    };
    SkyRenderer::new(&gpu.device, &gpu.queue, &air.atmosphere(), &settings).unwrap()
}

/// A renderer that is prepared for any sources and heights.
fn renderer_for_all_suns(gpu: &Headless, air: Preset) -> SkyRenderer {
    let settings = SkyRendererSettings::new(FORMAT);
    SkyRenderer::new(&gpu.device, &gpu.queue, &air.atmosphere(), &settings).unwrap()
}

/// The solver's sky at sixteen wavelengths.
fn reference(air: Preset, sun_deg: f64, height_m: f64, sun: impl Into<LightSource>) -> View {
    let grid = WavelengthGrid::standard();
    let sky = Sky::prepare(&air.atmosphere(), &grid, &settings(sun_deg, height_m)).unwrap();
    sky.view(height_m, sun)
}

const SIDE: u32 = 64;

/// Pixels of a frame that the renderer has drawn over.
fn draw(
    gpu: &Headless,
    renderer: &mut SkyRenderer,
    frame: &Frame,
    exposure: f32,
    geometry: Option<&Geometry<'_>>,
) -> Vec<[f32; 3]> {
    let camera = frame.camera(exposure).unwrap();
    let pixels = gpu.draw(frame, geometry, |encoder, target, depth| {
        renderer.record(encoder, target, depth, &camera);
    });
    pixels.unwrap()
}

#[test]
fn only_a_moved_eye_or_sun_fills_the_tables() {
    let gpu = Headless::new().unwrap();
    let mut renderer = renderer(&gpu, Preset::Clear, 30.0, 2.0);
    let sun = axes::direction(140.0, 30.0);
    for (count, azimuth) in [0.0, 45.0, 200.0].into_iter().enumerate() {
        renderer.update(2.0, sun).unwrap();
        let frame = Frame::towards(axes::direction(azimuth, 10.0).as_vec3(), 8);
        draw(&gpu, &mut renderer, &frame, 1e-4, None);
        let work = renderer.work();
        assert_eq!((work.tables, work.frames), (1, count as u64 + 1));
    }
    renderer.update(3.0, sun).unwrap();
    renderer.update(3.0, axes::direction(141.0, 30.0)).unwrap();
    assert_eq!(renderer.work().tables, 3);
}

/// Where the medium is evaluated when the sun moves, and when only the camera turns, and the exponentials of the tables. Hillaire 2020 evaluates it in 1.68 million places
/// each frame with the table sizes of the paper, Bevy 0.20 in 4.2 million.
#[test]
fn moved_suns_evaluate_the_medium_in_few_places_and_turned_cameras_in_none() {
    let gpu = Headless::new().unwrap();
    // On one thread, whose evaluations are counted.
    let pool = rayon::ThreadPoolBuilder::new().num_threads(1).build();
    pool.unwrap().install(|| {
        for (air, height_m) in [(Preset::Clear, 2.0), (Preset::Hazy, 1e4)] {
            let mut renderer = renderer_for_all_suns(&gpu, air);
            for sun_deg in [50.0, 5.0, -4.0] {
                let before = [medium_evaluations(), exponentials()];
                renderer
                    .update(height_m, axes::direction(140.0, sun_deg))
                    .unwrap();
                let moved = medium_evaluations() - before[0];
                let exp = exponentials() - before[1];
                println!(
                    "{air:?}, {height_m} m, sun at {sun_deg} degrees: {moved} evaluations, {exp} exponentials"
                );
                // In twilight, rays of aerial perspective that cross the edge of the planet's shadow have places of their own.
                let most = if sun_deg > 0.0 { 70_000 } else { 80_000 };
                assert!((1000..most).contains(&moved), "{moved}");
                assert!((6_500_000..9_500_000).contains(&exp), "{exp}");
                let before = [medium_evaluations(), exponentials()];
                for azimuth in [0.0, 100.0] {
                    let frame = Frame::towards(axes::direction(azimuth, 0.0).as_vec3(), 8);
                    draw(&gpu, &mut renderer, &frame, 1e-4, None);
                }
                assert_eq!([medium_evaluations(), exponentials()], before);
            }
            // Once a second source has its tables, it needs no more of them while only the first moves.
            let moon = axes::direction(20.0, 35.0);
            let moved = |renderer: &mut SkyRenderer, azimuth_deg: f64| {
                let before = medium_evaluations();
                let sun = axes::direction(azimuth_deg, 50.0);
                renderer.update(height_m, sun).unwrap();
                medium_evaluations() - before
            };
            let alone = moved(&mut renderer, 60.0);
            renderer.set_second_source(Some(moon.into())).unwrap();
            let both = moved(&mut renderer, 70.0);
            assert!(both > alone + 1000, "{both} {alone}");
            for azimuth_deg in [80.0, 90.0, 95.0] {
                assert_eq!(moved(&mut renderer, azimuth_deg), alone);
            }
            renderer.set_second_source(None).unwrap();
            // What fog, and what shadows in air, need besides.
            let more = |renderer: &mut SkyRenderer, azimuth_deg: f64| {
                let before = medium_evaluations();
                renderer
                    .update(height_m, axes::direction(azimuth_deg, 50.0))
                    .unwrap();
                medium_evaluations() - before
            };
            let alone = more(&mut renderer, 100.0);
            // A fog that changes needs no more than its own tables.
            renderer.set_fog(Some(valley_fog())).unwrap();
            let foggy = more(&mut renderer, 100.0);
            renderer.set_fog(Some(Fog::new(150.0, 10.0))).unwrap();
            let thicker = more(&mut renderer, 100.0);
            let settings = SkyRendererSettings {
                shadows: true,
                ..SkyRendererSettings::new(FORMAT)
            };
            let mut shadowed =
                SkyRenderer::new(&gpu.device, &gpu.queue, &air.atmosphere(), &settings).unwrap();
            let shadows = more(&mut shadowed, 100.0) - alone;
            println!("{air:?}: fog {foggy} or {thicker}, shadows {shadows} evaluations more");
            assert!((1000..6000).contains(&foggy), "{foggy}");
            assert!((1000..6000).contains(&thicker), "{thicker}");
            assert!((1000..60_000).contains(&shadows), "{shadows}");
        }
    });
}

/// Inside dust with a sharp upper edge, above it and far above it, in twilight, when rays cross the edges of the planet's shadow and of the
/// dust's.
#[test]
fn moved_suns_evaluate_the_medium_in_few_places_in_dust() {
    let mut air = Preset::Average.atmosphere();
    let (ground_m, top_m) = (air.planet.ground_altitude_m, air.planet.top_altitude_m);
    let dust = AerosolMixture::of(AerosolType::Desert, AerosolMixture::USUAL_HUMIDITY).unwrap();
    let dust = dust.constituent(None, None, air.clear_air(), ground_m, top_m);
    air.put(dust.unwrap());
    let pool = rayon::ThreadPoolBuilder::new().num_threads(1).build();
    pool.unwrap().install(|| {
        let solver = SkySolver::new(&air, &SkySettings::default(), RgbSpace::Srgb).unwrap();
        for height_m in [3e3, 1e4, 4e5] {
            for sun_deg in [0.0, -2.0, -4.0, -6.0] {
                let before = medium_evaluations();
                let sun = axes::direction(140.0, sun_deg);
                solver.tables(height_m, sun, None).unwrap();
                let moved = medium_evaluations() - before;
                println!("{height_m} m, sun at {sun_deg} degrees: {moved} evaluations");
                assert!((1000..150_000).contains(&moved), "{moved}");
            }
        }
    });
}

/// Frames of devices that blend with two colours, and of those that take two passes: half floats are rounded once more.
#[test]
fn frames_are_the_same_in_one_pass_and_in_two() {
    let devices = [SkyPasses::OPTIONAL_FEATURES, wgpu::Features::empty()];
    let [one, two] = devices.map(|features| {
        let gpu = Headless::with_features(features).unwrap();
        let mut renderer = renderer(&gpu, Preset::Hazy, 30.0, 2.0);
        renderer.set_fog(Some(valley_fog())).unwrap();
        let sun = axes::direction(140.0, 30.0);
        renderer.update(2.0, sun).unwrap();
        let frame = Frame::towards(sun.as_vec3(), SIDE);
        let walls = Geometry {
            colour: [0.2, 0.5, 0.9],
            distance_m: &|x, y| match (x + y) % 3 {
                0 => f32::INFINITY,
                _ => 20.0 + 100.0 * ((x * y) % 61) as f32,
            },
        };
        draw(&gpu, &mut renderer, &frame, 1e-4, Some(&walls))
    });
    let brightest = two.iter().flatten().fold(0.0f32, |a, b| a.max(*b));
    let pairs = one.as_flattened().iter().zip(two.as_flattened());
    let worst = pairs.fold(0.0f32, |worst, (a, b)| worst.max((a / b - 1.0).abs()));
    println!("brightest {brightest}, worst relative difference {worst:.5}");
    // The disc of the sun is in the frame.
    assert!(brightest > 100.0 && worst < 0.003, "{brightest} {worst}");
}

#[test]
fn tables_filled_in_the_background_are_those_of_an_update() {
    let gpu = Headless::new().unwrap();
    let mut renderer = renderer(&gpu, Preset::Clear, 30.0, 2.0);
    let frame = Frame::towards(axes::direction(100.0, 10.0).as_vec3(), 8);
    let [first, second] = [140.0, 170.0].map(|azimuth| axes::direction(azimuth, 30.0));
    let draw = |renderer: &mut SkyRenderer| draw(&gpu, renderer, &frame, 1e-4, None);
    renderer.update(2.0, second).unwrap();
    let right = draw(&mut renderer);
    renderer.update(2.0, first).unwrap();
    let before = draw(&mut renderer);
    assert_ne!(before, right);
    // The first call cannot have filled them yet.
    assert!(!renderer.update_in_background(2.0, second).unwrap());
    assert_eq!(draw(&mut renderer), before);
    while !renderer.update_in_background(2.0, second).unwrap() {
        std::thread::yield_now();
    }
    assert_eq!(draw(&mut renderer), right);
    assert_eq!(renderer.work().tables, 3);
}

/// Red, green and blue of light at sixteen wavelengths.
fn rgb_of(grid: &WavelengthGrid, light: &[f32]) -> [f64; 3] {
    RgbSpace::Srgb.from_xyz(grid.to_xyz(light))
}

#[test]
fn lighting_is_that_of_the_solver() {
    let gpu = Headless::new().unwrap();
    // Harmonics of degree 2 cannot follow light that comes from beside the horizon.
    for (sun_deg, limit) in [(50.0, 0.045), (5.0, 0.1)] {
        let sun = axes::direction(140.0, sun_deg);
        let mut renderer = renderer(&gpu, Preset::Clear, sun_deg, 2.0);
        assert!(renderer.lighting().is_none());
        renderer.update(2.0, sun).unwrap();
        let lighting = renderer.lighting().unwrap();
        let view = reference(Preset::Clear, sun_deg, 2.0, sun);
        let grid = view.sky().grid();
        let error = |got: Vec3, right: [f64; 3], luminance: f64| {
            let channels = got.to_array().into_iter().zip(right);
            channels
                .map(|(got, right)| ((f64::from(got) - right) / luminance).abs())
                .fold(0.0, f64::max)
        };
        let right = rgb_of(grid, &view.sun_irradiance());
        let sun_error = error(
            lighting.sun_illuminance_lx,
            right,
            RgbSpace::Srgb.luminance(right),
        );
        let table = view.table(TableChannels::Spectral);
        let on = |normal: DVec3| rgb_of(grid, &table.irradiance(normal));
        let horizontal = RgbSpace::Srgb.luminance(on(DVec3::Y));
        let normals = (0..60)
            .map(|k| axes::direction(30.0 * f64::from(k % 12), f64::from(k / 12) * 45.0 - 90.0));
        let sky_error = normals.map(|normal| {
            let got = lighting.sky_illuminance_lx(normal.as_vec3());
            error(got, on(normal), horizontal)
        });
        let sky_error = sky_error.fold(0.0, f64::max);
        println!("sun {sun_deg}: illuminance by the sun {sun_error:.4}, by the sky {sky_error:.3}");
        assert!(
            sun_error < 0.002 && sky_error < limit,
            "{sun_error} {sky_error}"
        );
    }
}

/// Fog with a visibility of 200 m that thins by e in 30 m.
fn valley_fog() -> Fog {
    Fog {
        layers: vec![RgbLayer {
            density: DensityProfile::exponential(30.0),
            extinction_per_m: [0.0196; 3],
            single_scattering_albedo: [0.999; 3],
            phase: PhaseFunction::henyey_greenstein(0.8).unwrap(),
        }],
        ground_height_m: 0.0,
        ground_albedo: [0.2; 3],
    }
}

#[test]
fn fog_has_any_profile_of_its_documentation() {
    let solver = SkySolver::new(
        &Preset::Clear.atmosphere(),
        &settings(30.0, 2.0),
        RgbSpace::Srgb,
    )
    .unwrap();
    let sun = axes::direction(140.0, 30.0);
    let profiles = [
        DensityProfile::exponential(30.0),
        DensityProfile::Clamped {
            base_height_m: 20.0,
            scale_height_m: 10.0,
        },
        DensityProfile::Layer {
            bottom_m: 5.0,
            top_m: 40.0,
        },
    ];
    for density in profiles {
        let mut fog = valley_fog();
        fog.layers[0].density = density.clone();
        let tables = solver.tables(2.0, sun, Some(&fog)).unwrap();
        assert!(tables.first.fog.is_some(), "{density:?}");
    }
    let mut fog = valley_fog();
    fog.layers[0].density = DensityProfile::Uniform;
    let error = solver.tables(2.0, sun, Some(&fog)).unwrap_err();
    assert_eq!(error, SkyRendererError::FogProfile);
}

/// The light below a fog, against what the library's fog lets fall on the ground. That fog is lit evenly by the sky, whose light comes
/// from beside the horizon under a low sun.
#[test]
fn lighting_in_fog_is_that_of_the_library() {
    let gpu = Headless::new().unwrap();
    for (sun_deg, limit) in [(50.0, 0.02), (10.0, 0.09)] {
        let sun = axes::direction(140.0, sun_deg);
        let mut renderer = renderer(&gpu, Preset::Clear, sun_deg, 0.0);
        renderer.update(0.0, sun).unwrap();
        let clear = *renderer.lighting().unwrap();
        let in_fog = |renderer: &mut SkyRenderer, extinction_per_m: f32| {
            let mut fog = valley_fog();
            fog.layers[0].extinction_per_m = [extinction_per_m; 3];
            renderer.set_fog(Some(fog.clone())).unwrap();
            renderer.update(0.0, sun).unwrap();
            let light = FogLighting {
                sun: Some(DirectionalLight {
                    direction: sun,
                    irradiance: clear.sun_illuminance_lx.to_array(),
                }),
                ambient: (clear.sky_illuminance_lx(Vec3::Y) / std::f32::consts::PI).to_array(),
                ground_albedo: fog.ground_albedo,
            };
            let fog = RgbFog::new(&fog.layers, Ground::FLAT, &light, FogScattering::Multiple);
            let fog = fog.unwrap();
            let on_ground = Vec3::from_array(fog.ground_irradiance().unwrap());
            let to_sun = fog.path(0.0, sun, f64::INFINITY).transmittance;
            (*renderer.lighting().unwrap(), on_ground, to_sun)
        };
        let horizontal = |light: &airlight_gpu::Lighting| {
            light.sun_illuminance_lx * sun.y as f32 + light.sky_illuminance_lx(Vec3::Y)
        };
        for extinction_per_m in [0.0196, 0.002, 1e-7] {
            let (light, on_ground, to_sun) = in_fog(&mut renderer, extinction_per_m);
            let dimmed = clear.sun_illuminance_lx * Vec3::from_array(to_sun);
            assert!(
                (light.sun_illuminance_lx / dimmed - 1.0)
                    .abs()
                    .max_element()
                    < 1e-4
            );
            let error = (horizontal(&light) / on_ground - 1.0).abs().max_element();
            println!("sun {sun_deg}, {extinction_per_m} 1/m: {error:.4}");
            assert!(error < limit, "{error}");
        }
    }
}

/// What lights add to frames in fog, against the library's lights in the same fog: with its phase function, that of Henyey and
/// Greenstein, and within the error that the shader functions state.
#[test]
fn lights_in_fog_are_those_of_the_library() {
    let gpu = Headless::new().unwrap();
    let (sun_deg, height_m) = (-12.0, 3.0);
    let sun = axes::direction(140.0, sun_deg);
    let mut renderer = renderer(&gpu, Preset::Clear, sun_deg, height_m);
    let lights = |eye: DVec3| {
        let at = |x: f64, y: f64, z: f64| DVec3::new(x, y, z) - eye;
        let down = DVec3::new(0.3, -1.0, 0.2);
        [
            Light::Point(PointLight::new(at(30.0, 8.0, -10.0), [1e4, 8e3, 5e3], 0.1).unwrap()),
            Light::Spot(
                SpotLight::new(at(60.0, 15.0, 20.0), down, [5e5, 5e5, 6e5], 0.3, 0.6, 0.2).unwrap(),
            ),
            Light::Sphere(SphereLight::new(at(25.0, 4.0, 15.0), 0.8, [3e4, 4e4, 6e4]).unwrap()),
        ]
    };
    let eye = DVec3::Y * height_m;
    let frame = Frame::towards(Vec3::X, SIDE);
    let distance_m = |x: u32, y: u32| match (x + y) % 2 {
        0 => f32::INFINITY,
        _ => 20.0 + ((3 * x + 7 * y) % 101) as f32,
    };
    let walls = Geometry {
        colour: [0.0; 3],
        distance_m: &distance_m,
    };
    let fog = valley_fog();
    renderer.set_fog(Some(fog.clone())).unwrap();
    renderer.update(height_m, sun).unwrap();
    let draw = |renderer: &mut SkyRenderer| draw(&gpu, renderer, &frame, 1.0, Some(&walls));
    let dark = draw(&mut renderer);
    let tables = renderer.work().tables;
    renderer.set_lights(&lights(eye)).unwrap();
    let lit = draw(&mut renderer);
    assert_eq!(renderer.work().tables, tables);
    let all = lights(DVec3::ZERO).to_vec();
    let right = RgbLightSet::new(all, &fog.layers, Ground::FLAT, LightSettings::default());
    let right = right.unwrap();
    let mut worst = (0.0, Vec3::ZERO);
    for k in 0..(SIDE * SIDE) as usize {
        let (x, y) = (k as u32 % SIDE, k as u32 / SIDE);
        let direction = frame.direction(x, y).as_dvec3().normalize();
        let to_ground_m = match direction.y < 0.0 {
            true => height_m / -direction.y,
            false => f64::INFINITY,
        };
        let want = right.path_radiance(&ViewRay {
            eye,
            direction,
            length_m: f64::from(distance_m(x, y)).min(to_ground_m),
        });
        for channel in 0..3 {
            let error = (lit[k][channel] - dark[k][channel]) / want[channel] - 1.0;
            if error.abs() > worst.0 {
                worst = (error.abs(), direction.as_vec3());
            }
        }
    }
    println!("{:.4} at {}", worst.0, worst.1);
    assert!(worst.0 < 0.003, "{worst:?}");
    renderer.set_lights(&[]).unwrap();
    assert_eq!(draw(&mut renderer), dark);
}

#[test]
fn the_sun_shines_where_it_is_and_only_there() {
    let gpu = Headless::new().unwrap();
    let (sun_deg, height_m) = (10.0, 2.0);
    let sun = axes::direction(140.0, sun_deg);
    let mut renderer = renderer(&gpu, Preset::Clear, sun_deg, height_m);
    renderer.update(height_m, sun).unwrap();
    let view = reference(Preset::Clear, sun_deg, height_m, sun);
    let right = view.sky().grid().to_xyz(&view.sun_disc_radiance(sun));
    let exposure = (1.0 / right[1]) as f32;
    // An odd side, so that the sun is in the middle of a pixel, which is smaller than the disc.
    let side = 401;
    let frame = Frame::towards(sun.as_vec3(), side);
    let pixels = draw(&gpu, &mut renderer, &frame, exposure, None);
    let luminance = |k: usize| RgbSpace::Srgb.luminance(pixels[k].map(f64::from));
    let middle = pixels.len() / 2;
    let pixel = 2.0 / f64::from(side);
    let across = sun.any_orthonormal_vector();
    let up = sun.cross(across);
    let place = |k: i32| (f64::from(k) - 4.0) / 9.0 * pixel;
    let parts = (0..81).map(|k| (sun + across * place(k % 9) + up * place(k / 9)).normalize());
    let disc = |part| view.sky().grid().to_xyz(&view.sun_disc_radiance(part))[1] / right[1];
    let error = luminance(middle) / (parts.map(disc).sum::<f64>() / 81.0) - 1.0;
    assert!(error.abs() < 0.02, "{error}");
    // Pixels are means over what they show of the disc, so that all of its light is in the frame.
    let radius = view.disc().angular_radius_rad;
    let mut sum = 0.0;
    for (k, _) in pixels.iter().enumerate() {
        let direction = frame.direction(k as u32 % side, k as u32 / side).as_dvec3();
        let away = direction.angle_between(sun);
        match away > radius + pixel {
            true => assert!(luminance(k) < 0.01, "{direction}"),
            false => sum += luminance(k) * pixel * pixel * away.cos().powi(3),
        }
        assert!(luminance(k) > 0.01 || away > radius - pixel, "{direction}");
    }
    let lighting = renderer.lighting().unwrap();
    let illuminance = lighting.sun_illuminance_lx.as_dvec3().to_array();
    let error = sum / (f64::from(exposure) * RgbSpace::Srgb.luminance(illuminance)) - 1.0;
    println!("light of the disc in the frame: {error:.4}");
    assert!(error.abs() < 0.02, "{error}");
}

/// Directions over the sphere, evenly, away from the horizon.
fn scattered() -> impl Iterator<Item = Vec3> {
    (0..400).map(|k| {
        let y = 1.0 - 2.0 * (f64::from(k) + 0.5) / 400.0;
        let (sin, cos) = (2.399_963_229_728_653 * f64::from(k)).sin_cos();
        let level = (1.0 - y * y).sqrt();
        DVec3::new(level * cos, y, level * sin).as_vec3()
    })
}

/// Mean reflected by a rough surface (GGX), by a sum over half vectors.
fn reflected(radiance: &dyn Fn(Vec3) -> Vec3, normal: Vec3, roughness: f32) -> Vec3 {
    const COUNT: u32 = 40_000;
    let across = normal.any_orthonormal_vector();
    let other = normal.cross(across);
    let squared = roughness.powi(4);
    let mut sum = (Vec3::ZERO, 0.0);
    for k in 0..COUNT {
        let u = (k as f32 + 0.5) / COUNT as f32;
        let cos = ((1.0 - u) / (1.0 + (squared - 1.0) * u)).sqrt();
        let azimuth = (2.399_963_229_728_653 * f64::from(k)) as f32;
        let level = across * azimuth.cos() + other * azimuth.sin();
        let half = level * (1.0 - cos * cos).max(0.0).sqrt() + normal * cos;
        let light = 2.0 * cos * half - normal;
        let weight = light.dot(normal).max(0.0);
        sum = (sum.0 + weight * radiance(light), sum.1 + weight);
    }
    sum.0 / sum.1
}

#[test]
fn an_environment_map_holds_what_surfaces_reflect() {
    let gpu = Headless::new().unwrap();
    let (sun_deg, height_m) = (35.0, 2.0);
    let sun = axes::direction(140.0, sun_deg);
    let mut renderer = renderer(&gpu, Preset::Clear, sun_deg, height_m);
    assert!(matches!(
        renderer.environment_map(100),
        Err(SkyRendererError::EnvironmentSide(100))
    ));
    renderer.update(height_m, sun).unwrap();
    let air = Preset::Clear.atmosphere();
    let fit = ColourFit::new(&air, SunCoverage::near(sun_deg, height_m)).unwrap();
    let view = renderer.sky().view(height_m, sun);
    let tables = SkyTables::new(&view, &fit, RgbSpace::Srgb).unwrap();
    let right = |d: Vec3| tables.rgb_radiance(d);
    let exposure = 1e-4;
    let mut map = renderer.environment_map(128).unwrap();
    assert_eq!(map.levels(), 5);
    let mut encoder = gpu.device.create_command_encoder(&Default::default());
    let recorded = renderer.record_environment(&mut encoder, &mut map, exposure);
    assert_eq!(recorded, Ok(()));
    for wrong in [f32::NAN, f32::INFINITY, -1.0] {
        let refused = renderer.record_environment(&mut encoder, &mut map, wrong);
        assert!(matches!(refused, Err(SkyRendererError::OutOfRange { .. })));
    }
    gpu.queue.submit([encoder.finish()]);
    let mean = right(Vec3::Y).y;
    let limits = [0.005, 0.015, 0.02, 0.03, 0.045];
    for (level, limit) in (0..map.levels()).zip(limits) {
        let roughness = level as f32 / 4.0;
        let directions: Vec<Vec3> = match level {
            // Texels across the horizon hold both sides.
            0 => scattered().filter(|d| d.y.abs() > 0.05).collect(),
            _ => scattered().step_by(25).collect(),
        };
        let got = sample_cube(&gpu, map.view(), &directions, level as f32);
        let errors = directions.iter().zip(got).map(|(&d, got)| {
            let want = match level {
                0 => right(d),
                _ => reflected(&right, d, roughness),
            };
            let error = (got / exposure - want).abs().max_element() / want.y.max(mean);
            (error, d)
        });
        let worst = errors.fold((0.0, Vec3::ZERO), |a, b| if b.0 > a.0 { b } else { a });
        println!("level {level}: {:.4} at {}", worst.0, worst.1);
        assert!(worst.0 < limit, "level {level}: {worst:?}");
    }
}

#[test]
fn the_example_that_adds_a_sky_is_short() {
    let lines = include_str!("../../examples/add_sky.rs").lines().count();
    assert!(lines <= 60, "{lines} lines");
}

#[test]
fn wrong_inputs_are_errors() {
    let gpu = Headless::new().unwrap();
    let air = Preset::Clear.atmosphere();
    let wrong = SkyRendererSettings::new(wgpu::TextureFormat::R32Uint);
    let error = SkyRenderer::new(&gpu.device, &gpu.queue, &air, &wrong).unwrap_err();
    assert!(matches!(error, SkyRendererError::Format(_)), "{error}");
    let mut renderer = renderer(&gpu, Preset::Clear, 30.0, 2.0);
    let up = DVec3::Y;
    for height_m in [f64::NAN, f64::INFINITY, f64::NEG_INFINITY] {
        assert!(matches!(
            renderer.update(height_m, up),
            Err(SkyRendererError::Height(_))
        ));
        assert!(matches!(
            renderer.update_in_background(height_m, up),
            Err(SkyRendererError::Height(_))
        ));
    }
    let sun = SunState::from(axes::direction(140.0, 30.0));
    for distance_ratio in [f64::NAN, f64::INFINITY, 0.0, -1.0] {
        let sun = sun.at_distance_ratio(distance_ratio);
        let refused = renderer.update(2.0, sun);
        assert!(matches!(refused, Err(SkyRendererError::Source { .. })));
        let refused = renderer.set_second_source(Some(sun.into()));
        assert!(matches!(refused, Err(SkyRendererError::Source { .. })));
    }
    let moon = MoonState::lit_by(axes::direction(20.0, 35.0), sun.direction);
    let spoil: [fn(&mut MoonState); 3] = [
        |moon| moon.distance_m = f64::NAN,
        |moon| moon.sun_distance_m = -1.0,
        |moon| moon.phase_angle_rad = 4.0,
    ];
    for spoil in spoil {
        let mut wrong = moon;
        spoil(&mut wrong);
        let refused = renderer.set_second_source(Some(wrong.into()));
        assert!(matches!(refused, Err(SkyRendererError::Source { .. })));
    }
    for wrong in [f32::NAN, f32::INFINITY, -0.1] {
        let mut fogs = [valley_fog(), valley_fog(), valley_fog()];
        fogs[0].layers[0].extinction_per_m[1] = wrong;
        fogs[1].layers[0].single_scattering_albedo[2] = wrong;
        fogs[2].ground_albedo[0] = wrong;
        for fog in fogs {
            let refused = renderer.set_fog(Some(fog));
            assert!(matches!(refused, Err(SkyRendererError::Fog(_))), "{wrong}");
        }
    }
    for ground_height_m in [f64::NAN, f64::INFINITY] {
        let fog = Fog {
            ground_height_m,
            ..valley_fog()
        };
        let refused = renderer.set_fog(Some(fog));
        assert!(matches!(refused, Err(SkyRendererError::Fog(_))));
    }
    for visibility_m in [f64::NAN, 0.0, -300.0] {
        let refused = renderer.set_fog(Some(Fog::new(visibility_m, 20.0)));
        assert!(
            matches!(refused, Err(SkyRendererError::Fog(_))),
            "{visibility_m}"
        );
    }
    // Air that cannot be solved for is refused in the background, too, and frames go on in the air before.
    let mut wrong_air = air.clone();
    wrong_air.planet.radius_m = f64::NAN;
    let refused = renderer.set_atmosphere(&wrong_air);
    assert!(matches!(refused, Err(SkyRendererError::Sky(_))));
    renderer.set_atmosphere_in_background(&wrong_air).unwrap();
    let refused = loop {
        match renderer.update_in_background(2.0, up) {
            Ok(_) => std::thread::yield_now(),
            Err(error) => break error,
        }
    };
    assert!(matches!(refused, SkyRendererError::Sky(_)), "{refused}");
    renderer.update(2.0, up).unwrap();
    assert_eq!(*renderer.sky().atmosphere(), air);
    let mut fog = valley_fog();
    for density in [DensityProfile::StandardAir1976, DensityProfile::Uniform] {
        fog.layers[0].density = density;
        assert!(matches!(
            renderer.set_fog(Some(fog.clone())),
            Err(SkyRendererError::FogProfile)
        ));
    }
    let light = PointLight::new(DVec3::new(30.0, 2.0, 0.0), [1e3; 3], 0.1).unwrap();
    let light = Light::Point(light);
    let many = renderer.set_lights(&[light; 17]);
    assert!(matches!(
        many,
        Err(SkyRendererError::TooManyLights { count: 17, .. })
    ));
    let invalid = Light::Point(PointLight {
        position: DVec3::NAN,
        intensity: [1e3; 3],
        radius_m: 0.1,
    });
    assert!(matches!(
        renderer.set_lights(&[invalid]),
        Err(SkyRendererError::Fog(_))
    ));
    renderer.set_lights(&[light]).unwrap();
    fog.layers[0].density = DensityProfile::Layer {
        bottom_m: 0.0,
        top_m: 50.0,
    };
    assert!(matches!(
        renderer.set_fog(Some(fog.clone())),
        Err(SkyRendererError::LightProfile)
    ));
    // Lights in two layers, of which the second has the profile of the first or another one.
    fog = valley_fog();
    for height_m in [30.0, 50.0] {
        fog.layers.truncate(1);
        fog.layers.push(RgbLayer {
            density: DensityProfile::exponential(height_m),
            ..fog.layers[0].clone()
        });
        assert_eq!(
            renderer.set_fog(Some(fog.clone())),
            Err(SkyRendererError::LightProfile)
        );
    }
    renderer.set_lights(&[]).unwrap();
    let layer = |top_m| RgbLayer {
        density: DensityProfile::Layer {
            bottom_m: 0.0,
            top_m,
        },
        ..fog.layers[0].clone()
    };
    for (tops_m, count) in [
        (&[][..], 0),
        (&[10.0, 20.0, 30.0, 40.0, 50.0], 5),
        (&[10.0, 20.0, 30.0, 40.0, 40.0], 4),
    ] {
        let fog = Fog {
            layers: tops_m.iter().copied().map(layer).collect(),
            ..fog.clone()
        };
        let most = MOST_FOG_LAYERS;
        let right = match count {
            1..=4 => Ok(()),
            count => Err(SkyRendererError::FogLayers { count, most }),
        };
        assert_eq!(renderer.set_fog(Some(fog)), right);
    }
    fog.layers[1].density = DensityProfile::exponential(-30.0);
    assert!(matches!(
        renderer.set_fog(Some(fog)),
        Err(SkyRendererError::Fog(_))
    ));
    let none = renderer.update(2.0, DVec3::ZERO);
    assert!(matches!(none, Err(SkyRendererError::Sun(_))));
    let none = renderer.set_second_source(Some(DVec3::NAN.into()));
    assert!(matches!(none, Err(SkyRendererError::Sun(_))));
}
