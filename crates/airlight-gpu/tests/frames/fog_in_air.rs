//! Frames of fog in air, against the library's sky with fog: light of sun and sky at the top of the fog, air and fog in their order along
//! each ray, and the ground below the fog.

use super::{SIDE, draw, reference, renderer};
use airlight::atmosphere::{Constituent, DensityProfile, Preset};
use airlight::axes;
use airlight::fog::droplets::Droplets;
use airlight::fog::{FogScattering, RgbLayer};
use airlight::glam::DVec3;
use airlight::scene::RgbFoggySky;
use airlight::spectrum::RgbSpace;
use airlight_gpu::Fog;
use airlight_gpu::headless::{Frame, Geometry, Headless};

/// A layer of fog, of radiation fog's droplets or others, over a ground of the planet's albedo, as the solver has it.
fn layer(extinction_per_m: f64, profile: DensityProfile, droplets: Droplets) -> Constituent {
    Constituent::fog(extinction_per_m, droplets.into(), profile, &[]).unwrap()
}

/// Errors of luminance relative to it: root mean square and largest.
fn errors(pairs: impl Iterator<Item = ([f32; 3], [f32; 3])>) -> [f64; 2] {
    let luminance = |rgb: [f32; 3]| RgbSpace::Srgb.luminance(rgb.map(f64::from));
    let (mut squares, mut worst, mut count) = (0.0, 0.0f64, 0.0);
    for (got, right) in pairs {
        let error = luminance(got) / luminance(right) - 1.0;
        squares += error * error;
        worst = worst.max(error.abs());
        count += 1.0;
    }
    [(squares / count).sqrt(), worst]
}

/// Compares frames of an eye at a height in fog with the library; false where they differ by more than 1 % rms, or 5 %.
fn is_as_the_library_has_it(
    gpu: &Headless,
    sun_deg: f64,
    height_m: f64,
    layers: &[Constituent],
) -> bool {
    let air = Preset::Average;
    let mut all_are_right = true;
    let sun = axes::direction(140.0, sun_deg);
    let view = reference(air, sun_deg, height_m, sun);
    let right = RgbFoggySky::new(&view, layers, FogScattering::Multiple, RgbSpace::Srgb);
    let right = right.unwrap();
    let albedo = &air.atmosphere().planet.ground_albedo;
    let in_rgb = |layer| RgbLayer::from_constituent(layer, RgbSpace::Srgb).unwrap();
    let fog = Fog {
        layers: layers.iter().map(in_rgb).collect(),
        ground_height_m: 0.0,
        ground_albedo: [albedo.at(550.0) as f32; 3],
    };
    let mut renderer = renderer(gpu, air, sun_deg, height_m);
    renderer.set_fog(Some(fog)).unwrap();
    renderer.update(height_m, sun).unwrap();
    let exposure = 1e-4;
    let mut all = Vec::new();
    for (azimuth, elevation) in [(100.0, 5.0), (320.0, -5.0)] {
        let frame = Frame::towards(axes::direction(azimuth, elevation).as_vec3(), SIDE / 2);
        let distance_m = |x: u32, y: u32| match (x + y) % 2 {
            0 => f32::INFINITY,
            _ => 30.0 * 1000f32.powf(((5 * x + 3 * y) % 31) as f32 / 30.0),
        };
        let walls = Geometry {
            colour: [0.0; 3],
            distance_m: &distance_m,
        };
        let pixels = draw(gpu, &mut renderer, &frame, exposure, Some(&walls));
        for (k, got) in pixels.into_iter().enumerate() {
            let (x, y) = (k as u32 % frame.side, k as u32 / frame.side);
            let direction: DVec3 = frame.direction(x, y).as_dvec3().normalize();
            let to_ground_m = right.ground_distance_m(direction);
            let wall_m = f64::from(distance_m(x, y));
            let from_horizon = direction.y.asin() - view.horizon_elevation_rad();
            let is_behind =
                to_ground_m.is_some_and(|ground_m| wall_m.is_finite() && wall_m > ground_m);
            if from_horizon.abs() < 0.01 || is_behind || direction.angle_between(sun) < 0.02 {
                continue;
            }
            let kind = match (wall_m.is_finite(), to_ground_m.is_some()) {
                (true, _) => 2,
                (false, true) => 1,
                (false, false) => 0,
            };
            let right = match wall_m.is_finite() {
                true => right.path(direction, wall_m).path_radiance,
                false => right.radiance(direction),
            };
            all.push((kind, (got.map(|v| v / exposure), right)));
        }
    }
    println!("sun {sun_deg}, eye {height_m} m:");
    for (kind, name) in ["sky", "ground", "walls"].into_iter().enumerate() {
        let of_kind = all.iter().filter(|(of, _)| *of == kind);
        let [rms, worst] = errors(of_kind.map(|(_, pair)| *pair));
        println!("  {name}: {rms:.4}, worst {worst:.4}");
        all_are_right &= rms < 0.01 && worst < 0.05;
    }
    all_are_right
}

/// Radiation fog around the eye, valley fog from a hill, and mist as deep as haze.
#[test]
fn fog_lies_in_the_air_as_the_library_has_it() {
    let gpu = Headless::new().unwrap();
    let mut all_are_right = true;
    for (sun_deg, height_m, extinction_per_m, scale_height_m) in [
        (30.0, 2.0, 0.01, 30.0),
        (8.0, 400.0, 0.008, 80.0),
        (8.0, 2.0, 0.0006, 400.0),
        (40.0, 1500.0, 0.0006, 400.0),
    ] {
        println!("{extinction_per_m} 1/m, {scale_height_m} m:");
        let profile = DensityProfile::exponential(scale_height_m);
        let fog = layer(extinction_per_m, profile, Droplets::default());
        all_are_right &= is_as_the_library_has_it(&gpu, sun_deg, height_m, &[fog]);
    }
    assert!(all_are_right);
}

/// Ground mist under a raised layer of other droplets, from below, between and above.
#[test]
fn layers_lie_in_the_air_as_the_library_has_them() {
    let gpu = Headless::new().unwrap();
    let mist = layer(0.01, DensityProfile::exponential(8.0), Droplets::default());
    let raised = DensityProfile::Layer {
        bottom_m: 80.0,
        top_m: 140.0,
    };
    let layers = [mist, layer(0.01, raised, Droplets::Advection)];
    let mut all_are_right = true;
    for (sun_deg, height_m) in [
        (30.0, 2.0),
        (30.0, 50.0),
        (8.0, 110.0),
        (30.0, 300.0),
        (8.0, 300.0),
    ] {
        all_are_right &= is_as_the_library_has_it(&gpu, sun_deg, height_m, &layers);
    }
    assert!(all_are_right);
}

#[test]
fn without_its_fog_a_frame_is_clear() {
    let gpu = Headless::new().unwrap();
    let sun = axes::direction(140.0, 30.0);
    let mut renderer = renderer(&gpu, Preset::Clear, 30.0, 2.0);
    let frame = Frame::towards(axes::direction(120.0, 0.0).as_vec3(), 16);
    let mut drawn = |fog: Option<Fog>| {
        renderer.set_fog(fog).unwrap();
        renderer.update(2.0, sun).unwrap();
        let pixels = draw(&gpu, &mut renderer, &frame, 1e-4, None);
        (pixels, renderer.work().tables)
    };
    let (clear, first) = drawn(None);
    let (foggy, second) = drawn(Some(super::valley_fog()));
    assert!(clear != foggy);
    let (again, third) = drawn(None);
    assert!(clear == again);
    assert_eq!([first, second, third], [1, 2, 3]);
}
