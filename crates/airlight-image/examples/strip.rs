//! Puts pictures side by side: `cargo run --release -p airlight-image --example strip -- OUT.png ROWS IN.png ...` keeps the
//! upper ROWS rows of each (0: all). 16-bit pictures are rounded to 8 bits without dither, for small files.

use image::{ImageReader, RgbImage, imageops};
use std::error::Error;

/// Pixels between two pictures.
const GAP: u32 = 2;

fn main() -> Result<(), Box<dyn Error>> {
    let arguments: Vec<String> = std::env::args().skip(1).collect();
    let [out, rows, inputs @ ..] = arguments.as_slice() else {
        return Err("expected the arguments OUT.png ROWS IN.png ...".into());
    };
    let rows: u32 = rows.parse()?;
    let pictures = inputs
        .iter()
        .map(|path| read(path, rows))
        .collect::<Result<Vec<_>, _>>()?;
    let height = pictures.iter().map(RgbImage::height).max().unwrap_or(1);
    let width: u32 = pictures.iter().map(|picture| picture.width() + GAP).sum();
    let mut strip = RgbImage::from_pixel(width.max(GAP + 1) - GAP, height, image::Rgb([255; 3]));
    let mut x = 0;
    for picture in &pictures {
        imageops::replace(&mut strip, picture, i64::from(x), 0);
        x += picture.width() + GAP;
    }
    strip.save(out)?;
    Ok(())
}

fn read(path: &str, rows: u32) -> Result<RgbImage, Box<dyn Error>> {
    let wide = ImageReader::open(path)?.decode()?.into_rgb16();
    let height = match rows {
        0 => wide.height(),
        rows => rows.min(wide.height()),
    };
    let eight = |v: u16| ((u32::from(v) * 255 + 32_767) / 65_535) as u8;
    Ok(RgbImage::from_fn(wide.width(), height, |x, y| {
        image::Rgb(wide.get_pixel(x, y).0.map(eight))
    }))
}
