//! The solver against outside truth: Monte Carlo and SASKTRAN2 on the sphere, for three atmospheres.
//!
//! `data/` holds copies of the tables; its README says where they come from. Observer at the ground, point sun, no disc;
//! radiance per unit solar irradiance, so that no choice of solar spectrum enters. Run with `--nocapture` for the table
//! of errors that the book shows.

use airlight::axes::direction;
use airlight::medium::{Atmosphere, reference};
use airlight::sky::{LineOfSight, Sky, SkySettings, SunCoverage};
use airlight::spectrum::WavelengthGrid;
use std::collections::BTreeMap;

/// One atmosphere under one sun, solved for at the three wavelengths of a table.
struct Case {
    sky: Sky,
    /// Solar irradiance of the table at each wavelength.
    solar: Vec<f64>,
    sun_zenith_deg: f64,
}

impl Case {
    fn new(
        atmosphere: &Atmosphere,
        wavelengths_nm: &[f64],
        unit_solar: bool,
        sun_zenith_deg: f64,
        settings: &SkySettings,
    ) -> Self {
        let grid = WavelengthGrid::from_wavelengths_nm(wavelengths_nm.to_vec()).unwrap();
        let suns = SunCoverage::near(90.0 - sun_zenith_deg, 0.0);
        let sky = Sky::prepare(
            atmosphere,
            &grid,
            &SkySettings {
                suns,
                ..settings.clone()
            },
        )
        .unwrap();
        let solar = |&nm: &f64| {
            if unit_solar {
                1.0
            } else {
                atmosphere.solar_irradiance.at(nm)
            }
        };
        Self {
            sky,
            solar: wavelengths_nm.iter().map(solar).collect(),
            sun_zenith_deg,
        }
    }

    /// Single scattering and all orders, in the unit of the table.
    fn radiance(&self, view_zenith_deg: f64, relative_azimuth_deg: f64, lane: usize) -> (f64, f64) {
        let view = self
            .sky
            .view(0.0, direction(0.0, 90.0 - self.sun_zenith_deg));
        let line: LineOfSight = view.along(
            direction(relative_azimuth_deg, 90.0 - view_zenith_deg),
            None,
        );
        let scale = self.solar[lane] / f64::from(view.solar_irradiance()[lane]);
        (
            f64::from(line.single[lane]) * scale,
            f64::from(line.radiance()[lane]) * scale,
        )
    }
}

/// The atmospheres, with the wavelengths at which their coefficients are those of the tables' columns.
fn atmosphere(name: &str) -> (Atmosphere, &'static [f64; 3], bool) {
    match name {
        "a0.0" => (reference::rayleigh(0.0), &[440.0, 550.0, 680.0], true),
        "a0.3" => (reference::rayleigh(0.3), &[440.0, 550.0, 680.0], true),
        "earth_demo" => (reference::earth_demo(), &[440.0, 550.0, 680.0], false),
        "csm" => (reference::csm(), &[442.25, 548.0, 677.25], false),
        other => panic!("no atmosphere {other}"),
    }
}

fn lane(channel: &str) -> usize {
    match channel.trim_start_matches("L_").trim_start_matches("beta") {
        "33.1e-6" | "440" | "442.25" => 0,
        "13.5e-6" | "550" | "548" => 1,
        "5.8e-6" | "680" | "677.25" => 2,
        other => panic!("no channel {other}"),
    }
}

fn rows(text: &str) -> (Vec<&str>, Vec<Vec<&str>>) {
    let mut lines = text.lines();
    let header = lines.next().unwrap().split(',').collect();
    (
        header,
        lines.map(|line| line.split(',').collect()).collect(),
    )
}

fn number(text: &str) -> f64 {
    text.parse()
        .unwrap_or_else(|_| panic!("not a number: {text}"))
}

#[derive(Default)]
struct Errors(Vec<f64>);

impl Errors {
    fn summary(&self) -> String {
        let n = self.0.len() as f64;
        let mean = self.0.iter().sum::<f64>() / n;
        let rms = (self.0.iter().map(|e| e * e).sum::<f64>() / n).sqrt();
        let worst = self.0.iter().fold(0.0f64, |w, e| w.max(e.abs()));
        format!(
            "{n:4} views, mean {:+.2} %, rms {:.2} %, worst {:.2} %",
            100.0 * mean,
            100.0 * rms,
            100.0 * worst
        )
    }
}

/// The largest error allowed for all orders: 1 % up to a sun zenith angle of 80 degrees, 2 % at 87 and 88.
fn limit(sun_zenith_deg: f64) -> f64 {
    if sun_zenith_deg <= 80.0 { 0.01 } else { 0.02 }
}

const MONTE_CARLO: [&str; 3] = [
    include_str!("data/mc_sphere_rayleigh.csv"),
    include_str!("data/mc_sphere_earth_demo.csv"),
    include_str!("data/mc_sphere_csm.csv"),
];

