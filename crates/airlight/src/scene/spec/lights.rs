//! Point, spot and sphere lights.

use crate::names::named;

/// Kind of a light.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
#[non_exhaustive]
pub enum LightKind {
    /// Shines equally in all directions.
    #[default]
    Point,
    /// Shines into a cone.
    Spot,
    /// A glowing sphere.
    Sphere,
}

named! { LightKind, "a kind of light", [
    ("point", (Point), "the same intensity in all directions"),
    ("spot", (Spot), "a cone"),
    ("sphere", (Sphere), "a luminous sphere"),
] }

/// A light: where it is, how bright, and where it shines. It is placed by `position_m`, or by `pixel` of a picture.
#[derive(Clone, Debug, Default, PartialEq)]
#[cfg_attr(feature = "serde", derive(serde::Serialize, serde::Deserialize))]
#[cfg_attr(feature = "serde", serde(default, deny_unknown_fields))]
#[cfg_attr(feature = "schema", derive(schemars::JsonSchema))]
pub struct LightSpec {
    /// Point, spot or sphere.
    pub kind: LightKind,
    /// Position, m east, up and south of the ground under the camera.
    pub position_m: Option<[f64; 3]>,
    /// On the ray of this pixel, instead of `position_m`; x to the right and y down, pixel centres at whole numbers.
    pub pixel: Option<[f64; 2]>,
    /// Distance along the ray of `pixel`, m, above 0. Default: that of the surface in the picture.
    pub distance_m: Option<f64>,
    /// Radiant intensity in red, green and blue, in the picture's unit times m^2: it gives the irradiance intensity / r^2.
    pub intensity: [f64; 3],
    /// Radius, m, above 0: of a sphere its size; of a point or spot, no ray passes closer. Default: a quarter of a pixel.
    pub radius_m: Option<f64>,
    /// Azimuth that a spot shines to, degrees clockwise from north. Default: 0.
    pub azimuth_deg: Option<f64>,
    /// Elevation that a spot shines to, degrees, -90 to 90. Default: -90, straight down.
    pub elevation_deg: Option<f64>,
    /// Angle from the axis of a spot up to which it has all its intensity, degrees, 0 to 90. Default: 20.
    pub inner_deg: Option<f64>,
    /// Angle from the axis of a spot beyond which it has none, degrees, 0 to 90. Default: 40.
    pub outer_deg: Option<f64>,
}
