//! TIFF decoder: pictures of 8 and 16 bits (display colours) and of floats (linear light), and depth maps of numbers of any kind.

use super::{
    colour::ColourDecoding,
    depth::RawDepth,
    orientation::Orientation,
    picture::{LightReference, Picture, REPAIRED, SampleBits, repair_colours, repair_opacity},
    pixel_layout::PixelLayout,
    source::{DecodeError, Source, TrackedFile, checked_size, reserve, sample_count},
};
use crate::{Notes, Size};
use ::tiff::{
    ColorType, TiffError,
    decoder::{Decoder, DecodingResult, Limits, ifd::Value},
    tags::{ExtraSamples, PhotometricInterpretation, PlanarConfiguration, Tag},
};
use glam::Vec3;
use std::io::BufReader;

/// Largest size of the decoded samples, bytes.
const MAX_BYTES: u64 = 1 << 33;

type TiffDecoder<'a> = Decoder<BufReader<TrackedFile<'a>>>;

fn start(source: Source<'_>) -> Result<(TiffDecoder<'_>, Size), DecodeError> {
    let mut limits = Limits::default();
    limits.decoding_buffer_size = usize::try_from(MAX_BYTES).unwrap_or(usize::MAX);
    let mut decoder = Decoder::new(source.reader)
        .map_err(failed)?
        .with_limits(limits);
    let (width, height) = decoder.dimensions().map_err(failed)?;
    Ok((decoder, checked_size(width.into(), height.into())?))
}

/// Components of the pixels of a file.
struct Components {
    layout: PixelLayout,
    /// Whether colours are multiplied by opacity ("associated alpha").
    is_premultiplied: bool,
    /// Components that the decoder returns for a pixel.
    decoded: usize,
}

pub(super) fn read(source: Source<'_>) -> Result<Picture, DecodeError> {
    let (mut decoder, size) = start(source)?;
    let mut notes = Notes::default();
    let components = components(&mut decoder, &mut notes)?;
    let orientation = number(&mut decoder, Tag::Orientation)?
        .and_then(Orientation::from_exif)
        .unwrap_or_default();
    let pixel_aspect = match (
        rational(&mut decoder, Tag::XResolution),
        rational(&mut decoder, Tag::YResolution),
    ) {
        // Pixels per unit: wide pixels are few.
        (Some(x), Some(y)) => Picture::checked_aspect(y / x),
        _ => 1.0,
    };
    let profile = decoder.find_tag(Tag::IccProfile).map_err(failed)?;
    let profile = profile.map(Value::into_u8_vec).transpose();
    let stated = profile.map_err(failed)?.and_then(|profile| {
        ColourDecoding::from_icc(&profile, components.layout.colours)
            .inspect_err(|reason| notes.add(format!("ICC profile ignored: {reason}")))
            .ok()
    });
    if decoder.more_images() {
        notes.add("further pages of the TIFF file ignored");
    }
    let image = decoder.read_image().map_err(failed)?;
    let srgb = ColourDecoding::srgb();
    let encoded = || stated.as_ref().unwrap_or(&srgb);
    let mut picture = match image {
        DecodingResult::U8(v) => {
            let values = unmultiplied(v, &components, u8::MAX.into());
            displayed(size, &components, &values, SampleBits::U8, encoded())
        }
        DecodingResult::U16(v) => {
            let values = unmultiplied(v, &components, u16::MAX.into());
            displayed(size, &components, &values, SampleBits::U16, encoded())
        }
        floats @ (DecodingResult::F16(_) | DecodingResult::F32(_) | DecodingResult::F64(_)) => {
            let (values, bits) = numbers(floats);
            linear(
                size,
                &components,
                &values,
                bits,
                stated.as_ref(),
                &mut notes,
            )
        }
        _ => Err(unsupported(
            "signed integers or integers of more than 16 bits",
        )),
    }?;
    picture.note_conversion(stated.as_ref().and_then(ColourDecoding::name));
    notes.merge(&picture.notes);
    let picture = Picture {
        notes,
        pixel_aspect,
        ..picture
    };
    Ok(picture.turned(orientation))
}

