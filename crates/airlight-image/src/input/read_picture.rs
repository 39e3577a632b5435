//! Reads pictures: linear red, green and blue from OpenEXR, Radiance HDR, PNG and JPEG files.

use super::{
    exr, exr_names,
    fault::Fault,
    hdr, jpeg,
    picture::{LightReference, Picture, mend_colours, mend_opacity},
    png,
    source::{Kind, Source, with_source},
};
use crate::ImageError;
use std::path::Path;

/// The formats that pictures are read from, as errors name them.
const KNOWN: &str = "OpenEXR, Radiance HDR, PNG, JPEG";

/// Reads a picture.
///
/// `layer` names a layer of an EXR file: channels `LAYER.R`, `LAYER.G`, `LAYER.B` (and `LAYER.A`), or the part of that
/// name. Without it, plain `R`, `G`, `B` are taken, else those of the only layer that has them. A layer that has only a
/// luminance `Y` gives grey. The picture is as large as the display window; where the data window leaves it uncovered, it
/// is black.
///
/// Of PNG files, all colour types and depths are read; their colours are decoded as sRGB, or by a `gAMA` chunk where that
/// says otherwise and nothing says sRGB. Turning by EXIF is not applied.
///
/// # Errors
/// [`ImageError::File`] where the system refuses, [`ImageError::EndsEarly`] for empty and truncated files,
/// [`ImageError::NoChannel`] where the layer has no colours, and [`ImageError::Read`] for anything else: an unknown
/// format, corrupt contents, CMYK, more than 65536 pixels a side or 2^30 in all.
pub fn read_picture(path: &Path, layer: Option<&str>) -> Result<Picture, ImageError> {
    with_source(path, KNOWN, |source| decode(source, layer))
}

fn decode(source: Source, layer: Option<&str>) -> Result<Picture, Fault> {
    if let Some(layer) = layer
        && source.kind != Kind::Exr
    {
        return Err(Fault::Bad(format!(
            "layer `{layer}` was asked for, but only EXR files have layers"
        )));
    }
    match source.kind {
        Kind::Exr => from_exr(source, layer),
        Kind::Hdr => hdr::read(source),
        Kind::Png => png::read(source),
        Kind::Jpeg => jpeg::read(source),
        Kind::Npy | Kind::Pfm => Err(Fault::Bad(format!(
            "it is a file of numbers (NPY or PFM), not a picture ({KNOWN})"
        ))),
    }
}

fn from_exr(source: Source, layer: Option<&str>) -> Result<Picture, Fault> {
    let file = exr::ExrFile::open(source)?;
    let pick = exr_names::colours(file.headers(), layer)?;
    let bits = file.bits(pick.part, &pick.rgb);
    let chromaticities = file.chromaticities(pick.part);
    let white_luminance_cd_m2 = file.white_luminance_cd_m2(pick.part);
    let mut groups: Vec<&[usize]> = vec![&pick.rgb];
    groups.extend(pick.alpha.as_ref().map(std::slice::from_ref));
    let loaded = file.load(pick.part, &groups, |group, samples| match group {
        0 => mend_colours(samples),
        _ => mend_opacity(samples),
    })?;
    let mut buffers = loaded.groups.into_iter();
    Ok(Picture {
        size: loaded.size,
        rgb: buffers.next().unwrap_or_default(),
        alpha: buffers.next(),
        reference: LightReference::Scene,
        bits,
        chromaticities,
        white_luminance_cd_m2,
        profile_ignored: false,
        repaired_samples: loaded.mended,
    })
}
