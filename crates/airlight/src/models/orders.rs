//! The solver `orders`: successive orders of scattering on the sphere, with fog in the sky.

use crate::control::Control;
use crate::scene::{
    Capabilities, Channels, Effort, FogLayers, Input, PreparedModel, RadianceModel, RadianceView,
    ResolvedScene, SceneError, SolvedView, SolverSpec, SunState,
};
use crate::sky::{Scattering, Sky, SkySettings, SunCoverage};
use crate::spectrum::WavelengthGrid;
use std::sync::Arc;

/// Successive orders of scattering on the sphere: the fast solver, without noise.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(crate) struct Orders;

impl RadianceModel for Orders {
    fn name(&self) -> &'static str {
        "orders"
    }

    fn summary(&self) -> &'static str {
        "successive orders of scattering on the sphere: the fast solver, without noise"
    }

    fn capabilities(&self) -> Capabilities {
        Capabilities {
            inputs: &[
                Input::Atmosphere,
                Input::Haze,
                Input::Ozone,
                Input::GroundAlbedo,
                Input::ObserverHeight,
                Input::SunDistance,
                Input::Fog,
                Input::FogScattering,
                Input::Objects,
                Input::Wavelengths,
                Input::Scattering,
                Input::Effort,
                Input::Spectra,
                Input::Distances,
            ],
            variants: &[],
            twilight: true,
            parts: true,
        }
    }

    fn prepare(
        &self,
        scene: &ResolvedScene,
        suns: SunCoverage,
        control: Control<'_>,
    ) -> Result<Arc<dyn PreparedModel>, SceneError> {
        let settings = sky_settings(&scene.solver, suns);
        let prepared = PreparedOrders::new(scene, &settings, control)?;
        Ok(Arc::new(prepared))
    }
}

/// How the sky is solved under a range of suns.
pub(super) fn sky_settings(solver: &SolverSpec, suns: SunCoverage) -> SkySettings {
    SkySettings {
        suns,
        scattering: solver.scattering.unwrap_or(Scattering::All),
        ..match solver.effort.unwrap_or_default() {
            Effort::Standard => SkySettings::default(),
            Effort::Fine => SkySettings::fine(),
        }
    }
}

/// A solved sky, and the fog to be put into it.
#[derive(Clone, Debug)]
pub(super) struct PreparedOrders {
    sky: Sky,
    fog: Option<FogLayers>,
}

impl PreparedOrders {
    /// Solves the sky of a scene.
    ///
    /// # Errors
    /// [`SceneError::Sky`] for an atmosphere that the solver refuses.
    pub fn new(
        scene: &ResolvedScene,
        settings: &SkySettings,
        control: Control<'_>,
    ) -> Result<Self, SceneError> {
        Ok(Self {
            sky: Sky::prepare_with(&scene.atmosphere, &scene.grid, settings, control)?,
            fog: scene.fog.clone(),
        })
    }

    /// The light at an eye under a sun.
    ///
    /// # Errors
    /// [`SceneError`] for fog that is refused.
    pub fn solved_view(
        &self,
        observer_altitude_m: f64,
        sun: &SunState,
        channels: Channels,
    ) -> Result<SolvedView, SceneError> {
        let ratio = sun.distance_ratio;
        let view = self.sky.view(observer_altitude_m, sun.direction);
        SolvedView::new(
            view.at_sun_distance(ratio),
            ratio,
            self.fog.as_ref(),
            channels,
        )
    }
}

impl PreparedModel for PreparedOrders {
    fn grid(&self) -> Option<&WavelengthGrid> {
        Some(self.sky.grid())
    }

    fn view(
        &self,
        observer_altitude_m: f64,
        sun: &SunState,
        channels: Channels,
    ) -> Result<Arc<dyn RadianceView>, SceneError> {
        Ok(Arc::new(self.solved_view(
            observer_altitude_m,
            sun,
            channels,
        )?))
    }
}
