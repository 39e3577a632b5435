//! Point, spot and sphere lights.

use crate::names::named;

/// Shape and directionality of a light.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
#[non_exhaustive]
pub enum LightKind {
    /// The same intensity in all directions.
    #[default]
    Point,
    /// Intensity in a cone.
    Spot,
    /// A sphere of uniform radiance.
    Sphere,
}

named! { LightKind, "a kind of light", [
    ("point", (Point), "the same intensity in all directions"),
    ("spot", (Spot), "intensity in a cone"),
    ("sphere", (Sphere), "a sphere of uniform radiance"),
] }

/// A light, placed by `position_m` or by a `pixel` of a picture.
#[derive(Clone, Debug, Default, PartialEq)]
#[cfg_attr(feature = "serde", derive(serde::Serialize, serde::Deserialize))]
#[cfg_attr(feature = "serde", serde(default, deny_unknown_fields))]
#[cfg_attr(feature = "schema", derive(schemars::JsonSchema))]
pub struct LightSpec {
    /// Point, spot or sphere. Default: point.
    pub kind: LightKind,
    /// Position, m east, up and south of the ground below the camera.
    pub position_m: Option<[f64; 3]>,
    /// Pixel of a picture on whose ray the light lies, instead of `position_m`: x to the right, y down, pixel centres at whole
    /// numbers.
    pub pixel: Option<[f64; 2]>,
    /// Distance along the ray of `pixel`, m, above 0. Default: that of the surface in the picture.
    pub distance_m: Option<f64>,
    /// Radiant intensity in red, green and blue, in the picture's unit times m^2; it causes the irradiance intensity / r^2.
    pub intensity: [f64; 3],
    /// Radius of a sphere, or smallest distance of rays from a point or spot light, m, above 0. Default: a quarter of a pixel.
    pub radius_m: Option<f64>,
    /// Azimuth of a spot's axis, degrees clockwise from north. Default: 0.
    pub azimuth_deg: Option<f64>,
    /// Elevation of a spot's axis, degrees, -90 to 90. Default: -90, straight down.
    pub elevation_deg: Option<f64>,
    /// Angle from a spot's axis up to which the intensity is full, degrees, 0 to 90. Default: 20.
    pub inner_deg: Option<f64>,
    /// Angle from a spot's axis beyond which the intensity is 0, degrees, 0 to 90. Default: 40.
    pub outer_deg: Option<f64>,
}
