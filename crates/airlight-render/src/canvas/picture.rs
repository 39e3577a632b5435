//! [`Canvas`]: sums over bundles of paths for all pixels of a picture.

use super::{ColorMoments, Pass, pixel_offset};
use crate::channels::PixelChannels;
use crate::error::RenderError;
use airlight::scene::RadianceSampler;
use airlight_image::rows::StoredRows;
use airlight_image::{Control, Frame, ImageError, Size};
use rayon::prelude::*;
use std::sync::atomic::{AtomicU64, Ordering};

/// Channels of a polarisation map: degree and angle of linear polarisation, `Q / I` and `U / I`.
pub const POLARISATION_CHANNELS: [&str; 4] = ["degree", "angle_deg", "Q_over_I", "U_over_I"];

/// Largest memory of all canvases of a picture, bytes.
const MOST_BYTES: f64 = 8e9;

/// A Monte Carlo picture in progress: sums over bundles of paths.
#[derive(Clone, Debug)]
pub struct Canvas {
    size: Size,
    /// Row of a frame that is the first of the canvas.
    first_row: u32,
    channels: PixelChannels,
    /// Sums in the channels of a view.
    sums: Vec<f64>,
    colors: Vec<ColorMoments>,
    /// Stokes parameters I, Q and U weighted as luminance; empty without polarisation.
    stokes: Vec<[f64; 3]>,
    bundles: u64,
}

impl Canvas {
    /// An empty canvas, with or without polarisation.
    pub fn new(size: Size, channels: &PixelChannels, polarised: bool) -> Self {
        let pixels = size.width() as usize * size.height() as usize;
        Self {
            size,
            first_row: 0,
            channels: channels.clone(),
            sums: vec![0.0; pixels * channels.view_count()],
            colors: vec![ColorMoments::default(); pixels],
            stokes: vec![[0.0; 3]; if polarised { pixels } else { 0 }],
            bundles: 0,
        }
    }

    /// The same for a band of the rows of a frame, which begins with a row.
    pub fn from_row(self, first_row: u32) -> Self {
        Self { first_row, ..self }
    }

    /// Refuses pictures that are too large to be kept in memory.
    ///
    /// # Errors
    /// [`RenderError::Setting`] above 8 GB.
    pub fn check_memory(
        sizes: impl Iterator<Item = Size>,
        channels: &PixelChannels,
    ) -> Result<(), RenderError> {
        let pixels: f64 = sizes
            .map(|size| f64::from(size.width()) * f64::from(size.height()))
            .sum();
        let bytes = size_of::<ColorMoments>() + channels.view_count() * size_of::<f64>();
        match pixels * bytes as f64 {
            need if need <= MOST_BYTES => Ok(()),
            need => Err(RenderError::setting(format!(
                "Monte Carlo pictures are kept in memory while they are drawn: expected at most {:.0} GB, got {:.0} GB; try a \
                 smaller size",
                1e-9 * MOST_BYTES,
                1e-9 * need
            ))),
        }
    }

    /// Traces the paths of a pass for every pixel of the canvas in a frame; each bundle starts at another point of the pixel.
    ///
    /// # Errors
    /// [`ImageError::Cancelled`] if the caller cancelled.
    pub fn add(
        &mut self,
        frame: &Frame,
        sampler: &dyn RadianceSampler,
        pass: &Pass,
        control: Control<'_>,
    ) -> Result<(), ImageError> {
        let first_row = self.first_row;
        self.add_with(pass, control, |x, y, bundle, found, stokes| {
            let [u, v] = pixel_offset(bundle);
            let y = first_row + y;
            match (frame.direction(f64::from(x) + u, f64::from(y) + v), stokes) {
                (Some(direction), Some(stokes)) => {
                    sampler.add_polarised_bundle(direction, bundle, found, stokes);
                }
                (Some(direction), None) => sampler.add_bundle(direction, bundle, found),
                (None, _) => {}
            }
        })
    }

