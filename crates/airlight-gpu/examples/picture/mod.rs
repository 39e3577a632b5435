//! Frames as picture files.

use airlight_image::tone::{ToneCurve, ToneMapper};
use airlight_image::{Control, PictureOptions, Size, rows::StoredRows, write_picture};
use std::{error::Error, path::Path};

/// Writes the pixels of a square frame, times an exposure.
pub fn write(output: &str, pixels: &[[f32; 3]], exposure: f32) -> Result<(), Box<dyn Error>> {
    let side = pixels.len().isqrt() as u32;
    let rows = StoredRows::new(side, 3, pixels.as_flattened().to_vec())?;
    let tone = ToneMapper::new(exposure, ToneCurve::default())?;
    write_picture(
        Path::new(output),
        Size::new(side, side)?,
        &rows,
        &tone,
        &PictureOptions::default(),
        Control::default(),
    )?;
    Ok(())
}
