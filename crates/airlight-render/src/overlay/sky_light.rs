//! Fog lit by a solved sky.

use crate::RenderError;
use airlight::Control;
use airlight::atmosphere::{Atmosphere, Constituent};
use airlight::fog::FogScattering;
use airlight::scene::{NightLight, ResolvedScene, RgbFoggySky, SceneError, SunState};
use airlight::sky::{Sky, SunCoverage, View};
use airlight::spectrum::RgbSpace;
use std::fmt;
use std::sync::{Mutex, PoisonError};

/// A solved sky that lights fog, shared by all pictures with the same air, eye and sun. It caches the last fog; another fog in
/// the same sky is computed quickly.
pub struct SkyLight {
    view: View,
    observer_altitude_m: f64,
    sun: SunState,
    night: Option<NightLight>,
    last: Mutex<Option<LitFog>>,
}

#[derive(Clone)]
struct LitFog {
    layers: Vec<Constituent>,
    scattering: FogScattering,
    sky: RgbFoggySky,
}

impl SkyLight {
    /// Solves the sky of a scene, and the lights of its night.
    ///
    /// # Errors
    /// [`RenderError::Scene`] for a sun outside the range of the ephemeris, and if the solver fails.
    pub fn solve(scene: &ResolvedScene) -> Result<Self, RenderError> {
        Self::solve_with(scene, Control::default())
    }

    /// As [`Self::solve`], with progress and cancellation.
    ///
    /// # Errors
    /// As [`Self::solve`], and if the caller cancelled.
    pub fn solve_with(scene: &ResolvedScene, control: Control<'_>) -> Result<Self, RenderError> {
        let sun = scene.sun.at_start()?;
        let suns = SunCoverage::near(sun.elevation_deg, scene.observer_altitude_m);
        let settings = scene.solver.sky_settings(suns);
        let sky = Sky::prepare_with(&scene.atmosphere, &scene.grid, &settings, control)
            .map_err(SceneError::from)?;
        let view = sky
            .view_with(scene.observer_altitude_m, sun.state(), control)
            .map_err(SceneError::from)?;
        Ok(Self {
            night: NightLight::new_with(scene, &view, &sun, RgbSpace::Srgb, control)?,
            view,
            observer_altitude_m: scene.observer_altitude_m,
            sun: sun.state(),
            last: Mutex::new(None),
        })
    }

    /// The sky with layers of fog.
    ///
    /// # Errors
    /// [`RenderError`] for fog without an upper end, which no skylight can enter, and for invalid fog.
    pub fn with_fog(
        &self,
        layers: &[Constituent],
        scattering: FogScattering,
    ) -> Result<RgbFoggySky, RenderError> {
        self.with_fog_with(layers, scattering, Control::default())
    }

    /// As [`Self::with_fog`], with cancellation.
    ///
    /// # Errors
    /// As [`Self::with_fog`], and if the caller cancelled.
    pub fn with_fog_with(
        &self,
        layers: &[Constituent],
        scattering: FogScattering,
        control: Control<'_>,
    ) -> Result<RgbFoggySky, RenderError> {
        if layers.iter().any(|layer| layer.density.is_uniform()) {
            return Err(Self::needs_top());
        }
        let last = self
            .last
            .lock()
            .unwrap_or_else(PoisonError::into_inner)
            .clone();
        let sky = match last {
            Some(last) if last.layers == layers && last.scattering == scattering => {
                return Ok(last.sky);
            }
            Some(last) => last.sky.with_fog_with(layers, scattering, control)?,
            None => match &self.night {
                Some(night) => {
                    RgbFoggySky::at_night_with(&self.view, night, layers, scattering, control)?
                }
                None => {
                    let space = RgbSpace::Srgb;
                    RgbFoggySky::new_with(&self.view, layers, scattering, space, control)?
                }
            },
        };
        *self.last.lock().unwrap_or_else(PoisonError::into_inner) = Some(LitFog {
            layers: layers.to_vec(),
            scattering,
            sky: sky.clone(),
        });
        Ok(sky)
    }

    /// The error for fog without an upper end.
    pub(super) fn needs_top() -> RenderError {
        RenderError::setting(
            "sky-light: expected fog with an upper end, where skylight enters, got uniform fog; try fog-profile height, \
             clamped, unclamped or slab, and scale-height or top for each layer",
        )
    }

    /// Direction and distance of the sun.
    pub fn sun(&self) -> &SunState {
        &self.sun
    }

    /// The atmosphere without the fog.
    pub fn atmosphere(&self) -> &Atmosphere {
        self.view.sky().atmosphere()
    }

    /// Altitude of the eye above sea level, m.
    pub fn observer_altitude_m(&self) -> f64 {
        self.observer_altitude_m
    }
}

impl fmt::Debug for SkyLight {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.debug_struct("SkyLight")
            .field("observer_altitude_m", &self.observer_altitude_m)
            .field("sun", &self.sun)
            .finish_non_exhaustive()
    }
}
