//! The sky of the article "Sky and Atmosphere rendering: A physical approach": sunlight scattered once.
//!
//! Three constants a coefficient, called red, green and blue, and taken for luminances of linear sRGB: colours are those
//! channels in cd/m^2, sent through [`RgbSpace::Srgb`].
//!
//! [`Variant`] has the shader as printed and the steps by which the article says one may go on. All keep its coefficients,
//! also where they are wrong: ozone has the molecules' profile, and a column 41 % too large.
//!
//! # Errata
//! - 8 steps of even length are far from enough. Sun at 45 degrees, view at 45 degrees towards its azimuth: 3652, 4655,
//!   7169 cd/m^2 as printed, 10878, 11659, 13903 converged.
//! - The planet stops neither view nor sun: the printed rays run on through it, in air that grows denser by e every
//!   1.2 km, down to numbers that overflow. Here such directions are black.
//! - The zenith transmittance that makes the sun white takes haze without the factor 1.11 of its extinction: 0.3 % of
//!   illuminance. Kept in all variants, so that they differ in their integrals alone.
//! - No light comes from the ground.

mod constants;
mod converged;
mod nodes;
mod printed;
mod sunlight;
#[cfg(test)]
mod tests;
mod vec3;

use crate::models::PublishedModel;
use crate::spectrum::RgbSpace;
use crate::spectrum::rgb::{Matrix3, apply};
pub use constants::{EYE_ALTITUDE_M, UNIT_ILLUMINANCE, ZENITH_ILLUMINANCE_LX};
use converged::Converged;
use glam::DVec3;
use printed::Printed;
pub use sunlight::Sunlight;

/// How the integrals are done.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Default)]
pub enum Variant {
    /// The shader in f32, operation by operation.
    Printed,
    /// The shader in f64.
    PrintedF64,
    /// 12 well-placed nodes on the line of sight and 10 on each way to the sun, planet and shadow in their place. Against 64
    /// and 48 nodes: below 1e-4 for suns from 2 degrees up, 0.2 % with the sun on the horizon, 0.1 % down to -4 degrees.
    #[default]
    Converged,
    /// The same with the ways to the sun from a table of 256 zenith angles and 64 heights (the article's second step). Against
    /// `Converged`: below 0.03 % with the sun at 60 degrees, 0.12 % at 10, 0.6 % at 2.
    Table,
    /// The same with light scattered more than once, from the table of Hillaire 2020 (the article's third step). Against our
    /// solver the worst channel of the sky is off by 9 % with the sun at 60 degrees, 17 % at 10, 25 % at 2; without it by
    /// 46, 62 and 95 %.
    Multiple,
}

/// What the sky is made for.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Settings {
    /// How the integrals are done.
    pub variant: Variant,
    /// The sun's light.
    pub sunlight: Sunlight,
    /// Height of the eye, m: from 0 to below 60 km.
    pub eye_altitude_m: f64,
}

impl Default for Settings {
    /// Converged, white at the zenith with 120 000 lx, from 1 m.
    fn default() -> Self {
        Self {
            variant: Variant::default(),
            sunlight: Sunlight::WhiteAtZenith(ZENITH_ILLUMINANCE_LX),
            eye_altitude_m: EYE_ALTITUDE_M,
        }
    }
}

/// Why settings are refused.
#[derive(Clone, Copy, Debug, PartialEq, thiserror::Error)]
pub enum SettingsError {
    /// The eye is not in the air.
    #[error("the eye must be from 0 to below 60 000 m high, got {0} m")]
    EyeAltitude(f64),
    /// The illuminance is no light.
    #[error("the illuminance by the zenith sun must be positive and finite, got {0} lx")]
    Illuminance(f64),
    /// The sun has no direction.
    #[error("the sun's direction must be finite and not zero, got {0}")]
    Sun(DVec3),
}

/// The article's sky for one eye and one sun.
pub struct SkyArticle {
    sun: DVec3,
    model: Model,
    to_xyz: Matrix3,
}

enum Model {
    Printed(Printed<f32>),
    PrintedF64(Printed<f64>),
    Converged(Box<Converged>),
}

impl SkyArticle {
    /// Prepares a sky with the sun in a direction.
    ///
    /// # Errors
    /// [`SettingsError`] for numbers out of their domain.
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
        let sun = sun_direction
            .try_normalize()
            .ok_or(SettingsError::Sun(sun_direction))?;
        let model = match settings.variant {
            Variant::Printed => Model::Printed(Printed::new(eye, settings.sunlight)),
            Variant::PrintedF64 => Model::PrintedF64(Printed::new(eye, settings.sunlight)),
            variant => Model::Converged(Box::new(Converged::new(variant, settings))),
        };
        Ok(Self {
            sun,
            model,
            to_xyz: RgbSpace::Srgb.to_xyz_matrix(),
        })
    }

    /// Luminances of the red, green and blue channel of the sky in the direction of a unit vector, cd/m^2, without the
    /// sun's disc. The printed variants give what the shader gives: not a number for rays deep into the planet.
    pub fn luminance(&self, direction: DVec3) -> [f64; 3] {
        match &self.model {
            Model::Printed(shader) => shader.luminance(direction.into(), self.sun.into()),
            Model::PrintedF64(shader) => shader.luminance(direction.into(), self.sun.into()),
            Model::Converged(model) => model.luminance(direction, self.sun),
        }
    }

    /// The same of the sun's disc, whose edge is smooth from 0.95 to 1.05 of its radius.
    pub fn disc_luminance(&self, direction: DVec3) -> [f64; 3] {
        match &self.model {
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

impl PublishedModel for SkyArticle {
    fn sun(&self) -> DVec3 {
        self.sun
    }

    /// Where the smooth edge ends.
    fn disc_edge_rad(&self) -> f64 {
        (0.5 * constants::SUN_WIDTH_DEG).to_radians() * constants::SUN_EDGE[1]
    }

    /// Black where the printed shader gives no number.
    fn sky_xyz(&self, direction: DVec3) -> [f64; 3] {
        self.xyz(self.luminance(direction))
    }

    fn disc_xyz(&self, direction: DVec3) -> [f64; 3] {
        self.xyz(self.disc_luminance(direction))
    }
}
