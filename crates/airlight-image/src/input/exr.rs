//! OpenEXR decoder: any channels of one part, placed in the display window as 32-bit floats.

use super::{
    depth::RawDepth,
    exr_channels,
    picture::{LightReference, Picture, REPAIRED, SampleBits, repair_colours, repair_opacity},
    source::{DecodeError, Source, TrackedFile, checked_size, sample_count, zeros},
};
use crate::{Size, output::Chromaticities};
use ::exr::{
    block::{
        UncompressedBlock,
        chunk::Chunk,
        reader::{ChunksReader, Reader},
    },
    error::Error as ExrError,
    math::Vec2,
    meta::{BlockDescription, MetaData, attribute::SampleType, header::Header},
};
use half::{f16, slice::HalfFloatSliceExt};
use rayon::prelude::*;
use std::io::BufReader;

/// Largest size in bytes of the blocks decoded together, unless a single one is larger.
const BATCH_BYTES: usize = 64 << 20;

/// Largest size of a block, bytes.
const BLOCK_BYTES: usize = 1 << 31;

/// Reads the colours of a layer, or of the file.
pub(super) fn read(source: Source, layer: Option<&str>) -> Result<Picture, DecodeError> {
    let file = ExrFile::open(source)?;
    let colours = exr_channels::colours(file.headers(), layer)?;
    let bits = file.bits(colours.part, &colours.rgb);
    let chromaticities = file.chromaticities(colours.part);
    let white_luminance_cd_m2 = file.white_luminance_cd_m2(colours.part);
    let mut groups: Vec<&[usize]> = vec![&colours.rgb];
    groups.extend(colours.alpha.as_ref().map(std::slice::from_ref));
    let loaded = file.load(colours.part, &groups, |group, samples| match group {
        0 => repair_colours(samples),
        _ => repair_opacity(samples),
    })?;
    let mut buffers = loaded.groups.into_iter();
    let rgb = buffers.next().unwrap_or_default();
    let mut picture = Picture {
        alpha: buffers.next(),
        chromaticities,
        white_luminance_cd_m2,
        ..Picture::new(loaded.size, rgb, LightReference::Scene, bits)
    };
    picture.notes.count(loaded.repaired, REPAIRED);
    Ok(picture)
}

/// Reads a depth channel.
pub(super) fn read_depth(source: Source, channel: Option<&str>) -> Result<RawDepth, DecodeError> {
    let file = ExrFile::open(source)?;
    let (part, channel) = exr_channels::depth(file.headers(), channel)?;
    let bits = file.bits(part, &[channel]);
    let loaded = file.load(part, &[&[channel]], |_, _| 0)?;
    Ok(RawDepth {
        size: loaded.size,
        values: loaded.groups.into_iter().next().unwrap_or_default(),
        bits,
    })
}

/// An EXR file after reading its header.
struct ExrFile {
    reader: Reader<BufReader<TrackedFile>>,
}

/// Samples of groups of channels.
struct Loaded {
    /// Size of the display window.
    size: Size,
    /// Interleaved channels of each group; 0 outside the data window.
    groups: Vec<Vec<f32>>,
    /// Number of repaired samples.
    repaired: u64,
}

impl ExrFile {
    fn open(source: Source) -> Result<Self, DecodeError> {
        let reader = Reader::read_from_buffered(source.reader, false).map_err(failed)?;
        Ok(Self { reader })
    }

    fn headers(&self) -> &[Header] {
        self.reader.headers()
    }

    /// Widest sample format of these channels.
    fn bits(&self, part: usize, channels: &[usize]) -> SampleBits {
        let list = &self.headers()[part].channels.list;
        let has = |kind| channels.iter().any(|&c| list[c].sample_type == kind);
        if has(SampleType::F32) {
            SampleBits::Float
        } else if has(SampleType::U32) {
            SampleBits::U32
        } else {
            SampleBits::Half
        }
    }

    /// Primaries and white point, where the file states them.
    fn chromaticities(&self, part: usize) -> Option<Chromaticities> {
        let c = self.headers()[part].shared_attributes.chromaticities?;
        Some(Chromaticities {
            red: [c.red.0, c.red.1],
            green: [c.green.0, c.green.1],
            blue: [c.blue.0, c.blue.1],
            white: [c.white.0, c.white.1],
        })
    }

    /// Luminance of red, green and blue of 1, cd/m^2, where the file states one above 0.
    fn white_luminance_cd_m2(&self, part: usize) -> Option<f32> {
        let stated = self.headers()[part].own_attributes.white_luminance?;
        (stated.is_finite() && stated > 0.0).then_some(stated)
    }

