//! Picture and depth readers.
//!
//! Formats are recognised by their contents, not by file endings. Any bytes give either a picture or an error that names the file
//! and what is wrong with it.

mod colour;
mod depth;
mod exif;
mod exr;
mod exr_blocks;
mod exr_channels;
mod hdr;
mod hole_fill;
mod jpeg;
mod npy;
mod npz;
mod orientation;
mod pfm;
mod picture;
mod pixel_layout;
mod png;
mod source;
mod tiff;

pub use depth::{DepthKind, DepthMap, DepthMeaning, DepthOptions, DepthPacking, UnknownDepth};
pub use exr_channels::ExrLayer;
pub use orientation::Orientation;
pub use picture::{LightReference, Picture, SampleBits};

use crate::{Control, ImageError, PictureFormat, Size};
use depth::RawDepth;
use source::{DecodeError, FileKind, Source, decode_bytes, decode_file, decode_source};
use std::path::Path;

/// Formats of pictures, as errors name them.
const PICTURE_FORMATS: &str = "OpenEXR, Radiance HDR, PNG, JPEG, TIFF";

/// Formats of depth maps, as errors name them.
const DEPTH_FORMATS: &str = "OpenEXR, PNG, NPY, NPZ, PFM, TIFF";

/// Reads a picture.
///
/// `layer` names a layer of an EXR file: channels `LAYER.R`, `LAYER.G`, `LAYER.B` (and `LAYER.A`), or the part of that
/// name. Without it, plain `R`, `G`, `B` are read, or those of the only layer called `Combined`, or of the only layer that has
/// them; of a stereo file, its first view. A layer that has only a luminance `Y` gives grey; luminance and chroma (`Y`, `RY`, `BY`)
/// are converted to red, green and blue. The picture has the size of the display window; it is black where the data window does
/// not cover it.
///
/// PNG files may have any colour type and depth; TIFF files grey or red, green and blue of 8 or 16 bits, which are display colours, or
/// floats, which are linear light. Display colours are converted to linear sRGB from what the file says they are:
/// PNG by its chunks cICP, else iCCP, else sRGB, else cHRM and gAMA; TIFF by its ICC profile; JPEG by its ICC profile, else the interoperability index of
/// its EXIF data; otherwise they are sRGB. In high dynamic range (PQ, HLG), 203 cd/m^2 are 1 (ITU-R BT.2408). A picture with an
/// EXIF orientation is turned upright. [`Picture::notes`] lists what was converted, repaired or ignored.
///
/// # Errors
/// [`ImageError::File`] where the system refuses, [`ImageError::EndsEarly`] for empty and truncated files,
/// [`ImageError::NoChannel`] where the layer has no colours, and [`ImageError::Read`] for anything else: an unknown
/// format, corrupt contents, CMYK, floats of a TIFF file that are encoded by a curve, more than 65536 pixels a side or 2^30 in total.
pub fn read_picture(path: &Path, layer: Option<&str>) -> Result<Picture, ImageError> {
    read_picture_with(path, layer, Control::default())
}

/// As [`read_picture`], with cancellation.
///
/// # Errors
/// As [`read_picture`], and if the caller cancelled.
pub fn read_picture_with(
    path: &Path,
    layer: Option<&str>,
    control: Control<'_>,
) -> Result<Picture, ImageError> {
    decode_file(path, PICTURE_FORMATS, control, |source| {
        decode_picture(source, layer)
    })
}

/// Whether the ending of a name is that of a picture that [`read_picture`] reads.
pub fn is_picture_name(path: &Path) -> bool {
    PictureFormat::from_path(path).is_ok() || is_tiff_name(path)
}

/// Whether the ending of a name is that of a TIFF file.
pub fn is_tiff_name(path: &Path) -> bool {
    let ending = path.extension().unwrap_or_default().to_ascii_lowercase();
    ["tif", "tiff"].iter().any(|known| ending == *known)
}