/// The components of a file; those besides colours and opacity are noted.
fn components(decoder: &mut TiffDecoder<'_>, notes: &mut Notes) -> Result<Components, DecodeError> {
    // Kinds that the decoder refuses without a name that a user knows.
    let photometric = number(decoder, Tag::PhotometricInterpretation)?;
    match photometric.and_then(PhotometricInterpretation::from_u16) {
        Some(PhotometricInterpretation::RGBPalette) => return Err(unsupported("a palette")),
        Some(PhotometricInterpretation::CIELab) => return Err(unsupported("CIE L*a*b*")),
        _ => {}
    }
    let color = decoder.colortype().map_err(failed)?;
    let extra: Vec<u16> = decoder
        .find_tag_unsigned_vec(Tag::ExtraSamples)
        .map_err(failed)?
        .unwrap_or_default();
    let first = extra.first().copied();
    let is_alpha = |kind: ExtraSamples| first == Some(kind.to_u16());
    let is_premultiplied = is_alpha(ExtraSamples::AssociatedAlpha);
    let has_alpha = is_premultiplied || is_alpha(ExtraSamples::UnassociatedAlpha);
    let (colours, alpha, decoded) = match color {
        ColorType::Gray(_) => (1, false, 1),
        ColorType::Multiband { num_samples, .. } if usize::from(num_samples) == 1 + extra.len() => {
            (1, has_alpha, usize::from(num_samples))
        }
        ColorType::RGB(_) => (3, false, 3),
        ColorType::RGBA(_) => (3, true, 4),
        ColorType::CMYK(_) | ColorType::CMYKA(_) => return Err(unsupported("CMYK")),
        ColorType::YCbCr(_) => return Err(unsupported("luminance and chroma (YCbCr)")),
        ColorType::Multiband { num_samples, .. } => {
            return Err(unsupported(&format!("{num_samples} bands")));
        }
        _ => return Err(unsupported("another kind of colour")),
    };
    let bits = color.bit_depth();
    if bits < 8 {
        return Err(unsupported(&format!("{bits} bits")));
    }
    let layout = PixelLayout { colours, alpha };
    let stored: usize = number(decoder, Tag::SamplesPerPixel)?.unwrap_or(1).into();
    let planes = number(decoder, Tag::PlanarConfiguration)?;
    if stored > 1 && planes == Some(PlanarConfiguration::Planar.to_u16()) {
        return Err(unsupported("components in planes of their own"));
    }
    let others = stored.saturating_sub(layout.count()) as u64;
    notes.count(others, "other components of the TIFF file ignored");
    Ok(Components {
        layout,
        is_premultiplied: is_premultiplied && alpha,
        decoded,
    })
}

/// A picture of display colours, whose opacity does not multiply them.
fn displayed<T: Copy + Into<usize>>(
    size: Size,
    components: &Components,
    values: &[T],
    bits: SampleBits,
    decoding: &ColourDecoding,
) -> Result<Picture, DecodeError> {
    let Components {
        layout, decoded, ..
    } = *components;
    check_count(size, components, values.len())?;
    let table = decoding.table(match bits {
        SampleBits::U8 => 256,
        _ => 65_536,
    });
    let mut rgb = reserve(sample_count(size, 3))?;
    let mut alpha = layout
        .alpha
        .then(|| reserve(sample_count(size, 1)))
        .transpose()?;
    // One row's pixels at a time, without further components.
    let row = decoded * size.width() as usize;
    let mut kept = Vec::with_capacity(layout.count() * size.width() as usize);
    for row in values.chunks_exact(row) {
        kept.clear();
        let pixels = row.chunks_exact(decoded);
        pixels.for_each(|pixel| kept.extend_from_slice(&pixel[..layout.count()]));
        layout.split(kept.iter().copied(), &table, &mut rgb, alpha.as_mut());
    }
    decoding.finish(&mut rgb).map_err(DecodeError::Invalid)?;
    Ok(Picture {
        alpha,
        ..Picture::new(size, rgb, LightReference::Display, bits)
    })
}

/// Encoded colours divided by their opacity, of which `opaque` is the largest number, where a file has multiplied them by it.
fn unmultiplied<T>(mut values: Vec<T>, components: &Components, opaque: u32) -> Vec<T>
where
    T: Copy + Into<u32> + TryFrom<u32>,
{
    let Components {
        layout,
        is_premultiplied,
        decoded,
    } = *components;
    if !is_premultiplied {
        return values;
    }
    for pixel in values.chunks_exact_mut(decoded) {
        let (colours, rest) = pixel.split_at_mut(layout.colours);
        let opacity: u32 = rest[0].into();
        for colour in colours {
            let multiplied: u32 = (*colour).into();
            let divided = (multiplied * opaque + opacity / 2).checked_div(opacity);
            if let Ok(plain) = T::try_from(divided.unwrap_or(0).min(opaque)) {
                *colour = plain;
            }
        }
    }
    values
}

