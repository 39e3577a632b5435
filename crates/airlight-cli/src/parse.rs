//! Parsers of argument values; errors state the values expected.

pub mod words;

use airlight::Named;
use airlight::scene::{CameraExposureError, Exposure};
use clap::builder::{PossibleValue, PossibleValuesParser, TypedValueParser};
use std::fmt::Display;
use std::ops::RangeInclusive;
use std::str::FromStr;

/// A place on the Earth.
#[derive(Clone, Copy, Debug, PartialEq, serde::Serialize)]
pub struct LatLon {
    /// Latitude, degrees north.
    pub latitude_deg: f64,
    /// Longitude, degrees east.
    pub longitude_deg: f64,
}

/// A view direction.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct AzEl {
    /// Azimuth, degrees clockwise from north.
    pub azimuth_deg: f64,
    /// Elevation, degrees above the horizon.
    pub elevation_deg: f64,
}

/// Width and height in pixels.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct PixelSize {
    /// Number of columns.
    pub width: u32,
    /// Number of rows.
    pub height: u32,
}

/// Overrides a value of a scene by that of an option, if the option is given.
pub fn put<T: Clone>(value: &mut Option<T>, given: &Option<T>) {
    if given.is_some() {
        value.clone_from(given);
    }
}

/// Parses the name of a value of a [`Named`] type.
pub fn value_of<T: Named>(text: &str) -> Result<T, String> {
    T::from_name(text).map_err(|error| error.to_string())
}

/// `on` or `off`, or as in scene files `true` or `false`.
pub fn on_off(text: &str) -> Result<bool, String> {
    match text {
        "on" | "true" => Ok(true),
        "off" | "false" => Ok(false),
        _ => Err("expected on or off".to_owned()),
    }
}

/// A contrast that defines visibility: 0.05 or 0.02.
pub fn contrast(text: &str) -> Result<f64, String> {
    match f64::from_str(text.trim()) {
        Ok(value) if value == 0.05 || value == 0.02 => Ok(value),
        _ => Err("expected 0.05 or 0.02".to_owned()),
    }
}

/// A finite number.
pub fn number(text: &str) -> Result<f64, String> {
    within(text, "a number", f64::is_finite)
}

/// A number of at least 0.
pub fn not_negative(text: &str) -> Result<f64, String> {
    within(text, "a number, 0 or above", |v| v.is_finite() && v >= 0.0)
}

/// A number above 0.
pub fn positive(text: &str) -> Result<f64, String> {
    within(text, "a number above 0", |v| v.is_finite() && v > 0.0)
}

/// A number from 0 to 1.
pub fn fraction(text: &str) -> Result<f64, String> {
    within(text, "a number from 0 to 1", |v| (0.0..=1.0).contains(&v))
}

/// The strength of patches in fog.
pub fn patch_strength(text: &str) -> Result<f64, String> {
    within(text, "a number from 0 to 2", |v| (0.0..=2.0).contains(&v))
}

/// An elevation in degrees.
pub fn elevation_deg(text: &str) -> Result<f64, String> {
    within(text, "a number of degrees from -90 to 90", |v| {
        (-90.0..=90.0).contains(&v)
    })
}

/// An altitude in metres, from the deepest sea to space.
pub fn altitude_m(text: &str) -> Result<f64, String> {
    within(text, "a number of metres from -12000 to 1e9", |v| {
        (-12e3..=1e9).contains(&v)
    })
}

/// The quality of a JPEG file.
pub fn quality(text: &str) -> Result<u8, String> {
    whole(text, 1..=100, 92)
}

/// A number of Monte Carlo paths for a pixel.
pub fn paths(text: &str) -> Result<u64, String> {
    whole(text, 128..=1_000_000_000, 256)
}

/// A number of threads.
pub fn threads(text: &str) -> Result<u32, String> {
    whole(text, 1..=1024, 4)
}

