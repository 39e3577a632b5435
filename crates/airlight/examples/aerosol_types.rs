//! The numbers of the book's chapter on aerosol types: `cargo run --release -p airlight --example aerosol_types` for what
//! they do to light; with `sky` behind it, the solver's skies of some of them beside the Monte Carlo's.

use airlight::axes;
use airlight::medium::aerosol_types::AerosolType;
use airlight::medium::{AerosolLoad, AerosolMixture, preset};
use airlight::sky::monte_carlo::{MonteCarlo, MonteCarloSettings};
use airlight::sky::{Sky, SkySettings, SunCoverage};
use airlight::spectrum::WavelengthGrid;
use std::error::Error;
use std::time::Instant;

fn main() -> Result<(), Box<dyn Error>> {
    match std::env::args().nth(1).as_deref() {
        None => bulk(),
        Some("sky") => skies(),
        Some(other) => Err(format!("there is no `{other}`: leave it out, or say `sky`").into()),
    }
}

fn bulk() -> Result<(), Box<dyn Error>> {
    println!(
        "| type | extinction, 1/km | optical depth | albedo | mean cosine | 350-500 nm | 500-800 nm | ms |"
    );
    for (name, kind, _) in AerosolType::ALL {
        let start = Instant::now();
        let mixture = AerosolMixture::of(kind, AerosolMixture::USUAL_HUMIDITY)?;
        let bulk = mixture.summary()?;
        let depth = mixture.usual_optical_depth_550()?;
        let ms = 1e3 * start.elapsed().as_secs_f64();
        println!(
            "| {name} | {:.4} | {depth:.3} | {:.4} | {:.4} | {:.3} | {:.3} | {ms:.0} |",
            1e3 * bulk.extinction_per_m,
            bulk.single_scattering_albedo,
            bulk.asymmetry,
            bulk.angstrom_350_500,
            bulk.angstrom_500_800,
        );
    }
    Ok(())
}

/// Solver over Monte Carlo less 1, and the Monte Carlo's standard error, at 440, 550 and 680 nm.
fn skies() -> Result<(), Box<dyn Error>> {
    let grid = WavelengthGrid::from_wavelengths_nm(vec![440.0, 550.0, 680.0])?;
    for (kind, depth) in [
        (AerosolType::Desert, 0.4),
        (AerosolType::MaritimeClean, 0.3),
        (AerosolType::Urban, 0.4),
    ] {
        let mut air = preset("average")?;
        let load = Some(AerosolLoad::OpticalDepth550(depth));
        let mixture = AerosolMixture::of(kind, 0.8)?;
        let part = mixture.constituent(load, None, air.clear_air(), 0.0, 100e3)?;
        air.constituents.retain(|old| old.name != "aerosol");
        air.constituents.push(part);
        let truth = MonteCarlo::new(&air, &grid, MonteCarloSettings::default())?;
        for sun_elevation in [30.0, 4.0] {
            let settings = SkySettings {
                suns: SunCoverage::near(sun_elevation, 0.0),
                ..Default::default()
            };
            let sky = Sky::prepare(&air, &grid, &settings)?;
            let sun = axes::direction(180.0, sun_elevation);
            let view = sky.view(2.0, sun);
            for (azimuth, elevation) in [
                (180.0, sun_elevation + 5.0),
                (180.0, 60.0),
                (90.0, 20.0),
                (0.0, 5.0),
            ] {
                let direction = axes::direction(azimuth, elevation);
                let solved = view.along(direction, None).radiance();
                let want = truth.radiance_within(0.005, 2_000_000, 2.0, sun, direction);
                print!("{kind:?} sun {sun_elevation} view {azimuth} {elevation}:");
                for (i, got) in solved.iter().enumerate() {
                    let (mean, error) = (want.mean[i], want.standard_error[i]);
                    print!(
                        "  {:+.2} % +- {:.2}",
                        1e2 * (f64::from(*got) / mean - 1.0),
                        1e2 * error / mean
                    );
                }
                println!();
            }
        }
    }
    Ok(())
}
