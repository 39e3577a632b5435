//! Prints the book's table of the solver's errors against Monte Carlo for some aerosol types (`scripts/book`):
//! `cargo run --release -p airlight --example aerosol_types`. Takes some minutes. An optional argument sets
//! `SkySettings::orders.peak_degree`.

use airlight::atmosphere::AerosolType;
use airlight::atmosphere::{AerosolLoad, AerosolMixture, ConstituentKind, preset};
use airlight::axes;
use airlight::monte_carlo::{MonteCarlo, MonteCarloSettings};
use airlight::sky::{Sky, SkySettings, SunCoverage};
use airlight::spectrum::WavelengthGrid;
use std::error::Error;

/// Relative difference of the solver to Monte Carlo, from the lowest to the highest of 440, 550 and 680 nm.
fn main() -> Result<(), Box<dyn Error>> {
    let peak_degree = std::env::args().nth(1).map(|text| text.parse());
    let peak_degree = peak_degree.transpose()?;
    println!(
        "| type, optical depth | sun | 5 degrees above the sun | 60 degrees up, towards the sun | 20 degrees up, across | 5 degrees up, opposite |"
    );
    println!("|---|---|---|---|---|---|");
    let mut noise = 0.0f64;
    let grid = WavelengthGrid::from_wavelengths_nm(vec![440.0, 550.0, 680.0])?;
    for (name, kind, depth) in [
        ("desert", AerosolType::Desert, 0.4),
        ("maritime-clean", AerosolType::MaritimeClean, 0.3),
        ("urban", AerosolType::Urban, 0.4),
    ] {
        let mut air = preset("average")?;
        let load = Some(AerosolLoad::OpticalDepth550(depth));
        let mixture = AerosolMixture::of(kind, 0.8)?;
        let part = mixture.constituent(load, None, air.clear_air(), 0.0, 100e3)?;
        air.constituents
            .retain(|old| old.kind != ConstituentKind::Aerosol);
        air.constituents.push(part);
        let truth = MonteCarlo::new(&air, &grid, MonteCarloSettings::default())?;
        for sun_elevation in [30.0, 4.0] {
            let mut settings = SkySettings {
                suns: SunCoverage::near(sun_elevation, 0.0),
                ..Default::default()
            };
            settings.orders.peak_degree = peak_degree.unwrap_or(settings.orders.peak_degree);
            let sky = Sky::prepare(&air, &grid, &settings)?;
            let sun = axes::direction(180.0, sun_elevation);
            let view = sky.view(2.0, sun);
            print!("| {name}, {depth} | {sun_elevation}° |");
            for (azimuth, elevation) in [
                (180.0, sun_elevation + 5.0),
                (180.0, 60.0),
                (90.0, 20.0),
                (0.0, 5.0),
            ] {
                let direction = axes::direction(azimuth, elevation);
                let solved = view.along(direction, None).radiance();
                let want = truth.radiance_within(0.005, 2_000_000, 2.0, sun, direction);
                let (mut least, mut most) = (f64::INFINITY, f64::NEG_INFINITY);
                for (i, got) in solved.iter().enumerate() {
                    let error = 100.0 * (f64::from(*got) / want.mean[i] - 1.0);
                    (least, most) = (least.min(error), most.max(error));
                    noise = noise.max(100.0 * want.standard_error[i] / want.mean[i]);
                }
                match [least, most].map(percent) {
                    [least, most] if least == most => print!(" {least} % |"),
                    [least, most] => print!(" {least} to {most} % |"),
                }
            }
            println!();
        }
    }
    println!("standard error of the Monte Carlo at most {noise:.2} %");
    Ok(())
}

/// Percentage with its sign, unless it rounds to 0.
fn percent(value: f64) -> String {
    match value.abs() < 0.05 {
        true => "0.0".to_owned(),
        false => format!("{value:+.1}"),
    }
}
