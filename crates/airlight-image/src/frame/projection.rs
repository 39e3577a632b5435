//! Kinds of projection and their settings.

use super::axes::CameraAxes;
use crate::{ImageError, Size};
use glam::DVec3;

/// Mapping of directions to a picture.
#[derive(Clone, Copy, Debug, PartialEq)]
#[non_exhaustive]
pub enum Projection {
    /// The whole sphere: azimuth increases linearly from left to right, elevation decreases linearly from the zenith (top
    /// edge) to the nadir. With north in the centre, west is on the left and east on the right.
    ///
    /// OpenEXR's latitude-longitude environment maps differ: they have south (+z) in the centre, and the outermost samples lie on
    /// the poles and the seam.
    Equirectangular {
        /// Azimuth of the centre of the picture, degrees clockwise from north.
        center_azimuth_deg: f64,
    },
    /// A face of a cube map for sampling by world direction in a graphics API.
    CubeFace(CubeFace),
    /// A face of a cube map for programs that sample it with the direction mirrored in x, as three.js' `CubeTextureLoader` does:
    /// the face +X is what the eye sees towards -X, and no face is a mirror image.
    MirroredCubeFace(CubeFace),
    /// Equidistant: the angle from the central direction is proportional to the distance from the centre of the picture.
    AngularFisheye(Fisheye),
    /// Rectilinear: a pinhole camera.
    Perspective(Camera),
}

/// Faces of a cube map, named by the world axis they face (x east, y up, z south).
///
/// The layout is that of OpenGL and Vulkan, so that sampling the cube with a world direction gives the
/// radiance in that direction: with `s` to the right and `t` down, both in `[-1, 1]`,
///
/// | face | direction |
/// |---|---|
/// | +X east | `( 1, -t, -s)` |
/// | -X west | `(-1, -t,  s)` |
/// | +Y up | `( s,  1,  t)` |
/// | -Y down | `( s, -1, -t)` |
/// | +Z south | `( s, -t,  1)` |
/// | -Z north | `(-s, -t, -1)` |
///
/// Cube maps are defined in left-handed axes: each face is the mirror image of the view.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash)]
pub enum CubeFace {
    /// +X, east.
    PositiveX,
    /// -X, west.
    NegativeX,
    /// +Y, up.
    PositiveY,
    /// -Y, down.
    NegativeY,
    /// +Z, south.
    PositiveZ,
    /// -Z, north.
    NegativeZ,
}

airlight::named! { CubeFace, "a cube face", [
    ("px", (PositiveX), "+X, east"),
    ("nx", (NegativeX), "-X, west"),
    ("py", (PositiveY), "+Y, up"),
    ("ny", (NegativeY), "-Y, down"),
    ("pz", (PositiveZ), "+Z, south"),
    ("nz", (NegativeZ), "-Z, north"),
] }

/// An equidistant fisheye. Its circle is the largest that fits the picture; pixels outside show nothing.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Fisheye {
    /// Azimuth of the centre, degrees clockwise from north. With the zenith in the centre it is the azimuth of the *bottom* of the
    /// picture: 180 has north at the top and east on the left, as on a star chart.
    pub azimuth_deg: f64,
    /// Elevation of the centre above the horizon, degrees, in `[-90, 90]`.
    pub elevation_deg: f64,
    /// Angle across the circle, degrees, above 0 and at most 360.
    pub field_of_view_deg: f64,
}

impl Fisheye {
    /// The whole sky: zenith in the centre, horizon at the edge, north at the top, east on the left.
    pub const ALL_SKY: Self = Self {
        azimuth_deg: 180.0,
        elevation_deg: 90.0,
        field_of_view_deg: 180.0,
    };

    /// Right, up and forward of the centre: unit vectors in the world axes of [`airlight::axes`].
    pub fn axes(&self) -> [DVec3; 3] {
        CameraAxes::new(self.azimuth_deg, self.elevation_deg, 0.0).to_array()
    }
}

