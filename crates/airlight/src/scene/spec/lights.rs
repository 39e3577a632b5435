//! Point, spot and sphere lights.

use crate::axes;
use crate::fog::FogError;
use crate::fog::lights::{Light, PointLight, SphereLight, SpotLight};
use crate::names::named;
use glam::DVec3;
use std::f64::consts::PI;

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

impl LightSpec {
    /// The light at a position, m, whatever position it states. `usual_radius_m` holds where it states no radius.
    ///
    /// # Errors
    /// [`FogError`] for numbers out of range.
    pub fn at(&self, position: DVec3, usual_radius_m: f64) -> Result<Light<[f32; 3]>, FogError> {
        let radius_m = self.radius_m.unwrap_or(usual_radius_m);
        let intensity = self.intensity.map(|v| v as f32);
        match self.kind {
            LightKind::Point => PointLight::new(position, intensity, radius_m).map(Light::Point),
            LightKind::Spot => {
                let [inner_rad, outer_rad] = self.cone_deg().map(f64::to_radians);
                let axis = axes::direction(
                    self.azimuth_deg.unwrap_or(0.0),
                    self.elevation_deg.unwrap_or(-90.0),
                );
                SpotLight::new(position, axis, intensity, inner_rad, outer_rad, radius_m)
                    .map(Light::Spot)
            }
            LightKind::Sphere => {
                let area_m2 = PI * radius_m * radius_m;
                let radiance = intensity.map(|v| v / area_m2 as f32);
                SphereLight::new(position, radius_m, radiance).map(Light::Sphere)
            }
        }
    }

    /// Inner and outer angle of a spot light's cone, degrees.
    fn cone_deg(&self) -> [f64; 2] {
        let inner = self.inner_deg;
        let outer = self
            .outer_deg
            .unwrap_or_else(|| inner.map_or(40.0, |inner| inner.max(40.0)));
        [inner.unwrap_or(outer.min(20.0)), outer]
    }
}
