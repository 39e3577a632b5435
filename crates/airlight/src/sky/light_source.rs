//! [`LightSource`]: what lights a view from outside the air.

use crate::night::MoonState;
use crate::sun::{SunDisc, SunState};
use glam::DVec3;

/// A distant light outside the air. A sky that is solved for the sun answers for the moon, too: the light inside the air is solved for
/// unit irradiance, so that only the irradiance and the disc of the source differ.
///
/// Light adds up: the sky under two sources is the sum of its views under each.
#[derive(Clone, Copy, Debug, PartialEq)]
#[non_exhaustive]
pub enum LightSource {
    /// The sun.
    Sun(SunState),
    /// The moon, in sunlight.
    Moon(MoonState),
}

impl LightSource {
    /// Vector towards the source, of unit length if it was made so.
    pub fn direction(&self) -> DVec3 {
        match self {
            Self::Sun(sun) => sun.direction,
            Self::Moon(moon) => moon.direction,
        }
    }

    /// The same source with a unit vector towards it.
    pub(super) fn normalised(self) -> Self {
        let direction = self.direction().normalize();
        match self {
            Self::Sun(sun) => Self::Sun(SunState { direction, ..sun }),
            Self::Moon(moon) => Self::Moon(MoonState { direction, ..moon }),
        }
    }

    /// Irradiance outside the air relative to that of the sun at the planet's mean distance, at a wavelength, nm.
    pub fn irradiance_ratio(&self, wavelength_nm: f64) -> f64 {
        match self {
            Self::Sun(sun) => sun.irradiance_factor(),
            Self::Moon(moon) => moon.irradiance_ratio(wavelength_nm),
        }
    }

    /// The disc of the source without the phase of the moon, from that of the sun at the planet's mean distance.
    pub fn disc(&self, sun_at_mean_distance: &SunDisc) -> SunDisc {
        match self {
            Self::Sun(sun) => sun.disc(sun_at_mean_distance),
            Self::Moon(moon) => moon.disc(),
        }
    }

    /// Radiance at a place on the disc relative to that of [`LightSource::disc`], along a unit vector: the phase of the moon
    /// ([`MoonState::relative_radiance`]), 1 for the sun.
    pub fn relative_radiance(&self, direction: DVec3) -> f64 {
        match self {
            Self::Sun(_) => 1.0,
            Self::Moon(moon) => moon.relative_radiance(direction),
        }
    }
}

impl From<DVec3> for LightSource {
    /// The sun in this direction, at the planet's mean distance.
    fn from(direction: DVec3) -> Self {
        SunState::from(direction).into()
    }
}

impl From<SunState> for LightSource {
    fn from(sun: SunState) -> Self {
        Self::Sun(sun)
    }
}

impl From<MoonState> for LightSource {
    fn from(moon: MoonState) -> Self {
        Self::Moon(moon)
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::atmosphere::reference;
    use crate::axes;
    use crate::sky::{Sky, SkySettings, SunCoverage};
    use crate::spectrum::WavelengthGrid;

    /// By the ratio of the irradiances, which is that of the published albedo; and dark where the moon is.
    #[test]
    fn the_sky_under_the_moon_is_the_daylight_sky_by_its_irradiance() {
        let grid = WavelengthGrid::from_wavelengths_nm(vec![450.0, 550.0, 650.0]).unwrap();
        let settings = SkySettings {
            suns: SunCoverage::near(30.0, 0.0),
            ..Default::default()
        };
        let sky = Sky::prepare(&reference::earth_demo(), &grid, &settings).unwrap();
        let direction = axes::direction(120.0, 30.0);
        let moon = MoonState::lit_by(direction, axes::direction(300.0, -30.0));
        let moon = moon.with_phase(60.0).unwrap();
        let [by_day, by_night] =
            [LightSource::from(direction), moon.into()].map(|source| sky.view(2.0, source));
        assert_eq!(by_night.source(), &LightSource::Moon(moon));
        assert_eq!(by_night.sun(), by_day.sun());
        let towards = axes::direction(80.0, 20.0);
        let [day, night] = [&by_day, &by_night].map(|view| view.along(towards, None).radiance());
        for (k, &nm) in grid.wavelengths_nm().iter().enumerate() {
            let ratio = f64::from(night[k]) / f64::from(day[k]);
            assert!((ratio / moon.irradiance_ratio(nm) - 1.0).abs() < 1e-6);
        }
        // The disc: its light is the irradiance, and half a disc is lit at 90 degrees.
        let quarter = moon.with_phase(90.0).unwrap();
        let view = sky.view(2.0, quarter);
        let aside = (quarter.to_sun - direction * direction.dot(quarter.to_sun)).normalize();
        let at = |part: f64| {
            let offset = aside * part * quarter.angular_radius_rad();
            view.sun_disc_radiance((direction + offset).normalize())[1]
        };
        assert!(at(0.5) > 0.0 && at(0.8) > at(0.2));
        assert_eq!(at(-0.5), 0.0);
        assert_eq!(at(1.1), 0.0);
    }
}
