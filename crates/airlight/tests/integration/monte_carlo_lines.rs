//! Monte Carlo along rays that end at a distance.

use crate::common::{green_fog, green_path, grey_layer};
use airlight::atmosphere::{
    Atmosphere, Constituent, ConstituentKind, DensityProfile, Planet, preset,
};
use airlight::axes::direction;
use airlight::fog::{FogScattering, Ground};
use airlight::monte_carlo::{Estimate, MonteCarlo, MonteCarloSettings};
use airlight::optics::PhaseFunction;
use airlight::sky::{Sky, SkySettings};
use airlight::spectrum::{SpectralCurve, WavelengthGrid};
use airlight::sun::SunDisc;
use glam::{DQuat, DVec3};

fn solver(air: &Atmosphere, paths: u64) -> MonteCarlo {
    let grid = WavelengthGrid::from_wavelengths_nm(vec![440.0, 550.0, 680.0]).unwrap();
    let settings = MonteCarloSettings {
        paths,
        ..Default::default()
    };
    MonteCarlo::new(air, &grid, settings).unwrap()
}

/// How far apart two estimates are, in standard errors, wavelength by wavelength.
fn apart(a: (&[f64], &[f64]), b: (&[f64], &[f64])) -> f64 {
    let noise = a.1.iter().zip(b.1).map(|(a, b)| a.hypot(*b));
    let difference = a.0.iter().zip(b.0).map(|(a, b)| (a - b).abs());
    difference
        .zip(noise)
        .map(|(d, n)| d / n)
        .fold(0.0, f64::max)
}

fn of(estimate: &Estimate) -> (&[f64], &[f64]) {
    (&estimate.mean, &estimate.standard_error)
}

/// The whole is what the air adds up to a place, and what it leaves of the light that arrives there: from space, from the
/// ground, through haze, in the planet's shadow, seen from outside.
#[test]
fn a_line_may_be_cut_anywhere() {
    let hazy = preset("hazy").unwrap();
    let sky = solver(&hazy, 32_768);
    for (eye_m, sun_deg, view, distance_m) in [
        (2.0, 40.0, direction(160.0, 3.0), 8e3),
        (2.0, 40.0, direction(20.0, 70.0), 900.0),
        (1500.0, 8.0, direction(90.0, -4.0), 15e3),
        (2.0, -2.0, direction(200.0, 6.0), 60e3),
        (300e3, 25.0, direction(170.0, -70.0), 290e3),
    ] {
        let sun = direction(180.0, sun_deg);
        let whole = sky.radiance(eye_m, sun, view);
        let near = sky.path_radiance(eye_m, sun, view, distance_m);
        let left = sky.transmittance(eye_m, view, distance_m);
        // From there on, up where it is.
        let radius_m = hazy.planet.radius_m;
        let there = DVec3::Y * (radius_m + eye_m) + view * distance_m;
        let turned = DQuat::from_rotation_arc(there.normalize(), DVec3::Y);
        let far = sky.radiance(there.length() - radius_m, turned * sun, turned * view);
        let both: Vec<f64> = (0..3)
            .map(|i| near.mean[i] + left[i] * far.mean[i])
            .collect();
        let noise: Vec<f64> = (0..3)
            .map(|i| near.standard_error[i].hypot(left[i] * far.standard_error[i]))
            .collect();
        let off = apart((&both, &noise), of(&whole));
        assert!(off < 4.0, "{eye_m} {sun_deg} {view}: {off} standard errors");
        // The parts are known well enough for that to mean something.
        assert!(noise.iter().zip(&both).all(|(n, b)| *n < 0.05 * b));
        assert!(near.mean.iter().zip(&whole.mean).all(|(n, w)| n < w));
    }
}

/// An endless line is the whole one where it goes to space, and the whole less the ground's light where it ends there.
#[test]
fn an_endless_line_shows_no_ground() {
    let sky = solver(&preset("clear").unwrap(), 32_768);
    let sun = direction(180.0, 35.0);
    let up = direction(100.0, 25.0);
    let (whole, path) = (
        sky.radiance(2.0, sun, up),
        sky.path_radiance(2.0, sun, up, f64::INFINITY),
    );
    assert!(apart(of(&whole), of(&path)) < 4.0);
    assert!(whole.mean != path.mean, "they are of other random numbers");
    let down = direction(100.0, -25.0);
    let ground_m = sky.path_radiance(2.0, sun, down, f64::INFINITY);
    let short_m = sky.path_radiance(2.0, sun, down, 2.0 / 25f64.to_radians().sin());
    assert!(apart(of(&ground_m), of(&short_m)) < 4.0);
    assert!(ground_m.mean[1] < 1e-3 * sky.radiance(2.0, sun, down).mean[1]);
}

#[test]
fn no_distance_is_no_air() {
    let sky = solver(&preset("clear").unwrap(), 128);
    let (sun, view) = (direction(180.0, 35.0), direction(100.0, 25.0));
    for distance_m in [0.0, -1.0, f64::NAN] {
        let nothing = sky.path_radiance(2.0, sun, view, distance_m);
        assert_eq!(nothing.mean, [0.0; 3]);
        assert_eq!(sky.transmittance(2.0, view, distance_m), [1.0; 3]);
    }
    // Before the air is entered.
    let far = sky.path_radiance(500e3, sun, -DVec3::Y, 300e3);
    assert_eq!(far.mean, [0.0; 3]);
}

