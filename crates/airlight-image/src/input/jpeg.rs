//! JPEG decoder: baseline and progressive, grey or colour.

use super::{
    picture::{LightReference, Picture, SRGB_8, SampleBits, is_foreign_profile},
    source::{DecodeError, Source, checked_size, reserve, sample_count},
};
use crate::Size;
use std::io::Read;
use zune_core::{bytestream::ZCursor, colorspace::ColorSpace, options::DecoderOptions};
use zune_jpeg::{JpegDecoder, errors::DecodeErrors};

pub(super) fn read(mut source: Source) -> Result<Picture, DecodeError> {
    let mut bytes = Vec::new();
    source.reader.read_to_end(&mut bytes)?;
    require_end(&bytes)?;
    let options = DecoderOptions::default()
        .set_max_width(Size::MAX as usize)
        .set_max_height(Size::MAX as usize);
    let mut decoder = JpegDecoder::new_with_options(ZCursor::new(bytes), options);
    decoder.decode_headers().map_err(failed)?;
    let info = decoder
        .info()
        .ok_or_else(|| DecodeError::invalid("expected a JPEG header, got none"))?;
    let size = checked_size(u64::from(info.width), u64::from(info.height))?;
    let is_grey = match decoder.input_colorspace() {
        Some(ColorSpace::CMYK | ColorSpace::YCCK) => {
            return Err(DecodeError::invalid(
                "expected a grey or RGB picture, got CMYK; try saving it as RGB",
            ));
        }
        Some(ColorSpace::Luma) => true,
        _ => false,
    };
    let (space, each) = if is_grey {
        (ColorSpace::Luma, 1)
    } else {
        (ColorSpace::RGB, 3)
    };
    decoder.set_options(options.jpeg_set_out_colorspace(space));
    let count = sample_count(size, each);
    if decoder.output_buffer_size() != Some(count) {
        return Err(DecodeError::invalid(
            "expected 1 or 3 JPEG components, got another number",
        ));
    }
    let profile_ignored = decoder
        .icc_profile()
        .as_deref()
        .is_some_and(is_foreign_profile);
    let mut rgb = reserve(sample_count(size, 3))?;
    let mut decoded = vec![0; count];
    decoder.decode_into(&mut decoded).map_err(failed)?;
    let light = |v: u8| SRGB_8.get(usize::from(v)).copied().unwrap_or(0.0);
    if is_grey {
        rgb.extend(decoded.iter().flat_map(|&v| [light(v); 3]));
    } else {
        rgb.extend(decoded.iter().map(|&v| light(v)));
    }
    Ok(Picture {
        size,
        rgb,
        alpha: None,
        reference: LightReference::Display,
        bits: SampleBits::U8,
        chromaticities: None,
        white_luminance_cd_m2: None,
        profile_ignored,
        repaired_samples: 0,
    })
}

/// Refuses a file without an end marker after its first scan: the decoder would fill in missing pixels.
fn require_end(bytes: &[u8]) -> Result<(), DecodeError> {
    let early = |what: &str| Err(DecodeError::Truncated(format!("{what} is missing")));
    // After the start marker: segments of a marker and a length that includes itself, up to the first scan.
    let mut at = 2;
    loop {
        let Some(&[0xff, marker, high, low]) = bytes.get(at..at + 4) else {
            // Fill bytes, or corrupt data that the decoder reports.
            match bytes.get(at) {
                Some(_) if at + 4 <= bytes.len() => {
                    at += 1;
                    continue;
                }
                _ => return early("the image data"),
            }
        };
        match marker {
            // The scan.
            0xda => break,
            // Fill bytes and markers without a length.
            0x00 | 0x01 | 0xff | 0xd0..=0xd8 => at += 1,
            _ => at += 2 + usize::from(u16::from_be_bytes([high, low])),
        }
    }
    let scan = bytes.get(at..).unwrap_or_default();
    if scan.windows(2).any(|pair| pair == [0xff, 0xd9]) {
        Ok(())
    } else {
        early("the end marker")
    }
}

fn failed(error: DecodeErrors) -> DecodeError {
    match error {
        DecodeErrors::ExhaustedData => {
            DecodeError::Truncated("the rest of the image data is missing".into())
        }
        other => {
            let reason = format!("{other:?}");
            DecodeError::Invalid(format!("corrupt JPEG data: {}", reason.trim()))
        }
    }
}
