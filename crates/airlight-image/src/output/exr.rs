//! OpenEXR files: linear, any channels, half or single precision, scan lines in blocks that are compressed in parallel.
//!
//! The `exr` crate describes headers and compresses blocks; the file itself is written here, block after block, so that a picture
//! is never in memory as a whole, except for channels carried from another file. Attributes are sorted by name, so that equal pictures give equal bytes.

pub use super::exr_join::join;
pub use super::options::{ExrCompression, ExrOptions, SamplePrecision};
use super::{
    Metadata,
    bands::{Bands, RowBuffer},
    carried::CarriedChannel,
    deflate::{Deflater, End},
    format::{FormatEntry, Written, into_file},
};
use crate::{Control, ImageError, RowSource, Size};
use ::exr::{
    block::{
        BlockIndex, UncompressedBlock,
        chunk::{CompressedBlock, CompressedScanLineBlock},
    },
    compression::Compression,
    error::Error as ExrError,
    math::Vec2,
    meta::{
        BlockDescription, MetaData,
        attribute::{
            self, AttributeValue, ChannelDescription, Chromaticities, LineOrder, SampleType, Text,
        },
        header::{Header, LayerAttributes},
    },
};
use half::{f16, slice::HalfFloatSliceExt};
use std::{
    collections::HashSet,
    io::{self, Seek, SeekFrom, Write},
    ops::Range,
    path::Path,
};

pub(super) const FORMAT: &str = "OpenEXR";

