//! Functions that take long return an error when the caller cancels.

use airlight::atmosphere::{Constituent, DensityProfile, presets};
use airlight::axes::direction;
use airlight::fog::droplets::Droplets;
use airlight::fog::{Fog, FogError, FogLighting, FogScattering, Ground, RgbFog, RgbLayer};
use airlight::models::registry;
use airlight::monte_carlo::{MonteCarlo, MonteCarloSettings};
use airlight::optics::mie::droplets::Drops;
use airlight::optics::mie::{MieError, Particles, SizeDistribution};
use airlight::scene::{Channels, Input, RgbFoggySky, Scene, SceneError};
use airlight::sky::{Sky, SkySettings, SunCoverage, TableChannels, View};
use airlight::spectrum::{RgbSpace, SpectralCurve, WavelengthGrid};
use airlight::{Cancelled, Control};
use glam::DVec3;
use std::sync::atomic::AtomicBool;

const SPACE: RgbSpace = RgbSpace::Srgb;

static CANCEL: AtomicBool = AtomicBool::new(true);

fn cancelled() -> Control<'static> {
    Control::cancelled_by(&CANCEL)
}

fn view() -> View {
    let settings = SkySettings {
        suns: SunCoverage::near(30.0, 2.0),
        ..SkySettings::default()
    };
    let air = presets::preset("clear").unwrap();
    let sky = Sky::prepare(&air, &WavelengthGrid::rgb(), &settings).unwrap();
    sky.view(2.0, direction(120.0, 30.0))
}

fn layer() -> Constituent {
    let density = DensityProfile::exponential(30.0);
    Constituent::fog(0.01, Droplets::Radiation.into(), density, &[]).unwrap()
}

#[test]
fn tables_of_a_view_are_cancelled() {
    let view = view();
    let table = view.table_with(TableChannels::Spectral, cancelled());
    assert_eq!(table.err(), Some(Cancelled));
    let view = view.radiance_view_with(Channels::Rgb(SPACE), cancelled());
    assert_eq!(view.err(), Some(Cancelled));
}

#[test]
fn the_light_in_fog_is_cancelled() {
    let light = FogLighting {
        sun: None,
        ambient: [1.0; 3],
        ground_albedo: [0.2; 3],
    };
    let layers = [RgbLayer::from_constituent(&layer(), SPACE).unwrap()];
    let fog = RgbFog::new_with(
        &layers,
        Ground::FLAT,
        &light,
        FogScattering::Multiple,
        cancelled(),
    );
    assert_eq!(fog.err(), Some(FogError::Cancelled(Cancelled)));
    let light = FogLighting {
        sun: None,
        ambient: SpectralCurve::Constant(1.0),
        ground_albedo: SpectralCurve::Constant(0.2),
    };
    let fog = Fog::new_with(
        &[layer()],
        Ground::FLAT,
        &light,
        FogScattering::Multiple,
        &WavelengthGrid::rgb(),
        cancelled(),
    );
    assert_eq!(fog.err(), Some(FogError::Cancelled(Cancelled)));
    let view = view();
    let (layers, scattering) = ([layer()], FogScattering::Multiple);
    let sky = RgbFoggySky::new_with(&view, &layers, scattering, SPACE, cancelled());
    assert!(sky.is_err_and(|error| error.is_cancelled()));
    let sky = RgbFoggySky::new(&view, &layers, scattering, SPACE).unwrap();
    let other = sky.with_fog_with(&layers, scattering, cancelled());
    assert!(other.is_err_and(|error| error.is_cancelled()));
}

/// Models that need no tables for a view return it.
#[test]
fn views_of_models_are_cancelled() -> Result<(), SceneError> {
    for (name, stops) in [
        ("orders", [true, true]),
        ("hillaire2020", [true, false]),
        ("preetham", [false, false]),
    ] {
        let model = registry::find(name)?;
        let mut scene = Scene::default();
        scene.sun.elevation_deg = Some(25.0);
        scene.solver.name = Some(name.to_owned());
        if model.capabilities().honours(Input::Wavelengths) {
            scene.solver.wavelengths = Some("rgb".to_owned());
        }
        let scene = scene.resolve()?;
        let suns = SunCoverage::near(25.0, scene.observer_altitude_m);
        let sun = scene.sun.at_start()?.state();
        let prepared = model.prepare(&scene, suns, cancelled());
        assert_eq!(prepared.is_err(), stops[0], "{name}");
        assert!(prepared.err().is_none_or(|error| error.is_cancelled()));
        let prepared = model.prepare(&scene, suns, Control::default())?;
        let (altitude_m, channels) = (scene.observer_altitude_m, Channels::Rgb(SPACE));
        let view = prepared.view_with(altitude_m, &sun, channels, cancelled());
        assert_eq!(view.is_err(), stops[1], "{name}");
        assert!(view.err().is_none_or(|error| error.is_cancelled()));
    }
    Ok(())
}

#[test]
fn particles_are_cancelled() {
    let stopped = Some(MieError::Cancelled(Cancelled));
    let water = Particles::water(SizeDistribution::gamma(10.0, 0.1)).unwrap();
    let matrices = water.matrices_with(550.0, &[0.0, 1.0], cancelled());
    assert_eq!(matrices.err(), stopped);
    assert_eq!(water.bulk_with(550.0, cancelled()).err(), stopped);
    assert_eq!(water.table_with(&[550.0], cancelled()).err(), stopped);
    // Wavelengths that are not embedded.
    let table = Drops::HeavyRadiationFog.table_with(&[501.0, 502.0], cancelled());
    assert_eq!(table.err(), stopped);
}

#[test]
fn paths_along_a_ray_are_cancelled() {
    let (air, grid) = (presets::preset("clear").unwrap(), WavelengthGrid::rgb());
    let paths = MonteCarlo::new(&air, &grid, MonteCarloSettings::default()).unwrap();
    let (sun, up) = (direction(0.0, 30.0), DVec3::Y);
    let stopped = Some(Cancelled);
    assert_eq!(
        paths.radiance_with(0.0, sun, up, cancelled()).err(),
        stopped
    );
    let path = paths.path_radiance_with(0.0, sun, up, 1e3, cancelled());
    assert_eq!(path.err(), stopped);
    let polarised = paths.polarised_with(0.0, sun, up, None, cancelled());
    assert_eq!(polarised.err(), stopped);
}