/// A whole number in a range, with an example.
fn whole<T>(text: &str, range: RangeInclusive<T>, such_as: T) -> Result<T, String>
where
    T: FromStr + PartialOrd + Display,
{
    let number = text.trim().parse().ok();
    number
        .filter(|number| range.contains(number))
        .ok_or_else(|| {
            let (from, to) = (range.start(), range.end());
            format!("expected a whole number from {from} to {to}, such as {such_as}")
        })
}

/// A distance or a height in metres.
pub fn length_m(text: &str) -> Result<f64, String> {
    within(text, "a number of metres above 0 and at most 1e9", |v| {
        v > 0.0 && v <= 1e9
    })
}

/// End of the error of a list of numbers in place of one.
pub const SEVERAL: &str = "got several";

fn within(text: &str, right: &str, accepts: impl Fn(f64) -> bool) -> Result<f64, String> {
    match f64::from_str(text.trim()) {
        Ok(value) if accepts(value) => Ok(value),
        _ if is_list(text) => Err(format!("expected {right}, {SEVERAL}")),
        _ => Err(format!("expected {right}")),
    }
}

/// Whether a text is a list of numbers.
fn is_list(text: &str) -> bool {
    text.contains(',')
        && text
            .split(',')
            .all(|number| f64::from_str(number.trim()).is_ok())
}

fn pair(text: &str) -> Option<(f64, f64)> {
    let (a, b) = text.split_once(',')?;
    Some((number(a).ok()?, number(b).ok()?))
}

/// `X,Y`.
pub fn two_numbers(text: &str) -> Result<(f64, f64), String> {
    pair(text).ok_or_else(|| "expected two numbers, such as 311.2,254.9".to_owned())
}

/// `R,G,B`, each 0 or above.
pub fn three_numbers(text: &str) -> Result<[f64; 3], String> {
    let right = || "expected three numbers, 0 or above, such as 0.7,0.8,0.9".to_owned();
    let numbers: Vec<f64> = text
        .split(',')
        .map(not_negative)
        .collect::<Result<_, _>>()
        .map_err(|_| right())?;
    numbers.try_into().map_err(|_| right())
}

/// `X,Y,Z`.
pub fn three_coordinates(text: &str) -> Result<[f64; 3], String> {
    let right = || "expected three numbers, such as 1.5,2,-6".to_owned();
    let numbers: Vec<f64> = text
        .split(',')
        .map(number)
        .collect::<Result<_, _>>()
        .map_err(|_| right())?;
    numbers.try_into().map_err(|_| right())
}

/// `LAT,LON` in degrees.
pub fn lat_lon(text: &str) -> Result<LatLon, String> {
    let (latitude_deg, longitude_deg) = pair(text).ok_or(
        "expected latitude,longitude in degrees, north and east positive, such as 48.8584,2.2945",
    )?;
    if !(-90.0..=90.0).contains(&latitude_deg) {
        return Err(format!(
            "expected a latitude from -90 to 90 degrees, got {latitude_deg}"
        ));
    }
    if !(-180.0..=360.0).contains(&longitude_deg) {
        return Err(format!(
            "expected a longitude from -180 to 360 degrees, got {longitude_deg}"
        ));
    }
    Ok(LatLon {
        latitude_deg,
        longitude_deg,
    })
}

/// `AZ,EL` in degrees.
pub fn az_el(text: &str) -> Result<AzEl, String> {
    let (azimuth_deg, elevation_deg) = pair(text).ok_or(
        "expected azimuth,elevation in degrees, clockwise from north and above the horizon, such as 180,45",
    )?;
    match (-90.0..=90.0).contains(&elevation_deg) {
        true => Ok(AzEl {
            azimuth_deg,
            elevation_deg,
        }),
        false => Err(format!(
            "expected an elevation from -90 to 90 degrees, got {elevation_deg}"
        )),
    }
}

