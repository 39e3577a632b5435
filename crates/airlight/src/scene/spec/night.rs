//! Lights of the night: moon, stars, airglow, zodiacal light and the glow of cities.

use crate::names::named;

/// Lights of the night: moon, stars, airglow, zodiacal light and the glow of cities.
///
/// On the Earth they are part of the sky once the sun is 4 degrees below the horizon. With a place and a time, moon and stars stand
/// where they do; with a fixed sun the celestial sphere is that of `latitude_deg`, and there is a moon only if its position is
/// given.
#[derive(Clone, Debug, Default, PartialEq)]
#[cfg_attr(feature = "serde", derive(serde::Serialize, serde::Deserialize))]
#[cfg_attr(feature = "serde", serde(default, deny_unknown_fields))]
#[cfg_attr(feature = "schema", derive(schemars::JsonSchema))]
pub struct NightSpec {
    /// When the lights of the night are part of the sky. Default: auto.
    pub lights: Option<NightLights>,
    /// Whether the moon is there. Default: true.
    pub moon: Option<bool>,
    /// Elevation of the moon's centre above the horizontal, degrees, instead of the moon of the time.
    pub moon_elevation_deg: Option<f64>,
    /// Azimuth of the moon, degrees clockwise from north, with `moon_elevation_deg`. Default: 180, south.
    pub moon_azimuth_deg: Option<f64>,
    /// Phase angle of the moon, degrees from 0 (full) to 180 (new). Default: that of its angle from the sun.
    pub moon_phase_deg: Option<f64>,
    /// Whether pictures show single stars, up to magnitude 6.5. Default: true.
    pub stars: Option<bool>,
    /// Solar radio flux at 10.7 cm that determines the airglow, solar flux units, 50 to 400: about 70 in quiet years, 200 in active
    /// ones. Default: 100.
    pub solar_flux_sfu: Option<f64>,
    /// Luminance of the moonless sky at the zenith that the glow of cities brings about, magnitudes per square arcsecond (the
    /// reading of a sky quality meter): 17 in a large city, 20.5 in the country, 22 where there is none. Default: no glow.
    pub sky_quality_mag: Option<f64>,
    /// Latitude that orients stars and Milky Way over a fixed sun, degrees, -90 to 90. Default: 45.
    pub latitude_deg: Option<f64>,
}

impl NightSpec {
    /// Whether lights of the night are set, other than that there are none.
    pub(crate) fn sets_lights(&self) -> bool {
        let rest = Self {
            lights: None,
            ..self.clone()
        };
        rest != Self::default() || self.lights == Some(NightLights::On)
    }
}

/// When the lights of the night are part of the sky.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
#[non_exhaustive]
pub enum NightLights {
    /// Once the sun is 4 degrees below the horizon.
    #[default]
    Auto,
    /// At any time: a moon by day, too.
    On,
    /// Never: sunlight only.
    Off,
}

named! { NightLights, "a choice of night lights", [
    ("auto", (Auto), "once the sun is 4 degrees below the horizon"),
    ("on", (On), "at any time: a moon by day, too"),
    ("off", (Off), "never: sunlight only"),
] }
