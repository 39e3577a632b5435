//! The kinds of projection and their settings.

use crate::{ImageError, Size};

/// How directions are laid out in a picture.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum Projection {
    /// The whole sphere: azimuth grows evenly from left to right as seen from inside, elevation falls evenly from the
    /// zenith (top edge) to the nadir. With north in the middle, west is on the left and east on the right.
    ///
    /// OpenEXR's own latitude-longitude environment maps look along +z in the middle: here that is south, 180 degrees.
    Equirectangular {
        /// Azimuth of the middle of the picture, degrees clockwise from north.
        center_azimuth_deg: f64,
    },
    /// One side of a cube, laid out for sampling by world direction in a graphics API.
    CubeFace(CubeFace),
    /// Angle from the centre direction in proportion to distance from the middle of the picture.
    AngularFisheye(Fisheye),
    /// Straight lines stay straight.
    Perspective(Camera),
}

/// Sides of a cube map, named by the world axis they face (x east, y up, z south).
///
/// Each picture is laid out as OpenGL and Vulkan expect it, so that sampling the cube with a world direction gives the
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
/// Cube maps are defined in left-handed axes, so each picture by itself is the mirror image of what the eye sees.
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

impl CubeFace {
    /// All six, in the order of graphics APIs: layer 0 to 5.
    pub const ALL: [Self; 6] = [
        Self::PositiveX,
        Self::NegativeX,
        Self::PositiveY,
        Self::NegativeY,
        Self::PositiveZ,
        Self::NegativeZ,
    ];

    /// A short name for files: `px`, `nx`, `py`, `ny`, `pz`, `nz`.
    pub fn name(self) -> &'static str {
        match self {
            Self::PositiveX => "px",
            Self::NegativeX => "nx",
            Self::PositiveY => "py",
            Self::NegativeY => "ny",
            Self::PositiveZ => "pz",
            Self::NegativeZ => "nz",
        }
    }
}

/// An equidistant fisheye. Its circle is the largest that fits the picture; outside it nothing is seen.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Fisheye {
    /// Azimuth of the middle, degrees clockwise from north. For a middle at the zenith it says which way the *bottom*
    /// of the picture lies: 180 puts north on top and east on the left, as on a star chart.
    pub azimuth_deg: f64,
    /// Elevation of the middle above the horizon, degrees, in `[-90, 90]`.
    pub elevation_deg: f64,
    /// Angle across the circle, degrees, above 0 and at most 360.
    pub field_of_view_deg: f64,
}

impl Fisheye {
    /// The whole sky: zenith in the middle, horizon round the edge, north on top, east on the left.
    pub const ALL_SKY: Self = Self {
        azimuth_deg: 180.0,
        elevation_deg: 90.0,
        field_of_view_deg: 180.0,
    };
}

/// A pinhole camera.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Camera {
    /// Azimuth of the middle of the picture, degrees clockwise from north.
    pub azimuth_deg: f64,
    /// Elevation of the middle above the horizon, degrees, in `[-90, 90]`.
    pub elevation_deg: f64,
    /// Turn of the camera about its axis, degrees, clockwise as seen by the photographer: the horizon then falls to
    /// the left.
    pub roll_deg: f64,
    /// Angle from the top to the bottom edge, degrees, above 0 and below 180.
    pub vertical_fov_deg: f64,
}

impl Camera {
    /// A level camera given its field of view from the left to the right edge (degrees, above 0 and below 180) of a
    /// picture of this size.
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
            // An angle beyond 180 degrees stays wrong, and is refused with the frame.
            vertical_fov_deg: if horizontal_fov_deg < 180.0 {
                half.atan().to_degrees() * 2.0
            } else {
                horizontal_fov_deg
            },
        }
    }
}

impl Projection {
    pub(super) fn check(&self, size: Size) -> Result<(), ImageError> {
        match self {
            Self::Equirectangular { center_azimuth_deg } => azimuth(*center_azimuth_deg),
            Self::CubeFace(_) if size.width() != size.height() => Err(ImageError::Setting {
                what: "a cube face",
                got: format!("{} x {}", size.width(), size.height()),
                right: "as wide as high",
            }),
            Self::CubeFace(_) => Ok(()),
            Self::AngularFisheye(fisheye) => {
                azimuth(fisheye.azimuth_deg)?;
                elevation(fisheye.elevation_deg)?;
                let angle = fisheye.field_of_view_deg;
                demand(
                    angle > 0.0 && angle <= 360.0,
                    "the fisheye's field of view in degrees",
                    angle,
                    "above 0 and at most 360",
                )
            }
            Self::Perspective(camera) => {
                azimuth(camera.azimuth_deg)?;
                elevation(camera.elevation_deg)?;
                demand(
                    camera.roll_deg.is_finite(),
                    "the roll in degrees",
                    camera.roll_deg,
                    "a finite number",
                )?;
                let angle = camera.vertical_fov_deg;
                demand(
                    angle > 0.0 && angle < 180.0,
                    "the camera's field of view in degrees",
                    angle,
                    "above 0 and below 180",
                )
            }
        }
    }
}

pub(super) fn azimuth(degrees: f64) -> Result<(), ImageError> {
    demand(
        degrees.is_finite(),
        "the azimuth in degrees",
        degrees,
        "a finite number",
    )
}

pub(super) fn elevation(degrees: f64) -> Result<(), ImageError> {
    demand(
        (-90.0..=90.0).contains(&degrees),
        "the elevation in degrees",
        degrees,
        "between -90 and 90",
    )
}

pub(super) fn demand(
    fulfilled: bool,
    what: &'static str,
    got: f64,
    right: &'static str,
) -> Result<(), ImageError> {
    if fulfilled {
        Ok(())
    } else {
        Err(ImageError::Setting {
            what,
            got: got.to_string(),
            right,
        })
    }
}
