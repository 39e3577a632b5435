use super::*;
use airlight::fog::{DensityProfile, FogLighting, FogScattering, Ground, RgbFog, RgbLayer};
use airlight::optics::PhaseFunction;
use airlight_image::input::{LightReference, SampleBits};

fn picture(width: u32, height: u32, rgb: impl Fn(u32, u32) -> [f32; 3]) -> Picture {
    let size = Size::new(width, height).unwrap();
    let pixels = (0..height).flat_map(|y| (0..width).map(move |x| (x, y)));
    let rgb = pixels.flat_map(|(x, y)| rgb(x, y)).collect();
    Picture::new(size, rgb, LightReference::Display, SampleBits::U8)
}

fn depth(width: u32, height: u32, metres: impl Fn(u32, u32) -> f32) -> DepthMap {
    let pixels = (0..height).flat_map(|y| (0..width).map(move |x| (x, y)));
    let size = Size::new(width, height).unwrap();
    let metres = pixels.map(|(x, y)| metres(x, y)).collect();
    DepthMap::new(size, metres, DepthKind::Z)
}

fn uniform_layer(extinction: f32, albedo: f32) -> RgbLayer {
    RgbLayer {
        density: DensityProfile::Uniform,
        extinction_per_m: [extinction; 3],
        single_scattering_albedo: [albedo; 3],
        phase: PhaseFunction::Isotropic,
    }
}

fn fog(layers: &[RgbLayer], ambient: [f32; 3]) -> FogSource {
    let lighting = FogLighting {
        sun: None,
        ambient,
        ground_albedo: [0.0; 3],
    };
    let fog = RgbFog::new(layers, Ground::FLAT, &lighting, FogScattering::Single);
    FogSource::Alone(fog.unwrap())
}

fn uniform(extinction: f32, ambient: [f32; 3]) -> FogOverlay {
    FogOverlay::Fog(fog(&[uniform_layer(extinction, 1.0)], ambient), None)
}

#[test]
fn depth_along_the_axis_becomes_distance_along_the_ray() {
    let (picture, depth) = (
        picture(9, 5, |_, _| [0.2, 0.4, 0.6]),
        depth(9, 5, |_, _| 10.0),
    );
    let camera = Intrinsics::from_horizontal_fov(picture.size, 90.0).unwrap();
    let overlay = uniform(0.05, [0.8, 0.8, 0.9]);
    let overlay = Overlay::new(&picture, &depth, &camera, 1.6, &overlay, Channels::Layers).unwrap();
    let mut row = vec![0.0; 9 * overlay.channels()];
    overlay.fill_row(2, &mut row);
    for i in 0..9u32 {
        let pixel = &row[10 * i as usize..][..10];
        let distance = 10.0 * camera.ray_length_per_z(i, 2);
        let t = (-0.05 * distance).exp();
        assert_eq!(pixel[9], 10.0);
        assert!((f64::from(pixel[3]) - t).abs() < 1e-5);
        assert!((f64::from(pixel[0]) - (0.2 * t + 0.8 * (1.0 - t))).abs() < 1e-5);
        assert!((f64::from(pixel[8]) - 0.9 * (1.0 - t)).abs() < 1e-5);
    }
}

#[test]
fn sky_in_thick_fog_is_ambient_and_encoded_blending_differs() {
    let picture = picture(4, 4, |_, _| [0.1, 0.1, 0.1]);
    let depth = depth(4, 4, |_, y| if y < 2 { f32::INFINITY } else { 20.0 });
    let camera = Intrinsics::from_horizontal_fov(picture.size, 60.0).unwrap();
    let colour = [0.8; 3];
    let light = uniform(0.03, colour);
    let encoded = FogOverlay::Encoded(0.03, colour);
    let shown = |overlay: &FogOverlay, y: u32| {
        let overlay =
            Overlay::new(&picture, &depth, &camera, 1.6, overlay, Channels::Picture).unwrap();
        let mut row = vec![0.0; 12];
        overlay.fill_row(y, &mut row);
        row[4]
    };
    assert!((shown(&light, 0) - 0.8).abs() < 1e-6 && (shown(&encoded, 0) - 0.8).abs() < 1e-5);
    // Blending encoded values keeps dark colours darker.
    assert!(shown(&encoded, 3) < shown(&light, 3) - 0.03);
}

#[test]
fn ambient_is_estimated_from_sky_or_dark_channel() {
    let bright = |x: u32, y: u32| match (x, y) {
        (_, 0..=9) => [0.5, 0.6, 0.8],
        (20..=39, 20..=39) => [0.9, 0.8, 0.7],
        _ => [0.1, 0.05, 0.02],
    };
    let picture = picture(60, 60, bright);
    let sky = depth(60, 60, |_, y| if y < 10 { f32::INFINITY } else { 5.0 });
    let (colour, how) = estimate_ambient(&picture, &sky);
    assert_eq!(how, Ambient::Sky);
    assert!((colour[2] - 0.8).abs() < 1e-6);
    let (colour, how) = estimate_ambient(&picture, &depth(60, 60, |_, _| 5.0));
    assert_eq!(how, Ambient::DarkChannel);
    assert!((colour[0] - 0.9).abs() < 1e-6, "{colour:?}");
}

