//! OpenEXR decoder: any channels of one part, placed in the display window as 32-bit floats or as they are.

use super::{
    depth::{self, DepthOptions, RawDepth},
    exr_blocks::{self, Block, BlockLayout, failed},
    exr_channels::{self, ExrLayer},
    picture::{LightReference, Picture, REPAIRED, SampleBits, repair_colours, repair_opacity},
    source::{DecodeError, Source, TrackedFile, checked_size, sample_count, zeros},
};
use crate::{
    Notes, Size,
    output::{Carried, Chromaticities},
};
use ::exr::{
    block::{
        chunk::Chunk,
        reader::{ChunksReader, Reader},
    },
    math::Vec2,
    meta::{
        BlockDescription, MetaData,
        attribute::{ChannelDescription, SampleType},
        header::Header,
    },
};
use airlight::spectrum::RgbSpace;
use rayon::prelude::*;
use std::{
    io::{BufReader, Seek},
    sync::Arc,
};

/// Largest size in bytes of the blocks decoded together, unless a single one is larger.
const BATCH_BYTES: usize = 64 << 20;

/// Largest size of a block, bytes.
const BLOCK_BYTES: usize = 1 << 31;

/// Reads the colours of a layer, or of the file.
pub(super) fn read(source: Source<'_>, layer: Option<&str>) -> Result<Picture, DecodeError> {
    let file = ExrFile::open(source)?;
    let colours = exr_channels::colours(file.headers(), layer)?;
    let part = colours.part;
    let bits = file.bits(part, &colours.rgb);
    let header = &file.headers()[part];
    let stated = file.chromaticities(part);
    let chromaticities = stated.filter(|stated| stated.to_linear_srgb().is_some());
    let white_luminance_cd_m2 = file.white_luminance_cd_m2(part);
    let aspect = header.shared_attributes.pixel_aspect;
    let mut carried = Carried::of_header(header);
    let others: Vec<usize> = (0..header.channels.list.len())
        .filter(|c| !colours.rgb.contains(c) && Some(*c) != colours.alpha)
        .collect();
    let (others, coarse): (Vec<usize>, Vec<usize>) = others
        .into_iter()
        .partition(|&c| file.sampling[part][c] == Vec2(1, 1));
    let descriptions: Vec<ChannelDescription> = others
        .iter()
        .map(|&c| header.channels.list[c].clone())
        .collect();
    let mut notes = Notes::default();
    if chromaticities != stated {
        notes.add("impossible chromaticities ignored");
    }
    notes.count(
        coarse.len() as u64,
        "subsampled channels besides the colours left out",
    );
    let depth = exr_channels::depth(file.headers(), None, Some(&colours.layer)).ok();
    let unused = (0..file.headers().len())
        .filter(|&other| other != part && depth.as_ref().is_none_or(|found| other != found.0))
        .count();
    notes.count(unused as u64, "other parts of the file left out");
    let (cut, whole) = (header.layer_size, header.shared_attributes.display_window);
    let corner = header.own_attributes.layer_position - whole.position;
    let far = corner + Vec2(cut.0 as i32, cut.1 as i32);
    if corner.0 < 0 || corner.1 < 0 || far.0 > whole.size.0 as i32 || far.1 > whole.size.1 as i32 {
        notes.add("pixels outside the display window left out");
    }
    let mut groups: Vec<&[usize]> = vec![&colours.rgb];
    groups.extend(colours.alpha.as_ref().map(std::slice::from_ref));
    let loaded = file.load(part, &groups, &others, |group, samples| match group {
        0 => repair_colours(samples),
        _ => repair_opacity(samples),
    })?;
    let mut buffers = loaded.groups.into_iter();
    let mut rgb = buffers.next().unwrap_or_default();
    if colours.is_luma_chroma {
        let primaries = chromaticities.unwrap_or(RgbSpace::Srgb.into());
        from_luma_chroma(&mut rgb, primaries.luminance_weights());
        notes.add("colours converted from luminance and chroma (Y, RY, BY)");
    }
    for (description, bytes) in descriptions.iter().zip(loaded.raw) {
        carried.add_channel(description, bytes);
    }
    notes.count(loaded.repaired, REPAIRED);
    Ok(Picture {
        alpha: buffers.next(),
        chromaticities,
        white_luminance_cd_m2,
        pixel_aspect: Picture::checked_aspect(aspect),
        layer: Some(match colours.is_luma_chroma {
            true => ExrLayer {
                prefix: String::new(),
                ..colours.layer
            },
            false => colours.layer,
        }),
        carried: Some(Arc::new(carried)),
        notes,
        ..Picture::new(loaded.size, rgb, LightReference::Scene, bits)
    })
}

