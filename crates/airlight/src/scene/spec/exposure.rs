//! Exposure of pictures that a display shows: metered, or a camera's.

use crate::names::named;
use std::fmt;
use std::str::FromStr;

/// Exposure of PNG, JPEG and preview: a metering mode, the exposure value of a camera at ISO 100 (sunny day 15, dusk 8), or the settings of
/// a camera.
#[derive(Clone, Copy, Debug, PartialEq)]
#[cfg_attr(feature = "serde", derive(serde::Serialize, serde::Deserialize))]
#[cfg_attr(
    feature = "serde",
    serde(
        untagged,
        expecting = "expected a metering mode (auto, centre-weighted, spot, average, highlight-weighted, incident), an exposure \
            value at ISO 100, such as 14.5, or the settings of a camera, such as \"f/8 1/125 s ISO 100\""
    )
)]
#[cfg_attr(feature = "schema", derive(schemars::JsonSchema))]
pub enum Exposure {
    /// Determined from the picture.
    Metered(MeteringMode),
    /// Exposure value at ISO 100.
    Ev100(f64),
    /// Settings of a camera.
    Camera(CameraExposure),
}

impl Exposure {
    /// Exposure from the picture's luminances.
    pub const AUTO: Self = Self::Metered(MeteringMode::Evaluative);

    /// Exposure value at ISO 100; `None` if it is metered.
    pub fn ev100(self) -> Option<f64> {
        match self {
            Self::Metered(_) => None,
            Self::Ev100(ev100) => Some(ev100),
            Self::Camera(camera) => Some(camera.ev100()),
        }
    }
}

/// What automatic exposure is metered from. All modes meter without the sun's disc.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Hash)]
#[non_exhaustive]
pub enum MeteringMode {
    /// The sky more than the ground, without the brightest and darkest parts; dusk stays darker than day.
    #[default]
    Evaluative,
    /// The mean luminance, mostly of the centre, is middle grey.
    CentreWeighted,
    /// The mean luminance of 2.5 % of the picture, in its centre, is middle grey.
    Spot,
    /// The mean luminance is middle grey.
    Average,
    /// The brightest hundredth is just below white.
    HighlightWeighted,
    /// A grey card that faces the zenith is middle grey.
    Incident,
}

named! { MeteringMode, "a metering mode", [
    ("auto", (Evaluative), "evaluative: the sky more than the ground, without the brightest and darkest parts; dusk stays darker than day"),
    ("centre-weighted", (CentreWeighted), "the mean luminance, mostly of the centre, is middle grey"),
    ("spot", (Spot), "the mean luminance of 2.5 % of the picture, in its centre, is middle grey"),
    ("average", (Average), "the mean luminance is middle grey"),
    ("highlight-weighted", (HighlightWeighted), "the brightest hundredth is just below white"),
    ("incident", (Incident), "a grey card that faces the zenith is middle grey"),
], aliases [("evaluative", (Evaluative)), ("matrix", (Evaluative)), ("center-weighted", (CentreWeighted))] }

/// Aperture, exposure time and speed of a camera, written as `f/8 1/125 s ISO 100`.
#[derive(Clone, Copy, Debug, PartialEq)]
#[cfg_attr(feature = "serde", derive(serde::Serialize, serde::Deserialize))]
#[cfg_attr(feature = "serde", serde(try_from = "String", into = "String"))]
#[cfg_attr(feature = "schema", derive(schemars::JsonSchema))]
#[cfg_attr(feature = "schema", schemars(with = "String"))]
pub struct CameraExposure {
    /// Focal length over the diameter of the aperture, above 0.
    pub f_number: f64,
    /// Exposure time, s, above 0.
    pub time_s: f64,
    /// ISO speed, above 0.
    pub iso: f64,
}

impl CameraExposure {
    /// Exposure value at ISO 100 (ISO 2720): log2(N² / t) - log2(S / 100).
    pub fn ev100(self) -> f64 {
        (self.f_number.powi(2) / self.time_s * (100.0 / self.iso)).log2()
    }
}

