//! Compact backgrounds: file sizes of a sky compressed by run lengths, and errors of skies rendered small and enlarged by
//! splines. Prints the tables of the book (`scripts/book`): `cargo run --release -p airlight-image --example background`, with
//! the argument `runs` or `splines` only one of them.

use airlight::axes::direction;
use airlight::models::PublishedModel;
use airlight::models::klassen1987::{Klassen1987, Klassen1987Settings};
use airlight::spectrum::RgbSpace;
use airlight::spectrum::difference::{D65_WHITE, ciede2000, xyz_to_lab};
use airlight::spectrum::rgb::srgb_encode;
use airlight_image::enlarge::Enlarged;
use airlight_image::output::Metadata;
use airlight_image::output::exr::{ExrCompression, ExrOptions, SamplePrecision, encode};
use airlight_image::rows::StoredRows;
use airlight_image::{Camera, Control, Frame, Projection, RowSource, Size};
use std::error::Error;
use std::io::Cursor;

const SIZE: (u32, u32) = (1024, 512);

type Outcome<T> = Result<T, Box<dyn Error>>;

fn main() -> Outcome<()> {
    match std::env::args().nth(1).as_deref() {
        None => run_lengths().and_then(|()| splines()),
        Some("runs") => run_lengths(),
        Some("splines") => splines(),
        Some(other) => Err(format!("expected `runs` or `splines`, got `{other}`").into()),
    }
}

/// The four skies, by name.
fn skies() -> Outcome<Vec<(String, Klassen1987)>> {
    let mut skies = Vec::new();
    for (name, sun_deg) in [("noon", 60.0), ("sunset", 1.0)] {
        for (variant, settings) in [
            ("printed", Klassen1987Settings::default().printed()),
            ("corrected", Klassen1987Settings::default()),
        ] {
            let model = Klassen1987::new(&settings, direction(180.0, sun_deg))?;
            skies.push((format!("{name}, {variant}"), model));
        }
    }
    Ok(skies)
}

/// The sky to the south above the horizon, 100 degrees across, with the sun in the middle.
fn frame(width: u32, height: u32) -> Outcome<Frame> {
    let camera = Camera {
        azimuth_deg: 180.0,
        elevation_deg: 30.81,
        roll_deg: 0.0,
        vertical_fov_deg: 61.6,
    };
    Ok(Frame::new(Projection::Perspective(camera), width, height)?)
}

/// A picture, linear sRGB in cd/m^2.
fn picture(model: &Klassen1987, (width, height): (u32, u32), remember: bool) -> Outcome<Vec<f32>> {
    let frame = frame(width, height)?;
    let mut walk = model.walk();
    let mut samples = Vec::with_capacity((3 * width * height) as usize);
    for j in 0..height {
        for i in 0..width {
            let look = frame
                .pixel_direction(i, j)
                .ok_or("expected a direction for each pixel")?;
            let xyz = match remember {
                true => walk(look),
                false => model.sky_xyz(look),
            };
            samples.extend(RgbSpace::Srgb.from_xyz(xyz).map(|v| v as f32));
        }
    }
    Ok(samples)
}

/// Sizes of pictures compressed by run lengths: 8-bit codes, half and single precision.
fn run_lengths() -> Outcome<()> {
    println!(
        "| sky | 8-bit colours in runs | EXR, half: run lengths | zip | EXR, float: run lengths | zip |"
    );
    println!("|---|---|---|---|---|---|");
    let skies = skies()?;
    for (name, model) in &skies {
        println!("| {name} | {} |", packed(model, false)?);
    }
    // Not in the book's table.
    for (name, model) in &skies {
        println!("colours remembered: {name}: {}", packed(model, true)?);
    }
    Ok(())
}