/// Reads a picture, and its depth from the same file, which may be a pipe. `options` are those of the depth of a picture.
///
/// # Errors
/// For the picture as [`read_picture_with`]; those of the depth, as [`read_depth_with`], are in the inner result.
pub fn read_picture_with_depth(
    path: &Path,
    layer: Option<&str>,
    options: impl FnOnce(&Picture) -> DepthOptions,
    control: Control<'_>,
) -> Result<(Picture, Result<DepthMap, ImageError>), ImageError> {
    let mut again = None;
    let picture = decode_file(path, PICTURE_FORMATS, control, |source| {
        again = source.again();
        decode_picture(source, layer)
    })?;
    let options = options(&picture);
    let depth = match again {
        None => read_depth_with(path, &options, control),
        Some(source) => finish_depth(path, &options, |path| {
            decode_source(source, path, |source| decode_depth(source, &options))
        }),
    };
    Ok((picture, depth))
}

fn decode_picture(source: Source<'_>, layer: Option<&str>) -> Result<Picture, DecodeError> {
    if let Some(layer) = layer
        && source.kind != FileKind::Exr
    {
        return Err(DecodeError::Invalid(format!(
            "expected an EXR file for layer `{layer}`: only EXR files have layers"
        )));
    }
    match source.kind {
        FileKind::Exr => exr::read(source, layer),
        FileKind::Hdr => hdr::read(source),
        FileKind::Png => png::read(source),
        FileKind::Jpeg => jpeg::read(source),
        FileKind::Npy | FileKind::Npz | FileKind::Pfm => Err(DecodeError::Invalid(format!(
            "expected a picture ({PICTURE_FORMATS}), got an array of numbers (NPY, NPZ or PFM)"
        ))),
        FileKind::Tiff => tiff::read(source),
    }
}

/// Reads a depth map: EXR, PNG (grey of 8 or 16 bits, equal red, green and blue, or [`DepthPacking`]), NPY (numbers of any type,
/// shape `(h, w)`, `(h, w, 1)` or `(1, h, w)`), NPZ (the only array, or that called depth), PFM (whose scale factor is ignored) or
/// TIFF (one number to a pixel).
///
/// | number in the file | z-depth, distance | disparity | inverse | depth buffer |
/// |---|---|---|---|---|
/// | NaN | hole | hole | hole | hole |
/// | 0 | hole | hole | infinitely far | the near plane; reversed: infinitely far |
/// | 1 | 1 | 1 | 1 | infinitely far; reversed: the near plane |
/// | infinite | infinitely far | hole | hole | infinitely far; reversed: hole |
/// | below 0 | error | as any other | error | error |
///
/// Infinitely far are also disparities that are not above 0 with their offset, depths of 1e9 m or more, and z-depths and distances
/// of 9.9e9 units or more at any scale: renderers write 1e10 where a ray leaves the scene. Outside the data window of an EXR
/// file the number is 0.
///
/// # Errors
/// As [`read_picture`]; [`ImageError::Setting`] where an option is out of range;
/// [`ImageError::NegativeDepth`]; [`ImageError::Read`] also where all pixels are holes.
pub fn read_depth(path: &Path, options: &DepthOptions) -> Result<DepthMap, ImageError> {
    read_depth_with(path, options, Control::default())
}

/// As [`read_depth`], with cancellation.
///
/// # Errors
/// As [`read_depth`], and if the caller cancelled.
pub fn read_depth_with(
    path: &Path,
    options: &DepthOptions,
    control: Control<'_>,
) -> Result<DepthMap, ImageError> {
    finish_depth(path, options, |path| {
        decode_file(path, DEPTH_FORMATS, control, |source| {
            decode_depth(source, options)
        })
    })
}

/// Reads a depth map as [`read_depth`] does, from the contents of a PNG, NPY or PFM file in memory; `path` is its name in errors. The
/// decoders of the other formats are large for web pages, which have files in memory alone.
///
/// # Errors
/// As [`read_depth`].
pub fn read_depth_bytes(
    bytes: Vec<u8>,
    path: &Path,
    options: &DepthOptions,
) -> Result<DepthMap, ImageError> {
    const FORMATS: &str = "PNG, NPY, PFM";
    finish_depth(path, options, |path| {
        decode_bytes(bytes, path, FORMATS, |source| match source.kind {
            FileKind::Png => png::read_depth(source, options.packing),
            FileKind::Npy => npy::read(source),
            FileKind::Pfm => pfm::read(source),
            _ => Err(DecodeError::invalid(format!(
                "expected one of the formats {FORMATS} for a file in memory, got another"
            ))),
        })
    })
}