/// A picture of linear light, whose opacity multiplies it, as in EXR files.
fn linear(
    size: Size,
    components: &Components,
    values: &[f32],
    bits: SampleBits,
    stated: Option<&ColourDecoding>,
    notes: &mut Notes,
) -> Result<Picture, DecodeError> {
    let encoded = |decoding: &ColourDecoding| {
        let name = decoding.name().unwrap_or("sRGB");
        unsupported(&format!("floats encoded by the curve of a profile, {name}"))
    };
    let matrix = match stated {
        Some(decoding) => decoding
            .of_linear_light()
            .ok_or_else(|| encoded(decoding))?,
        None => None,
    };
    let Components {
        layout,
        is_premultiplied,
        decoded,
    } = *components;
    check_count(size, components, values.len())?;
    let mut rgb: Vec<f32> = reserve(sample_count(size, 3))?;
    let mut alpha: Option<Vec<f32>> = layout
        .alpha
        .then(|| reserve(sample_count(size, 1)))
        .transpose()?;
    for pixel in values.chunks_exact(decoded) {
        let [r, g, b] = match layout.colours {
            1 => [0; 3],
            _ => [0, 1, 2],
        };
        let mut colour = Vec3::new(pixel[r], pixel[g], pixel[b]);
        if let Some(matrix) = &matrix {
            colour = *matrix * colour;
        }
        if let Some(alpha) = &mut alpha {
            let opacity = pixel[layout.colours];
            alpha.push(opacity);
            if !is_premultiplied {
                colour *= opacity;
            }
        }
        rgb.extend_from_slice(&colour.to_array());
    }
    let mut repaired = repair_colours(&mut rgb);
    if let Some(alpha) = &mut alpha {
        repaired += repair_opacity(alpha);
    }
    notes.count(repaired, REPAIRED);
    Ok(Picture {
        alpha,
        ..Picture::new(size, rgb, LightReference::Scene, bits)
    })
}

fn check_count(size: Size, components: &Components, count: usize) -> Result<(), DecodeError> {
    match count == sample_count(size, components.decoded) {
        true => Ok(()),
        false => Err(DecodeError::invalid(
            "corrupt TIFF data: the samples are fewer or more than the pixels",
        )),
    }
}

/// A depth map: one number to a pixel, integer or float of any width.
pub(super) fn read_depth(source: Source<'_>) -> Result<RawDepth, DecodeError> {
    let (mut decoder, size) = start(source)?;
    match decoder.colortype().map_err(failed)? {
        ColorType::Gray(_) => {}
        other => {
            return Err(DecodeError::Invalid(format!(
                "expected a TIFF depth map with one sample to a pixel, got {other:?}"
            )));
        }
    }
    let (values, bits) = numbers(decoder.read_image().map_err(failed)?);
    if values.len() != sample_count(size, 1) {
        return Err(DecodeError::invalid(
            "expected a TIFF depth map of 8 bits or more, got fewer",
        ));
    }
    Ok(RawDepth { size, values, bits })
}

/// Samples in the numbers of the file.
fn numbers(image: DecodingResult) -> (Vec<f32>, SampleBits) {
    match image {
        DecodingResult::U8(v) => (v.into_iter().map(f32::from).collect(), SampleBits::U8),
        DecodingResult::I8(v) => (v.into_iter().map(f32::from).collect(), SampleBits::U8),
        DecodingResult::U16(v) => (v.into_iter().map(f32::from).collect(), SampleBits::U16),
        DecodingResult::I16(v) => (v.into_iter().map(f32::from).collect(), SampleBits::U16),
        DecodingResult::U32(v) => (v.into_iter().map(|v| v as f32).collect(), SampleBits::U32),
        DecodingResult::I32(v) => (v.into_iter().map(|v| v as f32).collect(), SampleBits::U32),
        DecodingResult::U64(v) => (v.into_iter().map(|v| v as f32).collect(), SampleBits::U32),
        DecodingResult::I64(v) => (v.into_iter().map(|v| v as f32).collect(), SampleBits::U32),
        DecodingResult::F16(v) => (
            v.into_iter().map(|v| v.to_f32()).collect(),
            SampleBits::Half,
        ),
        DecodingResult::F32(v) => (v, SampleBits::Float),
        DecodingResult::F64(v) => (v.into_iter().map(|v| v as f32).collect(), SampleBits::Float),
    }
}

/// The number of a tag; `None` if the file has none.
fn number(decoder: &mut TiffDecoder<'_>, tag: Tag) -> Result<Option<u16>, DecodeError> {
    decoder.find_tag_unsigned(tag).map_err(failed)
}

/// The fraction of a tag; `None` if there is none.
fn rational(decoder: &mut TiffDecoder<'_>, tag: Tag) -> Option<f32> {
    match decoder.find_tag(tag) {
        Ok(Some(Value::Rational(above, below))) => Some(above as f32 / below as f32),
        _ => None,
    }
}

fn unsupported(got: &str) -> DecodeError {
    DecodeError::Invalid(format!(
        "expected a TIFF picture with grey or red, green and blue, of 8 or 16 bits or linear floats, got {got}; try saving it so, or as PNG \
         or EXR"
    ))
}

fn failed(error: TiffError) -> DecodeError {
    match error {
        TiffError::IoError(error) => DecodeError::Io(error),
        TiffError::LimitsExceeded => {
            DecodeError::invalid("its samples take more than 8 GiB of memory")
        }
        TiffError::UnsupportedError(what) => DecodeError::Invalid(format!(
            "unsupported TIFF file: {what}; try saving it uncompressed, or as PNG or EXR"
        )),
        other => DecodeError::Invalid(format!("corrupt TIFF data: {other}")),
    }
}