#[test]
fn all_orders_agree_with_monte_carlo() {
    for text in MONTE_CARLO {
        let mut by_case: BTreeMap<(&str, &str), Vec<Vec<&str>>> = BTreeMap::new();
        for row in rows(text).1 {
            by_case.entry((row[0], row[1])).or_default().push(row);
        }
        for ((config, sun), rows) in by_case {
            let (air, wavelengths, unit_solar) = atmosphere(config);
            let case = Case::new(
                &air,
                wavelengths,
                unit_solar,
                number(sun),
                &SkySettings::default(),
            );
            let mut errors = Errors::default();
            for row in rows {
                let (_, all) = case.radiance(number(row[2]), number(row[3]), lane(row[4]));
                let (want, standard_error) = (number(row[5]), number(row[6]));
                errors.0.push(all / want - 1.0);
                let allowed = limit(number(sun)) * want + 3.0 * standard_error;
                assert!(
                    (all - want).abs() < allowed,
                    "{row:?}: got {all:.6e}, {:.2} %",
                    100.0 * (all / want - 1.0)
                );
            }
            println!(
                "Monte Carlo, all orders   {config:>10}, sun zenith {sun:>2}: {}",
                errors.summary()
            );
        }
    }
}

/// SASKTRAN2 agrees with the Monte Carlo to 0.3 % (95th percentile; csm 1.1 %): allowed here on top of our own limit.
#[test]
fn single_scattering_and_all_orders_agree_with_sasktran() {
    for (text, config_column, tolerance) in [
        (include_str!("data/sasktran2_rayleigh_sphere.csv"), 1, 0.003),
        (include_str!("data/sasktran2_earth_demo.csv"), 0, 0.003),
        (include_str!("data/sasktran2_csm.csv"), 0, 0.011),
    ] {
        let (header, rows) = rows(text);
        let mut by_case: BTreeMap<(String, &str, &str), Vec<Vec<&str>>> = BTreeMap::new();
        let mode_column = 1 - config_column;
        for row in rows {
            let config = match row[config_column] {
                "0" | "0.0" => "a0.0".to_string(),
                "0.3" => "a0.3".to_string(),
                other => other.to_string(),
            };
            by_case
                .entry((config, row[mode_column], row[2]))
                .or_default()
                .push(row);
        }
        for ((config, mode, sun), rows) in by_case {
            let (air, wavelengths, unit_solar) = atmosphere(&config);
            let case = Case::new(
                &air,
                wavelengths,
                unit_solar,
                number(sun),
                &SkySettings::default(),
            );
            let mut errors = Errors::default();
            for row in rows {
                for column in 5..8 {
                    let (single, all) =
                        case.radiance(number(row[3]), number(row[4]), lane(header[column]));
                    let (got, allowed) = match mode {
                        "single" => (single, 0.002),
                        _ => (all, limit(number(sun)) + tolerance),
                    };
                    let error = got / number(row[column]) - 1.0;
                    errors.0.push(error);
                    assert!(
                        error.abs() < allowed,
                        "{mode} {row:?} {}: got {got:.6e}, {:.2} %",
                        header[column],
                        100.0 * error
                    );
                }
            }
            println!(
                "SASKTRAN2, {mode:>8}       {config:>10}, sun zenith {sun:>2}: {}",
                errors.summary()
            );
        }
    }
}

/// Prints what each setting of the solver buys: the errors against the Monte Carlo with that setting alone changed.
#[test]
#[ignore = "prints a table of the book; fails only where the solver does"]
fn what_each_setting_buys() {
    type Change = fn(&mut SkySettings);
    let changes: [(&str, Change); 10] = [
        ("default", |_| ()),
        ("altitudes 12", |s| s.altitudes = 12),
        ("altitudes 40", |s| s.altitudes = 40),
        ("degree 5, peak degree 6", |s| {
            (s.orders.degree, s.orders.peak_degree) = (5, 6)
        }),
        ("degree 12, peak degree 14", |s| {
            (s.orders.degree, s.orders.peak_degree) = (12, 14)
        }),
        ("rescattered degree 2", |s| s.orders.rescattered_degree = 2),
        ("rescattered degree 8", |s| s.orders.rescattered_degree = 8),
        ("first order 4 + 3 + 4 zenith angles", |s| {
            s.orders.first.zenith_nodes = [4, 3, 4]
        }),
        ("later orders 8 + 8 + 10 zenith angles", |s| {
            s.orders.later.zenith_nodes = [8, 8, 10]
        }),
        ("tolerance 0.001", |s| s.orders.tolerance = 0.001),
    ];
    for (name, change) in changes {
        let mut settings = SkySettings::default();
        change(&mut settings);
        let (mut errors, mut low) = (Errors::default(), Errors::default());
        for row in MONTE_CARLO
            .iter()
            .flat_map(|text| rows(text).1)
            .collect::<Vec<_>>()
            .chunk_by(|a, b| a[..2] == b[..2])
        {
            let (config, sun) = (row[0][0], row[0][1]);
            let (air, wavelengths, unit_solar) = atmosphere(config);
            let case = Case::new(&air, wavelengths, unit_solar, number(sun), &settings);
            for row in row {
                let (_, all) = case.radiance(number(row[2]), number(row[3]), lane(row[4]));
                let error = all / number(row[5]) - 1.0;
                assert!(error.is_finite());
                if number(sun) <= 80.0 {
                    errors.0.push(error)
                } else {
                    low.0.push(error)
                }
            }
        }
        println!(
            "{name:>38} | {} | low sun {}",
            errors.summary(),
            low.summary()
        );
    }
}