    /// Adds the bundles of a pass, which begin where the last pass ended, to every pixel. `sample` takes column, row and bundle,
    /// and adds to the radiance (initially zero, in the channels of a view) and, with polarisation, to the Stokes parameters.
    ///
    /// # Errors
    /// [`ImageError::Cancelled`] if the caller cancelled.
    pub fn add_with(
        &mut self,
        pass: &Pass,
        control: Control<'_>,
        sample: impl Fn(u32, u32, u64, &mut [f64], Option<&mut [f64; 3]>) + Sync,
    ) -> Result<(), ImageError> {
        let channels = &self.channels;
        let (width, count) = (self.size.width() as usize, channels.view_count());
        let height = self.size.height();
        // One row each, empty without polarisation.
        let mut stokes: Vec<&mut [[f64; 3]]> = self.stokes.chunks_mut(width).collect();
        stokes.resize_with(height as usize, Default::default);
        let done = AtomicU64::new(0);
        self.sums
            .par_chunks_mut(width * count)
            .zip(self.colors.par_chunks_mut(width))
            .zip(stokes)
            .enumerate()
            .try_for_each(|(y, ((sums, colors), stokes))| {
                let mut found = vec![0.0; count];
                for (x, (sums, color)) in sums.chunks_mut(count).zip(colors).enumerate() {
                    for bundle in pass.bundles.clone() {
                        control.check()?;
                        found.fill(0.0);
                        sample(x as u32, y as u32, bundle, &mut found, stokes.get_mut(x));
                        sums.iter_mut().zip(&found).for_each(|(sum, v)| *sum += v);
                        color.add(channels.to_rgb(&found));
                    }
                }
                let done = done.fetch_add(1, Ordering::Relaxed) + 1;
                control.report(done, u64::from(height));
                Ok::<(), ImageError>(())
            })?;
        self.bundles = pass.bundles.end;
        Ok(())
    }

    /// Mean and standard error of red, green and blue of each pixel, row by row.
    pub fn moments(&self) -> impl Iterator<Item = [(f64, f64); 3]> + '_ {
        let of = |color: &ColorMoments| [0, 1, 2].map(|lane| color.moments(lane, self.bundles));
        self.colors.iter().map(of)
    }

    /// Mean over all bundles so far, in the channels of a view.
    pub fn means(&self) -> Vec<f32> {
        let count = self.bundles.max(1) as f64;
        self.sums.iter().map(|sum| (sum / count) as f32).collect()
    }

    /// Standard errors of red, green and blue, multiplied by `scale`.
    ///
    /// # Errors
    /// [`ImageError::Setting`], which does not occur for a frame of a size above 0.
    pub fn noise(&self, scale: f32) -> Result<StoredRows, ImageError> {
        let errors = |moments: [(f64, f64); 3]| moments.map(|(_, error)| scale * error as f32);
        let samples = self.moments().flat_map(errors).collect();
        StoredRows::new(self.size.width(), 3, samples)
    }

    /// Values of [`POLARISATION_CHANNELS`]; `None` without polarisation.
    pub fn polarisation(&self) -> Option<Result<StoredRows, ImageError>> {
        if self.stokes.is_empty() {
            return None;
        }
        let samples = self.stokes.iter().flat_map(polarisation).collect();
        let channels = POLARISATION_CHANNELS.len();
        Some(StoredRows::new(self.size.width(), channels, samples))
    }

    /// Sum of the squared relative standard errors of green, and the number of pixels that are not black.
    pub fn relative_errors(&self) -> (f64, u64) {
        let errors = self
            .moments()
            .filter(|[_, (mean, _), _]| *mean > 0.0)
            .map(|[_, (mean, error), _]| (error / mean).powi(2));
        errors.fold((0.0, 0), |(sum, count), error| (sum + error, count + 1))
    }
}

