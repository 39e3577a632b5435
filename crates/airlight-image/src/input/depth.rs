//! Depth maps: their meaning, and the conversion from the numbers of a file to metres.

use super::picture::{Picture, SampleBits};
use super::source::DecodeError;
use super::{ExrLayer, Orientation};
use crate::{ImageError, Notes, Size};
use rayon::prelude::*;
use std::path::Path;

/// Meaning of the numbers in a depth file.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
#[non_exhaustive]
pub enum DepthMeaning {
    /// Depth along the axis of the camera.
    #[default]
    ZDepth,
    /// Distance from the camera along the ray of the pixel.
    RayDistance,
    /// Disparity of a stereo pair in pixels: z is `focal_length_px * baseline_m / (scale * value + offset_px)`.
    Disparity {
        /// Focal length in pixels, above 0.
        focal_length_px: f64,
        /// Distance between the cameras, metres, above 0.
        baseline_m: f64,
        /// Difference of the two principal points, pixels (Middlebury's `doffs`).
        offset_px: f64,
    },
    /// Reciprocal of the depth along the axis: z is `1 / (scale * value)`.
    Inverse,
    /// Depth buffer of a perspective camera, from 0 at the near plane to 1 at the far plane, as graphics hardware stores it. Integers
    /// stand for 0 to 1.
    Buffer {
        /// Depth of the near plane, metres, above 0.
        near_m: f64,
        /// Depth of the far plane, metres, beyond the near plane; may be infinite. What reaches it is sky.
        far_m: f64,
        /// 1 is at the near plane and 0 at the far plane.
        is_reversed: bool,
    },
}

/// Treatment of pixels whose depth is unknown.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Hash)]
#[non_exhaustive]
pub enum UnknownDepth {
    /// Filled from the known neighbours: from the farther one, as is right for occlusions in stereo pairs, or by linear
    /// interpolation where both lie on one surface.
    #[default]
    Fill,
    /// Sky: infinitely far.
    Far,
    /// Free of fog: depth 0.
    Clear,
    /// Sky above the topmost known pixel of each column; otherwise filled.
    SkyAbove,
}

airlight::named! { UnknownDepth, "a treatment of unknown depth", [
    ("fill", (Fill), "filled from their neighbours"),
    ("far", (Far), "treated as sky"),
    ("clear", (Clear), "kept free of fog"),
    ("sky-above", (SkyAbove), "above the topmost known pixel of their column treated as sky, otherwise filled"),
] }

/// How the components of a colour PNG hold depth.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Hash)]
#[non_exhaustive]
pub enum DepthPacking {
    /// One number to a pixel; equal red, green and blue count as one.
    #[default]
    None,
    /// 24 bits, the lowest in red, from 0 to 1000 m: CARLA. The largest number is sky.
    Carla,
}

airlight::named! { DepthPacking, "a packing of depth", [
    ("none", (None), "one number to a pixel, or equal red, green and blue"),
    ("carla", (Carla), "24 bits in red (lowest), green and blue, up to 1000 m, as in CARLA"),
] }

