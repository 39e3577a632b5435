//! Prints the numbers of the book's chapter on spheres: `cargo run --release -p airlight --example spheres`.

use airlight::optics::mie::droplets::Drops;
use airlight::optics::mie::{MieError, Particles};
use airlight::spectrum::{RgbSpace, WavelengthGrid};
use std::time::Instant;

fn main() -> Result<(), MieError> {
    presets()
}

/// Published drops at 550 nm, and how long their tables take.
fn presets() -> Result<(), MieError> {
    println!(
        "kind, mode radius um, effective radius um, effective variance, extinction 1/m for 1 g/m^3, asymmetry, \
         extinction at 450 and 650 nm over that at 550, angles, s for 16 wavelengths, s for RGB after that"
    );
    let grid = WavelengthGrid::standard();
    for (name, drops) in Drops::ALL {
        let sizes = drops.sizes();
        let water = Particles::water(sizes)?;
        let green = water.bulk(550.0)?;
        let [blue, red] = [water.bulk(450.0)?, water.bulk(650.0)?]
            .map(|other| other.extinction_um2() / green.extinction_um2());
        let start = Instant::now();
        let table = drops.table(grid.wavelengths_nm())?;
        let spectral_s = start.elapsed().as_secs_f64();
        let start = Instant::now();
        drops.rgb_table(RgbSpace::Srgb)?;
        println!(
            "{name}, {:.3}, {:.3}, {:.3}, {:.4}, {:.4}, {blue:.3}, {red:.3}, {}, {spectral_s:.2}, {:.3}",
            sizes.mode_radius_um(),
            sizes.effective_radius_um(),
            sizes.effective_variance(),
            green.extinction_per_m_by_mass(1.0, 1.0),
            green.asymmetry,
            table.phase.angles_rad().len(),
            start.elapsed().as_secs_f64(),
        );
    }
    Ok(())
}
