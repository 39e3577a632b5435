//! PNG files: sRGB, 8 or 16 bits, with or without opacity. Bands of rows are filtered and compressed independently in parallel, and
//! joined to one stream.

pub use super::options::{PngDepth, PngOptions};
use super::{
    Metadata,
    bands::{Bands, RowBuffer},
    deflate::{Adler32, Deflater, End},
    format::{FormatEntry, Written, expect_channels, into_file},
    run_huffman,
};
use crate::{Control, ImageError, RowSource, Size, tone::ToneMapper};
use png::{BitDepth, ColorType, PixelDimensions, Unit, chunk};
use std::{io::Write, path::Path};

const FORMAT: &str = "PNG";

/// Compression level of [`run_huffman`].
const FASTEST: u8 = 1;

/// Whether repetitions of more than a byte are found. Web pages do without that code, and compress as at level 1.
const HAS_DEFLATER: bool = !cfg!(target_arch = "wasm32");

/// Registry entry of the format.
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

/// Writes linear RGB rows, tone mapped by `tone`, to a file. A fourth channel is opacity in `[0, 1]`: it is rounded
/// without tone curve or dither; colours are not premultiplied by it.
///
/// # Errors
/// [`ImageError`]; the target is then unchanged.
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

/// Writes rows to a stream as [`write()`] does; [`Written::bytes`] stays 0.
///
/// # Errors
/// [`ImageError`] where the source has neither three nor four channels, a setting is out of range, the metadata state other
/// primaries than those of sRGB, the stream fails, or the caller cancels.
pub fn encode(
    out: &mut (dyn Write + Send),
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
    metadata.require_srgb(FORMAT)?;
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
            let packed = match options.compression_level {
                level if HAS_DEFLATER && level != FASTEST => {
                    Deflater::new(FORMAT, level, false).piece(&filtered, end)?
                }
                _ => run_huffman::compress(&filtered, end),
            };
            Ok((packed, Adler32::of(&filtered), filtered.len()))
        },
        |band, (packed, part, length)| {
            checksum = checksum.then(part, length);
            let mut data = Vec::with_capacity(packed.len() + 6);
            if band == 0 {
                // zlib header: deflate with a window of 32 KiB.
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

/// The rows of a band, tone mapped and filtered. The first row is predicted from its left neighbours only, so that bands are
/// independent.
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
    let mut buffers = FilterBuffers::default();
    let mut filtered = Vec::with_capacity((width * step + 1) * bands.rows(band).len());
    for (index, y) in bands.rows(band).enumerate() {
        writer.write(y, rows.row(y), &mut now);
        let before = (index > 0).then_some(above.as_slice());
        filter_row(&now, before, step, &mut buffers, &mut filtered);
        std::mem::swap(&mut now, &mut above);
    }
    filtered
}

/// Filters a row (PNG specification, clause 9: each byte as its difference from a prediction) by each method and keeps the one
/// whose differences have the least sum of magnitudes, as the specification recommends. `above` is the previous row, if the
/// prediction may use it; `step` is the number of bytes of a pixel.
///
/// Appends the number of the method and the filtered bytes to `out`.
fn filter_row(
    row: &[u8],
    above: Option<&[u8]>,
    step: usize,
    buffers: &mut FilterBuffers,
    out: &mut Vec<u8>,
) {
    let step = step.min(row.len());
    buffers.best.resize(row.len(), 0);
    buffers.candidate.resize(row.len(), 0);
    left(row, step, &mut buffers.best);
    let mut method = 1;
    let mut least = cost(&buffers.best);
    if let Some(above) = above {
        let methods: [(u8, Method); 3] = [(2, up), (3, average), (4, paeth)];
        for (number, apply) in methods {
            apply(row, above, step, &mut buffers.candidate);
            let sum = cost(&buffers.candidate);
            if sum < least {
                least = sum;
                method = number;
                std::mem::swap(&mut buffers.best, &mut buffers.candidate);
            }
        }
    }
    out.push(method);
    out.extend_from_slice(&buffers.best);
}

type Method = fn(&[u8], &[u8], usize, &mut [u8]);

/// Buffers reused from row to row.
#[derive(Default)]
struct FilterBuffers {
    best: Vec<u8>,
    candidate: Vec<u8>,
}

/// Sum of the magnitudes of the differences as signed bytes.
fn cost(filtered: &[u8]) -> u64 {
    filtered
        .chunks(4096)
        .map(|part| {
            let sum: u32 = part
                .iter()
                .map(|&b| u32::from((b as i8).unsigned_abs()))
                .sum();
            u64::from(sum)
        })
        .sum()
}

fn left(row: &[u8], step: usize, out: &mut [u8]) {
    out[..step].copy_from_slice(&row[..step]);
    for ((out, now), before) in out[step..].iter_mut().zip(&row[step..]).zip(row) {
        *out = now.wrapping_sub(*before);
    }
}

fn up(row: &[u8], above: &[u8], _step: usize, out: &mut [u8]) {
    for ((out, now), above) in out.iter_mut().zip(row).zip(above) {
        *out = now.wrapping_sub(*above);
    }
}

fn average(row: &[u8], above: &[u8], step: usize, out: &mut [u8]) {
    for i in 0..step {
        out[i] = row[i].wrapping_sub(above[i] / 2);
    }
    let neighbours = row.iter().zip(&above[step..]);
    for ((out, now), (&a, &b)) in out[step..].iter_mut().zip(&row[step..]).zip(neighbours) {
        // The mean, rounded down.
        *out = now.wrapping_sub((a & b) + ((a ^ b) >> 1));
    }
}

fn paeth(row: &[u8], above: &[u8], step: usize, out: &mut [u8]) {
    for i in 0..step {
        out[i] = row[i].wrapping_sub(above[i]);
    }
    let neighbours = row.iter().zip(&above[step..]).zip(above);
    for ((out, now), ((&a, &b), &c)) in out[step..].iter_mut().zip(&row[step..]).zip(neighbours) {
        // The neighbour nearest to a + b - c; ties go to left, then above.
        let (x, y, z) = (i16::from(a), i16::from(b), i16::from(c));
        let (to_a, to_b, to_c) = ((y - z).abs(), (x - z).abs(), (x + y - 2 * z).abs());
        let nearer = if to_b <= to_c { b } else { c };
        let guess = if to_a <= to_b && to_a <= to_c {
            a
        } else {
            nearer
        };
        *out = now.wrapping_sub(guess);
    }
}

/// Converts rows to bytes.
struct RowBytes<'a> {
    tone: &'a ToneMapper,
    depth: PngDepth,
    has_alpha: bool,
    /// Colours without opacity; empty where there is none.
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
        // NaN is transparent.
        let level = |alpha: f32, max: f32| alpha.clamp(0.0, 1.0) * max + 0.5;
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

fn header<'a>(
    out: &'a mut (dyn Write + Send),
    size: Size,
    channels: usize,
    options: &PngOptions,
    metadata: &Metadata,
) -> Result<png::Writer<&'a mut (dyn Write + Send)>, png::EncodingError> {
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
    if let Some(aspect) = metadata.pixel_aspect.filter(|aspect| *aspect != 1.0) {
        encoder.set_pixel_dims(Some(PixelDimensions {
            xppu: 10_000,
            yppu: (aspect * 10_000.0).round() as u32,
            unit: Unit::Unspecified,
        }));
    }
    encoder.set_source_srgb(png::SrgbRenderingIntent::Perceptual);
    for (name, text) in metadata.as_texts() {
        // Keywords have 1 to 79 Latin characters.
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