/// Error of the settings of a camera.
#[derive(Clone, Debug, PartialEq, Eq, thiserror::Error)]
#[error(
    "expected aperture, time and speed of a camera, such as `f/8 1/125 s ISO 100`, got `{text}`"
)]
pub struct CameraExposureError {
    text: String,
}

impl FromStr for CameraExposure {
    type Err = CameraExposureError;

    /// Spaces and the `s` may be left out, commas may stand between the parts.
    fn from_str(text: &str) -> Result<Self, Self::Err> {
        let positive = |text: &str| {
            let number = text.parse::<f64>().ok();
            number.filter(|number| number.is_finite() && *number > 0.0)
        };
        let seconds = |text: &str| {
            let text = text.trim_end_matches('s').trim_end();
            match text.split_once('/') {
                Some((over, under)) => Some(positive(over)? / positive(under)?),
                None => positive(text),
            }
        };
        let parse = || {
            let text = text.to_ascii_lowercase().replace(',', " ");
            let (before, iso) = text.split_once("iso")?;
            let (aperture, time) = before.trim().strip_prefix("f/")?.split_once(' ')?;
            Some(Self {
                f_number: positive(aperture)?,
                time_s: seconds(time.trim())?,
                iso: positive(iso.trim())?,
            })
        };
        parse().ok_or_else(|| CameraExposureError {
            text: text.to_owned(),
        })
    }
}

impl TryFrom<String> for CameraExposure {
    type Error = CameraExposureError;

    fn try_from(text: String) -> Result<Self, Self::Error> {
        text.parse()
    }
}

impl fmt::Display for CameraExposure {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        let Self {
            f_number,
            time_s,
            iso,
        } = self;
        let part = time_s.recip().round();
        match *time_s < 1.0 && part.recip() == *time_s {
            true => write!(f, "f/{f_number} 1/{part} s ISO {iso}"),
            false => write!(f, "f/{f_number} {time_s} s ISO {iso}"),
        }
    }
}

impl From<CameraExposure> for String {
    fn from(camera: CameraExposure) -> Self {
        camera.to_string()
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn camera(f_number: f64, time_s: f64, iso: f64) -> CameraExposure {
        CameraExposure {
            f_number,
            time_s,
            iso,
        }
    }

    #[test]
    fn cameras_are_written_and_read() {
        for (text, right) in [
            ("f/8 1/125 s ISO 100", camera(8.0, 1.0 / 125.0, 100.0)),
            ("f/1.4 20 s ISO 2500", camera(1.4, 20.0, 2500.0)),
            ("f/2.8 0.3 s ISO 64", camera(2.8, 0.3, 64.0)),
        ] {
            assert_eq!(text.parse(), Ok(right));
            assert_eq!(right.to_string(), text);
        }
        let short = "F/8,1/125,ISO100".parse();
        assert_eq!(short, Ok(camera(8.0, 1.0 / 125.0, 100.0)));
        for wrong in [
            "",
            "f/8",
            "f/8 1/0 s ISO 100",
            "8 1/125 ISO 100",
            "f/8 1/125 s",
        ] {
            let error = wrong.parse::<CameraExposure>().unwrap_err().to_string();
            assert!(error.contains("f/8 1/125 s ISO 100, got") || error.contains(wrong));
        }
    }

    /// Exposure values of ISO 2720: 0 for 1 s at f/1, 15 for the sunny 16 rule up to its rounding; a faster film needs less light.
    #[test]
    fn exposure_values_are_those_of_the_standard() {
        assert_eq!(camera(1.0, 1.0, 100.0).ev100(), 0.0);
        let sunny = camera(16.0, 0.01, 100.0).ev100();
        assert!((sunny - 14.64).abs() < 0.01, "{sunny}");
        let twice = camera(16.0, 0.01, 200.0).ev100();
        assert!((twice - (sunny - 1.0)).abs() < 1e-12, "{twice}");
    }
}
