//! Airlight's Monte Carlo compared with another code: the same physics, so differences must be noise.

use airlight::axes::direction;
use airlight::monte_carlo::{Estimate, MonteCarlo, MonteCarloSettings};
use airlight::spectrum::WavelengthGrid;
use airlight_validation::skies::{atmosphere, lane};
use airlight_validation::table::{Line, Table};

const TABLES: [&str; 3] = [
    include_str!("../../data/mc_sphere_rayleigh.csv"),
    include_str!("../../data/mc_sphere_earth_demo.csv"),
    include_str!("../../data/mc_sphere_csm.csv"),
];

/// Angles of the sun and the view of a line.
fn angles(line: &Line<'_>) -> [f64; 3] {
    ["sun_zenith_deg", "view_zenith_deg", "rel_azimuth_deg"].map(|name| line.number(name))
}

/// Compares every `stride`-th direction of all tables; differences divided by their standard errors, for all orders and for
/// each of the first four.
fn deviations(stride: usize, paths: u64) -> (Vec<f64>, Vec<f64>) {
    let (mut all, mut by_order) = (Vec::new(), Vec::new());
    let mut directions = 0;
    for text in TABLES {
        let table = Table::new(text);
        let lines: Vec<Line<'_>> = table.lines().collect();
        let mut solver: Option<(&str, MonteCarlo)> = None;
        let mut looked: Option<([f64; 3], Estimate)> = None;
        for line in &lines {
            let config = line.text("config");
            if solver.as_ref().is_none_or(|(name, _)| *name != config) {
                let (air, wavelengths) = atmosphere(config);
                let grid = WavelengthGrid::from_wavelengths_nm(wavelengths.to_vec()).unwrap();
                let settings = MonteCarloSettings {
                    paths,
                    ..Default::default()
                };
                solver = Some((config, MonteCarlo::new(&air, &grid, settings).unwrap()));
                looked = None;
            }
            let Some((_, sky)) = &solver else {
                unreachable!()
            };
            let at = angles(line);
            if looked.as_ref().is_none_or(|(before, _)| *before != at) {
                directions += 1;
                if directions % stride != 0 {
                    looked = None;
                    continue;
                }
                let [sun, view, azimuth] = at;
                let (sun, view) = (direction(0.0, 90.0 - sun), direction(azimuth, 90.0 - view));
                looked = Some((at, sky.radiance(0.0, sun, view)));
            }
            let Some((_, found)) = &looked else { continue };
            let (air, wavelengths) = atmosphere(config);
            let lane = lane(line.text("channel"));
            let solar =
                air.solar_irradiance.at(wavelengths[lane]) / sky.grid().solar_irradiance()[lane];
            let ours = found.mean[lane] * solar;
            let noise = (found.standard_error[lane] * solar).hypot(line.number("SE"));
            all.push((ours - line.number("L")) / noise);
            for (order, part) in found.orders[..4].iter().enumerate() {
                let theirs = line.number(&format!("L_order{}", order + 1));
                // The other code's noise in a single order is not stated: it is at most that of the sum.
                let noise = (part.standard_error[lane] * solar).hypot(line.number("SE"));
                by_order.push((part.mean[lane] * solar - theirs) / noise);
            }
        }
    }
    (all, by_order)
}

fn mean_square(values: &[f64]) -> f64 {
    values.iter().map(|z| z * z).sum::<f64>() / values.len() as f64
}

fn worst(values: &[f64]) -> f64 {
    values.iter().fold(0.0, |worst, z| worst.max(z.abs()))
}

/// Deviations of independent unbiased estimates have a mean square of 1; the three wavelengths of a direction share their
/// paths, so there are a third as many independent ones.
fn hold(stride: usize, paths: u64, least: usize) {
    let (all, by_order) = deviations(stride, paths);
    let [square, order_square] = [&all, &by_order].map(|z| mean_square(z));
    let mean = all.iter().sum::<f64>() / all.len() as f64;
    println!(
        "{} values: mean {mean:+.2}, mean square {square:.2}, worst {:.1} standard errors; by order {order_square:.2}, {:.1}",
        all.len(),
        worst(&all),
        worst(&by_order)
    );
    assert!(all.len() >= least);
    let spread = (6.0 / all.len() as f64).sqrt();
    assert!((square - 1.0).abs() < 4.0 * spread, "{square} for 1");
    assert!(mean.abs() < 4.0 * (3.0 / all.len() as f64).sqrt(), "{mean}");
    assert!(worst(&all) < 4.5 && order_square < 1.0 + 4.0 * spread);
}

#[test]
fn two_monte_carlos_differ_by_noise() {
    hold(17, 8192, 50);
}

/// All rows of the tables.
#[test]
#[ignore = "minutes: all directions with many paths"]
fn two_monte_carlos_differ_by_noise_everywhere() {
    hold(1, 65_536, 912);
}