/// Settings for reading a depth file. The default is z-depth in metres.
#[derive(Clone, Debug, PartialEq)]
pub struct DepthOptions {
    /// Meaning of the numbers.
    pub meaning: DepthMeaning,
    /// Metres per unit of the file: 0.001 for millimetres. For disparity, pixels per unit; for inverse depth, 1/m per
    /// unit. Above 0; with an offset also below, for numbers that decrease with depth.
    pub scale: f64,
    /// Added to scaled depths, distances and inverse depths, m or 1/m, as for normalised depth; 0 is then a number as any other and
    /// not unknown. `None`: 0 is unknown.
    pub offset: Option<f64>,
    /// How a colour PNG holds depth.
    pub packing: DepthPacking,
    /// Equal red, green and blue of an EXR file without a depth channel are depth, and so are the numbers of a TIFF file.
    pub grey_is_depth: bool,
    /// Channel of an EXR file, or array of an NPZ file; in a file with several parts also as `PART.CHANNEL`.
    ///
    /// By default the first of `Z`, `depth.Z`, `depth.V`, `depth.Y`, `depth.R` and `depth` in the file, ignoring case; then a single
    /// channel whose name ends with one of them (`ViewLayer.Depth.Z`), a `Y` without `X` or `Z`, an `R` without `G`, `B`, `A`,
    /// and the only channel of the file. A `Z` beside an `X` is not depth. Other files are refused with the list of their channels.
    pub channel: Option<String>,
    /// Layer of the colours to which the depth belongs: of several views or layers of an EXR file, its depth is read.
    pub beside: Option<ExrLayer>,
    /// Treatment of pixels whose depth is unknown.
    pub unknown: UnknownDepth,
    /// Distance from which pixels are sky (infinitely far), metres.
    pub far_from_m: Option<f64>,
    /// Negative numbers mean unknown depth instead of an error.
    pub negative_is_unknown: bool,
}

impl Default for DepthOptions {
    fn default() -> Self {
        Self {
            meaning: DepthMeaning::default(),
            scale: 1.0,
            offset: None,
            packing: DepthPacking::None,
            grey_is_depth: true,
            channel: None,
            beside: None,
            unknown: UnknownDepth::default(),
            far_from_m: None,
            negative_is_unknown: false,
        }
    }
}

impl DepthOptions {
    /// Checks the numbers.
    pub(super) fn validate(&self) -> Result<(), ImageError> {
        let positive = |what, value: f64| {
            let valid = value.is_finite() && value > 0.0;
            ImageError::require(valid, what, value, "a finite number above 0")
        };
        match self.offset {
            None => positive("the scale of depth", self.scale)?,
            Some(offset) => {
                let valid = self.scale.is_finite() && self.scale != 0.0;
                let right = "a finite number other than 0";
                ImageError::require(valid, "the scale of depth", self.scale, right)?;
                let (valid, right) = (offset.is_finite(), "a finite number");
                ImageError::require(valid, "the offset of depth", offset, right)?;
            }
        }
        if let Some(far) = self.far_from_m {
            positive("the distance in metres from which pixels are sky", far)?;
        }
        if let DepthMeaning::Disparity {
            focal_length_px,
            baseline_m,
            offset_px,
        } = self.meaning
        {
            positive("the focal length in pixels", focal_length_px)?;
            positive("the distance between the cameras in metres", baseline_m)?;
            ImageError::require(
                offset_px.is_finite(),
                "the offset of disparity in pixels",
                offset_px,
                "a finite number",
            )?;
        }
        if let DepthMeaning::Buffer { near_m, far_m, .. } = self.meaning {
            positive("the depth of the near plane in metres", near_m)?;
            let right = "beyond the near plane, or infinite";
            ImageError::require(
                far_m > near_m,
                "the depth of the far plane in metres",
                far_m,
                right,
            )?;
        }
        Ok(())
    }
}

/// Direction in which depth is measured.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash)]
pub enum DepthKind {
    /// Along the axis of the camera; [`crate::Intrinsics::ray_length_per_z`] converts to distance.
    Z,
    /// Along the ray of the pixel.
    Ray,
}

/// A depth map in memory.
#[derive(Clone, Debug, PartialEq)]
pub struct DepthMap {
    /// Width and height in pixels.
    pub size: Size,
    /// Depth of each pixel in metres, row by row from the upper left: 0 or more, infinite for sky, never NaN.
    pub metres: Vec<f32>,
    /// Direction in which depth is measured.
    pub kind: DepthKind,
    /// Sample format of the file. Eight bits are coarse for anything but disparity.
    pub bits: SampleBits,
    /// Number of pixels of unknown depth in the file.
    pub holes: u64,
    /// Number of pixels infinitely far.
    pub infinite: u64,
    /// What was converted or repaired.
    pub notes: Notes,
}

