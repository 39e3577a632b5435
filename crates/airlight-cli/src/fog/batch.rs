//! Fog over many pictures: progress and reports.

use crate::args::OverlayArgs;
use crate::error::CliError;
use crate::interrupt::{self, STOP};
use crate::progress::{Busy, PicturesBar};
use crate::report::{self, seconds};
use airlight_image::Control;
use airlight_render::batch::{BatchPlan, FoundInputs, listed};
use airlight_render::openjd::JobTemplate;
use airlight_render::overlay::OverlayScene;
use std::collections::BTreeMap;
use std::path::Path;
use std::time::Instant;

/// Writes the pictures of a description whose paths are folders or patterns.
///
/// # Errors
/// [`CliError`]; pictures that are already written remain.
pub fn run(args: &OverlayArgs, scene: OverlayScene) -> Result<(), CliError> {
    let plan = BatchPlan::new(scene, args.batch.settings())?;
    remarks(plan.found(), args.quiet);
    if let Some(path) = &args.batch.openjd {
        return write_job(args, &plan, path);
    }
    let batch = {
        let _busy = Busy::with("planning");
        plan.start()?
    };
    let shard = match plan.settings().shard {
        Some(shard) => format!(" in shard {shard}"),
        None => String::new(),
    };
    let begun = Instant::now();
    let (total, missing) = (plan.pictures().count(), batch.missing());
    let report = {
        let _writing = interrupt::start_writing()?;
        let bar = PicturesBar::new(missing as u64);
        batch.run(Control::cancelled_by(&STOP).reporting_to(&bar))?
    };
    report::remarks(&plan.scene().overlay.colour, &report.notes);
    let failures = report.failures.len();
    if !args.quiet {
        let mut also = String::new();
        if total > missing {
            also = format!(
                ", {} existed already (--overwrite replaces them)",
                total - missing
            );
        }
        if failures > 0 {
            also.push_str(&format!(", {failures} failed"));
        }
        let time = begun.elapsed();
        report::print(&format!(
            "{}: {} of {total} {}{shard} written{also}\n  manifest      {}\n  time          {}, {} pictures/s\n",
            plan.scene().output()?.display(),
            report.made,
            report::pictures(total),
            plan.manifest().display(),
            seconds(time),
            report::short(report.made as f64 / time.as_secs_f64().max(1e-9))
        ))?;
    }
    match report.stopped {
        Some(error) => Err(error.into()),
        None if failures > 0 => Err(CliError::failure(format!(
            "{failures} {} failed:{}",
            report::pictures(failures),
            listed(&report.failures)
        ))),
        None => Ok(()),
    }
}

/// Writes a job for a render farm.
fn write_job(args: &OverlayArgs, plan: &BatchPlan, path: &Path) -> Result<(), CliError> {
    let job = JobTemplate::of_batch(plan, args.batch.tasks)?;
    report::write_job(path, &job, args.quiet)
}

/// Reports pictures that are left out, other files and depth files without a picture on standard error.
fn remarks(found: &FoundInputs, quiet: bool) {
    let missing = found.without_depth.len();
    if missing > 0 {
        report::note(&format!(
            "{missing} of {} pictures without depth are left out:{}",
            missing + found.inputs.len(),
            listed(&found.without_depth)
        ));
    }
    let mut endings: BTreeMap<String, u32> = BTreeMap::new();
    for path in &found.passed_over {
        let ending = path.extension().unwrap_or_default().to_string_lossy();
        *endings.entry(ending.into_owned()).or_default() += 1;
    }
    if !endings.is_empty() {
        let endings = endings.iter().map(|(ending, count)| match ending.as_str() {
            "" => format!("{count} without an ending"),
            ending => format!("{count} .{ending}"),
        });
        let endings: Vec<String> = endings.collect();
        report::note(&format!(
            "files passed over, which are not EXR, HDR, PNG, JPEG or TIFF: {}",
            endings.join(", ")
        ));
    }
    if !(found.unused_depths.is_empty() || quiet) {
        let paths = found.unused_depths.iter();
        let paths: Vec<String> = paths.map(|path| format!("`{}`", path.display())).collect();
        report::note(&format!(
            "{} depth files without a picture:{}",
            paths.len(),
            listed(&paths)
        ));
    }
}
