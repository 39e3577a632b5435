//! Reads depth maps from OpenEXR, PNG, NPY and PFM files.

use super::{
    depth::{DepthKind, DepthMap, DepthMeaning, DepthOptions, Unknown},
    exr, exr_names,
    fault::Fault,
    fill, metres,
    metres::Raw,
    npy, pfm, png,
    source::{Kind, Source, with_source},
};
use crate::ImageError;
use std::path::Path;

/// The formats that depth maps are read from, as errors name them.
const KNOWN: &str = "OpenEXR, PNG, NPY, PFM";

/// Reads a depth map: EXR, PNG (grey, 8 or 16 bits), NPY (numbers of any kind, shape `(h, w)`, `(h, w, 1)` or
/// `(1, h, w)`) or PFM (of which the scale is not applied).
///
/// | number in the file | z-depth, distance | disparity | inverse |
/// |---|---|---|---|
/// | not-a-number | hole | hole | hole |
/// | 0 | hole | hole | infinitely far |
/// | infinite | infinitely far | hole | hole |
/// | below 0 | error | counts | error |
///
/// Disparity that is not above 0 together with its offset is infinitely far, and so is what is at least 1e9 m away, and
/// z-depth or distance of 9.9e9 units or more, whatever the scale: renderers write 1e10 where they meet nothing. Outside
/// the data window of an EXR file the number is 0.
///
/// # Errors
/// As [`super::read_picture`]; [`ImageError::Setting`] where an option is out of range;
/// [`ImageError::NegativeDepth`]; [`ImageError::Read`] also where all pixels are holes.
pub fn read_depth(path: &Path, options: &DepthOptions) -> Result<DepthMap, ImageError> {
    options.check()?;
    let mut raw = with_source(path, KNOWN, |source| {
        decode(source, options.channel.as_deref())
    })?;
    let counts = metres::convert(path, &mut raw, options)?;
    let mut depth = raw.values;
    if counts.holes > 0 {
        match options.unknown {
            Unknown::Fill => fill::fill(&mut depth, raw.size.width() as usize),
            Unknown::Far => put(&mut depth, f32::INFINITY),
            Unknown::Clear => put(&mut depth, 0.0),
        }
    }
    Ok(DepthMap {
        size: raw.size,
        metres: depth,
        kind: match options.meaning {
            DepthMeaning::RayDistance => DepthKind::Ray,
            _ => DepthKind::Z,
        },
        bits: raw.bits,
        holes: counts.holes,
        infinite: counts.infinite,
    })
}

/// Puts a value into all holes.
fn put(depth: &mut [f32], value: f32) {
    for v in depth {
        *v = if v.is_nan() { value } else { *v };
    }
}

fn decode(source: Source, channel: Option<&str>) -> Result<Raw, Fault> {
    if let Some(channel) = channel
        && source.kind != Kind::Exr
    {
        return Err(Fault::Bad(format!(
            "channel `{channel}` was asked for, but only EXR files have channels with names"
        )));
    }
    match source.kind {
        Kind::Exr => from_exr(source, channel),
        Kind::Png => png::read_grey(source),
        Kind::Npy => npy::read(source),
        Kind::Pfm => pfm::read(source),
        Kind::Jpeg => Err(Fault::bad(
            "it is a JPEG, whose losses spoil depth: depth maps are read from OpenEXR, PNG, NPY and PFM",
        )),
        Kind::Hdr => Err(Fault::bad(
            "it is a Radiance HDR picture: depth maps are read from OpenEXR, PNG, NPY and PFM",
        )),
    }
}

fn from_exr(source: Source, channel: Option<&str>) -> Result<Raw, Fault> {
    let file = exr::ExrFile::open(source)?;
    let (part, channel) = exr_names::depth(file.headers(), channel)?;
    let bits = file.bits(part, &[channel]);
    let loaded = file.load(part, &[&[channel]], |_, _| 0)?;
    Ok(Raw {
        size: loaded.size,
        values: loaded.groups.into_iter().next().unwrap_or_default(),
        bits,
    })
}
