//! Options for the position of the eye and of the sun.

use crate::parse::{self, LatLon, put};
use airlight::scene::{Scene, SunSpec};
use clap::{ArgAction, Args};

/// Position of the eye and of the sun.
#[derive(Clone, Debug, Default, Args)]
#[command(next_help_heading = "Place and sun")]
pub struct PlaceArgs {
    /// Place on the Earth: latitude,longitude in degrees, north and east positive
    #[arg(long, value_name = "LAT,LON", value_parser = parse::lat_lon, allow_hyphen_values = true)]
    #[arg(conflicts_with_all = ["sun_elevation", "sun_azimuth"])]
    pub at: Option<LatLon>,
    /// Time with its offset from UTC or its time zone, as in 2026-06-21T21:15:00+02:00 or "2026-06-21 21:15 Europe/Paris"; or now
    /// [default: now]
    #[arg(long, value_name = "TIME", allow_hyphen_values = true)]
    pub when: Option<String>,
    /// Elevation of the sun's centre above the horizontal, degrees, instead of place and time
    #[arg(long, value_name = "DEG", value_parser = parse::elevation_deg, conflicts_with = "when")]
    pub sun_elevation: Option<f64>,
    /// Azimuth of the sun, degrees clockwise from north [default: 180, south]
    #[arg(long, value_name = "DEG", value_parser = parse::number)]
    pub sun_azimuth: Option<f64>,
    /// Altitude of the eye above sea level, m; at least --eye-height-m above the ground [default: 0]
    #[arg(long, value_name = "M", value_parser = parse::altitude_m)]
    pub altitude_m: Option<f64>,
    /// Smallest height of the eye above the ground, m [default: 2]
    #[arg(long, value_name = "M", value_parser = parse::length_m)]
    pub eye_height_m: Option<f64>,
    /// Whether refraction raises the sun of --at and --when, by half a degree at the horizon [default: on]
    #[arg(long, value_name = "on|off", action = ArgAction::Set, value_parser = parse::on_off)]
    pub refraction: Option<bool>,
}

impl PlaceArgs {
    /// Overrides values of a scene.
    pub fn fill(&self, scene: &mut Scene) {
        let sun = &mut scene.sun;
        let refraction = sun.refraction;
        if let Some(place) = self.at {
            *sun = SunSpec {
                latitude_deg: Some(place.latitude_deg),
                longitude_deg: Some(place.longitude_deg),
                time: sun.time.take(),
                refraction,
                ..SunSpec::default()
            };
        }
        if self.sun_elevation.is_some() {
            *sun = SunSpec {
                elevation_deg: self.sun_elevation,
                azimuth_deg: sun.azimuth_deg,
                refraction,
                ..SunSpec::default()
            };
        }
        put(&mut sun.time, &self.when);
        put(&mut sun.azimuth_deg, &self.sun_azimuth);
        put(&mut sun.refraction, &self.refraction);
        put(&mut scene.observer.altitude_m, &self.altitude_m);
        put(&mut scene.observer.eye_height_m, &self.eye_height_m);
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_place_replaces_a_fixed_sun_and_vice_versa() {
        let mut scene = Scene::default();
        scene.sun.elevation_deg = Some(10.0);
        scene.sun.azimuth_deg = Some(90.0);
        let at = PlaceArgs {
            at: Some(LatLon {
                latitude_deg: 1.0,
                longitude_deg: 2.0,
            }),
            ..PlaceArgs::default()
        };
        at.fill(&mut scene);
        assert_eq!(
            (scene.sun.elevation_deg, scene.sun.azimuth_deg),
            (None, None)
        );
        assert_eq!(scene.sun.latitude_deg, Some(1.0));
        let fixed = PlaceArgs {
            sun_elevation: Some(3.0),
            ..PlaceArgs::default()
        };
        fixed.fill(&mut scene);
        assert_eq!(
            (scene.sun.elevation_deg, scene.sun.latitude_deg),
            (Some(3.0), None)
        );
    }
}
