//! Position of a scene's sun: fixed, or computed from place and time.

use super::{Scene, SceneError, SunState};
use crate::atmosphere::Atmosphere;
#[cfg(feature = "ephemeris")]
use crate::atmosphere::refracting_air;
use crate::axes;
#[cfg(feature = "ephemeris")]
use crate::sun::{Moment, Place, sun_position};
use glam::DVec3;

/// Source of the sun's position.
#[derive(Clone, Copy, Debug, PartialEq)]
#[non_exhaustive]
pub enum SunSource {
    /// A fixed position.
    Fixed(SunAngles),
    /// Computed from a place on the Earth and a time.
    #[cfg(feature = "ephemeris")]
    Ephemeris {
        /// Place, at the altitude of the eye.
        place: Place,
        /// Time, or the start of a sequence.
        start: Moment,
        /// Whether refraction raises the sun.
        refraction: bool,
    },
}

/// Position of the sun in the sky.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct SunAngles {
    /// Azimuth, degrees clockwise from north.
    pub azimuth_deg: f64,
    /// Apparent elevation above the horizontal, degrees.
    pub elevation_deg: f64,
    /// Elevation without refraction, if computed from place and time, degrees.
    pub geometric_elevation_deg: Option<f64>,
    /// Distance relative to the planet's mean distance.
    pub distance_ratio: f64,
}

impl SunAngles {
    /// Unit vector towards the sun.
    pub fn direction(&self) -> DVec3 {
        axes::direction(self.azimuth_deg, self.elevation_deg)
    }

    /// Direction and distance.
    pub fn state(&self) -> SunState {
        SunState {
            direction: self.direction(),
            distance_ratio: self.distance_ratio,
        }
    }
}

impl SunSource {
    /// Position at the time of the scene or the start of its sequence.
    ///
    /// # Errors
    /// [`SceneError::Refused`] for a time outside the range of the ephemeris.
    pub fn at_start(&self) -> Result<SunAngles, SceneError> {
        match self {
            Self::Fixed(sun) => Ok(*sun),
            #[cfg(feature = "ephemeris")]
            Self::Ephemeris { start, .. } => self.at(*start),
        }
    }
}

#[cfg(feature = "ephemeris")]
impl SunSource {
    /// Position at a time. A fixed sun does not move.
    ///
    /// # Errors
    /// [`SceneError::Refused`] for a time outside the range of the ephemeris.
    pub fn at(&self, time: Moment) -> Result<SunAngles, SceneError> {
        let (place, refraction) = match *self {
            Self::Fixed(sun) => return Ok(sun),
            Self::Ephemeris {
                place, refraction, ..
            } => (place, refraction),
        };
        let air = refraction.then(|| refracting_air(place.altitude_m));
        let place = Place {
            // The sun's parallax is 0.002 degrees for the whole radius of the Earth.
            altitude_m: place.altitude_m.clamp(-12e3, 100e3),
            ..place
        };
        let found = sun_position(time, place, air)
            .map_err(|error| SceneError::refused("sun.time", format!("{time}: {error}")))?;
        Ok(SunAngles {
            azimuth_deg: found.azimuth_deg,
            elevation_deg: found.elevation_deg,
            geometric_elevation_deg: Some(found.geometric_elevation_deg),
            distance_ratio: found.distance_au,
        })
    }

    /// Time, or start of a sequence; `None` for a fixed sun.
    pub fn start(&self) -> Option<Moment> {
        match self {
            Self::Fixed(_) => None,
            Self::Ephemeris { start, .. } => Some(*start),
        }
    }

    /// Place on the Earth; `None` for a fixed sun.
    pub fn place(&self) -> Option<Place> {
        match self {
            Self::Fixed(_) => None,
            Self::Ephemeris { place, .. } => Some(*place),
        }
    }
}

