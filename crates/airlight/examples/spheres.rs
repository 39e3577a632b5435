//! Prints the tables of the book's chapter on spheres (`scripts/book`): `cargo run --release -p airlight --example spheres` for
//! the optical properties of published drop distributions; with the argument `times` for the time to read and to compute their tables.

use airlight::Named;
use airlight::optics::mie::droplets::Drops;
use airlight::optics::mie::{MieError, Particles};
use airlight::spectrum::WavelengthGrid;
use std::error::Error;
use std::time::Instant;

fn main() -> Result<(), Box<dyn Error>> {
    match std::env::args().nth(1).as_deref() {
        None => Ok(drops()?),
        Some("times") => Ok(times()?),
        Some(other) => Err(format!("expected no argument or `times`, got `{other}`").into()),
    }
}

/// A remark on the distribution, and its source.
fn source(drops: Drops) -> (&'static str, &'static str) {
    match drops {
        Drops::HeavyAdvectionFog => ("", "Shettle and Fenn 1979, fog 1"),
        Drops::ModerateAdvectionFog => ("", "fog 2"),
        Drops::HeavyRadiationFog => ("", "fog 3"),
        Drops::ModerateRadiationFog => (", `mist`", "fog 4"),
        Drops::CloudC1 => ("", "Deirmendjian 1969, table 4"),
        Drops::CloudC2 => (", makes coronas", "the same"),
        Drops::CloudC3 => (", mother of pearl", "the same"),
        Drops::HazeM | Drops::HazeL | Drops::HazeH => ("", "the same"),
        Drops::Rain => (", 1 mm an hour", "Feingold and Levin 1986"),
        _ => ("", ""),
    }
}

/// Formats a radius with the digits that the published values need.
fn radius(um: f64) -> String {
    match um < 9.95 && (um - um.round()).abs() > 1e-9 {
        true => format!("{um:.2}"),
        false => format!("{um:.0}"),
    }
}

/// Published drop distributions at 550 nm.
fn drops() -> Result<(), MieError> {
    println!(
        "| name | source | mode radius, µm | effective radius, µm | variance | extinction of 1 g/m³, 1/m | mean cosine | extinction at 450 and 650 nm over 550 nm |"
    );
    println!("|---|---|---|---|---|---|---|---|");
    for &drops in Drops::ALL {
        let name = drops.name();
        let sizes = drops.sizes();
        let water = Particles::water(sizes)?;
        let green = water.bulk(550.0)?;
        let [blue, red] = [water.bulk(450.0)?, water.bulk(650.0)?]
            .map(|other| other.extinction_um2() / green.extinction_um2());
        let extinction = green.extinction_per_m_by_mass(1.0, 1.0);
        let (remark, source) = source(drops);
        println!(
            "| `{name}`{remark} | {source} | {} | {} | {:.3} | {} | {:.4} | {blue:.3}, {red:.3} |",
            radius(sizes.mode_radius_um()),
            radius(sizes.effective_radius_um()),
            sizes.effective_variance(),
            match extinction < 1.0 {
                true => format!("{extinction:.4}"),
                false => format!("{extinction:.2}"),
            },
            green.asymmetry,
        );
    }
    Ok(())
}

/// Time to read the embedded tables and to compute them.
fn times() -> Result<(), MieError> {
    println!("| name | angles | 16 wavelengths read, ms | computed, s | angles computed |");
    println!("|---|---|---|---|---|");
    let grid = WavelengthGrid::standard();
    for &drops in Drops::ALL {
        let name = drops.name();
        let start = Instant::now();
        let read = drops.table(grid.wavelengths_nm())?;
        let read_ms = 1e3 * start.elapsed().as_secs_f64();
        let start = Instant::now();
        let computed = drops.computed_table(grid.wavelengths_nm())?;
        println!(
            "| `{name}` | {} | {read_ms:.1} | {:.1} | {} |",
            read.phase.angles_rad().len(),
            start.elapsed().as_secs_f64(),
            computed.phase.angles_rad().len(),
        );
    }
    Ok(())
}
