//! Blocks of EXR files: from compressed bytes to samples, subsampled channels included.

use super::source::DecodeError;
use ::exr::{
    block::{
        UncompressedBlock,
        chunk::{Chunk, CompressedBlock},
    },
    error::Error as ExrError,
    math::Vec2,
    meta::{MetaData, attribute::SampleType, header::Header},
};
use half::{f16, slice::HalfFloatSliceExt};

/// A decoded block.
pub(super) struct Block {
    pub(super) x: usize,
    pub(super) y: usize,
    pub(super) width: usize,
    pub(super) height: usize,
    /// Interleaved channels of each group. Rows that a subsampled channel does not have are 0.
    pub(super) groups: Vec<Vec<f32>>,
    /// Channels in their sample formats.
    pub(super) raw: Vec<Vec<u8>>,
    pub(super) repaired: u64,
}

/// Positions of channels in the rows of the blocks of a part.
pub(super) struct BlockLayout {
    part: usize,
    channels: Vec<Channel>,
    /// Upper left corner of the data window.
    corner: (i64, i64),
    size: Vec2<usize>,
    lines_per_block: usize,
    is_subsampled: bool,
}

/// Sample format of a channel, and distance of its samples in pixels.
struct Channel {
    kind: SampleType,
    sampling: (usize, usize),
}

/// Headers for decompression. The library expects blocks of a whole number of bytes a pixel: with subsampled channels that number
/// depends on the rows of a block.
pub(super) struct DecodingHeaders(Vec<(usize, MetaData)>);

impl BlockLayout {
    pub(super) fn new(
        header: &Header,
        part: usize,
        sampling: &[Vec2<usize>],
    ) -> Result<Self, DecodeError> {
        let channels = header.channels.list.iter().zip(sampling);
        let channels: Vec<Channel> = channels
            .map(|(channel, sampling)| Channel {
                kind: channel.sample_type,
                sampling: (sampling.0, sampling.1),
            })
            .collect();
        let is_subsampled = channels.iter().any(|channel| channel.sampling != (1, 1));
        let position = header.own_attributes.layer_position;
        let layout = Self {
            part,
            channels,
            corner: (position.0.into(), position.1.into()),
            size: header.layer_size,
            lines_per_block: header.compression.scan_lines_per_block(),
            is_subsampled,
        };
        let is_tiled = header.blocks != ::exr::meta::BlockDescription::ScanLines;
        if is_subsampled && (is_tiled || !layout.is_regular()) {
            return Err(DecodeError::invalid(
                "expected subsampled EXR channels (such as chroma) in scan lines whose size is a multiple of their sampling, got \
                 others; try saving it as R, G, B",
            ));
        }
        Ok(layout)
    }

    /// Whether subsampled channels fit the data window, as OpenEXR demands.
    fn is_regular(&self) -> bool {
        let fits = |corner: i64, size: usize, step: usize| {
            (1..=64).contains(&step)
                && corner.rem_euclid(step as i64) == 0
                && size.is_multiple_of(step)
        };
        self.channels.iter().all(|channel| {
            fits(self.corner.0, self.size.0, channel.sampling.0)
                && fits(self.corner.1, self.size.1, channel.sampling.1)
        })
    }

    /// Horizontal and vertical distance of the samples of a channel, pixels.
    pub(super) fn sampling(&self, channel: usize) -> (usize, usize) {
        self.channels[channel].sampling
    }

    /// Height of the data window.
    pub(super) fn height(&self) -> usize {
        self.size.1
    }

    /// Bytes of a sample of a channel.
    pub(super) fn sample_bytes(&self, channel: usize) -> usize {
        self.channels[channel].kind.bytes_per_sample()
    }

    /// Whether a channel has samples in a row, counted from the top of the data window.
    pub(super) fn has_row(&self, channel: usize, row: i64) -> bool {
        row.rem_euclid(self.channels[channel].sampling.1 as i64) == 0
    }

