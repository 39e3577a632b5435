//! JPEG files: baseline and progressive, grey or colour.

use super::{
    fault::{Fault, checked_size, room, samples},
    picture::{LightReference, Picture, SampleBits, is_foreign},
    png::srgb_8,
    source::Source,
};
use crate::Size;
use std::io::Read;
use zune_core::{bytestream::ZCursor, colorspace::ColorSpace, options::DecoderOptions};
use zune_jpeg::{JpegDecoder, errors::DecodeErrors};

pub(super) fn read(mut source: Source) -> Result<Picture, Fault> {
    let mut bytes = Vec::new();
    source.reader.read_to_end(&mut bytes)?;
    demand_end(&bytes)?;
    let options = DecoderOptions::default()
        .set_max_width(Size::MAX as usize)
        .set_max_height(Size::MAX as usize);
    let mut decoder = JpegDecoder::new_with_options(ZCursor::new(bytes), options);
    decoder.decode_headers().map_err(failed)?;
    let info = decoder
        .info()
        .ok_or_else(|| Fault::bad("as JPEG it has no header"))?;
    let size = checked_size(u64::from(info.width), u64::from(info.height))?;
    let is_grey = match decoder.input_colorspace() {
        Some(ColorSpace::CMYK | ColorSpace::YCCK) => {
            return Err(Fault::bad(
                "it is a CMYK picture, made for printing: save it as RGB",
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
    let count = samples(size, each);
    if decoder.output_buffer_size() != Some(count) {
        return Err(Fault::bad("as JPEG it has an unusual number of colours"));
    }
    let profile_ignored = decoder.icc_profile().as_deref().is_some_and(is_foreign);
    let mut rgb = room(samples(size, 3))?;
    let mut decoded = vec![0; count];
    decoder.decode_into(&mut decoded).map_err(failed)?;
    let table = srgb_8();
    let light = |v: u8| table.get(usize::from(v)).copied().unwrap_or(0.0);
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

/// Refuses a file without an end marker after its first scan: the decoder would make up what is missing.
fn demand_end(bytes: &[u8]) -> Result<(), Fault> {
    let early = |what: &str| Err(Fault::Early(format!("{what} is missing")));
    // Past the marker of the beginning, segments of a marker and a length that counts itself, up to the first scan.
    let mut at = 2;
    loop {
        let Some(&[0xff, marker, high, low]) = bytes.get(at..at + 4) else {
            // Fill bytes, or nonsense for the decoder to complain of.
            match bytes.get(at) {
                Some(_) if at + 4 <= bytes.len() => {
                    at += 1;
                    continue;
                }
                _ => return early("the picture itself"),
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
        early("the end of the picture")
    }
}

fn failed(error: DecodeErrors) -> Fault {
    match error {
        DecodeErrors::ExhaustedData => Fault::Early("the rest of the picture is missing".into()),
        other => {
            let reason = format!("{other:?}");
            Fault::Bad(format!("as JPEG it cannot be decoded: {}", reason.trim()))
        }
    }
}
