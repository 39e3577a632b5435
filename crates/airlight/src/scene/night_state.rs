//! Celestial sphere and moon of a scene at a time.

#[cfg(feature = "ephemeris")]
use super::MoonSource;
use super::{ResolvedScene, SunAngles, SunSource};
#[cfg(feature = "ephemeris")]
use crate::atmosphere::refracting_air;
#[cfg(feature = "ephemeris")]
use crate::night::MoonState;
use crate::night::{CelestialFrame, NightState};
#[cfg(feature = "ephemeris")]
use crate::sun::Moment;

impl ResolvedScene {
    /// Celestial sphere and moon under a sun at the time of the scene; `None` by day and without lights of the night.
    pub fn night(&self, sun: &SunAngles) -> Option<NightState> {
        match self.sun {
            SunSource::Fixed(_) => self.night_over_fixed_sun(sun),
            #[cfg(feature = "ephemeris")]
            SunSource::Ephemeris { start, .. } => self.night_at(sun, start),
        }
    }

    fn night_over_fixed_sun(&self, sun: &SunAngles) -> Option<NightState> {
        let night = self
            .night
            .filter(|night| night.includes(sun.elevation_deg))?;
        let direction = sun.direction();
        Some(NightState {
            frame: CelestialFrame::with_sun(direction, night.latitude_deg),
            moon: night.fixed_moon(direction),
        })
    }

    /// [`ResolvedScene::night`] at another time.
    #[cfg(feature = "ephemeris")]
    pub fn night_at(&self, sun: &SunAngles, time: Moment) -> Option<NightState> {
        let SunSource::Ephemeris {
            place, refraction, ..
        } = self.sun
        else {
            return self.night_over_fixed_sun(sun);
        };
        let night = self
            .night
            .filter(|night| night.includes(sun.elevation_deg))?;
        let (latitude_deg, longitude_deg) = (place.latitude_deg, place.longitude_deg);
        let moon = match night.moon {
            MoonSource::Ephemeris => {
                let air = refraction.then(|| refracting_air(place.altitude_m));
                let moon = MoonState::at(time.unix_s(), latitude_deg, longitude_deg, air);
                Some(night.with_phase(moon))
            }
            _ => night.fixed_moon(sun.direction()),
        };
        Some(NightState {
            frame: CelestialFrame::at(time.unix_s(), latitude_deg, longitude_deg),
            moon,
        })
    }
}
