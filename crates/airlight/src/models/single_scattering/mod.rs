//! Sky of the article "Sky and Atmosphere rendering: A physical approach": single scattering.
//!
//! Each coefficient has three constants, named red, green and blue and interpreted as luminances of linear sRGB: the
//! channels are in cd/m^2 and converted through [`RgbSpace::Srgb`].
//!
//! [`Variant`] selects the shader as printed or one of the improvements that the article suggests. All variants keep its
//! coefficients, including wrong ones: ozone has the profile of molecules, and a column 41 % too large.
//!
//! # Errata
//! - 8 equal steps are far too few. Sun at 45 degrees, view at 45 degrees towards its azimuth: 3652, 4655, 7169 cd/m^2 as
//!   printed, 10878, 11659, 13903 converged.
//! - The planet blocks neither view rays nor sunlight: the printed rays continue through it, in air whose density grows by e
//!   every 1.2 km, until numbers overflow. Here such directions are black.
//! - The zenith transmittance that makes the sun white omits the factor 1.11 of the extinction by haze: 0.3 % of the
//!   illuminance. Kept in all variants, so that they differ only in their integrals.
//! - The ground emits no light.

mod constants;
mod converged;
mod nodes;
mod printed;
mod settings;
mod sunlight;
#[cfg(test)]
mod tests;
mod vec3;

use crate::control::Control;
use crate::debug::debug_fields;
use crate::models::PublishedModel;
use crate::models::prepared::Prepared;
use crate::scene::{
    Capabilities, Input, PreparedModel, RadianceModel, ResolvedScene, SceneError, SunlightKind,
};
use crate::sky::SunCoverage;
use crate::spectrum::RgbSpace;
use crate::spectrum::rgb::{Matrix3, apply};
use crate::sun::{LimbDarkening, SunDisc};
pub use constants::UNIT_ILLUMINANCE;
use constants::ZENITH_ILLUMINANCE_LX;
use converged::Converged;
use glam::DVec3;
use printed::Printed;
pub use settings::{Settings, SettingsError, Variant};
use std::sync::Arc;
pub use sunlight::Sunlight;

/// The article's sky for one eye and one sun.
pub struct SkyArticle {
    sun: DVec3,
    disc: SunDisc,
    model: Arc<Model>,
    to_xyz: Matrix3,
}

debug_fields! { SkyArticle { sun } }

enum Model {
    Printed(Printed<f32>),
    PrintedF64(Printed<f64>),
    Converged(Box<Converged>),
}

impl SkyArticle {
    /// Sky for a sun direction.
    ///
    /// # Errors
    /// [`SettingsError`] if an argument is outside its domain.
    pub fn new(settings: &Settings, sun_direction: DVec3) -> Result<Self, SettingsError> {
        let eye = settings.eye_altitude_m;
        if !(0.0..constants::TOP_RADIUS_M - constants::PLANET_RADIUS_M).contains(&eye) {
            return Err(SettingsError::EyeAltitude(eye));
        }
        if let Sunlight::WhiteAtZenith(lx) = settings.sunlight
            && !(lx.is_finite() && lx > 0.0)
        {
            return Err(SettingsError::Illuminance(lx));
        }
        let model = match settings.variant {
            Variant::Printed => Model::Printed(Printed::new(eye, settings.sunlight)),
            Variant::PrintedF64 => Model::PrintedF64(Printed::new(eye, settings.sunlight)),
            variant => Model::Converged(Box::new(Converged::new(variant, settings))),
        };
        let sky = Self {
            sun: DVec3::Y,
            // Where the smooth edge ends.
            disc: SunDisc {
                angular_radius_rad: (0.5 * constants::SUN_WIDTH_DEG).to_radians()
                    * constants::SUN_EDGE[1],
                limb_darkening: LimbDarkening::Uniform,
            },
            model: Arc::new(model),
            to_xyz: RgbSpace::Srgb.to_xyz_matrix(),
        };
        sky.under(sun_direction)
    }

    /// The same air and eye with another sun direction.
    ///
    /// # Errors
    /// [`SettingsError::Sun`].
    pub fn under(&self, sun_direction: DVec3) -> Result<Self, SettingsError> {
        let sun = sun_direction
            .try_normalize()
            .ok_or(SettingsError::Sun(sun_direction))?;
        Ok(Self {
            sun,
            disc: self.disc.clone(),
            model: self.model.clone(),
            to_xyz: self.to_xyz,
        })
    }

