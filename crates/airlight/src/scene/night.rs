//! Lights of the night in physical quantities.

use super::spec::{NightLights, NightSpec};
use crate::atmosphere::Atmosphere;
use crate::axes;
use crate::night::{MEAN_SOLAR_FLUX_SFU, MoonState};
use crate::sky::SunCoverage;
use glam::DVec3;

/// Elevation of the sun below which the lights of the night are drawn by default, degrees. There the sky is 1e5 times as bright
/// as they are, so that none of them appears suddenly but a moon.
const NIGHT_DEG: f64 = -4.0;

/// Lights of the night in a scene.
#[derive(Clone, Copy, Debug, PartialEq)]
#[non_exhaustive]
pub struct NightSettings {
    /// Whether they are there by day, too.
    pub by_day: bool,
    /// The moon.
    pub moon: MoonSource,
    /// Phase angle of the moon instead of its own, degrees.
    pub moon_phase_deg: Option<f64>,
    /// Whether single stars are visible.
    pub stars: bool,
    /// Solar radio flux that determines the airglow, solar flux units.
    pub solar_flux_sfu: f64,
    /// Luminance of the moonless zenith with the glow of cities, magnitudes per square arcsecond.
    pub sky_quality_mag: Option<f64>,
    /// Latitude of the celestial sphere over a fixed sun, degrees.
    pub latitude_deg: f64,
}

/// Source of the moon's position.
#[derive(Clone, Copy, Debug, PartialEq)]
#[non_exhaustive]
pub enum MoonSource {
    /// No moon.
    None,
    /// The moon of the scene's place and time; none over a fixed sun.
    Ephemeris,
    /// A fixed unit vector towards it.
    Fixed(DVec3),
}

impl NightSpec {
    /// The settings, or `None` if there are no lights of the night: the atmosphere of another planet, or
    /// [`NightLights::Off`].
    pub(super) fn resolve(&self, atmosphere: &Atmosphere) -> Option<NightSettings> {
        let lights = self.lights.unwrap_or_default();
        if lights == NightLights::Off || !atmosphere.is_earth() {
            return None;
        }
        let moon = match (self.moon, self.moon_elevation_deg) {
            (Some(false), _) => MoonSource::None,
            (_, None) => MoonSource::Ephemeris,
            (_, Some(elevation_deg)) => MoonSource::Fixed(axes::direction(
                self.moon_azimuth_deg.unwrap_or(180.0),
                elevation_deg,
            )),
        };
        Some(NightSettings {
            by_day: lights == NightLights::On,
            moon,
            moon_phase_deg: self.moon_phase_deg,
            stars: self.stars.unwrap_or(true),
            solar_flux_sfu: self.solar_flux_sfu.unwrap_or(MEAN_SOLAR_FLUX_SFU),
            sky_quality_mag: self.sky_quality_mag,
            latitude_deg: self.latitude_deg.unwrap_or(45.0),
        })
    }
}

impl NightSettings {
    /// Whether the lights of the night are drawn for a sun at an elevation.
    pub(super) fn includes(&self, sun_elevation_deg: f64) -> bool {
        self.by_day || sun_elevation_deg < NIGHT_DEG
    }

    /// Whether a range of suns may include the night.
    pub(crate) fn may_include(&self, suns: SunCoverage) -> bool {
        match suns {
            SunCoverage::Near {
                sun_elevation_deg, ..
            } => self.includes(sun_elevation_deg),
            _ => true,
        }
    }
}

impl NightSettings {
    /// The moon over a fixed sun, if it is given.
    pub(super) fn fixed_moon(&self, sun: DVec3) -> Option<MoonState> {
        match self.moon {
            MoonSource::Fixed(direction) => {
                Some(self.with_phase(MoonState::lit_by(direction, sun)))
            }
            _ => None,
        }
    }

    /// A moon with the phase of the settings, if they give one.
    pub(super) fn with_phase(&self, moon: MoonState) -> MoonState {
        let phased = self
            .moon_phase_deg
            .and_then(|deg| moon.with_phase(deg).ok());
        phased.unwrap_or(moon)
    }
}
