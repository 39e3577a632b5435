//! Prints the book's table of the effect of polarisation on the radiance of the sky, by Monte Carlo.
//!
//! ```sh
//! cargo run --release -p airlight-validation --example polarisation [PATHS]
//! ```

use airlight::atmosphere::preset;
use airlight::axes::direction;
use airlight::monte_carlo::{MonteCarlo, MonteCarloSettings, PolarisedEstimate};
use airlight::spectrum::WavelengthGrid;
use airlight_validation::skies::truth_air;
use std::error::Error;

/// View azimuths from the sun and view elevations, degrees.
const AZIMUTHS_DEG: [f64; 4] = [0.0, 60.0, 120.0, 180.0];
const ELEVATIONS_DEG: [f64; 4] = [2.0, 10.0, 30.0, 60.0];
const SUNS_DEG: [f64; 4] = [60.0, 30.0, 5.0, -2.0];

fn main() -> Result<(), Box<dyn Error>> {
    let paths = match std::env::args().nth(1) {
        Some(text) => text.parse()?,
        None => 16_384,
    };
    println!(
        "| air | sun | rms, % | worst, % | where | its noise, % | rms at 450 / 550 / 650 nm, % | luminance: rms, worst, % | most polarised |"
    );
    println!("|---|---|---|---|---|---|---|---|---|");
    let grid = WavelengthGrid::standard();
    for (name, air) in [
        ("`clear`", preset("clear")?),
        ("`hazy`", preset("hazy")?),
        (
            "hazy, continental particles",
            truth_air("continental").ok_or("no such air")?,
        ),
    ] {
        let settings = MonteCarloSettings {
            paths,
            ..Default::default()
        };
        let sky = MonteCarlo::new(&air, &grid, settings)?;
        for sun_deg in SUNS_DEG {
            println!("| {name} | {sun_deg}° | {} |", row(&sky, sun_deg));
        }
    }
    Ok(())
}

fn row(sky: &MonteCarlo, sun_deg: f64) -> String {
    let sun = direction(0.0, sun_deg);
    let wavelengths = sky.grid().wavelengths_nm();
    let mut all: Vec<(f64, f64, String)> = Vec::new();
    let mut squares = vec![0.0; wavelengths.len()];
    let (mut luminance, mut degree, mut views) = (Vec::new(), 0.0f64, 0.0);
    let zenith = std::iter::once((0.0, 90.0));
    let fan = AZIMUTHS_DEG
        .iter()
        .flat_map(|az| ELEVATIONS_DEG.map(|el| (*az, el)));
    for (azimuth, elevation) in fan.chain(zenith) {
        let found = sky.polarised(2.0, sun, direction(azimuth, elevation), None);
        for (lane, nm) in wavelengths.iter().enumerate() {
            let whole = found.intensity.mean[lane] / 100.0;
            let share = found.effect.mean[lane] / whole;
            let noise = found.effect.standard_error[lane] / whole;
            let at = format!("{nm:.0} nm, azimuth {azimuth}°, elevation {elevation}°");
            squares[lane] += share * share;
            degree = degree.max(found.degree.mean[lane]);
            all.push((share, noise, at));
        }
        luminance.push(of_luminance(sky, &found));
        views += 1.0;
    }
    let rms =
        |values: &[f64]| (values.iter().map(|v| v * v).sum::<f64>() / values.len() as f64).sqrt();
    let shares: Vec<f64> = all.iter().map(|one| one.0).collect();
    let worst = all
        .iter()
        .max_by(|a, b| a.0.abs().total_cmp(&b.0.abs()))
        .map_or((0.0, 0.0, String::new()), Clone::clone);
    let near = |nm: f64| {
        let off = |lane: &usize| (wavelengths[*lane] - nm).abs();
        let lane = (0..wavelengths.len())
            .min_by(|a, b| off(a).total_cmp(&off(b)))
            .unwrap_or(0);
        (squares[lane] / views).sqrt()
    };
    let most = luminance.iter().fold(0.0f64, |most, v| most.max(v.abs()));
    format!(
        "{:.2} | {:+.2} | {} | {:.2} | {:.2} / {:.2} / {:.2} | {:.2}, {:.2} | {:.2}",
        rms(&shares),
        worst.0,
        worst.2,
        worst.1,
        near(450.0),
        near(550.0),
        near(650.0),
        rms(&luminance),
        most,
        degree
    )
}

/// Effect of polarisation on the luminance, percent.
fn of_luminance(sky: &MonteCarlo, found: &PolarisedEstimate) -> f64 {
    let y = |values: &[f64]| -> f64 {
        let single: Vec<f32> = values.iter().map(|&v| v as f32).collect();
        sky.grid().to_xyz(&single)[1]
    };
    100.0 * y(&found.effect.mean) / y(&found.intensity.mean)
}
