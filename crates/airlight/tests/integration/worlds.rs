//! The thick airs of other worlds: published measurements at the surface, and paths of light.

use crate::common::scalar_settings;
use airlight::atmosphere::presets::preset;
use airlight::axes::direction;
use airlight::monte_carlo::{MonteCarlo, MonteCarloSettings};
use airlight::sky::{Sky, SunCoverage, TableChannels, View};
use airlight::spectrum::WavelengthGrid;
use glam::DVec3;

fn grid(nm: &[f64]) -> WavelengthGrid {
    WavelengthGrid::from_wavelengths_nm(nm.to_vec()).unwrap()
}

fn view(name: &str, nm: &[f64], sun: f64) -> View {
    let settings = scalar_settings(SunCoverage::near(sun, 0.0));
    let sky = Sky::prepare(&preset(name).unwrap(), &grid(nm), &settings).unwrap();
    sky.view(0.0, direction(0.0, sun))
}

/// Irradiance on level ground over that outside the air, at each wavelength.
fn transmitted(name: &str, nm: &[f64], sun: f64) -> Vec<f64> {
    let view = view(name, nm, sun);
    let sine = sun.to_radians().sin();
    let sky = view.table(TableChannels::Spectral).irradiance(DVec3::Y);
    let outside = preset(name).unwrap().solar_irradiance;
    let direct = view.sun_irradiance();
    let parts = sky.iter().zip(direct).zip(nm);
    parts
        .map(|((sky, direct), nm)| {
            (f64::from(*sky) + f64::from(direct) * sine) / (outside.at(*nm) * sine)
        })
        .collect()
}

/// Curiosity's ultraviolet sensors, 200 to 380 nm, lost 97 % of the light when the optical depth rose to 8.5 (Guzewich et al. 2019).
#[test]
fn a_dust_storm_takes_ultraviolet_light_as_measured() {
    let nm = [350.0, 375.0];
    let [clear, storm] = ["mars", "dust-storm"].map(|name| transmitted(name, &nm, 60.0));
    for (clear, storm) in clear.iter().zip(&storm) {
        let lost = 1.0 - storm / clear;
        println!(
            "dust-storm: {clear:.4} {storm:.4}, {:.2} % lost",
            100.0 * lost
        );
        assert!((0.95..0.99).contains(&lost), "{lost}");
    }
}

/// Radiances in three directions, in percent of those of paths of light.
#[test]
#[ignore = "minutes of path tracing"]
fn skies_of_thick_airs_match_monte_carlo() {
    let nm = [440.0, 550.0, 680.0];
    for name in ["dust-storm"] {
        for sun in [60.0, 20.0] {
            let view = view(name, &nm, sun);
            let paths = MonteCarlo::new(
                &preset(name).unwrap(),
                &grid(&nm),
                MonteCarloSettings {
                    paths: 4_096,
                    ..Default::default()
                },
            )
            .unwrap();
            for (azimuth, elevation) in [(0.0, 90.0), (90.0, 30.0), (180.0, 10.0)] {
                let towards = direction(azimuth, elevation);
                let expected =
                    paths.radiance_within(0.005, 65_536, 0.0, direction(0.0, sun), towards);
                let got = view.along(towards, None).radiance();
                for lane in 0..3 {
                    let (mean, error) = (expected.mean[lane], expected.standard_error[lane]);
                    let difference = f64::from(got[lane]) / mean - 1.0;
                    println!(
                        "{name} {sun} {azimuth} {elevation} {}: {:.2} % +- {:.2} %",
                        nm[lane],
                        100.0 * difference,
                        100.0 * error / mean
                    );
                    assert!(difference.abs() < 0.02 + 3.0 * error / mean, "{name} {sun}");
                }
            }
        }
    }
}
