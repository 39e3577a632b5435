//! Multiple scattering in fog compared with spherical Monte Carlo, which shares only the phase functions with the fog solver.

use crate::common::{GREEN_NM, green_fog, green_path, grey_layer, rows};
use airlight::atmosphere::{Atmosphere, Constituent, ConstituentKind, DensityProfile, Planet};
use airlight::axes::direction;
use airlight::fog::{Fog, FogScattering, Ground, droplets};
use airlight::monte_carlo::{MonteCarlo, MonteCarloSettings};
use airlight::optics::PhaseFunction;
use airlight::optics::mie::droplets::Drops;
use airlight::spectrum::{SpectralCurve, WavelengthGrid};
use airlight::sun::SunDisc;
use glam::DVec3;
use std::f32::consts::PI;

/// Height of the top of the fog, m.
const TOP_M: f64 = 100.0;
/// Height of the eye, m.
const EYE_M: f64 = 2.0;
const GROUND_ALBEDO: f64 = 0.2;
/// Azimuth of the sun, degrees.
const SUN_DEG: f64 = 180.0;

/// A slab of fog without absorption.
struct Scene {
    depth: f64,
    phase: PhaseFunction,
    sun_elevation_deg: f64,
}

impl Scene {
    fn extinction_per_m(&self) -> f64 {
        self.depth / TOP_M
    }

    /// The fog over round ground.
    fn fog(&self) -> Fog {
        let slab = DensityProfile::slab(TOP_M);
        let layer = grey_layer(slab, self.extinction_per_m(), 1.0, self.phase.clone());
        let sun = direction(SUN_DEG, self.sun_elevation_deg);
        let multiple = FogScattering::Multiple;
        green_fog(layer, Ground::EARTH, Some(sun), GROUND_ALBEDO, multiple)
    }

    /// The fog as the atmosphere of a planet.
    fn planet(&self) -> MonteCarlo {
        let air = Atmosphere {
            name: "fog".to_owned(),
            planet: Planet {
                radius_m: Ground::EARTH.radius_m,
                top_altitude_m: TOP_M,
                ground_altitude_m: 0.0,
                ground_albedo: SpectralCurve::Constant(GROUND_ALBEDO),
            },
            constituents: vec![Constituent {
                kind: ConstituentKind::Fog,
                density: DensityProfile::Layer {
                    bottom_m: 0.0,
                    top_m: TOP_M,
                },
                scattering_per_m: SpectralCurve::Constant(self.extinction_per_m()),
                absorption_per_m: SpectralCurve::Constant(0.0),
                phase: self.phase.clone(),
            }],
            solar_irradiance: SpectralCurve::Constant(1.0),
            sun: SunDisc::default(),
        };
        let grid = WavelengthGrid::from_wavelengths_nm(vec![550.0]).unwrap();
        MonteCarlo::new(&air, &grid, MonteCarloSettings::default()).unwrap()
    }
}

/// Views: azimuth relative to the sun and elevation, degrees. The last three are level, or nearly.
const VIEWS: [(f64, f64); 9] = [
    (0.0, 90.0),
    (60.0, 45.0),
    (180.0, 20.0),
    (40.0, 5.0),
    (120.0, 5.0),
    (180.0, -3.0),
    (90.0, 1.0),
    (30.0, 0.0),
    (90.0, 0.0),
];
const SLANT: usize = 6;

impl Scene {
    /// Radiance along a view by the solver, with the light of the ground.
    fn radiance(&self, fog: &Fog, eye_m: f64, view: DVec3) -> f64 {
        let ground = fog.ground_irradiance().unwrap()[0] * GROUND_ALBEDO as f32 / PI;
        let (length_m, behind) = match view.y < 0.0 {
            // The curvature of the ground over this length is below 1e-3 of the eye height.
            true => (eye_m / -view.y, ground),
            false => (f64::INFINITY, 0.0),
        };
        let [transmittance, path_radiance] = green_path(fog, eye_m, view, length_m);
        path_radiance + transmittance * f64::from(behind)
    }

    fn sun(&self) -> DVec3 {
        direction(SUN_DEG, self.sun_elevation_deg)
    }
}

