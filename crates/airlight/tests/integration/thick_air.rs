//! The sky of optically thick air: slabs against discrete ordinates, haze against paths of light, conservation of energy, and refusal of
//! what did not converge.

use crate::common::{SLAB_TOP_M, Slab, numbers, scalar_settings};
use airlight::atmosphere::{Atmosphere, ConstituentKind, DensityProfile, Interpolation, presets};
use airlight::axes::direction;
use airlight::monte_carlo::{MonteCarlo, MonteCarloSettings};
use airlight::sky::{Sky, SkyError, SkySettings, SunCoverage};
use airlight::spectrum::WavelengthGrid;

#[test]
fn skies_of_thick_slabs_are_those_of_discrete_ordinates() {
    let table = include_str!("../../../airlight-validation/data/sky_slabs_disort.csv");
    let mut last: Option<([f64; 5], Sky)> = None;
    for row in numbers::<9>(table) {
        let [
            sun_zenith,
            omega,
            g,
            tau,
            albedo,
            above,
            zenith,
            azimuth,
            expected,
        ] = row;
        let key = [sun_zenith, omega, g, tau, albedo];
        let sun_elevation = 90.0 - sun_zenith;
        if last.as_ref().is_none_or(|(solved, _)| *solved != key) {
            let slab = Slab {
                depth: tau,
                single_scattering_albedo: omega,
                asymmetry: g,
                ground_albedo: albedo,
            };
            last = Some((
                key,
                slab.sky(sun_elevation, SkySettings::default()).unwrap(),
            ));
        }
        let sky = &last.as_ref().unwrap().1;
        let altitude_m = SLAB_TOP_M * (1.0 - above);
        let view = sky.view(altitude_m, direction(0.0, sun_elevation));
        let line = view.along(direction(azimuth, 90.0 - zenith), None);
        let got = f64::from(line.path_radiance()[0]);
        // Beyond what can be seen, 1e-9 of the sun's light, the iteration does not look.
        if expected < 1e-9 {
            continue;
        }
        let error = got / expected - 1.0;
        let limit = match tau {
            ..=5.0 => 0.01,
            ..=100.0 => 0.015,
            _ => 0.03,
        };
        assert!(
            error.abs() < limit,
            "{row:?}: {got}, error {:.2} %",
            100.0 * error
        );
    }
}

/// Light that leaves a slab without absorption upwards, and downwards into black ground, relative to the sunlight that arrives, minus 1.
fn energy_error(depth: f64, asymmetry: f64, ground_albedo: f64, sun_elevation_deg: f64) -> f64 {
    let slab = Slab {
        depth,
        single_scattering_albedo: 1.0,
        asymmetry,
        ground_albedo,
    };
    let sky = slab.sky(sun_elevation_deg, SkySettings::default()).unwrap();
    let sun = direction(0.0, sun_elevation_deg);
    let [above, ground] = [SLAB_TOP_M, 0.0].map(|altitude_m| sky.view(altitude_m, sun));
    let direct = f64::from(ground.sun_irradiance()[0]) * sun.y;
    let received = f64::from(ground.downwelling_irradiance()[0]) + direct;
    let leaving = f64::from(above.upwelling_irradiance()[0]) + (1.0 - ground_albedo) * received;
    leaving / sun.y - 1.0
}

/// Asserts that at most 0.3 % of the light that arrives is lost or gained, however often it is scattered: also between a slab and
/// ground that reflects all light. (Under a sun at 8 degrees the curvature of the Earth alone changes the flux by more.)
fn assert_energy_is_conserved(ground_albedo: f64, sun_elevation_deg: f64, depths: &[f64]) {
    for &depth in depths {
        for asymmetry in [0.0, 0.7, 0.85] {
            let error = 100.0 * energy_error(depth, asymmetry, ground_albedo, sun_elevation_deg);
            let case = format!(
                "depth {depth}, asymmetry {asymmetry}, ground {ground_albedo}, sun {sun_elevation_deg}"
            );
            println!("{case}: {error:+.3} %");
            assert!(error.abs() < 0.3, "{case}: {error:.3} %");
        }
    }
}

const DEPTHS: [f64; 6] = [0.1, 1.0, 5.0, 20.0, 50.0, 100.0];

#[test]
fn air_that_does_not_absorb_conserves_energy() {
    assert_energy_is_conserved(0.0, 60.0, &DEPTHS);
    assert_energy_is_conserved(1.0, 20.0, &[1.0, 100.0]);
}

#[test]
#[ignore = "takes half a minute"]
fn air_that_does_not_absorb_conserves_energy_over_any_ground() {
    for ground_albedo in [0.0, 0.5, 1.0] {
        for sun_elevation_deg in [60.0, 20.0] {
            assert_energy_is_conserved(ground_albedo, sun_elevation_deg, &DEPTHS);
        }
    }
}

#[test]
fn light_that_did_not_converge_is_refused() {
    let slab = Slab {
        depth: 5.0,
        single_scattering_albedo: 1.0,
        asymmetry: 0.7,
        ground_albedo: 0.5,
    };
    let mut settings = SkySettings::default();
    let solved = slab.sky(10.0, settings.clone()).unwrap();
    assert!((0.0..settings.orders.tolerance).contains(&solved.iteration_error()));
    settings.orders.max_iterations = 2;
    // Far below what two iterations reach.
    settings.orders.tolerance = 1e-12;
    let Err(error) = slab.sky(10.0, settings) else {
        panic!("expected an error");
    };
    assert!(
        matches!(error, SkyError::NotConverged { iterations: 2, .. }),
        "{error}"
    );
}

