//! [`NightLight`]: the light of a night over one place, for fog lit by it.

use super::glow_view::GlowView;
use super::{Channels, NightSky, ResolvedScene, SceneError, SunAngles};
use crate::control::Control;
use crate::debug::debug_fields;
use crate::sky::{SunCoverage, View};
use crate::spectrum::RgbSpace;
use std::sync::Arc;

/// Moonlight, airglow, zodiacal light, starlight and the glow of cities over one place at one time, for
/// [`RgbFoggySky::at_night`](super::RgbFoggySky::at_night): the same light as in the night sky of
/// [`PreparedModel::night_view`](super::PreparedModel::night_view). Cloning is cheap.
#[derive(Clone)]
pub struct NightLight {
    pub(super) space: RgbSpace,
    /// The sky under the moon, if its light matters.
    pub(super) moonlit: Option<View>,
    pub(super) glow: Arc<GlowView>,
}

debug_fields! { NightLight { space, moonlit } }

impl NightLight {
    /// The lights of a scene's night for the eye of a view of its sky, in linear red, green and blue; `None` by day and without
    /// lights of the night. Solves the air once more, for sources above the horizon.
    ///
    /// # Errors
    /// [`SceneError::Sky`] if the solver fails.
    pub fn new(
        scene: &ResolvedScene,
        view: &View,
        sun: &SunAngles,
        space: RgbSpace,
    ) -> Result<Option<Self>, SceneError> {
        Self::new_with(scene, view, sun, space, Control::default())
    }

    /// As [`Self::new`], with cancellation.
    ///
    /// # Errors
    /// As [`Self::new`], and if the caller cancelled.
    pub fn new_with(
        scene: &ResolvedScene,
        view: &View,
        sun: &SunAngles,
        space: RgbSpace,
        control: Control<'_>,
    ) -> Result<Option<Self>, SceneError> {
        let (Some(settings), Some(night)) = (scene.night, scene.night(sun)) else {
            return Ok(None);
        };
        let altitude_m = view.radius_m() - view.sky().atmosphere().planet.radius_m;
        let suns = SunCoverage::near(sun.elevation_deg, altitude_m);
        let sky = NightSky::new(scene, settings, (view.sky(), suns), control)?;
        Ok(Some(Self {
            space,
            moonlit: sky.moonlit_view(altitude_m, &night, control)?,
            glow: Arc::new(sky.glow(altitude_m, &night, Channels::Rgb(space), control)?),
        }))
    }
}
