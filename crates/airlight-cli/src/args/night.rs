//! Options for the lights of the night.

use crate::parse::{self, put};
use airlight::scene::{NightLights, Scene};
use clap::{ArgAction, Args};

/// Moon, stars, airglow and the glow of cities.
#[derive(Clone, Debug, Default, Args)]
#[command(next_help_heading = "Night")]
pub struct NightArgs {
    /// When moon, stars, airglow and zodiacal light are part of the sky [default: auto]
    #[arg(long, value_name = "WHEN", value_parser = parse::named::<NightLights>())]
    pub night: Option<NightLights>,
    /// Whether the moon is there [default: on, with --at]
    #[arg(long, value_name = "on|off", action = ArgAction::Set, value_parser = parse::on_off)]
    pub moon: Option<bool>,
    /// Elevation of the moon's centre, degrees, instead of the moon of --at and --when
    #[arg(long, value_name = "DEG", value_parser = parse::elevation_deg, allow_hyphen_values = true)]
    pub moon_elevation: Option<f64>,
    /// Azimuth of the moon, degrees clockwise from north [default: 180, south]
    #[arg(long, value_name = "DEG", value_parser = parse::number, allow_hyphen_values = true)]
    #[arg(requires = "moon_elevation")]
    pub moon_azimuth: Option<f64>,
    /// Phase angle of the moon, degrees from 0 (full) to 180 (new) [default: from its angle to the sun]
    #[arg(long, value_name = "DEG", value_parser = parse::number)]
    pub moon_phase: Option<f64>,
    /// Whether pictures show single stars, up to magnitude 6.5 [default: on]
    #[arg(long, value_name = "on|off", action = ArgAction::Set, value_parser = parse::on_off)]
    pub stars: Option<bool>,
    /// Solar radio flux at 10.7 cm that determines the airglow, solar flux units: 70 in quiet years, 200 in active ones [default:
    /// 100]
    #[arg(long, value_name = "SFU", value_parser = parse::number)]
    pub solar_flux: Option<f64>,
    /// Brightness of the moonless zenith with the glow of cities, magnitudes per square arcsecond: 17 in a large city, 20.5 in the
    /// country [default: no cities]
    #[arg(long, value_name = "MAG", value_parser = parse::number)]
    pub sky_quality: Option<f64>,
    /// Latitude of stars and Milky Way over --sun-elevation, degrees [default: 45]
    #[arg(long, value_name = "DEG", value_parser = parse::elevation_deg, allow_hyphen_values = true)]
    #[arg(conflicts_with = "at")]
    pub star_latitude: Option<f64>,
}

impl NightArgs {
    /// Overrides values of a scene.
    pub fn fill(&self, scene: &mut Scene) {
        let night = &mut scene.night;
        put(&mut night.lights, &self.night);
        put(&mut night.moon, &self.moon);
        put(&mut night.moon_elevation_deg, &self.moon_elevation);
        put(&mut night.moon_azimuth_deg, &self.moon_azimuth);
        put(&mut night.moon_phase_deg, &self.moon_phase);
        put(&mut night.stars, &self.stars);
        put(&mut night.solar_flux_sfu, &self.solar_flux);
        put(&mut night.sky_quality_mag, &self.sky_quality);
        put(&mut night.latitude_deg, &self.star_latitude);
    }
}
