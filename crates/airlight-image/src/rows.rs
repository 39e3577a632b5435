//! Where pixels come from.

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