/// Registry entry of the format.
pub(super) static ENTRY: FormatEntry = FormatEntry {
    name: FORMAT,
    endings: &["exr"],
    is_linear: true,
    holds_alpha: true,
    holds_channels: true,
    clamping: "were brighter than half precision holds (65504) and are cut off there",
    describe: |options| match options.exr.precision {
        SamplePrecision::Float => "float EXR".to_owned(),
        SamplePrecision::Half => "half EXR".to_owned(),
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

/// Zip compression level, 0 to 9: higher levels shrink files by a few percent and take half as much time again.
const ZIP_LEVEL: u8 = 2;

/// Writes rows to a file. `channels` names the samples of a pixel in the order of the source.
///
/// # Errors
/// [`ImageError`]; the target is then unchanged.
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

/// A stream that an EXR file can be written to: the table of offsets is filled in at the end.
pub trait WriteSeek: Write + Seek + Send {}

impl<T: Write + Seek + Send> WriteSeek for T {}

/// Writes rows to a stream as [`write()`] does; [`Written::bytes`] stays 0.
///
/// # Errors
/// [`ImageError`] where the number of names is not that of the source's channels, a name is empty, too long or repeated, the
/// stream fails, or the caller cancels.
pub fn encode(
    out: &mut dyn WriteSeek,
    size: Size,
    channels: &[&str],
    source: &dyn RowSource,
    options: &ExrOptions,
    metadata: &Metadata,
    control: Control<'_>,
) -> Result<Written, ImageError> {
    let carried = metadata.carried.as_deref();
    let carried = carried.map_or(&[][..], |carried| &carried.channels);
    check_channels(channels, carried, source)?;
    let (header, order) = build_header(size, channels, options, metadata)?;
    let lines = header.compression.scan_lines_per_block() as u32;
    let block_bytes = header.channels.bytes_per_pixel * size.width() as usize * lines as usize;
    let bands = Bands::of_rows(size, lines);
    let mut written = Written::default();
    let mut stream = ScanLineStream::start(out, &header)?;
    let encoder = BlockEncoder {
        source,
        size,
        order: &order,
        carried,
        headers: std::slice::from_ref(&header),
        half: options.precision == SamplePrecision::Half,
    };
    // The block raw, sorted and compressed; a row interleaved, split by channel and rounded.
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

fn check_channels(
    channels: &[&str],
    carried: &[CarriedChannel],
    source: &dyn RowSource,
) -> Result<(), ImageError> {
    let carried = |name: &str| {
        let mut names = carried.iter().map(|channel| &channel.description.name);
        names.any(|carried| carried.as_slice() == name.as_bytes())
    };
    if channels.is_empty() || channels.len() != source.channels() {
        return Err(ImageError::Channels {
            format: "the EXR channel list",
            expected: channels.len(),
            got: source.channels(),
        });
    }
    for (i, name) in channels.iter().enumerate() {
        let valid = (1..=255).contains(&name.len()) && !name.contains('\0');
        if !valid || channels[..i].contains(name) || carried(name) {
            return Err(ImageError::Setting {
                what: "each EXR channel name",
                got: format!("`{name}`"),
                right: "1 to 255 bytes long and unique",
            });
        }
    }
    Ok(())
}

/// Size in bytes of a block of 16 or 32 scan lines above which single lines are compressed, to bound memory.
const MAX_BLOCK: usize = 16 << 20;

/// Where the samples of a channel of the file come from.
#[derive(Clone, Copy)]
enum ChannelSource {
    /// A plane of [`BlockEncoder::planes`].
    Plane(usize),
    Carried(usize),
}

/// The channels of a file, sorted by name.
struct ChannelOrder {
    all: Vec<ChannelSource>,
    /// Index in a pixel of the source for each plane.
    planes: Vec<usize>,
}

/// The header, and the sources of its channels.
fn build_header(
    size: Size,
    channels: &[&str],
    options: &ExrOptions,
    metadata: &Metadata,
) -> Result<(Header, ChannelOrder), ImageError> {
    let sample = match options.precision {
        SamplePrecision::Half => SampleType::F16,
        SamplePrecision::Float => SampleType::F32,
    };
    let carried = metadata.carried.as_deref();
    let described = channels
        .iter()
        .map(|name| ChannelDescription::named(text(name), sample))
        .zip((0..).map(ChannelSource::Plane));
    let also = carried.into_iter().flat_map(|carried| &carried.channels);
    let also = also
        .map(|channel| channel.description.clone())
        .zip((0..).map(ChannelSource::Carried));
    let mut sorted: Vec<_> = described.chain(also).collect();
    sorted.sort_by(|(a, _), (b, _)| a.name.as_slice().cmp(b.name.as_slice()));
    let mut order = ChannelOrder {
        all: Vec::new(),
        planes: Vec::new(),
    };
    for (_, source) in &sorted {
        order.all.push(match *source {
            ChannelSource::Plane(channel) => {
                order.planes.push(channel);
                ChannelSource::Plane(order.planes.len() - 1)
            }
            carried => carried,
        });
    }
    let sizes = sorted
        .iter()
        .map(|(channel, _)| channel.sample_type.bytes_per_sample());
    let pixel_bytes: usize = sizes.sum();
    let list = sorted.into_iter().map(|(channel, _)| channel).collect();
    let bytes_per_line = size.width() as usize * pixel_bytes;
    let compression = match options.compression {
        ExrCompression::None => Compression::Uncompressed,
        ExrCompression::Rle => Compression::RLE,
        ExrCompression::Zips => Compression::ZIP1,
        ExrCompression::Zip if bytes_per_line * 16 > MAX_BLOCK => Compression::ZIP1,
        ExrCompression::Zip => Compression::ZIP16,
        ExrCompression::Piz if bytes_per_line * 32 > MAX_BLOCK => Compression::ZIP1,
        ExrCompression::Piz => Compression::PIZ,
    };
    let dimensions = Vec2(size.width() as usize, size.height() as usize);
    let mut header = Header::new(text("main"), dimensions, list)
        .with_encoding(
            compression,
            BlockDescription::ScanLines,
            LineOrder::Increasing,
        )
        .with_attributes(attributes(metadata));
    let point = |p: [f32; 2]| Vec2(p[0], p[1]);
    header.shared_attributes.pixel_aspect = metadata.pixel_aspect.unwrap_or(1.0);
    if let Some(carried) = carried {
        carried.set_shared(&mut header);
    }
    if let Some(band) = metadata.band {
        let end = band.first_row.checked_add(size.height());
        if end.is_none_or(|end| end > band.picture_rows) {
            return Err(ImageError::Setting {
                what: "the last row of a band",
                got: format!("{} + {}", band.first_row, size.height()),
                right: "at most the number of rows of the picture",
            });
        }
        header.own_attributes.layer_position.1 += band.first_row as i32;
        header.shared_attributes.display_window.size.1 = band.picture_rows as usize;
    }
    header.shared_attributes.chromaticities = metadata.chromaticities.map(|c| Chromaticities {
        red: point(c.red),
        green: point(c.green),
        blue: point(c.blue),
        white: point(c.white),
    });
    let taken: HashSet<Vec<u8>> = header
        .all_named_attributes()
        .map(|(name, _)| name.to_vec())
        .collect();
    for (name, value) in &metadata.texts {
        let name = attribute_name(name, &taken);
        header
            .own_attributes
            .other
            .insert(text(&name), AttributeValue::Text(text(value)));
    }
    Ok((header, order))
}

fn attributes(metadata: &Metadata) -> LayerAttributes {
    let words = |words: &Option<String>| words.as_deref().map(text);
    let carried = metadata.carried.as_deref();
    let carried = carried.map_or_else(LayerAttributes::default, |carried| {
        carried.attributes.clone()
    });
    LayerAttributes {
        owner: words(&metadata.owner).or(carried.owner),
        comments: words(&metadata.comments).or(carried.comments),
        capture_date: words(&metadata.capture_date).or(carried.capture_date),
        software_name: words(&metadata.software).or(carried.software_name),
        // OpenEXR: UTC = local time + offset.
        utc_offset: metadata.utc_offset_s.map(|s| -s).or(carried.utc_offset),
        latitude: metadata.latitude_deg.or(carried.latitude),
        longitude: metadata.longitude_deg.or(carried.longitude),
        altitude: metadata.altitude_m.or(carried.altitude),
        white_luminance: metadata.white_luminance_cd_m2,
        adopted_neutral: metadata
            .chromaticities
            .and_then(|stated| stated.stated_neutral())
            .map(|[x, y]| Vec2(x, y)),
        ..carried
    }
}

/// A name or text in UTF-8, without null bytes, which terminate names.
fn text(words: &str) -> Text {
    Text::from_bytes_unchecked(words.bytes().filter(|&b| b != 0).collect())
}

/// A name of 1 to 255 bytes that differs from those of standard attributes.
fn attribute_name(name: &str, taken: &HashSet<Vec<u8>>) -> String {
    let mut end = name.len().min(240);
    while !name.is_char_boundary(end) {
        end -= 1;
    }
    let name = &name[..end];
    let reserved = ::exr::meta::header::standard_names::ALL.contains(&name.as_bytes());
    if name.is_empty() || reserved || taken.contains(name.as_bytes()) {
        format!("airlight:{name}")
    } else {
        name.to_owned()
    }
}

struct BlockEncoder<'a> {
    source: &'a dyn RowSource,
    size: Size,
    order: &'a ChannelOrder,
    carried: &'a [CarriedChannel],
    headers: &'a [Header],
    half: bool,
}

impl BlockEncoder<'_> {
    /// Compresses a block of rows.
    fn block(&self, rows: Range<u32>) -> Result<(Vec<u8>, Written), ImageError> {
        let width = self.size.width() as usize;
        let pixel_bytes = self.headers[0].channels.bytes_per_pixel;
        let mut counts = Written::default();
        let mut data = Vec::with_capacity(width * rows.len() * pixel_bytes);
        let mut buffer = RowBuffer::new(self.source, self.size);
        let mut planes = vec![0.0; width * self.order.planes.len()];
        let mut halves = vec![f16::ZERO; if self.half { planes.len() } else { 0 }];
        let largest = if self.half {
            f16::MAX.to_f32()
        } else {
            // Infinity is valid: the depth of the sky.
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
            }
            for source in &self.order.all {
                match *source {
                    ChannelSource::Plane(n) if self.half => {
                        let plane = &halves[n * width..(n + 1) * width];
                        data.extend(plane.iter().flat_map(|v| v.to_ne_bytes()));
                    }
                    ChannelSource::Plane(n) => {
                        let plane = &planes[n * width..(n + 1) * width];
                        data.extend(plane.iter().flat_map(|v| v.to_ne_bytes()));
                    }
                    ChannelSource::Carried(n) => {
                        data.extend_from_slice(self.carried[n].row(y, width));
                    }
                }
            }
        }
        Ok((self.compress(data, &rows)?, counts))
    }

    /// Splits interleaved samples by channel, in the order of the file.
    fn split_planes(&self, row: &[f32], planes: &mut [f32]) {
        // Few enough pixels at a time to stay in the cache while each channel is copied.
        const PIXELS: usize = 256;
        let (width, count) = (self.size.width() as usize, self.order.planes.len());
        for start in (0..width).step_by(PIXELS) {
            let end = (start + PIXELS).min(width);
            let pixels = &row[start * count..end * count];
            for (plane, &channel) in planes.chunks_mut(width).zip(&self.order.planes) {
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
                reason: "the compressor returned no scan lines".to_owned(),
            }),
        }
    }
}