/// A pinhole camera.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Camera {
    /// Azimuth of the centre of the picture, degrees clockwise from north.
    pub azimuth_deg: f64,
    /// Elevation of the centre above the horizon, degrees, in `[-90, 90]`.
    pub elevation_deg: f64,
    /// Roll about the axis, degrees, clockwise as seen by the photographer: the horizon then tilts down to the left.
    pub roll_deg: f64,
    /// Angle from the top to the bottom edge, degrees, above 0 and below 180.
    pub vertical_fov_deg: f64,
}

impl Camera {
    /// Right, up and forward: unit vectors in the world axes of [`airlight::axes`].
    pub fn axes(&self) -> [DVec3; 3] {
        CameraAxes::new(self.azimuth_deg, self.elevation_deg, self.roll_deg).to_array()
    }

    /// A camera without roll from its horizontal field of view (degrees, above 0 and below 180) in a picture of this size.
    pub fn with_horizontal_fov(
        azimuth_deg: f64,
        elevation_deg: f64,
        horizontal_fov_deg: f64,
        size: Size,
    ) -> Self {
        let aspect = f64::from(size.height()) / f64::from(size.width());
        let half = (horizontal_fov_deg.to_radians() / 2.0).tan() * aspect;
        Self {
            azimuth_deg,
            elevation_deg,
            roll_deg: 0.0,
            // An angle beyond 180 degrees stays invalid, and is refused with the frame.
            vertical_fov_deg: if horizontal_fov_deg < 180.0 {
                half.atan().to_degrees() * 2.0
            } else {
                horizontal_fov_deg
            },
        }
    }
}

impl Projection {
    /// Name of the kind of projection, such as "equirectangular" or "cube face".
    pub fn name(&self) -> &'static str {
        match self {
            Self::Equirectangular { .. } => "equirectangular",
            Self::CubeFace(_) => "cube face",
            Self::MirroredCubeFace(_) => "cube face mirrored in x",
            Self::AngularFisheye(_) => "fisheye",
            Self::Perspective(_) => "perspective",
        }
    }

    pub(super) fn check(&self, size: Size) -> Result<(), ImageError> {
        match self {
            Self::Equirectangular { center_azimuth_deg } => check_azimuth(*center_azimuth_deg),
            Self::CubeFace(_) | Self::MirroredCubeFace(_) if size.width() != size.height() => {
                Err(ImageError::Setting {
                    what: "a cube face",
                    got: format!("{} x {}", size.width(), size.height()),
                    right: "as wide as high",
                })
            }
            Self::CubeFace(_) | Self::MirroredCubeFace(_) => Ok(()),
            Self::AngularFisheye(fisheye) => {
                check_azimuth(fisheye.azimuth_deg)?;
                check_elevation(fisheye.elevation_deg)?;
                let angle = fisheye.field_of_view_deg;
                ImageError::require(
                    angle > 0.0 && angle <= 360.0,
                    "the fisheye's field of view in degrees",
                    angle,
                    "above 0 and at most 360",
                )
            }
            Self::Perspective(camera) => {
                check_azimuth(camera.azimuth_deg)?;
                check_elevation(camera.elevation_deg)?;
                ImageError::require(
                    camera.roll_deg.is_finite(),
                    "the roll in degrees",
                    camera.roll_deg,
                    "a finite number",
                )?;
                let angle = camera.vertical_fov_deg;
                ImageError::require(
                    angle > 0.0 && angle < 180.0,
                    "the camera's field of view in degrees",
                    angle,
                    "above 0 and below 180",
                )
            }
        }
    }
}

pub(super) fn check_azimuth(degrees: f64) -> Result<(), ImageError> {
    ImageError::require(
        degrees.is_finite(),
        "the azimuth in degrees",
        degrees,
        "a finite number",
    )
}

pub(super) fn check_elevation(degrees: f64) -> Result<(), ImageError> {
    ImageError::require(
        (-90.0..=90.0).contains(&degrees),
        "the elevation in degrees",
        degrees,
        "between -90 and 90",
    )
}