    /// Luminances of the red, green and blue channel of the sky along a unit vector, cd/m^2, without the sun's disc. The printed
    /// variants return what the shader returns: NaN for rays deep into the planet.
    pub fn luminance(&self, direction: DVec3) -> [f64; 3] {
        match self.model.as_ref() {
            Model::Printed(shader) => shader.luminance(direction.into(), self.sun.into()),
            Model::PrintedF64(shader) => shader.luminance(direction.into(), self.sun.into()),
            Model::Converged(model) => model.luminance(direction, self.sun),
        }
    }

    /// Luminances of the sun's disc, cd/m^2, whose edge is smooth from 0.95 to 1.05 of its radius.
    pub(crate) fn disc_luminance(&self, direction: DVec3) -> [f64; 3] {
        match self.model.as_ref() {
            Model::Printed(shader) => shader.disc(direction.into(), self.sun.into()),
            Model::PrintedF64(shader) => shader.disc(direction.into(), self.sun.into()),
            Model::Converged(model) => model.disc(direction, self.sun),
        }
    }

    fn xyz(&self, rgb: [f64; 3]) -> [f64; 3] {
        match rgb.iter().all(|v| v.is_finite()) {
            true => apply(&self.to_xyz, rgb),
            false => [0.0; 3],
        }
    }
}

/// The article's sky as a [`RadianceModel`], with the article's air instead of the scene's.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(crate) struct SingleScatteringModel;

/// Names of the variants, the default first.
const VARIANTS: [(&str, Variant); 5] = [
    ("corrected", Variant::Converged),
    ("printed", Variant::Printed),
    ("printed-f64", Variant::PrintedF64),
    ("table", Variant::Table),
    ("multiple", Variant::Multiple),
];

impl RadianceModel for SingleScatteringModel {
    fn name(&self) -> &'static str {
        "single-scattering"
    }

    fn summary(&self) -> &'static str {
        "the sky article: single scattering in its own air; variants are the article's improvements"
    }

    fn capabilities(&self) -> Capabilities {
        const NAMES: [&str; 5] = [
            VARIANTS[0].0,
            VARIANTS[1].0,
            VARIANTS[2].0,
            VARIANTS[3].0,
            VARIANTS[4].0,
        ];
        Capabilities {
            inputs: &[
                Input::GroundAlbedo,
                Input::ObserverHeight,
                Input::Objects,
                Input::Variant,
                Input::Sunlight,
            ],
            variants: &NAMES,
            twilight: true,
            parts: false,
        }
    }

    fn prepare(
        &self,
        scene: &ResolvedScene,
        _suns: SunCoverage,
        _control: Control<'_>,
    ) -> Result<Arc<dyn PreparedModel>, SceneError> {
        let name = self.name();
        let refused = move |error| SceneError::model(name, error);
        let solver = &scene.solver;
        let variant = VARIANTS
            .iter()
            .find(|(name, _)| solver.variant.as_deref() == Some(name));
        let settings = Settings {
            variant: variant.map_or(Variant::Converged, |(_, variant)| *variant),
            sunlight: match solver.sunlight.unwrap_or_default() {
                SunlightKind::Measured => Sunlight::SolarSpectrum,
                SunlightKind::White => {
                    Sunlight::WhiteAtZenith(solver.zenith_lux.unwrap_or(ZENITH_ILLUMINANCE_LX))
                }
            },
            eye_altitude_m: scene.observer_altitude_m,
        };
        // Tables are shared by all suns.
        let at_eye = SkyArticle::new(&settings, DVec3::Y).map_err(refused)?;
        let prepared = Prepared::new(name, scene, None, move |eye_altitude_m, sun, _| {
            let sky = match eye_altitude_m == settings.eye_altitude_m {
                true => at_eye.under(sun.direction),
                false => SkyArticle::new(
                    &Settings {
                        eye_altitude_m,
                        ..settings
                    },
                    sun.direction,
                ),
            };
            Ok(Arc::new(sky.map_err(refused)?))
        });
        Ok(Arc::new(prepared))
    }
}

impl PublishedModel for SkyArticle {
    fn sun(&self) -> DVec3 {
        self.sun
    }

    fn disc(&self) -> &SunDisc {
        &self.disc
    }

    /// Black where the printed shader returns NaN.
    fn sky_xyz(&self, direction: DVec3) -> [f64; 3] {
        self.xyz(self.luminance(direction))
    }

    fn disc_xyz(&self, direction: DVec3) -> [f64; 3] {
        self.xyz(self.disc_luminance(direction))
    }
}
