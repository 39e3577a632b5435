//! Lights of the night in the air: levels against measurements, and laws of their sum.

use airlight::fog::FogScattering;
use airlight::models::registry;
use airlight::night::{NightState, magnitude_per_square_arcsec};
use airlight::scene::{
    Channels, FogSpec, NightLight, NightLights, PreparedModel, RadianceView, RgbFoggySky, Scene,
};
use airlight::sky::{Scattering, Sky, SunCoverage};
use airlight::spectrum::{RgbSpace, WavelengthGrid};
use airlight::{Control, axes};
use glam::DVec3;
use std::sync::Arc;

const SRGB: Channels = Channels::Rgb(RgbSpace::Srgb);

/// A night far from twilight, in clear air, of few wavelengths.
fn night() -> Scene {
    let mut scene = Scene::default();
    scene.sun.elevation_deg = Some(-30.0);
    scene.sun.azimuth_deg = Some(0.0);
    scene.air.atmosphere = Some("clear".to_owned());
    scene.solver.wavelengths = Some("fast".to_owned());
    scene
}

/// The same with single scattering, which is solved at once: for laws that hold for any orders.
fn quick_night() -> Scene {
    let mut scene = night();
    scene.solver.scattering = Some(Scattering::Single);
    scene
}

fn prepared(scene: &Scene) -> Arc<dyn PreparedModel> {
    let scene = scene.resolve().unwrap();
    let sun = scene.sun.at_start().unwrap();
    let suns = SunCoverage::near(sun.elevation_deg, scene.observer_altitude_m);
    registry::prepare(&scene, suns, Control::default()).unwrap()
}

/// The lights of a scene in air that is solved already.
fn view_in(scene: &Scene, model: &dyn PreparedModel) -> Arc<dyn RadianceView> {
    let scene = scene.resolve().unwrap();
    let sun = scene.sun.at_start().unwrap();
    let altitude_m = scene.observer_altitude_m;
    match scene.night(&sun) {
        Some(night) => model.night_view(altitude_m, &sun.state(), &night, SRGB),
        None => model.view(altitude_m, &sun.state(), SRGB),
    }
    .unwrap()
}

fn view(scene: &Scene) -> Arc<dyn RadianceView> {
    view_in(scene, prepared(scene).as_ref())
}

fn luminance(view: &dyn RadianceView, direction: DVec3) -> f64 {
    let mut values = [0.0; 3];
    view.radiance(&[direction], &mut values);
    view.luminance(&values)
}

fn state(scene: &Scene) -> Option<NightState> {
    let scene = scene.resolve().unwrap();
    let sun = scene.sun.at_start().unwrap();
    scene.night(&sun)
}

/// Dark sites have 21.5 to 22 magnitudes per square arcsecond at the zenith (Patat 2003, Astron. Astrophys. 400, 1183: 21.6 at
/// Paranal; Falchi et al. 2016 take 22.0), and a horizontal illuminance of about 1 mlx.
#[test]
fn a_moonless_sky_is_as_dark_as_dark_sites() {
    let view = view(&night());
    let zenith = magnitude_per_square_arcsec(luminance(view.as_ref(), DVec3::Y));
    assert!((21.5..=22.0).contains(&zenith), "{zenith}");
    let mut values = [0.0; 3];
    view.horizontal_irradiance(&mut values);
    let horizontal_lx = view.luminance(&values);
    assert!((0.6e-3..1.4e-3).contains(&horizontal_lx), "{horizontal_lx}");
    // Brighter towards the horizon, by the airglow's long path.
    let low = luminance(view.as_ref(), axes::direction(90.0, 15.0));
    assert!(low > 1.2 * luminance(view.as_ref(), DVec3::Y));
    // Ground of albedo 0.1 to 0.2, lit by this sky.
    let ground = luminance(view.as_ref(), -DVec3::Y);
    let albedo = ground * std::f64::consts::PI / horizontal_lx;
    assert!((0.08..0.25).contains(&albedo), "{albedo}");
    assert!(view.moon().is_none());
    let stars = view.stars().unwrap();
    assert!(stars.directions.len() > 3000);
    assert!(stars.irradiance.iter().all(|e| e.is_finite()));
}

