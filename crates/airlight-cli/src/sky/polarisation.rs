//! The polarisation of a picture's light, in a file beside it.

use super::layout::tagged;
use crate::error::CliError;
use crate::interrupt::STOP;
use airlight::monte_carlo::PolarisedSample;
use airlight_image::output::Metadata;
use airlight_image::output::exr::{self, ExrOptions, ExrSample};
use airlight_image::rows::StoredRows;
use airlight_image::{Control, Size};
use std::path::Path;

/// Channels of the file.
const CHANNELS: [&str; 4] = ["degree", "angle_deg", "Q_over_I", "U_over_I"];

/// Stokes parameters `I`, `Q`, `U` of a pixel, weighed as the eye weighs luminance; summed over its paths.
#[derive(Clone, Copy, Debug, Default)]
pub struct PixelStokes([f64; 3]);

impl PixelStokes {
    /// Adds a bundle of paths; `weights` are those of the wavelengths in luminance.
    pub fn add(&mut self, sample: &PolarisedSample, weights: impl Iterator<Item = f64>) {
        for (lane, weight) in weights.enumerate() {
            for (sum, part) in self.0.iter_mut().zip(&sample.stokes) {
                *sum += weight * part[lane];
            }
        }
    }

    /// What the channels hold: degree and angle of linear polarisation, and `Q` and `U` over `I`; zeros of darkness.
    fn channels(&self) -> [f32; 4] {
        let [i, q, u] = self.0;
        if i <= 0.0 {
            return [0.0; 4];
        }
        let angle = (0.5 * u.atan2(q)).to_degrees().rem_euclid(180.0);
        [q.hypot(u) / i, angle.rem_euclid(180.0), q / i, u / i].map(|v| v as f32)
    }
}

/// Writes it beside a picture.
///
/// # Errors
/// [`CliError`] where it cannot be written.
pub fn write(path: &Path, size: Size, pixels: &[PixelStokes]) -> Result<(), CliError> {
    let samples = pixels.iter().flat_map(PixelStokes::channels).collect();
    let rows = StoredRows::new(size.width(), CHANNELS.len(), samples)?;
    let options = ExrOptions {
        sample: ExrSample::Float,
        ..ExrOptions::default()
    };
    let control = Control::cancelled_by(&STOP);
    let path = tagged(path, "polarisation").with_extension("exr");
    exr::write(
        &path,
        size,
        &CHANNELS,
        &rows,
        &options,
        &Metadata::default(),
        control,
    )?;
    Ok(())
}
