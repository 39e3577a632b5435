//! The solver `orders`: successive orders of scattering on the sphere, with fog in the sky.

use crate::control::Control;
use crate::night::NightState;
use crate::scene::{
    Capabilities, Channels, FogLayers, Input, NightSky, PreparedModel, RadianceModel, RadianceView,
    ResolvedScene, SceneError, SolvedView, SunState,
};
use crate::sky::{Sky, SkySettings, SunCoverage};
use crate::spectrum::WavelengthGrid;
use std::sync::Arc;

/// Successive orders of scattering on the sphere as a [`RadianceModel`]: the fast solver, without noise.
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
                Input::Night,
                Input::Fog,
                Input::FogScattering,
                Input::FogPatches,
                Input::Objects,
                Input::Wavelengths,
                Input::Scattering,
                Input::Effort,
                Input::PolarisationCorrection,
                Input::Polarisation,
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
        if scene.set_inputs.contains(&Input::Polarisation) && scene.fog.is_some() {
            return Err(SceneError::value(
                "output.polarisation",
                "air without fog, or the solver monte-carlo",
                "fog",
                "solver.name = \"monte-carlo\"",
            ));
        }
        let settings = scene.solver.sky_settings(suns);
        let prepared = PreparedOrders::new(scene, &settings, control)?;
        let night = scene.night.filter(|night| night.may_include(suns));
        let night = night.map(|night| NightSky::new(scene, night, (&prepared.sky, suns), control));
        Ok(Arc::new(PreparedOrders {
            night: night.transpose()?,
            ..prepared
        }))
    }
}

/// A solved sky, and the fog to add to it.
#[derive(Clone, Debug)]
pub(super) struct PreparedOrders {
    sky: Sky,
    fog: Option<FogLayers>,
    /// Lights of the night, if the range of suns includes the night.
    night: Option<NightSky>,
}

impl PreparedOrders {
    /// Solves the sky of a scene.
    ///
    /// # Errors
    /// [`SceneError::Sky`] if the solver fails.
    pub fn new(
        scene: &ResolvedScene,
        settings: &SkySettings,
        control: Control<'_>,
    ) -> Result<Self, SceneError> {
        Ok(Self {
            sky: Sky::prepare_with(&scene.atmosphere, &scene.grid, settings, control)?,
            fog: scene.fog.clone(),
            night: None,
        })
    }

    /// View for an eye at an altitude (m above sea level) under a sun.
    ///
    /// # Errors
    /// [`SceneError`] for an invalid fog, and where the sky is not prepared for the view and does not converge.
    pub fn solved_view(
        &self,
        observer_altitude_m: f64,
        sun: &SunState,
        channels: Channels,
        control: Control<'_>,
    ) -> Result<SolvedView, SceneError> {
        let view = self.sky.view_with(observer_altitude_m, *sun, control)?;
        SolvedView::new(view, self.fog.as_ref(), channels, control)
    }
}

impl PreparedModel for PreparedOrders {
    fn grid(&self) -> Option<&WavelengthGrid> {
        Some(self.sky.grid())
    }

    fn view_with(
        &self,
        observer_altitude_m: f64,
        sun: &SunState,
        channels: Channels,
        control: Control<'_>,
    ) -> Result<Arc<dyn RadianceView>, SceneError> {
        Ok(Arc::new(self.solved_view(
            observer_altitude_m,
            sun,
            channels,
            control,
        )?))
    }

    fn view_of_rays_with(
        &self,
        observer_altitude_m: f64,
        sun: &SunState,
        channels: Channels,
        control: Control<'_>,
    ) -> Result<Arc<dyn RadianceView>, SceneError> {
        if self.fog.is_some() {
            return self.view_with(observer_altitude_m, sun, channels, control);
        }
        let view = self.sky.view_with(observer_altitude_m, *sun, control)?;
        Ok(Arc::new(SolvedView::without_table(view, channels)))
    }

    fn night_view_with(
        &self,
        observer_altitude_m: f64,
        sun: &SunState,
        night: &NightState,
        channels: Channels,
        control: Control<'_>,
    ) -> Result<Arc<dyn RadianceView>, SceneError> {
        match &self.night {
            Some(lights) => {
                let sunlit = self.sky.view_with(observer_altitude_m, *sun, control)?;
                Ok(Arc::new(lights.view(sunlit, night, channels, control)?))
            }
            None => self.view_with(observer_altitude_m, sun, channels, control),
        }
    }

    fn with_fog(&self, fog: Option<&FogLayers>) -> Option<Arc<dyn PreparedModel>> {
        Some(Arc::new(Self {
            sky: self.sky.clone(),
            night: self.night.as_ref().map(|night| night.with_fog(fog)),
            fog: fog.cloned(),
        }))
    }
}
