//! L. Hosek and A. Wilkie, "An Analytic Model for Full Spectral Sky-Dome Radiance", SIGGRAPH 2012.
//!
//! An extended Perez formula fitted to path tracing, by turbidity, ground albedo and elevation of the sun, from the crate
//! `hw-skymodel`: its RGB data, of which 683 times is taken as luminance of linear sRGB in cd/m^2. Requires the feature
//! `hosek-wilkie`.
//!
//! Limits: turbidity from 1 to 10, sun from the horizon to the zenith, an eye on the ground, no light below the horizon
//! (black here), f32. The crate omits the sun's disc: it is attenuated by the formulas of [`super::preetham`].

use super::PublishedModel;
use super::preetham::DimmedSun;
use super::prepared::{Prepared, turbidity};
use crate::axes;
use crate::control::Control;
use crate::debug::debug_fields;
use crate::math::rounded::rounded;
use crate::scene::{Capabilities, Input, PreparedModel, RadianceModel, ResolvedScene, SceneError};
use crate::sky::SunCoverage;
use crate::spectrum::RgbSpace;
use crate::spectrum::rgb::{DOMINANT_NM, Matrix3, apply};
use glam::DVec3;
use hw_skymodel::rgb::{Channel, SkyParams, SkyState};
use std::sync::Arc;

/// Luminance of one unit of the crate's data, cd/m^2: its spectra are in watts.
const LUMENS_PER_WATT: f64 = 683.0;

/// Error of [`HosekWilkie::new`].
#[derive(Clone, Copy, Debug, PartialEq, thiserror::Error)]
#[non_exhaustive]
pub enum HosekWilkieError {
    /// The turbidity is out of range.
    #[error("expected a turbidity from 1 to 10, got {}", rounded(*.0))]
    Turbidity(f64),
    /// The ground's albedo is out of range.
    #[error("expected a ground albedo from 0 to 1 in red, green and blue, got {0:?}")]
    Albedo([f64; 3]),
    /// The sun is below the horizon, or its direction is zero or not finite.
    #[error(
        "expected a sun elevation from 0 to 90 degrees, got {}; the model has no sky for a sun below the horizon",
        rounded(*.0)
    )]
    SunElevation(f64),
}

/// The sky above an eye on the ground, for one turbidity, ground albedo and sun direction.
pub struct HosekWilkie {
    sun: DVec3,
    state: SkyState,
    disc: DimmedSun,
    to_xyz: Matrix3,
}

debug_fields! { HosekWilkie { sun } }

impl HosekWilkie {
    /// Sky for a turbidity (1 to 10), a ground albedo (red, green, blue; 0 to 1) and a sun direction.
    ///
    /// # Errors
    /// [`HosekWilkieError`] if an argument is outside its domain.
    pub fn new(
        turbidity: f64,
        ground_albedo: [f64; 3],
        sun_direction: DVec3,
    ) -> Result<Self, HosekWilkieError> {
        if !(1.0..=10.0).contains(&turbidity) {
            return Err(HosekWilkieError::Turbidity(turbidity));
        }
        if !ground_albedo.iter().all(|a| (0.0..=1.0).contains(a)) {
            return Err(HosekWilkieError::Albedo(ground_albedo));
        }
        let elevation_deg = axes::elevation_deg(sun_direction);
        let sun = match sun_direction.try_normalize() {
            Some(sun) if elevation_deg >= 0.0 => sun,
            _ => return Err(HosekWilkieError::SunElevation(elevation_deg)),
        };
        let params = SkyParams {
            // In f32 the zenith may round to above the crate's limit.
            elevation: (elevation_deg.to_radians() as f32).min(std::f32::consts::FRAC_PI_2),
            turbidity: turbidity as f32,
            albedo: ground_albedo.map(|a| a as f32),
        };
        let state =
            SkyState::new(&params).map_err(|_| HosekWilkieError::SunElevation(elevation_deg))?;
        Ok(Self {
            sun,
            state,
            disc: DimmedSun::new(turbidity, sun),
            to_xyz: RgbSpace::Srgb.to_xyz_matrix(),
        })
    }
}

impl PublishedModel for HosekWilkie {
    fn sun(&self) -> DVec3 {
        self.sun
    }

    /// Black below the horizon.
    fn sky_xyz(&self, direction: DVec3) -> [f64; 3] {
        if direction.y < 0.0 {
            return [0.0; 3];
        }
        let theta = direction.angle_between(DVec3::Y) as f32;
        let gamma = direction.angle_between(self.sun) as f32;
        let rgb = [Channel::R, Channel::G, Channel::B]
            .map(|c| LUMENS_PER_WATT * f64::from(self.state.radiance(theta, gamma, c)));
        apply(&self.to_xyz, rgb)
    }