/// Moonlight of the empirical model of Krisciunas & Schaefer (1991, Publ. Astron. Soc. Pac. 103, 1033), eq. 15 and 20 to 22, cd/m^2:
/// fitted at 2800 m; stated error 8 to 23 %. It depends on the extinction only, of which it takes all to scatter.
fn krisciunas_schaefer(phase_deg: f64, moon: DVec3, direction: DVec3) -> f64 {
    const EXTINCTION: f64 = 0.172;
    let air_mass = |d: DVec3| (1.0 - 0.96 * (1.0 - d.y * d.y)).powf(-0.5);
    let magnitude = 3.84 + 0.026 * phase_deg + 4e-9 * phase_deg.powi(4);
    let apart = moon.angle_between(direction);
    let scattering = 10f64.powf(5.36) * (1.06 + apart.cos().powi(2))
        + 10f64.powf(6.15 - apart.to_degrees() / 40.0);
    let through = |d: DVec3| 10f64.powf(-0.4 * EXTINCTION * air_mass(d));
    let nanolamberts =
        scattering * 10f64.powf(-0.4 * magnitude) * through(moon) * (1.0 - through(direction));
    3.183e-6 * nanolamberts
}

#[test]
fn moonlit_skies_match_an_empirical_model() {
    let mut scene = night();
    // The model's extinction, 0.172 magnitudes, with the optical depth of air at sea level and of ozone.
    scene.air.aod_550 = Some(0.035);
    let solved = prepared(&scene);
    for (phase_deg, elevation_deg) in [(30.0, 60.0), (80.0, 35.0)] {
        scene.night.moon_elevation_deg = Some(elevation_deg);
        scene.night.moon_phase_deg = Some(phase_deg);
        let view = view_in(&scene, solved.as_ref());
        let moonlit = view.moon().unwrap();
        let moon = state(&scene).unwrap().moon.unwrap().direction;
        let (mut sum, mut count) = (0.0, 0.0);
        for azimuth_deg in [20.0, 90.0, 180.0, 250.0] {
            for elevation_deg in [30.0, 50.0, 75.0] {
                let direction = axes::direction(azimuth_deg, elevation_deg);
                if moon.angle_between(direction).to_degrees() < 30.0 {
                    continue;
                }
                let got = luminance(moonlit.as_ref(), direction);
                let want = krisciunas_schaefer(phase_deg, moon, direction);
                assert!(
                    (0.5..1.7).contains(&(got / want)),
                    "{phase_deg}, {azimuth_deg}, {elevation_deg}: {got} against {want}"
                );
                sum += got / want;
                count += 1.0;
            }
        }
        let mean = sum / count;
        println!("phase {phase_deg}: mean ratio {mean:.3}");
        assert!((0.8..1.2).contains(&mean), "{phase_deg}: {mean}");
    }
}

#[test]
fn light_of_sun_moon_and_stars_adds_up() {
    let mut scene = quick_night();
    scene.sun.elevation_deg = Some(-8.0);
    let without_moon = view(&scene);
    scene.night.moon_elevation_deg = Some(40.0);
    let whole = view(&scene);
    scene.night = Default::default();
    scene.night.lights = Some(NightLights::Off);
    let sunlit = view(&scene);
    assert!(state(&scene).is_none());
    for direction in [
        DVec3::Y,
        axes::direction(30.0, 20.0),
        axes::direction(200.0, -10.0),
    ] {
        let parts = luminance(without_moon.as_ref(), direction)
            + luminance(whole.moon().unwrap().as_ref(), direction);
        let got = luminance(whole.as_ref(), direction);
        assert!((got / parts - 1.0).abs() < 1e-5, "{direction}");
        let night = luminance(without_moon.as_ref(), direction);
        let sun = luminance(sunlit.as_ref(), direction);
        assert!(
            night > sun && night - sun < 1.2e-3,
            "{direction}: {night} {sun}"
        );
    }
    let mut rows = vec![0.0; 3 * 8];
    let azimuths: Vec<f64> = (0..8).map(f64::from).collect();
    let row: Vec<DVec3> = azimuths
        .iter()
        .map(|azimuth| axes::direction(azimuth.to_degrees(), 33.0))
        .collect();
    whole
        .row_sampler(&azimuths)
        .unwrap()
        .sample_row(33.0_f64.to_radians(), &mut rows);
    let mut singly = vec![0.0; 3 * 8];
    whole.radiance(&row, &mut singly);
    for (a, b) in rows.iter().zip(&singly) {
        assert!((a / b - 1.0).abs() < 1e-3, "{a} {b}");
    }
}

