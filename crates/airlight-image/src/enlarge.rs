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

#[cfg(test)]
mod tests {
    use super::*;

    fn picture(width: u32, height: u32, of: impl Fn(f64, f64, usize) -> f64) -> StoredRows {
        let mut samples = Vec::new();
        for j in 0..height {
            for i in 0..width {
                let (x, y) = (
                    (f64::from(i) + 0.5) / f64::from(width),
                    (f64::from(j) + 0.5) / f64::from(height),
                );
                samples.extend((0..3).map(|channel| of(x, y, channel) as f32));
            }
        }
        StoredRows::new(width, 3, samples).unwrap()
    }

    fn enlarged(picture: &StoredRows, width: u32, height: u32) -> Vec<f32> {
        let all = Enlarged::new(picture, Size::new(width, height).unwrap()).unwrap();
        let mut out = vec![f32::NAN; (width * height * 3) as usize];
        for (y, row) in out.chunks_exact_mut(width as usize * 3).enumerate() {
            all.fill_row(y as u32, row);
        }
        out
    }

    /// Also at the edges.
    #[test]
    fn parabolas_are_exact_at_any_size() {
        let of = |x: f64, y: f64, channel: usize| match channel {
            0 => 1.0 + x - 2.0 * x * x,
            1 => 3.0 + y * y * 4.0,
            _ => 5.0 - x * y + x * x * y * y,
        };
        for (from, to) in [
            ((8, 5), (64, 35)),
            ((3, 3), (100, 7)),
            ((9, 4), (9, 4)),
            ((16, 16), (5, 3)),
        ] {
            let got = enlarged(&picture(from.0, from.1, of), to.0, to.1);
            let want = picture(to.0, to.1, of);
            for (a, b) in got.iter().zip(want.samples()) {
                assert!((a - b).abs() < 3e-5, "{from:?} {to:?}: {a} {b}");
            }
        }
    }

    #[test]
    fn the_spline_passes_through_every_pixel() {
        let rough = |x: f64, y: f64, channel: usize| {
            (40.0 * x + channel as f64).sin() + (31.0 * y * y).cos()
        };
        let small = picture(11, 7, rough);
        // Enlarged three times, every third pixel from the second has the centre of an original one.
        let large = enlarged(&small, 33, 21);
        for j in 0..7 {
            for i in 0..11 {
                for channel in 0..3 {
                    let a = small.samples()[(j * 11 + i) * 3 + channel];
                    let b = large[((3 * j + 1) * 33 + 3 * i + 1) * 3 + channel];
                    assert!((a - b).abs() < 1e-6, "{i} {j}: {a} {b}");
                }
            }
        }
    }

    /// The error of cubic splines falls with the fourth power of the pixel size.
    #[test]
    fn the_error_falls_with_the_fourth_power() {
        let smooth = |x: f64, y: f64, _: usize| (9.0 * x + 1.0).sin() + (8.0 * y).cos();
        let want = picture(240, 240, smooth);
        let worst = |size: u32| {
            let got = enlarged(&picture(size, size, smooth), 240, 240);
            // Away from the edges, where the parabola has an order less.
            let inside = (60..180).flat_map(|j| (60..180).map(move |i| (j * 240 + i) * 3));
            inside
                .map(|at| (got[at] - want.samples()[at]).abs())
                .fold(0.0, f32::max)
        };
        let ratio = worst(20) / worst(40);
        assert!((12.0..20.0).contains(&ratio), "{ratio}");
    }

    #[test]
    fn short_lines_stay_straight() {
        let one = enlarged(&picture(1, 1, |_, _, channel| channel as f64), 4, 3);
        assert!(one.chunks(3).all(|rgb| rgb == [0.0, 1.0, 2.0]));
        let two = enlarged(&picture(2, 1, |x, _, _| x), 8, 1);
        for (i, rgb) in two.chunks(3).enumerate() {
            assert!((rgb[0] - (i as f32 + 0.5) / 8.0).abs() < 1e-6);
        }
        let none = StoredRows::new(2, 1, vec![1.0, f32::NAN]).unwrap();
        assert!(Enlarged::new(&none, Size::new(4, 4).unwrap()).is_err());
    }
}