/// Converts luminance and chroma to red, green and blue in place: RY is (R - Y) / Y, BY is (B - Y) / Y, and Y has these weights.
fn from_luma_chroma(samples: &mut [f32], weights: [f32; 3]) {
    for pixel in samples.as_chunks_mut::<3>().0 {
        let [luminance, red, blue] = *pixel;
        let (red, blue) = ((red + 1.0) * luminance, (blue + 1.0) * luminance);
        let green = (luminance - weights[0] * red - weights[2] * blue) / weights[1];
        *pixel = [red, green, blue];
    }
}

/// Reads a depth channel; that of the layer of the colours beside which it lies, if they are known.
pub(super) fn read_depth(
    source: Source<'_>,
    options: &DepthOptions,
) -> Result<RawDepth, DecodeError> {
    let file = ExrFile::open(source)?;
    let (channel, beside) = (options.channel.as_deref(), options.beside.as_ref());
    let found = exr_channels::depth(file.headers(), channel, beside);
    let (part, channels) = match found {
        Ok((part, channel)) => (part, vec![channel]),
        Err(error) if options.grey_is_depth && channel.is_none() => {
            // Nothing but colours.
            match exr_channels::colours(file.headers(), None) {
                Ok(plain) if file.channel_count() == 3 + usize::from(plain.alpha.is_some()) => {
                    (plain.part, plain.rgb.to_vec())
                }
                _ => return Err(error),
            }
        }
        Err(error) => return Err(error),
    };
    let bits = file.bits(part, &channels);
    let loaded = file.load(part, &[&channels], &[], |_, _| 0)?;
    let mut values = loaded.groups.into_iter().next().unwrap_or_default();
    if channels.len() > 1 {
        values = depth::of_equal_components(&values)?;
    }
    Ok(RawDepth {
        size: loaded.size,
        values,
        bits,
    })
}

/// An EXR file after reading its header.
struct ExrFile<'a> {
    reader: Reader<BufReader<TrackedFile<'a>>>,
    /// Horizontal and vertical distance of the samples of each channel of each part, pixels.
    sampling: Vec<Vec<Vec2<usize>>>,
}

/// Samples of groups of channels.
struct Loaded {
    /// Size of the display window.
    size: Size,
    /// Interleaved channels of each group; 0 outside the data window.
    groups: Vec<Vec<f32>>,
    /// Other channels in their sample formats; 0 outside the data window.
    raw: Vec<Vec<u8>>,
    /// Number of repaired samples.
    repaired: u64,
}

impl<'a> ExrFile<'a> {
    fn open(mut source: Source<'a>) -> Result<Self, DecodeError> {
        // Errors are those of the second attempt.
        let headers = MetaData::read_from_buffered(&mut source.reader, false);
        source.reader.rewind()?;
        let headers = headers.map(|meta| meta.headers).unwrap_or_default();
        let sampling: Vec<Vec<Vec2<usize>>> = headers
            .iter()
            .map(|header| header.channels.list.iter().map(|c| c.sampling).collect())
            .collect();
        if sampling.iter().flatten().any(|step| *step != Vec2(1, 1)) {
            // The library reads no subsampled channels: it gets another header, and their blocks are decoded here.
            let mut bytes = source.read_to_end()?;
            exr_blocks::hide_sampling(&mut bytes)?;
            source = source.with_bytes(bytes);
        }
        let reader = Reader::read_from_buffered(source.reader, false).map_err(failed)?;
        Ok(Self { reader, sampling })
    }

    fn headers(&self) -> &[Header] {
        self.reader.headers()
    }