#[test]
fn cities_brighten_the_zenith_to_the_quality_that_is_given() {
    let mut scene = quick_night();
    scene.night.sky_quality_mag = Some(18.5);
    let city = view(&scene);
    let zenith = luminance(city.as_ref(), DVec3::Y);
    assert!((magnitude_per_square_arcsec(zenith) - 18.5).abs() < 0.01);
    let low = luminance(city.as_ref(), axes::direction(0.0, 20.0));
    assert!(low > 1.5 * zenith, "{low} {zenith}");
    let mut rgb = [0.0; 3];
    city.radiance(&[DVec3::Y], &mut rgb);
    assert!(rgb[0] > rgb[2], "{rgb:?}");
    // The ground reflects the glow.
    let mut lit = [0.0; 3];
    city.horizontal_irradiance(&mut lit);
    let ground = luminance(city.as_ref(), -DVec3::Y);
    let albedo = ground * std::f64::consts::PI / city.luminance(&lit);
    assert!((0.05..0.25).contains(&albedo), "{albedo}");
    // A sky that is brighter by nature stays as it is.
    scene.night.sky_quality_mag = Some(23.0);
    let dark = luminance(view(&scene).as_ref(), DVec3::Y);
    scene.night.sky_quality_mag = None;
    assert_eq!(dark, luminance(view(&scene).as_ref(), DVec3::Y));
}

#[test]
fn fog_at_night_hides_the_stars_and_glows_as_the_sky() {
    let mut scene = quick_night();
    scene.night.moon_elevation_deg = Some(50.0);
    let clear = view(&scene);
    scene.fog = Some(thick_fog());
    let foggy = view(&scene);
    let sum = |view: &dyn RadianceView| view.stars().unwrap().irradiance.iter().sum::<f32>();
    assert!(sum(foggy.as_ref()) < 0.02 * sum(clear.as_ref()));
    let (mut lit, mut sky) = ([0.0; 3], [0.0; 3]);
    foggy.horizontal_irradiance(&mut lit);
    clear.horizontal_irradiance(&mut sky);
    assert!(lit.iter().all(|e| e.is_finite() && *e > 0.0));
    for direction in [
        DVec3::Y,
        axes::direction(10.0, 0.5),
        axes::direction(10.0, -20.0),
    ] {
        let level = luminance(foggy.as_ref(), direction);
        assert!(
            level.is_finite() && level > 1e-5 && level < 0.3,
            "{direction}: {level}"
        );
    }
    // Air and fog in front of an object.
    let (mut through, mut path) = ([0.0; 3], [0.0; 3]);
    let mut before = 0.0;
    for distance_m in [1.0, 20.0, 100.0, 1000.0] {
        foggy.path(
            axes::direction(10.0, 0.0),
            distance_m,
            &mut through,
            &mut path,
        );
        assert!(through[1] >= 0.0 && through[1] <= 1.0 && path[1] >= before);
        before = path[1];
    }
}

/// Thick fog in a slab.
fn thick_fog() -> FogSpec {
    FogSpec {
        visibility_m: Some(50.0),
        top_m: Some(100.0),
        ..Default::default()
    }
}

