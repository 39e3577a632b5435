//! Progress bars on standard error, shown only on a terminal.

use airlight_image::Progress;
use indicatif::{HumanDuration, ProgressBar, ProgressState, ProgressStyle};
use std::fmt::Write;
use std::sync::atomic::{AtomicU64, Ordering};
use std::time::Duration;

/// Interval at which bars are drawn, whether or not progress is reported.
const TICK: Duration = Duration::from_millis(200);

/// Style of work of known length.
fn bar_style() -> ProgressStyle {
    let style = ProgressStyle::with_template("{msg} {wide_bar} {percent:>3} %{left}");
    style
        .unwrap_or_else(|_| ProgressStyle::default_bar())
        .with_key("left", time_left)
}

/// Time left, which is not known before the first progress.
fn time_left(state: &ProgressState, out: &mut dyn Write) {
    if state.pos() > 0 {
        // The text of a bar cannot fail.
        let _ = write!(out, ", {:#} left", HumanDuration(state.eta()));
    }
}

/// Style of work of unknown length.
fn spinner_style() -> ProgressStyle {
    let style = ProgressStyle::with_template("{spinner} {msg}, {elapsed}");
    style.unwrap_or_else(|_| ProgressStyle::default_spinner())
}

/// Progress in rows of pictures.
pub struct RowsBar {
    bar: ProgressBar,
    /// Rows of finished files.
    before: AtomicU64,
    /// Whether the bar restarts at each stage of a picture.
    by_stages: bool,
}

impl RowsBar {
    /// A bar over a number of rows.
    pub fn new(rows: u64) -> Self {
        Self::with(rows, false)
    }

    /// A bar for each stage of a picture: solving, and rows.
    pub fn by_stages() -> Self {
        Self::with(0, true)
    }

    fn with(rows: u64, by_stages: bool) -> Self {
        let bar = ProgressBar::new(rows);
        bar.set_style(if rows == 0 {
            spinner_style()
        } else {
            bar_style()
        });
        // Until the first stage.
        bar.set_message("preparing");
        bar.enable_steady_tick(TICK);
        Self {
            bar,
            before: AtomicU64::new(0),
            by_stages,
        }
    }

    /// Sets the message.
    pub fn say(&self, what: String) {
        self.bar.set_message(what);
    }

    /// Sets the amount of work of a stage; 0: not known.
    fn set_length(&self, rows: u64) {
        self.bar.set_length(rows);
        self.bar.set_style(if rows == 0 {
            spinner_style()
        } else {
            bar_style()
        });
    }

    /// Adds the rows of finished files, to which those of the following files are added.
    pub fn files_done(&self, rows: u64) {
        let before = self.before.fetch_add(rows, Ordering::Relaxed);
        self.bar.set_position(before + rows);
    }
}

impl Progress for RowsBar {
    fn stage(&self, what: &str, rows: u64) {
        if self.by_stages {
            self.bar.reset();
            self.set_length(rows);
            self.bar.set_message(what.to_owned());
        }
    }

    fn advanced(&self, done: u64, total: u64) {
        if self.by_stages && self.bar.length() != Some(total) {
            self.set_length(total);
        }
        self.bar
            .set_position(self.before.load(Ordering::Relaxed) + done);
    }
}

impl Drop for RowsBar {
    fn drop(&mut self) {
        self.bar.finish_and_clear();
    }
}

/// A spinner for work of unknown duration.
pub struct Busy(ProgressBar);

impl Busy {
    /// Sets the message.
    pub fn with(what: &'static str) -> Self {
        let bar = ProgressBar::new_spinner();
        bar.set_style(spinner_style());
        bar.set_message(what);
        bar.enable_steady_tick(TICK);
        Self(bar)
    }
}

impl Drop for Busy {
    fn drop(&mut self) {
        self.0.finish_and_clear();
    }
}

/// Progress in pictures.
pub struct PicturesBar(ProgressBar);

impl PicturesBar {
    /// A bar over a number of pictures.
    pub fn new(count: u64) -> Self {
        let bar = ProgressBar::new(count);
        let style =
            ProgressStyle::with_template("{pos} of {len} pictures {wide_bar} {per_sec}{left}");
        let style = style.unwrap_or_else(|_| ProgressStyle::default_bar());
        bar.set_style(style.with_key("left", time_left));
        bar.enable_steady_tick(TICK);
        Self(bar)
    }

    /// Counts a finished picture.
    pub fn one_more(&self) {
        self.0.inc(1);
    }
}

impl Progress for PicturesBar {
    fn advanced(&self, done: u64, _total: u64) {
        self.0.set_position(done);
    }
}

impl Drop for PicturesBar {
    fn drop(&mut self) {
        self.0.finish_and_clear();
    }
}
