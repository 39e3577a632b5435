//! OpenEXR files: linear, any channels, half or single precision, scan lines in blocks that are compressed in parallel.

pub use super::options::{ExrCompression, ExrOptions, ExrSample};
use super::{
    Metadata,
    bands::{Bands, RowBuffer},
    deflate::{Deflater, End},
    exr_header,
    exr_stream::{FORMAT, ScanLineStream, failed},
    format::{FormatEntry, Written, into_file},
};
use crate::{Control, ImageError, RowSource, Size};
use ::exr::{
    block::{
        BlockIndex, UncompressedBlock,
        chunk::{CompressedBlock, CompressedScanLineBlock},
    },
    compression::Compression,
    math::Vec2,
    meta::header::Header,
};
use half::{f16, slice::HalfFloatSliceExt};
use std::{
    io::{Seek, Write},
    ops::Range,
    path::Path,
};

/// The format of this file's writer.
pub(super) static ENTRY: FormatEntry = FormatEntry {
    name: FORMAT,
    endings: &["exr"],
    is_linear: true,
    holds_alpha: true,
    holds_channels: true,
    clamping: "were brighter than half precision holds (65504) and are cut off there",
    describe: |options| match options.exr.sample {
        ExrSample::Float => "float EXR".to_owned(),
        ExrSample::Half => "half EXR".to_owned(),
    },
    write: |path, rgb, options, control| {
        write(
            path,
            rgb.size,
            &["R", "G", "B"],
            rgb.source,
            &options.exr,
            &options.metadata,
            control,
        )
    },
};

/// Effort of zip, 0 to 9: from here up files shrink by a few percent only, for half as much time again.
const ZIP_LEVEL: u8 = 2;

/// Writes rows to a file; `channels` names the values of a pixel in the order the source gives them.
///
/// # Errors
/// [`ImageError`]; the target is then as before.
pub fn write(
    path: &Path,
    size: Size,
    channels: &[&str],
    source: &dyn RowSource,
    options: &ExrOptions,
    metadata: &Metadata,
    control: Control<'_>,
) -> Result<Written, ImageError> {
    into_file(path, control, |out| {
        encode(out, size, channels, source, options, metadata, control)
    })
}

/// Writes rows to a stream. [`Written::bytes`] is left 0.
///
/// # Errors
/// [`ImageError`] where the names are not as many as the source's channels, one is empty, too long or there twice, the
/// stream fails, or the caller asks to stop.
pub fn encode<W: Write + Seek + Send>(
    out: &mut W,
    size: Size,
    channels: &[&str],
    source: &dyn RowSource,
    options: &ExrOptions,
    metadata: &Metadata,
    control: Control<'_>,
) -> Result<Written, ImageError> {
    check_channels(channels, source)?;
    let (header, order) = exr_header::build(size, channels, options, metadata)?;
    let lines = header.compression.scan_lines_per_block() as u32;
    let block_bytes = header.channels.bytes_per_pixel * size.width() as usize * lines as usize;
    let bands = Bands::of_rows(size, lines);
    let mut written = Written::default();
    let mut stream = ScanLineStream::start(out, &header)?;
    let encoder = BlockEncoder {
        source,
        size,
        order: &order,
        headers: std::slice::from_ref(&header),
        half: options.sample == ExrSample::Half,
    };
    // The block, sorted and packed; a row as given, split by channel and rounded.
    let band_bytes = block_bytes * 3 + size.width() as usize * channels.len() * 10;
    bands.run(
        band_bytes,
        control,
        |band| encoder.block(bands.rows(band)),
        |band, (packed, counts)| {
            written.clamped_samples += counts.clamped_samples;
            written.nan_samples += counts.nan_samples;
            stream.block(bands.rows(band).start, &packed)
        },
    )?;
    stream.finish()?;
    Ok(written)
}

fn check_channels(channels: &[&str], source: &dyn RowSource) -> Result<(), ImageError> {
    if channels.is_empty() || channels.len() != source.channels() {
        return Err(ImageError::Channels {
            format: "this EXR layout",
            expected: channels.len(),
            got: source.channels(),
        });
    }
    for (i, name) in channels.iter().enumerate() {
        let valid = (1..=255).contains(&name.len()) && !name.contains('\0');
        if !valid || channels[..i].contains(name) {
            return Err(ImageError::Setting {
                what: "each EXR channel name",
                got: format!("`{name}`"),
                right: "1 to 255 bytes long, and there once",
            });
        }
    }
    Ok(())
}

