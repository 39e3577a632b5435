//! Finding the sun of a scene: as set, or from place and time.

use super::{Scene, SceneError, SunState};
use crate::atmosphere::Atmosphere;
#[cfg(feature = "ephemeris")]
use crate::atmosphere::refracting_air;
use crate::axes;
#[cfg(feature = "ephemeris")]
use crate::sun::{Moment, Place, sun_position};
use glam::DVec3;

/// How the sun is found.
#[derive(Clone, Copy, Debug, PartialEq)]
#[non_exhaustive]
pub enum SunSource {
    /// Its position is set.
    Fixed(SunAngles),
    /// From a place on the Earth and a time.
    #[cfg(feature = "ephemeris")]
    Ephemeris {
        /// The place, at the altitude of the eye.
        place: Place,
        /// The time; of a sequence, its start.
        start: Moment,
        /// Whether the air lifts the sun.
        refraction: bool,
    },
}

/// Position of the sun in the sky.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct SunAngles {
    /// Degrees clockwise from north.
    pub azimuth_deg: f64,
    /// Degrees above the horizontal, as seen.
    pub elevation_deg: f64,
    /// The same without refraction, where place and time gave it.
    pub geometric_elevation_deg: Option<f64>,
    /// Distance over the planet's mean distance.
    pub distance_ratio: f64,
}

impl SunAngles {
    /// Unit vector towards it.
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
    /// The sun at the time of the scene, the start of a sequence.
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
    /// The sun at a time. A fixed sun does not move.
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

    /// The time, or the start of a sequence; `None` for a fixed sun.
    pub fn start(&self) -> Option<Moment> {
        match self {
            Self::Fixed(_) => None,
            Self::Ephemeris { start, .. } => Some(*start),
        }
    }

    /// The place on the Earth; `None` for a fixed sun.
    pub fn place(&self) -> Option<Place> {
        match self {
            Self::Fixed(_) => None,
            Self::Ephemeris { place, .. } => Some(*place),
        }
    }
}

impl Scene {
    /// How the sun is found, for an eye at an altitude (m above sea level) in an atmosphere.
    ///
    /// # Errors
    /// [`SceneError`] where the scene does not say where the sun is, or says a time that is none.
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
                "the Earth, for which place and time give the sun",
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
            .map_err(|error| SceneError::refused("sun.time", format!("{error}; or write now")))?;
        let source = SunSource::Ephemeris {
            place: Place {
                latitude_deg,
                longitude_deg,
                altitude_m,
            },
            start,
            refraction: sun.refraction.unwrap_or(true),
        };
        // A time out of range is refused before anything is computed.
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
    fn a_sun_is_found_or_its_absence_explained() {
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
        scene.sun.time = Some("yesterday".to_owned());
        assert!(
            said(&scene, &earth).starts_with("sun.time: ")
                && said(&scene, &earth).ends_with("or write now")
        );
    }
}