const HAZE: &str = include_str!("../../../airlight-validation/data/sky_haze_monte_carlo.csv");

/// A row of the table of skies under thick haze: optical depth, elevation of the sun, azimuth and elevation of the view, and at each
/// wavelength the radiance and its standard error.
type HazeRow = [f64; 10];

/// Height of the eye, m.
const EYE_M: f64 = 2.0;

/// The default atmosphere with the optical depth of a row.
fn hazy([depth, ..]: HazeRow) -> Atmosphere {
    Atmosphere::from_toml(&format!("aerosol.aod_550 = {depth}")).unwrap()
}

fn haze_grid() -> WavelengthGrid {
    WavelengthGrid::from_wavelengths_nm(vec![440.0, 550.0, 680.0]).unwrap()
}

/// Checks the views of the table with optical depths of the haze: each is within 2 % beyond two standard errors.
fn check_haze(depths: &[f64]) {
    let mut rows: Vec<HazeRow> = numbers(HAZE).collect();
    rows.retain(|[depth, ..]| depths.contains(depth));
    for group in rows.chunk_by(|a, b| a[..2] == b[..2]) {
        let [depth, sun_deg, ..] = group[0];
        let settings = scalar_settings(SunCoverage::near(sun_deg, 0.0));
        let sky = Sky::prepare(&hazy(group[0]), &haze_grid(), &settings).unwrap();
        let view = sky.view(EYE_M, direction(0.0, sun_deg));
        for [_, _, azimuth, elevation, light @ ..] in group {
            let got = view.along(direction(*azimuth, *elevation), None).radiance();
            for lane in 0..3 {
                let error = 100.0 * (f64::from(got[lane]) / light[lane] - 1.0);
                let noise = 100.0 * light[lane + 3] / light[lane];
                println!("{depth} {sun_deg} {azimuth} {elevation}: {error:+.2} +- {noise:.2} %");
                assert!(
                    error.abs() < 2.0 + 2.0 * noise,
                    "{depth} {sun_deg} {azimuth} {elevation}: {error:.2} %"
                );
            }
        }
    }
}

#[test]
fn skies_under_thick_haze_match_monte_carlo() {
    check_haze(&[10.0]);
}

#[test]
#[ignore = "solves for seven skies"]
fn skies_under_haze_of_any_depth_match_monte_carlo() {
    check_haze(&[5.0, 10.0, 20.0, 30.0]);
}

/// Recomputes the table.
#[test]
#[ignore = "minutes of path tracing"]
fn haze_table_is_reproduced() {
    for row in numbers::<10>(HAZE) {
        let [depth, sun_deg, azimuth, elevation, light @ ..] = row;
        let settings = MonteCarloSettings::default();
        let paths = MonteCarlo::new(&hazy(row), &haze_grid(), settings).unwrap();
        let most = if depth > 5.0 { 262_144 } else { 131_072 };
        let (sun, view) = (direction(0.0, sun_deg), direction(azimuth, elevation));
        let found = paths.radiance_within(0.004, most, EYE_M, sun, view);
        for lane in 0..3 {
            let (got, expected) = (found.mean[lane], light[lane]);
            let error = found.standard_error[lane].hypot(light[lane + 3]);
            assert!((got - expected).abs() < 1e-5 * expected + 5.0 * error);
        }
    }
}

/// Airs that extend far above a thick layer, where light spreads sideways, with profiles given by few knots: without mixing the
/// iteration alternates and grows.
#[test]
#[ignore = "takes half a minute"]
fn dust_of_tabulated_profiles_converges() {
    for (nu, top_m, interpolation) in [
        (0.003, 100e3, Interpolation::Linear),
        (0.01, 100e3, Interpolation::LogLinear),
    ] {
        let mut air = presets::mars();
        let altitudes_m: Vec<f64> = (0..=20).map(|i| top_m * f64::from(i) / 20.0).collect();
        let density = |z: &f64| {
            let thinner = (z / 11.1e3_f64).exp();
            (nu * (1.0 - thinner)).exp() / thinner
        };
        let densities = altitudes_m.iter().map(density).collect();
        let profile = DensityProfile::tabulated(altitudes_m, densities, interpolation).unwrap();
        let dust = air
            .constituents
            .iter_mut()
            .find(|part| part.kind == ConstituentKind::Aerosol);
        let dust = dust.unwrap();
        let thicker = 8.5 / (dust.extinction_per_m(550.0) * profile.column_m(0.0, 120e3));
        dust.scattering_per_m = dust.scattering_per_m.clone().scaled(thicker);
        dust.absorption_per_m = dust.absorption_per_m.clone().scaled(thicker);
        dust.density = profile;
        let settings = SkySettings {
            suns: SunCoverage::near(45.0, 0.0),
            ..SkySettings::default()
        };
        let grid = WavelengthGrid::from_wavelengths_nm(vec![680.0]).unwrap();
        let sky = Sky::prepare(&air, &grid, &settings);
        let error = sky.map(|sky| sky.iteration_error());
        assert!(matches!(error, Ok(0.0..0.002)), "{nu}: {error:?}");
    }
}