struct BlockEncoder<'a> {
    source: &'a dyn RowSource,
    size: Size,
    order: &'a [usize],
    headers: &'a [Header],
    half: bool,
}

impl BlockEncoder<'_> {
    /// The compressed block of these rows.
    fn block(&self, rows: Range<u32>) -> Result<(Vec<u8>, Written), ImageError> {
        let width = self.size.width() as usize;
        let pixel_bytes = self.headers[0].channels.bytes_per_pixel;
        let mut counts = Written::default();
        let mut data = Vec::with_capacity(width * rows.len() * pixel_bytes);
        let mut buffer = RowBuffer::new(self.source, self.size);
        let mut planes = vec![0.0; width * self.order.len()];
        let mut halves = vec![f16::ZERO; if self.half { planes.len() } else { 0 }];
        let largest = if self.half {
            f16::MAX.to_f32()
        } else {
            // Holds infinity: the depth of the sky, for one.
            f32::INFINITY
        };
        for y in rows.clone() {
            self.split_planes(buffer.row(y), &mut planes);
            for value in &mut planes {
                if value.is_nan() {
                    counts.nan_samples += 1;
                    *value = 0.0;
                } else if value.abs() > largest {
                    counts.clamped_samples += 1;
                    *value = value.clamp(-largest, largest);
                }
            }
            if self.half {
                halves.convert_from_f32_slice(&planes);
                data.extend(halves.iter().flat_map(|v| v.to_ne_bytes()));
            } else {
                data.extend(planes.iter().flat_map(|v| v.to_ne_bytes()));
            }
        }
        Ok((self.compress(data, &rows)?, counts))
    }

    /// From values pixel by pixel to values channel by channel, in the order of the file.
    fn split_planes(&self, row: &[f32], planes: &mut [f32]) {
        // Few enough pixels at a time that they stay in the cache while each channel is picked out.
        const PIXELS: usize = 256;
        let (width, count) = (self.size.width() as usize, self.order.len());
        for start in (0..width).step_by(PIXELS) {
            let end = (start + PIXELS).min(width);
            let pixels = &row[start * count..end * count];
            for (plane, &channel) in planes.chunks_mut(width).zip(self.order) {
                let values = pixels[channel..].iter().step_by(count);
                for (to, from) in plane[start..end].iter_mut().zip(values) {
                    *to = *from;
                }
            }
        }
    }

    fn compress(&self, data: Vec<u8>, rows: &Range<u32>) -> Result<Vec<u8>, ImageError> {
        let compression = self.headers[0].compression;
        let is_zip = matches!(compression, Compression::ZIP1 | Compression::ZIP16);
        if is_zip && cfg!(target_endian = "little") {
            return zip(data);
        }
        let block = UncompressedBlock {
            index: BlockIndex {
                layer: 0,
                pixel_position: Vec2(0, rows.start as usize),
                pixel_size: Vec2(self.size.width() as usize, rows.len()),
                level: Vec2(0, 0),
            },
            data,
        };
        match block
            .compress_to_chunk(self.headers)
            .map_err(failed)?
            .compressed_block
        {
            CompressedBlock::ScanLine(CompressedScanLineBlock {
                compressed_pixels_le,
                ..
            }) => Ok(compressed_pixels_le),
            _ => Err(ImageError::Encode {
                format: FORMAT,
                reason: "scan lines were packed as something else".to_owned(),
            }),
        }
    }
}

/// OpenEXR's zip: bytes of even place first, then those of odd place, each as its difference from the one before (plus
/// 128), then zlib. Data that would not shrink stay as they are.
fn zip(data: Vec<u8>) -> Result<Vec<u8>, ImageError> {
    let mut sorted: Vec<u8> = Vec::with_capacity(data.len());
    sorted.extend(data.iter().step_by(2));
    sorted.extend(data.iter().skip(1).step_by(2));
    // From the end, so that each byte still finds the one before it unchanged.
    for i in (1..sorted.len()).rev() {
        sorted[i] = sorted[i].wrapping_sub(sorted[i - 1]).wrapping_add(128);
    }
    let packed = Deflater::new(FORMAT, ZIP_LEVEL, true).piece(&sorted, End::Last)?;
    Ok(if packed.len() < data.len() {
        packed
    } else {
        data
    })
}