    fn disc_xyz(&self, direction: DVec3) -> [f64; 3] {
        self.disc.xyz(direction)
    }
}

/// Hosek & Wilkie 2012 as a [`RadianceModel`], with turbidity and ground albedo derived from a scene.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(crate) struct HosekWilkieModel;

impl RadianceModel for HosekWilkieModel {
    fn name(&self) -> &'static str {
        "hosek-wilkie"
    }

    fn summary(&self) -> &'static str {
        "Hosek & Wilkie 2012: an analytic sky by turbidity and ground albedo, for the sun above the horizon"
    }

    fn capabilities(&self) -> Capabilities {
        Capabilities {
            inputs: &[
                Input::Atmosphere,
                Input::Haze,
                Input::GroundAlbedo,
                Input::Objects,
            ],
            variants: &[],
            twilight: false,
            parts: false,
        }
    }

    fn prepare(
        &self,
        scene: &ResolvedScene,
        _suns: SunCoverage,
        _control: Control<'_>,
    ) -> Result<Arc<dyn PreparedModel>, SceneError> {
        let (name, turbidity) = (self.name(), turbidity(&scene.atmosphere));
        let albedo = &scene.atmosphere.planet.ground_albedo;
        let albedo = DOMINANT_NM.map(|nm| albedo.at(nm));
        let prepared = Prepared::new(name, scene, None, move |_, sun, _| {
            let sky = HosekWilkie::new(turbidity, albedo, sun.direction);
            Ok(Arc::new(
                sky.map_err(|error| SceneError::model(name, error))?,
            ))
        });
        Ok(Arc::new(prepared))
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use std::f64::consts::PI;

    fn sky(turbidity: f64, sun_deg: f64) -> HosekWilkie {
        HosekWilkie::new(turbidity, [0.1; 3], axes::direction(180.0, sun_deg)).unwrap()
    }

    /// Illuminance on the ground from the sky, lx.
    fn illuminance(sky: &HosekWilkie) -> f64 {
        let (rings, sectors) = (60, 72);
        let mut sum = 0.0;
        for ring in 0..rings {
            // Uniform in the squared sine: rings of equal irradiance.
            let elevation = ((ring as f64 + 0.5) / rings as f64)
                .sqrt()
                .asin()
                .to_degrees();
            for sector in 0..sectors {
                let azimuth = 360.0 * (f64::from(sector) + 0.5) / f64::from(sectors);
                sum += sky.sky_xyz(axes::direction(azimuth, elevation))[1];
            }
        }
        PI * sum / (f64::from(rings) * f64::from(sectors))
    }

    #[test]
    fn illuminance_is_that_of_a_clear_day() {
        // A clear sky with the sun at 60 degrees gives 8 to 20 klx without direct sunlight.
        let lx = illuminance(&sky(2.5, 60.0));
        assert!((8e3..20e3).contains(&lx), "{lx}");
        assert!(illuminance(&sky(2.5, 5.0)) < 0.5 * lx);
    }

    #[test]
    fn sky_is_blue_above_and_black_below_the_horizon() {
        let sky = sky(2.5, 40.0);
        let zenith = sky.sky_xyz(DVec3::Y);
        assert!(zenith[2] > 1.3 * zenith[0], "{zenith:?}");
        assert_eq!(sky.sky_xyz(-DVec3::Y), [0.0; 3]);
        assert!(sky.disc_xyz(axes::direction(180.0, 40.0))[1] > 1e9);
    }

    #[test]
    fn invalid_arguments_are_refused() {
        let refuse = |t, a, sun| HosekWilkie::new(t, [a; 3], sun).err().unwrap();
        assert_eq!(refuse(0.5, 0.1, DVec3::Y), HosekWilkieError::Turbidity(0.5));
        assert!(matches!(
            refuse(2.0, 1.1, DVec3::Y),
            HosekWilkieError::Albedo(_)
        ));
        let text = refuse(2.0, 0.1, axes::direction(0.0, -3.0)).to_string();
        assert!(text.contains("below the horizon"), "{text}");
        assert!(matches!(
            refuse(2.0, 0.1, DVec3::ZERO),
            HosekWilkieError::SunElevation(_)
        ));
        assert!(HosekWilkie::new(10.0, [1.0; 3], DVec3::Y).is_ok());
    }
}
