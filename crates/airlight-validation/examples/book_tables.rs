//! Prints the tables of the book's chapter on accuracy (`scripts/book`):
//!
//! ```sh
//! cargo run --release -p airlight-validation --example book_tables -- tables
//! ```
//!
//! `tables` (other solvers), `twilight` (Airlight's Monte Carlo, also with the fine settings; takes some minutes), `measured`
//! (the measured sky) and `fit` (the fitted aerosol); `settings` prints the errors against Monte Carlo with one setting of the
//! solver changed at a time, for the chapter on the solver. With the feature `gpu`: `frames` (frames of a graphics device, by renderer
//! and sun) and `frames-monte-carlo`; both take minutes.

use airlight::Control;
use airlight::sky::SkySettings;
use airlight_validation::check::Statistics;
use airlight_validation::measured::{self, FOLDS};
use airlight_validation::{Check, Suite, run, skies};
use std::error::Error;

fn main() -> Result<(), Box<dyn Error>> {
    match std::env::args().nth(1).as_deref() {
        Some("tables") => tables(),
        Some("twilight") => twilight(),
        Some("measured") => measured(),
        Some("fit") => {
            fit();
            Ok(())
        }
        Some("settings") => {
            settings();
            Ok(())
        }
        #[cfg(feature = "gpu")]
        Some("frames") => frames::table(),
        #[cfg(feature = "gpu")]
        Some("frames-monte-carlo") => frames::monte_carlo_table(),
        _ => Err(
            "expected the name of a table: tables, twilight, measured, fit, settings; with the feature gpu also frames, \
             frames-monte-carlo"
                .into(),
        ),
    }
}

/// Statistics of a check, all of which have rows.
fn statistics(check: &Check) -> Result<Statistics, Box<dyn Error>> {
    Ok(check.statistics().ok_or("a check without rows")?)
}

/// Sun zenith angle of a check with one position of the sun, degrees.
fn sun_zenith_deg(check: &Check) -> f64 {
    check.rows.first().map_or(0.0, |row| row.at.sun_zenith_deg)
}

/// All tables of other solvers, by atmosphere and sun.
fn tables() -> Result<(), Box<dyn Error>> {
    println!("| against | atmosphere | sun zenith | views | mean | rms | worst |");
    println!("|---|---|---|---|---|---|---|");
    let checks = run(&[Suite::Tables])?;
    let mut rows = Vec::new();
    // The plane-parallel libRadtran makes no claim.
    for check in checks.iter().filter(|check| check.limit.is_some()) {
        let mut parts = check.what.split(", ");
        let light = match parts.next() {
            Some("single scattering") => "single scattering",
            _ => "all orders",
        };
        let against = match check.against.as_str() {
            "Monte Carlo on the sphere" => "Monte Carlo",
            other => other,
        };
        let air = match parts.next() {
            Some("a0.0") => "rayleigh, albedo 0",
            Some("a0.3") => "rayleigh, albedo 0.3",
            Some("earth_demo") => "earth-demo",
            other => other.ok_or("a check without an atmosphere")?,
        };
        let s = statistics(check)?;
        let sun = sun_zenith_deg(check);
        let order = (format!("{light}, {against}"), air.to_owned(), sun as u32);
        let row = format!(
            "| {light}, {against} | {air} | {sun}° | {} | {:+.2} % | {:.2} % | {:.2} % |",
            s.count,
            s.mean,
            s.rms,
            s.worst.abs()
        );
        rows.push((order, row));
    }
    rows.sort();
    for (_, row) in rows {
        println!("{row}");
    }
    Ok(())
}

/// Rms and worst error against Airlight's Monte Carlo, for each atmosphere with the default and the fine settings.
fn twilight() -> Result<(), Box<dyn Error>> {
    println!("| sun | clear | clear, fine | hazy | hazy, fine | desert | desert, fine |");
    println!("|---|---|---|---|---|---|---|");
    let usual = skies::against_truth(&SkySettings::default(), Control::default())?;
    let fine = skies::against_truth(&SkySettings::fine(), Control::default())?;
    let mut suns: Vec<f64> = usual.iter().map(sun_zenith_deg).collect();
    suns.sort_by(f64::total_cmp);
    suns.dedup();
    for sun in suns {
        print!("| {}° |", 90.0 - sun);
        for air in ["clear", "hazy", "desert"] {
            for checks in [&usual, &fine] {
                let of = |check: &&Check| {
                    check.what.contains(&format!(", {air},")) && sun_zenith_deg(check) == sun
                };
                let check = checks.iter().find(of).ok_or("a table lacks a sun")?;
                let s = statistics(check)?;
                print!(" {:.1}, {:.1} |", s.rms, s.worst.abs());
            }
        }
        println!();
    }
    Ok(())
}