impl DepthMap {
    /// A map from the numbers of an array, row by row from the upper left, as [`read_depth`] takes those of a file. Errors call the
    /// array `depth`.
    ///
    /// # Errors
    /// As [`read_depth`]; [`ImageError::Setting`] if the number of values does not match the size.
    pub fn from_numbers(
        size: Size,
        values: Vec<f32>,
        bits: SampleBits,
        options: &DepthOptions,
    ) -> Result<Self, ImageError> {
        options.validate()?;
        let pixels = size.width() as usize * size.height() as usize;
        ImageError::require(
            values.len() == pixels,
            "the number of depths",
            values.len() as f64,
            "one for each pixel",
        )?;
        let raw = RawDepth { size, values, bits };
        into_map(raw, Path::new("depth"), options)
    }
}

/// Converts the numbers of a file to metres, and fills in unknown ones.
fn finish_depth(
    path: &Path,
    options: &DepthOptions,
    decode: impl FnOnce(&Path) -> Result<RawDepth, ImageError>,
) -> Result<DepthMap, ImageError> {
    options.validate()?;
    into_map(decode(path)?, path, options)
}

fn into_map(raw: RawDepth, path: &Path, options: &DepthOptions) -> Result<DepthMap, ImageError> {
    let mut map = raw.into_map(path, options)?;
    if map.holes > 0 {
        match options.unknown {
            UnknownDepth::Fill => {
                hole_fill::fill_holes(&mut map.metres, map.size.width() as usize);
            }
            UnknownDepth::Far => replace_holes(&mut map.metres, f32::INFINITY),
            UnknownDepth::SkyAbove => {
                let width = map.size.width() as usize;
                hole_fill::open_sky(&mut map.metres, width);
                map.infinite = map.metres.iter().filter(|m| m.is_infinite()).count() as u64;
                hole_fill::fill_holes(&mut map.metres, width);
            }
            UnknownDepth::Clear => replace_holes(&mut map.metres, 0.0),
        }
    }
    Ok(map)
}

/// Replaces NaN by a value.
fn replace_holes(depth: &mut [f32], value: f32) {
    for v in depth {
        *v = if v.is_nan() { value } else { *v };
    }
}

fn decode_depth(source: Source<'_>, options: &DepthOptions) -> Result<RawDepth, DecodeError> {
    let channel = options.channel.as_deref();
    if let Some(channel) = channel
        && !matches!(source.kind, FileKind::Exr | FileKind::Npz)
    {
        return Err(DecodeError::Invalid(format!(
            "expected an EXR file for channel `{channel}`: only EXR files have channels with names"
        )));
    }
    if options.packing != DepthPacking::None && source.kind != FileKind::Png {
        return Err(DecodeError::Invalid(format!(
            "expected a PNG file for packed depth ({}), got another format",
            options.packing
        )));
    }
    let kind = match source.kind {
        FileKind::Exr => return exr::read_depth(source, options),
        FileKind::Png => return png::read_depth(source, options.packing),
        FileKind::Npy => return npy::read(source),
        FileKind::Npz => return npy::read(npz::open(source, channel)?),
        FileKind::Pfm => return pfm::read(source),
        FileKind::Tiff if options.grey_is_depth => return tiff::read_depth(source),
        FileKind::Tiff => "a TIFF picture without depth",
        FileKind::Jpeg => "a JPEG picture, whose compression alters depth",
        FileKind::Hdr => "a Radiance HDR picture",
    };
    Err(DecodeError::Invalid(format!(
        "expected a depth map ({DEPTH_FORMATS}), got {kind}"
    )))
}
