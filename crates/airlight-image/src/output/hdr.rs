//! Radiance RGBE files: three 8-bit mantissas and a shared exponent, steps of about 1 percent, run-length encoded.
//!
//! Mantissas are rounded to nearest, as most readers expect: errors stay below 0.4 percent of the largest component.
//! Radiance's own programs add half a step on reading.

use super::{
    Metadata,
    bands::{Bands, RowBuffer},
    format::{FormatEntry, Written, expect_channels, into_file},
};
use crate::{Control, ImageError, RowSource, Size};
use std::{io::Write, path::Path};

const FORMAT: &str = "Radiance HDR";

/// Registry entry of the format.
pub(super) static ENTRY: FormatEntry = FormatEntry {
    name: FORMAT,
    endings: &["hdr", "pic"],
    is_linear: true,
    holds_alpha: false,
    holds_channels: false,
    clamping: "lay below 0, for colours outside the RGB space, which HDR cannot hold: they are 0",
    describe: |_| FORMAT.to_owned(),
    write: |path, rgb, options, control| {
        write(path, rgb.size, rgb.source, &options.metadata, control)
    },
};

/// Variable of the header: luminance of RGB (1, 1, 1) in cd/m^2, called `whiteLuminance` in EXR files.
pub(crate) const WHITE_LUMINANCE: &str = "WHITE_LUMINANCE";

/// Variable of the header: x and y of what looks white, called `adoptedNeutral` in EXR files.
pub(crate) const NEUTRAL: &str = "ADOPTED_NEUTRAL";

/// Largest RGBE value: mantissa 255 with the highest exponent.
const MAX: f32 = 255.0 * 6.646_14e35;

/// Writes linear RGB rows to a file.
///
/// # Errors
/// [`ImageError`]; the target is then unchanged.
pub fn write(
    path: &Path,
    size: Size,
    source: &dyn RowSource,
    metadata: &Metadata,
    control: Control<'_>,
) -> Result<Written, ImageError> {
    into_file(path, control, |out| {
        encode(out, size, source, metadata, control)
    })
}

/// Writes linear RGB rows to a stream as [`write()`] does; [`Written::bytes`] stays 0.
///
/// # Errors
/// [`ImageError`] where the source does not have three channels, the stream fails, or the caller cancels.
pub fn encode(
    out: &mut (dyn Write + Send),
    size: Size,
    source: &dyn RowSource,
    metadata: &Metadata,
    control: Control<'_>,
) -> Result<Written, ImageError> {
    expect_channels(FORMAT, source, 3)?;
    let failed = |source| ImageError::Stream {
        format: FORMAT,
        source,
    };
    out.write_all(header(size, metadata).as_bytes())
        .map_err(failed)?;
    let bands = Bands::for_channels(size, 3, 1);
    let mut written = Written::default();
    let width = size.width() as usize;
    bands.run(
        width * 16 * bands.rows(0).len(),
        control,
        |band| {
            let mut rows = RowBuffer::new(source, size);
            let mut bytes = Vec::with_capacity(width * 4 * bands.rows(band).len());
            let mut counts = Written::default();
            let mut pixels = vec![[0; 4]; width];
            for y in bands.rows(band) {
                let row = rows.row(y).as_chunks::<3>().0;
                for (pixel, rgb) in pixels.iter_mut().zip(row) {
                    *pixel = rgbe(*rgb, &mut counts);
                }
                scan_line(&pixels, &mut bytes);
            }
            Ok((bytes, counts))
        },
        |_, (bytes, counts)| {
            written.clamped_samples += counts.clamped_samples;
            written.nan_samples += counts.nan_samples;
            out.write_all(&bytes).map_err(failed)
        },
    )?;
    Ok(written)
}

