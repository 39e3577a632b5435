//! [`CityGlow`]: light of cities, scattered back by the air.

use super::{ResolvedScene, SceneError};
use crate::axes;
use crate::control::Control;
use crate::night::black_body;
use crate::sky::{Sky, SkyError, SkySettings, SunCoverage};
use crate::spectrum::SpectralCurve;
use glam::DVec3;

/// Colour temperature of street lighting, K: between sodium discharge and white light-emitting diodes.
const TEMPERATURE_K: f64 = 3200.0;
/// Elevation of the sun in the two solutions that are compared, and albedo of the bright ground.
const SUN_DEG: f64 = 60.0;
const BRIGHT_ALBEDO: f64 = 0.5;

/// Radiance of a sky over ground that emits evenly everywhere: an unlimited city. What a sun adds to the sky by way of the
/// ground is the difference of two solutions, over black and over bright ground; divided by the light of the ground it is the
/// sky over ground of radiance 1, by the same solver with all orders of scattering.
///
/// A real city ends somewhere: its glow is stronger in its direction and falls off away from it. Light emitted near
/// the horizontal is underestimated, as the ground emits equally in all directions.
#[derive(Debug)]
pub(super) struct CityGlow {
    black: Sky,
    bright: Sky,
    ground_altitude_m: f64,
}

impl CityGlow {
    /// Solves the air of a scene over black and over bright ground.
    ///
    /// # Errors
    /// [`SceneError::Sky`] if the solver fails.
    pub fn new(scene: &ResolvedScene, control: Control<'_>) -> Result<Self, SceneError> {
        let settings = SkySettings {
            suns: SunCoverage::near(SUN_DEG, scene.observer_altitude_m),
            ..SkySettings::default()
        };
        let over = |albedo: f64| {
            let mut atmosphere = scene.atmosphere.clone();
            atmosphere.planet.ground_albedo = SpectralCurve::Constant(albedo);
            Sky::prepare_with(&atmosphere, &scene.grid, &settings, control)
        };
        Ok(Self {
            black: over(0.0)?,
            bright: over(BRIGHT_ALBEDO)?,
            ground_altitude_m: scene.atmosphere.planet.ground_altitude_m,
        })
    }

    /// Radiance of the sky at each wavelength along directions (unit vectors), for an eye at an altitude, over ground with the
    /// spectrum of street lighting; scaled so that the luminance at the zenith is 1 cd/m^2. Towards the ground 0: streets are
    /// not drawn.
    ///
    /// # Errors
    /// [`SkyError::NotConverged`] for an altitude far from that of the scene.
    pub fn radiance(
        &self,
        altitude_m: f64,
        directions: &[DVec3],
    ) -> Result<Vec<Vec<f64>>, SkyError> {
        let sun = axes::direction(180.0, SUN_DEG);
        let grid = self.bright.grid();
        let street_light = black_body(grid, TEMPERATURE_K);
        let ground = self
            .bright
            .try_view(self.ground_altitude_m, sun)?
            .along(-DVec3::Y, None);
        let (bright, black) = (
            self.bright.try_view(altitude_m, sun)?,
            self.black.try_view(altitude_m, sun)?,
        );
        let along = |direction: DVec3| -> Vec<f64> {
            let (over_bright, over_black) =
                (bright.along(direction, None), black.along(direction, None));
            let more = over_bright
                .path_radiance()
                .into_iter()
                .zip(over_black.path_radiance());
            more.zip(&ground.ground)
                .zip(&street_light)
                .map(|(((bright, black), ground), street_light)| {
                    f64::from((bright - black).max(0.0)) / f64::from(*ground) * street_light
                })
                .collect()
        };
        let zenith: Vec<f32> = along(DVec3::Y).iter().map(|&v| v as f32).collect();
        let scale = 1.0 / grid.to_xyz(&zenith)[1];
        Ok(directions
            .iter()
            .map(|&direction| along(direction).iter().map(|v| v * scale).collect())
            .collect())
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::scene::Scene;

    #[test]
    fn the_glow_grows_towards_the_horizon_and_is_reddish() {
        let mut scene = Scene::default();
        scene.sun.elevation_deg = Some(-30.0);
        let resolved = scene.resolve().unwrap();
        let glow = CityGlow::new(&resolved, Control::default()).unwrap();
        let directions: Vec<DVec3> = [90.0, 60.0, 30.0, 10.0]
            .map(|deg| axes::direction(0.0, deg))
            .to_vec();
        let values = glow.radiance(2.0, &directions).unwrap();
        let luminance: Vec<f64> = values
            .iter()
            .map(|v| {
                let v: Vec<f32> = v.iter().map(|&v| v as f32).collect();
                resolved.grid.to_xyz(&v)[1]
            })
            .collect();
        assert!((luminance[0] - 1.0).abs() < 1e-4);
        assert!(luminance.is_sorted(), "{luminance:?}");
        assert!(luminance[2] > 1.3 && luminance[3] < 12.0, "{luminance:?}");
    }
}
