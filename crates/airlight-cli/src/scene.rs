//! What is looked at, from where, under which sun: from options to a prepared sky.

use crate::args::{AirArgs, EffortArg, PlaceArgs, ScatteringArg, SolverArg};
use crate::atmosphere;
use crate::error::CliError;
use crate::parse::LatLon;
use crate::progress::Busy;
use airlight::atmosphere::Atmosphere;
use airlight::axes;
use airlight::models::klassen1987;
use airlight::sky::{Scattering, Sky, SkySettings, SunCoverage, View};
use airlight::spectrum::WavelengthGrid;
use airlight::sun::Moment;
use airlight::sun::position::{Place, RefractingAir, sun_position};
use std::time::{Duration, Instant};

/// Where the eye is, what the air is and how the sun is found.
pub struct Scene {
    /// The air asked for.
    pub atmosphere: Atmosphere,
    /// Its wavelengths.
    pub grid: WavelengthGrid,
    /// Altitude of the eye above sea level, m.
    pub eye_altitude_m: f64,
    /// How the sun is found.
    pub sun: SunSource,
    scattering: Scattering,
    effort: EffortArg,
}

/// How the sun is found.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum SunSource {
    /// It was told.
    Explicit(Sun),
    /// From place and time.
    Ephemeris {
        /// Where on the Earth.
        place: LatLon,
        /// When (for a sequence: when it starts).
        start: Moment,
        /// Altitude of the eye, m.
        altitude_m: f64,
        /// Whether the air lifts the sun.
        refraction: bool,
    },
}

/// Where the sun stands.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Sun {
    /// Degrees clockwise from north.
    pub azimuth_deg: f64,
    /// Degrees above the horizontal, as seen.
    pub elevation_deg: f64,
    /// The same without refraction, where place and time gave it.
    pub geometric_elevation_deg: Option<f64>,
    /// Distance over the planet's mean distance.
    pub distance_ratio: f64,
}

impl SunSource {
    /// The sun at a moment (of no account where it was told).
    ///
    /// # Errors
    /// [`CliError::Usage`] where the moment is out of the ephemeris' range.
    pub fn at(&self, moment: Option<Moment>) -> Result<Sun, CliError> {
        let (place, start, altitude_m, refraction) = match *self {
            Self::Explicit(sun) => return Ok(sun),
            Self::Ephemeris {
                place,
                start,
                altitude_m,
                refraction,
            } => (place, start, altitude_m, refraction),
        };
        let time = moment.unwrap_or(start);
        let place = Place {
            latitude_deg: place.latitude_deg,
            longitude_deg: place.longitude_deg,
            // The sun's parallax is 0.002 degrees for the whole radius of the Earth.
            altitude_m: altitude_m.clamp(-12e3, 100e3),
        };
        let air = refraction.then(|| standard_air(altitude_m));
        let found = sun_position(time, place, air)
            .map_err(|error| CliError::usage(format!("the sun at {time}: {error}")))?;
        Ok(Sun {
            azimuth_deg: found.azimuth_deg,
            elevation_deg: found.elevation_deg,
            geometric_elevation_deg: Some(found.geometric_elevation_deg),
            distance_ratio: found.distance_au,
        })
    }

    /// The moment shown or begun with.
    pub fn start(&self) -> Option<Moment> {
        match self {
            Self::Explicit(_) => None,
            Self::Ephemeris { start, .. } => Some(*start),
        }
    }

    /// The place on the Earth.
    pub fn place(&self) -> Option<LatLon> {
        match self {
            Self::Explicit(_) => None,
            Self::Ephemeris { place, .. } => Some(*place),
        }
    }
}

impl Scene {
    /// Puts the options together.
    ///
    /// # Errors
    /// [`CliError`] where they do not fit together or a file cannot be read.
    pub fn new(place: &PlaceArgs, air: &AirArgs) -> Result<Self, CliError> {
        let atmosphere = atmosphere::build(air, place.altitude_m)?;
        let lowest_m = atmosphere.planet.ground_altitude_m + place.eye_height_m;
        let eye_altitude_m = place.altitude_m.max(lowest_m);
        let sun = sun_source(place, &atmosphere, eye_altitude_m)?;
        // Told at once where the time is out of range.
        sun.at(None)?;
        let asked = WavelengthGrid::by_name(&air.wavelengths)
            .map_err(|error| CliError::usage(format!("--wavelengths: {error}")))?;
        let grid = match air.solver {
            // It has its own.
            SolverArg::Klassen1987 => klassen1987::wavelength_grid(),
            _ => asked,
        };
        let scattering = match air.scattering {
            ScatteringArg::All => Scattering::All,
            ScatteringArg::Single => Scattering::Single,
        };
        Ok(Self {
            atmosphere,
            grid,
            eye_altitude_m,
            sun,
            scattering,
            effort: air.effort,
        })
    }

