//! PNG files: sRGB, 8 or 16 bits. Bands are filtered and compressed in parallel, each on its own, and joined to one
//! stream.

use super::{
    Metadata, Written,
    bands::{Bands, RowBuffer},
    deflate::{Adler32, Deflater, End},
    expect_channels, into_file, png_filter,
};
use crate::{Control, RenderError, RowSource, Size, tone::ToneMapper};
use png::{BitDepth, ColorType, chunk};
use std::{io::Write, path::Path};

const FORMAT: &str = "PNG";

/// Bits of a component.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Hash)]
pub enum PngDepth {
    /// 8 bits, dithered unless the tone mapper says otherwise.
    #[default]
    Eight,
    /// 16 bits.
    Sixteen,
}

/// Settings of PNG files.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct PngOptions {
    /// Bits of a component.
    pub depth: PngDepth,
    /// Effort of compression: 0 stores, 1 is fastest, 9 smallest; from 3 up little is gained.
    pub compression_level: u8,
}

impl Default for PngOptions {
    fn default() -> Self {
        Self {
            depth: PngDepth::Eight,
            compression_level: 3,
        }
    }
}

/// Writes linear RGB rows, as `tone` shows them, to a file.
///
/// # Errors
/// [`RenderError`]; the target is then as before.
pub fn write(
    path: &Path,
    size: Size,
    source: &dyn RowSource,
    tone: &ToneMapper,
    options: &PngOptions,
    metadata: &Metadata,
    control: Control<'_>,
) -> Result<Written, RenderError> {
    into_file(path, control, |out| {
        encode(out, size, source, tone, options, metadata, control)
    })
}

/// Writes linear RGB rows, as `tone` shows them, to a stream. [`Written::bytes`] is left 0.
///
/// # Errors
/// [`RenderError`] where the source has not three channels, a setting is out of range, the stream fails, or the caller
/// asks to stop.
pub fn encode<W: Write + Send>(
    out: &mut W,
    size: Size,
    source: &dyn RowSource,
    tone: &ToneMapper,
    options: &PngOptions,
    metadata: &Metadata,
    control: Control<'_>,
) -> Result<Written, RenderError> {
    expect_channels(FORMAT, source, 3)?;
    if options.compression_level > 9 {
        return Err(RenderError::Setting {
            what: "the PNG compression level",
            got: options.compression_level.to_string(),
            right: "0 to 9",
        });
    }
    let mut png = header(out, size, options, metadata).map_err(failed)?;
    let bands = Bands::for_channels(size, 3, 1);
    let pixel_bytes = match options.depth {
        PngDepth::Eight => 3,
        PngDepth::Sixteen => 6,
    };
    let row_bytes = size.width() as usize * pixel_bytes;
    let mut checksum = Adler32::EMPTY;
    let last = bands.count() - 1;
    bands.run(
        row_bytes * 3 * bands.rows(0).len(),
        control,
        |band| {
            let filtered = filtered_band(source, tone, size, options.depth, bands, band);
            let end = if band == last { End::Last } else { End::Open };
            let packed =
                Deflater::new(FORMAT, options.compression_level, false).piece(&filtered, end)?;
            Ok((packed, Adler32::of(&filtered), filtered.len()))
        },
        |band, (packed, part, length)| {
            checksum = checksum.then(part, length);
            let mut data = Vec::with_capacity(packed.len() + 6);
            if band == 0 {
                // Deflate with a window of 32 KiB; header checksum included.
                data.extend_from_slice(&[0x78, 0x01]);
            }
            data.extend_from_slice(&packed);
            if band == last {
                data.extend_from_slice(&checksum.value().to_be_bytes());
            }
            png.write_chunk(chunk::IDAT, &data).map_err(failed)
        },
    )?;
    png.finish().map_err(failed)?;
    Ok(Written::default())
}

/// The rows of a band, tone mapped and filtered. The first row's guesses look only to the left, so that each band
/// stands by itself.
fn filtered_band(
    source: &dyn RowSource,
    tone: &ToneMapper,
    size: Size,
    depth: PngDepth,
    bands: Bands,
    band: u32,
) -> Vec<u8> {
    let width = size.width() as usize;
    let step = match depth {
        PngDepth::Eight => 3,
        PngDepth::Sixteen => 6,
    };
    let mut rows = RowBuffer::new(source, size);
    let mut wide = vec![
        0u16;
        if depth == PngDepth::Sixteen {
            width * 3
        } else {
            0
        }
    ];
    let mut now = vec![0u8; width * step];
    let mut above = vec![0u8; width * step];
    let mut scratch = png_filter::Scratch::default();
    let mut filtered = Vec::with_capacity((width * step + 1) * bands.rows(band).len());
    for (index, y) in bands.rows(band).enumerate() {
        let linear = rows.row(y);
        match depth {
            PngDepth::Eight => tone.row_to_u8(y, linear, &mut now),
            PngDepth::Sixteen => {
                tone.row_to_u16(linear, &mut wide);
                for (bytes, value) in now.as_chunks_mut::<2>().0.iter_mut().zip(&wide) {
                    *bytes = value.to_be_bytes();
                }
            }
        }
        let before = (index > 0).then_some(above.as_slice());
        png_filter::filter(&now, before, step, &mut scratch, &mut filtered);
        std::mem::swap(&mut now, &mut above);
    }
    filtered
}

fn header<'a, W: Write>(
    out: &'a mut W,
    size: Size,
    options: &PngOptions,
    metadata: &Metadata,
) -> Result<png::Writer<&'a mut W>, png::EncodingError> {
    let mut encoder = png::Encoder::new(out, size.width(), size.height());
    encoder.set_color(ColorType::Rgb);
    encoder.set_depth(match options.depth {
        PngDepth::Eight => BitDepth::Eight,
        PngDepth::Sixteen => BitDepth::Sixteen,
    });
    encoder.set_source_srgb(png::SrgbRenderingIntent::Perceptual);
    for (name, text) in metadata.as_texts() {
        // Keywords hold 1 to 79 Latin characters.
        let keyword: String = name
            .chars()
            .map(|c| {
                if c.is_ascii_graphic() || c == ' ' {
                    c
                } else {
                    '_'
                }
            })
            .take(79)
            .collect();
        if keyword.trim().is_empty() {
            continue;
        }
        let text = text.replace('\0', " ");
        if text.is_ascii() {
            encoder.add_text_chunk(keyword.trim().to_owned(), text)?;
        } else {
            encoder.add_itxt_chunk(keyword.trim().to_owned(), text)?;
        }
    }
    let mut writer = encoder.write_header()?;
    // Primaries of BT.709, sRGB transfer function, RGB, full range.
    writer.write_chunk(chunk::cICP, &[1, 13, 0, 1])?;
    Ok(writer)
}

fn failed(error: png::EncodingError) -> RenderError {
    match error {
        png::EncodingError::IoError(source) => RenderError::Stream {
            format: FORMAT,
            source,
        },
        other => RenderError::Encode {
            format: FORMAT,
            reason: other.to_string(),
        },
    }
}
