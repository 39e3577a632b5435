//! Radiance HDR decoder: RGBE or XYZE, plain or run-length encoded.

use super::{
    picture::{LightReference, Picture, REPAIRED, SampleBits, repair_colours},
    source::{DecodeError, Source, checked_size, reserve, sample_count},
};
use crate::{
    Notes, Size,
    output::{Chromaticities, hdr},
};
use glam::Vec3;
use std::io::{BufRead, Read};

/// Longest line of a header, bytes.
const MAX_LINE: u64 = 1 << 16;

/// Longest header, lines.
const MAX_LINES: usize = 1 << 12;

struct Header {
    size: Size,
    /// Factor for the stored values.
    factor: f64,
    chromaticities: Option<Chromaticities>,
    white_luminance_cd_m2: Option<f32>,
    is_xyz: bool,
    pixel_aspect: f32,
}

pub(super) fn read(mut source: Source<'_>) -> Result<Picture, DecodeError> {
    let reader = &mut source.reader;
    let header = header(reader)?;
    let size = header.size;
    let width = size.width() as usize;
    // 2^(e - 136) for each exponent; 0 for exponent 0.
    let scale: Vec<f32> = (0..=255)
        .map(|e| match e {
            0 => 0.0,
            _ => (f64::from(e - 136).exp2() * header.factor) as f32,
        })
        .collect();
    let mut rgb = reserve(sample_count(size, 3))?;
    let mut line = vec![[0; 4]; width];
    for _ in 0..size.height() {
        scan_line(reader, &mut line)?;
        rgb.extend(line.iter().flat_map(|&[r, g, b, e]| {
            let unit = scale.get(usize::from(e)).copied().unwrap_or(0.0);
            [r, g, b].map(|mantissa| f32::from(mantissa) * unit)
        }));
    }
    // A tiny exposure can make values infinite.
    let repaired = repair_colours(&mut rgb);
    let mut notes = Notes::default();
    let stated = header.chromaticities;
    let mut chromaticities = stated.filter(|stated| stated.to_linear_srgb().is_some());
    if chromaticities != stated {
        notes.add("impossible primaries ignored");
    }
    if header.is_xyz {
        // Files with red, green and blue are what is written.
        let matrix = Chromaticities::XYZ.to_linear_srgb().unwrap_or_default();
        for pixel in rgb.as_chunks_mut::<3>().0 {
            *pixel = (matrix.as_mat3() * Vec3::from(*pixel)).into();
        }
        chromaticities = None;
        notes.add("colours converted from CIE XYZ to sRGB");
    }
    let mut picture = Picture {
        chromaticities,
        white_luminance_cd_m2: header.white_luminance_cd_m2,
        pixel_aspect: header.pixel_aspect,
        notes,
        ..Picture::new(size, rgb, LightReference::Scene, SampleBits::Float)
    };
    picture.notes.count(repaired, REPAIRED);
    Ok(picture)
}

fn header(reader: &mut impl BufRead) -> Result<Header, DecodeError> {
    let (mut exposure, mut aspect) = (1.0, 1.0);
    let (mut primaries, mut neutral, mut white) = (None, None, None);
    let mut is_xyz = false;
    for number in 0.. {
        let line = header_line(reader)?;
        if number == MAX_LINES {
            return Err(DecodeError::invalid(
                "expected an empty line after the HDR header, got none",
            ));
        }
        if line.is_empty() {
            break;
        }
        if number == 0 || line.starts_with('#') {
            continue;
        }
        let Some((name, value)) = line.split_once('=') else {
            continue;
        };
        let value = value.trim();
        match name.trim() {
            "FORMAT" => match value {
                "32-bit_rle_rgbe" => {}
                "32-bit_rle_xyze" => is_xyz = true,
                _ => {
                    return Err(DecodeError::Invalid(format!(
                        "expected the HDR format 32-bit_rle_rgbe or 32-bit_rle_xyze, got `{value}`"
                    )));
                }
            },
            // Several exposures multiply.
            "EXPOSURE" => exposure *= value.parse().unwrap_or(1.0),
            "PIXASPECT" => aspect *= value.parse().unwrap_or(1.0),
            "PRIMARIES" => primaries = chromaticities(value),
            hdr::NEUTRAL => neutral = numbers(value),
            hdr::WHITE_LUMINANCE => white = value.parse().ok(),
            _ => {}
        }
    }
    let usable = f64::is_normal(exposure) && exposure > 0.0;
    Ok(Header {
        size: dimensions(&header_line(reader)?)?,
        factor: if usable { 1.0 / exposure } else { 1.0 },
        chromaticities: primaries.map(|stated: Chromaticities| Chromaticities {
            neutral: neutral.unwrap_or(stated.neutral),
            ..stated
        }),
        white_luminance_cd_m2: white.filter(|white: &f32| white.is_finite() && *white > 0.0),
        is_xyz,
        // Radiance states height over width.
        pixel_aspect: Picture::checked_aspect((1.0 / aspect) as f32),
    })
}