#[test]
fn fog_covers_opaque_pixels_only() {
    // Colours of linear files are premultiplied by opacity.
    let mut half = picture(3, 1, |x, _| match x {
        0 => [0.4; 3],
        1 => [0.2; 3],
        _ => [0.0; 3],
    });
    half.reference = LightReference::Scene;
    half.alpha = Some(vec![1.0, 0.5, 0.0]);
    let depth = depth(3, 1, |_, _| 20.0);
    let camera = Intrinsics::from_horizontal_fov(half.size, 1.0).unwrap();
    for overlay in [uniform(0.03, [0.8; 3]), FogOverlay::Encoded(0.03, [0.8; 3])] {
        for channels in [Channels::Picture, Channels::Layers] {
            let overlay = Overlay::new(&half, &depth, &camera, 1.6, &overlay, channels).unwrap();
            let names = overlay.channel_names();
            assert_eq!(names.len(), overlay.channels());
            assert_eq!(names.last().map(String::as_str), Some("A"));
            let mut row = vec![0.0; 3 * names.len()];
            overlay.fill_row(0, &mut row);
            let pixel = |i: usize| &row[i * names.len()..][..names.len()];
            assert!((pixel(1)[0] - 0.5 * pixel(0)[0]).abs() < 1e-4, "{row:?}");
            assert_eq!(pixel(2)[0], 0.0, "transparent pixels stay black");
            let opacities = [0, 1, 2].map(|i| pixel(i)[names.len() - 1]);
            assert_eq!(opacities, [1.0, 0.5, 0.0]);
        }
    }
}

#[test]
fn sun_clouds_and_edges_do_not_affect_the_ambient() {
    let horizon = [0.5f32, 0.6, 0.8];
    // Hills whose edge is mixed with the sky over two pixels, sky that darkens upwards from them.
    let (width, height) = (120u32, 60u32);
    let edge = |x: u32| 38 + (x * 7) % 5;
    let near = |x: u32, y: u32| if y <= edge(x) { f32::INFINITY } else { 50.0 };
    let depth = depth(width, height, near);
    let sky = |x: u32, y: u32| -> f32 {
        match edge(x).saturating_sub(y) {
            0 => 0.3,
            1 => 0.7,
            up => 1.0 - 0.002 * up as f32,
        }
    };
    let sun = |x: u32, y: u32| {
        let away = (f64::from(x) - 20.0).hypot(f64::from(y) - 30.0);
        1.0 + 6.0 * (-(away / 15.0).powi(2)).exp() as f32
    };
    let cloud = |x: u32| if x > 85 { 0.5 } else { 1.0 };
    let plain = |_: u32, _: u32| 1.0f32;
    let shining: [&dyn Fn(u32, u32) -> f32; 4] =
        [&plain, &sun, &|x, _| cloud(x), &|x, y| sun(x, y) * cloud(x)];
    for (case, factor) in shining.into_iter().enumerate() {
        let picture = picture(width, height, |x, y| match y <= edge(x) {
            true => horizon.map(|c| c * sky(x, y) * factor(x, y)),
            false => [0.05, 0.06, 0.03],
        });
        let (colour, how) = estimate_ambient(&picture, &depth);
        assert_eq!(how, Ambient::Sky);
        for lane in 0..3 {
            let off = colour[lane] / horizon[lane] - 1.0;
            assert!(off.abs() < 0.02, "case {case}, lane {lane}: {off}");
        }
    }
    // Gaps in a hedge, whose pixels are all near an edge, are not used as sky.
    let hedge = self::depth(width, height, |x, y| match (x % 4, y % 3) {
        (0, 0) => f32::INFINITY,
        _ => 9.0,
    });
    let picture = picture(width, height, |_, _| [0.3; 3]);
    assert_eq!(horizon_pixels(&picture, &hedge), None);
    assert_eq!(estimate_ambient(&picture, &hedge).1, Ambient::DarkChannel);
}

#[test]
fn a_point_light_glows_in_front_of_objects() {
    use airlight::fog::lights::{
        Light, LightRayGeometry, LightSettings, PointLight, RgbLightSet, airlight_isotropic,
    };
    let (picture, depth) = (
        picture(9, 5, |_, _| [0.0; 3]),
        depth(9, 5, |x, _| if x < 4 { 6.0 } else { f32::INFINITY }),
    );
    let camera = Intrinsics::from_horizontal_fov(picture.size, 60.0).unwrap();
    // Half of the fog in each of two layers.
    let (whole, half) = (uniform_layer(0.05, 0.8), uniform_layer(0.025, 0.8));
    let halves = [half.clone(), half];
    let at = DVec3::new(-1.0, 2.5, -5.0);
    let light = Light::Point(PointLight::new(at, [3.0, 2.0, 1.0], 0.01).unwrap());
    for layers in [&[whole][..], &halves[..]] {
        let settings = LightSettings::default();
        let lights = RgbLightSet::new(vec![light], layers, Ground::FLAT, settings).unwrap();
        let overlay = FogOverlay::Fog(fog(layers, [0.0; 3]), Some(lights));
        let overlay =
            Overlay::new(&picture, &depth, &camera, 1.6, &overlay, Channels::Picture).unwrap();
        let mut row = vec![0.0; 27];
        overlay.fill_row(1, &mut row);
        for x in 0..9 {
            let (direction, length) = (camera.pixel_direction(x, 1), camera.ray_length_per_z(x, 1));
            let length_m = if x < 4 { 6.0 * length } else { f64::INFINITY };
            let geometry = LightRayGeometry::new(DVec3::Y * 1.6, direction, length_m, at, 0.01);
            let exact = 0.05 * 0.8 * airlight_isotropic(&geometry, 0.05);
            let seen = &row[3 * x as usize..][..3];
            for (lane, intensity) in [3.0, 2.0, 1.0].into_iter().enumerate() {
                let off = f64::from(seen[lane]) / (intensity * exact) - 1.0;
                assert!(off.abs() < 2e-5, "{x}, {lane}: {off}");
            }
        }
    }
}

