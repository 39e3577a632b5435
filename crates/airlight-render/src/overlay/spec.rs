//! [`OverlaySpec`]: colour picture, depth map and light level of an overlay.

use super::ExistingAerial;
use crate::RenderError;
use airlight::fog::lights::LightForm;
use airlight_image::frame::{Intrinsics, PixelCentres};
use airlight_image::input::{DepthMeaning, DepthOptions, DepthPacking, UnknownDepth, is_tiff_name};
use airlight_image::{ImageError, Size};
use serde::{Deserialize, Serialize};
use std::path::{Path, PathBuf};

/// Meaning of the values of a depth file.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Hash)]
#[non_exhaustive]
pub enum DepthFileKind {
    /// Depth along the camera's axis.
    #[default]
    Z,
    /// Distance along the ray of the pixel.
    Ray,
    /// Stereo disparity, pixels: needs a focal length in pixels and a baseline.
    Disparity,
    /// Inverse depth along the camera's axis.
    Inverse,
    /// Depth buffer, 0 at the near plane and 1 at the far plane: needs the near plane.
    Buffer,
    /// Depth buffer, 1 at the near plane and 0 at the far plane: needs the near plane.
    ReversedBuffer,
}

airlight::named! { DepthFileKind, "a kind of depth", [
    ("z", (Z), "depth along the camera's axis"),
    ("ray", (Ray), "distance along the ray of the pixel"),
    ("disparity", (Disparity), "stereo disparity, pixels: needs a focal length in pixels and a baseline"),
    ("inverse", (Inverse), "inverse depth"),
    ("buffer", (Buffer), "depth buffer, 0 at the near plane to 1 at the far plane: needs the near plane"),
    ("reversed-buffer", (ReversedBuffer), "depth buffer, 1 at the near plane to 0 at the far plane: needs the near plane"),
] }

/// Treatment of negative depths.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Hash)]
#[non_exhaustive]
pub enum NegativeDepth {
    /// An error, which names the first.
    #[default]
    Refuse,
    /// Unknown depth.
    Unknown,
}

airlight::named! { NegativeDepth, "a treatment of negative depth", [
    ("refuse", (Refuse), "an error"),
    ("unknown", (Unknown), "unknown depth"),
] }

/// Colour picture, depth map and light level of an overlay: the table `[overlay]` of a scene file.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
#[serde(default, deny_unknown_fields)]
#[cfg_attr(feature = "schema", derive(schemars::JsonSchema))]
pub struct OverlaySpec {
    /// Colour picture: EXR, HDR or TIFF of floats (linear), PNG, JPEG or TIFF of integers (decoded to light and encoded again); for a
    /// batch, a folder or pattern.
    pub colour: PathBuf,
    /// Layer of an EXR colour picture; `None`: its plain colours, else those of a layer called `Combined` or the only ones.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub colour_layer: Option<String>,
    /// Depth map; `None`: the depth channel of the colour picture.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub depth: Option<PathBuf>,
    /// Meaning of the depth map's values.
    pub depth_kind: DepthFileKind,
    /// Metres for each unit of depth (disparity: pixels, inverse: 1/m), above 0; with `depth_offset` also below.
    pub depth_scale: f64,
    /// Added to scaled depth, m (inverse: 1/m), as for normalised depth; 0 in the file is then not unknown.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub depth_offset: Option<f64>,
    /// How the components of a colour PNG hold depth; `None`: one number to a pixel.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub depth_packing: Option<DepthPacking>,
    /// Channel of an EXR depth file.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub depth_channel: Option<String>,
    /// Treatment of negative depths; `None`: an error.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub negative: Option<NegativeDepth>,
    /// Treatment of pixels of unknown depth.
    pub holes: UnknownDepth,
    /// Pixels at this distance or beyond are sky, m.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub far_m: Option<f64>,
    /// Distance between the two cameras of a disparity map, m.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub baseline_m: Option<f64>,
    /// Difference of the principal points of the two cameras, added to disparities, pixels.
    pub disparity_offset_px: f64,
    /// Depth of the near plane of a depth buffer, m.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub near_plane_m: Option<f64>,
    /// Depth of the far plane of a depth buffer, m; `None`: infinite. What reaches it is sky.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub far_plane_m: Option<f64>,
    /// Focal length, pixels, instead of a field of view.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub focal_px: Option<f64>,
    /// Principal point, pixels from the upper left corner with pixel centres at whole numbers; `None`: the centre. Needs
    /// `focal_px`.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub principal_point_px: Option<[f64; 2]>,
    /// Radiance of the ambient light, linear, in the picture's unit; `None`: estimated from the picture.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub ambient: Option<[f64; 3]>,
    /// Factor on the ambient light, above 0.
    pub ambient_scale: f64,
    /// Irradiance of the sun on a surface that faces it, relative to the irradiance by the ambient light (pi times its radiance);
    /// `None`: 3.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub sun_strength: Option<f64>,
    /// Whether the fog is lit by the solved sky with its sun, moon and stars instead of the picture's ambient light.
    pub sky_light: bool,
    /// Units of the picture in one cd/m^2 of the solved sky; `None`: from the white luminance stated in the file, otherwise matched
    /// to the picture.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub radiance_scale: Option<f64>,
    /// Whether the picture shows the clear air in front of its objects.
    pub air: ExistingAerial,
    /// Form of the light scattered from the scene's lights.
    pub light_form: LightForm,
    /// Whether transmittance, path radiance and distance are written as additional layers (EXR).
    pub layers: bool,
}