    /// Decodes groups of channels of one part. `repair` is called with the index of a group and blocks of its samples, and returns
    /// the number of samples it changed.
    fn load(
        self,
        part: usize,
        groups: &[&[usize]],
        repair: impl Fn(usize, &mut [f32]) -> u64 + Sync,
    ) -> Result<Loaded, DecodeError> {
        let header = &self.headers()[part];
        let window = header.shared_attributes.display_window;
        let size = checked_size(window.size.0 as u64, window.size.1 as u64)?;
        check(header)?;
        let position = header.own_attributes.layer_position;
        let layout = BlockLayout::new(header);
        let block_bytes = header.max_block_byte_size().max(1);
        let threads = rayon::current_num_threads().max(1);
        let batch = (BATCH_BYTES / block_bytes).clamp(1, threads * 4);
        let offset = WindowOffset {
            size,
            x: i64::from(position.0) - i64::from(window.position.0),
            y: i64::from(position.1) - i64::from(window.position.1),
        };
        let mut loaded = Loaded {
            size,
            groups: groups
                .iter()
                .map(|group| zeros(sample_count(size, group.len())))
                .collect::<Result<_, _>>()?,
            repaired: 0,
        };
        // Blocks of other parts are not read, but their offsets must be valid.
        self.headers().iter().try_for_each(check_tiles)?;
        let mut chunks = self
            .reader
            .filter_chunks(false, |_, _, block| {
                block.layer == part && block.level == Vec2(0, 0)
            })
            .map_err(failed)?;
        let meta = chunks.meta_data().clone();
        loop {
            let compressed: Vec<Chunk> = chunks
                .by_ref()
                .take(batch)
                .collect::<Result<_, _>>()
                .map_err(failed)?;
            if compressed.is_empty() {
                return Ok(loaded);
            }
            let blocks: Vec<Block> = compressed
                .into_par_iter()
                .map(|chunk| layout.decode(chunk, &meta, part, groups, &repair))
                .collect::<Result<_, _>>()?;
            for block in blocks {
                loaded.repaired += block.repaired;
                for ((whole, piece), group) in
                    loaded.groups.iter_mut().zip(&block.groups).zip(groups)
                {
                    offset.copy(&block, piece, whole, group.len());
                }
            }
        }
    }
}

/// Refuses files that cannot be decoded, or would need too much memory.
fn check(header: &Header) -> Result<(), DecodeError> {
    checked_size(header.layer_size.0 as u64, header.layer_size.1 as u64)?;
    check_tiles(header)?;
    if header.max_block_byte_size() > BLOCK_BYTES {
        return Err(DecodeError::invalid(
            "expected EXR blocks of at most 2 GiB, got larger ones",
        ));
    }
    let coarse =
        |channel: &&::exr::meta::attribute::ChannelDescription| channel.sampling != Vec2(1, 1);
    match header.channels.list.iter().find(coarse) {
        Some(channel) => Err(DecodeError::Invalid(format!(
            "expected a sample per pixel in each EXR channel, got a subsampled channel `{}` (such as chroma); try saving it as \
             R, G, B",
            channel.name
        ))),
        None => Ok(()),
    }
}

fn check_tiles(header: &Header) -> Result<(), DecodeError> {
    let fits = |n: usize| (1..=Size::MAX as usize).contains(&n);
    match header.blocks {
        BlockDescription::Tiles(tiles) if !fits(tiles.tile_size.0) || !fits(tiles.tile_size.1) => {
            Err(DecodeError::Invalid(format!(
                "expected EXR tiles of 1 to {2} pixels a side, got {0} x {1}",
                tiles.tile_size.0,
                tiles.tile_size.1,
                Size::MAX
            )))
        }
        _ => Ok(()),
    }
}

/// A decoded block.
struct Block {
    x: usize,
    y: usize,
    width: usize,
    height: usize,
    groups: Vec<Vec<f32>>,
    repaired: u64,
}

/// Positions of channels in the rows of a block.
struct BlockLayout {
    /// For each channel: bytes of a pixel before it, and its sample type.
    channels: Vec<(usize, SampleType)>,
    pixel_bytes: usize,
}

impl BlockLayout {
    fn new(header: &Header) -> Self {
        let mut pixel_bytes = 0;
        let channels = header
            .channels
            .list
            .iter()
            .map(|channel| {
                let before = pixel_bytes;
                pixel_bytes += channel.sample_type.bytes_per_sample();
                (before, channel.sample_type)
            })
            .collect();
        Self {
            channels,
            pixel_bytes,
        }
    }

