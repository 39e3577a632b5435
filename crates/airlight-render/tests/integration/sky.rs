//! Fog lit by a solved sky.

use super::common::{depth, layers, picture};
use airlight::models::registry;
use airlight::scene::Channels;
use airlight::sky::{Sky, SkySettings, SunCoverage, TableChannels};
use airlight::spectrum::RgbSpace;
use airlight_image::input::Picture;
use airlight_image::{Control, Size};
use airlight_render::overlay::{
    ExistingAerial, LightLevelSource, OverlayImage, OverlayScene, PreparedOverlay,
};

const SIZE: (u32, u32) = (64, 32);

/// A camera low over the horizon, away from a sun at 15 degrees, in height fog.
fn outdoors(visibility_m: f64) -> OverlayScene {
    let mut scene = OverlayScene::default();
    scene.overlay.sky_light = true;
    scene.overlay.layers = true;
    scene.scene.solver.wavelengths = Some("rgb".to_owned());
    scene.scene.sun.elevation_deg = Some(15.0);
    scene.scene.sun.azimuth_deg = Some(90.0);
    scene.scene.camera.fov_deg = Some(6.0);
    scene.scene.camera.azimuth_deg = Some(40.0);
    scene.scene.camera.elevation_deg = Some(1.6);
    scene.scene.observer.eye_height_m = Some(2.0);
    scene.fog_mut().visibility_m = Some(visibility_m);
    scene
}

/// The clear sky that the scene's camera sees, in cd/m^2 times a scale.
fn drawn_sky(scene: &OverlayScene, scale: f32) -> Picture {
    let mut clear = scene.scene.clone();
    clear.fog = None;
    clear.observer.altitude_m = Some(2.0);
    let resolved = clear.resolve().unwrap();
    let sun = resolved.sun.at_start().unwrap();
    let suns = SunCoverage::near(sun.elevation_deg, 2.0);
    let settings = SkySettings {
        suns,
        ..SkySettings::default()
    };
    let sky = Sky::prepare(&resolved.atmosphere, &resolved.grid, &settings).unwrap();
    let view = sky.view(2.0, sun.state().direction);
    let table = view.table(TableChannels::Rgb(RgbSpace::Srgb));
    let camera = scene
        .camera(Size::new(SIZE.0, SIZE.1).unwrap(), 1.0)
        .unwrap();
    picture(SIZE, |x, y| {
        let mut rgb = [0.0; 3];
        table.sample(camera.pixel_direction(x, y), &mut rgb);
        rgb.map(|v| v * scale)
    })
}

/// The right half hidden by a wall 200 km away that reflects no light.
#[test]
fn the_air_before_far_objects_converges_to_the_drawn_sky() {
    for (visibility_m, top_m, scale_height_m) in [(1e9, Some(3.0), None), (20e3, None, Some(300.0))]
    {
        let mut scene = outdoors(visibility_m);
        scene.fog_mut().top_m = top_m;
        scene.fog_mut().scale_height_m = scale_height_m;
        scene.overlay.radiance_scale = Some(1.0);
        scene.overlay.air = ExistingAerial::Missing;
        let mut sky = drawn_sky(&scene, 1.0);
        for (i, rgb) in sky.rgb.as_chunks_mut::<3>().0.iter_mut().enumerate() {
            if i % 64 >= 32 {
                *rgb = [0.0; 3];
            }
        }
        let wall = depth(SIZE, |x, _| if x < 32 { f32::INFINITY } else { 200e3 });
        let image = OverlayImage::new(&scene.overlay, sky, wall).unwrap();
        let seen = layers(&scene, &image);
        // Up to 2 degrees, where 200 km away there is hardly any air left.
        for y in 13..29 {
            let [left, right] = [seen.rgb(31, y), seen.rgb(32, y)];
            for lane in 0..3 {
                let off = right[lane] / left[lane] - 1.0;
                assert!(
                    off.abs() < 0.015,
                    "{visibility_m}, row {y}: {left:?} {right:?}"
                );
            }
        }
    }
}