impl DepthMap {
    /// A map of known depths, in metres.
    pub fn new(size: Size, metres: Vec<f32>, kind: DepthKind) -> Self {
        Self {
            size,
            metres,
            kind,
            bits: SampleBits::Float,
            holes: 0,
            infinite: 0,
            notes: Notes::default(),
        }
    }

    /// Enlarges or reduces a map of another size to that of a picture, if both have the same aspect ratio: each pixel takes the
    /// nearest depth, since means of depths lie on no surface.
    pub fn resized_like(mut self, picture: &Picture) -> Self {
        let (from, to) = (self.size, picture.size);
        let height = u64::from(from.width()) * u64::from(to.height());
        let expected = u64::from(from.height()) * u64::from(to.width());
        // Equal to less than half a pixel of the smaller one.
        let pixel = u64::from(from.width().max(to.width()));
        if from == to || 2 * height.abs_diff(expected) >= pixel {
            return self;
        }
        let nearest = |n: u32, from: u32, to: u32| {
            ((u64::from(n) * 2 + 1) * u64::from(from) / (2 * u64::from(to))) as usize
        };
        let columns: Vec<usize> = (0..to.width())
            .map(|x| nearest(x, from.width(), to.width()))
            .collect();
        let width = from.width() as usize;
        let rows = (0..to.height()).map(|y| nearest(y, from.height(), to.height()));
        let metres = rows.flat_map(|y| columns.iter().map(move |x| y * width + x));
        self.metres = metres.map(|at| self.metres[at]).collect();
        self.infinite = self.metres.iter().filter(|m| m.is_infinite()).count() as u64;
        self.size = to;
        self.notes.add(format!(
            "depth map resized from {} x {} to {} x {}",
            from.width(),
            from.height(),
            to.width(),
            to.height()
        ));
        self
    }

    /// Least and largest depth that is not infinite, m; `None` for a map of sky.
    pub fn range_m(&self) -> Option<(f32, f32)> {
        let finite = self.metres.iter().copied().filter(|m| m.is_finite());
        finite.fold(None, |range, m| {
            let (least, largest) = range.unwrap_or((m, m));
            Some((least.min(m), largest.max(m)))
        })
    }

    /// Turns a map that lies as its picture lay in the file, which is seen by exchanged sides. Where the size leaves it open, the
    /// map is upright, and a note says so.
    pub fn turned_like(mut self, picture: &Picture) -> Self {
        let orientation = picture.orientation;
        let stored = orientation.turned(picture.size);
        if orientation == Orientation::UPRIGHT {
            return self;
        }
        if self.size == picture.size {
            if self.size == stored {
                self.notes.add("the depth map is taken to be upright");
            }
            return self;
        }
        if self.size == stored {
            self.metres = orientation.apply(self.size, 1, self.metres);
            self.size = picture.size;
            self.notes.add("the depth map is turned with the picture");
        }
        self
    }

    /// Checks that the map has the size of a picture.
    ///
    /// # Errors
    /// [`ImageError::SizesDiffer`].
    pub fn check_against(&self, picture: &Picture) -> Result<(), ImageError> {
        if self.size == picture.size {
            Ok(())
        } else {
            Err(ImageError::SizesDiffer {
                depth: (self.size.width(), self.size.height()),
                picture: (picture.size.width(), picture.size.height()),
                exif_orientation: (picture.orientation != Orientation::UPRIGHT)
                    .then(|| picture.orientation.exif()),
            })
        }
    }
}

/// Depth from which a pixel is sky, metres: renderers write 1e10 and more where a ray leaves the scene.
const SKY_M: f64 = 1e9;

/// Number from which a pixel is sky at any scale.
const SKY: f32 = 9.9e9;

/// Pixels that a thread converts at a time, and those of them whose numbers it keeps until their signs are known.
const BLOCK: usize = 1 << 14;
const PIECE: usize = 1 << 8;

