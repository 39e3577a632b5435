//! `airlight compare`: one scene with two solvers.

use crate::args::{CompareArgs, StatisticsArg};
use crate::error::CliError;
use crate::interrupt::STOP;
use crate::progress::RowsBar;
use crate::report::{self, seconds};
use airlight_image::Control;
use airlight_image::tone::{Exposure, ToneMapper};
use airlight_plot::{Colormap, ContactSheet, Panel, Raster};
use airlight_render::compare::{Difference, Statistics, sky_horizontal_lx};
use airlight_render::{RenderedImage, Renderer};

/// Runs the command.
///
/// # Errors
/// [`CliError`] for invalid options and failures.
pub fn run(args: &CompareArgs) -> Result<(), CliError> {
    args.output.as_deref().map_or(Ok(()), report::check_png)?;
    let [first, second] = args.read()?;
    // Check both before solving either.
    let renderers = [Renderer::new(&first)?, Renderer::new(&second)?];
    let draw = |renderer: &Renderer| {
        let bar = RowsBar::by_stages();
        renderer.render(Control::cancelled_by(&STOP).reporting_to(&bar))
    };
    let (first, second) = (draw(&renderers[0])?, draw(&renderers[1])?);
    let scale = match args.same_light {
        true => sky_horizontal_lx(&first) / sky_horizontal_lx(&second),
        false => 1.0,
    };
    if !scale.is_finite() || scale <= 0.0 {
        return Err(CliError::usage(
            "--same-light: expected two skies that are not black, got a black one; try leaving it out",
        ));
    }
    let difference = Difference::new(&first, &second, scale);
    let names = (args.first.text.as_str(), args.second.text.as_str());
    let statistics = difference
        .statistics((&first, names.0), (&second, names.1), scale)
        .ok_or_else(|| CliError::usage("expected a picture of sky that is not black, got none; try another projection or direction"))?;
    if let Some(output) = &args.output {
        let exposure = Exposure::from_factor(f64::from(first.tone.exposure()) * scale)?;
        let tone = renderers[0].tone_mapper(exposure)?;
        let sheet = sheet(args, (&first, &second), &tone, &difference, &statistics);
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

/// Contact sheet of both pictures with the same exposure, and the maps.
fn sheet(
    args: &CompareArgs,
    (first, second): (&RenderedImage, &RenderedImage),
    second_tone: &ToneMapper,
    difference: &Difference,
    statistics: &Statistics,
) -> ContactSheet {
    // Round limits of a scale.
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
    let size = first.frame.size();
    let map = |title: &str, values: &[f64], (colormap, unit): (Colormap, &str)| Panel {
        title: title.to_owned(),
        picture: Raster {
            width: size.width(),
            height: size.height(),
            rgb: values
                .iter()
                .flat_map(|&value| colormap.colour(value))
                .collect(),
        },
        scale: Some((colormap, unit.to_owned())),
    };
    let (percents, colours) = (&difference.percent, &difference.ciede2000);
    ContactSheet {
        heading: format!(
            "{} compared with {}, sun at {:.2} degrees",
            args.second.text, args.first.text, first.sun.elevation_deg
        ),
        columns: 2,
        panels: vec![
            report::panel(&args.first.text, first, &first.tone),
            report::panel(&args.second.text, second, second_tone),
            map("Difference of luminance", percents, (percent, "percent")),
            map("Difference of colour", colours, (colour, "CIEDE2000")),
        ],
        notes: statistics.lines(),
    }
}