fn header_line(reader: &mut impl BufRead) -> Result<String, DecodeError> {
    let mut line = Vec::new();
    reader.take(MAX_LINE).read_until(b'\n', &mut line)?;
    if line.pop() != Some(b'\n') {
        return Err(DecodeError::invalid(
            "expected an empty line after the HDR header, got none",
        ));
    }
    Ok(String::from_utf8_lossy(&line).trim().to_owned())
}

fn chromaticities(value: &str) -> Option<Chromaticities> {
    let [rx, ry, gx, gy, bx, by, wx, wy] = numbers(value)?;
    Some(Chromaticities {
        red: [rx, ry],
        green: [gx, gy],
        blue: [bx, by],
        white: [wx, wy],
        neutral: [wx, wy],
    })
}

/// Exactly `N` finite numbers.
fn numbers<const N: usize>(value: &str) -> Option<[f32; N]> {
    let numbers: Vec<f32> = value
        .split_whitespace()
        .map(|n| n.parse().ok().filter(|n: &f32| n.is_finite()))
        .collect::<Option<_>>()?;
    numbers.try_into().ok()
}

fn dimensions(line: &str) -> Result<Size, DecodeError> {
    let words: Vec<&str> = line.split_whitespace().collect();
    let refused = || {
        DecodeError::Invalid(format!(
            "expected the HDR size as `-Y HEIGHT +X WIDTH`, rows from the top, got `{line}`"
        ))
    };
    let ["-Y", height, "+X", width] = words[..] else {
        return Err(refused());
    };
    let number = |text: &str| text.parse::<u64>().map_err(|_| refused());
    checked_size(number(width)?, number(height)?)
}

fn scan_line(reader: &mut impl BufRead, line: &mut [[u8; 4]]) -> Result<(), DecodeError> {
    let width = line.len();
    let first = four(reader)?;
    // Narrower and wider rows are never run-length encoded.
    if !(8..0x8000).contains(&width) {
        return old_line(reader, first, line);
    }
    let [2, 2, high @ 0..128, low] = first else {
        return old_line(reader, first, line);
    };
    if usize::from(u16::from_be_bytes([high, low])) != width {
        return Err(DecodeError::invalid(
            "corrupt HDR data: a row has the wrong length",
        ));
    }
    let mut loose = [0; 128];
    for component in 0..4 {
        let mut rest = &mut line[..];
        while !rest.is_empty() {
            let code = usize::from(byte(reader)?);
            let length = if code > 128 { code - 128 } else { code };
            if length == 0 || length > rest.len() {
                return Err(DecodeError::invalid(
                    "corrupt HDR data: a run exceeds its row",
                ));
            }
            let (now, later) = rest.split_at_mut(length);
            if code > 128 {
                let value = byte(reader)?;
                for pixel in now {
                    pixel[component] = value;
                }
            } else {
                let values = &mut loose[..length];
                reader.read_exact(values)?;
                for (pixel, value) in now.iter_mut().zip(values) {
                    pixel[component] = *value;
                }
            }
            rest = later;
        }
    }
    Ok(())
}

/// A row in the old encoding: plain pixels, among which `1 1 1 n` repeats the previous pixel n times, or 256 n times if it
/// follows another repetition, and so on.
fn old_line(
    reader: &mut impl BufRead,
    first: [u8; 4],
    line: &mut [[u8; 4]],
) -> Result<(), DecodeError> {
    let (mut at, mut shift) = (0, 0);
    let mut next = first;
    loop {
        if let [1, 1, 1, n] = next {
            let run = usize::from(n).checked_shl(shift).unwrap_or(usize::MAX);
            if at == 0 || run > line.len() - at {
                return Err(DecodeError::invalid(
                    "corrupt HDR data: a run exceeds its row",
                ));
            }
            let before = line[at - 1];
            line[at..at + run].fill(before);
            at += run;
            shift = (shift + 8).min(32);
        } else {
            line[at] = next;
            at += 1;
            shift = 0;
        }
        if at == line.len() {
            return Ok(());
        }
        next = four(reader)?;
    }
}

fn byte(reader: &mut impl BufRead) -> Result<u8, DecodeError> {
    let mut one = [0];
    reader.read_exact(&mut one)?;
    Ok(one[0])
}

fn four(reader: &mut impl BufRead) -> Result<[u8; 4], DecodeError> {
    let mut four = [0; 4];
    reader.read_exact(&mut four)?;
    Ok(four)
}
