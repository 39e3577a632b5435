//! Polarised light of the sky solver against paths of light.

use crate::common;
use airlight::atmosphere::{
    AerosolLoad, AerosolMixture, AerosolType, Atmosphere, ConstituentKind, preset,
};
use airlight::axes::direction;
use airlight::monte_carlo::{MonteCarlo, MonteCarloSettings, PolarisedEstimate};
use airlight::sky::{PolarisationTable, Sky, SkySettings};
use airlight::spectrum::WavelengthGrid;

const TABLE: &str = include_str!("../../../airlight-validation/data/sky_polarised_monte_carlo.csv");

const WAVELENGTHS_NM: [f64; 4] = [360.0, 450.0, 550.0, 650.0];

/// A row of the table: radiance, effect of polarisation on it, Q and U, each with its standard error.
struct Row {
    air: &'static str,
    sun: f64,
    azimuth: f64,
    elevation: f64,
    lane: usize,
    values: [[f64; 2]; 4],
}

fn rows() -> Vec<Row> {
    common::rows(TABLE)
        .map(|fields| {
            let number = |k: usize| fields[k].parse::<f64>().unwrap();
            Row {
                air: fields[0],
                sun: number(1),
                azimuth: number(2),
                elevation: number(3),
                lane: WAVELENGTHS_NM
                    .iter()
                    .position(|&nm| nm == number(4))
                    .unwrap(),
                values: [5, 7, 9, 11].map(|k| [number(k), number(k + 1)]),
            }
        })
        .collect()
}

/// Clear air, or hazy air whose haze consists of spheres with known polarisation.
fn atmosphere(name: &str) -> Atmosphere {
    if name == "clear" {
        return preset(name).unwrap();
    }
    let mut air = preset("hazy").unwrap();
    let haze = air.constituent(&ConstituentKind::Aerosol).unwrap();
    let density = Some(haze.density.clone());
    let mixture = AerosolMixture::of(
        AerosolType::ContinentalAverage,
        AerosolMixture::USUAL_HUMIDITY,
    )
    .unwrap();
    let load = Some(AerosolLoad::OpticalDepth550(0.35));
    let (ground, top) = (air.planet.ground_altitude_m, air.planet.top_altitude_m);
    let particles = mixture
        .constituent(load, density, air.clear_air(), ground, top)
        .unwrap();
    air.constituents
        .retain(|part| part.kind != ConstituentKind::Aerosol);
    air.constituents.push(particles);
    air
}

fn grid() -> WavelengthGrid {
    WavelengthGrid::from_wavelengths_nm(WAVELENGTHS_NM.to_vec()).unwrap()
}

/// Root mean squares in percent of the radiance.
#[derive(Default)]
struct Errors {
    count: f64,
    /// The effect of polarisation on the radiance, what is left of it after the correction, and the noise of the table.
    effect: [f64; 3],
    /// Distance of (Q, U) from that of the table, and the noise of the table.
    linear: [f64; 2],
}

impl Errors {
    fn rms(&self) -> ([f64; 3], [f64; 2]) {
        let root = |sum: f64| 100.0 * (sum / self.count).sqrt();
        (self.effect.map(root), self.linear.map(root))
    }
}

/// The correction removes the error of scalar light, which is up to 13 % at 360 nm: what is left is the noise of the table. Q and U
/// follow in clear air; in haze, of whose polarisation only the moments of degree 2 are solved for, they are less accurate.
#[test]
fn the_polarised_sky_matches_monte_carlo() {
    let rows = rows();
    for name in ["clear", "continental"] {
        let air = atmosphere(name);
        let [polarised, scalar] = [true, false].map(|polarisation_correction| {
            let settings = SkySettings {
                polarisation_correction,
                ..Default::default()
            };
            Sky::prepare(&air, &grid(), &settings).unwrap()
        });
        for sun in [60.0, 30.0, 5.0, -2.0] {
            let [polarised, scalar] =
                [&polarised, &scalar].map(|sky| sky.view(2.0, direction(0.0, sun)));
            let mut errors = Errors::default();
            for row in rows.iter().filter(|row| row.air == name && row.sun == sun) {
                let towards = direction(row.azimuth, row.elevation);
                let light = polarised.polarised(towards);
                let without = scalar.along(towards, None).radiance()[row.lane];
                let [[i, _], [effect, noise], [q, noise_q], [u, noise_u]] = row.values;
                let at = |values: &[f32]| f64::from(values[row.lane]);
                let found = at(&light.intensity) - f64::from(without);
                let squares = [effect, found - effect, noise].map(|v| (v / i).powi(2));
                let off = (at(&light.q) - q).hypot(at(&light.u) - u);
                let linear = [off, noise_q.hypot(noise_u)].map(|v| (v / i).powi(2));
                errors.count += 1.0;
                errors
                    .effect
                    .iter_mut()
                    .zip(squares)
                    .for_each(|(sum, v)| *sum += v);
                errors
                    .linear
                    .iter_mut()
                    .zip(linear)
                    .for_each(|(sum, v)| *sum += v);
            }
            let ([effect, left, noise], [linear, linear_noise]) = errors.rms();
            println!(
                "{name}, sun at {sun}: effect {effect:.2} %, left {left:.2} % (noise {noise:.2} %); Q and U off by {linear:.2} % \
                 (noise {linear_noise:.2} %)"
            );
            assert!(left < 1.5 * noise + 0.03 * effect, "{name} {sun}: {left}");
            let limit = match (name, sun > 20.0) {
                ("clear", _) => 0.2,
                (_, true) => 3.0,
                (_, false) => 7.0,
            };
            assert!(
                linear < 1.5 * linear_noise + limit,
                "{name} {sun}: {linear}"
            );
        }
    }
}

