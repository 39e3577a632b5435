//! PNG decoder: pictures of any colour type and depth, depth maps of 8 or 16 bits of grey.

use super::{
    colour::ColourDecoding,
    depth::{DepthPacking, RawDepth, of_equal_components},
    exif::Exif,
    picture::{LightReference, Picture, SampleBits},
    pixel_layout::PixelLayout,
    source::{DecodeError, Source, TrackedFile, checked_size, reserve, sample_count},
};
use crate::{Notes, Size, output::Chromaticities};
use png::{BitDepth, ColorType, Decoder, DecodingError, Info, Limits, Reader, Transformations};
use std::io::BufReader;

type PngReader<'a> = Reader<BufReader<TrackedFile<'a>>>;

fn start(
    source: Source<'_>,
    transform: Transformations,
) -> Result<(PngReader<'_>, Size), DecodeError> {
    let mut decoder = Decoder::new_with_limits(source.reader, Limits { bytes: 1 << 28 });
    decoder.set_transformations(transform);
    decoder.set_ignore_text_chunk(true);
    let header = decoder.read_header_info().map_err(failed)?;
    let size = checked_size(u64::from(header.width), u64::from(header.height))?;
    Ok((decoder.read_info().map_err(failed)?, size))
}

pub(super) fn read(source: Source<'_>) -> Result<Picture, DecodeError> {
    let (mut reader, size) = start(source, Transformations::EXPAND)?;
    let (color, depth) = reader.output_color_type();
    let layout = PixelLayout {
        colours: match color {
            ColorType::Grayscale | ColorType::GrayscaleAlpha => 1,
            _ => 3,
        },
        alpha: matches!(color, ColorType::GrayscaleAlpha | ColorType::Rgba),
    };
    let info = reader.info();
    let mut notes = Notes::default();
    let decoding = decoding(info, layout.colours, &mut notes);
    // Pixels per unit: wide pixels are few.
    let pixel_aspect = info
        .pixel_dims
        .map_or(1.0, |dims| dims.yppu as f32 / dims.xppu as f32);
    let pixel_aspect = Picture::checked_aspect(pixel_aspect);
    let exif = info.exif_metadata.as_deref().map(Exif::parse);
    let mut rgb = reserve(sample_count(size, 3))?;
    let mut alpha = layout
        .alpha
        .then(|| reserve(sample_count(size, 1)))
        .transpose()?;
    let bits = if depth == BitDepth::Sixteen {
        let table = decoding.table(65_536);
        rows(&mut reader, |rows| {
            let (values, _) = rows.as_chunks::<2>();
            let values = values.iter().map(|&two| u16::from_be_bytes(two));
            layout.split(values, &table, &mut rgb, alpha.as_mut());
        })?;
        SampleBits::U16
    } else {
        let table = decoding.table(256);
        rows(&mut reader, |rows| {
            layout.split(rows.iter().copied(), &table, &mut rgb, alpha.as_mut());
        })?;
        SampleBits::U8
    };
    decoding.finish(&mut rgb).map_err(DecodeError::Invalid)?;
    let mut picture = Picture {
        alpha,
        notes,
        pixel_aspect,
        ..Picture::new(size, rgb, LightReference::Display, bits)
    };
    picture.note_conversion(decoding.name());
    Ok(picture.turned(exif.unwrap_or_default().orientation))
}

/// A depth map: grey of 8 or 16 bits, in the numbers of the file; or red, green and blue that are equal or packed.
pub(super) fn read_depth(
    source: Source<'_>,
    packing: DepthPacking,
) -> Result<RawDepth, DecodeError> {
    let (mut reader, size) = start(source, Transformations::IDENTITY)?;
    let (color, depth) = reader.output_color_type();
    let components = match color {
        ColorType::Grayscale => 1,
        ColorType::Rgb => 3,
        ColorType::Rgba => 4,
        ColorType::GrayscaleAlpha | ColorType::Indexed => 0,
    };
    let bits = match (components, depth) {
        (1.., BitDepth::Eight) => SampleBits::U8,
        (1.., BitDepth::Sixteen) => SampleBits::U16,
        _ => {
            let kind = match color {
                ColorType::GrayscaleAlpha => "grey and opacity",
                ColorType::Indexed => "a palette",
                _ => "grey",
            };
            return Err(DecodeError::Invalid(format!(
                "expected a PNG depth map with grey or colours of 8 or 16 bits, got {kind} of {} bits",
                depth as u8
            )));
        }
    };
    let mut values = reserve(sample_count(size, components))?;
    if bits == SampleBits::U16 {
        rows(&mut reader, |rows| {
            let (pairs, _) = rows.as_chunks::<2>();
            values.extend(pairs.iter().map(|&two| f32::from(u16::from_be_bytes(two))));
        })?;
    } else {
        rows(&mut reader, |rows| {
            values.extend(rows.iter().copied().map(f32::from));
        })?;
    }
    if components == 4 {
        values = values
            .chunks_exact(4)
            .flat_map(|p| [p[0], p[1], p[2]])
            .collect();
    }
    match (packing, components, bits) {
        (DepthPacking::None, 1, _) => {}
        (DepthPacking::None, ..) => values = of_equal_components(&values)?,
        (DepthPacking::Carla, 3.., SampleBits::U8) => {
            let pixels = values.chunks_exact(3);
            let metres = |number: f32| match number {
                CARLA_MAX => f32::INFINITY,
                number => number * (1000.0 / CARLA_MAX),
            };
            values = pixels
                .map(|p| metres(p[0] + 256.0 * p[1] + 65_536.0 * p[2]))
                .collect();
        }
        (DepthPacking::Carla, ..) => {
            return Err(DecodeError::invalid(
                "expected red, green and blue of 8 bits for packed depth, got grey or 16 bits; try leaving out depth-packing",
            ));
        }
    }
    let bits = match packing {
        DepthPacking::None => bits,
        DepthPacking::Carla => SampleBits::U32,
    };
    Ok(RawDepth { size, values, bits })
}

