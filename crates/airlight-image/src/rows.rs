//! Sources of picture rows.

use crate::{Control, ImageError, Size};
use airlight::Cancelled;
use rayon::prelude::*;

/// Supplies linear pixels row by row. Writers call it from many threads, in any order, once for each row.
pub trait RowSource: Sync {
    /// Number of samples of a pixel.
    fn channels(&self) -> usize;

    /// Fills row `y` (0 at the top). `out` has `width * channels` samples, interleaved.
    fn fill_row(&self, y: u32, out: &mut [f32]);
}

/// A row source from a function.
#[derive(Clone, Copy, Debug)]
pub struct RowFn<F> {
    channels: usize,
    fill: F,
}

impl<F: Fn(u32, &mut [f32]) + Sync> RowFn<F> {
    /// Rows with `channels` samples a pixel, filled by `fill(y, out)`.
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

/// A picture in memory.
#[derive(Clone, Debug, PartialEq)]
pub struct StoredRows {
    width: u32,
    channels: usize,
    samples: Vec<f32>,
}

impl StoredRows {
    /// Interleaved samples, row after row from the top.
    ///
    /// # Errors
    /// [`ImageError::Setting`] where the number of samples is not a multiple of `width * channels`.
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

    /// All samples, interleaved, row after row.
    pub fn samples(&self) -> &[f32] {
        &self.samples
    }
}

/// The rows of a source from one of them on.
#[derive(Clone, Copy)]
pub struct RowsFrom<'a> {
    source: &'a dyn RowSource,
    first: u32,
}

impl<'a> RowsFrom<'a> {
    /// Rows of which row 0 is row `first` of the source.
    pub fn new(source: &'a dyn RowSource, first: u32) -> Self {
        Self { source, first }
    }
}

impl std::fmt::Debug for RowsFrom<'_> {
    fn fmt(&self, f: &mut std::fmt::Formatter<'_>) -> std::fmt::Result {
        f.debug_struct("RowsFrom")
            .field("first", &self.first)
            .finish_non_exhaustive()
    }
}

impl RowSource for RowsFrom<'_> {
    fn channels(&self) -> usize {
        self.source.channels()
    }

    fn fill_row(&self, y: u32, out: &mut [f32]) {
        self.source.fill_row(self.first + y, out);
    }
}

/// All rows of a picture in memory, drawn on all threads: interleaved samples, row after row from the top.
///
/// # Errors
/// [`Cancelled`], within the time of a few rows.
pub fn draw_rows(
    rows: &dyn RowSource,
    size: Size,
    control: Control<'_>,
) -> Result<Vec<f32>, Cancelled> {
    let row = size.width() as usize * rows.channels();
    let mut samples = vec![0.0; row * size.height() as usize];
    samples
        .par_chunks_mut(row)
        .zip(0..size.height())
        .try_for_each(|(out, y)| {
            control.check()?;
            rows.fill_row(y, out);
            Ok(())
        })?;
    Ok(samples)
}

impl RowSource for StoredRows {
    fn channels(&self) -> usize {
        self.channels
    }

    /// Leaves `out` unchanged below the last row.
    fn fill_row(&self, y: u32, out: &mut [f32]) {
        let row = self.width as usize * self.channels;
        let start = y as usize * row;
        if let Some(samples) = self.samples.get(start..start + row) {
            let n = row.min(out.len());
            out[..n].copy_from_slice(&samples[..n]);
        }
    }
}
