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

/// The ground of Venus is orange: Venera 8 found 1.5 % of all sunlight at the ground with the sun at 5.5 degrees.
#[test]
fn light_at_the_ground_of_venus_is_faint_and_orange() {
    let got = transmitted("venus", &[440.0, 550.0, 680.0], 5.5);
    println!("venus: {got:?}");
    assert!(got[0] < 0.5 * got[1] && got[1] < got[2], "{got:?}");
    // Infrared light, of which gases absorb most, is in the published part.
    assert!((0.005..0.06).contains(&got[1]), "{got:?}");
}

/// The ground of Titan is a thousand times dimmer than the Earth's in full sunlight, and orange (Tomasko et al., Nature 438, 765, 2005).
#[test]
fn light_at_the_ground_of_titan_is_faint_and_orange() {
    let nm = [440.0, 550.0, 680.0];
    let (titan, earth) = (
        transmitted("titan", &nm, 58.0),
        transmitted("average", &nm, 58.0),
    );
    let outside = 9.58_f64.powi(-2);
    let dimmer: Vec<f64> = earth
        .iter()
        .zip(&titan)
        .map(|(e, t)| e / (t * outside))
        .collect();
    println!("titan: {titan:?}, dimmer by {dimmer:?}");
    assert!((300.0..2000.0).contains(&dimmer[1]), "{dimmer:?}");
    assert!(
        titan[0] < 0.3 * titan[1] && titan[1] < 0.7 * titan[2],
        "{titan:?}"
    );
}

/// Radiances from above the air, and from the ground where paths still reach the sun, one wavelength at a time.
#[test]
#[ignore = "minutes of path tracing"]
fn skies_of_thick_airs_match_monte_carlo() {
    let from_above = [(0.0, -90.0), (90.0, -60.0), (180.0, -40.0)];
    let from_ground = [(0.0, 90.0), (90.0, 30.0), (180.0, 10.0)];
    let cases = [
        ("venus", true, [440.0, 550.0, 680.0]),
        ("titan", true, [440.0, 550.0, 680.0]),
        ("titan", false, [550.0, 600.0, 680.0]),
        ("dust-storm", true, [440.0, 550.0, 680.0]),
        ("dust-storm", false, [440.0, 550.0, 680.0]),
    ];
    let mut wrong = Vec::new();
    for (name, above, wavelengths) in cases {
        let air = preset(name).unwrap();
        let (eye_m, directions) = match above {
            true => (air.planet.top_altitude_m - 1e3, from_above),
            false => (0.0, from_ground),
        };
        for nm in wavelengths {
            for sun in [60.0, 20.0] {
                let settings = scalar_settings(SunCoverage::near(sun, eye_m));
                let sky = Sky::prepare(&air, &grid(&[nm]), &settings).unwrap();
                let view = sky.view(eye_m, direction(0.0, sun));
                let paths =
                    MonteCarlo::new(&air, &grid(&[nm]), MonteCarloSettings::default()).unwrap();
                for (azimuth, elevation) in directions {
                    let towards = direction(azimuth, elevation);
                    let expected =
                        paths.radiance_within(0.005, 65_536, eye_m, direction(0.0, sun), towards);
                    let got = f64::from(view.along(towards, None).radiance()[0]);
                    let error = expected.standard_error[0] / expected.mean[0];
                    let difference = got / expected.mean[0] - 1.0;
                    let line = format!(
                        "{name} from {eye_m} m, sun {sun}, {nm} nm, {azimuth} {elevation}: {:.2} % +- {:.2} %",
                        100.0 * difference,
                        100.0 * error
                    );
                    println!("{line}");
                    if difference.abs() > 0.02 + 3.0 * error {
                        wrong.push(line);
                    }
                }
            }
        }
    }
    assert!(wrong.is_empty(), "{}", wrong.join("\n"));
}