/// Largest number of 24 bits.
const CARLA_MAX: f32 = 16_777_215.0;

/// Bytes of the rows that are decoded while those before them are used.
const BATCH_BYTES: usize = 1 << 18;

/// Passes whole rows from the top to `take`, several at a time, while the next ones are decoded. Interlaced pictures are
/// decoded completely first.
fn rows(reader: &mut PngReader<'_>, mut take: impl FnMut(&[u8]) + Send) -> Result<(), DecodeError> {
    let info = reader.info();
    let (width, height) = (info.width, info.height as usize);
    let too_large = || DecodeError::invalid("a row does not fit into memory");
    let line = reader.output_line_size(width).ok_or_else(too_large)?.max(1);
    if info.interlaced {
        let bytes = reader.output_buffer_size().ok_or_else(too_large)?;
        Vec::<u8>::new().try_reserve_exact(bytes).map_err(|_| {
            DecodeError::invalid("not enough memory for an interlaced picture of this size")
        })?;
        let mut whole = vec![0; bytes];
        reader.next_frame(&mut whole).map_err(failed)?;
        take(&whole);
        return Ok(());
    }
    let batch = (BATCH_BYTES / line).clamp(1, height);
    let (mut next, mut ready) = (vec![0; batch * line], vec![0; batch * line]);
    let (mut left, mut taken) = (height, 0);
    while left > 0 || taken > 0 {
        let count = batch.min(left);
        let (decoded, ()) = rayon::join(
            || {
                next[..count * line]
                    .chunks_exact_mut(line)
                    .try_for_each(|row| decode_row(reader, row))
            },
            || take(&ready[..taken * line]),
        );
        decoded?;
        std::mem::swap(&mut next, &mut ready);
        taken = count;
        left -= count;
    }
    // Reads past the last row: the rest of the data and its checksums.
    reader.read_row(&mut next).map_err(failed)?;
    Ok(())
}

fn decode_row(reader: &mut PngReader<'_>, row: &mut [u8]) -> Result<(), DecodeError> {
    match reader.read_row(row).map_err(failed)? {
        Some(_) => Ok(()),
        None => Err(DecodeError::Truncated("rows are missing".to_owned())),
    }
}

/// Decoding of the colours: by code points, else by a profile, else as sRGB, else by primaries and gamma (PNG, third edition,
/// clause 4.3).
fn decoding(info: &Info<'_>, components: usize, notes: &mut Notes) -> ColourDecoding {
    if let Some(points) = &info.coding_independent_code_points {
        let full = points.is_video_full_range_image;
        match ColourDecoding::from_cicp(points.color_primaries, points.transfer_function, full) {
            Some(decoding) => return decoding,
            None => notes.add(format!(
                "cICP code points {} and {} are unknown and ignored",
                points.color_primaries, points.transfer_function
            )),
        }
    }
    if let Some(profile) = &info.icc_profile {
        match ColourDecoding::from_icc(profile, components) {
            Ok(decoding) => return decoding,
            Err(reason) => notes.add(format!("ICC profile ignored: {reason}")),
        }
    }
    if info.srgb.is_some() {
        return ColourDecoding::srgb();
    }
    let exponent = info.gama_chunk.map(|gamma| f64::from(gamma.into_value()));
    let exponent = exponent.filter(|gamma| (0.1..=10.0).contains(gamma));
    let exponent = exponent.map(|gamma| 1.0 / gamma);
    let primaries = info.chrm_chunk.map(|c| {
        let xy = |(x, y): (png::ScaledFloat, png::ScaledFloat)| [x.into_value(), y.into_value()];
        Chromaticities {
            red: xy(c.red),
            green: xy(c.green),
            blue: xy(c.blue),
            white: xy(c.white),
            neutral: xy(c.white),
        }
    });
    ColourDecoding::from_primaries(primaries, exponent).unwrap_or_else(|| {
        notes.add("impossible primaries (cHRM) ignored");
        ColourDecoding::srgb()
    })
}

fn failed(error: DecodingError) -> DecodeError {
    match error {
        DecodingError::IoError(error) => DecodeError::Io(error),
        DecodingError::LimitsExceeded => {
            DecodeError::invalid("its rows or metadata take more than 256 MiB of memory")
        }
        other => DecodeError::Invalid(format!("corrupt PNG data: {other}")),
    }
}
