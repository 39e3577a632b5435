//! Prints the book's numbers and tables of the air and the sun (`scripts/book`):
//! `cargo run --release --example book_numbers -p airlight`; with the argument `molecules`, `hazes` or `earth` only that table.

use airlight::Named;
use airlight::atmosphere::{ConstituentKind, Preset, gases, preset};
use airlight::atmosphere::{turbidity_of_optical_depth, visibility_of_extinction_m};
use airlight::optics::rayleigh;
use airlight::sun::{self, Place, RefractingAir};

type Fallible = Result<(), Box<dyn std::error::Error>>;

fn main() -> Fallible {
    match std::env::args().nth(1).as_deref() {
        None => {
            molecules();
            hazes()?;
            earth()?;
            presets()?;
            sun()
        }
        Some("molecules") => {
            molecules();
            Ok(())
        }
        Some("hazes") => hazes(),
        Some("earth") => earth(),
        Some(other) => Err(format!("expected molecules, hazes or earth, got `{other}`").into()),
    }
}

/// Cross-sections and vertical optical depths of the standard atmosphere; ozone of 300 Dobson units.
fn molecules() {
    println!(
        "| λ, nm | cross-section, m² | F | depolarisation | Rayleigh optical depth | ozone optical depth |"
    );
    println!("|---|---|---|---|---|---|");
    let (air, ozone) = (
        gases::air(rayleigh::STANDARD_PRESSURE_PA),
        gases::ozone(300.0),
    );
    for nm in [
        360.0, 400.0, 450.0, 500.0, 550.0, 600.0, 650.0, 700.0, 800.0,
    ] {
        let king = rayleigh::king_factor(nm, rayleigh::CO2_PPM);
        println!(
            "| {nm} | {:.3e} | {king:.4} | {:.4} | {:.4} | {:.4} |",
            rayleigh::cross_section_m2(nm, rayleigh::CO2_PPM),
            rayleigh::depolarization_of_king_factor(king),
            air.optical_depth(0.0, 100e3, nm),
            ozone.optical_depth(0.0, 100e3, nm),
        );
    }
}

/// The same hazes as optical depth, turbidity and visibility.
fn hazes() -> Fallible {
    println!("| preset | optical depth | turbidity | visibility |\n|---|---|---|---|");
    let km = |extinction, clear| visibility_of_extinction_m(extinction, clear) / 1e3;
    let clear = preset("clear")?.clear_air();
    println!("| no aerosol | 0 | 1 | {:.0} km |", km(0.0, clear));
    for name in ["clear", "average", "hazy"] {
        let air = preset(name)?;
        let aerosol = air
            .constituent(&ConstituentKind::Aerosol)
            .ok_or("no aerosol")?;
        let depth = aerosol.optical_depth(0.0, air.planet.top_altitude_m, 550.0);
        println!(
            "| `{name}` | {depth:.2} | {:.2} | {:.0} km |",
            turbidity_of_optical_depth(depth, air.clear_air()),
            km(aerosol.extinction_per_m(550.0), air.clear_air()),
        );
    }
    Ok(())
}

/// The constituents of the presets of the Earth.
fn earth() -> Fallible {
    println!("| constituent | optical depth at 440 / 550 / 680 nm | what |\n|---|---|---|");
    for (preset_name, part_name, what) in [
        (
            "clear",
            "rayleigh",
            "dry air, 1013.25 hPa, standard-air profile, [depolarised](particles.md#phase-functions)",
        ),
        ("clear", "ozone", "300 Dobson units"),
        (
            "clear",
            "aerosol",
            "Ångström exponent 1.3, albedo 0.95, scale height 1.5 km, continental phase function",
        ),
        ("average", "aerosol", "the same, more of it"),
        ("hazy", "aerosol", "single-scattering albedo 0.93"),
    ] {
        let air = preset(preset_name)?;
        let part = air
            .constituent(&part_name.into())
            .ok_or("no such constituent")?;
        let depths = [440.0, 550.0, 680.0].map(|nm| {
            let depth = part.optical_depth(0.0, air.planet.top_altitude_m, nm);
            format!("{depth:.4}")
        });
        let of = match part_name {
            "aerosol" => format!(", `{preset_name}`"),
            _ => String::new(),
        };
        println!("| `{part_name}`{of} | {} | {what} |", depths.join(" / "));
    }
    Ok(())
}

/// The constituents of all presets.
fn presets() -> Fallible {
    for &preset in Preset::ALL {
        let (name, air) = (preset.name(), preset.atmosphere());
        let planet = &air.planet;
        println!(
            "\n{name}: radius {} km, top {} km, ground albedo {} / {} / {} at 440 / 550 / 680 nm",
            planet.radius_m / 1e3,
            planet.top_altitude_m / 1e3,
            planet.ground_albedo.at(440.0),
            planet.ground_albedo.at(550.0),
            planet.ground_albedo.at(680.0),
        );
        println!(
            "  sun: {:.4} W m^-2 nm^-1 at 550 nm, angular radius {:.5} deg, {:?}",
            air.solar_irradiance.at(550.0),
            air.sun.angular_radius_rad.to_degrees(),
            air.sun.limb_darkening,
        );
        for part in &air.constituents {
            let depth =
                |nm| part.optical_depth(planet.ground_altitude_m, planet.top_altitude_m, nm);
            let extinction = part.extinction_per_m(550.0);
            println!(
                "  {}: optical depth {:.4} / {:.4} / {:.4}, single-scattering albedo {:.3}, mean cosine {:.3}",
                part.kind,
                depth(440.0),
                depth(550.0),
                depth(680.0),
                part.scattering_per_m.at(550.0) / extinction,
                part.phase.asymmetry(550.0),
            );
        }
    }
    Ok(())
}

/// The position of the sun over Paris at midsummer, with and without refraction.
fn sun() -> Fallible {
    let paris = Place {
        latitude_deg: 48.8584,
        longitude_deg: 2.2945,
        altitude_m: 0.0,
    };
    let time = "2026-06-21T21:15:00+02:00".parse()?;
    let sun = sun::sun_position(time, paris, Some(RefractingAir::STANDARD))?;
    println!("\nParis, 2026-06-21T21:15:00+02:00: {sun:?}");
    Ok(())
}