/// Sizes of one compressed picture in percent of the uncompressed one, with the model's colours cached or not.
fn packed(model: &Klassen1987, remember: bool) -> Outcome<String> {
    let size = Size::new(SIZE.0, SIZE.1)?;
    let samples = picture(model, SIZE, remember)?;
    let white = 5.0 * samples.iter().sum::<f32>() / samples.len() as f32;
    let codes: Vec<[u8; 3]> = samples
        .as_chunks::<3>()
        .0
        .iter()
        .map(|rgb| {
            rgb.map(|v| (255.0 * srgb_encode(f64::from(v / white).clamp(0.0, 1.0))).round() as u8)
        })
        .collect();
    // A run is a length (one byte) and a colour; it ends with its row.
    let runs: usize = codes
        .chunks(SIZE.0 as usize)
        .map(|row| {
            let same = row.chunk_by(|a, b| a == b);
            same.map(|run| run.len().div_ceil(256)).sum::<usize>()
        })
        .sum();
    let source = StoredRows::new(SIZE.0, 3, samples)?;
    let bytes = |precision, compression| -> Outcome<usize> {
        let mut out = Cursor::new(Vec::new());
        let options = ExrOptions {
            precision,
            compression,
        };
        let names = ["R", "G", "B"];
        let metadata = Metadata::default();
        encode(
            &mut out,
            size,
            &names,
            &source,
            &options,
            &metadata,
            Control::default(),
        )?;
        Ok(out.into_inner().len())
    };
    let percent = |precision| -> Outcome<String> {
        let whole = bytes(precision, ExrCompression::None)? as f64;
        let rle = bytes(precision, ExrCompression::Rle)? as f64;
        let zip = bytes(precision, ExrCompression::Zip)? as f64;
        let [rle, zip] = [rle, zip].map(|packed| 100.0 * packed / whole);
        Ok(format!("{rle:.0} % | {zip:.0} %"))
    };
    Ok(format!(
        "{:.0} % | {} | {}",
        100.0 * (4 * runs) as f64 / (3 * codes.len()) as f64,
        percent(SamplePrecision::Half)?,
        percent(SamplePrecision::Float)?
    ))
}

/// A number with two significant digits, all its digits before the point, and at most three after it.
fn short(v: f64) -> String {
    let before = v.abs().log10().floor() as i32;
    format!("{v:.0$}", (1 - before).clamp(0, 3) as usize)
}

/// Errors of enlarged pictures against those rendered at full size.
fn splines() -> Outcome<()> {
    println!(
        "| sky | enlarged | luminance, rms | worst | CIEDE2000, mean | worst |\n|---|---|---|---|---|---|"
    );
    for (mut name, model) in skies()? {
        let full = picture(&model, SIZE, false)?;
        for factor in [4, 8, 16] {
            println!(
                "| {} | {factor} times | {} |",
                std::mem::take(&mut name),
                enlarged(&model, &full, factor)?
            );
        }
    }
    Ok(())
}

/// Errors of a picture rendered smaller by a factor.
fn enlarged(model: &Klassen1987, full: &[f32], factor: u32) -> Outcome<String> {
    let luminance = |rgb: &[f32; 3]| RgbSpace::Srgb.to_xyz(rgb.map(f64::from))[1];
    let pixels = full.as_chunks::<3>().0;
    let white = 5.0 * pixels.iter().map(luminance).sum::<f64>() / pixels.len() as f64;
    let small = (SIZE.0 / factor, SIZE.1 / factor);
    let samples = picture(model, small, false)?;
    let enlarged = Enlarged::new(
        &StoredRows::new(small.0, 3, samples)?,
        Size::new(SIZE.0, SIZE.1)?,
    )?;
    let mut got = vec![0.0; full.len()];
    for (y, row) in got.chunks_exact_mut(3 * SIZE.0 as usize).enumerate() {
        enlarged.fill_row(y as u32, row);
    }
    let (mut squares, mut worst, mut sum, mut most) = (0.0, 0.0f64, 0.0, 0.0f64);
    for (a, b) in got.as_chunks::<3>().0.iter().zip(pixels) {
        let error = luminance(a) / luminance(b) - 1.0;
        squares += error * error;
        worst = worst.max(error.abs());
        let lab = |rgb: &[f32; 3]| {
            let xyz = RgbSpace::Srgb.to_xyz(rgb.map(f64::from));
            xyz_to_lab(xyz.map(|v| 100.0 * v / white), D65_WHITE)
        };
        let difference = ciede2000(lab(a), lab(b));
        sum += difference;
        most = most.max(difference);
    }
    let count = pixels.len() as f64;
    Ok(format!(
        "{} % | {} % | {:.3} | {}",
        short(100.0 * (squares / count).sqrt()),
        short(100.0 * worst),
        sum / count,
        short(most),
    ))
}
