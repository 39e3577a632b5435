//! What the command line asks for.

use std::{error::Error, path::PathBuf, str::FromStr};

pub const USAGE: &str =
    "usage: landscape OUT.exr [--png OUT.png] [--size 1280x720] [--samples 3] [--air on|off]
    [--sun-elevation 12] [--sun-azimuth 250] [--atmosphere average]
    [--camera LATITUDE,LONGITUDE,HEIGHT_ABOVE_GROUND_M,AZIMUTH,ELEVATION,HORIZONTAL_FOV]";

/// The picture to draw. Angles in degrees; azimuths clockwise from north.
#[derive(Clone, Debug)]
pub struct Options {
    pub exr: PathBuf,
    /// A second picture, as a display shows it: `.png` or `.jpg`.
    pub shown: Option<PathBuf>,
    pub size: [u32; 2],
    /// Samples of colour along each side of a pixel.
    pub samples: u32,
    /// Whether the air between eye and ground is drawn.
    pub air: bool,
    pub sun_elevation: f64,
    pub sun_azimuth: f64,
    pub atmosphere: String,
    pub latitude: f64,
    pub longitude: f64,
    /// Metres above the bare ground.
    pub height: f64,
    pub azimuth: f64,
    pub elevation: f64,
    pub horizontal_fov: f64,
}

impl Options {
    /// Reads arguments.
    pub fn parse(mut arguments: impl Iterator<Item = String>) -> Result<Self, Box<dyn Error>> {
        let mut options = Self {
            exr: PathBuf::new(),
            shown: None,
            size: [1280, 720],
            samples: 3,
            air: false,
            sun_elevation: 12.0,
            sun_azimuth: 250.0,
            atmosphere: "average".to_owned(),
            latitude: 36.52333,
            longitude: -84.25583,
            height: 60.0,
            azimuth: 290.0,
            elevation: -7.0,
            horizontal_fov: 58.0,
        };
        while let Some(name) = arguments.next() {
            if !name.starts_with("--") {
                options.exr = name.into();
                continue;
            }
            let value = arguments.next().ok_or(format!("{name} lacks a value"))?;
            match name.as_str() {
                "--png" => options.shown = Some(value.into()),
                "--size" => options.size = list(&name, &value, 'x')?,
                "--samples" => [options.samples] = list(&name, &value, ',')?,
                "--air" => options.air = value == "on",
                "--sun-elevation" => [options.sun_elevation] = list(&name, &value, ',')?,
                "--sun-azimuth" => [options.sun_azimuth] = list(&name, &value, ',')?,
                "--atmosphere" => options.atmosphere = value,
                "--camera" => {
                    [
                        options.latitude,
                        options.longitude,
                        options.height,
                        options.azimuth,
                        options.elevation,
                        options.horizontal_fov,
                    ] = list(&name, &value, ',')?
                }
                _ => return Err(format!("unknown option {name}\n{USAGE}").into()),
            }
        }
        if options.exr.as_os_str().is_empty() || options.samples == 0 {
            return Err(USAGE.into());
        }
        Ok(options)
    }
}

/// `N` numbers between separators.
fn list<T: FromStr, const N: usize>(
    name: &str,
    value: &str,
    separator: char,
) -> Result<[T; N], String> {
    let numbers: Option<Vec<T>> = value
        .split(separator)
        .map(|v| v.trim().parse().ok())
        .collect();
    numbers
        .and_then(|n| n.try_into().ok())
        .ok_or(format!("`{value}` is not {N} numbers for {name}\n{USAGE}"))
}