/// Airlight and published models compared with the measured sky.
fn measured() -> Result<(), Box<dyn Error>> {
    println!("| what | rms, mW m⁻² sr⁻¹ nm⁻¹, these 8 scans | all 15 |\n|---|---|---|");
    let checks = run(&[Suite::Measured])?;
    let [published_air, of_the_day, ..] = checks.as_slice() else {
        return Err("the measured sky lacks a check".into());
    };
    let (csm, day) = (statistics(published_air)?.rms, statistics(of_the_day)?.rms);
    let mut rows = vec![
        (
            day,
            format!("**Airlight, air of the day** | **{day:.1}** |"),
        ),
        (
            csm,
            format!("Airlight, the air that those models were run with (`csm`) | {csm:.1} |"),
        ),
    ];
    for model in measured::published() {
        // The best run of each, and the corrected one.
        let name = match model.model.as_str() {
            "bruneton, 10wl" => "Bruneton (10 wavelengths)",
            "libradtran, 40wl" => "libRadtran (40)",
            "libradtran, 40wl_libradtran_fixed" => "libRadtran, with a corrected interface (40)",
            "haber, 10wl" => "Haber (10)",
            "nishita96, 40wl" => "Nishita 1996 (40)",
            "hosek, 40wl" => "Hosek (40)",
            "preetham, 40wl" => "Preetham (40)",
            _ => continue,
        };
        let (ours, all) = (model.rmse, model.rmse_all_scans);
        rows.push((ours, format!("{name} | {ours:.1} | {all:.1}")));
    }
    rows.sort_by(|a, b| a.0.total_cmp(&b.0));
    for (_, row) in rows {
        println!("| {row} |");
    }
    Ok(())
}

/// Aerosol fitted to each half of the scans.
fn fit() {
    println!(
        "| fitted to | optical depth at 550 nm | Ångström exponent | single-scattering albedo |"
    );
    println!("|---|---|---|---|");
    for fold in &FOLDS {
        let scans = fold.fitted.map(|time| {
            let (hour, minute) = time.split_at(2);
            format!("{}:{minute}", hour.trim_start_matches('0'))
        });
        println!(
            "| {} | {:.4} | {:.3} | {:.3} |",
            scans.join(", "),
            fold.aerosol.optical_depth_550,
            fold.aerosol.angstrom_exponent,
            fold.aerosol.single_scattering_albedo
        );
    }
}

/// Rms error against Monte Carlo with one setting changed.
fn settings() {
    println!("| setting | sun zenith 80° or less | above 80° |\n|---|---|---|");
    type Change = fn(&mut SkySettings);
    let changes: [(&str, Change); 11] = [
        ("default", |_| ()),
        ("suns half as far apart", |s| s.sun_spacing = 0.5),
        ("altitudes 8", |s| s.altitudes = 8),
        ("altitudes 40", |s| s.altitudes = 40),
        ("degree 5, peak degree 6, all of it rescattered", |s| {
            let orders = &mut s.orders;
            (orders.degree, orders.peak_degree, orders.rescattered_degree) = (5, 6, 5)
        }),
        ("degree 12, peak degree 14", |s| {
            (s.orders.degree, s.orders.peak_degree) = (12, 14)
        }),
        ("rescattered degree 2", |s| s.orders.rescattered_degree = 2),
        ("rescattered degree 8", |s| s.orders.rescattered_degree = 8),
        ("first order 4 + 3 + 4 zenith angles", |s| {
            s.orders.first.zenith_nodes = [4, 3, 4]
        }),
        ("later orders 8 + 8 + 10 zenith angles", |s| {
            s.orders.later.zenith_nodes = [8, 8, 10]
        }),
        ("tolerance 0.001", |s| s.orders.tolerance = 0.001),
    ];
    for (name, change) in changes {
        let mut settings = SkySettings::default();
        change(&mut settings);
        let checks =
            skies::against_monte_carlo(&settings, Control::default()).expect("nothing cancels it");
        let rms = |wanted: fn(f64) -> bool| {
            let squares: Vec<f64> = checks
                .iter()
                .flat_map(|check| check.rows.iter().map(|row| (row, check.error(row))))
                .filter(|(row, _)| wanted(row.at.sun_zenith_deg))
                .map(|(_, error)| error * error)
                .collect();
            (squares.iter().sum::<f64>() / squares.len() as f64).sqrt()
        };
        println!(
            "| {name} | {:.2} % | {:.2} % |",
            rms(|sun| sun <= 80.0),
            rms(|sun| sun > 80.0)
        );
    }
}

