//! Sums over the bundles of paths of all pixels of a picture.

use super::{ColorMoments, pixel_offset};
use crate::channels::PixelChannels;
use crate::error::RenderError;
use airlight::scene::RadianceSampler;
use airlight_image::rows::StoredRows;
use airlight_image::{Control, Frame, ImageError, Size};
use rayon::prelude::*;
use std::ops::Range;
use std::sync::atomic::{AtomicU64, Ordering};

/// Channels of a polarisation map: degree and angle of linear polarisation, and `Q` and `U` over `I`.
pub const POLARISATION_CHANNELS: [&str; 4] = ["degree", "angle_deg", "Q_over_I", "U_over_I"];

/// Most memory that the canvases of a picture may take, bytes.
const MOST_BYTES: f64 = 8e9;

/// A picture by Monte Carlo as far as it is known: sums over bundles of paths.
#[derive(Clone, Debug)]
pub struct Canvas {
    frame: Frame,
    channels: PixelChannels,
    /// In the channels of a view.
    sums: Vec<f64>,
    colors: Vec<ColorMoments>,
    /// Stokes parameters I, Q and U weighted as luminance; empty where polarisation is not followed.
    stokes: Vec<[f64; 3]>,
    bundles: u64,
}

impl Canvas {
    /// An empty canvas; `polarised` where the polarisation of light is followed.
    pub fn new(frame: Frame, channels: &PixelChannels, polarised: bool) -> Self {
        let pixels = frame.size().width() as usize * frame.size().height() as usize;
        Self {
            frame,
            channels: channels.clone(),
            sums: vec![0.0; pixels * channels.view_count()],
            colors: vec![ColorMoments::default(); pixels],
            stokes: vec![[0.0; 3]; if polarised { pixels } else { 0 }],
            bundles: 0,
        }
    }

    /// Refuses pictures too large to be kept in memory while they are drawn.
    ///
    /// # Errors
    /// [`RenderError::Setting`] above 8 GB.
    pub fn check_memory<'f>(
        frames: impl Iterator<Item = &'f Frame>,
        channels: &PixelChannels,
    ) -> Result<(), RenderError> {
        let pixels: f64 = frames
            .map(|frame| f64::from(frame.size().width()) * f64::from(frame.size().height()))
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

    /// Where its pixels look.
    pub fn frame(&self) -> &Frame {
        &self.frame
    }

    /// Follows the paths of a range of bundles through every pixel; the range begins where the last one ended.
    ///
    /// # Errors
    /// [`ImageError::Cancelled`] where the caller asked to stop.
    pub fn add(
        &mut self,
        sampler: &dyn RadianceSampler,
        bundles: Range<u64>,
        control: Control<'_>,
    ) -> Result<(), ImageError> {
        let (frame, channels) = (self.frame, &self.channels);
        let (width, count) = (frame.size().width() as usize, channels.view_count());
        let height = frame.size().height();
        // One row each, empty where polarisation is not followed.
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
                    control.check()?;
                    for bundle in bundles.clone() {
                        let [u, v] = pixel_offset(bundle);
                        let Some(direction) = frame.direction(x as f64 + u, y as f64 + v) else {
                            continue;
                        };
                        found.fill(0.0);
                        match stokes.get_mut(x) {
                            Some(stokes) => {
                                sampler.add_polarised_bundle(direction, bundle, &mut found, stokes);
                            }
                            None => sampler.add_bundle(direction, bundle, &mut found),
                        }
                        sums.iter_mut().zip(&found).for_each(|(sum, v)| *sum += v);
                        color.add(channels.to_rgb(&found));
                    }
                }
                let done = done.fetch_add(1, Ordering::Relaxed) + 1;
                control.report(done, u64::from(height));
                Ok::<(), ImageError>(())
            })?;
        self.bundles = bundles.end;
        Ok::<(), ImageError>(())
    }

    /// The picture so far, in the channels of a view.
    pub fn means(&self) -> Vec<f32> {
        let count = self.bundles.max(1) as f64;
        self.sums.iter().map(|sum| (sum / count) as f32).collect()
    }

    /// Standard errors of red, green and blue, `scale` times.
    ///
    /// # Errors
    /// [`ImageError::Setting`]: never for a frame of a size above 0.
    pub fn noise(&self, scale: f32) -> Result<StoredRows, ImageError> {
        let error = |color: &ColorMoments, component| {
            scale * color.moments(component, self.bundles).1 as f32
        };
        let samples = self
            .colors
            .iter()
            .flat_map(|color| [0, 1, 2].map(|component| error(color, component)))
            .collect();
        StoredRows::new(self.size().width(), 3, samples)
    }

    /// Values of [`POLARISATION_CHANNELS`]; `None` where polarisation is not followed.
    pub fn polarisation(&self) -> Option<Result<StoredRows, ImageError>> {
        if self.stokes.is_empty() {
            return None;
        }
        let samples = self.stokes.iter().flat_map(polarisation).collect();
        let channels = POLARISATION_CHANNELS.len();
        Some(StoredRows::new(self.size().width(), channels, samples))
    }

    /// Sum of the squared relative standard errors of green, and the number of pixels that are lit.
    pub fn relative_errors(&self) -> (f64, u64) {
        let errors = self.colors.iter().filter_map(|color| {
            let (mean, error) = color.moments(1, self.bundles);
            (mean > 0.0).then(|| (error / mean).powi(2))
        });
        errors.fold((0.0, 0), |(sum, count), error| (sum + error, count + 1))
    }

    fn size(&self) -> Size {
        self.frame.size()
    }
}

/// Degree and angle of linear polarisation, and `Q` and `U` over `I`; zeros where there is no light.
fn polarisation(&[i, q, u]: &[f64; 3]) -> [f32; 4] {
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
    use std::sync::atomic::AtomicBool;

    fn canvas(passes: &[u64], polarised: bool) -> Canvas {
        let frame = Frame::equirectangular(4).unwrap();
        let channels = PixelChannels::rgb(RgbSpace::Srgb);
        let mut canvas = Canvas::new(frame, &channels, polarised);
        let mut done = 0;
        for &until in passes {
            let control = Control::default();
            canvas.add(&TestSampler, done..until, control).unwrap();
            done = until;
        }
        canvas
    }

    #[test]
    fn passes_add_up_to_one() {
        assert_eq!(
            canvas(&[2, 4, 8], false).means(),
            canvas(&[8], false).means()
        );
    }

    #[test]
    fn the_noise_is_the_spread_of_the_bundles() {
        // Bundles of 0 and 2 by turns: a mean of 1 and a standard deviation of sqrt(8 / 7).
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
    fn a_canvas_stops_when_asked_and_is_not_larger_than_memory() {
        let stop = AtomicBool::new(true);
        let frame = Frame::equirectangular(4).unwrap();
        let channels = PixelChannels::rgb(RgbSpace::Srgb);
        let mut canvas = Canvas::new(frame, &channels, false);
        let stopped = canvas.add(&TestSampler, 0..2, Control::cancelled_by(&stop));
        assert!(stopped.unwrap_err().is_cancelled());
        let large = Frame::equirectangular(32768).unwrap();
        let refused = Canvas::check_memory([&large].into_iter(), &channels).unwrap_err();
        assert!(refused.to_string().contains("try a smaller size"));
        assert!(Canvas::check_memory([&frame; 6].into_iter(), &channels).is_ok());
    }
}
