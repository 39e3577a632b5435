//! Metadata of picture files.

use super::carried::Carried;
use crate::{Frame, ImageError, Projection};
use airlight::spectrum::RgbSpace;
use airlight::spectrum::rgb::adaptation_matrix;
use glam::{DMat3, DVec3};
use std::sync::Arc;

/// Metadata of a picture. EXR files store them as standard attributes where one exists, PNG files as text chunks, HDR files as
/// header lines, JPEG files in the Exif block.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct Metadata {
    /// Program and version.
    pub software: Option<String>,
    /// Owner or author.
    pub owner: Option<String>,
    /// Free text.
    pub comments: Option<String>,
    /// Local date and time of the scene, as in OpenEXR: `YYYY:MM:DD hh:mm:ss`.
    pub capture_date: Option<String>,
    /// Local time minus UTC in seconds: positive east of Greenwich. (OpenEXR files store the opposite sign.)
    pub utc_offset_s: Option<f32>,
    /// Degrees north of the equator.
    pub latitude_deg: Option<f32>,
    /// Degrees east of Greenwich.
    pub longitude_deg: Option<f32>,
    /// Metres above sea level.
    pub altitude_m: Option<f32>,
    /// Luminance of RGB (1, 1, 1), cd/m^2: 1 where the values are in cd/m^2.
    pub white_luminance_cd_m2: Option<f32>,
    /// Primaries and white of the RGB values; readers assume sRGB where they are missing. PNG and JPEG files hold sRGB only.
    pub chromaticities: Option<Chromaticities>,
    /// Width of a pixel over its height; square where missing.
    pub pixel_aspect: Option<f32>,
    /// The larger picture of which an EXR file holds a band of rows; other formats ignore it.
    pub band: Option<RowBand>,
    /// Attributes and channels of an EXR file, carried to another.
    pub carried: Option<Arc<Carried>>,
    /// Further named texts, such as units or the command line.
    pub texts: Vec<(String, String)>,
}

/// A band of the rows of a larger picture, as the data window of an EXR file in a display window of the size of the picture.
/// [`join`](super::exr::join) makes the picture of its bands.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct RowBand {
    /// Row of the picture that is the first of the band.
    pub first_row: u32,
    /// Number of rows of the picture.
    pub picture_rows: u32,
}

impl RowBand {
    /// Numbers of rows of which bands consist, except the last of a picture, so that compressed blocks of rows end with them.
    pub const MULTIPLE: u32 = 32;
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
    /// White point: RGB (1, 1, 1).
    pub white: [f32; 2],
    /// What looks white; the white point in most files, and D65 in those with colours that are not adapted to their white point.
    pub neutral: [f32; 2],
}

impl Chromaticities {
    /// CIE 1931 XYZ, white of equal energy.
    pub const XYZ: Self = Self {
        red: [1.0, 0.0],
        green: [0.0, 1.0],
        blue: [0.0, 0.0],
        white: [1.0 / 3.0, 1.0 / 3.0],
        neutral: [1.0 / 3.0, 1.0 / 3.0],
    };

    /// Matrix from linear RGB of these primaries to linear sRGB. The neutral colour becomes white, adapted by the Bradford transform.
    ///
    /// `None` where the primaries lie on one line, the white is no colour, or the neutral colour is outside their gamut.
    pub fn to_linear_srgb(&self) -> Option<DMat3> {
        let srgb = Self::from(RgbSpace::Srgb);
        let [from, to] = [self.neutral, srgb.neutral].map(|white| white.map(f64::from));
        let adaptation = DMat3::from_cols_array_2d(&adaptation_matrix(from, to)).transpose();
        let matrix = srgb.to_xyz()?.inverse() * adaptation * self.to_xyz()?;
        let neutral = matrix.inverse() * DVec3::ONE;
        let is_usable = matrix.is_finite() && matrix.determinant().abs() > 1e-9;
        (is_usable && neutral.min_element() > 1e-3).then_some(matrix)
    }

    /// Whether colours of these primaries are linear sRGB, within the rounding of single precision.
    pub fn are_srgb(&self) -> bool {
        let matrix = self.to_linear_srgb();
        matrix.is_some_and(|matrix| matrix.abs_diff_eq(DMat3::IDENTITY, 1e-5))
    }

    /// The neutral colour, where it is not the white point.
    pub(super) fn stated_neutral(&self) -> Option<[f32; 2]> {
        (self.neutral != self.white).then_some(self.neutral)
    }

    /// Luminance of red, green and blue of 1; of sRGB for impossible primaries.
    pub fn luminance_weights(&self) -> [f32; 3] {
        let matrix = self
            .to_xyz()
            .or_else(|| Self::from(RgbSpace::Srgb).to_xyz());
        matrix.map_or([0.0, 1.0, 0.0], |matrix| matrix.row(1).as_vec3().to_array())
    }

    /// Matrix to CIE XYZ, in which white has Y = 1.
    fn to_xyz(self) -> Option<DMat3> {
        let xyz = |[x, y]: [f32; 2]| DVec3::new(x.into(), y.into(), 1.0 - f64::from(x + y));
        let primaries = DMat3::from_cols(xyz(self.red), xyz(self.green), xyz(self.blue));
        let white = xyz(self.white) / f64::from(self.white[1]);
        let amounts = primaries.inverse() * white;
        let matrix = primaries * DMat3::from_diagonal(amounts);
        (matrix.is_finite() && primaries.determinant().abs() > 1e-6).then_some(matrix)
    }
}

impl From<RgbSpace> for Chromaticities {
    fn from(space: RgbSpace) -> Self {
        let xy = |point: [f64; 2]| point.map(|v| v as f32);
        let [red, green, blue] = space.primaries_xy().map(xy);
        Self {
            red,
            green,
            blue,
            white: xy(space.white_point_xy()),
            neutral: xy(space.neutral_xy()),
        }
    }
}

impl Metadata {
    /// The same with a description of the frame's projection.
    pub fn with_frame(mut self, frame: &Frame) -> Self {
        let settings = match frame.projection() {
            Projection::Equirectangular { center_azimuth_deg } => {
                format!("center azimuth {center_azimuth_deg} deg")
            }
            Projection::CubeFace(face) | Projection::MirroredCubeFace(face) => face.to_string(),
            Projection::AngularFisheye(fisheye) => format!(
                "equidistant, azimuth {} deg, elevation {} deg, field of view {} deg",
                fisheye.azimuth_deg, fisheye.elevation_deg, fisheye.field_of_view_deg
            ),
            Projection::Perspective(camera) => format!(
                "azimuth {} deg, elevation {} deg, roll {} deg, vertical field of view {} deg",
                camera.azimuth_deg, camera.elevation_deg, camera.roll_deg, camera.vertical_fov_deg
            ),
        };
        let name = frame.projection().name();
        self.texts
            .push(("projection".to_owned(), format!("{name}, {settings}")));
        self
    }

    /// The same with another named text.
    pub fn with_text(mut self, name: impl Into<String>, text: impl Into<String>) -> Self {
        self.texts.push((name.into(), text.into()));
        self
    }

    /// Refuses primaries other than those of sRGB, for formats that hold no others.
    pub(super) fn require_srgb(&self, format: &'static str) -> Result<(), ImageError> {
        match self.chromaticities.is_none_or(|stated| stated.are_srgb()) {
            true => Ok(()),
            false => Err(ImageError::Encode {
                format,
                reason: "expected colours in sRGB, got other primaries; try EXR or HDR".to_owned(),
            }),
        }
    }

    /// All metadata as names and texts, for formats without standard fields.
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