#[cfg(feature = "gpu")]
mod frames {
    use airlight::Control;
    use airlight_gpu::headless::Headless;
    use airlight_validation::frames::{
        Case, DIRECTIONS, FrameRow, PATH_DIRECTIONS, PATHS, Place, Quantity, Renderer, SUNS_DEG,
        against_monte_carlo, against_solver,
    };
    use airlight_validation::{Row, Unit};
    use std::error::Error;

    /// Errors by renderer and sun, of an eye in the air and of one at 400 km: rms and largest.
    pub fn table() -> Result<(), Box<dyn Error>> {
        let device = Headless::new()?;
        let rows = against_solver(&device, &Case::all(), DIRECTIONS, reported())?;
        println!(
            "| | sun | sky, % | sky, CIEDE2000 | walls, % | walls, CIEDE2000 | from 400 km, % | CIEDE2000 |"
        );
        println!("|---|---|---|---|---|---|---|---|");
        for renderer in Renderer::ALL {
            for sun_deg in SUNS_DEG {
                let errors = |quantity: Quantity, place: Place| {
                    let chosen = |r: &&FrameRow| {
                        r.renderer == renderer
                            && r.quantity == quantity
                            && r.row.at.sun_zenith_deg == 90.0 - sun_deg
                            && Place::of(&r.row.at) == place
                    };
                    let rows = rows.iter().filter(chosen);
                    rms_and_largest(rows.map(|r| quantity.unit().error(&r.row)))
                };
                let name = if sun_deg == SUNS_DEG[0] {
                    renderer.name()
                } else {
                    ""
                };
                let in_air = Quantity::ALL.map(|quantity| errors(quantity, Place::Air));
                let [sky, walls, sky_colour, wall_colour] = in_air;
                let space = errors(Quantity::Sky, Place::Space);
                let space_colour = errors(Quantity::SkyColour, Place::Space);
                println!(
                    "| {name} | {sun_deg}° | {sky} | {sky_colour} | {walls} | {wall_colour} | {space} | {space_colour} |"
                );
            }
        }
        Ok(())
    }

    /// Errors of `airlight-gpu` by sun, of an eye in the air and of one at 400 km: rms, noise of the reference, and largest.
    pub fn monte_carlo_table() -> Result<(), Box<dyn Error>> {
        let device = Headless::new()?;
        let rows = against_monte_carlo(&device, &Case::all(), PATH_DIRECTIONS, PATHS, reported())?;
        println!("| sun | eye up to 10 km: rms | noise | mean | from 400 km: rms | noise | mean |");
        println!("|---|---|---|---|---|---|---|");
        for sun_deg in SUNS_DEG {
            let of = |inside: bool| {
                let chosen = |row: &&Row| {
                    row.at.sun_zenith_deg == 90.0 - sun_deg
                        && (Place::of(&row.at) != Place::Space) == inside
                };
                let rows: Vec<&Row> = rows.iter().filter(chosen).collect();
                let rms = |of: &dyn Fn(&Row) -> f64| {
                    let squares: f64 = rows.iter().map(|row| of(row).powi(2)).sum();
                    (squares / rows.len() as f64).sqrt()
                };
                let mean = rows.iter().map(|row| Unit::Percent.error(row)).sum::<f64>();
                format!(
                    "{:.2} | {:.2} | {:+.2}",
                    rms(&|row| Unit::Percent.error(row)),
                    rms(&|row| Unit::Percent.noise(row)),
                    mean / rows.len() as f64
                )
            };
            println!("| {sun_deg}° | {} | {} |", of(true), of(false));
        }
        Ok(())
    }

    /// Prints how far a comparison is on standard error.
    fn reported() -> Control<'static> {
        Control::default().reporting_to(&|done: u64, total: u64| eprintln!("{done} of {total}"))
    }

    fn rms_and_largest(errors: impl Iterator<Item = f64>) -> String {
        let (mut count, mut squares, mut largest) = (0.0, 0.0, 0.0f64);
        for error in errors {
            count += 1.0;
            squares += error * error;
            largest = largest.max(error.abs());
        }
        match count > 0.0 {
            true => format!("{:.2}, {largest:.1}", f64::sqrt(squares / count)),
            false => String::new(),
        }
    }
}
