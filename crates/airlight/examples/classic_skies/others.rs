//! Preetham, Hosek and Wilkie, Hillaire, and four orders.

use crate::measure::{Errors, SUNS_DEG, fan, seconds_a_line, sun};
use airlight::classic::ClassicSky;
use airlight::classic::four_orders::FourOrders;
use airlight::classic::hillaire2020::Hillaire2020;
use airlight::classic::preetham::Preetham;
use airlight::medium::aerosol::turbidity_of_optical_depth;
use airlight::medium::{Atmosphere, preset};
use airlight::sky::{Sky, SkySettings};
use airlight::spectrum::WavelengthGrid;
use glam::DVec3;
use std::time::Instant;

type Fallible<T> = Result<T, Box<dyn std::error::Error>>;

/// Prints errors of Y and Z against our solver, the zenith at dusk, and speeds.
///
/// # Errors
/// None with these settings.
pub fn print() -> Fallible<()> {
    for name in ["clear", "average", "hazy"] {
        let air = preset(name)?;
        let turbidity = turbidity(&air)?;
        println!(
            "\nEarth, {name}, turbidity {turbidity:.2}: rms (worst) percent of Y, then of Z; suns {SUNS_DEG:?}"
        );
        let grid = WavelengthGrid::standard();
        let truth = Sky::prepare(&air, &grid, &SkySettings::default())?;
        for model in MODELS {
            let (mut luminance, mut blue) = (format!("  {model:14} Y"), format!("  {:14} Z", ""));
            for sun_deg in SUNS_DEG {
                let sky = sky(model, &air, turbidity, sun_deg)?;
                let view = truth.view(2.0, sun(sun_deg));
                let both: Vec<_> = fan()
                    .into_iter()
                    .map(|d| (sky.sky_xyz(d), grid.to_xyz(&view.along(d, None).radiance())))
                    .collect();
                let of = |i: usize| Errors::of(both.iter().map(|(got, want)| (got[i], want[i])));
                luminance += &format!(" | {}", of(1));
                blue += &format!(" | {}", of(2));
            }
            println!("{luminance}\n{blue}");
        }
    }
    dusk()?;
    speeds()
}

const MODELS: &[&str] = &[
    "preetham",
    #[cfg(feature = "hosek-wilkie")]
    "hosek-wilkie",
    "hillaire2020",
    "four orders",
];

fn sky(
    model: &str,
    air: &Atmosphere,
    turbidity: f64,
    sun_deg: f64,
) -> Fallible<Box<dyn ClassicSky>> {
    let grid = WavelengthGrid::standard();
    Ok(match model {
        "preetham" => Box::new(Preetham::new(turbidity.max(2.0), sun(sun_deg))?),
        #[cfg(feature = "hosek-wilkie")]
        "hosek-wilkie" => {
            let albedo = [612.0, 549.0, 465.0].map(|nm| air.planet.ground_albedo.at(nm));
            let model =
                airlight::classic::hosek_wilkie::HosekWilkie::new(turbidity, albedo, sun(sun_deg))?;
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

/// As the models take it: optical depth of air and haze over that of air, at 550 nm.
fn turbidity(air: &Atmosphere) -> Fallible<f64> {
    let aerosol = air.constituent("aerosol").ok_or("no aerosol")?;
    let depth = aerosol.optical_depth(0.0, air.planet.top_altitude_m, 550.0);
    Ok(turbidity_of_optical_depth(depth, air.clear_air()))
}

/// How the zenith fades.
fn dusk() -> Fallible<()> {
    const SUNS_DEG: [f64; 5] = [10.0, 2.0, 0.0, -3.0, -6.0];
    let air = preset("average")?;
    let grid = WavelengthGrid::standard();
    let truth = Sky::prepare(&air, &grid, &SkySettings::default())?;
    println!("\nzenith luminance, cd/m^2, suns {SUNS_DEG:?}");
    let row = |name: &str, of: &dyn Fn(f64) -> Option<f64>| {
        let values = SUNS_DEG.map(|s| of(s).map_or("none".into(), |y| format!("{y:.1}")));
        println!("  {name:14} {}", values.join(" | "));
    };
    row("our solver", &|sun_deg| {
        let line = truth.view(2.0, sun(sun_deg)).along(DVec3::Y, None);
        Some(grid.to_xyz(&line.radiance())[1])
    });
    let turbidity = turbidity(&air)?;
    for model in MODELS {
        row(model, &|sun_deg| {
            let sky = sky(model, &air, turbidity, sun_deg).ok()?;
            Some(sky.sky_xyz(DVec3::Y)[1])
        });
    }
    Ok(())
}

fn speeds() -> Fallible<()> {
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
    println!(
        "\n16 wavelengths: time to prepare and a line of sight, in our solver's ({:.0} ms, {:.1} us here)",
        1e3 * solving,
        1e6 * ours
    );
    for model in MODELS {
        let mut made = None;
        let making = timed(&mut || {
            made = Some(sky(model, &air, turbidity, 30.0)?);
            Ok(())
        })?;
        let made = made.ok_or("not made")?;
        let line = seconds_a_line(|d| made.sky_xyz(d));
        println!("  {model:14} {:.4} {:.4}", making / solving, line / ours);
    }
    Ok(())
}
