//! Preetham, Hosek and Wilkie, Hillaire, and four orders of scattering.

use crate::measure::{Errors, SUNS_DEG, fan, head, ratio, seconds_a_line, sun};
use airlight::atmosphere::turbidity_of_optical_depth;
use airlight::atmosphere::{Atmosphere, ConstituentKind, preset};
use airlight::models::PublishedModel;
use airlight::models::four_orders::FourOrders;
use airlight::models::hillaire2020::Hillaire2020;
use airlight::models::preetham::Preetham;
use airlight::sky::{Sky, SkySettings};
use airlight::spectrum::WavelengthGrid;
use glam::DVec3;
use std::time::Instant;

type Fallible<T> = Result<T, Box<dyn std::error::Error>>;

/// Names of the models in the program and in the book.
const MODELS: &[(&str, &str)] = &[
    ("preetham", "Preetham"),
    #[cfg(feature = "hosek-wilkie")]
    ("hosek-wilkie", "Hosek and Wilkie"),
    ("hillaire2020", "Hillaire"),
    ("four orders", "four orders"),
];

/// Errors of Y and Z relative to our solver in average haze, percent.
pub fn average() -> Fallible<()> {
    head(" | ");
    let air = preset("average")?;
    let truth = Sky::prepare(&air, &WavelengthGrid::standard(), &SkySettings::default())?;
    for (model, name) in MODELS {
        let [luminance, blue] = errors(model, &air, &truth)?;
        println!("| {name} | Y | {luminance} |");
        println!("| | Z | {blue} |");
    }
    Ok(())
}

/// Errors of Y in clear and hazy air. Preetham's model requires a turbidity of at least 2.
pub fn luminance() -> Fallible<()> {
    head(" | air");
    let mut airs = Vec::new();
    for name in ["clear", "hazy"] {
        let air = preset(name)?;
        let truth = Sky::prepare(&air, &WavelengthGrid::standard(), &SkySettings::default())?;
        airs.push((name, air, truth));
    }
    for (model, name) in MODELS {
        let mut name = *name;
        for (air_name, air, truth) in &airs {
            let turbidity = turbidity(air)?;
            if *model != "preetham" || turbidity >= 2.0 {
                let [luminance, _] = errors(model, air, truth)?;
                let name = std::mem::take(&mut name);
                println!("| {name} | {air_name} ({turbidity:.2}) | {luminance} |");
            }
        }
    }
    Ok(())
}

/// Errors of Y and Z for each position of the sun.
fn errors(model: &str, air: &Atmosphere, truth: &Sky) -> Fallible<[String; 2]> {
    let turbidity = turbidity(air)?;
    let mut cells = [Vec::new(), Vec::new()];
    for sun_deg in SUNS_DEG {
        let sky = sky(model, air, turbidity, sun_deg)?;
        let view = truth.view(2.0, sun(sun_deg));
        let pair = |d| {
            let line = view.along(d, None).radiance();
            (sky.sky_xyz(d), truth.grid().to_xyz(&line))
        };
        let both: Vec<_> = fan().into_iter().map(pair).collect();
        for (cells, i) in cells.iter_mut().zip([1, 2]) {
            let of = Errors::of(both.iter().map(|(got, want)| (got[i], want[i])));
            cells.push(of.to_string());
        }
    }
    Ok(cells.map(|cells| cells.join(" | ")))
}

fn sky(
    model: &str,
    air: &Atmosphere,
    turbidity: f64,
    sun_deg: f64,
) -> Fallible<Box<dyn PublishedModel>> {
    let grid = WavelengthGrid::standard();
    Ok(match model {
        "preetham" => Box::new(Preetham::new(turbidity.max(2.0), sun(sun_deg))?),
        #[cfg(feature = "hosek-wilkie")]
        "hosek-wilkie" => {
            let albedo = [612.0, 549.0, 465.0].map(|nm| air.planet.ground_albedo.at(nm));
            let model =
                airlight::models::hosek_wilkie::HosekWilkie::new(turbidity, albedo, sun(sun_deg))?;
            Box::new(model)
        }
        "hillaire2020" => Box::new(Hillaire2020::new(air, &grid, 2.0, sun(sun_deg))?),
        _ => Box::new(FourOrders::new(
            air,
            &grid,
            (2.0, sun(sun_deg)),
            4,
            &SkySettings::default(),
        )?),
    })
}

