//! Where pixels come from, and how a long write is followed and stopped.

use std::sync::atomic::{AtomicBool, Ordering};

use crate::ImageError;

/// Supplies linear pixels row by row. Called from many threads, in any order, each row once a picture.
pub trait RowSource: Sync {
    /// Values a pixel.
    fn channels(&self) -> usize;

    /// Fills row `y` (0 at the top): `out` holds `width * channels` values, pixel by pixel.
    fn fill_row(&self, y: u32, out: &mut [f32]);
}

/// A row source made of a function.
#[derive(Clone, Copy, Debug)]
pub struct RowFn<F> {
    channels: usize,
    fill: F,
}

impl<F: Fn(u32, &mut [f32]) + Sync> RowFn<F> {
    /// Rows of `channels` values a pixel, filled by `fill(y, out)`.
    pub fn new(channels: usize, fill: F) -> Self {
        Self { channels, fill }
    }
}

impl<F: Fn(u32, &mut [f32]) + Sync> RowSource for RowFn<F> {
    fn channels(&self) -> usize {
        self.channels
    }

    fn fill_row(&self, y: u32, out: &mut [f32]) {
        (self.fill)(y, out)
    }
}

/// A picture that lies in memory, row after row, pixel by pixel.
#[derive(Clone, Debug, PartialEq)]
pub struct StoredRows {
    width: u32,
    channels: usize,
    samples: Vec<f32>,
}

impl StoredRows {
    /// Takes `samples`, whose number must be a whole number of rows of `width * channels` values.
    ///
    /// # Errors
    /// [`ImageError::Setting`] where it is not.
    pub fn new(width: u32, channels: usize, samples: Vec<f32>) -> Result<Self, ImageError> {
        let row = (width as usize).saturating_mul(channels);
        if row == 0 || !samples.len().is_multiple_of(row) {
            return Err(ImageError::Setting {
                what: "the number of samples",
                got: format!("{} for {width} x {channels}", samples.len()),
                right: "a multiple of width times channels",
            });
        }
        Ok(Self {
            width,
            channels,
            samples,
        })
    }

    /// Number of rows.
    pub fn height(&self) -> u32 {
        (self.samples.len() / (self.width as usize * self.channels)) as u32
    }

    /// All samples, row after row.
    pub fn samples(&self) -> &[f32] {
        &self.samples
    }
}

impl RowSource for StoredRows {
    fn channels(&self) -> usize {
        self.channels
    }

    /// Rows below the last are left as they are.
    fn fill_row(&self, y: u32, out: &mut [f32]) {
        let row = self.width as usize * self.channels;
        let start = y as usize * row;
        if let Some(samples) = self.samples.get(start..start + row) {
            let n = row.min(out.len());
            out[..n].copy_from_slice(&samples[..n]);
        }
    }
}

/// Is told how far a picture has come.
pub trait Progress: Sync {
    /// A stage of the work begins: what is done, in a few words, and how many rows it has (0: not known).
    fn stage(&self, _what: &str, _rows: u64) {}

    /// `done` of `total` rows are finished. Called from the threads that finish them.
    fn rows_written(&self, done: u32, total: u32);
}

/// How the caller follows and stops a write. The default does neither.
#[derive(Clone, Copy, Default)]
pub struct Control<'a> {
    /// Once true, the write ends with [`ImageError::Cancelled`] and leaves no file.
    pub cancel: Option<&'a AtomicBool>,
    /// Told as rows are written.
    pub progress: Option<&'a dyn Progress>,
}

impl<'a> Control<'a> {
    /// Stops when `cancel` becomes true.
    pub fn cancelled_by(cancel: &'a AtomicBool) -> Self {
        Self {
            cancel: Some(cancel),
            progress: None,
        }
    }

    /// The same, reporting to `progress`.
    pub fn reporting_to(self, progress: &'a dyn Progress) -> Self {
        Self {
            progress: Some(progress),
            ..self
        }
    }

    /// Reports that a stage of the work begins: see [`Progress::stage`].
    pub fn stage(&self, what: &str, rows: u64) {
        if let Some(progress) = self.progress {
            progress.stage(what, rows);
        }
    }

    /// [`ImageError::Cancelled`] once the caller has asked to stop.
    pub fn check(&self) -> Result<(), ImageError> {
        match self.cancel {
            Some(cancel) if cancel.load(Ordering::Relaxed) => Err(ImageError::Cancelled),
            _ => Ok(()),
        }
    }

    /// Reports that `done` of `total` rows are finished.
    pub fn report(&self, done: u32, total: u32) {
        if let Some(progress) = self.progress {
            progress.rows_written(done, total);
        }
    }
}

impl std::fmt::Debug for Control<'_> {
    fn fmt(&self, f: &mut std::fmt::Formatter<'_>) -> std::fmt::Result {
        f.debug_struct("Control")
            .field("cancel", &self.cancel)
            .field("progress", &self.progress.is_some())
            .finish()
    }
}
