//! Options that say where the eye is and where the sun stands.

use crate::parse::{self, LatLon};
use clap::{ArgAction, Args};

/// Where the eye is and where the sun stands.
#[derive(Clone, Debug, Args)]
#[command(next_help_heading = "Place and sun")]
pub struct PlaceArgs {
    /// Place on the Earth: latitude,longitude in degrees, north and east positive
    #[arg(long, value_name = "LAT,LON", value_parser = parse::lat_lon, allow_hyphen_values = true)]
    #[arg(conflicts_with_all = ["sun_elevation", "sun_azimuth"])]
    pub at: Option<LatLon>,
    /// Time with its offset from UTC, as in 2026-06-21T21:15:00+02:00 or 2026-06-21T19:15:00Z; or now [default: now]
    #[arg(long, value_name = "TIME", requires = "at")]
    pub when: Option<String>,
    /// Elevation of the sun's centre above the horizontal, degrees, instead of place and time
    #[arg(long, value_name = "DEG", value_parser = parse::elevation_deg)]
    pub sun_elevation: Option<f64>,
    /// Azimuth of the sun, degrees clockwise from north [default: 180, south]
    #[arg(long, value_name = "DEG", value_parser = parse::number)]
    #[arg(requires = "sun_elevation")]
    pub sun_azimuth: Option<f64>,
    /// Altitude of the eye above sea level, m; held at least 2 m above the ground
    #[arg(long, value_name = "M", value_parser = parse::altitude_m, default_value_t = 0.0)]
    pub altitude_m: f64,
    /// Height of the eye above the ground, m, that it is not to fall below
    #[arg(long, value_name = "M", value_parser = parse::length_m, default_value_t = 2.0)]
    pub eye_height_m: f64,
    /// Whether the air lifts the sun of --at and --when, by half a degree at the horizon: true or false
    #[arg(long, value_name = "BOOL", default_value_t = true, action = ArgAction::Set)]
    pub refraction: bool,
}