/// A table of factors against the ray of each pixel on its own, in light that leaves the fog as it is.
#[test]
fn tables_of_patches_match_single_rays() {
    use airlight::fog::FogPatches;
    use airlight::fog::droplets::DropletKind;
    use airlight::scene::{FogLayer, FogLayers};

    let (width, height) = (640, 360);
    let picture = picture(width, height, |_, _| [0.0; 3]);
    // Ground, walls between 10 and 250 m, and sky.
    let depth = depth(width, height, |x, y| match y {
        0..60 => f32::INFINITY,
        60..240 => 10.0 + 30.0 * (x / 80) as f32,
        _ => 500.0 / (y as f32 - 180.0),
    });
    let camera = Intrinsics::from_horizontal_fov(picture.size, 70.0).unwrap();
    let overlay = uniform(0.03, [1.0; 3]);
    let layer = FogLayer {
        profile: DensityProfile::Uniform,
        droplets: DropletKind::Isotropic,
        extinction_per_m: 0.03,
    };
    let fog = |strength| FogLayers {
        layers: vec![layer.clone()],
        scattering: FogScattering::Single,
        patches: Some(FogPatches {
            strength,
            ..FogPatches::default()
        }),
    };
    let shown = |fog: &FogLayers| {
        let even =
            Overlay::new(&picture, &depth, &camera, 1.6, &overlay, Channels::Layers).unwrap();
        let patchy = even.with_patches(fog).unwrap();
        let mut rows = vec![0.0; (width * height * 10) as usize];
        for (y, row) in rows.chunks_exact_mut(width as usize * 10).enumerate() {
            patchy.fill_row(y as u32, row);
        }
        rows
    };
    let strong = fog(0.8);
    let rows = shown(&strong);
    let view = strong
        .patches_seen_from(1.6, f64::INFINITY, 0.0)
        .unwrap()
        .unwrap();
    let (mut squares, mut worst, mut count) = (0.0, 0.0f64, 0.0);
    for y in (0..height).step_by(7) {
        for x in (0..width).step_by(11) {
            let pixel = &rows[10 * (y * width + x) as usize..][..10];
            let distance_m = f64::from(pixel[9]) * camera.ray_length_per_z(x, y);
            let seen = f64::from(pixel[3]);
            let factor = view.factor(camera.pixel_direction(x, y), distance_m);
            let right = (-0.03 * distance_m * factor).exp();
            let off = (seen - right).abs();
            squares += off * off;
            worst = worst.max(off);
            count += 1.0;
            // The fog has its colour.
            assert!((f64::from(pixel[6]) - (1.0 - seen)).abs() < 1e-5);
        }
    }
    let rms = f64::sqrt(squares / count);
    assert!(rms < 0.003 && worst < 0.025, "{rms} {worst}");
    // The picture alone is computed by rows, with the factor on the distance.
    let alone = Overlay::new(&picture, &depth, &camera, 1.6, &overlay, Channels::Picture).unwrap();
    let alone = alone.with_patches(&strong).unwrap();
    assert!(alone.even_fog().is_some());
    for y in [10, 130, 300] {
        let mut row = vec![0.0; (width * 3) as usize];
        alone.fill_row(y, &mut row);
        let pixels = rows[10 * (y * width) as usize..].as_chunks::<10>().0;
        for (alone, pixel) in row.as_chunks::<3>().0.iter().zip(pixels) {
            for (a, b) in alone.iter().zip(pixel) {
                assert!((a - b).abs() < 1e-5, "{y}: {alone:?} {pixel:?}");
            }
        }
    }
    // Patches without strength are even fog, to the rounding of exponentials.
    let flat = shown(&fog(0.0));
    let mut row = vec![0.0; (width * 10) as usize];
    let even = Overlay::new(&picture, &depth, &camera, 1.6, &overlay, Channels::Layers).unwrap();
    even.fill_row(300, &mut row);
    for (a, b) in row.iter().zip(&flat[300 * row.len()..]) {
        assert!((a - b).abs() < 1e-5, "{a} {b}");
    }
}