/// OpenEXR's zip compression: bytes at even positions, then those at odd positions, as differences from the previous byte (plus
/// 128), then zlib. Data that would not shrink stay uncompressed.
fn zip(data: Vec<u8>) -> Result<Vec<u8>, ImageError> {
    let mut sorted: Vec<u8> = Vec::with_capacity(data.len());
    sorted.extend(data.iter().step_by(2));
    sorted.extend(data.iter().skip(1).step_by(2));
    // From the end, so that the previous byte is still unchanged.
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

/// Magic number of OpenEXR files.
const MAGIC: [u8; 4] = [0x76, 0x2f, 0x31, 0x01];

/// File format version 2, single part, scan lines.
const VERSION: u32 = 2;

/// Flag of files in which a name is longer than 31 bytes.
const LONG_NAMES: u32 = 1 << 10;

/// A scan-line file being written: header, table of offsets, blocks in order.
pub(super) struct ScanLineStream<'a> {
    out: &'a mut dyn WriteSeek,
    /// First row of the data window.
    top: i32,
    table_at: u64,
    next_at: u64,
    offsets: Vec<u64>,
}

impl<'a> ScanLineStream<'a> {
    /// Writes the header and an empty table.
    pub(super) fn start(out: &'a mut dyn WriteSeek, header: &Header) -> Result<Self, ImageError> {
        MetaData::validate(std::slice::from_ref(header), true).map_err(failed)?;
        let bytes = header_bytes(header)?;
        let start = out.stream_position().map_err(stream_error)?;
        out.write_all(&bytes).map_err(stream_error)?;
        let table_at = start + bytes.len() as u64;
        let table = vec![0; header.chunk_count * 8];
        out.write_all(&table).map_err(stream_error)?;
        Ok(Self {
            out,
            top: header.own_attributes.layer_position.y(),
            table_at,
            next_at: table_at + table.len() as u64,
            offsets: Vec::with_capacity(header.chunk_count),
        })
    }