/// The fog of a scene in its sky, for real-time use.
fn foggy_sky(scene: &Scene) -> RgbFoggySky {
    let scene = scene.resolve().unwrap();
    let sun = scene.sun.at_start().unwrap();
    let suns = SunCoverage::near(sun.elevation_deg, scene.observer_altitude_m);
    let settings = scene.solver.sky_settings(suns);
    let sky = Sky::prepare(&scene.atmosphere, &scene.grid, &settings).unwrap();
    let view = sky.view(scene.observer_altitude_m, sun.state());
    let fog = scene.fog.as_ref().unwrap();
    let layers = fog
        .constituents(WavelengthGrid::standard().wavelengths_nm())
        .unwrap();
    match NightLight::new(&scene, &view, &sun, RgbSpace::Srgb).unwrap() {
        Some(night) => RgbFoggySky::at_night(&view, &night, &layers, fog.scattering),
        None => RgbFoggySky::new(&view, &layers, fog.scattering, RgbSpace::Srgb),
    }
    .unwrap()
}

fn srgb_luminance(rgb: [f32; 3]) -> f64 {
    RgbSpace::Srgb.luminance(rgb.map(f64::from))
}

/// Two implementations of one sky: per ray of a picture, and the sum of all lights in the model's view.
#[test]
fn fog_is_lit_by_the_night_as_in_the_sky_of_the_model() {
    let mut scene = quick_night();
    scene.sun.elevation_deg = Some(-9.0);
    scene.night.moon_elevation_deg = Some(35.0);
    scene.night.moon_phase_deg = Some(0.0);
    for visibility_m in [50.0, 3000.0] {
        scene.fog = Some(FogSpec {
            visibility_m: Some(visibility_m),
            ..thick_fog()
        });
        let (sky, model) = (foggy_sky(&scene), view(&scene));
        for (azimuth_deg, elevation_deg) in [(180.0, 1.0), (40.0, 0.2), (300.0, 30.0), (90.0, -8.0)]
        {
            let direction = axes::direction(azimuth_deg, elevation_deg);
            let mut want = [0.0; 3];
            model.radiance(&[direction], &mut want);
            let got = sky.radiance(direction);
            for (got, want) in got.iter().zip(want) {
                assert!((got / want - 1.0).abs() < 1e-4, "{direction}: {got} {want}");
            }
            for distance_m in [30.0, 2000.0] {
                let (mut through, mut want) = ([0.0; 3], [0.0; 3]);
                model.path(direction, distance_m, &mut through, &mut want);
                let path = sky.path(direction, distance_m);
                for lane in 0..3 {
                    let off = path.transmittance[lane] - through[lane];
                    assert!(off.abs() < 1e-6, "{direction}, {distance_m} m: {off}");
                    let off = path.path_radiance[lane] / want[lane] - 1.0;
                    assert!(off.abs() < 1e-4, "{direction}, {distance_m} m: {off}");
                }
            }
        }
    }
}

