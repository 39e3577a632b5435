//! `airlight probe`: the light along given directions, in numbers.
//!
//! [`views`] reads the directions, [`values`] holds what is told of them, [`model`] what published models tell; [`json`], [`csv`]
//! and [`table`] write it.

mod csv;
mod json;
mod model;
mod table;
mod values;
mod views;

use crate::args::{FormatArg, ProbeArgs};
use crate::error::CliError;
use crate::progress::Busy;
use crate::report;
use crate::scene::Scene;
use airlight::monte_carlo::{MonteCarlo, MonteCarloSettings};
use values::Answer;
use views::AskedView;

/// Paths for each view where nothing is said.
const PATHS: u64 = 65_536;

/// Runs the command.
///
/// # Errors
/// [`CliError`]: what was wrong with the options, or what failed.
pub fn run(args: &ProbeArgs) -> Result<(), CliError> {
    crate::scene::use_threads(args.air.threads)?;
    let views = views::read(args)?;
    if views.is_empty() && args.format == FormatArg::Csv {
        return Err(CliError::usage(
            "CSV has a line for each view: give --view AZ,EL or --views FILE.csv",
        ));
    }
    let settings = args.air.monte_carlo(PATHS)?;
    if args.polarisation && settings.is_none() {
        return Err(CliError::usage(
            "--polarisation is for random paths, the other solver's light is scalar: give --solver monte-carlo as well",
        ));
    }
    args.model.check(args.air.solver)?;
    model::check(args, &views)?;
    let scene = Scene::new(&args.place, &args.air)?;
    if let Some(path) = &args.output {
        report::check_writable(path)?;
    }
    let answer = match args.air.solver.is_published_model() {
        true => model::answer(args, &scene, &views)?,
        false => solved(args, &scene, settings, &views)?,
    };
    let text = match args.format {
        FormatArg::Json => json::text(&answer)?,
        FormatArg::Csv => csv::text(&answer),
        FormatArg::Table => table::text(&answer),
    };
    match &args.output {
        Some(path) => report::write(path, &text),
        None => report::print(&text),
    }
}

/// What the solver answers, and random paths beside it where there are settings for them.
fn solved(
    args: &ProbeArgs,
    scene: &Scene,
    settings: Option<MonteCarloSettings>,
    views: &[AskedView],
) -> Result<Answer, CliError> {
    let sun = scene.sun.at(None)?;
    let (sky, _) = scene.prepare(scene.near(&sun))?;
    let paths = settings
        .map(|settings| MonteCarlo::new(&scene.atmosphere, &scene.grid, settings))
        .transpose()?;
    let _busy = Busy::with("computing");
    Ok(Answer::new(
        args,
        scene,
        (&sky, paths.as_ref()),
        &sun,
        views,
    ))
}
