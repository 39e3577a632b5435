//! Depth maps: the distance of what each pixel shows.

use super::picture::{Picture, SampleBits};
use crate::{ImageError, Size};

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
                depth: (self.size.width(), self.size.height()),
                picture: (picture.size.width(), picture.size.height()),
            })
        }
    }
}

impl DepthOptions {
    /// Checks the numbers.
    ///
    /// # Errors
    /// [`ImageError::Setting`] for one out of range.
    pub(super) fn check(&self) -> Result<(), ImageError> {
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
