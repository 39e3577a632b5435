//! JPEG decoder: baseline and progressive, grey or colour.

use super::{
    colour::ColourDecoding,
    exif::Exif,
    picture::{LightReference, Picture, SampleBits},
    source::{DecodeError, Source, checked_size, reserve, sample_count},
};
use crate::{Control, Notes, Size};
use std::io;
use zune_core::{
    bytestream::{ZByteIoError, ZByteReaderTrait, ZCursor, ZSeekFrom},
    colorspace::ColorSpace,
    options::DecoderOptions,
};
use zune_jpeg::{JpegDecoder, errors::DecodeErrors};

pub(super) fn read(mut source: Source<'_>) -> Result<Picture, DecodeError> {
    let bytes = source.read_to_end()?;
    check_encoding(&bytes)?;
    require_end(&bytes)?;
    let pixel_aspect = pixel_aspect(&bytes).unwrap_or(1.0);
    let options = DecoderOptions::default()
        .set_max_width(Size::MAX as usize)
        .set_max_height(Size::MAX as usize);
    let control = source.control();
    let bytes = TrackedBytes::new(bytes, control);
    let mut decoder = JpegDecoder::new_with_options(bytes, options);
    decoder.decode_headers().map_err(failed)?;
    let info = decoder
        .info()
        .ok_or_else(|| DecodeError::invalid("expected a JPEG header, got none"))?;
    let size = checked_size(u64::from(info.width), u64::from(info.height))?;
    let is_grey = matches!(decoder.input_colorspace(), Some(ColorSpace::Luma));
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
    let exif = decoder.exif().map(|exif| Exif::parse(exif));
    let exif = exif.unwrap_or_default();
    let mut notes = Notes::default();
    let decoding = match decoder.icc_profile() {
        Some(profile) => ColourDecoding::from_icc(&profile, if is_grey { 1 } else { 3 })
            .unwrap_or_else(|reason| {
                notes.add(format!("ICC profile ignored: {reason}"));
                ColourDecoding::srgb()
            }),
        None if exif.is_adobe_rgb => ColourDecoding::adobe_rgb(),
        None => ColourDecoding::srgb(),
    };
    let table = decoding.table(256);
    let mut rgb = reserve(sample_count(size, 3))?;
    let mut decoded = vec![0; count];
    decoder.decode_into(&mut decoded).map_err(failed)?;
    // The decoder takes an end of the bytes for missing data, which it replaces.
    control.check().map_err(io::Error::other)?;
    // An array, as every byte is a valid index of it.
    let mut light = [0.0; 256];
    light
        .iter_mut()
        .zip(table.iter())
        .for_each(|(light, v)| *light = *v);
    let light = |v: u8| light[usize::from(v)];
    if is_grey {
        rgb.extend(decoded.iter().flat_map(|&v| [light(v); 3]));
    } else {
        rgb.extend(decoded.iter().map(|&v| light(v)));
    }
    decoding.finish(&mut rgb).map_err(DecodeError::Invalid)?;
    let mut picture = Picture {
        pixel_aspect: Picture::checked_aspect(pixel_aspect),
        notes,
        ..Picture::new(size, rgb, LightReference::Display, SampleBits::U8)
    };
    picture.note_conversion(decoding.name());
    Ok(picture.turned(exif.orientation))
}

/// Bytes of a file in memory that end once the caller has cancelled.
struct TrackedBytes<'a> {
    bytes: ZCursor<Vec<u8>>,
    control: Control<'a>,
    reads: u32,
}

impl<'a> TrackedBytes<'a> {
    /// Reads of a few bytes between two looks at the control: well below a millisecond.
    const INTERVAL: u32 = 4096;

    fn new(bytes: Vec<u8>, control: Control<'a>) -> Self {
        Self {
            bytes: ZCursor::new(bytes),
            control,
            reads: 0,
        }
    }

    #[inline(always)]
    fn check(&mut self) -> Result<(), ZByteIoError> {
        self.reads += 1;
        match self.reads >= Self::INTERVAL {
            true => self.look(),
            false => Ok(()),
        }
    }

    /// Begins to count again only where the caller goes on, so that all later reads fail otherwise.
    #[cold]
    fn look(&mut self) -> Result<(), ZByteIoError> {
        self.control
            .check()
            .map_err(|_| ZByteIoError::Generic("cancelled"))?;
        self.reads = 0;
        Ok(())
    }
}

