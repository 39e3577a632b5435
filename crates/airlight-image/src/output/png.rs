//! PNG files: sRGB, 8 or 16 bits, with or without opacity. Bands are filtered and compressed in parallel, each on its own, and joined to one
//! stream.

pub use super::options::{PngDepth, PngOptions};
use super::{
    Metadata,
    bands::{Bands, RowBuffer},
    deflate::{Adler32, Deflater, End},
    format::{FormatEntry, Written, expect_channels, into_file},
    png_filter,
};
use crate::{Control, ImageError, RowSource, Size, tone::ToneMapper};
use png::{BitDepth, ColorType, chunk};
use std::{io::Write, path::Path};

const FORMAT: &str = "PNG";

/// The format of this file's writer.
pub(super) static ENTRY: FormatEntry = FormatEntry {
    name: FORMAT,
    endings: &["png"],
    is_linear: false,
    holds_alpha: true,
    holds_channels: false,
    clamping: "",
    describe: |_| FORMAT.to_owned(),
    write: |path, rgb, options, control| {
        let (png, metadata) = (&options.png, &options.metadata);
        write(path, rgb.size, rgb.source, rgb.tone, png, metadata, control)
    },
};

/// Writes linear RGB rows, as `tone` shows them, to a file. A fourth channel is opacity in `[0, 1]`: it is rounded,
/// without tone curve or dither, and colours are taken as not multiplied by it.
///
/// # Errors
/// [`ImageError`]; the target is then as before.
pub fn write(
    path: &Path,
    size: Size,
    source: &dyn RowSource,
    tone: &ToneMapper,
    options: &PngOptions,
    metadata: &Metadata,
    control: Control<'_>,
) -> Result<Written, ImageError> {
    into_file(path, control, |out| {
        encode(out, size, source, tone, options, metadata, control)
    })
}

/// Writes rows to a stream as [`write()`] does. [`Written::bytes`] is left 0.
///
/// # Errors
/// [`ImageError`] where the source has neither three channels nor four, a setting is out of range, the stream fails, or the caller
/// asks to stop.
pub fn encode<W: Write + Send>(
    out: &mut W,
    size: Size,
    source: &dyn RowSource,
    tone: &ToneMapper,
    options: &PngOptions,
    metadata: &Metadata,
    control: Control<'_>,
) -> Result<Written, ImageError> {
    let channels = source.channels();
    if channels != 4 {
        expect_channels(FORMAT, source, 3)?;
    }
    if options.compression_level > 9 {
        return Err(ImageError::Setting {
            what: "the PNG compression level",
            got: options.compression_level.to_string(),
            right: "0 to 9",
        });
    }
    let mut png = header(out, size, channels, options, metadata).map_err(failed)?;
    let bands = Bands::for_channels(size, channels, 1);
    let pixel_bytes = channels * options.depth.bytes();
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
    let step = source.channels() * depth.bytes();
    let mut rows = RowBuffer::new(source, size);
    let mut writer = RowBytes::new(tone, width, source.channels(), depth);
    let mut now = vec![0u8; width * step];
    let mut above = vec![0u8; width * step];
    let mut scratch = png_filter::Scratch::default();
    let mut filtered = Vec::with_capacity((width * step + 1) * bands.rows(band).len());
    for (index, y) in bands.rows(band).enumerate() {
        writer.write(y, rows.row(y), &mut now);
        let before = (index > 0).then_some(above.as_slice());
        png_filter::filter(&now, before, step, &mut scratch, &mut filtered);
        std::mem::swap(&mut now, &mut above);
    }
    filtered
}

/// Makes the bytes of rows.
struct RowBytes<'a> {
    tone: &'a ToneMapper,
    depth: PngDepth,
    has_alpha: bool,
    /// Colours without the opacity between them; empty where there is none.
    linear: Vec<f32>,
    narrow: Vec<u8>,
    wide: Vec<u16>,
}

impl<'a> RowBytes<'a> {
    fn new(tone: &'a ToneMapper, width: usize, channels: usize, depth: PngDepth) -> Self {
        let has_alpha = channels == 4;
        let of = |needed: bool| if needed { width * 3 } else { 0 };
        Self {
            tone,
            depth,
            has_alpha,
            linear: vec![0.0; of(has_alpha)],
            narrow: vec![0; of(has_alpha && depth == PngDepth::Eight)],
            wide: vec![0; of(depth == PngDepth::Sixteen)],
        }
    }

    fn write(&mut self, y: u32, row: &[f32], out: &mut [u8]) {
        // Not-a-number is transparent.
        let level = |alpha: f32, most: f32| alpha.clamp(0.0, 1.0) * most + 0.5;
        let linear = if self.has_alpha {
            let pixels = row.as_chunks::<4>().0;
            for (rgb, [r, g, b, _]) in self.linear.as_chunks_mut::<3>().0.iter_mut().zip(pixels) {
                *rgb = [*r, *g, *b];
            }
            &self.linear
        } else {
            row
        };
        match (self.depth, self.has_alpha) {
            (PngDepth::Eight, false) => self.tone.row_to_u8(y, linear, out),
            (PngDepth::Eight, true) => {
                self.tone.row_to_u8(y, linear, &mut self.narrow);
                let colours = self.narrow.as_chunks::<3>().0.iter();
                let alphas = row.as_chunks::<4>().0.iter();
                let pixels = out.as_chunks_mut::<4>().0.iter_mut();
                for ((pixel, &[r, g, b]), &[.., alpha]) in pixels.zip(colours).zip(alphas) {
                    *pixel = [r, g, b, level(alpha, 255.0) as u8];
                }
            }
            (PngDepth::Sixteen, false) => {
                self.tone.row_to_u16(linear, &mut self.wide);
                for (bytes, value) in out.as_chunks_mut::<2>().0.iter_mut().zip(&self.wide) {
                    *bytes = value.to_be_bytes();
                }
            }
            (PngDepth::Sixteen, true) => {
                self.tone.row_to_u16(linear, &mut self.wide);
                let colours = self.wide.as_chunks::<3>().0.iter();
                let alphas = row.as_chunks::<4>().0.iter();
                let pixels = out.as_chunks_mut::<8>().0.iter_mut();
                for ((pixel, &[r, g, b]), &[.., alpha]) in pixels.zip(colours).zip(alphas) {
                    let values = [r, g, b, level(alpha, 65535.0) as u16];
                    for (bytes, value) in pixel.as_chunks_mut::<2>().0.iter_mut().zip(values) {
                        *bytes = value.to_be_bytes();
                    }
                }
            }
        }
    }
}

fn header<'a, W: Write>(
    out: &'a mut W,
    size: Size,
    channels: usize,
    options: &PngOptions,
    metadata: &Metadata,
) -> Result<png::Writer<&'a mut W>, png::EncodingError> {
    let mut encoder = png::Encoder::new(out, size.width(), size.height());
    encoder.set_color(if channels == 4 {
        ColorType::Rgba
    } else {
        ColorType::Rgb
    });
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

fn failed(error: png::EncodingError) -> ImageError {
    match error {
        png::EncodingError::IoError(source) => ImageError::Stream {
            format: FORMAT,
            source,
        },
        other => ImageError::Encode {
            format: FORMAT,
            reason: other.to_string(),
        },
    }
}