/// Turbidity as defined by the models: optical depth of air and haze relative to that of air, at 550 nm.
fn turbidity(air: &Atmosphere) -> Fallible<f64> {
    let aerosol = air
        .constituent(&ConstituentKind::Aerosol)
        .ok_or("no aerosol")?;
    let depth = aerosol.optical_depth(0.0, air.planet.top_altitude_m, 550.0);
    Ok(turbidity_of_optical_depth(depth, air.clear_air()))
}

/// Luminance of the zenith for each position of the sun, cd/m^2.
pub fn zenith() -> Fallible<()> {
    const SUNS_DEG: [f64; 5] = [10.0, 2.0, 0.0, -3.0, -6.0];
    let air = preset("average")?;
    let grid = WavelengthGrid::standard();
    let truth = Sky::prepare(&air, &grid, &SkySettings::default())?;
    let suns = SUNS_DEG.map(|sun| format!("{sun}°")).join(" | ");
    println!("| sun | {suns} |\n|---|---|---|---|---|---|");
    let row = |name: &str, of: &dyn Fn(f64) -> Option<f64>| {
        let cell = |y: f64| {
            if y < 100.0 {
                format!("{y:.1}")
            } else {
                format!("{y:.0}")
            }
        };
        let values = SUNS_DEG.map(|sun| of(sun).map_or(String::new(), cell));
        println!("| {name} | {} |", values.join(" | "));
    };
    row("our solver", &|sun_deg| {
        let line = truth.view(2.0, sun(sun_deg)).along(DVec3::Y, None);
        Some(grid.to_xyz(&line.radiance())[1])
    });
    let turbidity = turbidity(&air)?;
    for (model, name) in MODELS {
        row(name, &|sun_deg| {
            let sky = sky(model, &air, turbidity, sun_deg).ok()?;
            Some(sky.sky_xyz(DVec3::Y)[1])
        });
    }
    Ok(())
}

/// Times to prepare and per view ray, relative to our solver, for 16 wavelengths.
pub fn times() -> Fallible<()> {
    let air = preset("average")?;
    let turbidity = turbidity(&air)?;
    let grid = WavelengthGrid::standard();
    let timed = |make: &mut dyn FnMut() -> Fallible<()>| -> Fallible<f64> {
        let start = Instant::now();
        make()?;
        Ok(start.elapsed().as_secs_f64())
    };
    let mut solved = None;
    let solving = timed(&mut || {
        solved = Some(Sky::prepare(&air, &grid, &SkySettings::default())?);
        Ok(())
    })?;
    let solved = solved.ok_or("not solved")?;
    let view = solved.view(2.0, sun(30.0));
    let ours = seconds_a_line(|d| grid.to_xyz(&view.along(d, None).radiance()));
    println!("| | to prepare | a line of sight |\n|---|---|---|");
    println!(
        "| our solver, all suns | 1 ({solving:.1} s) | 1 ({:.0} µs) |",
        1e6 * ours
    );
    for (model, name) in MODELS {
        let mut made = None;
        let making = timed(&mut || {
            made = Some(sky(model, &air, turbidity, 30.0)?);
            Ok(())
        })?;
        let made = made.ok_or("not made")?;
        let line = seconds_a_line(|d| made.sky_xyz(d));
        println!(
            "| {name} | {} | {} |",
            ratio(making / solving),
            ratio(line / ours)
        );
    }
    Ok(())
}