fn header(size: Size, metadata: &Metadata) -> String {
    let mut text = String::from("#?RADIANCE\n");
    for (name, value) in metadata.as_texts() {
        // One line each, with only one `=`.
        let clean = |text: &str| text.replace(['\n', '\r', '\0'], " ");
        let name = clean(&name).to_ascii_uppercase().replace([' ', '='], "_");
        text.push_str(&format!("# {name}={}\n", clean(&value)));
    }
    if let Some(aspect) = metadata.pixel_aspect.filter(|aspect| *aspect != 1.0) {
        text.push_str(&format!("PIXASPECT={}\n", 1.0 / aspect));
    }
    if let Some(c) = metadata.chromaticities {
        text.push_str(&format!(
            "PRIMARIES={} {} {} {} {} {} {} {}\n",
            c.red[0],
            c.red[1],
            c.green[0],
            c.green[1],
            c.blue[0],
            c.blue[1],
            c.white[0],
            c.white[1]
        ));
        if let Some([x, y]) = c.stated_neutral() {
            text.push_str(&format!("{NEUTRAL}={x} {y}\n"));
        }
    }
    // The format has no field for the unit; readers pass over variables that they do not know.
    if let Some(white) = metadata.white_luminance_cd_m2 {
        text.push_str(&format!("{WHITE_LUMINANCE}={white}\n"));
    }
    text.push_str(&format!(
        "FORMAT=32-bit_rle_rgbe\n\n-Y {} +X {}\n",
        size.height(),
        size.width()
    ));
    text
}

/// Mantissas and exponent of a colour; negative components become 0.
#[inline]
fn rgbe(rgb: [f32; 3], counts: &mut Written) -> [u8; 4] {
    let rgb = rgb.map(|v| {
        if v.is_nan() {
            counts.nan_samples += 1;
            0.0
        } else if !(0.0..=MAX).contains(&v) {
            counts.clamped_samples += 1;
            v.clamp(0.0, MAX)
        } else {
            v
        }
    });
    let max = rgb[0].max(rgb[1]).max(rgb[2]);
    if max < 1e-37 {
        return [0; 4];
    }
    // max = m * 2^exponent with m in [1/2, 1).
    let mut exponent = (max.to_bits() >> 23) as i32 - 126;
    // Rounding up to 256 takes the next exponent.
    if max * power_of_two(8 - exponent) >= 255.5 {
        exponent += 1;
    }
    let scale = power_of_two(8 - exponent);
    let [r, g, b] = rgb.map(|v| (v * scale + 0.5) as u8);
    [r, g, b, (exponent + 128).clamp(0, 255) as u8]
}

/// 2^n where the result is normal.
#[inline]
fn power_of_two(n: i32) -> f32 {
    f32::from_bits(((n + 127).clamp(1, 254) as u32) << 23)
}

/// Appends a scan line: run-length encoded by component where the format allows for its width, plain otherwise.
fn scan_line(pixels: &[[u8; 4]], out: &mut Vec<u8>) {
    let width = pixels.len();
    if !(8..=0x7fff).contains(&width) {
        out.extend_from_slice(pixels.as_flattened());
        return;
    }
    out.extend_from_slice(&[2, 2, (width >> 8) as u8, width as u8]);
    let mut component = vec![0; width];
    for c in 0..4 {
        for (value, pixel) in component.iter_mut().zip(pixels) {
            *value = pixel[c];
        }
        run_lengths(&component, out);
    }
}

/// Runs as `128 + length, value` (length 2 to 127), other bytes as `length, values` (length 1 to 128).
fn run_lengths(values: &[u8], out: &mut Vec<u8>) {
    // Shorter runs cost more than they save.
    const MIN_RUN: usize = 4;
    let mut at = 0;
    let mut literal = 0;
    let flush = |from: usize, to: usize, out: &mut Vec<u8>| {
        for part in values[from..to].chunks(128) {
            out.push(part.len() as u8);
            out.extend_from_slice(part);
        }
    };
    while at < values.len() {
        let run = values[at..]
            .iter()
            .take(127)
            .take_while(|&&v| v == values[at])
            .count();
        if run >= MIN_RUN {
            flush(literal, at, out);
            out.extend_from_slice(&[128 + run as u8, values[at]]);
            at += run;
            literal = at;
        } else {
            at += run;
        }
    }
    flush(literal, at, out);
}
