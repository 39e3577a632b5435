//! Computes radiances of random skies by Monte Carlo for the tests of the fast solver: lines of `data/random_airs_monte_carlo.csv`.
//!
//! ```sh
//! cargo run --release -p airlight-validation --example random_airs -- 0 1 2
//! ```
//!
//! computes the cases of these numbers, without numbers all; `--show` prints their airs instead. The result is the same with any number
//! of threads.

use airlight::axes::direction;
use airlight::monte_carlo::{MonteCarlo, MonteCarloSettings};
use airlight::spectrum::WavelengthGrid;
use airlight_validation::random_airs::{AEROSOLS, LAYERS, RandomSky, WAVELENGTHS_NM};

/// Target of the relative standard error under a sun, and the largest number of paths: little light of twilight is found by many.
fn precision(sun_elevation_deg: f64) -> (f64, u64) {
    match sun_elevation_deg {
        ..-1.0 => (0.006, 1 << 20),
        ..1.0 => (0.004, 1 << 19),
        _ => (0.0025, 1 << 18),
    }
}

fn main() -> Result<(), Box<dyn std::error::Error>> {
    let arguments: Vec<String> = std::env::args().skip(1).collect();
    let (show, numbers): (Vec<_>, Vec<_>) = arguments.iter().partition(|a| *a == "--show");
    let numbers: Vec<u64> = match numbers.is_empty() {
        true => (AEROSOLS.start..LAYERS.end).collect(),
        false => numbers
            .iter()
            .map(|n| n.parse())
            .collect::<Result<_, _>>()?,
    };
    let grid = WavelengthGrid::from_wavelengths_nm(WAVELENGTHS_NM.to_vec())?;
    if show.is_empty() {
        let columns = |name: &str| WAVELENGTHS_NM.map(|nm| format!("{name}{nm}")).join(",");
        println!("number,{},{}", columns("l"), columns("se"));
    }
    for number in numbers {
        let case = RandomSky::new(number);
        if !show.is_empty() {
            println!("{number} {case:?}\n{}", case.air);
            case.atmosphere();
            continue;
        }
        let settings = MonteCarloSettings {
            seed: number,
            ..MonteCarloSettings::default()
        };
        let sky = MonteCarlo::new(&case.atmosphere(), &grid, settings)?;
        let sun = direction(0.0, case.sun_elevation_deg);
        let view = direction(case.azimuth_deg, case.elevation_deg);
        let (error, most) = precision(case.sun_elevation_deg);
        let found = sky.radiance_within(error, most, case.altitude_m, sun, view);
        let list = |values: &[f64]| {
            let texts: Vec<String> = values.iter().map(|v| format!("{v:.5e}")).collect();
            texts.join(",")
        };
        println!(
            "{number},{},{}",
            list(&found.mean),
            list(&found.standard_error)
        );
    }
    Ok(())
}