impl ZByteReaderTrait for TrackedBytes<'_> {
    #[inline(always)]
    fn read_byte_no_error(&mut self) -> u8 {
        self.bytes.read_byte_no_error()
    }

    #[inline(always)]
    fn read_exact_bytes(&mut self, buffer: &mut [u8]) -> Result<(), ZByteIoError> {
        self.check()?;
        self.bytes.read_exact_bytes(buffer)
    }

    fn read_bytes(&mut self, buffer: &mut [u8]) -> Result<usize, ZByteIoError> {
        self.check()?;
        self.bytes.read_bytes(buffer)
    }

    fn peek_bytes(&mut self, buffer: &mut [u8]) -> Result<usize, ZByteIoError> {
        self.bytes.peek_bytes(buffer)
    }

    fn peek_exact_bytes(&mut self, buffer: &mut [u8]) -> Result<(), ZByteIoError> {
        self.bytes.peek_exact_bytes(buffer)
    }

    fn z_seek(&mut self, to: ZSeekFrom) -> Result<u64, ZByteIoError> {
        self.bytes.z_seek(to)
    }

    #[inline(always)]
    fn is_eof(&mut self) -> Result<bool, ZByteIoError> {
        self.check()?;
        self.bytes.is_eof()
    }

    fn z_position(&mut self) -> Result<u64, ZByteIoError> {
        self.bytes.z_position()
    }

    fn read_remaining(&mut self, rest: &mut Vec<u8>) -> Result<usize, ZByteIoError> {
        self.bytes.read_remaining(rest)
    }
}

/// Width of a pixel over its height, by the densities of the JFIF header: pixels per unit, of which wide ones are few.
fn pixel_aspect(bytes: &[u8]) -> Option<f32> {
    // Marker, length, name, version, unit, horizontal and vertical density.
    let at = segment(bytes, |marker| marker == 0xe0)?;
    let header = bytes.get(at..at + 16)?;
    let density = |at: usize| f32::from(u16::from_be_bytes([header[at], header[at + 1]]));
    (header[4..9] == *b"JFIF\0").then(|| density(14) / density(12))
}

/// Refuses kinds of JPEG that are not decoded, by the marker and the header of the frame.
fn check_encoding(bytes: &[u8]) -> Result<(), DecodeError> {
    let Some(at) = segment(bytes, |marker| {
        matches!(marker, 0xc0..=0xcf) && !matches!(marker, 0xc4 | 0xc8 | 0xcc)
    }) else {
        return Ok(());
    };
    let refuse = |kind: &str, advice: &str| {
        Err(DecodeError::Invalid(format!(
            "expected a baseline or progressive JPEG of 8 bits, grey or colour, got {kind}; try saving it as {advice}"
        )))
    };
    let (bits, components) = (bytes.get(at + 4), bytes.get(at + 9));
    match bytes[at + 1] {
        0xc3 | 0xc7 | 0xcb | 0xcf => return refuse("lossless compression", "PNG"),
        0xc9..=0xcf => return refuse("arithmetic coding", "baseline JPEG"),
        0xc5..=0xc7 => return refuse("a hierarchical one", "baseline JPEG"),
        _ => {}
    }
    if bits.is_some_and(|&bits| bits != 8) {
        return refuse("12 bits", "16-bit PNG");
    }
    match components {
        Some(4) => refuse("CMYK", "RGB"),
        Some(1 | 3) | None => Ok(()),
        Some(count) => refuse(&format!("{count} components"), "RGB"),
    }
}

/// Position of the first segment before the first scan whose marker `is_wanted`.
fn segment(bytes: &[u8], is_wanted: impl Fn(u8) -> bool) -> Option<usize> {
    // After the start marker: segments of a marker and a length that includes itself.
    let mut at = 2;
    loop {
        let &[first, marker, high, low] = bytes.get(at..at + 4)? else {
            return None;
        };
        if first != 0xff {
            // Corrupt data, which the decoder reports.
            at += 1;
            continue;
        }
        if is_wanted(marker) {
            return Some(at);
        }
        match marker {
            // The scan.
            0xda => return None,
            // Fill bytes and markers without a length.
            0x00 | 0x01 | 0xff | 0xd0..=0xd8 => at += 1,
            _ => at += 2 + usize::from(u16::from_be_bytes([high, low])),
        }
    }
}

/// Refuses a file without an end marker after its first scan: the decoder would fill in missing pixels.
fn require_end(bytes: &[u8]) -> Result<(), DecodeError> {
    let early = |what: &str| Err(DecodeError::Truncated(format!("{what} is missing")));
    let Some(at) = segment(bytes, |marker| marker == 0xda) else {
        return early("the image data");
    };
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
