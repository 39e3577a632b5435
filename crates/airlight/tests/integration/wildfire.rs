//! The sky under the smoke of forest fires: against paths of light, and against the loss of irradiance measured over Moscow.

use crate::common::{numbers, scalar_settings};
use airlight::atmosphere::{Atmosphere, ConstituentKind, presets};
use airlight::axes::direction;
use airlight::monte_carlo::{MonteCarlo, MonteCarloSettings};
use airlight::sky::{Sky, SunCoverage, TableChannels};
use airlight::spectrum::WavelengthGrid;
use glam::DVec3;

const TABLE: &str = include_str!("../../../airlight-validation/data/sky_smoke_monte_carlo.csv");

const WAVELENGTHS_NM: [f64; 3] = [440.0, 550.0, 680.0];
const EYE_M: f64 = 2.0;

/// A row of the table.
struct Row {
    sun: f64,
    azimuth: f64,
    elevation: f64,
    radiance: [f64; 3],
    standard_error: [f64; 3],
}

fn rows() -> Vec<Row> {
    numbers::<9>(TABLE)
        .map(|[sun, azimuth, elevation, light @ ..]| Row {
            sun,
            azimuth,
            elevation,
            radiance: [light[0], light[1], light[2]],
            standard_error: [light[3], light[4], light[5]],
        })
        .collect()
}

fn solved(air: &Atmosphere, nm: &[f64], sun: f64) -> Sky {
    let settings = scalar_settings(SunCoverage::near(sun, 0.0));
    let grid = WavelengthGrid::from_wavelengths_nm(nm.to_vec()).unwrap();
    Sky::prepare(air, &grid, &settings).unwrap()
}

/// Four views under a sun at 50 and at 15 degrees: each within 0.5 % beyond two standard errors of the paths, and 0.3 % on average.
#[test]
fn the_sky_under_smoke_matches_monte_carlo() {
    let rows = rows();
    let (mut worst, mut sum, mut count) = (0.0_f64, 0.0, 0.0);
    for group in rows.chunk_by(|a, b| a.sun == b.sun) {
        let sun = group[0].sun;
        let sky = solved(&presets::wildfire(), &WAVELENGTHS_NM, sun);
        let view = sky.view(EYE_M, direction(0.0, sun));
        for row in group {
            let got = view
                .along(direction(row.azimuth, row.elevation), None)
                .radiance();
            for lane in 0..3 {
                let difference = f64::from(got[lane]) / row.radiance[lane] - 1.0;
                let noise = 2.0 * row.standard_error[lane] / row.radiance[lane];
                worst = worst.max(100.0 * (difference.abs() - noise));
                sum += 100.0 * difference;
                count += 1.0;
            }
        }
    }
    let mean = sum / count;
    println!("mean {mean:.2} %, worst beyond two standard errors {worst:.2} %");
    assert_eq!(count, 24.0);
    assert!(
        worst < 0.5 && mean.abs() < 0.3,
        "mean {mean:.2} %, worst {worst:.2} %"
    );
}

/// On 7 August 2010 an optical depth of 6.4 at 500 nm took 91 % of the irradiance from 300 to 380 nm in Moscow, with the sun 47
/// degrees high (Chubarova et al., Atmos. Meas. Tech. 5, 557, 2012).
#[test]
fn smoke_takes_as_much_ultraviolet_light_as_measured() {
    let nm: Vec<f64> = (0..=8).map(|k| 300.0 + 10.0 * f64::from(k)).collect();
    let irradiance = |air: &Atmosphere| {
        let sky = solved(air, &nm, 47.0);
        let view = sky.view(EYE_M, direction(0.0, 47.0));
        let diffuse = view.table(TableChannels::Spectral).irradiance(DVec3::Y);
        let sin = 47_f64.to_radians().sin();
        let global: Vec<f64> = view
            .sun_irradiance()
            .iter()
            .zip(&diffuse)
            .map(|(sun, sky)| f64::from(*sun) * sin + f64::from(*sky))
            .collect();
        global
            .windows(2)
            .map(|pair| 5.0 * (pair[0] + pair[1]))
            .sum::<f64>()
    };
    let mut smoky = presets::wildfire();
    let is_smoke = |kind: &ConstituentKind| *kind == ConstituentKind::Aerosol;
    let top_m = smoky.planet.top_altitude_m;
    let smoke = smoky
        .constituents
        .iter_mut()
        .find(|part| is_smoke(&part.kind))
        .unwrap();
    let thicker = 6.4 / smoke.optical_depth(0.0, top_m, 500.0);
    smoke.scattering_per_m = smoke.scattering_per_m.clone().scaled(thicker);
    smoke.absorption_per_m = smoke.absorption_per_m.clone().scaled(thicker);
    let mut clear = smoky.clone();
    clear.constituents.retain(|part| !is_smoke(&part.kind));
    let loss = 1.0 - irradiance(&smoky) / irradiance(&clear);
    println!("{:.1} % lost", 100.0 * loss);
    assert!((loss - 0.91).abs() < 0.02, "{loss}");
}

/// Recomputes the table.
#[test]
#[ignore = "minutes of path tracing"]
fn smoke_table_is_reproduced() {
    let grid = WavelengthGrid::from_wavelengths_nm(WAVELENGTHS_NM.to_vec()).unwrap();
    let paths = MonteCarlo::new(&presets::wildfire(), &grid, MonteCarloSettings::default());
    let paths = paths.unwrap();
    for row in rows() {
        let sun = direction(0.0, row.sun);
        let view = direction(row.azimuth, row.elevation);
        let light = paths.radiance_within(0.002, 2_000_000, EYE_M, sun, view);
        for lane in 0..3 {
            let (got, expected) = (light.mean[lane], row.radiance[lane]);
            let error = light.standard_error[lane].hypot(row.standard_error[lane]);
            println!(
                "{} {} {}: {got:.5e} {error:.2e}, {expected:.5e}",
                row.sun, row.azimuth, row.elevation
            );
            assert!((got - expected).abs() < 1e-5 * expected + 5.0 * error);
        }
    }
}