/// Absolute errors of the radiance in each view in percent, and the same reduced by three standard errors of the reference.
fn errors(scene: &Scene) -> (Vec<f64>, Vec<f64>) {
    let (fog, planet) = (scene.fog(), scene.planet());
    let (mut errors, mut significant) = (Vec::new(), Vec::new());
    for (azimuth, elevation) in VIEWS {
        let view = direction(SUN_DEG + azimuth, elevation);
        let truth = planet.radiance_within(2e-3, 1 << 22, EYE_M, scene.sun(), view);
        let seen = scene.radiance(&fog, EYE_M, view);
        let mean = truth.mean[0];
        let noise = 100.0 * truth.standard_error[0] / mean;
        let error = 100.0 * (seen / mean - 1.0);
        println!("    {azimuth:4} {elevation:4}: {mean:.4e} +- {noise:.2} %, off by {error:6.2} %");
        assert!(noise < 1.0, "Monte Carlo noise: {noise} %");
        errors.push(error.abs());
        significant.push((error.abs() - 3.0 * noise).max(0.0));
    }
    (errors, significant)
}

/// Prints a table of the book with `--nocapture`.
#[test]
#[ignore = "takes minutes of Monte Carlo"]
fn multiple_scattering_matches_monte_carlo() {
    let drops = droplets::phase(10.0);
    let peaked = PhaseFunction::HenyeyGreenstein { g: 0.8 };
    // With optical depths, and limits in percent for slant and for level rays beyond three standard errors.
    let high: [(f64, f64, f64); 3] = [(0.05, 1.6, 1.4), (0.5, 1.1, 0.5), (3.0, 1.5, 0.9)];
    let low = [(0.05, 5.6, 4.3), (0.5, 4.2, 3.0), (3.0, 1.3, 0.7)];
    let of_drops = [(0.05, 1.7, 2.1), (0.5, 1.1, 2.0)];
    let mut table = "| vertical optical depth | 0.05 | 0.5 | 3 |\n|---|---|---|---|\n".to_owned();
    for (name, phase, sun_elevation_deg, fogs) in [
        (
            "asymmetry 0.8, sun 30°: 3° and more from level / level or 1° above",
            &peaked,
            30.0,
            &high[..],
        ),
        ("the same, sun 5°", &peaked, 5.0, &low),
        ("drops of 10 µm, sun 30°", &drops, 30.0, &of_drops),
    ] {
        let mut cells = ["", "", ""].map(str::to_owned);
        for (cell, &(depth, slant, level)) in cells.iter_mut().zip(fogs) {
            println!("{name}; optical depth {depth}");
            let (errors, significant) = errors(&Scene {
                depth,
                phase: phase.clone(),
                sun_elevation_deg,
            });
            let worst = |errors: &[f64]| errors.iter().copied().fold(0.0, f64::max);
            let (slants, levels) = errors.split_at(SLANT);
            let short = |error: f64| match error {
                9.95.. => format!("{error:.0}"),
                _ => format!("{error:.1}"),
            };
            *cell = format!("{} / {}", short(worst(slants)), short(worst(levels)));
            let (slants, levels) = significant.split_at(SLANT);
            assert!(worst(slants) < slant, "{slants:.2?}");
            assert!(worst(levels) < level, "{levels:.2?}");
        }
        table += &format!("| {name} | {} |\n", cells.join(" | "));
    }
    print!("\n{table}");
}

/// Light around the sun through thick fog, which the peak of the phase function scatters several times: the aureole has no ring.
#[test]
fn the_aureole_in_thick_fog_matches_monte_carlo() {
    let scene = Scene {
        depth: 6.0,
        phase: droplets::phase(10.0),
        sun_elevation_deg: 60.0,
    };
    let (fog, planet) = (scene.fog(), scene.planet());
    let sun = direction(SUN_DEG, scene.sun_elevation_deg);
    let along = |from_sun_deg: f64| {
        let view = direction(SUN_DEG, scene.sun_elevation_deg - from_sun_deg);
        green_path(&fog, EYE_M, view, f64::INFINITY)[1]
    };
    for from_sun_deg in [1.0, 2.5, 4.0] {
        let view = direction(SUN_DEG, scene.sun_elevation_deg - from_sun_deg);
        let truth = planet.radiance_within(2e-2, 1 << 18, EYE_M, sun, view);
        let ratio = along(from_sun_deg) / truth.mean[0];
        println!(
            "{from_sun_deg}: {ratio:.3} +- {:.3}",
            truth.standard_error[0] / truth.mean[0]
        );
        assert!((0.94..1.07).contains(&ratio), "{from_sun_deg}: {ratio}");
    }
    // Falls without steps.
    let mut before = along(0.3);
    for step in 1..80 {
        let here = along(0.3 + 0.1 * f64::from(step));
        assert!(
            here < before && here > 0.85 * before,
            "{step}: {before} {here}"
        );
        before = here;
    }
}

