//! Many pictures: found by name, fogged in parallel, those already there left as they are, all told in a manifest.

mod draw;
mod inputs;
mod manifest;
mod pattern;
mod plan;
mod record;
mod work;

use super::light::{LightSource, SolvedSky};
use crate::args::{OverlayArgs, overlay_vary};
use crate::error::CliError;
use crate::interrupt;
use crate::report::{self, seconds};
use inputs::{Input, Place, listed};
use manifest::{Manifest, is_whole};
use pattern::Pattern;
use plan::Plan;
use record::Which;
use std::path::{Path, PathBuf};
use std::time::Instant;
use work::{Outcome, Task};

/// Whether the options ask for many pictures, or for what only many have.
///
/// # Errors
/// [`CliError::Usage`] for a pattern that is none.
pub fn is_asked_for(args: &OverlayArgs) -> Result<bool, CliError> {
    let many = !matches!(Place::to_read(&args.colour)?, Place::File(_));
    Ok(many || args.batch.is_given() || Pattern::new(&args.output)?.is_some())
}

/// Makes them.
///
/// # Errors
/// [`CliError`]; pictures already made stay.
pub fn run(args: &OverlayArgs) -> Result<(), CliError> {
    let plan = Plan::new(args)?;
    let solved = match overlay_vary::changes_the_sky(&args.batch.vary) {
        true => None,
        false => SolvedSky::of(args)?,
    };
    let light = LightSource::new(solved.as_ref(), args);
    let path = match &args.batch.manifest {
        Some(path) => path.clone(),
        None => plan.folder.join("manifest.jsonl"),
    };
    make_folder(path.parent())?;
    let manifest = Manifest::open(&path)?;
    let tasks = match missing(args, &plan, &manifest) {
        Ok(tasks) => tasks,
        Err(refusal) => {
            manifest.leave()?;
            return Err(refusal);
        }
    };
    let begun = Instant::now();
    let outcome = {
        let _writing = interrupt::start_writing()?;
        let outcome = work::run(args, &light, &plan, &manifest, &tasks);
        manifest.finish()?;
        outcome
    };
    let failures = outcome.failures.len();
    if !args.quiet {
        report::print(&summary(args, &plan, &tasks, &outcome, &path, begun))?;
    }
    if let Some(error) = outcome.stopped {
        return Err(error);
    }
    match failures {
        0 => Ok(()),
        _ => Err(CliError::failure(format!(
            "{failures} pictures failed:{}",
            listed(&outcome.failures)
        ))),
    }
}

/// Makes a folder that is not there.
fn make_folder(folder: Option<&Path>) -> Result<(), CliError> {
    let Some(folder) = folder.filter(|folder| !folder.as_os_str().is_empty()) else {
        return Ok(());
    };
    std::fs::create_dir_all(folder).map_err(|error| {
        CliError::failure(format!(
            "cannot make the folder `{}`: {error}",
            folder.display()
        ))
    })
}

/// The pictures that are not there yet, by input.
///
/// # Errors
/// [`CliError::Usage`] where some are there that were made otherwise.
fn missing<'a>(
    args: &OverlayArgs,
    plan: &'a Plan,
    manifest: &Manifest,
) -> Result<Vec<Task<'a>>, CliError> {
    let mut tasks: Vec<Task<'a>> = Vec::new();
    let (mut strange, mut different) = (Vec::new(), Vec::new());
    for (input, variant) in plan.pictures() {
        let output = plan.output(args, input, variant);
        if args.batch.overwrite || !is_whole(&output) {
            match tasks
                .last_mut()
                .filter(|task| std::ptr::eq(task.input, input))
            {
                Some(task) => task.variants.push(variant),
                None => tasks.push(Task {
                    input,
                    variants: vec![variant],
                }),
            }
            continue;
        }
        let name = manifest.name_of(&output);
        let Some(line) = manifest.made(&name)? else {
            strange.push(format!("`{}`", output.display()));
            continue;
        };
        let options = plan.options(args, input, variant);
        let differences = Which::new(input, variant, &name).differences(&options, &line)?;
        if !differences.is_empty() {
            different.push(format!(
                "`{}`: {}",
                output.display(),
                differences.join("; ")
            ));
        }
    }
    let refuse = |what: &str, list: Vec<String>| {
        Err(CliError::usage(format!(
            "{} of the pictures are there already, but {what}. Give --overwrite to make all anew, or another --output:{}",
            list.len(),
            listed(&list)
        )))
    };
    if !different.is_empty() {
        return refuse("made with other options", different);
    }
    if !strange.is_empty() {
        return refuse("the manifest does not know them", strange);
    }
    Ok(tasks)
}

fn summary(
    args: &OverlayArgs,
    plan: &Plan,
    tasks: &[Task<'_>],
    outcome: &Outcome,
    manifest: &Path,
    begun: Instant,
) -> String {
    let total = plan.pictures().count();
    let there = total - tasks.iter().map(|task| task.variants.len()).sum::<usize>();
    let mut also = String::new();
    if there > 0 {
        also = format!(", {there} were there already (--overwrite makes them anew)");
    }
    if !outcome.failures.is_empty() {
        also.push_str(&format!(", {} failed", outcome.failures.len()));
    }
    let time = begun.elapsed();
    format!(
        "{}: {} of {total} pictures made{also}\n  manifest      {}\n  time          {}, {} pictures/s\n",
        args.output.display(),
        outcome.made,
        manifest.display(),
        seconds(time),
        report::short(outcome.made as f64 / time.as_secs_f64().max(1e-9))
    )
}