impl Default for OverlaySpec {
    fn default() -> Self {
        Self {
            colour: PathBuf::new(),
            colour_layer: None,
            depth: None,
            depth_kind: DepthFileKind::Z,
            depth_scale: 1.0,
            depth_offset: None,
            depth_packing: None,
            negative: None,
            depth_channel: None,
            holes: UnknownDepth::Fill,
            far_m: None,
            baseline_m: None,
            disparity_offset_px: 0.0,
            near_plane_m: None,
            far_plane_m: None,
            focal_px: None,
            principal_point_px: None,
            ambient: None,
            ambient_scale: 1.0,
            sun_strength: None,
            sky_light: false,
            radiance_scale: None,
            air: ExistingAerial::Drawn,
            light_form: LightForm::Exact,
            layers: false,
        }
    }
}

impl OverlaySpec {
    /// Error for colour files that hold no depth and have no depth map.
    pub(crate) fn without_depth(&self) -> RenderError {
        RenderError::value(
            "overlay.depth",
            "a depth map, since only EXR pictures hold depth",
            format!("none for `{}`", self.colour.display()),
            "depth.npy, or a folder or pattern for several",
        )
    }

    /// Ending of the output of a picture in a folder: that of the picture, but `exr` for layers and `png` for TIFF, which is not
    /// written.
    pub fn ending_in_folder(&self, colour: &Path) -> String {
        match colour.extension() {
            _ if self.layers => "exr".to_owned(),
            _ if is_tiff_name(colour) => "png".to_owned(),
            ending => ending.unwrap_or_default().to_string_lossy().into_owned(),
        }
    }

    /// Options for reading the depth file.
    ///
    /// # Errors
    /// [`RenderError::Setting`] for a disparity map without focal length or baseline.
    pub fn depth_options(&self) -> Result<DepthOptions, RenderError> {
        let meaning = match self.depth_kind {
            DepthFileKind::Z => DepthMeaning::ZDepth,
            DepthFileKind::Ray => DepthMeaning::RayDistance,
            DepthFileKind::Inverse => DepthMeaning::Inverse,
            DepthFileKind::Buffer | DepthFileKind::ReversedBuffer => match self.near_plane_m {
                Some(near_m) => DepthMeaning::Buffer {
                    near_m,
                    far_m: self.far_plane_m.unwrap_or(f64::INFINITY),
                    is_reversed: self.depth_kind == DepthFileKind::ReversedBuffer,
                },
                None => {
                    return Err(RenderError::value(
                        "overlay.near_plane_m",
                        "the depth of the near plane of a depth buffer",
                        "none",
                        "0.1, which is that of many programs",
                    ));
                }
            },
            DepthFileKind::Disparity => match (self.focal_px, self.baseline_m) {
                (Some(focal_length_px), Some(baseline_m)) => DepthMeaning::Disparity {
                    focal_length_px,
                    baseline_m,
                    offset_px: self.disparity_offset_px,
                },
                _ => {
                    return Err(RenderError::setting(
                        "depth-kind disparity: expected a focal length in pixels and a baseline, got one or none of them; try \
                         focal-px with baseline-m",
                    ));
                }
            },
        };
        if let (Some(plane_m), false) = (
            self.near_plane_m.or(self.far_plane_m),
            matches!(meaning, DepthMeaning::Buffer { .. }),
        ) {
            let key = match self.near_plane_m {
                Some(_) => "overlay.near_plane_m",
                None => "overlay.far_plane_m",
            };
            return Err(RenderError::value(
                key,
                format!("a depth buffer, unlike depth-kind {}", self.depth_kind),
                plane_m.to_string(),
                "depth-kind buffer, or reversed-buffer",
            ));
        }
        if self.depth_offset.is_none() && self.depth_scale <= 0.0 {
            return Err(RenderError::value(
                "overlay.depth_scale",
                "a number above 0, or an offset for depth that decreases",
                self.depth_scale.to_string(),
                "depth-offset with the depth of 0, in metres",
            ));
        }
        let advice = match meaning {
            DepthMeaning::Disparity { .. } => Some("disparity-offset-px"),
            DepthMeaning::Buffer { .. } => Some("leaving it out"),
            _ => None,
        };
        if let (Some(_), Some(advice)) = (self.depth_offset, advice) {
            return Err(RenderError::value(
                "overlay.depth_offset",
                "depth, distance or inverse depth",
                self.depth_kind.to_string(),
                advice,
            ));
        }
        Ok(DepthOptions {
            meaning,
            scale: self.depth_scale,
            offset: self.depth_offset,
            packing: self.depth_packing.unwrap_or_default(),
            grey_is_depth: true,
            channel: self.depth_channel.clone(),
            beside: None,
            unknown: self.holes,
            far_from_m: self.far_m,
            negative_is_unknown: self.negative == Some(NegativeDepth::Unknown),
        })
    }

    /// The camera of a picture of this size, looking north. Its horizontal field of view is `fov_deg` unless a focal length is set.
    ///
    /// # Errors
    /// [`ImageError::Setting`] for numbers out of range.
    pub(super) fn camera(&self, size: Size, fov_deg: f64) -> Result<Intrinsics, ImageError> {
        let Some(focal) = self.focal_px else {
            return Intrinsics::from_horizontal_fov(size, fov_deg);
        };
        let middle = |n: u32| 0.5 * f64::from(n) - 0.5;
        let principal = self
            .principal_point_px
            .map_or((middle(size.width()), middle(size.height())), |[x, y]| {
                (x, y)
            });
        Intrinsics::new(size, (focal, focal), principal, PixelCentres::Whole)
    }
}
