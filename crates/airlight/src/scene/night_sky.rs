//! [`NightSky`]: the lights of the night as the air dims and scatters them.

use super::city_glow::CityGlow;
use super::glow_view::{GlowView, RingScattering};
use super::night_view::NightView;
use super::{
    Channels, FogLayers, NightSettings, RadianceView, ResolvedScene, SceneError, SolvedView,
};
use crate::control::Control;
use crate::night::{MoonState, NightGlow, NightState};
use crate::sky::{Sky, SkyError, SunCoverage, View};
use std::sync::{Arc, Mutex, PoisonError};

/// Depth of the moon below the horizon from which its light does not matter: that of a full moon is then less than a thousandth of
/// the airglow. Degrees.
const MOON_DOWN_DEG: f64 = 10.0;

/// The air, solved for sources anywhere above the horizon, and the lights of the night in it.
#[derive(Clone, Debug)]
pub(crate) struct NightSky {
    sky: Sky,
    fog: Option<FogLayers>,
    settings: NightSettings,
    city: Option<Arc<CityGlow>>,
    /// Scattering for the eyes of earlier views.
    rings: Arc<Mutex<Vec<Arc<RingScattering>>>>,
}

impl NightSky {
    /// Solves the air of a scene; a `sky` that is solved for all suns serves as it is.
    ///
    /// # Errors
    /// [`SceneError::Sky`] if the solver fails.
    pub fn new(
        scene: &ResolvedScene,
        settings: NightSettings,
        sky: (&Sky, SunCoverage),
        control: Control<'_>,
    ) -> Result<Self, SceneError> {
        let city = match settings.sky_quality_mag {
            Some(_) => Some(Arc::new(CityGlow::new(scene, control)?)),
            None => None,
        };
        Ok(Self {
            sky: match sky {
                (sky, SunCoverage::All) => sky.clone(),
                _ => Sky::prepare_with(
                    &scene.atmosphere,
                    &scene.grid,
                    &scene.solver.sky_settings(SunCoverage::AboveHorizon),
                    control,
                )?,
            },
            fog: scene.fog.clone(),
            settings,
            city,
            rings: Arc::default(),
        })
    }

    /// The same lights in another fog.
    pub fn with_fog(&self, fog: Option<&FogLayers>) -> Self {
        Self {
            fog: fog.cloned(),
            ..self.clone()
        }
    }

    /// A sky under the sun, and the lights of a night with it.
    ///
    /// # Errors
    /// [`SceneError`] for an invalid fog, and if the caller cancelled.
    pub fn view(
        &self,
        sunlit: View,
        night: &NightState,
        channels: Channels,
        control: Control<'_>,
    ) -> Result<NightView, SceneError> {
        let altitude_m = sunlit.radius_m() - sunlit.sky().atmosphere().planet.radius_m;
        let moon = night.moon.map(|moon| -> Result<_, SceneError> {
            let view = self.moonlit(altitude_m, &moon, control)?;
            let lit = SolvedView::new(view, self.fog.as_ref(), channels, control)?;
            Ok(Arc::new(lit) as Arc<dyn RadianceView>)
        });
        let glow = self.glow(altitude_m, night, channels, control)?;
        let lighting = match self.fog {
            Some(_) => glow.mean_radiance(),
            None => Vec::new(),
        };
        let fog = self.fog.as_ref();
        let sunlit = SolvedView::with_glow(sunlit, &lighting, fog, channels, control)?;
        let glow = match sunlit.fog() {
            Some(fog) => glow.behind(fog.clone()),
            None => glow,
        };
        let stars = self.settings.stars.then(|| glow.stars(&night.frame));
        Ok(NightView::new(sunlit, moon.transpose()?, glow, stars))
    }

    /// The sky under the moon of a night, for an eye at an altitude, m; `None` if the moon is so low that its light does not matter.
    ///
    /// # Errors
    /// [`SkyError::NotConverged`]; [`SkyError::Cancelled`].
    pub fn moonlit_view(
        &self,
        altitude_m: f64,
        night: &NightState,
        control: Control<'_>,
    ) -> Result<Option<View>, SkyError> {
        let Some(moon) = night.moon else {
            return Ok(None);
        };
        let up_deg = moon.direction.y.clamp(-1.0, 1.0).asin().to_degrees();
        (up_deg > -MOON_DOWN_DEG)
            .then(|| self.moonlit(altitude_m, &moon, control))
            .transpose()
    }

    fn moonlit(
        &self,
        altitude_m: f64,
        moon: &MoonState,
        control: Control<'_>,
    ) -> Result<View, SkyError> {
        self.sky.view_with(altitude_m, *moon, control)
    }

    /// The diffuse lights of a night for an eye at an altitude, m, without fog.
    ///
    /// # Errors
    /// [`SkyError::NotConverged`] for an altitude far from that of the scene, under the glow of cities; [`SkyError::Cancelled`].
    pub(super) fn glow(
        &self,
        altitude_m: f64,
        night: &NightState,
        channels: Channels,
        control: Control<'_>,
    ) -> Result<GlowView, SkyError> {
        GlowView::new(
            &self.sky,
            self.rings(altitude_m, control)?.as_ref(),
            NightGlow::new(night.frame, self.settings.solar_flux_sfu),
            (self.city.as_deref(), self.settings.sky_quality_mag),
            channels,
        )
    }

    /// Scattering for an eye at an altitude, m; computed once.
    fn rings(
        &self,
        altitude_m: f64,
        control: Control<'_>,
    ) -> Result<Arc<RingScattering>, SkyError> {
        let known = || self.rings.lock().unwrap_or_else(PoisonError::into_inner);
        let find = |rings: &[Arc<RingScattering>]| {
            let same = |rings: &&Arc<RingScattering>| rings.altitude_m() == altitude_m;
            rings.iter().find(same).cloned()
        };
        if let Some(rings) = find(&known()) {
            return Ok(rings);
        }
        // Not computed under the lock: threads that wait for it might be needed.
        let rings = Arc::new(RingScattering::new(&self.sky, altitude_m, control)?);
        known().push(rings.clone());
        Ok(rings)
    }
}