    /// Number of channels of all parts.
    fn channel_count(&self) -> usize {
        let headers = self.headers().iter();
        headers.map(|header| header.channels.list.len()).sum()
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

    /// Primaries, white point and neutral colour, where the file states one of them.
    fn chromaticities(&self, part: usize) -> Option<Chromaticities> {
        let header = &self.headers()[part];
        let xy = |point: Vec2<f32>| [point.0, point.1];
        let primaries = header.shared_attributes.chromaticities;
        let primaries = primaries.map(|c| Chromaticities {
            red: xy(c.red),
            green: xy(c.green),
            blue: xy(c.blue),
            white: xy(c.white),
            neutral: xy(c.white),
        });
        let neutral = header.own_attributes.adopted_neutral.map(xy);
        match (primaries, neutral) {
            (None, None) => None,
            (primaries, neutral) => {
                let primaries = primaries.unwrap_or(RgbSpace::Srgb.into());
                Some(Chromaticities {
                    neutral: neutral.unwrap_or(primaries.neutral),
                    ..primaries
                })
            }
        }
    }

    /// Luminance of red, green and blue of 1, cd/m^2, where the file states one above 0.
    fn white_luminance_cd_m2(&self, part: usize) -> Option<f32> {
        let stated = self.headers()[part].own_attributes.white_luminance?;
        (stated.is_finite() && stated > 0.0).then_some(stated)
    }

    /// Decodes groups of channels of one part, and other channels, which are not subsampled, as they are. `repair` is called with the index of a group and blocks of its samples, and returns
    /// the number of samples it changed.
    fn load(
        self,
        part: usize,
        groups: &[&[usize]],
        raw: &[usize],
        repair: impl Fn(usize, &mut [f32]) -> u64 + Sync,
    ) -> Result<Loaded, DecodeError> {
        let header = &self.headers()[part];
        let window = header.shared_attributes.display_window;
        let size = checked_size(window.size.0 as u64, window.size.1 as u64)?;
        check(header)?;
        let position = header.own_attributes.layer_position;
        let layout = BlockLayout::new(header, part, &self.sampling[part])?;
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
            raw: raw
                .iter()
                .map(|&c| vec![0; sample_count(size, layout.sample_bytes(c))])
                .collect(),
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
        let meta = layout.decoding_headers(chunks.meta_data());
        loop {
            let compressed: Vec<Chunk> = chunks
                .by_ref()
                .take(batch)
                .collect::<Result<_, _>>()
                .map_err(failed)?;
            if compressed.is_empty() {
                for (whole, group) in loaded.groups.iter_mut().zip(groups) {
                    offset.fill_rows(&layout, whole, group);
                }
                return Ok(loaded);
            }
            let blocks: Vec<Block> = compressed
                .into_par_iter()
                .map(|chunk| layout.decode(chunk, &meta, groups, raw, &repair))
                .collect::<Result<_, _>>()?;
            for block in blocks {
                loaded.repaired += block.repaired;
                for ((whole, piece), group) in
                    loaded.groups.iter_mut().zip(&block.groups).zip(groups)
                {
                    offset.copy(&block, piece, whole, group.len());
                }
                for ((whole, piece), &channel) in loaded.raw.iter_mut().zip(&block.raw).zip(raw) {
                    offset.copy(&block, piece, whole, layout.sample_bytes(channel));
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
    Ok(())
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

/// Position of the data window in the display window.
struct WindowOffset {
    size: Size,
    x: i64,
    y: i64,
}

impl WindowOffset {
    /// Copies the part of a block inside the picture, `channels` samples a pixel.
    fn copy<T: Copy>(&self, block: &Block, from: &[T], to: &mut [T], channels: usize) {
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

impl WindowOffset {
    /// Interpolates the rows of vertically subsampled channels between those that the file has.
    fn fill_rows(&self, layout: &BlockLayout, samples: &mut [f32], group: &[usize]) {
        let (width, height) = (self.size.width() as usize, i64::from(self.size.height()));
        let row_length = width * group.len();
        for (c, &channel) in group.iter().enumerate() {
            let step = layout.sampling(channel).1 as i64;
            if step == 1 {
                continue;
            }
            // Rows of the picture that the file has.
            let first = self.y.max(0);
            let end = (self.y + layout.height() as i64).min(height);
            let known = |y: i64| layout.has_row(channel, y - self.y);
            for y in (first..end).filter(|&y| !known(y)) {
                let above = (first..y).rev().take(step as usize).find(|&y| known(y));
                let below = (y + 1..end).take(step as usize).find(|&y| known(y));
                let Some((a, b)) = above.or(below).zip(below.or(above)) else {
                    continue;
                };
                let part = match b > a {
                    true => (y - a) as f32 / (b - a) as f32,
                    false => 0.0,
                };
                for x in 0..width {
                    let at = |y: i64| y as usize * row_length + x * group.len() + c;
                    samples[at(y)] = samples[at(a)] * (1.0 - part) + samples[at(b)] * part;
                }
            }
        }
    }
}
