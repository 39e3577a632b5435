//! What a picture file says about itself.

use crate::{Frame, Projection};
use airlight::spectrum::RgbSpace;

/// Facts about a picture. EXR files keep them as standard attributes where there is one, PNG files as text chunks, HDR
/// files as header lines, JPEG files as a comment.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct Metadata {
    /// Program and version that made it.
    pub software: Option<String>,
    /// Who it belongs to.
    pub owner: Option<String>,
    /// Anything else a person should read.
    pub comments: Option<String>,
    /// Local date and time shown: `YYYY:MM:DD hh:mm:ss`, as OpenEXR wants it.
    pub capture_date: Option<String>,
    /// Local time minus UTC in seconds: positive east of Greenwich. (OpenEXR stores the opposite sign; the writer sees
    /// to it.)
    pub utc_offset_s: Option<f32>,
    /// Degrees north of the equator.
    pub latitude_deg: Option<f32>,
    /// Degrees east of Greenwich.
    pub longitude_deg: Option<f32>,
    /// Metres above sea level.
    pub altitude_m: Option<f32>,
    /// Luminance in cd/m^2 of RGB (1, 1, 1): 1 where the values are in cd/m^2.
    pub white_luminance_cd_m2: Option<f32>,
    /// Primaries and white of the RGB values; readers take sRGB's where it is missing.
    pub chromaticities: Option<Chromaticities>,
    /// The picture covers the sphere as an equirectangular map.
    pub is_latitude_longitude: bool,
    /// Further named texts: units, command line, place, ...
    pub texts: Vec<(String, String)>,
}

/// CIE 1931 xy of the primaries and white of an RGB space.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Chromaticities {
    /// Red primary.
    pub red: [f32; 2],
    /// Green primary.
    pub green: [f32; 2],
    /// Blue primary.
    pub blue: [f32; 2],
    /// White point.
    pub white: [f32; 2],
}

impl Chromaticities {
    /// sRGB and Rec. ITU-R BT.709, white D65.
    pub const SRGB: Self = Self {
        red: [0.64, 0.33],
        green: [0.30, 0.60],
        blue: [0.15, 0.06],
        white: [0.3127, 0.3290],
    };
    /// The CIE 1931 XYZ components themselves, white of equal energy.
    pub const XYZ: Self = Self {
        red: [1.0, 0.0],
        green: [0.0, 1.0],
        blue: [0.0, 0.0],
        white: [1.0 / 3.0, 1.0 / 3.0],
    };
}

impl From<RgbSpace> for Chromaticities {
    fn from(space: RgbSpace) -> Self {
        let [red, green, blue] = space.primaries_xy().map(|xy| xy.map(|v| v as f32));
        Self {
            red,
            green,
            blue,
            white: space.white_point_xy().map(|v| v as f32),
        }
    }
}

impl Metadata {
    /// The same with the frame's projection described.
    pub fn with_frame(mut self, frame: &Frame) -> Self {
        let (kind, detail) = match frame.projection() {
            Projection::Equirectangular { center_azimuth_deg } => {
                self.is_latitude_longitude = true;
                (
                    "equirectangular",
                    format!("center azimuth {center_azimuth_deg} deg"),
                )
            }
            Projection::CubeFace(face) => ("cube face", face.name().to_owned()),
            Projection::AngularFisheye(fisheye) => (
                "equidistant fisheye",
                format!(
                    "azimuth {} deg, elevation {} deg, field of view {} deg",
                    fisheye.azimuth_deg, fisheye.elevation_deg, fisheye.field_of_view_deg
                ),
            ),
            Projection::Perspective(camera) => (
                "perspective",
                format!(
                    "azimuth {} deg, elevation {} deg, roll {} deg, vertical field of view {} deg",
                    camera.azimuth_deg,
                    camera.elevation_deg,
                    camera.roll_deg,
                    camera.vertical_fov_deg
                ),
            ),
        };
        self.texts
            .push(("projection".to_owned(), format!("{kind}, {detail}")));
        self
    }

    /// The same with a named text added.
    pub fn with_text(mut self, name: impl Into<String>, text: impl Into<String>) -> Self {
        self.texts.push((name.into(), text.into()));
        self
    }

    /// Every fact as a name and a text, for formats that know nothing else.
    pub(super) fn as_texts(&self) -> Vec<(String, String)> {
        let mut texts = Vec::new();
        let mut add = |name: &str, text: Option<String>| {
            if let Some(text) = text {
                texts.push((name.to_owned(), text));
            }
        };
        let number = |n: Option<f32>, unit: &str| n.map(|n| format!("{n} {unit}"));
        add("Software", self.software.clone());
        add("Author", self.owner.clone());
        add("Comment", self.comments.clone());
        add("Creation Time", self.capture_date.clone());
        add("UTC offset", number(self.utc_offset_s, "s"));
        add("Latitude", number(self.latitude_deg, "deg north"));
        add("Longitude", number(self.longitude_deg, "deg east"));
        add("Altitude", number(self.altitude_m, "m"));
        texts.extend(self.texts.iter().cloned());
        texts
    }
}
