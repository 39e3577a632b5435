//! Measures writers on a large picture: seconds, megapixels a second, file size, and peak memory on Linux.
//!
//! `cargo run --release -p airlight-image --example big_picture -- FOLDER [HEIGHT] [FORMAT...]`, where a format is
//! `png`, `png16`, `jpg`, `hdr`, `exr`, `exr-float`, `exr-piz` or `spectral`. The width is twice the height (default
//! 8192).

use airlight_image::{
    Control, Frame, ImageError,
    output::{
        Metadata, Written,
        exr::{self, ExrCompression, ExrOptions, SamplePrecision},
        hdr,
        jpeg::{self, JpegOptions},
        png::{self, PngDepth, PngOptions},
        spectral::{self, SpectralLayout},
    },
    rows::RowFn,
    tone::{ToneCurve, ToneMapper},
};
use glam::DVec3;
use std::{path::Path, time::Instant};

const FORMATS: [&str; 8] = [
    "png",
    "png16",
    "jpg",
    "hdr",
    "exr",
    "exr-float",
    "exr-piz",
    "spectral",
];

fn main() -> Result<(), ImageError> {
    let mut arguments = std::env::args().skip(1);
    let folder = arguments.next().unwrap_or_else(|| ".".to_owned());
    let height = arguments
        .next()
        .and_then(|h| h.parse().ok())
        .unwrap_or(8192);
    let mut formats: Vec<String> = arguments.collect();
    if formats.is_empty() {
        formats = FORMATS.map(str::to_owned).into();
    }
    let frame = Frame::equirectangular(height)?;
    for format in &formats {
        let start = Instant::now();
        let written = write(Path::new(&folder), &frame, format)?;
        let seconds = start.elapsed().as_secs_f64();
        let pixels = f64::from(frame.size().width()) * f64::from(height);
        println!(
            "{format:10} {seconds:7.2} s {:7.1} Mpx/s {:8.1} MB, peak memory {}",
            pixels / seconds / 1e6,
            written.bytes as f64 / 1e6,
            peak_memory()
        );
    }
    Ok(())
}

fn write(folder: &Path, frame: &Frame, format: &str) -> Result<Written, ImageError> {
    let size = frame.size();
    let rgb = gradient(frame, 3);
    let tone = ToneMapper::new(1.0, ToneCurve::default())?;
    let metadata = Metadata::default().with_frame(frame);
    let control = Control::default();
    let exr_as = |precision, compression| {
        let options = ExrOptions {
            precision,
            compression,
        };
        let path = folder.join(format!("big_{format}.exr"));
        exr::write(
            &path,
            size,
            &["R", "G", "B"],
            &rgb,
            &options,
            &metadata,
            control,
        )
    };
    match format {
        "png" | "png16" => {
            let options = PngOptions {
                depth: if format == "png" {
                    PngDepth::Eight
                } else {
                    PngDepth::Sixteen
                },
                ..PngOptions::default()
            };
            let path = folder.join(format!("big_{format}.png"));
            png::write(&path, size, &rgb, &tone, &options, &metadata, control)
        }
        "jpg" => {
            let path = folder.join("big.jpg");
            jpeg::write(
                &path,
                size,
                &rgb,
                &tone,
                &JpegOptions::default(),
                &metadata,
                control,
            )
        }
        "hdr" => hdr::write(&folder.join("big.hdr"), size, &rgb, &metadata, control),
        "exr-float" => exr_as(SamplePrecision::Float, ExrCompression::Zip),
        "exr-piz" => exr_as(SamplePrecision::Half, ExrCompression::Piz),
        "spectral" => {
            let wavelengths: Vec<f64> = (0..40).map(|i| 380.0 + 10.0 * f64::from(i)).collect();
            spectral::write(
                &folder.join("big_spectral.exr"),
                size,
                &SpectralLayout::new(&wavelengths)?,
                &gradient(frame, 43),
                &ExrOptions::default(),
                &metadata,
                control,
            )
        }
        _ => exr_as(SamplePrecision::Half, ExrCompression::Zip),
    }
}

/// A simple sky, brighter towards the horizon and around the sun, whose disc is above the range of half precision.
fn gradient(frame: &Frame, channels: usize) -> RowFn<impl Fn(u32, &mut [f32]) + Sync + use<>> {
    let rows = frame.rows();
    let width = frame.size().width() as usize;
    let sun = airlight::axes::direction(120.0, 30.0);
    RowFn::new(channels, move |y, out: &mut [f32]| {
        let mut directions = vec![DVec3::ZERO; width];
        rows.fill(y, &mut directions);
        for (pixel, direction) in out.chunks_mut(channels).zip(directions) {
            let up = direction.y.max(0.0) as f32;
            let mu = direction.dot(sun) as f32;
            let disc = if mu > 0.999_989 { 1e5 } else { 0.0 };
            let glow = 0.02 / (1.0005 - mu);
            let haze = 0.4 * (1.0 - up) * (1.0 - up);
            for (c, value) in pixel.iter_mut().enumerate() {
                *value = 0.1 + 0.05 * c as f32 * up + haze + glow + disc;
            }
        }
    })
}

fn peak_memory() -> String {
    let status = std::fs::read_to_string("/proc/self/status").unwrap_or_default();
    status
        .lines()
        .find_map(|line| line.strip_prefix("VmHWM:"))
        .map_or("unknown".to_owned(), |size| size.trim().to_owned())
}
