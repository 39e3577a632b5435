//! Writes a gradient of a sky as linear EXR and as displayed PNG: `cargo run -p airlight-image --example picture -- OUT_WITHOUT_ENDING`.

use airlight_image::output::PictureOptions;
use airlight_image::rows::RowFn;
use airlight_image::tone::{ToneCurve, ToneMapper};
use airlight_image::{Control, Frame, write_picture};
use std::path::Path;

fn main() -> Result<(), Box<dyn std::error::Error>> {
    let name = std::env::args()
        .nth(1)
        .ok_or("expected OUT_WITHOUT_ENDING, got nothing")?;
    let frame = Frame::equirectangular(256)?;
    // Radiance by elevation, computed row by row as the writers ask for it.
    let rows = RowFn::new(3, |y, out| {
        for (x, pixel) in out.chunks_exact_mut(3).enumerate() {
            let up = frame
                .pixel_direction(x as u32, y)
                .map_or(0.0, |d| d.y.max(0.0)) as f32;
            pixel.copy_from_slice(&[0.5 - 0.4 * up, 0.6 - 0.3 * up, 0.8 - 0.1 * up]);
        }
    });
    let tone = ToneMapper::new(1.0, ToneCurve::default())?;
    for ending in ["exr", "png"] {
        let path = Path::new(&name).with_extension(ending);
        let options = PictureOptions::default();
        write_picture(
            &path,
            frame.size(),
            &rows,
            &tone,
            &options,
            Control::default(),
        )?;
        println!("{}", path.display());
    }
    Ok(())
}
