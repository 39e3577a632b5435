//! `airlight compare`: one scene by two solvers.
//!
//! [`statistics`] measures the difference; the contact sheet shows both pictures and maps of it.

mod statistics;

use crate::args::{CompareArgs, SolverArg, StatisticsArg};
use crate::error::CliError;
use crate::report::{self, seconds};
use crate::sky::RenderedImage;
use airlight_image::tone::ToneMapper;
use airlight_plot::{Colormap, ContactSheet, Panel, Raster};
use statistics::{Difference, Spread, Statistics};

/// Runs the command.
///
/// # Errors
/// [`CliError`]: what was wrong with the options, or what failed.
pub fn run(args: &CompareArgs) -> Result<(), CliError> {
    check(args)?;
    crate::scene::use_threads(args.air.threads)?;
    let first = RenderedImage::new(&args.sky(&args.first))?;
    let second = RenderedImage::new(&args.sky(&args.second))?;
    let scale = match args.same_light {
        true => first.light.sky_horizontal_lx / second.light.sky_horizontal_lx,
        false => 1.0,
    };
    if !scale.is_finite() || scale <= 0.0 {
        return Err(CliError::usage(
            "--same-light needs two skies that shed light: one of these is black",
        ));
    }
    let difference = Difference::new(&first, &second, scale);
    let spread = |values: &[f64]| {
        Spread::new(&first, values).ok_or_else(|| {
            CliError::usage("the picture shows no sky that is lit: nothing can be compared")
        })
    };
    let statistics = Statistics {
        first: args.first.name.clone(),
        second: args.second.name.clone(),
        sun_elevation_deg: first.sun.elevation_deg,
        sky_horizontal_lx: [
            first.light.sky_horizontal_lx,
            second.light.sky_horizontal_lx,
        ],
        second_scaled_by: scale,
        luminance_percent: spread(&difference.percent)?,
        ciede2000: spread(&difference.ciede2000)?,
        seconds: [first.time.as_secs_f64(), second.time.as_secs_f64()],
    };
    if let Some(output) = &args.output {
        let sheet = contact_sheet(args, (&first, &second), &difference, &statistics)?;
        report::write_contact_sheet(output, &sheet)?;
    }
    let text = match args.format {
        StatisticsArg::Table => format!(
            "{}\ntime: {}, {}\n",
            statistics.lines().join("\n"),
            seconds(first.time),
            seconds(second.time)
        ),
        StatisticsArg::Json => serde_json::to_string_pretty(&statistics)
            .map(|text| text + "\n")
            .map_err(|error| CliError::failure(format!("cannot write JSON: {error}")))?,
    };
    report::print(&text)
}

/// Refuses options that do not go together, before anything is computed.
fn check(args: &CompareArgs) -> Result<(), CliError> {
    if args.air.solver != SolverArg::Orders {
        return Err(CliError::usage(
            "the solvers are the two names without dashes: leave out --solver",
        ));
    }
    let random = args.air.paths.is_some() || args.air.seed.is_some();
    if random && !args.has_paths() {
        return Err(CliError::usage(
            "--paths and --seed are for random paths: compare with monte-carlo, or leave them out",
        ));
    }
    if args.picture.spectral {
        return Err(CliError::usage(
            "skies are compared in luminance and colour: leave out --spectral",
        ));
    }
    args.output.as_deref().map_or(Ok(()), report::check_png)
}

/// Both pictures under one exposure, and the maps.
fn contact_sheet(
    args: &CompareArgs,
    (first, second): (&RenderedImage, &RenderedImage),
    difference: &Difference,
    statistics: &Statistics,
) -> Result<ContactSheet, CliError> {
    let scaled = ToneMapper::new(
        (f64::from(first.tone.exposure()) * statistics.second_scaled_by) as f32,
        crate::sky::tone_curve(&args.picture),
    )?;
    // Steps that a scale is read by.
    let round = |most: f64| {
        const STEPS: [f64; 9] = [0.5, 1.0, 2.0, 5.0, 10.0, 20.0, 50.0, 100.0, 200.0];
        STEPS
            .into_iter()
            .find(|&step| step >= most)
            .unwrap_or(500.0)
    };
    let percent = Colormap::diverging(
        args.map_percent
            .unwrap_or_else(|| round(statistics.luminance_percent.within_95)),
    );
    let colour = Colormap::sequential(round(statistics.ciede2000.within_95));
    let map = |title: &str, values: &[f64], (colormap, unit): (Colormap, &str)| Panel {
        title: title.to_owned(),
        picture: Raster {
            width: first.frame.size().width(),
            height: first.frame.size().height(),
            rgb: values
                .iter()
                .flat_map(|&value| colormap.colour(value))
                .collect(),
        },
        scale: Some((colormap, unit.to_owned())),
    };
    let shown = |name: &str, picture| Panel {
        title: name.to_owned(),
        picture,
        scale: None,
    };
    Ok(ContactSheet {
        heading: format!(
            "{} beside {}, sun at {:.2} degrees",
            args.second.name, args.first.name, first.sun.elevation_deg
        ),
        columns: 2,
        panels: vec![
            shown(&args.first.name, first.displayed(&first.tone)),
            shown(&args.second.name, second.displayed(&scaled)),
            map(
                "Difference of luminance",
                &difference.percent,
                (percent, "percent"),
            ),
            map(
                "Difference of colour",
                &difference.ciede2000,
                (colour, "CIEDE2000"),
            ),
        ],
        notes: statistics.lines(),
    })
}
