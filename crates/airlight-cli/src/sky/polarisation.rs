//! The polarisation of a picture's light, in a file beside it.

use crate::error::CliError;
use crate::interrupt::STOP;
use airlight_image::output::Metadata;
use airlight_image::output::exr::{self, ExrOptions, ExrSample};
use airlight_image::rows::StoredRows;
use airlight_image::{Control, Size};
use airlight_render::canvas::{POLARIZATION_CHANNELS, PixelStokes};
use airlight_render::pixels::tagged_path;
use std::path::Path;

/// Writes it beside a picture.
///
/// # Errors
/// [`CliError`] where it cannot be written.
pub fn write(path: &Path, size: Size, pixels: &[PixelStokes]) -> Result<(), CliError> {
    let samples = pixels.iter().flat_map(PixelStokes::channels).collect();
    let rows = StoredRows::new(size.width(), POLARIZATION_CHANNELS.len(), samples)?;
    let options = ExrOptions {
        sample: ExrSample::Float,
        ..ExrOptions::default()
    };
    let control = Control::cancelled_by(&STOP);
    let path = tagged_path(path, "polarisation").with_extension("exr");
    exr::write(
        &path,
        size,
        &POLARIZATION_CHANNELS,
        &rows,
        &options,
        &Metadata::default(),
        control,
    )?;
    Ok(())
}
