//! A published model prepared for a scene.

use super::PublishedModel;
use super::published_view::PublishedView;
use crate::atmosphere::turbidity_of_optical_depth;
use crate::atmosphere::{Atmosphere, ConstituentKind};
use crate::control::Control;
use crate::scene::{Channels, PreparedModel, RadianceView, ResolvedScene, SceneError, SunState};
use crate::spectrum::{SpectralCurve, WavelengthGrid};
use std::fmt;
use std::sync::Arc;

/// A published model prepared for a scene; `make` builds it for an eye at an altitude (m above sea level) and a sun.
pub(super) struct Prepared<F> {
    name: &'static str,
    albedo: SpectralCurve,
    /// Wavelengths of its spectra, if it has spectra.
    grid: Option<WavelengthGrid>,
    /// Whether objects are shaded at the model's wavelengths in RGB pictures too.
    spectral_objects: bool,
    make: F,
}

impl<F> Prepared<F>
where
    F: Fn(f64, &SunState, Control<'_>) -> Result<Arc<dyn PublishedModel>, SceneError>
        + Send
        + Sync
        + 'static,
{
    /// A model with spectra at the wavelengths of `grid`, or with colours only for `None`.
    pub fn new(
        name: &'static str,
        scene: &ResolvedScene,
        grid: Option<WavelengthGrid>,
        make: F,
    ) -> Self {
        Self {
            name,
            albedo: scene.atmosphere.planet.ground_albedo.clone(),
            grid,
            spectral_objects: false,
            make,
        }
    }

    /// The same, with objects shaded at the model's wavelengths in RGB pictures too.
    pub fn with_spectral_objects(self) -> Self {
        Self {
            spectral_objects: true,
            ..self
        }
    }
}

impl<F> PreparedModel for Prepared<F>
where
    F: Fn(f64, &SunState, Control<'_>) -> Result<Arc<dyn PublishedModel>, SceneError>
        + Send
        + Sync
        + 'static,
{
    fn grid(&self) -> Option<&WavelengthGrid> {
        self.grid.as_ref()
    }

    fn object_channels(&self, channels: Channels) -> Channels {
        match self.spectral_objects {
            true => Channels::Spectral,
            false => channels,
        }
    }

    fn view_with(
        &self,
        observer_altitude_m: f64,
        sun: &SunState,
        channels: Channels,
        control: Control<'_>,
    ) -> Result<Arc<dyn RadianceView>, SceneError> {
        let model = (self.make)(observer_altitude_m, sun, control)?;
        Ok(Arc::new(PublishedView::new(
            self.name,
            model,
            &self.albedo,
            channels,
        )?))
    }
}

impl<F> fmt::Debug for Prepared<F> {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.debug_struct("Prepared")
            .field("name", &self.name)
            .finish_non_exhaustive()
    }
}

/// Turbidity of an atmosphere: optical depth of molecules and haze relative to that of the molecules, at 550 nm.
pub(super) fn turbidity(air: &Atmosphere) -> f64 {
    let planet = &air.planet;
    let depth = air
        .constituent(&ConstituentKind::Aerosol)
        .map_or(0.0, |haze| {
            haze.optical_depth(planet.ground_altitude_m, planet.top_altitude_m, 550.0)
        });
    turbidity_of_optical_depth(depth, air.clear_air())
}
