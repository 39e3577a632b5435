//! Many moments: a sky prepared once, a picture for each, those already there left as they are.

use super::layout::PictureFile;
use super::prepared_frame::{Prepared, PreparedFrame};
use super::preview;
use super::renderer::Renderer;
use crate::error::CliError;
use crate::interrupt;
use crate::progress::RowsBar;
use crate::report::{self, seconds};
use airlight::sky::SunCoverage;
use airlight::sun::Moment;
use airlight_image::output::Written;
use airlight_render::sequence::{FramePattern, SequencePlan};
use std::path::Path;
use std::time::Instant;

/// One frame to make.
struct Frame {
    number: u64,
    time: Moment,
    files: Vec<PictureFile>,
}

/// Runs a sequence from the scene's time until `until`.
///
/// # Errors
/// [`CliError`]; frames already made stay.
pub fn run(
    renderer: &Renderer<'_>,
    until: &str,
    preview: Option<preview::Terminal>,
) -> Result<(), CliError> {
    let (output, plan, start) = planned(renderer, until)?;
    let pattern = FramePattern::new(output);
    let frames: Vec<Frame> = plan
        .frames()
        .map(|step| Frame {
            number: step.number,
            time: start.at(step.time_s as f64),
            files: renderer
                .layout
                .files(&pattern.path(step.number, step.time_s)),
        })
        .collect();
    let total = frames.len();
    let missing: Vec<Frame> = frames
        .into_iter()
        .filter(|frame| renderer.args.sequence.overwrite || !frame.is_whole())
        .collect();
    let begun = Instant::now();
    if let Some(first) = missing.first() {
        renderer.check(
            first
                .files
                .last()
                .map(|_| pattern.path(first.number, first.time.unix_s() as i64))
                .as_deref(),
        )?;
        make(renderer, &missing, total, preview)?;
    }
    if renderer.args.quiet {
        return Ok(());
    }
    let there = total - missing.len();
    let skipped = match there {
        0 => String::new(),
        n => format!(", {n} were there already (--overwrite makes them anew)"),
    };
    report::print(&format!(
        "{}: {} of {total} frames made{skipped}, {}\n  time          {}\n",
        output.display(),
        missing.len(),
        renderer.kind(),
        seconds(begun.elapsed())
    ))
}

/// Where to write, the frames, and when they begin.
fn planned<'a>(
    renderer: &Renderer<'a>,
    until: &str,
) -> Result<(&'a Path, SequencePlan, Moment), CliError> {
    let Some(output) = renderer.args.output.as_deref() else {
        return Err(CliError::usage(
            "--until draws files: say with --output what to call them",
        ));
    };
    let Some(start) = renderer.scene.sun.start() else {
        return Err(CliError::usage(
            "--until needs a sun that moves: give --at and --when instead of --sun-elevation",
        ));
    };
    let start = start.at(start.unix_s().floor());
    let refuse = |error: String| CliError::usage(format!("--until: {error}"));
    let end = match until.trim().strip_prefix('+') {
        Some(span) => start.unix_s() + crate::parse::span_s(span).map_err(refuse)? as f64,
        None => Moment::parse(until)
            .map_err(|error| refuse(format!("{error}; or write now")))?
            .unix_s(),
    };
    let every = renderer.args.sequence.every.unwrap_or(1);
    if end < start.unix_s() {
        return Err(refuse(format!(
            "{until} lies before --when {start}: it must be later"
        )));
    }
    let plan = SequencePlan::new(start.unix_s() as i64, end.floor() as i64, every)?;
    // Told before anything is computed.
    renderer.scene.sun.at(Some(start.at(end)))?;
    Ok((output, plan, start))
}

fn make(
    renderer: &Renderer<'_>,
    missing: &[Frame],
    total: usize,
    preview: Option<preview::Terminal>,
) -> Result<(), CliError> {
    let scene = renderer.scene;
    let suns = match missing {
        [only] => scene.near(&scene.sun.at(Some(only.time))?),
        _ => SunCoverage::All,
    };
    let (prepared, _) = Prepared::new(renderer, suns)?;
    let bar = RowsBar::new(missing.iter().map(Frame::rows).sum());
    let mut written: Vec<Written> = Vec::new();
    for frame in missing {
        bar.say(format!("frame {} of {total}", frame.number));
        let sun = scene.sun.at(Some(frame.time))?;
        let prepared = PreparedFrame::new(renderer, &prepared, &sun, Some(frame.time))?;
        if let Some(terminal) = preview {
            report::print(&preview::text(renderer, &prepared, terminal)?)?;
        }
        let _writing = interrupt::start_writing()?;
        written.extend(renderer.write(&prepared, &frame.files, &bar)?);
    }
    drop(bar);
    renderer.warn_of_clipping(&written);
    Ok(())
}

impl Frame {
    /// Files appear whole or not at all, so those that are there are done.
    fn is_whole(&self) -> bool {
        self.files.iter().all(|file| {
            std::fs::metadata(&file.path).is_ok_and(|about| about.is_file() && about.len() > 0)
        })
    }

    fn rows(&self) -> u64 {
        self.files
            .iter()
            .map(|file| u64::from(file.frame.size().height()))
            .sum()
    }
}
