//! Which frames a sequence has, and the loop over those still missing.

use super::FramePattern;
use airlight_image::{Control, ImageError};
use std::path::{Path, PathBuf};

/// Evenly spaced moments, from the first to the last inclusive.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct SequencePlan {
    start_s: i64,
    every_s: i64,
    count: u64,
}

/// One frame of a plan.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct FrameStep {
    /// Its number, from 1.
    pub number: u64,
    /// The moment it shows, seconds since 1970-01-01T00:00:00Z.
    pub time_s: i64,
}

impl SequencePlan {
    /// The most frames a plan may have.
    pub const MOST_FRAMES: u64 = 1_000_000;

    /// Moments `start_s`, `start_s + every_s` and so on, none after `until_s` (seconds since 1970-01-01T00:00:00Z).
    ///
    /// # Errors
    /// [`ImageError::Setting`] where `every_s` is not positive, `until_s` lies before `start_s`, or there would be
    /// more than a million frames.
    pub fn new(start_s: i64, until_s: i64, every_s: i64) -> Result<Self, ImageError> {
        let refuse = |what, got: String, right| Err(ImageError::Setting { what, got, right });
        if every_s <= 0 {
            return refuse(
                "the step of a sequence",
                format!("{every_s} s"),
                "above 0 s",
            );
        }
        if until_s < start_s {
            return refuse(
                "the end of a sequence",
                format!("{until_s} s with a start at {start_s} s"),
                "at or after its start",
            );
        }
        let count = until_s.abs_diff(start_s) / every_s.unsigned_abs();
        if count >= Self::MOST_FRAMES {
            return refuse(
                "the number of frames",
                format!("{}", u128::from(count) + 1),
                "at most 1000000: take a longer step or an earlier end",
            );
        }
        Ok(Self {
            start_s,
            every_s,
            count: count + 1,
        })
    }

    /// Number of frames.
    pub fn count(&self) -> u64 {
        self.count
    }

    /// The frames in order.
    pub fn frames(&self) -> impl Iterator<Item = FrameStep> + use<> {
        let Self {
            start_s, every_s, ..
        } = *self;
        (0..self.count).map(move |index| FrameStep {
            number: index + 1,
            // The result lies between start and end, even where a step from the start overflows on the way.
            time_s: start_s.wrapping_add(every_s.wrapping_mul(index as i64)),
        })
    }
}

/// Hears how far a sequence has come. Each method does nothing unless overridden.
pub trait SequenceProgress {
    /// A frame is about to be made; `total` frames in all.
    fn started(&mut self, frame: FrameStep, total: u64, path: &Path) {
        let _ = (frame, total, path);
    }

    /// A frame's file was already there.
    fn skipped(&mut self, frame: FrameStep, total: u64, path: &Path) {
        let _ = (frame, total, path);
    }

    /// A frame's file is whole.
    fn finished(&mut self, frame: FrameStep, total: u64, path: &Path) {
        let _ = (frame, total, path);
    }
}

/// Hears nothing.
impl SequenceProgress for () {}

/// What a run of a sequence did.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub struct SequenceReport {
    /// Frames made.
    pub made: u64,
    /// Frames whose file was there already.
    pub skipped: u64,
}

/// Makes every frame of `plan` whose file is not there yet, in order, by `make(frame, path)`.
///
/// Files are only ever whole, so one that exists and is not empty counts as done; with `overwrite`, all are made.
///
/// # Errors
/// The first error of `make`, or [`ImageError::Cancelled`] between frames once the caller has asked to stop. Frames
/// already made stay.
pub fn run(
    plan: &SequencePlan,
    pattern: &FramePattern,
    overwrite: bool,
    control: Control<'_>,
    progress: &mut dyn SequenceProgress,
    mut make: impl FnMut(FrameStep, &Path) -> Result<(), ImageError>,
) -> Result<SequenceReport, ImageError> {
    let mut report = SequenceReport::default();
    for frame in plan.frames() {
        control.check()?;
        let path: PathBuf = pattern.path(frame.number, frame.time_s);
        if !overwrite && is_whole(&path) {
            report.skipped += 1;
            progress.skipped(frame, plan.count, &path);
            continue;
        }
        progress.started(frame, plan.count, &path);
        make(frame, &path)?;
        report.made += 1;
        progress.finished(frame, plan.count, &path);
    }
    Ok(report)
}

fn is_whole(path: &Path) -> bool {
    std::fs::metadata(path).is_ok_and(|about| about.is_file() && about.len() > 0)
}