    /// Bytes of a row of a channel in blocks of this width.
    fn row_bytes(&self, channel: usize, row: usize, width: usize) -> usize {
        match self.has_row(channel, row as i64) {
            true => width / self.channels[channel].sampling.0 * self.sample_bytes(channel),
            false => 0,
        }
    }

    fn block_bytes(&self, first_row: usize, width: usize, height: usize) -> usize {
        let rows = first_row..first_row + height;
        rows.flat_map(|row| (0..self.channels.len()).map(move |c| (row, c)))
            .map(|(row, c)| self.row_bytes(c, row, width))
            .sum()
    }

    /// The headers by which the blocks of the part are decompressed.
    pub(super) fn decoding_headers(&self, meta: &MetaData) -> DecodingHeaders {
        let usual = meta.headers[self.part].channels.bytes_per_pixel;
        if !self.is_subsampled {
            return DecodingHeaders(vec![(usual, meta.clone())]);
        }
        let mut headers: Vec<(usize, MetaData)> = Vec::new();
        for first in (0..self.size.1).step_by(self.lines_per_block.max(1)) {
            let bytes = self.pixel_bytes(first);
            if headers.iter().all(|(known, _)| *known != bytes) {
                let mut meta = meta.clone();
                let list = &mut meta.headers[self.part].channels;
                list.bytes_per_pixel = bytes;
                for (description, channel) in list.list.iter_mut().zip(&self.channels) {
                    description.sampling = Vec2(channel.sampling.0, channel.sampling.1);
                }
                headers.push((bytes, meta));
            }
        }
        DecodingHeaders(headers)
    }

    /// Bytes a pixel of the block of scan lines that begins with a row.
    fn pixel_bytes(&self, first: usize) -> usize {
        let height = self.lines_per_block.min(self.size.1 - first);
        self.block_bytes(first, self.size.0, height) / (self.size.0 * height).max(1)
    }