impl Scene {
    /// Source of the sun's position for an eye at an altitude (m above sea level) in an atmosphere.
    ///
    /// # Errors
    /// [`SceneError`] if the scene has neither a position of the sun nor a place, or an invalid time.
    pub fn sun_source(
        &self,
        atmosphere: &Atmosphere,
        altitude_m: f64,
    ) -> Result<SunSource, SceneError> {
        let sun = &self.sun;
        if let Some(elevation_deg) = sun.elevation_deg {
            return Ok(SunSource::Fixed(SunAngles {
                azimuth_deg: sun.azimuth_deg.unwrap_or(180.0).rem_euclid(360.0),
                elevation_deg,
                geometric_elevation_deg: None,
                distance_ratio: sun.distance_ratio.unwrap_or(1.0),
            }));
        }
        let (Some(latitude_deg), Some(longitude_deg)) = (sun.latitude_deg, sun.longitude_deg)
        else {
            return Err(SceneError::value(
                "sun",
                "a position of the sun",
                "none",
                "elevation_deg = 10, or latitude_deg and longitude_deg with time",
            ));
        };
        if !atmosphere.is_earth() {
            return Err(SceneError::value(
                "sun.latitude_deg",
                "the Earth for a sun of place and time",
                format!("the atmosphere \"{}\"", atmosphere.name),
                "elevation_deg and azimuth_deg",
            ));
        }
        self.ephemeris(latitude_deg, longitude_deg, altitude_m)
    }

    #[cfg(feature = "ephemeris")]
    fn ephemeris(
        &self,
        latitude_deg: f64,
        longitude_deg: f64,
        altitude_m: f64,
    ) -> Result<SunSource, SceneError> {
        let sun = &self.sun;
        let start = Moment::parse(sun.time.as_deref().unwrap_or("now"))
            .map_err(|error| SceneError::refused("sun.time", format!("{error}; try now")))?;
        let source = SunSource::Ephemeris {
            place: Place {
                latitude_deg,
                // From -180 to 180.
                longitude_deg: match longitude_deg > 180.0 {
                    true => longitude_deg - 360.0,
                    false => longitude_deg,
                },
                altitude_m,
            },
            start,
            refraction: sun.refraction.unwrap_or(true),
        };
        // Refuse a time out of range before anything is computed.
        source.at_start()?;
        Ok(source)
    }

    #[cfg(not(feature = "ephemeris"))]
    fn ephemeris(&self, latitude_deg: f64, _: f64, _: f64) -> Result<SunSource, SceneError> {
        Err(SceneError::value(
            "sun.latitude_deg",
            "a build with the feature ephemeris, which computes the sun of a place and a time",
            format!("one without, and {latitude_deg}"),
            "elevation_deg and azimuth_deg",
        ))
    }
}

#[cfg(test)]
#[cfg(feature = "ephemeris")]
mod tests {
    use super::*;
    use crate::atmosphere::preset;

    #[test]
    fn the_sun_is_found_or_the_error_suggests_a_position() {
        let (earth, mars) = (preset("average").unwrap(), preset("mars").unwrap());
        let mut scene = Scene::default();
        let said = |scene: &Scene, air| scene.sun_source(air, 0.0).unwrap_err().to_string();
        assert!(said(&scene, &earth).contains("elevation_deg = 10"));
        scene.sun.elevation_deg = Some(10.0);
        scene.sun.azimuth_deg = Some(-90.0);
        let sun = scene.sun_source(&mars, 0.0).unwrap().at_start().unwrap();
        assert_eq!((sun.azimuth_deg, sun.distance_ratio), (270.0, 1.0));
        scene.sun = super::super::SunSpec {
            latitude_deg: Some(48.8584),
            longitude_deg: Some(2.2945),
            time: Some("2026-06-21T14:00:00+02:00".to_owned()),
            ..Default::default()
        };
        assert!(
            said(&scene, &mars).contains("\"mars\""),
            "{}",
            said(&scene, &mars)
        );
        let source = scene.sun_source(&earth, 0.0).unwrap();
        let sun = source.at_start().unwrap();
        assert!(
            (60.0..65.0).contains(&sun.elevation_deg) && sun.distance_ratio > 1.01,
            "{sun:?}"
        );
        assert_eq!(
            source.start().unwrap().to_string(),
            "2026-06-21T14:00:00+02:00"
        );
        scene.sun.longitude_deg = Some(200.0);
        let east = scene.sun_source(&earth, 0.0).unwrap();
        assert_eq!(east.place().unwrap().longitude_deg, -160.0);
        scene.sun.time = Some("yesterday".to_owned());
        assert!(
            said(&scene, &earth).starts_with("sun.time: ")
                && said(&scene, &earth).ends_with("try now")
        );
    }
}
