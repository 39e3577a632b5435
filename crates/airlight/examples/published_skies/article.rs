//! The sky article's shader and its improvements.

use crate::Fallible;
use crate::measure::{Errors, SUNS_DEG, fan, head, ratio, seconds_a_line, sun};
use airlight::atmosphere::presets::published;
use airlight::models::single_scattering::{Settings, SkyArticle, Variant};
use airlight::sky::{Scattering, Sky, SkySettings, View};
use airlight::spectrum::WavelengthGrid;
use glam::DVec3;

const VARIANTS: [(&str, Variant); 5] = [
    ("printed", Variant::Printed),
    ("printed, f64", Variant::PrintedF64),
    ("converged", Variant::Converged),
    ("table", Variant::Table),
    ("multiple", Variant::Multiple),
];

/// Errors relative to our solver's single scattering, percent of a channel.
pub fn once() -> Fallible {
    against(
        Scattering::Single,
        &["printed", "printed, f64", "converged", "table"],
    )
}

/// Errors relative to our solver with all orders.
pub fn all() -> Fallible {
    against(
        Scattering::All,
        &["printed", "converged", "table", "multiple"],
    )
}

fn against(scattering: Scattering, names: &[&str]) -> Fallible {
    head(" ");
    let settings = SkySettings {
        scattering,
        ..SkySettings::fine()
    };
    let air = published::sky_article();
    let truth = Sky::prepare(&air, &WavelengthGrid::rgb(), &settings)?;
    for (name, variant) in VARIANTS.into_iter().filter(|(n, _)| names.contains(n)) {
        print!("| {name} |");
        for sun_deg in SUNS_DEG {
            let sky = article(variant, sun_deg)?;
            print!(" {} |", errors(&sky, &truth.view(1.0, sun(sun_deg))));
        }
        println!();
    }
    Ok(())
}

/// Time of a view ray, relative to the printed shader.
pub fn times() -> Fallible {
    let printed_s = time(Variant::Printed)?;
    println!("| | time |\n|---|---|");
    println!("| printed | 1 ({:.1} µs) |", 1e6 * printed_s);
    for (name, variant) in VARIANTS.into_iter().skip(1) {
        println!("| {name} | {} |", ratio(time(variant)? / printed_s));
    }
    let air = published::sky_article();
    let solver = Sky::prepare(&air, &WavelengthGrid::rgb(), &SkySettings::default())?;
    let view = solver.view(1.0, sun(30.0));
    let ours = seconds_a_line(|d| view.along(d, None));
    println!("| our solver, all orders | {} |", ratio(ours / printed_s));
    Ok(())
}

fn article(variant: Variant, sun_deg: f64) -> Result<SkyArticle, Box<dyn std::error::Error>> {
    let settings = Settings {
        variant,
        ..Default::default()
    };
    Ok(SkyArticle::new(&settings, sun(sun_deg))?)
}

fn time(variant: Variant) -> Result<f64, Box<dyn std::error::Error>> {
    let sky = article(variant, 30.0)?;
    Ok(seconds_a_line(|d: DVec3| sky.luminance(d)))
}

/// Errors over all channels and directions of the fan.
fn errors(sky: &SkyArticle, view: &View) -> Errors {
    // The solver's lanes are blue, green, red, with its own solar spectrum.
    let outside = Settings::default().sunlight.illuminance_outside();
    let solar = view.solar_irradiance();
    let pairs = fan().into_iter().flat_map(|direction| {
        let line = view.along(direction, None).radiance();
        let got = sky.luminance(direction);
        [0, 1, 2].map(|i| (got[i], f64::from(line[2 - i] / solar[2 - i]) * outside[i]))
    });
    Errors::of(pairs)
}