#[test]
fn fog_is_as_bright_as_the_picture_says() {
    let mut scene = outdoors(500.0);
    scene.fog_mut().scale_height_m = Some(40.0);
    let sky = scene.solve_sky().unwrap().unwrap();
    let fogged = |scene: &OverlayScene, scale: f32, white: Option<f32>| {
        let mut clear = drawn_sky(scene, scale);
        clear.white_luminance_cd_m2 = white;
        let far = depth(SIZE, |_, _| f32::INFINITY);
        let image = OverlayImage::new(&scene.overlay, clear, far).unwrap();
        let prepared = PreparedOverlay::new(scene, &image, Some(&sky)).unwrap();
        let seen = super::common::Layers::of(&prepared.overlay(&image).unwrap());
        let clear = &image.picture.rgb[3 * (12 * 64 + 30)..][..3];
        (
            seen.rgb(30, 12),
            prepared.level.source,
            [clear[0], clear[1], clear[2]],
        )
    };
    let (full, source, clear) = fogged(&scene, 1.0, Some(1.0));
    assert_eq!(source, LightLevelSource::FileWhite);
    assert!(
        (full[0] / clear[0] - 1.0).abs() > 0.05,
        "the fog is visible: {full:?} {clear:?}"
    );
    let mut given = scene.clone();
    given.overlay.radiance_scale = Some(1e-4);
    for (scene, white, expected, limit) in [
        (&scene, Some(1e4), LightLevelSource::FileWhite, 1e-5),
        (&given, None, LightLevelSource::RadianceScale, 1e-5),
        (&scene, None, LightLevelSource::MatchedSky, 1e-3),
    ] {
        let (seen, source, _) = fogged(scene, 1e-4, white);
        assert_eq!(source, expected);
        for lane in 0..3 {
            let off = seen[lane] / (1e-4 * full[lane]) - 1.0;
            assert!(off.abs() < limit, "{source}: {seen:?} {full:?}");
        }
    }
}

#[test]
fn skies_at_dusk_and_at_places_light_fog_in_photographs() {
    let size = (40, 30);
    let photo = picture(size, |_, y| match y {
        0..12 => [0.40, 0.51, 0.72],
        _ => [0.045, 0.061, 0.021],
    });
    let far = depth(size, |_, y| if y < 12 { f32::INFINITY } else { 60.0 });
    let base = |set: fn(&mut OverlayScene)| {
        let mut scene = OverlayScene::default();
        scene.overlay.layers = true;
        scene.overlay.sky_light = true;
        scene.scene.solver.wavelengths = Some("rgb".to_owned());
        scene.fog_mut().visibility_m = Some(80.0);
        scene.fog_mut().top_m = Some(50.0);
        set(&mut scene);
        scene
    };
    for (scene, source) in [
        (
            base(|s| s.scene.sun.elevation_deg = Some(40.0)),
            LightLevelSource::MatchedSky,
        ),
        (
            base(|s| {
                s.scene.sun.elevation_deg = Some(-4.0);
                s.scene.air.atmosphere = Some("clear".to_owned());
            }),
            LightLevelSource::MatchedSky,
        ),
        (
            base(|s| {
                s.scene.sun.latitude_deg = Some(48.85);
                s.scene.sun.longitude_deg = Some(2.29);
                s.scene.sun.time = Some("2026-06-21T19:15:00Z".to_owned());
                s.scene.air.aod_550 = Some(0.3);
            }),
            LightLevelSource::MatchedSky,
        ),
        (
            base(|s| {
                s.scene.sun.elevation_deg = Some(40.0);
                s.overlay.ambient = Some([0.4; 3]);
            }),
            LightLevelSource::MatchedAmbient,
        ),
        (
            base(|s| {
                s.scene.sun.elevation_deg = Some(40.0);
                s.fog_mut().top_m = Some(30.0);
                s.scene.air.ground_altitude_m = Some(900.0);
            }),
            LightLevelSource::MatchedSky,
        ),
    ] {
        scene.check().unwrap();
        let image = OverlayImage::new(&scene.overlay, photo.clone(), far.clone()).unwrap();
        let sky = scene.solve_sky().unwrap().unwrap();
        let prepared = PreparedOverlay::new(&scene, &image, Some(&sky)).unwrap();
        assert_eq!(prepared.level.source, source);
        let seen = super::common::Layers::of(&prepared.overlay(&image).unwrap());
        let [_, _, blue] = seen.rgb(20, 25);
        assert!(blue > 0.04, "{source}: {blue}");
    }
}

