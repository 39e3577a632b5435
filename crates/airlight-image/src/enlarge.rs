//! Upsampling by interpolating cubic B-splines.
//!
//! For smooth backgrounds that are expensive to compute, such as skies: Klassen, "Modeling the Effect of the Atmosphere on
//! Light", ACM Transactions on Graphics 6(3), 1987, section 8, renders them small and enlarges them with splines. The spline passes
//! through the centre of every pixel of the small picture; its slope and curvature are continuous. Along a line of samples
//! `s_i` its coefficients `c_i` solve
//!
//! ```text
//! (c_(i-1) + 4 c_i + c_(i+1)) / 6 = s_i
//! ```
//!
//! first along the rows of a picture, then along its columns. At either end the outermost segment and its continuation beyond the
//! centre of the last pixel are a parabola: with `c_(-1) = 3 c_0 - 3 c_1 + c_2` the first two equations give
//! `c_0 - c_1 = s_0 - s_1`. Parabolas are therefore reproduced exactly up to the edges. (The common reflection at the edge would
//! force a zero slope there, and the horizon is an edge.)

use crate::{ImageError, RowSource, Size, rows::StoredRows};

/// Coefficients beyond either end of a line, for positions up to half a pixel beyond the last centre.
const PADDING: usize = 2;

/// A stored picture resampled to another size.
///
/// At discontinuities the spline overshoots by about an eighth of the step, possibly below 0; skies without the sun's disc have
/// none. The book's chapter on the sky of 1987 states the errors of enlarged skies.
#[derive(Clone, Debug)]
pub struct Enlarged {
    channels: usize,
    /// Number of coefficients of a row.
    stride: usize,
    coefficients: Vec<f64>,
    columns: Vec<Taps>,
    rows: Vec<Taps>,
}

/// Index of the first of four coefficients, and their weights.
#[derive(Clone, Copy, Debug)]
struct Taps {
    first: usize,
    weights: [f64; 4],
}

impl Enlarged {
    /// Fits the spline through the pixels of `picture`, to be sampled at the size `to`, which may also be smaller.
    ///
    /// # Errors
    /// [`ImageError::Setting`] where a sample is not finite.
    pub fn new(picture: &StoredRows, to: Size) -> Result<Self, ImageError> {
        if let Some(bad) = picture.samples().iter().find(|v| !v.is_finite()) {
            return Err(ImageError::Setting {
                what: "each sample of an enlarged picture",
                got: bad.to_string(),
                right: "a finite number",
            });
        }
        let channels = picture.channels();
        let height = picture.height() as usize;
        let width = picture.samples().len() / (height * channels);
        let (padded_width, padded_height) = (width + 2 * PADDING, height + 2 * PADDING);
        let stride = padded_width * channels;
        let mut coefficients = vec![0.0; padded_height * stride];
        for (row, samples) in picture.samples().chunks_exact(width * channels).enumerate() {
            let start = (row + PADDING) * stride;
            for channel in 0..channels {
                let line = samples.iter().skip(channel).step_by(channels);
                let line = spline(line.map(|&v| f64::from(v)).collect());
                for (i, c) in line.into_iter().enumerate() {
                    coefficients[start + i * channels + channel] = c;
                }
            }
        }
        for column in 0..stride {
            let line = (0..height).map(|row| coefficients[(row + PADDING) * stride + column]);
            for (row, c) in spline(line.collect()).into_iter().enumerate() {
                coefficients[row * stride + column] = c;
            }
        }
        Ok(Self {
            channels,
            stride,
            coefficients,
            columns: taps(width, to.width()),
            rows: taps(height, to.height()),
        })
    }
}

impl RowSource for Enlarged {
    fn channels(&self) -> usize {
        self.channels
    }

    /// Leaves `out` unchanged below the last row.
    fn fill_row(&self, y: u32, out: &mut [f32]) {
        let Some(row) = self.rows.get(y as usize) else {
            return;
        };
        let mut line = vec![0.0; self.stride];
        for (i, weight) in row.weights.iter().enumerate() {
            let values = &self.coefficients[(row.first + i) * self.stride..][..self.stride];
            for (sum, value) in line.iter_mut().zip(values) {
                *sum += weight * value;
            }
        }
        for (pixel, column) in out.chunks_exact_mut(self.channels).zip(&self.columns) {
            let cells = &line[column.first * self.channels..];
            for (channel, value) in pixel.iter_mut().enumerate() {
                let term = |(i, weight)| weight * cells[i * self.channels + channel];
                *value = column.weights.iter().enumerate().map(term).sum::<f64>() as f32;
            }
        }
    }
}

/// Coefficients of the spline through samples, with [`PADDING`] more at either end. Two samples give a straight line, one a
/// constant.
fn spline(samples: Vec<f64>) -> Vec<f64> {
    let n = samples.len();
    let mut c = vec![0.0; n + 2 * PADDING];
    let inner = &mut c[PADDING..PADDING + n];
    inner.copy_from_slice(&samples);
    if n > 2 {
        // c_0 = c_1 + (s_0 - s_1), so equation 1 is 5 c_1 + c_2 = 6 s_1 - (s_0 - s_1); the other end is symmetric.
        let (first, last) = (samples[0] - samples[1], samples[n - 1] - samples[n - 2]);
        for (i, value) in inner.iter_mut().enumerate().take(n - 1).skip(1) {
            *value = 6.0 * samples[i];
        }
        inner[1] -= first;
        inner[n - 2] -= last;
        let mut diagonal = vec![4.0; n];
        diagonal[1] += 1.0;
        diagonal[n - 2] += 1.0;
        for i in 2..n - 1 {
            diagonal[i] -= 1.0 / diagonal[i - 1];
            inner[i] -= inner[i - 1] / diagonal[i - 1];
        }
        inner[n - 2] /= diagonal[n - 2];
        for i in (1..n - 2).rev() {
            inner[i] = (inner[i] - inner[i + 1]) / diagonal[i];
        }
        inner[0] = inner[1] + first;
        inner[n - 1] = inner[n - 2] + last;
    }
    for k in (0..PADDING).rev() {
        c[k] = extrapolate(n, c[k + 1], c[k + 2], c[k + 3]);
        let m = n + 2 * PADDING - 1 - k;
        c[m] = extrapolate(n, c[m - 1], c[m - 2], c[m - 3]);
    }
    c
}

/// Extrapolates three coefficients (fewer for short lines) by one.
fn extrapolate(samples: usize, a: f64, b: f64, c: f64) -> f64 {
    match samples {
        1 => a,
        2 => 2.0 * a - b,
        _ => 3.0 * a - 3.0 * b + c,
    }
}

/// Taps of the centres of `to` pixels on `from` padded coefficients.
fn taps(from: usize, to: u32) -> Vec<Taps> {
    let step = from as f64 / f64::from(to);
    let taps = |i: u32| {
        let x = (f64::from(i) + 0.5) * step - 0.5 + PADDING as f64;
        let below = (x.floor() as usize).clamp(1, from + 2 * PADDING - 3);
        let t = x - below as f64;
        let u = 1.0 - t;
        let weights = [
            u * u * u / 6.0,
            (4.0 - 6.0 * t * t + 3.0 * t * t * t) / 6.0,
            (4.0 - 6.0 * u * u + 3.0 * u * u * u) / 6.0,
            t * t * t / 6.0,
        ];
        Taps {
            first: below - 1,
            weights,
        }
    };
    (0..to).map(taps).collect()
}