const TABLE: &str = include_str!("../data/fog_peak_monte_carlo.csv");

/// A row of the table of light that the forward peak of droplets scatters on.
struct Row {
    scene: Scene,
    eye_m: f64,
    view: DVec3,
    radiance: f64,
    standard_error: f64,
    /// Index in [`KINDS`].
    kind: usize,
    inputs: String,
}

/// Kinds of views, with the largest error in percent.
const KINDS: [(&str, f64); 3] = [
    ("2 to 12° beside the sun", 2.0),
    ("bow and glory", 2.0),
    ("level or 1° above", 3.0),
];

fn table() -> Vec<Row> {
    let slab = DensityProfile::slab(TOP_M);
    let drops = Constituent::fog(0.01, Drops::CloudC1.into(), slab, &[GREEN_NM]).unwrap();
    rows(TABLE)
        .map(|row| {
            let number = |column: usize| row[column].parse::<f64>().unwrap();
            let (eye_m, azimuth) = (number(3), number(4));
            Row {
                scene: Scene {
                    depth: number(1),
                    phase: match row[0] {
                        "cloud-c1" => drops.phase.clone(),
                        _ => droplets::phase(10.0),
                    },
                    sun_elevation_deg: number(2),
                },
                eye_m,
                view: direction(SUN_DEG + azimuth, number(5)),
                radiance: number(6),
                standard_error: number(7),
                kind: match (eye_m > TOP_M, azimuth == 0.0) {
                    (true, _) => 1,
                    (false, true) => 0,
                    (false, false) => 2,
                },
                inputs: row[..6].join(","),
            }
        })
        .collect()
}

/// Sunlight that the forward peak scatters on, or out of a ray. Prints a table of the book with `--nocapture`.
#[test]
fn light_of_the_forward_peak_matches_monte_carlo() {
    let table = table();
    let depths = ["0.05", "0.15", "0.6", "2", "6"];
    println!(
        "\n| vertical optical depth | {} |\n|---|---|---|---|---|---|",
        depths.join(" | ")
    );
    for (kind, (name, limit)) in KINDS.into_iter().enumerate() {
        let mut cells = Vec::new();
        for depth in depths {
            let depth: f64 = depth.parse().unwrap();
            let mut worst: f64 = 0.0;
            for row in table
                .iter()
                .filter(|row| row.kind == kind && row.scene.depth == depth)
            {
                let got = row.scene.radiance(&row.scene.fog(), row.eye_m, row.view);
                let error = 100.0 * (got / row.radiance - 1.0);
                let noise = 100.0 * row.standard_error / row.radiance;
                println!("    {}: {error:+.2} +- {noise:.2} %", row.inputs);
                assert!(
                    error.abs() < limit + 3.0 * noise,
                    "{}: {error} %",
                    row.inputs
                );
                worst = if error.abs() > worst.abs() {
                    error
                } else {
                    worst
                };
            }
            cells.push(match worst {
                0.0 => String::new(),
                _ => format!("{worst:+.1}"),
            });
        }
        println!("| {name} | {} |", cells.join(" | "));
    }
}

/// Recomputes the table of light that the forward peak scatters on.
#[test]
#[ignore = "takes minutes of Monte Carlo"]
fn forward_peak_table_is_reproduced() {
    for row in table() {
        let (planet, sun) = (row.scene.planet(), row.scene.sun());
        let truth = planet.radiance_within(4e-3, 1 << 20, row.eye_m, sun, row.view);
        let (got, error) = (truth.mean[0], truth.standard_error[0]);
        println!("{},{got:.5e},{error:.2e}", row.inputs);
        let error = error.max(row.standard_error);
        assert!((got - row.radiance).abs() < 1e-5 * got + 6.0 * error);
    }
}
