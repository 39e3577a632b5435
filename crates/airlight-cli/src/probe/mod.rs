//! `airlight probe`: light along given directions as numbers. [`table`] formats them as plain text.

mod table;

use crate::args::{FormatArg, ProbeArgs};
use crate::error::CliError;
use crate::interrupt::STOP;
use crate::progress::RowsBar;
use crate::report;
use airlight_image::Control;
use airlight_render::probe::{Probe, ProbeRay};
use airlight_render::scene_file::read_text;
use std::io::Read;
use std::path::Path;

/// Runs the command.
///
/// # Errors
/// [`CliError`] for invalid options and failures.
pub fn run(args: &ProbeArgs) -> Result<(), CliError> {
    let rays = rays(args)?;
    if rays.is_empty() && args.format == FormatArg::Csv {
        return Err(CliError::usage(
            "--format csv: expected directions, got none; try --view AZ,EL or --views FILE.csv",
        ));
    }
    let probe = Probe::new(&args.read()?, rays)?;
    if let Some(path) = &args.output {
        report::check_writable(path)?;
    }
    let bar = RowsBar::by_stages();
    let answer = probe.answer(Control::cancelled_by(&STOP).reporting_to(&bar))?;
    drop(bar);
    let text = match args.format {
        FormatArg::Json => answer
            .to_json()
            .map_err(|error| CliError::failure(format!("cannot write JSON: {error}")))?,
        FormatArg::Csv => answer.to_csv(),
        FormatArg::Table => table::text(&answer),
    };
    match &args.output {
        Some(path) => report::write(path, &text),
        None => report::print(&text),
    }
}

/// Directions of the options, those of `--view` first.
fn rays(args: &ProbeArgs) -> Result<Vec<ProbeRay>, CliError> {
    let mut rays: Vec<ProbeRay> = args
        .view
        .iter()
        .map(|view| ProbeRay {
            azimuth_deg: view.azimuth_deg,
            elevation_deg: view.elevation_deg,
            distance_m: args.distance_m,
        })
        .collect();
    if let Some(path) = &args.views {
        let text = match path == Path::new("-") {
            true => {
                let mut text = String::new();
                std::io::stdin()
                    .lock()
                    .read_to_string(&mut text)
                    .map_err(|error| {
                        CliError::failure(format!("cannot read standard input: {error}"))
                    })?;
                text
            }
            false => read_text(path, "CSV")?,
        };
        let found = ProbeRay::list_from_csv(&text, args.distance_m)
            .map_err(|error| CliError::usage(format!("`{}`, {error}", path.display())))?;
        rays.extend(found);
    }
    Ok(rays)
}