    /// Solves for the light inside the air; tells how long it took.
    ///
    /// # Errors
    /// [`CliError::Usage`] where the solver refuses the atmosphere.
    pub fn prepare(&self, suns: SunCoverage) -> Result<(Sky, Duration), CliError> {
        let start = Instant::now();
        let _busy = Busy::with("solving for the light in the air");
        let settings = SkySettings {
            suns,
            scattering: self.scattering,
            ..match self.effort {
                EffortArg::Standard => SkySettings::default(),
                EffortArg::Fine => SkySettings::fine(),
            }
        };
        let sky = Sky::prepare(&self.atmosphere, &self.grid, &settings)?;
        Ok((sky, start.elapsed()))
    }

    /// Which light is computed, as on the command line.
    pub fn scattering_name(&self) -> &'static str {
        match self.scattering {
            Scattering::All => "all",
            Scattering::Single => "single",
        }
    }

    /// The fastest preparation for one position of the sun.
    pub fn near(&self, sun: &Sun) -> SunCoverage {
        SunCoverage::near(sun.elevation_deg, self.eye_altitude_m)
    }

    /// What is seen under a sun.
    pub fn view<'a>(&self, sky: &'a Sky, sun: &Sun) -> View {
        sky.view(self.eye_altitude_m, sun.direction())
            .at_sun_distance(sun.distance_ratio)
    }
}

impl Sun {
    /// Unit vector towards it.
    pub fn direction(&self) -> glam::DVec3 {
        axes::direction(self.azimuth_deg, self.elevation_deg)
    }
}

/// Computes with so many threads.
///
/// # Errors
/// [`CliError::Failure`] where the system refuses.
pub fn use_threads(count: Option<u32>) -> Result<(), CliError> {
    let Some(count) = count else { return Ok(()) };
    rayon::ThreadPoolBuilder::new()
        .num_threads(count as usize)
        .build_global()
        .map_err(|error| CliError::failure(format!("cannot start {count} threads: {error}")))
}

fn sun_source(
    args: &PlaceArgs,
    air: &Atmosphere,
    eye_altitude_m: f64,
) -> Result<SunSource, CliError> {
    if let Some(elevation_deg) = args.sun_elevation {
        return Ok(SunSource::Explicit(Sun {
            azimuth_deg: args.sun_azimuth.unwrap_or(180.0).rem_euclid(360.0),
            elevation_deg,
            geometric_elevation_deg: None,
            distance_ratio: 1.0,
        }));
    }
    let Some(place) = args.at else {
        return Err(CliError::usage(
            "say where the sun stands: --at LAT,LON with --when TIME, or --sun-elevation DEG",
        ));
    };
    if !atmosphere::is_earth(air) {
        return Err(CliError::usage(format!(
            "--at and --when find the sun for places on the Earth: for the atmosphere \"{}\" say where it stands with \
             --sun-elevation and --sun-azimuth",
            air.name
        )));
    }
    let when = args.when.as_deref().unwrap_or("now");
    let start = Moment::parse(when)
        .map_err(|error| CliError::usage(format!("--when: {error}; or write now")))?;
    Ok(SunSource::Ephemeris {
        place,
        start,
        altitude_m: eye_altitude_m,
        refraction: args.refraction,
    })
}

/// Pressure and temperature of the International Standard Atmosphere (ISO 2533) up to 11 km, and above that as if it
/// went on so until nothing is left.
fn standard_air(altitude_m: f64) -> RefractingAir {
    let cooling = (1.0 - 2.255_77e-5 * altitude_m).max(0.0);
    RefractingAir {
        pressure_pa: (101_325.0 * cooling.powf(5.255_88)).min(200_000.0),
        temperature_c: (15.0 - 6.5e-3 * altitude_m).max(-56.5),
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn standard_air_thins_out() {
        let at = |m| standard_air(m).pressure_pa;
        assert!((at(0.0) - 101_325.0).abs() < 1.0);
        assert!((at(5000.0) / 54_020.0 - 1.0).abs() < 2e-3);
        assert_eq!(at(400e3), 0.0);
        assert!(at(-12e3) < 400_000.0);
    }
}
