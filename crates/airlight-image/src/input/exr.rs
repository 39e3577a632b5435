//! OpenEXR files: any channels of one part, brought to the display window as 32-bit floats.

use super::{
    fault::{Fault, checked_size, samples, zeros},
    picture::SampleBits,
    source::{Source, Watched},
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

/// The most bytes that blocks being decoded together may take, unless a single one takes more.
const BATCH_BYTES: usize = 64 << 20;

/// The most bytes of one block.
const BLOCK_BYTES: usize = 1 << 31;

/// An EXR file whose header has been read.
pub(super) struct ExrFile {
    reader: Reader<BufReader<Watched>>,
}

/// Samples of groups of channels.
pub(super) struct Loaded {
    /// Of the display window.
    pub(super) size: Size,
    /// For each group its channels, interleaved; 0 outside the data window.
    pub(super) groups: Vec<Vec<f32>>,
    /// Sum of what mending returned.
    pub(super) mended: u64,
}

impl ExrFile {
    pub(super) fn open(source: Source) -> Result<Self, Fault> {
        let reader = Reader::read_from_buffered(source.reader, false).map_err(failed)?;
        Ok(Self { reader })
    }

    pub(super) fn headers(&self) -> &[Header] {
        self.reader.headers()
    }

    /// How the widest of these channels is stored.
    pub(super) fn bits(&self, part: usize, channels: &[usize]) -> SampleBits {
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

    /// Primaries and white, where the file states them.
    pub(super) fn chromaticities(&self, part: usize) -> Option<Chromaticities> {
        let c = self.headers()[part].shared_attributes.chromaticities?;
        Some(Chromaticities {
            red: [c.red.0, c.red.1],
            green: [c.green.0, c.green.1],
            blue: [c.blue.0, c.blue.1],
            white: [c.white.0, c.white.1],
        })
    }

    /// The luminance of a value of 1 (red, green and blue), cd/m^2, where the file states one above 0.
    pub(super) fn white_luminance_cd_m2(&self, part: usize) -> Option<f32> {
        let stated = self.headers()[part].own_attributes.white_luminance?;
        (stated.is_finite() && stated > 0.0).then_some(stated)
    }

    /// Decodes groups of channels of one part; `mend` is given the number of the group and pieces of its samples.
    pub(super) fn load(
        self,
        part: usize,
        groups: &[&[usize]],
        mend: impl Fn(usize, &mut [f32]) -> u64 + Sync,
    ) -> Result<Loaded, Fault> {
        let header = &self.headers()[part];
        let window = header.shared_attributes.display_window;
        let size = checked_size(window.size.0 as u64, window.size.1 as u64)?;
        check(header)?;
        let position = header.own_attributes.layer_position;
        let layout = Layout::new(header);
        let block_bytes = header.max_block_byte_size().max(1);
        let threads = rayon::current_num_threads().max(1);
        let batch = (BATCH_BYTES / block_bytes).clamp(1, threads * 4);
        let place = Place {
            size,
            x: i64::from(position.0) - i64::from(window.position.0),
            y: i64::from(position.1) - i64::from(window.position.1),
        };
        let mut loaded = Loaded {
            size,
            groups: groups
                .iter()
                .map(|group| zeros(samples(size, group.len())))
                .collect::<Result<_, _>>()?,
            mended: 0,
        };
        // Nothing reads other parts' blocks, but their offsets must make sense.
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
                .map(|chunk| layout.decode(chunk, &meta, part, groups, &mend))
                .collect::<Result<_, _>>()?;
            for block in blocks {
                loaded.mended += block.mended;
                for ((whole, piece), group) in
                    loaded.groups.iter_mut().zip(&block.groups).zip(groups)
                {
                    place.copy(&block, piece, whole, group.len());
                }
            }
        }
    }
}

/// Refuses what cannot be decoded, or would need absurd amounts of memory.
fn check(header: &Header) -> Result<(), Fault> {
    checked_size(header.layer_size.0 as u64, header.layer_size.1 as u64)?;
    check_tiles(header)?;
    if header.max_block_byte_size() > BLOCK_BYTES {
        return Err(Fault::bad("as EXR it has blocks of more than 2 GiB"));
    }
    let coarse =
        |channel: &&::exr::meta::attribute::ChannelDescription| channel.sampling != Vec2(1, 1);
    match header.channels.list.iter().find(coarse) {
        Some(channel) => Err(Fault::Bad(format!(
            "its channel `{}` has fewer samples than the picture has pixels (as luminance with chroma has), which is \
             not read: save it as R, G, B",
            channel.name
        ))),
        None => Ok(()),
    }
}

fn check_tiles(header: &Header) -> Result<(), Fault> {
    let fits = |n: usize| (1..=Size::MAX as usize).contains(&n);
    match header.blocks {
        BlockDescription::Tiles(tiles) if !fits(tiles.tile_size.0) || !fits(tiles.tile_size.1) => {
            Err(Fault::Bad(format!(
                "as EXR it has tiles of {} x {} pixels, which must be 1 to {} a side",
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
    mended: u64,
}

/// Where channels lie in the rows of a block.
struct Layout {
    /// Of each channel: bytes of a pixel before it, and its kind.
    channels: Vec<(usize, SampleType)>,
    pixel_bytes: usize,
}

impl Layout {
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
        mend: &(impl Fn(usize, &mut [f32]) -> u64 + Sync),
    ) -> Result<Block, Fault> {
        let corrupt = || Fault::bad("as EXR it is corrupt: a block is not what was announced");
        if chunk.layer_index != part {
            return Err(corrupt());
        }
        let block = UncompressedBlock::decompress_chunk(chunk, meta, false).map_err(failed)?;
        let Vec2(width, height) = block.index.pixel_size;
        let row_bytes = width * self.pixel_bytes;
        if block.index.level != Vec2(0, 0) || block.data.len() != row_bytes * height {
            return Err(corrupt());
        }
        let mut mended = 0;
        let mut decoded = Vec::with_capacity(groups.len());
        for (number, group) in groups.iter().enumerate() {
            let mut samples = vec![0.0; width * height * group.len()];
            let rows = samples.chunks_exact_mut((width * group.len()).max(1));
            let mut scratch = Scratch::new(width);
            for (row, data) in rows.zip(block.data.chunks_exact(row_bytes.max(1))) {
                for (c, &channel) in group.iter().enumerate() {
                    let (before, kind) = self.channels[channel];
                    let start = before * width;
                    let bytes = &data[start..start + width * kind.bytes_per_sample()];
                    scratch.convert(bytes, kind);
                    for (to, from) in row[c..]
                        .iter_mut()
                        .step_by(group.len())
                        .zip(&scratch.floats)
                    {
                        *to = *from;
                    }
                }
            }
            mended += mend(number, &mut samples);
            decoded.push(samples);
        }
        Ok(Block {
            x: block.index.pixel_position.0,
            y: block.index.pixel_position.1,
            width,
            height,
            groups: decoded,
            mended,
        })
    }
}

/// A row of one channel.
struct Scratch {
    halves: Vec<f16>,
    floats: Vec<f32>,
}

impl Scratch {
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

/// Where the data window lies in the display window.
struct Place {
    size: Size,
    x: i64,
    y: i64,
}

impl Place {
    /// Copies what of a block lies in the picture, `each` samples a pixel.
    fn copy(&self, block: &Block, from: &[f32], to: &mut [f32], each: usize) {
        let (width, height) = (self.size.width() as usize, self.size.height() as usize);
        // Columns of the block that are in the picture.
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
        for (row, samples) in from.chunks_exact(block.width * each).enumerate() {
            let y = self.y + (block.y + row) as i64;
            if row < block.height && (0..height as i64).contains(&y) {
                let at = (y as usize * width + start) * each;
                to[at..at + count * each]
                    .copy_from_slice(&samples[first * each..(first + count) * each]);
            }
        }
    }
}

fn failed(error: ExrError) -> Fault {
    match error {
        ExrError::Io(error) => Fault::Io(error),
        ExrError::NotSupported(what) => {
            Fault::Bad(format!("as EXR it is of a kind that is not read: {what}"))
        }
        ExrError::Invalid(what) => Fault::Bad(format!("as EXR it is corrupt: {what}")),
        ExrError::Aborted => Fault::bad("decoding stopped"),
    }
}