/// What symmetry demands, and that a table holds the polarisation of the views it was made from.
#[test]
fn polarisation_is_symmetric_and_tabulated() {
    let settings = SkySettings::default();
    let sky = Sky::prepare(&atmosphere("clear"), &WavelengthGrid::fast(), &settings).unwrap();
    for (eye_m, sun_deg) in [(2.0, 25.0), (2.0, 0.0), (2.0, -4.0), (20_000.0, 40.0)] {
        let view = sky.view(eye_m, direction(130.0, sun_deg));
        let table = PolarisationTable::new(&view);
        let luminous = |values: &[f32]| sky.grid().to_xyz(values)[1];
        for (azimuth, elevation) in [(130.0, 70.0), (310.0, 20.0), (130.0, -40.0)] {
            let light = view.polarised(direction(azimuth, elevation));
            let off = light
                .u
                .iter()
                .zip(&light.intensity)
                .map(|(u, i)| (u / i).abs());
            assert!(
                off.fold(0.0, f32::max) < 1e-4,
                "{eye_m} {sun_deg} {azimuth}"
            );
        }
        for (azimuth, elevation) in [(30.0, 50.0), (71.0, 12.0), (128.0, 31.0), (95.0, -60.0)] {
            let [one, other] = [azimuth, 260.0 - azimuth].map(|azimuth| {
                let light = view.polarised(direction(azimuth, elevation));
                let degree = light.degree();
                assert!(degree.iter().all(|d| (0.0..1.0).contains(d)), "{degree:?}");
                let i = luminous(&light.intensity);
                let fractions = [luminous(&light.q) / i, luminous(&light.u) / i];
                let tabulated = table.sample(direction(azimuth, elevation));
                for (table, exact) in tabulated.into_iter().zip(fractions) {
                    let off = (f64::from(table) - exact).abs();
                    assert!(off < 0.01, "{eye_m} {sun_deg} {azimuth} {elevation}: {off}");
                }
                fractions
            });
            assert!((one[0] - other[0]).abs() < 1e-4 && (one[1] + other[1]).abs() < 1e-4);
        }
        // At the zenith the plane is that of the eye's meridian: polarised across the sun's plane.
        let zenith = view.polarised(direction(0.0, 90.0));
        let beside = view.polarised(direction(0.0, 89.99));
        for (a, b) in zenith.degree().iter().zip(beside.degree()) {
            assert!((a - b).abs() < 1e-3, "{a} {b}");
        }
        for angle in zenith.angle_deg() {
            // From south, anticlockwise as seen by an eye that looks up; the sun's azimuth is 130 from north, so its plane is 50
            // clockwise as seen from above from the meridian.
            assert!(
                (angle - 140.0).abs() < 0.1 || (angle - 40.0).abs() < 0.1,
                "{angle}"
            );
        }
    }
}

fn traced(row: &Row, paths: u64) -> PolarisedEstimate {
    let settings = MonteCarloSettings {
        paths,
        ..Default::default()
    };
    let air = MonteCarlo::new(&atmosphere(row.air), &grid(), settings).unwrap();
    let sun = direction(0.0, row.sun);
    air.polarised(2.0, sun, direction(row.azimuth, row.elevation), None)
}

/// Recomputes the table.
#[test]
#[ignore = "minutes of path tracing"]
fn polarised_table_is_reproduced() {
    for row in rows().iter().filter(|row| row.lane == 0) {
        let found = traced(row, 131_072);
        for (lane, nm) in WAVELENGTHS_NM.iter().enumerate() {
            let values = [&found.intensity, &found.effect, &found.q, &found.u]
                .map(|part| format!("{:.5e},{:.1e}", part.mean[lane], part.standard_error[lane]));
            println!(
                "{},{},{},{},{nm},{}",
                row.air,
                row.sun,
                row.azimuth,
                row.elevation,
                values.join(",")
            );
        }
        for ([expected, error], part) in
            row.values
                .into_iter()
                .zip([&found.intensity, &found.effect, &found.q, &found.u])
        {
            let error = error.max(part.standard_error[0]);
            assert!((part.mean[0] - expected).abs() < 6.0 * error, "{expected}");
        }
    }
}
