//! Bars on standard error, shown only where that is a terminal.

use airlight::monte_carlo::BUNDLE;
use airlight_image::Progress;
use indicatif::{ProgressBar, ProgressStyle};
use std::sync::atomic::{AtomicU64, Ordering};
use std::time::Duration;

/// How far many rows of one or more files have come.
pub struct RowsBar {
    bar: ProgressBar,
    /// Rows of files already done.
    before: AtomicU64,
}

impl RowsBar {
    /// A bar for so many rows in all.
    pub fn new(rows: u64) -> Self {
        let bar = ProgressBar::new(rows);
        let style = ProgressStyle::with_template("{msg} {wide_bar} {percent:>3} %, {eta} left");
        bar.set_style(style.unwrap_or_else(|_| ProgressStyle::default_bar()));
        Self {
            bar,
            before: AtomicU64::new(0),
        }
    }

    /// A bar for a pass over the rows of a picture, up to a number of bundles of paths a pixel.
    pub fn for_pass(rows: u64, until: u64, goal: u64) -> Self {
        let bar = Self::new(rows);
        bar.say(format!(
            "{} of {} paths a pixel",
            until * BUNDLE as u64,
            goal * BUNDLE as u64
        ));
        bar
    }

    /// Says what is being made now.
    pub fn say(&self, what: String) {
        self.bar.set_message(what);
    }

    /// So much more is done.
    pub fn advance(&self, rows: u64) {
        self.bar.inc(rows);
    }

    /// A file of so many rows is whole.
    pub fn file_done(&self, rows: u64) {
        let before = self.before.fetch_add(rows, Ordering::Relaxed);
        self.bar.set_position(before + rows);
    }
}

impl Progress for RowsBar {
    fn stage(&self, what: &str, total: u64) {
        self.bar.set_message(what.to_owned());
        self.bar.set_length(total);
        self.bar.set_position(0);
    }

    fn advanced(&self, done: u64, _total: u64) {
        self.bar
            .set_position(self.before.load(Ordering::Relaxed) + done);
    }
}

impl Drop for RowsBar {
    fn drop(&mut self) {
        self.bar.finish_and_clear();
    }
}

/// A sign of life during work whose length is not known.
pub struct Busy(ProgressBar);

impl Busy {
    /// Says what is being done.
    pub fn with(what: &'static str) -> Self {
        let bar = ProgressBar::new_spinner();
        let style = ProgressStyle::with_template("{spinner} {msg}, {elapsed}");
        bar.set_style(style.unwrap_or_else(|_| ProgressStyle::default_spinner()));
        bar.set_message(what);
        bar.enable_steady_tick(Duration::from_millis(100));
        Self(bar)
    }
}

impl Drop for Busy {
    fn drop(&mut self) {
        self.0.finish_and_clear();
    }
}

/// How many of many pictures are done.
pub struct PicturesBar(ProgressBar);

impl PicturesBar {
    /// A bar for so many pictures.
    pub fn new(count: u64) -> Self {
        let bar = ProgressBar::new(count);
        let style = ProgressStyle::with_template(
            "{pos} of {len} pictures {wide_bar} {per_sec}, {eta} left",
        );
        bar.set_style(style.unwrap_or_else(|_| ProgressStyle::default_bar()));
        Self(bar)
    }

    /// One more is done.
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
