//! Depth maps: how far away is what each pixel shows.

use super::{
    exr, exr_names,
    fault::Fault,
    fill, metres,
    metres::Raw,
    npy, pfm,
    picture::{Picture, SampleBits},
    png,
    source::{Kind, Source, with_source},
};
use crate::{ImageError, Size};
use std::path::Path;

/// The formats that depth maps are read from, as errors name them.
const KNOWN: &str = "OpenEXR, PNG, NPY, PFM";

/// What the numbers in a depth file mean.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub enum DepthMeaning {
    /// Depth along the axis of the camera.
    #[default]
    ZDepth,
    /// Distance from the camera along the ray of the pixel.
    RayDistance,
    /// How many pixels apart two cameras side by side see the same point: z is
    /// `focal_length_px * baseline_m / (scale * value + offset_px)`.
    Disparity {
        /// Focal length in pixels, above 0.
        focal_length_px: f64,
        /// Distance between the cameras, metres, above 0.
        baseline_m: f64,
        /// Difference of the two principal points, pixels (Middlebury's `doffs`).
        offset_px: f64,
    },
    /// One over depth along the axis: z is `1 / (scale * value)`.
    Inverse,
}

/// What becomes of pixels whose depth is unknown.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Hash)]
pub enum Unknown {
    /// They are filled from their known neighbours: from the farther one, as holes of stereo pictures want it, or by a
    /// straight line where both lie on one surface.
    #[default]
    Fill,
    /// They are taken for sky: infinitely far.
    Far,
    /// They are kept clear of fog: depth 0.
    Clear,
}

/// How a depth file is to be read. The default is z-depth in metres.
#[derive(Clone, Debug, PartialEq)]
pub struct DepthOptions {
    /// What its numbers mean.
    pub meaning: DepthMeaning,
    /// Metres for each unit of the file, above 0: 0.001 for millimetres. For disparity, pixels for each unit; for
    /// inverse depth, 1/m for each unit.
    pub scale: f64,
    /// The channel of an EXR file, in a file with several parts also as `PART.CHANNEL`.
    ///
    /// Where none is given: `Z`, `depth.Z`, `depth.V`, `depth.Y`, `depth.R` or `depth`, the first of these that is
    /// there, in large or small letters; then a single channel that ends so (`ViewLayer.Depth.Z`), a `Y` without `X` or
    /// `Z`, an `R` without `G`, `B`, `A`, and the only channel of the file. A `Z` beside an `X` is no depth. Other files
    /// are refused with the list of their channels.
    pub channel: Option<String>,
    /// What becomes of pixels whose depth is unknown.
    pub unknown: Unknown,
    /// At or beyond so many metres, pixels show the sky: infinitely far.
    pub far_from_m: Option<f64>,
    /// Negative numbers mean that nothing is known, and are no error.
    pub negative_is_unknown: bool,
}

impl Default for DepthOptions {
    fn default() -> Self {
        Self {
            meaning: DepthMeaning::default(),
            scale: 1.0,
            channel: None,
            unknown: Unknown::default(),
            far_from_m: None,
            negative_is_unknown: false,
        }
    }
}

/// Along what depth is measured.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash)]
pub enum DepthKind {
    /// Along the axis of the camera: [`crate::Intrinsics::ray_length_per_z`] makes distance of it.
    Z,
    /// Along the ray of the pixel.
    Ray,
}

/// A depth map in memory.
#[derive(Clone, Debug, PartialEq)]
pub struct DepthMap {
    /// Width and height in pixels.
    pub size: Size,
    /// Depth of each pixel in metres, row by row from the upper left: 0 or more, infinite where nothing was met, never
    /// not-a-number.
    pub metres: Vec<f32>,
    /// Along what it is measured.
    pub kind: DepthKind,
    /// How the file stores its numbers. Eight bits are coarse for anything but disparity.
    pub bits: SampleBits,
    /// Pixels whose depth the file does not say.
    pub holes: u64,
    /// Pixels that the file says are infinitely far, or as good as.
    pub infinite: u64,
}

impl DepthMap {
    /// Makes sure that the map belongs to a picture.
    ///
    /// # Errors
    /// [`ImageError::SizesDiffer`] where it is not as large.
    pub fn check_against(&self, picture: &Picture) -> Result<(), ImageError> {
        if self.size == picture.size {
            Ok(())
        } else {
            Err(ImageError::SizesDiffer {
                depth: self.size,
                picture: picture.size,
            })
        }
    }
}

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

impl DepthOptions {
    fn check(&self) -> Result<(), ImageError> {
        let above_0 = |what, value: f64| {
            if value.is_finite() && value > 0.0 {
                Ok(())
            } else {
                Err(ImageError::Setting {
                    what,
                    got: value.to_string(),
                    right: "a finite number above 0",
                })
            }
        };
        above_0("the scale of depth", self.scale)?;
        if let Some(far) = self.far_from_m {
            above_0("the depth in metres from which all is sky", far)?;
        }
        if let DepthMeaning::Disparity {
            focal_length_px,
            baseline_m,
            offset_px,
        } = self.meaning
        {
            above_0("the focal length in pixels", focal_length_px)?;
            above_0("the distance between the cameras in metres", baseline_m)?;
            if !offset_px.is_finite() {
                return Err(ImageError::Setting {
                    what: "the offset of disparity in pixels",
                    got: offset_px.to_string(),
                    right: "a finite number",
                });
            }
        }
        Ok(())
    }
}
