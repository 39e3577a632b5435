//! Values of the engines, which must be the same on every machine.

use airlight::atmosphere::Preset;
use airlight::fog::droplets::Droplets;
use airlight::fog::{DirectionalLight, FogLighting, FogScattering, Ground, RgbFog, RgbLayer};
use airlight::glam::DVec3;
use airlight::monte_carlo::{MonteCarlo, MonteCarloSettings};
use airlight::scene::{Channels, Scene};
use airlight::sky::{Sky, SkySettings, SunCoverage};
use airlight::spectrum::{RgbSpace, WavelengthGrid};
use airlight::{Control, atmosphere::DensityProfile, axes, models::registry};
use std::fmt::Write;

/// Directions to the west of a sun in the south, by azimuth and elevation, degrees.
const DIRECTIONS: [[f64; 2]; 5] = [
    [190.0, 12.0],
    [270.0, 1.0],
    [270.0, 45.0],
    [0.0, 90.0],
    [30.0, -3.0],
];
/// Published models without noise.
const MODELS: [&str; 4] = ["preetham", "hillaire2020", "klassen1987", "orders"];

/// A name, and its value.
pub type Value = (String, f64);

/// Values of the sun's position, of a solved sky, of fog, of published models and of a Monte Carlo.
///
/// # Panics
/// Where an engine refuses its input, which is fixed.
pub fn values() -> Vec<Value> {
    let mut all = Vec::new();
    sun(&mut all);
    sky(&mut all);
    fog(&mut all);
    for model in MODELS {
        published(model, &mut all);
    }
    monte_carlo(&mut all);
    all
}

/// Values as text, one name and value a line.
pub fn text(values: &[Value]) -> String {
    values
        .iter()
        .fold(String::new(), |mut text, (name, value)| {
            writeln!(text, "{name} {value:e}").expect("text in memory");
            text
        })
}

/// Solves a sky as the viewer does: four wavelengths, all suns. Returns a radiance, so that the work is not left out.
///
/// # Panics
/// Never: the air is fixed.
pub fn solve_all_suns() -> f64 {
    let grid = four_wavelengths();
    let settings = SkySettings::default();
    let sky = Sky::prepare(&Preset::Average.atmosphere(), &grid, &settings).expect("a sky");
    let view = sky.view(2.0, axes::direction(180.0, 10.0));
    f64::from(view.along(DVec3::Y, None).radiance()[0])
}

fn four_wavelengths() -> WavelengthGrid {
    WavelengthGrid::from_wavelengths_nm(vec![440.0, 495.0, 560.0, 625.0]).expect("wavelengths")
}

fn sun(all: &mut Vec<Value>) {
    let scene = "sun.latitude_deg = 48.8584\nsun.longitude_deg = 2.2945\nsun.time = \"2026-06-21T21:15:00+02:00\"";
    let scene = Scene::from_toml(scene).expect("a scene");
    let sun = scene
        .resolve()
        .expect("a scene")
        .sun
        .at_start()
        .expect("a sun");
    all.push(("sun elevation".to_owned(), sun.elevation_deg));
    all.push(("sun azimuth".to_owned(), sun.azimuth_deg));
}

fn sky(all: &mut Vec<Value>) {
    let settings = SkySettings {
        suns: SunCoverage::near(10.0, 2.0),
        ..SkySettings::default()
    };
    let air = Preset::Hazy.atmosphere();
    let sky = Sky::prepare(&air, &four_wavelengths(), &settings).expect("a sky");
    let view = sky.view(2.0, axes::direction(180.0, 10.0));
    for [azimuth, elevation] in DIRECTIONS {
        let light = view.along(axes::direction(azimuth, elevation), Some(2e4));
        let path_radiance = light.path_radiance();
        let lanes = path_radiance.into_iter().chain(light.transmittance);
        for (k, value) in lanes.enumerate() {
            let name = format!("sky {azimuth} {elevation} {k}");
            all.push((name, f64::from(value)));
        }
    }
}

fn fog(all: &mut Vec<Value>) {
    let layer = RgbLayer {
        density: DensityProfile::exponential(30.0),
        extinction_per_m: [0.01, 0.011, 0.012],
        single_scattering_albedo: [0.99; 3],
        phase: Droplets::default().phase(),
    };
    let sun = axes::direction(180.0, 20.0);
    let light = FogLighting {
        sun: Some(DirectionalLight {
            direction: sun,
            irradiance: [1e5; 3],
        }),
        ambient: [3e3; 3],
        ground_albedo: [0.2; 3],
    };
    for scattering in [FogScattering::Single, FogScattering::Multiple] {
        let layers = std::slice::from_ref(&layer);
        let fog = RgbFog::new(layers, Ground::FLAT, &light, scattering).expect("fog");
        let seen = fog.seen_from(2.0);
        for [azimuth, elevation] in DIRECTIONS {
            let path = seen.path(axes::direction(azimuth, elevation), 150.0);
            let channels = path.path_radiance.into_iter().chain(path.transmittance);
            for (k, value) in channels.enumerate() {
                let name = format!("fog {scattering:?} {azimuth} {elevation} {k}");
                all.push((name, f64::from(value)));
            }
        }
    }
}

fn published(model: &str, all: &mut Vec<Value>) {
    let scene = format!("sun.elevation_deg = 10\nsun.azimuth_deg = 180\nsolver.name = \"{model}\"");
    let scene = Scene::from_toml(&scene)
        .and_then(|scene| scene.resolve())
        .expect("a scene");
    let sun = scene.sun.at_start().expect("a sun");
    let suns = SunCoverage::near(sun.elevation_deg, scene.observer_altitude_m);
    let prepared = registry::prepare(&scene, suns, Control::default()).expect("a model");
    let channels = Channels::Rgb(RgbSpace::Srgb);
    let view = prepared.view(scene.observer_altitude_m, &sun.state(), channels);
    let directions = DIRECTIONS.map(|[azimuth, elevation]| axes::direction(azimuth, elevation));
    let mut light = [0.0; 3 * DIRECTIONS.len()];
    view.expect("a view").radiance(&directions, &mut light);
    for (k, value) in light.into_iter().enumerate() {
        all.push((format!("{model} {k}"), f64::from(value)));
    }
}

fn monte_carlo(all: &mut Vec<Value>) {
    let settings = MonteCarloSettings {
        paths: 2048,
        ..MonteCarloSettings::default()
    };
    let air = Preset::Hazy.atmosphere();
    let traced = MonteCarlo::new(&air, &four_wavelengths(), settings).expect("a Monte Carlo");
    let sun = axes::direction(180.0, 10.0);
    let light = traced.radiance(2.0, sun, axes::direction(190.0, 12.0));
    for (k, mean) in light.mean.into_iter().enumerate() {
        all.push((format!("monte carlo {k}"), mean));
    }
}