/// A depth map in the numbers of its file.
pub(super) struct RawDepth {
    pub(super) size: Size,
    pub(super) values: Vec<f32>,
    pub(super) bits: SampleBits,
}

/// Depth from red, green and blue, interleaved, that must be equal.
pub(super) fn of_equal_components(rgb: &[f32]) -> Result<Vec<f32>, DecodeError> {
    let pixels = rgb.as_chunks::<3>().0;
    let is_grey = |[r, g, b]: &[f32; 3]| r.total_cmp(g).is_eq() && g.total_cmp(b).is_eq();
    if pixels.iter().all(is_grey) {
        return Ok(pixels.iter().map(|[r, ..]| *r).collect());
    }
    Err(DecodeError::invalid(
        "expected one number to a pixel or equal red, green and blue, got colours; try depth-packing for depth in their bits, \
         or depth-channel with a name",
    ))
}

/// Number of pixels of each kind.
#[derive(Clone, Copy, Default)]
struct Counts {
    holes: u64,
    infinite: u64,
    negative: u64,
    /// Index and value of the first negative pixel.
    first_negative: Option<(usize, f32)>,
}

impl Counts {
    fn and(self, later: Self) -> Self {
        Self {
            holes: self.holes + later.holes,
            infinite: self.infinite + later.infinite,
            negative: self.negative + later.negative,
            first_negative: self.first_negative.or(later.first_negative),
        }
    }
}

impl RawDepth {
    /// The map in metres; holes are NaN.
    pub(super) fn into_map(
        mut self,
        path: &Path,
        options: &DepthOptions,
    ) -> Result<DepthMap, ImageError> {
        let counts = self.convert(options);
        let width = self.size.width() as usize;
        if let Some((at, value)) = counts.first_negative {
            return Err(ImageError::NegativeDepth {
                path: path.to_owned(),
                count: counts.negative,
                x: (at % width) as u32,
                y: (at / width) as u32,
                value,
            });
        }
        if counts.holes == self.values.len() as u64 {
            return Err(ImageError::Read {
                path: path.to_owned(),
                reason: format!(
                    "expected at least one pixel of known depth, got {} holes ({})",
                    counts.holes,
                    holes_of(&options.meaning)
                ),
            });
        }
        let kind = match options.meaning {
            DepthMeaning::RayDistance => DepthKind::Ray,
            _ => DepthKind::Z,
        };
        Ok(DepthMap {
            bits: self.bits,
            holes: counts.holes,
            infinite: counts.infinite,
            ..DepthMap::new(self.size, self.values, kind)
        })
    }

    /// Converts the numbers to metres in place, holes to NaN.
    fn convert(&mut self, options: &DepthOptions) -> Counts {
        let scale = options.scale;
        match (options.meaning, options.offset) {
            // The most common kind, without branches.
            (DepthMeaning::ZDepth | DepthMeaning::RayDistance, None) => {
                self.convert_by(options, |value| scaled_depth(value, scale))
            }
            (DepthMeaning::Buffer { .. }, _) => {
                let largest = match self.bits {
                    SampleBits::U8 => 255.0,
                    SampleBits::U16 => 65_535.0,
                    SampleBits::U32 => 4_294_967_295.0,
                    SampleBits::Half | SampleBits::Float => 1.0,
                };
                let options = DepthOptions {
                    scale: scale / largest,
                    ..options.clone()
                };
                self.convert_by(&options, |value| interpret(value, &options))
            }
            _ => self.convert_by(options, |value| interpret(value, options)),
        }
    }

