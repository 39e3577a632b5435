//! Files in memory for the tests of the readers.

use super::Folder;
use airlight_image::{DepthMap, DepthOptions, ImageError, read_depth};
use exr::prelude::*;
use jpeg_encoder::{ImageBuffer, JpegColorType, rgb_to_ycbcr};
use std::io::Cursor;

/// A part of an EXR file: its name, position and size, channels.
pub struct Part {
    pub name: Option<&'static str>,
    pub view: Option<&'static str>,
    pub position: (i32, i32),
    pub size: (usize, usize),
    pub channels: Vec<(&'static str, FlatSamples)>,
    pub compression: Compression,
    pub tile: Option<usize>,
}

impl Part {
    pub fn new(size: (usize, usize), channels: Vec<(&'static str, FlatSamples)>) -> Self {
        Self {
            name: None,
            view: None,
            position: (0, 0),
            size,
            channels,
            compression: Compression::ZIP16,
            tile: None,
        }
    }

    pub fn of_view(self, view: &'static str) -> Self {
        Self {
            view: Some(view),
            ..self
        }
    }

    pub fn named(self, name: &'static str) -> Self {
        Self {
            name: Some(name),
            ..self
        }
    }
}

/// An EXR file whose display window has this upper left corner and size.
pub fn exr_file(window: (i32, i32, usize, usize), parts: Vec<Part>) -> Vec<u8> {
    let layers: Vec<Layer<AnyChannels<FlatSamples>>> = parts
        .into_iter()
        .map(|part| {
            let list = part
                .channels
                .into_iter()
                .map(|(name, samples)| AnyChannel::new(name, samples))
                .collect();
            let attributes = LayerAttributes {
                layer_name: part.name.map(Text::from),
                view_name: part.view.map(Text::from),
                layer_position: Vec2(part.position.0, part.position.1),
                ..LayerAttributes::default()
            };
            let encoding = Encoding {
                compression: part.compression,
                blocks: match part.tile {
                    Some(side) => Blocks::Tiles(Vec2(side, side)),
                    None => Blocks::ScanLines,
                },
                line_order: LineOrder::Increasing,
            };
            Layer::new(part.size, attributes, encoding, AnyChannels::sort(list))
        })
        .collect();
    let (x, y, width, height) = window;
    let mut attributes = ImageAttributes::new(IntegerBounds::new(Vec2(x, y), Vec2(width, height)));
    attributes.chromaticities = Some(exr::meta::attribute::Chromaticities {
        red: Vec2(0.7, 0.3),
        green: Vec2(0.2, 0.8),
        blue: Vec2(0.1, 0.05),
        white: Vec2(0.3127, 0.329),
    });
    let mut bytes = Cursor::new(Vec::new());
    Image {
        attributes,
        layer_data: layers.into_iter().collect::<Layers<_>>(),
    }
    .write()
    .non_parallel()
    .to_buffered(&mut bytes)
    .unwrap();
    bytes.into_inner()
}

/// A PNG file; `also` adds further chunks.
pub fn png_file(
    (width, height): (u32, u32),
    color: png::ColorType,
    depth: png::BitDepth,
    data: &[u8],
    also: impl FnOnce(&mut png::Encoder<'_, &mut Vec<u8>>),
) -> Vec<u8> {
    let mut bytes = Vec::new();
    let mut encoder = png::Encoder::new(&mut bytes, width, height);
    encoder.set_color(color);
    encoder.set_depth(depth);
    also(&mut encoder);
    let mut writer = encoder.write_header().unwrap();
    writer.write_image_data(data).unwrap();
    writer.finish().unwrap();
    bytes
}

/// A PNG file of 16-bit grey.
pub fn grey_16(size: (u32, u32), values: &[u16]) -> Vec<u8> {
    let data: Vec<u8> = values.iter().flat_map(|v| v.to_be_bytes()).collect();
    let (color, depth) = (png::ColorType::Grayscale, png::BitDepth::Sixteen);
    png_file(size, color, depth, &data, |_| {})
}

/// An NPY file of a version with these header fields.
pub fn npy_file(version: u8, descr: &str, fortran: bool, shape: &str, data: &[u8]) -> Vec<u8> {
    let order = if fortran { "True" } else { "False" };
    let mut header = format!("{{'descr': {descr}, 'fortran_order': {order}, 'shape': {shape}, }}");
    while (header.len() + 12) % 64 != 63 {
        header.push(' ');
    }
    header.push('\n');
    let mut bytes = b"\x93NUMPY".to_vec();
    bytes.extend([version, 0]);
    if version == 1 {
        bytes.extend((header.len() as u16).to_le_bytes());
    } else {
        bytes.extend((header.len() as u32).to_le_bytes());
    }
    bytes.extend(header.as_bytes());
    bytes.extend(data);
    bytes
}

/// An NPZ archive of files, deflated or stored.
pub fn npz_file(arrays: &[(&str, Vec<u8>)], deflated: bool) -> Vec<u8> {
    let (mut bytes, mut directory) = (Vec::new(), Vec::new());
    for (name, array) in arrays {
        let packed = match deflated {
            true => {
                let mut packed = Vec::with_capacity(array.len() + 100);
                let mut deflate = flate2::Compress::new(flate2::Compression::fast(), false);
                let finish = flate2::FlushCompress::Finish;
                deflate.compress_vec(array, &mut packed, finish).unwrap();
                packed
            }
            false => array.clone(),
        };
        let mut about = vec![20, 0, 0, 0, if deflated { 8 } else { 0 }, 0, 0, 0, 0, 0];
        about.extend([0; 4]);
        about.extend((packed.len() as u32).to_le_bytes());
        about.extend((array.len() as u32).to_le_bytes());
        about.extend((name.len() as u16).to_le_bytes());
        about.extend([0, 0]);
        directory.extend(b"PK\x01\x02\x14\0");
        directory.extend(&about);
        directory.extend([0; 10]);
        directory.extend((bytes.len() as u32).to_le_bytes());
        directory.extend(name.bytes());
        bytes.extend(b"PK\x03\x04");
        bytes.extend(&about);
        bytes.extend(name.bytes());
        bytes.extend(packed);
    }
    let start = bytes.len() as u32;
    bytes.extend(&directory);
    let count = (arrays.len() as u16).to_le_bytes();
    bytes.extend(b"PK\x05\x06\0\0\0\0");
    bytes.extend(count.iter().chain(&count));
    bytes.extend((directory.len() as u32).to_le_bytes());
    bytes.extend(start.to_le_bytes());
    bytes.extend([0, 0]);
    bytes
}

/// A TIFF file of one 32-bit float to a pixel, uncompressed.
pub fn tiff_file(size: (u32, u32), values: &[f32]) -> Vec<u8> {
    tiff_of::<tiff::encoder::colortype::Gray32Float>(size, values, &[], &[])
}

/// Value of a further tag of a TIFF file.
pub enum TiffTag<'a> {
    Short(u16),
    Shorts(&'a [u16]),
    Bytes(&'a [u8]),
    Fraction(u32, u32),
}

/// A TIFF file of pixels of a kind, with further components and tags, uncompressed.
pub fn tiff_of<C: tiff::encoder::colortype::ColorType>(
    (width, height): (u32, u32),
    values: &[C::Inner],
    extra: &[tiff::tags::ExtraSamples],
    tags: &[(tiff::tags::Tag, TiffTag<'_>)],
) -> Vec<u8>
where
    [C::Inner]: tiff::encoder::TiffValue,
{
    let mut bytes = std::io::Cursor::new(Vec::new());
    let mut encoder = tiff::encoder::TiffEncoder::new(&mut bytes).unwrap();
    let mut image = encoder.new_image::<C>(width, height).unwrap();
    if !extra.is_empty() {
        image.extra_samples(extra).unwrap();
    }
    for (tag, value) in tags {
        let directory = image.encoder();
        match *value {
            TiffTag::Short(number) => directory.write_tag(*tag, number),
            TiffTag::Shorts(numbers) => directory.write_tag(*tag, numbers),
            TiffTag::Bytes(bytes) => directory.write_tag(*tag, bytes),
            TiffTag::Fraction(n, d) => directory.write_tag(*tag, tiff::encoder::Rational { n, d }),
        }
        .unwrap();
    }
    image.write_data(values).unwrap();
    bytes.into_inner()
}

/// A PFM file; `rows` from the top.
pub fn pfm_file((width, height): (usize, usize), little: bool, rows: &[f32]) -> Vec<u8> {
    let order = if little { "-0.003922" } else { "1.0" };
    let mut bytes = format!("Pf\n{width} {height}\n{order}\n").into_bytes();
    for row in rows.chunks(width).rev() {
        for v in row {
            bytes.extend(if little {
                v.to_le_bytes()
            } else {
                v.to_be_bytes()
            });
        }
    }
    bytes
}

/// A smooth picture as the encoder of JPEG takes it.
struct SmoothPicture {
    size: (u16, u16),
    color: JpegColorType,
}

impl ImageBuffer for SmoothPicture {
    fn get_jpeg_color_type(&self) -> JpegColorType {
        self.color
    }

    fn width(&self) -> u16 {
        self.size.0
    }

    fn height(&self) -> u16 {
        self.size.1
    }

    fn fill_buffers(&self, y: u16, buffers: &mut [Vec<u8>; 4]) {
        for x in 0..self.size.0 {
            let [a, b, c, d] = [0, 1, 2, 3].map(|c| (x * 3 + y * 2 + c * 40).min(255) as u8);
            let components = match self.color {
                JpegColorType::Luma => vec![a],
                JpegColorType::Ycbcr => <[u8; 3]>::from(rgb_to_ycbcr(a, b, c)).to_vec(),
                _ => vec![a, b, c, d],
            };
            for (buffer, component) in buffers.iter_mut().zip(components) {
                buffer.push(component);
            }
        }
    }
}

/// A JPEG file of a smooth picture, with a colour profile if that is not empty.
pub fn jpeg_file(
    size: (u16, u16),
    color: JpegColorType,
    progressive: bool,
    profile: &[u8],
) -> Vec<u8> {
    let mut bytes = Vec::new();
    let mut encoder = jpeg_encoder::Encoder::new(&mut bytes, 95);
    encoder.set_progressive(progressive);
    if !profile.is_empty() {
        encoder.add_icc_profile(profile).unwrap();
    }
    encoder.encode_image(SmoothPicture { size, color }).unwrap();
    bytes
}

/// Reads the depth map in `bytes` through a file.
pub fn read_as(
    folder: &Folder,
    bytes: &[u8],
    options: &DepthOptions,
) -> std::result::Result<DepthMap, ImageError> {
    let path = folder.file("depth.bin");
    std::fs::write(&path, bytes).unwrap();
    read_depth(&path, options)
}