    fn decode(
        &self,
        chunk: Chunk,
        meta: &MetaData,
        part: usize,
        groups: &[&[usize]],
        repair: &(impl Fn(usize, &mut [f32]) -> u64 + Sync),
    ) -> Result<Block, DecodeError> {
        let corrupt =
            || DecodeError::invalid("corrupt EXR data: a block does not match the header");
        if chunk.layer_index != part {
            return Err(corrupt());
        }
        let block = UncompressedBlock::decompress_chunk(chunk, meta, false).map_err(failed)?;
        let Vec2(width, height) = block.index.pixel_size;
        let row_bytes = width * self.pixel_bytes;
        if block.index.level != Vec2(0, 0) || block.data.len() != row_bytes * height {
            return Err(corrupt());
        }
        let mut repaired = 0;
        let mut decoded = Vec::with_capacity(groups.len());
        for (number, group) in groups.iter().enumerate() {
            let mut samples = vec![0.0; width * height * group.len()];
            let rows = samples.chunks_exact_mut((width * group.len()).max(1));
            let mut buffers = RowBuffers::new(width);
            for (row, data) in rows.zip(block.data.chunks_exact(row_bytes.max(1))) {
                for (c, &channel) in group.iter().enumerate() {
                    let (before, kind) = self.channels[channel];
                    let start = before * width;
                    let bytes = &data[start..start + width * kind.bytes_per_sample()];
                    buffers.convert(bytes, kind);
                    for (to, from) in row[c..]
                        .iter_mut()
                        .step_by(group.len())
                        .zip(&buffers.floats)
                    {
                        *to = *from;
                    }
                }
            }
            repaired += repair(number, &mut samples);
            decoded.push(samples);
        }
        Ok(Block {
            x: block.index.pixel_position.0,
            y: block.index.pixel_position.1,
            width,
            height,
            groups: decoded,
            repaired,
        })
    }
}

/// Buffers for a row of one channel.
struct RowBuffers {
    halves: Vec<f16>,
    floats: Vec<f32>,
}

impl RowBuffers {
    fn new(width: usize) -> Self {
        Self {
            halves: vec![f16::ZERO; width],
            floats: vec![0.0; width],
        }
    }

    fn convert(&mut self, bytes: &[u8], kind: SampleType) {
        let fours = bytes.as_chunks::<4>().0.iter();
        match kind {
            SampleType::F16 => {
                for (half, two) in self.halves.iter_mut().zip(bytes.as_chunks::<2>().0) {
                    *half = f16::from_ne_bytes(*two);
                }
                self.halves.convert_to_f32_slice(&mut self.floats);
            }
            SampleType::F32 => {
                for (value, four) in self.floats.iter_mut().zip(fours) {
                    *value = f32::from_ne_bytes(*four);
                }
            }
            SampleType::U32 => {
                for (value, four) in self.floats.iter_mut().zip(fours) {
                    *value = u32::from_ne_bytes(*four) as f32;
                }
            }
        }
    }
}

/// Position of the data window in the display window.
struct WindowOffset {
    size: Size,
    x: i64,
    y: i64,
}

impl WindowOffset {
    /// Copies the part of a block inside the picture, `channels` samples a pixel.
    fn copy(&self, block: &Block, from: &[f32], to: &mut [f32], channels: usize) {
        let (width, height) = (self.size.width() as usize, self.size.height() as usize);
        // Columns of the block inside the picture.
        let left = self.x + block.x as i64;
        let first = left.min(0).unsigned_abs() as usize;
        let start = left.max(0) as usize;
        let count = block
            .width
            .saturating_sub(first)
            .min(width.saturating_sub(start));
        if count == 0 {
            return;
        }
        for (row, samples) in from.chunks_exact(block.width * channels).enumerate() {
            let y = self.y + (block.y + row) as i64;
            if row < block.height && (0..height as i64).contains(&y) {
                let at = (y as usize * width + start) * channels;
                to[at..at + count * channels]
                    .copy_from_slice(&samples[first * channels..(first + count) * channels]);
            }
        }
    }
}

fn failed(error: ExrError) -> DecodeError {
    match error {
        ExrError::Io(error) => DecodeError::Io(error),
        ExrError::NotSupported(what) => {
            DecodeError::Invalid(format!("unsupported EXR file: {what}"))
        }
        ExrError::Invalid(what) => DecodeError::Invalid(format!("corrupt EXR data: {what}")),
        ExrError::Aborted => DecodeError::invalid("decoding stopped"),
    }
}
