//! Klassen 1987 as a [`RadianceModel`]: sun and sky, and the naturally lit scene with fog or objects.

use super::Base;
use super::fog::SunDepth;
use super::scene::{Fog1987, Klassen1987Scene};
use super::{BaseBlue, Haze, Klassen1987, Klassen1987Error, Klassen1987Settings};
use crate::control::Control;
use crate::models::PublishedModel;
use crate::models::prepared::Prepared;
use crate::optics::mie::MieError;
use crate::optics::mie::droplets::Drops;
use crate::scene::{
    BaseBlueKind, Capabilities, FogLayers, Input, Klassen1987Spec, PreparedModel, RadianceModel,
    ResolvedScene, SceneError, SunState, WetHaze,
};
use crate::sky::{SkyError, SunCoverage};
use std::sync::{Arc, Mutex, PoisonError};

/// Bits per channel to which colours are accurate when they are reused: files may hold more than 8, and are exposed later.
const BITS: u32 = 12;

/// Klassen 1987 as a [`RadianceModel`], with haze and air derived from a scene.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(crate) struct Klassen1987Model;

impl RadianceModel for Klassen1987Model {
    fn name(&self) -> &'static str {
        "klassen1987"
    }

    fn summary(&self) -> &'static str {
        "Klassen 1987: layers of haze and air, with single scattering by the haze in front of a blue sky"
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
                Input::Objects,
                Input::Variant,
                Input::Klassen1987,
                Input::Spectra,
            ],
            variants: &["corrected", "printed"],
            twilight: false,
            parts: false,
        }
    }

    fn prepare(
        &self,
        scene: &ResolvedScene,
        suns: SunCoverage,
        control: Control<'_>,
    ) -> Result<Arc<dyn PreparedModel>, SceneError> {
        let fog = scene.fog.as_ref().map(slab).transpose()?;
        let whole = fog.is_some() || scene.has_objects;
        if !whole && scene.set_inputs.contains(&Input::ObserverHeight) {
            return Err(SceneError::value(
                "observer",
                "an eye on the ground for a scene without fog and objects",
                format!("{} m", scene.observer_altitude_m),
                "leaving altitude_m and eye_height_m out, or adding fog or objects",
            ));
        }
        let printed = scene.solver.variant.as_deref() == Some("printed");
        let settings = settings(scene, printed);
        settings.validate().map_err(refused)?;
        let prepared = PreparedAir {
            base: Base::prepare(&settings, suns, control).map_err(refused)?,
            settings,
            fog,
            depth: match printed {
                true => SunDepth::Printed,
                false => SunDepth::Exact,
            },
            ground_altitude_m: scene.atmosphere.planet.ground_altitude_m,
            last: Mutex::new(None),
        };
        let grid = super::wavelength_grid().with_solar(&scene.atmosphere.solar_irradiance);
        let make = move |altitude_m: f64, sun: &SunState, control: Control<'_>| {
            prepared.model(altitude_m, sun, whole, control)
        };
        let prepared = Prepared::new(self.name(), scene, Some(grid), make);
        Ok(Arc::new(prepared.with_spectral_objects()))
    }
}

/// Parts shared by all suns, and the last sun.
struct PreparedAir {
    settings: Klassen1987Settings,
    base: Base,
    fog: Option<Fog1987>,
    depth: SunDepth,
    ground_altitude_m: f64,
    last: Mutex<Option<(SunState, Lit)>>,
}

/// The model for one sun.
#[derive(Clone)]
enum Lit {
    /// Sun and sky.
    Sky(Arc<Klassen1987>),
    /// Fog and ground, seen from any height.
    Scene(Box<Klassen1987Scene>),
}

impl PreparedAir {
    /// Sun and sky; if `whole` is set, also fog and ground, seen from an altitude.
    fn model(
        &self,
        altitude_m: f64,
        sun: &SunState,
        whole: bool,
        control: Control<'_>,
    ) -> Result<Arc<dyn PublishedModel>, SceneError> {
        let last = || self.last.lock().unwrap_or_else(PoisonError::into_inner);
        let height_m = altitude_m - self.ground_altitude_m;
        let known = last().clone().filter(|(known, _)| known == sun);
        let lit = match known {
            Some((_, lit)) => lit,
            None => {
                let sky = Klassen1987::over(&self.settings, &self.base, sun, control);
                let sky = Arc::new(sky.map_err(refused)?);
                let lit = match whole {
                    false => Lit::Sky(sky),
                    true => {
                        let fog = self.fog.clone();
                        let scene = Klassen1987Scene::new(sky, height_m, fog, self.depth);
                        Lit::Scene(Box::new(scene.map_err(refused)?))
                    }
                };
                *last() = Some((*sun, lit.clone()));
                lit
            }
        };
        Ok(match lit {
            Lit::Sky(sky) => sky,
            Lit::Scene(scene) => Arc::new(scene.at_height_m(height_m)),
        })
    }
}

/// Layers of the model for a scene's air, with the scene's overrides.
fn settings(scene: &ResolvedScene, printed: bool) -> Klassen1987Settings {
    let mut settings = Klassen1987Settings {
        bits_per_channel: BITS,
        ..Klassen1987Settings::of(&scene.atmosphere)
    };
    if printed {
        settings = settings.printed();
    }
    let Klassen1987Spec {
        haze_extinction_per_m,
        haze_thickness_m,
        wet_haze,
        air_density,
        air_thickness_m,
        base_blue,
    } = scene.solver.klassen1987;
    let put = |value: &mut f64, set: Option<f64>| *value = set.unwrap_or(*value);
    put(&mut settings.haze_extinction_per_m, haze_extinction_per_m);
    put(&mut settings.haze_thickness_m, haze_thickness_m);
    put(&mut settings.air_density, air_density);
    put(&mut settings.air_thickness_m, air_thickness_m);
    if let Some(kind) = wet_haze {
        settings.haze = Haze::Drops(match kind {
            WetHaze::HazeM => Drops::HazeM,
            WetHaze::HazeL => Drops::HazeL,
            WetHaze::HazeH => Drops::HazeH,
        });
    }
    match base_blue {
        Some(BaseBlueKind::Paper) => settings.base_blue = BaseBlue::PAPER,
        Some(BaseBlueKind::Solver) => settings.base_blue = BaseBlue::Solver,
        None => {}
    }
    settings
}

/// The fog of a scene, which must be one slab.
fn slab(fog: &FogLayers) -> Result<Fog1987, SceneError> {
    let (layer, top_m) = match &fog.layers[..] {
        [layer] => (layer, layer.profile.slab_top_m()),
        _ => {
            return Err(SceneError::value(
                "fog.layers",
                "one layer of fog for klassen1987",
                format!("{}", fog.layers.len()),
                "leaving the others out, or another solver",
            ));
        }
    };
    let Some(top_m) = top_m else {
        return Err(SceneError::value(
            "fog.top_m",
            "a slab of constant density for klassen1987",
            "fog whose density depends on height",
            "top_m = 25",
        ));
    };
    Ok(Fog1987 {
        top_m,
        droplets: layer.constituent(&Klassen1987::wavelengths())?,
    })
}

/// Converts an error of the model.
fn refused(error: Klassen1987Error) -> SceneError {
    match error {
        Klassen1987Error::Sky(SkyError::Cancelled(cancelled))
        | Klassen1987Error::Mie(MieError::Cancelled(cancelled)) => cancelled.into(),
        error => SceneError::model("klassen1987", error),
    }
}