    /// Writes the compressed block that starts with row `y`.
    pub(super) fn block(&mut self, y: u32, packed: &[u8]) -> Result<(), ImageError> {
        let length = i32::try_from(packed.len()).map_err(|_| ImageError::Encode {
            format: FORMAT,
            reason: "a block of scan lines is larger than 2 GiB".to_owned(),
        })?;
        self.offsets.push(self.next_at);
        self.next_at += 8 + packed.len() as u64;
        let mut write = |bytes: &[u8]| self.out.write_all(bytes).map_err(stream_error);
        write(&self.top.saturating_add(y as i32).to_le_bytes())?;
        write(&length.to_le_bytes())?;
        write(packed)
    }

    /// Writes the table.
    pub(super) fn finish(self) -> Result<(), ImageError> {
        let table: Vec<u8> = self.offsets.iter().flat_map(|o| o.to_le_bytes()).collect();
        self.out
            .seek(SeekFrom::Start(self.table_at))
            .map_err(stream_error)?;
        self.out.write_all(&table).map_err(stream_error)?;
        self.out
            .seek(SeekFrom::Start(self.next_at))
            .map_err(stream_error)?;
        self.out.flush().map_err(stream_error)
    }
}

fn header_bytes(header: &Header) -> Result<Vec<u8>, ImageError> {
    let mut attributes: Vec<_> = header.all_named_attributes().collect();
    attributes.sort_by_key(|(name, _)| *name);
    let channel_names = header.channels.list.iter().map(|c| c.name.as_slice().len());
    let attribute_names = attributes.iter().map(|(name, _)| name.len());
    let long_names = channel_names
        .chain(attribute_names)
        .any(|length| length > 31);
    let version = if long_names {
        VERSION | LONG_NAMES
    } else {
        VERSION
    };
    let mut bytes = Vec::from(MAGIC);
    bytes.extend_from_slice(&version.to_le_bytes());
    for (name, value) in &attributes {
        attribute::write(name, value, &mut bytes).map_err(failed)?;
    }
    bytes.push(0);
    Ok(bytes)
}

fn failed(error: ExrError) -> ImageError {
    match error {
        ExrError::Io(source) => ImageError::Stream {
            format: FORMAT,
            source,
        },
        other => ImageError::Encode {
            format: FORMAT,
            reason: other.to_string(),
        },
    }
}

fn stream_error(source: io::Error) -> ImageError {
    ImageError::Stream {
        format: FORMAT,
        source,
    }
}