/// Degree and angle of linear polarisation, `Q / I` and `U / I`; 0 for black pixels.
pub fn polarisation(&[i, q, u]: &[f64; 3]) -> [f32; 4] {
    if i <= 0.0 {
        return [0.0; 4];
    }
    let angle = (0.5 * u.atan2(q)).to_degrees().rem_euclid(180.0);
    [q.hypot(u) / i, angle.rem_euclid(180.0), q / i, u / i].map(|v| v as f32)
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::test_view::TestSampler;
    use airlight::spectrum::RgbSpace;
    use std::ops::Range;
    use std::sync::atomic::AtomicBool;

    fn canvas(passes: &[u64], polarised: bool) -> Canvas {
        let frame = Frame::equirectangular(4).unwrap();
        let channels = PixelChannels::rgb(RgbSpace::Srgb);
        let mut canvas = Canvas::new(frame.size(), &channels, polarised);
        let mut done = 0;
        for &until in passes {
            let control = Control::default();
            let pass = pass(done..until);
            canvas.add(&frame, &TestSampler, &pass, control).unwrap();
            done = until;
        }
        canvas
    }

    fn pass(bundles: Range<u64>) -> Pass {
        Pass { bundles, goal: 8 }
    }

    #[test]
    fn passes_equal_a_single_pass() {
        assert_eq!(
            canvas(&[2, 4, 8], false).means(),
            canvas(&[8], false).means()
        );
    }

    #[test]
    fn noise_is_the_standard_error_over_bundles() {
        // Bundles alternate between 0 and 2: a mean of 1 and a standard deviation of sqrt(8 / 7).
        let canvas = canvas(&[8], false);
        assert!(canvas.means().iter().all(|v| *v == 1.0));
        let noise = canvas.noise(10.0).unwrap();
        let want = 10.0 * (8.0f32 / 7.0 / 8.0).sqrt();
        assert!(
            noise
                .samples()
                .iter()
                .all(|v| (v / want - 1.0).abs() < 1e-6)
        );
        let (sum, count) = canvas.relative_errors();
        assert_eq!(count, 32);
        assert!((sum / 32.0 - 1.0 / 7.0).abs() < 1e-12);
    }

    #[test]
    fn degree_and_angle_follow_from_the_stokes_parameters() {
        assert!(canvas(&[2], false).polarisation().is_none());
        let map = canvas(&[4], true).polarisation().unwrap().unwrap();
        assert_eq!(map.samples()[..4], [0.5, 90.0, -0.5, 0.0]);
        assert_eq!(polarisation(&[2.0, 1.0, 0.0]), [0.5, 0.0, 0.5, 0.0]);
        assert_eq!(polarisation(&[2.0, 0.0, 1.0]), [0.5, 45.0, 0.0, 0.5]);
        assert_eq!(polarisation(&[2.0, 0.0, -1.0]), [0.5, 135.0, 0.0, -0.5]);
        assert_eq!(polarisation(&[0.0, 0.0, 0.0]), [0.0; 4]);
    }

    #[test]
    fn canvases_can_be_cancelled_and_are_limited_in_size() {
        let stop = AtomicBool::new(true);
        let frame = Frame::equirectangular(4).unwrap();
        let channels = PixelChannels::rgb(RgbSpace::Srgb);
        let mut canvas = Canvas::new(frame.size(), &channels, false);
        let control = Control::cancelled_by(&stop);
        let stopped = canvas.add(&frame, &TestSampler, &pass(0..2), control);
        assert!(stopped.unwrap_err().is_cancelled());
        let large = Frame::equirectangular(32768).unwrap();
        let refused = Canvas::check_memory([large.size()].into_iter(), &channels).unwrap_err();
        assert!(refused.to_string().contains("try a smaller size"));
        assert!(Canvas::check_memory([frame.size(); 6].into_iter(), &channels).is_ok());
    }
}