    /// Converts with a function to metres: NaN where depth is unknown, below 0 where it is negative.
    fn convert_by(&mut self, options: &DepthOptions, metres: impl Fn(f32) -> f64 + Sync) -> Counts {
        let far = options.far_from_m.unwrap_or(SKY_M);
        let far = far.min(SKY_M);
        let convert = |block: usize, values: &mut [f32]| {
            let mut counts = Counts::default();
            let mut given = [0.0; PIECE];
            for (piece, values) in values.chunks_mut(PIECE).enumerate() {
                let given = &mut given[..values.len()];
                given.copy_from_slice(values);
                let (mut infinite, mut holes, mut negative) = (0u32, 0u32, 0u32);
                for value in values {
                    let metres = metres(*value);
                    let is_known = metres >= 0.0;
                    let is_far = metres >= far;
                    holes += u32::from(!is_known);
                    infinite += u32::from(is_far);
                    negative += u32::from(metres < 0.0);
                    let known = if is_known { metres as f32 } else { f32::NAN };
                    *value = if is_far { f32::INFINITY } else { known };
                }
                counts.holes += u64::from(holes);
                counts.infinite += u64::from(infinite);
                if negative > 0 && !options.negative_is_unknown {
                    counts.negative += u64::from(negative);
                    let first = given.iter().position(|&value| metres(value) < 0.0);
                    let first = first.map(|at| (block * BLOCK + piece * PIECE + at, given[at]));
                    counts.first_negative = counts.first_negative.or(first);
                }
            }
            counts
        };
        let blocks = self.values.par_chunks_mut(BLOCK).enumerate();
        blocks
            .map(|(block, values)| convert(block, values))
            .reduce(Counts::default, Counts::and)
    }
}

/// Numbers that mean unknown depth.
fn holes_of(meaning: &DepthMeaning) -> &'static str {
    match meaning {
        DepthMeaning::ZDepth | DepthMeaning::RayDistance => "0 or NaN",
        DepthMeaning::Disparity { .. } => "0, infinite or NaN",
        DepthMeaning::Inverse => "infinite or NaN",
        DepthMeaning::Buffer { .. } => "NaN",
    }
}

/// Depth of a number that is proportional to it, m: NaN where it is unknown.
#[inline(always)]
fn scaled_depth(value: f32, scale: f64) -> f64 {
    // Comparisons of the wide number, so that the compiler vectorizes all of it.
    let value = f64::from(value);
    let known = if value == 0.0 {
        f64::NAN
    } else {
        value * scale
    };
    if value >= f64::from(SKY) {
        f64::INFINITY
    } else {
        known
    }
}

/// Depth of a number, m: NaN where it is unknown, below 0 where it is negative.
fn interpret(value: f32, options: &DepthOptions) -> f64 {
    let scaled = f64::from(value) * options.scale;
    match options.meaning {
        _ if value.is_nan() => f64::NAN,
        DepthMeaning::ZDepth | DepthMeaning::RayDistance => match options.offset {
            None => scaled_depth(value, options.scale),
            Some(_) if value >= SKY => f64::INFINITY,
            Some(offset) => scaled + offset,
        },
        DepthMeaning::Disparity {
            focal_length_px,
            baseline_m,
            offset_px,
        } => {
            let disparity = scaled + offset_px;
            if value == 0.0 || value.is_infinite() {
                f64::NAN
            } else if disparity <= 0.0 {
                f64::INFINITY
            } else {
                focal_length_px * baseline_m / disparity
            }
        }
        DepthMeaning::Inverse => match value {
            v if v.is_infinite() && options.offset.is_some() => f64::NAN,
            f32::INFINITY => f64::NAN,
            // Affine inverse depth is uncertain at its far end: below 0 is as far as 0.
            _ if let Some(offset) = options.offset => 1.0 / (scaled + offset).max(0.0),
            v if v < 0.0 => scaled,
            // 1 / 0 is infinite.
            _ => 1.0 / scaled.abs(),
        },
        DepthMeaning::Buffer {
            near_m,
            far_m,
            is_reversed,
        } => {
            // Linear in the reciprocal of depth.
            let nearness = if is_reversed { scaled } else { 1.0 - scaled };
            if scaled < 0.0 {
                scaled
            } else if nearness <= 0.0 {
                f64::INFINITY
            } else {
                1.0 / (nearness / near_m + (1.0 - nearness) / far_m)
            }
        }
    }
}
