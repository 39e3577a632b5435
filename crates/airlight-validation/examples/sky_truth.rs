//! Computes a table of reference skies by Monte Carlo for the tests of the fast solver: `data/mc_airlight_*.csv`.
//!
//! ```sh
//! cargo run --release -p airlight-validation --example sky_truth -- clear >crates/airlight-validation/data/mc_airlight_clear.csv
//! ```
//!
//! Takes some minutes per atmosphere on two cores. The result is the same on any machine and any number of threads.

use airlight::axes::direction;
use airlight::monte_carlo::{MonteCarlo, MonteCarloSettings};
use airlight::spectrum::WavelengthGrid;
use airlight_validation::skies::truth_air;

/// Sun elevation, target standard error relative to the mean, and largest number of paths.
const SUNS: [(f64, f64, u64); 8] = [
    (60.0, 0.001, 2_000_000),
    (30.0, 0.001, 2_000_000),
    (10.0, 0.001, 4_000_000),
    (3.0, 0.0012, 6_000_000),
    (0.5, 0.0015, 10_000_000),
    (-2.0, 0.003, 3_000_000),
    (-4.0, 0.006, 2_000_000),
    (-6.0, 0.007, 4_000_000),
];
/// Elevation of the view, and its azimuth from the sun.
const VIEWS: [(f64, f64); 9] = [
    (90.0, 0.0),
    (45.0, 90.0),
    (45.0, 180.0),
    (20.0, 30.0),
    (10.0, 90.0),
    (10.0, 180.0),
    (2.0, 20.0),
    (2.0, 90.0),
    (2.0, 180.0),
];

fn main() -> Result<(), Box<dyn std::error::Error>> {
    let names: Vec<String> = std::env::args().skip(1).collect();
    let wavelengths = [440.0, 550.0, 680.0];
    let grid = WavelengthGrid::from_wavelengths_nm(wavelengths.to_vec())?;
    println!("config,sun_zenith_deg,view_zenith_deg,rel_azimuth_deg,channel,L,SE");
    for name in &names {
        let air = truth_air(name).ok_or("atmospheres: presets, and desert")?;
        let sky = MonteCarlo::new(&air, &grid, MonteCarloSettings::default())?;
        for (elevation, error, most) in SUNS {
            for (view, azimuth) in VIEWS {
                let (sun, view_zenith) = (direction(0.0, elevation), 90.0 - view);
                let found = sky.radiance_within(error, most, 0.0, sun, direction(azimuth, view));
                for (lane, nm) in wavelengths.iter().enumerate() {
                    // Converts from the solver's mean solar irradiance about a wavelength to that at the wavelength.
                    let solar = air.solar_irradiance.at(*nm) / sky.grid().solar_irradiance()[lane];
                    println!(
                        "{name},{},{view_zenith},{azimuth},{nm},{:.6e},{:.2e}",
                        90.0 - elevation,
                        found.mean[lane] * solar,
                        found.standard_error[lane] * solar
                    );
                }
            }
        }
    }
    Ok(())
}
