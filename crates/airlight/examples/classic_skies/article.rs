//! The sky article's shader and the steps beyond it.

use crate::measure::{Errors, SUNS_DEG, fan, seconds_a_line, sun};
use airlight::classic::single_scattering::{Settings, SkyArticle, Variant};
use airlight::medium::presets::published;
use airlight::sky::{Scattering, Sky, SkySettings, View};
use airlight::spectrum::WavelengthGrid;
use glam::DVec3;

const VARIANTS: [Variant; 5] = [
    Variant::Printed,
    Variant::PrintedF64,
    Variant::Converged,
    Variant::Table,
    Variant::Multiple,
];

/// Prints errors against our solver, and speeds.
///
/// # Errors
/// None with these settings.
pub fn print() -> Result<(), Box<dyn std::error::Error>> {
    println!(
        "The sky article on its own air: rms (worst) percent of a channel, time a line of sight"
    );
    let air = published::sky_article();
    for scattering in [Scattering::Single, Scattering::All] {
        let settings = SkySettings {
            scattering,
            ..SkySettings::fine()
        };
        let truth = Sky::prepare(&air, &WavelengthGrid::rgb(), &settings)?;
        println!("\nagainst our solver, {scattering:?}; suns {SUNS_DEG:?}");
        for variant in VARIANTS {
            let mut row = format!("  {:11}", format!("{variant:?}"));
            for sun_deg in SUNS_DEG {
                let sky = article(variant, sun_deg)?;
                row += &format!(" | {}", errors(&sky, &truth.view(1.0, sun(sun_deg))));
            }
            println!("{row}");
        }
    }
    println!(
        "\ntime a line, in printed f32 ones ({} ns here)",
        (1e9 * time(Variant::Printed)?).round()
    );
    for variant in VARIANTS {
        println!(
            "  {:11} {:.2}",
            format!("{variant:?}"),
            time(variant)? / time(Variant::Printed)?
        );
    }
    let solver = Sky::prepare(&air, &WavelengthGrid::rgb(), &SkySettings::default())?;
    let view = solver.view(1.0, sun(30.0));
    let ours = seconds_a_line(|d| view.along(d, None));
    println!(
        "  our solver, all orders, 3 wavelengths {:.2}",
        ours / time(Variant::Printed)?
    );
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

/// All channels of the fan.
fn errors(sky: &SkyArticle, view: &View<'_>) -> Errors {
    // The solver's lanes are blue, green, red, under a sun of its own.
    let outside = Settings::default().sunlight.illuminance_outside();
    let solar = view.solar_irradiance();
    let pairs = fan().into_iter().flat_map(|direction| {
        let line = view.along(direction, None).radiance();
        let got = sky.luminance(direction);
        [0, 1, 2].map(|i| (got[i], f64::from(line[2 - i] / solar[2 - i]) * outside[i]))
    });
    Errors::of(pairs)
}