/// Fog over a picture at a place and time has the light that the night sky of that place and time has in the same fog.
#[test]
fn moonlit_fog_matches_the_sky_of_its_place_and_time() {
    let mut scene = OverlayScene::default();
    scene.overlay.sky_light = true;
    scene.overlay.radiance_scale = Some(1.0);
    scene.scene.solver.wavelengths = Some("fast".to_owned());
    // The night before a full moon.
    scene.scene.sun.latitude_deg = Some(48.86);
    scene.scene.sun.longitude_deg = Some(2.29);
    scene.scene.sun.time = Some("2026-01-03T00:00:00Z".to_owned());
    scene.scene.camera.azimuth_deg = Some(120.0);
    scene.scene.observer.eye_height_m = Some(1.6);
    scene.fog_mut().visibility_m = Some(60.0);
    scene.fog_mut().top_m = Some(80.0);
    scene.check().unwrap();
    let size = (16, 12);
    let dark = picture(size, |_, _| [0.0; 3]);
    let far = depth(size, |_, _| f32::INFINITY);
    let image = OverlayImage::new(&scene.overlay, dark, far).unwrap();
    scene.overlay.layers = true;
    let seen = layers(&scene, &image);

    let sky = scene.scene.resolve().unwrap();
    let sun = sky.sun.at_start().unwrap();
    let night = sky.night(&sun).unwrap();
    assert!(night.moon.unwrap().lit_fraction() > 0.99);
    let suns = SunCoverage::near(sun.elevation_deg, sky.observer_altitude_m);
    let model = registry::prepare(&sky, suns, Control::default()).unwrap();
    let channels = Channels::Rgb(RgbSpace::Srgb);
    let view = model
        .night_view(sky.observer_altitude_m, &sun.state(), &night, channels)
        .unwrap();
    let camera = scene.camera(image.picture.size, 1.0).unwrap();
    for (x, y) in [(1, 0), (8, 5), (14, 3)] {
        let mut want = [0.0; 3];
        view.radiance(&[camera.pixel_direction(x, y)], &mut want);
        let got = seen.rgb(x, y);
        // Moonlit fog: 0.2 lx over pi, of which some is reflected.
        assert!((0.01..0.1).contains(&got[1]), "{got:?}");
        for (got, want) in got.iter().zip(want) {
            assert!((got / want - 1.0).abs() < 1e-3, "{x}, {y}: {got} {want}");
        }
    }
    // Moonlight is most of it.
    scene.scene.night.moon = Some(false);
    let dark = layers(&scene, &image).rgb(8, 5);
    assert!(dark[1] < 0.1 * seen.rgb(8, 5)[1], "{dark:?}");
    // Monte Carlo knows sunlight only, and fog shows no stars.
    for (set, sentence) in [
        (
            (|s: &mut OverlayScene| s.scene.solver.name = Some("monte-carlo".to_owned()))
                as fn(&mut OverlayScene),
            "night: expected solver orders",
        ),
        (
            |s| s.scene.night.stars = Some(true),
            "night.stars: expected",
        ),
        (|s| s.overlay.sky_light = false, "try sky-light"),
    ] {
        let mut wrong = scene.clone();
        wrong.fog_mut().scattering = None;
        set(&mut wrong);
        let error = wrong.check().unwrap_err().to_string();
        assert!(error.contains(sentence), "{error}");
    }
}

#[test]
fn a_black_picture_says_no_level() {
    let mut scene = outdoors(500.0);
    scene.fog_mut().scale_height_m = Some(40.0);
    scene.overlay.ambient = Some([0.0; 3]);
    let image = super::common::black((32, 24), &scene.overlay);
    let sky = scene.solve_sky().unwrap().unwrap();
    let prepared = PreparedOverlay::new(&scene, &image, Some(&sky));
    assert!(
        prepared
            .err()
            .unwrap()
            .to_string()
            .contains("radiance-scale")
    );
}
