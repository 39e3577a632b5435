//! The loop shared by all writers: bands of rows are encoded in parallel and written in order, with few in memory.

use crate::{Control, ImageError, RowSource, Size};
use rayon::prelude::*;
use std::ops::Range;

/// Division of a picture into bands of rows.
#[derive(Clone, Copy, Debug)]
pub(super) struct Bands {
    size: Size,
    rows: u32,
}

/// Target size of the rows of a band as filled by the source, bytes.
const BAND_BYTES: usize = 4 << 20;

/// Largest size of the bands being encoded at a time, bytes: bounds the memory of a writer for any number of threads.
const HELD_BYTES: usize = 64 << 20;

impl Bands {
    /// Bands of `rows` rows.
    pub(super) fn of_rows(size: Size, rows: u32) -> Self {
        Self {
            size,
            rows: rows.max(1),
        }
    }

    /// Bands of about [`BAND_BYTES`], a multiple of `multiple` rows each, for rows of `channels` floats.
    pub(super) fn for_channels(size: Size, channels: usize, multiple: u32) -> Self {
        let row_bytes = size.width() as usize * channels * 4;
        let rows = (BAND_BYTES / row_bytes.max(1)).clamp(1, 256) as u32;
        Self::of_rows(size, rows.div_ceil(multiple) * multiple)
    }

    pub(super) fn count(self) -> u32 {
        self.size.height().div_ceil(self.rows)
    }

    pub(super) fn rows(self, band: u32) -> Range<u32> {
        let start = band * self.rows;
        start..(start + self.rows).min(self.size.height())
    }

    /// Encodes all bands with `encode` in parallel and passes the results in order to `write`, which runs while the next bands are
    /// encoded. `band_bytes` is the approximate memory for encoding one band; encoded bands are assumed to be much smaller.
    pub(super) fn run<T: Send>(
        self,
        band_bytes: usize,
        control: Control<'_>,
        encode: impl Fn(u32) -> Result<T, ImageError> + Sync,
        mut write: impl FnMut(u32, T) -> Result<(), ImageError> + Send,
    ) -> Result<(), ImageError> {
        let threads = rayon::current_num_threads();
        let batch = (HELD_BYTES / band_bytes.max(1)).clamp(1, threads * 4) as u32;
        let height = u64::from(self.size.height());
        let mut encoded: Vec<T> = Vec::new();
        let mut first = 0;
        let mut next = 0;
        loop {
            let ahead = next..(next + batch).min(self.count());
            let (coming, written) = rayon::join(
                || {
                    ahead
                        .clone()
                        .into_par_iter()
                        .with_max_len(1)
                        .map(|band| {
                            control.check()?;
                            encode(band)
                        })
                        .collect::<Result<Vec<T>, ImageError>>()
                },
                || {
                    for (band, item) in (first..).zip(encoded.drain(..)) {
                        control.check()?;
                        write(band, item)?;
                        control.report(u64::from(self.rows(band).end), height);
                    }
                    Ok::<(), ImageError>(())
                },
            );
            written?;
            encoded = coming?;
            if encoded.is_empty() {
                return Ok(());
            }
            first = ahead.start;
            next = ahead.end;
        }
    }
}

/// Rows of a source, one at a time, in a reused buffer.
pub(super) struct RowBuffer<'a> {
    source: &'a dyn RowSource,
    row: Vec<f32>,
}

impl<'a> RowBuffer<'a> {
    pub(super) fn new(source: &'a dyn RowSource, size: Size) -> Self {
        Self {
            source,
            row: vec![0.0; size.width() as usize * source.channels()],
        }
    }

    pub(super) fn row(&mut self, y: u32) -> &[f32] {
        self.source.fill_row(y, &mut self.row);
        &self.row
    }
}