/// `WIDTHxHEIGHT` in pixels.
pub fn pixel_size(text: &str) -> Result<PixelSize, String> {
    let right = "expected width x height in pixels, each from 1 to 65536, such as 2048x1024";
    let (width, height) = text.split_once(['x', 'X']).ok_or(right)?;
    let side = |text: &str| {
        text.trim()
            .parse::<u32>()
            .ok()
            .filter(|n| (1..=65536).contains(n))
            .ok_or(right)
    };
    Ok(PixelSize {
        width: side(width)?,
        height: side(height)?,
    })
}

/// A duration such as `90s`, `10m`, `1h30m` or `2d`.
pub fn span(text: &str) -> Result<String, String> {
    airlight_render::sequence::parse_span_s(text)
        .map(|_| text.to_owned())
        .map_err(|right| format!("expected {right}"))
}

/// An exposure: a metering mode, an exposure value at ISO 100, or the settings of a camera.
pub fn exposure(text: &str) -> Result<Exposure, String> {
    if text.starts_with(['f', 'F']) {
        let camera = text.parse().map(Exposure::Camera);
        return camera.map_err(|error: CameraExposureError| error.to_string());
    }
    match (number(text), text.to_ascii_lowercase().parse()) {
        (Ok(ev100), _) => Ok(Exposure::Ev100(ev100)),
        (_, Ok(mode)) => Ok(Exposure::Metered(mode)),
        (_, Err(unknown)) => Err(format!(
            "{unknown}, or give an exposure value at ISO 100, such as 14.5, or the settings of a camera, such as 'f/8 1/125 s ISO 100'"
        )),
    }
}

/// Parser of a [`Named`] type, whose help lists all values.
pub fn named<T: Named + Send + Sync>() -> impl TypedValueParser<Value = T> {
    let values = T::ALL.iter().map(|value| {
        let aliases = T::ALIASES.iter().filter(move |(_, meant)| meant == value);
        PossibleValue::new(value.name())
            .help(value.summary())
            .aliases(aliases.map(|(alias, _)| *alias))
    });
    PossibleValuesParser::new(values).try_map(|name| T::from_name(&name))
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn valid_values_are_parsed() {
        assert_eq!(
            lat_lon("48.8584,2.2945"),
            Ok(LatLon {
                latitude_deg: 48.8584,
                longitude_deg: 2.2945
            })
        );
        assert_eq!(
            lat_lon(" -33.9 , 151.2 "),
            Ok(LatLon {
                latitude_deg: -33.9,
                longitude_deg: 151.2
            })
        );
        assert_eq!(
            az_el("-10,5"),
            Ok(AzEl {
                azimuth_deg: -10.0,
                elevation_deg: 5.0
            })
        );
        assert_eq!(
            pixel_size("2048x1024"),
            Ok(PixelSize {
                width: 2048,
                height: 1024
            })
        );
    }

    #[test]
    fn invalid_values_are_rejected() {
        for text in [
            "", "1", "91,0", "0,361", "NaN,0", "0,inf", "1,2,3", "a,b", ",",
        ] {
            assert!(lat_lon(text).is_err(), "{text}");
        }
        for text in [
            "",
            "0x0",
            "1x0",
            "-1x5",
            "5",
            "65537x1",
            "1x1x1",
            "9999999999x2",
            "ax1",
        ] {
            assert!(pixel_size(text).is_err(), "{text}");
        }
        for text in ["nan", "inf", "x", ""] {
            assert!(
                number(text).is_err() && positive(text).is_err() && altitude_m(text).is_err(),
                "{text}"
            );
        }
        assert!(
            fraction("1.01").is_err()
                && not_negative("-0.1").is_err()
                && elevation_deg("90.1").is_err()
        );
        assert!(length_m("0").is_err() && az_el("0,91").is_err());
        let several = length_m("5,10,20").unwrap_err();
        assert!(several.ends_with(SEVERAL), "{several}");
    }
}
