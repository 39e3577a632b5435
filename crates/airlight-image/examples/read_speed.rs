//! Measures readers on a picture and a depth map of 10 megapixels: milliseconds per megapixel, best of five runs.
//!
//! `cargo run --release -p airlight-image --example read_speed`

use airlight::spectrum::rgb::srgb_decode;
use airlight_image::{
    Control, DepthOptions, Size,
    input::{DepthMeaning, read_depth, read_picture},
    output::{
        Metadata,
        exr::{self, ExrCompression, ExrOptions},
    },
    rows::StoredRows,
};
use png::{BitDepth, ColorType};
use std::{error::Error, io::Cursor, path::Path, time::Instant};

const WIDTH: u32 = 4000;
const HEIGHT: u32 = 2500;

fn main() -> Result<(), Box<dyn Error>> {
    let path = std::env::temp_dir().join(format!("airlight-read-speed-{}", std::process::id()));
    let measured = measure(&path);
    std::fs::remove_file(&path)?;
    measured
}

fn measure(path: &Path) -> Result<(), Box<dyn Error>> {
    let mut noise = Noise(3);
    let rgb: Vec<u8> = (0..WIDTH * HEIGHT)
        .flat_map(|i| [0, 1, 2].map(|_| shade(i) + noise.below(4)))
        .collect();
    let picture = || read_picture(path, None).map(drop);
    timed("writing 12 bytes per pixel", path, &[], || {
        let mut memory = Vec::with_capacity(rgb.len());
        memory.extend(rgb.iter().map(|&v| f32::from(v)));
        std::hint::black_box(&memory);
        Ok::<_, std::io::Error>(())
    })?;
    let wide: Vec<u8> = rgb.iter().flat_map(|&v| [v, v]).collect();
    for (bits, depth, data) in [(8, BitDepth::Eight, &rgb), (16, BitDepth::Sixteen, &wide)] {
        let file = png_file(ColorType::Rgb, depth, data)?;
        let decoder = || decode_png(path);
        timed(
            &format!("PNG {bits} bits, decoder alone"),
            path,
            &file,
            decoder,
        )?;
        timed(&format!("PNG {bits} bits"), path, &file, picture)?;
    }
    let mut jpeg = Vec::new();
    let encoder = jpeg_encoder::Encoder::new(&mut jpeg, 90);
    encoder.encode(
        &rgb,
        WIDTH as u16,
        HEIGHT as u16,
        jpeg_encoder::ColorType::Rgb,
    )?;
    timed("JPEG", path, &jpeg, picture)?;
    let linear = rgb
        .iter()
        .map(|&v| srgb_decode(f64::from(v) / 255.0) as f32);
    let rows = StoredRows::new(WIDTH, 3, linear.collect())?;
    for compression in [
        ExrCompression::Zip,
        ExrCompression::Piz,
        ExrCompression::None,
    ] {
        let options = ExrOptions {
            compression,
            ..ExrOptions::default()
        };
        let mut file = Cursor::new(Vec::new());
        exr::encode(
            &mut file,
            Size::new(WIDTH, HEIGHT)?,
            &["R", "G", "B"],
            &rows,
            &options,
            &Metadata::default(),
            Control::default(),
        )?;
        let name = format!("EXR half {compression:?}");
        timed(&name, path, file.get_ref(), picture)?;
    }

    let depths: Vec<u16> = (0..WIDTH * HEIGHT)
        .map(|i| match noise.below(20) {
            0 => 0,
            _ => 2000 + u16::from(shade(i)) * 10,
        })
        .collect();
    let millimetres = DepthOptions {
        scale: 0.001,
        ..DepthOptions::default()
    };
    let big_endian: Vec<u8> = depths.iter().flat_map(|v| v.to_be_bytes()).collect();
    let file = png_file(ColorType::Grayscale, BitDepth::Sixteen, &big_endian)?;
    timed("depth PNG, filled", path, &file, || {
        read_depth(path, &millimetres).map(drop)
    })?;
    let stereo = DepthOptions {
        meaning: DepthMeaning::Disparity {
            focal_length_px: 1000.0,
            baseline_m: 0.2,
            offset_px: 0.0,
        },
        ..millimetres.clone()
    };
    let mut pfm = format!("Pf\n{WIDTH} {HEIGHT}\n-1.0\n").into_bytes();
    pfm.extend(depths.iter().flat_map(|&v| f32::from(v).to_le_bytes()));
    timed("disparity PFM, filled", path, &pfm, || {
        read_depth(path, &stereo).map(drop)
    })?;
    Ok(())
}

/// Prints the time of `work` on a file of these bytes, after one run to warm up.
fn timed<E: Error + 'static>(
    name: &str,
    path: &Path,
    bytes: &[u8],
    work: impl Fn() -> Result<(), E>,
) -> Result<(), Box<dyn Error>> {
    std::fs::write(path, bytes)?;
    work()?;
    let mut best = f64::INFINITY;
    for _ in 0..5 {
        let start = Instant::now();
        work()?;
        best = best.min(start.elapsed().as_secs_f64());
    }
    let megapixels = f64::from(WIDTH * HEIGHT) / 1e6;
    println!("{name}: {:.2} ms per megapixel", best * 1e3 / megapixels);
    Ok(())
}

fn png_file(color: ColorType, depth: BitDepth, data: &[u8]) -> Result<Vec<u8>, Box<dyn Error>> {
    let mut bytes = Vec::new();
    let mut encoder = png::Encoder::new(&mut bytes, WIDTH, HEIGHT);
    encoder.set_color(color);
    encoder.set_depth(depth);
    let mut writer = encoder.write_header()?;
    writer.write_image_data(data)?;
    writer.finish()?;
    Ok(bytes)
}

fn decode_png(path: &Path) -> Result<(), png::DecodingError> {
    let file = std::io::BufReader::new(std::fs::File::open(path)?);
    let mut reader = png::Decoder::new(file).read_info()?;
    let mut row = vec![0; reader.output_line_size(WIDTH).unwrap_or(0)];
    while reader.read_row(&mut row)?.is_some() {}
    Ok(())
}

/// A smooth picture.
fn shade(i: u32) -> u8 {
    let (x, y) = (f64::from(i % WIDTH), f64::from(i / WIDTH));
    (128.0 + 60.0 * (x * 0.01).sin() + 50.0 * (y * 0.013).cos()) as u8
}

/// A linear congruential generator (the constants of Numerical Recipes).
struct Noise(u32);

impl Noise {
    fn below(&mut self, end: u32) -> u8 {
        self.0 = self.0.wrapping_mul(1_664_525).wrapping_add(1_013_904_223);
        ((self.0 >> 16) % end) as u8
    }
}