    /// Decodes a block; `repair` is called with the index of a group and its samples, and returns the number of samples it changed.
    pub(super) fn decode(
        &self,
        chunk: Chunk,
        headers: &DecodingHeaders,
        groups: &[&[usize]],
        raw: &[usize],
        repair: &(impl Fn(usize, &mut [f32]) -> u64 + Sync),
    ) -> Result<Block, DecodeError> {
        let corrupt =
            || DecodeError::invalid("corrupt EXR data: a block does not match the header");
        if chunk.layer_index != self.part {
            return Err(corrupt());
        }
        let pixel_bytes = match &chunk.compressed_block {
            CompressedBlock::ScanLine(block) if self.is_subsampled => {
                let first = i64::from(block.y_coordinate) - self.corner.1;
                let first = usize::try_from(first).map_err(|_| corrupt())?;
                if first >= self.size.1 {
                    return Err(corrupt());
                }
                self.pixel_bytes(first)
            }
            _ => headers.0.first().map_or(0, |(bytes, _)| *bytes),
        };
        let meta = headers.0.iter().find(|(bytes, _)| *bytes == pixel_bytes);
        let (_, meta) = meta.ok_or_else(corrupt)?;
        let block = UncompressedBlock::decompress_chunk(chunk, meta, false).map_err(failed)?;
        let Vec2(width, height) = block.index.pixel_size;
        let (x, y) = (block.index.pixel_position.0, block.index.pixel_position.1);
        let complete = block.data.len() == self.block_bytes(y, width, height);
        if block.index.level != Vec2(0, 0) || !complete {
            return Err(corrupt());
        }
        // Where each channel begins in each row.
        let mut starts = vec![0; height * self.channels.len()];
        let mut at = 0;
        for (row, starts) in starts.chunks_exact_mut(self.channels.len()).enumerate() {
            for (c, start) in starts.iter_mut().enumerate() {
                *start = at;
                at += self.row_bytes(c, y + row, width);
            }
        }
        let bytes_of = |row: usize, c: usize| {
            let start = starts[row * self.channels.len() + c];
            &block.data[start..start + self.row_bytes(c, y + row, width)]
        };
        let mut repaired = 0;
        let mut decoded = Vec::with_capacity(groups.len());
        for (number, group) in groups.iter().enumerate() {
            let mut samples = vec![0.0; width * height * group.len()];
            let rows = samples.chunks_exact_mut((width * group.len()).max(1));
            let mut buffers = RowBuffers::new(width);
            for (row, samples) in rows.enumerate() {
                for (c, &channel) in group.iter().enumerate() {
                    let bytes = bytes_of(row, channel);
                    if bytes.is_empty() {
                        continue;
                    }
                    let Channel { kind, sampling } = self.channels[channel];
                    buffers.convert(bytes, kind);
                    buffers.enlarge(sampling.0);
                    for (to, from) in samples[c..]
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
        let copied = raw.iter().map(|&channel| {
            let rows = (0..height).flat_map(|row| bytes_of(row, channel));
            rows.copied().collect()
        });
        Ok(Block {
            x,
            y,
            width,
            height,
            raw: copied.collect(),
            groups: decoded,
            repaired,
        })
    }
}

/// Sets the sampling of all channels in the headers of a file to every pixel.
///
/// # Errors
/// [`DecodeError`] where the headers are corrupt.
pub(super) fn hide_sampling(file: &mut [u8]) -> Result<(), DecodeError> {
    let corrupt = || DecodeError::invalid("corrupt EXR data: the header ends too early");
    let text_end = |file: &[u8], at: usize| {
        let rest = file.get(at..).ok_or_else(corrupt)?;
        let length = rest.iter().position(|&b| b == 0).ok_or_else(corrupt)?;
        Ok::<usize, DecodeError>(at + length)
    };
    // After the magic number and the version: attributes of a name, a type, a length and a value. An empty name ends a header,
    // another one ends the headers of a file with several parts.
    let mut at = 8;
    loop {
        let name_end = text_end(file, at)?;
        if name_end == at {
            if matches!(file.get(at + 1), None | Some(0)) || file[4..8][1] & 0x10 == 0 {
                return Ok(());
            }
            at += 1;
            continue;
        }
        let kind_end = text_end(file, name_end + 1)?;
        let is_list = file[name_end + 1..kind_end] == *b"chlist";
        let length = file.get(kind_end + 1..kind_end + 5).ok_or_else(corrupt)?;
        let length = length.first_chunk().ok_or_else(corrupt)?;
        let value = kind_end + 5;
        let end = value + u32::from_le_bytes(*length) as usize;
        let mut channel = value;
        while is_list && file.get(channel).ok_or_else(corrupt)? != &0 {
            // Name, sample type, linearity with padding, horizontal and vertical sampling.
            let sampling = text_end(file, channel)? + 1 + 8;
            let both = file.get_mut(sampling..sampling + 8).ok_or_else(corrupt)?;
            both.copy_from_slice(&[1, 0, 0, 0, 1, 0, 0, 0]);
            channel = sampling + 8;
        }
        at = end;
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

    /// Interpolates samples that are `step` pixels apart, the first at the first pixel, to every pixel.
    fn enlarge(&mut self, step: usize) {
        if step == 1 {
            return;
        }
        let last = (self.floats.len() / step).max(1) - 1;
        // From the end, so that samples are read before they are replaced.
        for x in (0..self.floats.len()).rev() {
            let (before, part) = (x / step, (x % step) as f32 / step as f32);
            let (a, b) = (self.floats[before], self.floats[(before + 1).min(last)]);
            self.floats[x] = if before == last {
                a
            } else {
                a + (b - a) * part
            };
        }
    }
}

pub(super) fn failed(error: ExrError) -> DecodeError {
    match error {
        ExrError::Io(error) => DecodeError::Io(error),
        ExrError::NotSupported(what) => {
            DecodeError::Invalid(format!("unsupported EXR file: {what}"))
        }
        ExrError::Invalid(what) => DecodeError::Invalid(format!("corrupt EXR data: {what}")),
        ExrError::Aborted => DecodeError::invalid("decoding stopped"),
    }
}