/// Over white ground, fog that hardly absorbs is as bright as an even sky above it, however thick it is, and has its colour.
#[test]
fn thick_fog_is_as_bright_as_the_night_on_it() {
    for moon_deg in [None, Some(45.0f64)] {
        let mut scene = quick_night();
        scene.air.ground_albedo = Some(1.0);
        scene.night.moon_elevation_deg = moon_deg;
        scene.night.moon_phase_deg = moon_deg.map(|_| 0.0);
        let clear = view(&scene);
        let mut on_fog = [0.0; 3];
        clear.horizontal_irradiance(&mut on_fog);
        if let (Some(moon), Some(deg)) = (clear.moon(), moon_deg) {
            let mut direct = [0.0; 3];
            moon.sun_irradiance(&mut direct);
            let sine = deg.to_radians().sin() as f32;
            on_fog
                .iter_mut()
                .zip(direct)
                .for_each(|(e, d)| *e += sine * d);
        }
        scene.fog = Some(thick_fog());
        let sky = foggy_sky(&scene);
        let fog = sky.path_over_clear(axes::direction(90.0, 0.0), f64::INFINITY);
        assert!(fog.transmittance.iter().all(|t| *t < 1e-6));
        let level = srgb_luminance(fog.path_radiance);
        let even = srgb_luminance(on_fog) / std::f64::consts::PI;
        println!("{moon_deg:?}: {level:.3e} under {even:.3e} cd/m^2");
        // Moonlight from one direction is not even.
        let limit = if moon_deg.is_some() { 0.2 } else { 0.03 };
        assert!(
            (level / even - 1.0).abs() < limit,
            "{moon_deg:?}: {level} {even}"
        );
        // Dark sites have about 1 mlx, and a full moon 0.2 lx.
        let expected = if moon_deg.is_some() {
            0.03..0.12
        } else {
            2e-4..5e-4
        };
        assert!(expected.contains(&level), "{moon_deg:?}: {level}");
        for lane in [0, 2] {
            let colour = fog.path_radiance[lane] / fog.path_radiance[1];
            let off = colour / (on_fog[lane] / on_fog[1]) - 1.0;
            assert!(off.abs() < 0.03, "{moon_deg:?}, lane {lane}: {off}");
        }
    }
}

/// Twilight fades into the glow of the night without a step.
#[test]
fn fog_fades_into_the_night_without_a_step() {
    let level = |sun_deg: f64, lights: NightLights| {
        let mut scene = quick_night();
        scene.solver.wavelengths = Some("rgb".to_owned());
        scene.sun.elevation_deg = Some(sun_deg);
        scene.night.lights = Some(lights);
        scene.fog = Some(FogSpec {
            scattering: Some(FogScattering::Single),
            ..thick_fog()
        });
        let fog = foggy_sky(&scene).path_over_clear(axes::direction(90.0, 0.0), f64::INFINITY);
        srgb_luminance(fog.path_radiance)
    };
    let [with, without] = [NightLights::Auto, NightLights::Off].map(|lights| level(-4.01, lights));
    assert!(with > without && with / without < 1.001, "{with} {without}");
    let levels: Vec<f64> = (6..=18)
        .step_by(2)
        .map(|deg| level(-f64::from(deg), NightLights::Auto).ln())
        .collect();
    // By twilight's own fading, up to 3 in 2 degrees, which changes gradually.
    let steps: Vec<f64> = levels.windows(2).map(|pair| pair[0] - pair[1]).collect();
    assert!(
        steps.iter().all(|step| (-0.1..3.0).contains(step)),
        "{steps:?}"
    );
    for pair in steps.windows(2) {
        assert!((pair[0] - pair[1]).abs() < 1.6, "{steps:?}");
    }
    let deep = level(-30.0, NightLights::Auto).ln();
    assert!(
        (levels[levels.len() - 1] - deep).abs() < 0.3,
        "{levels:?} {deep}"
    );
}

/// Nothing jumps where the lights of the night begin, and far below the horizon the sun no longer matters.
#[test]
fn the_level_of_the_night_does_not_depend_on_how_deep_the_sun_is() {
    let zenith = |elevation_deg: f64, lights: NightLights| {
        let mut scene = quick_night();
        scene.sun.elevation_deg = Some(elevation_deg);
        scene.night.lights = Some(lights);
        luminance(view(&scene).as_ref(), DVec3::Y)
    };
    let (with, without) = (
        zenith(-4.01, NightLights::Auto),
        zenith(-4.01, NightLights::Off),
    );
    assert!(with > without && with / without < 1.001, "{with} {without}");
    assert_eq!(
        zenith(-3.99, NightLights::Auto),
        zenith(-3.99, NightLights::Off)
    );
    let astronomical = zenith(-18.0, NightLights::Auto);
    let deep = zenith(-24.0, NightLights::Auto);
    assert!(
        (astronomical / deep - 1.0).abs() < 0.25,
        "{astronomical} {deep}"
    );
}