/// The fast solver's aerial perspective: light scattered once to a few parts in 1000, all light to a percent, transmittance to
/// 1e-4.
#[test]
fn aerial_perspective_is_that_of_the_fast_solver() {
    let clear = preset("clear").unwrap();
    let random = solver(&clear, 65_536);
    for (sun_deg, first) in [(50.0, 0), (6.0, 1)] {
        let sun = direction(180.0, sun_deg);
        let fast = Sky::prepare(&clear, random.grid(), &SkySettings::default()).unwrap();
        for (eye_m, view, distance_m) in [
            (2.0, direction(130.0, 1.0), 20e3),
            (2.0, direction(0.0, 0.0), 3e3),
            (3e3, direction(60.0, -5.0), 25e3),
            (2.0, direction(180.0, 30.0), 5e3),
        ]
        .into_iter()
        .skip(first)
        .step_by(2)
        {
            let line = fast.view(eye_m, sun).along(view, Some(distance_m));
            let found = random.polarised(eye_m, sun, view, Some(distance_m));
            let found = found.radiance();
            let left = random.transmittance(eye_m, view, distance_m);
            for lane in 0..3 {
                let once = f64::from(line.single[lane]) / found.orders[0].mean[lane] - 1.0;
                let noise = found.orders[0].standard_error[lane] / found.orders[0].mean[lane];
                assert!(once.abs() < 2e-3 + 4.0 * noise, "{view} {lane}: {once}");
                let all = f64::from(line.path_radiance()[lane]) / found.mean[lane] - 1.0;
                let noise = found.standard_error[lane] / found.mean[lane];
                assert!(noise < 5e-3, "{noise}");
                assert!(all.abs() < 0.01 + 4.0 * noise, "{view} {lane}: {all}");
                let off = f64::from(line.transmittance[lane]) / left[lane] - 1.0;
                assert!(off.abs() < 1e-4, "{view} {lane}: {off}");
            }
        }
    }
}

/// Objects in thick fog, where the stated error of the fog solution with multiple scattering is 3 %.
#[test]
fn fog_in_front_of_objects_matches_the_fog_solution() {
    const TOP_M: f64 = 100.0;
    let phase = PhaseFunction::HenyeyGreenstein { g: 0.8 };
    let (extinction_per_m, sun) = (0.03, direction(180.0, 30.0));
    let slab = DensityProfile::slab(TOP_M);
    let layer = grey_layer(slab, extinction_per_m, 1.0, phase.clone());
    let multiple = FogScattering::Multiple;
    let fog = green_fog(layer, Ground::EARTH, Some(sun), 0.2, multiple);
    let air = Atmosphere {
        name: "fog".to_owned(),
        planet: Planet {
            radius_m: Ground::EARTH.radius_m,
            top_altitude_m: TOP_M,
            ground_altitude_m: 0.0,
            ground_albedo: SpectralCurve::Constant(0.2),
        },
        constituents: vec![Constituent {
            kind: ConstituentKind::Fog,
            density: DensityProfile::Layer {
                bottom_m: 0.0,
                top_m: TOP_M,
            },
            scattering_per_m: SpectralCurve::Constant(extinction_per_m),
            absorption_per_m: SpectralCurve::Constant(0.0),
            phase,
        }],
        solar_irradiance: SpectralCurve::Constant(1.0),
        sun: SunDisc::default(),
    };
    let grid = WavelengthGrid::from_wavelengths_nm(vec![550.0]).unwrap();
    let settings = MonteCarloSettings {
        paths: 196_608,
        ..Default::default()
    };
    let random = MonteCarlo::new(&air, &grid, settings).unwrap();
    for (azimuth, elevation, distance_m) in
        [(180.0, 0.0, 20.0), (180.0, 0.0, 100.0), (120.0, 20.0, 40.0)]
    {
        let view = direction(azimuth, elevation);
        let found = random.path_radiance(2.0, sun, view, distance_m);
        let [transmittance, path_radiance] = green_path(&fog, 2.0, view, distance_m);
        let noise = found.standard_error[0] / found.mean[0];
        let off = path_radiance / found.mean[0] - 1.0;
        println!("{azimuth} {elevation} {distance_m}: {off:.4} +- {noise:.4}");
        assert!(noise < 0.012, "{noise}");
        assert!(
            off.abs() < 0.03 + 3.0 * noise,
            "{azimuth} {elevation} {distance_m}: {off} +- {noise}"
        );
        let left = random.transmittance(2.0, view, distance_m)[0];
        assert!((transmittance / left - 1.0).abs() < 1e-5);
    }
}

/// The same bits on any number of threads, and bundle by bundle.
#[test]
fn threads_change_no_bit() {
    let sky = solver(&preset("average").unwrap(), 1024);
    let (sun, view) = (direction(180.0, 10.0), direction(150.0, 1.0));
    let on = |threads| {
        let pool = rayon::ThreadPoolBuilder::new().num_threads(threads);
        let found = || sky.path_radiance(2.0, sun, view, 4e3);
        pool.build().unwrap().install(found)
    };
    let one = on(1);
    assert_eq!(one, on(2));
    assert_eq!(one, on(3));
    let bundles = (0..16).map(|bundle| sky.sample_path(2.0, sun, view, 4e3, bundle));
    let sum: f64 = bundles.flatten().map(|order| order[1]).sum();
    assert!((sum / 16.0 / one.mean[1] - 1.0).abs() < 1e-12);
}

#[test]
fn the_ground_under_an_eye_on_the_ground_is_lit() {
    let toml = "planet.ground_albedo = 0.5\naerosol.type = \"continental-average\"";
    let monte_carlo = solver(&Atmosphere::from_toml(toml).unwrap(), 256);
    let sun = direction(0.0, 15.0);
    // The ray ends where it starts, on either side of the ground by rounding.
    for k in 0..200 {
        let down = direction(1.8 * f64::from(k), -0.2 - 0.44 * f64::from(k));
        let radiance = monte_carlo.radiance(0.0, sun, down).mean[1];
        assert!(radiance > 0.01 && radiance < 0.2, "{k}: {radiance}");
    }
}
