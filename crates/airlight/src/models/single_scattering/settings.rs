//! Settings of the article's sky.

use super::constants::{EYE_ALTITUDE_M, ZENITH_ILLUMINANCE_LX};
use super::sunlight::Sunlight;
use glam::DVec3;

/// Evaluation of the integrals.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Default)]
#[non_exhaustive]
pub enum Variant {
    /// The shader in f32, operation by operation.
    Printed,
    /// The shader in f64.
    PrintedF64,
    /// 12 well-placed nodes on the view ray and 10 on each ray to the sun, with the planet and its shadow. Differs from 64 and
    /// 48 nodes by less than 1e-4 for suns from 2 degrees up, 0.2 % with the sun on the horizon, 0.1 % down to -4 degrees.
    #[default]
    Converged,
    /// As `Converged`, with transmittances to the sun from a table of 256 zenith angles and 64 altitudes (the article's second
    /// step). Differs from `Converged` by less than 0.03 % with the sun at 60 degrees, 0.12 % at 10, 0.6 % at 2.
    Table,
    /// As `Table`, with multiple scattering from the table of Hillaire 2020 (the article's third step). Differs from our solver
    /// in the worst channel of the sky by 9 % with the sun at 60 degrees, 17 % at 10, 25 % at 2; without it by 46, 62 and 95 %.
    Multiple,
}

/// Settings of [`SkyArticle`](super::SkyArticle).
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Settings {
    /// Evaluation of the integrals.
    pub variant: Variant,
    /// Sunlight outside the atmosphere.
    pub sunlight: Sunlight,
    /// Altitude of the eye, m: from 0 to below 60 km.
    pub eye_altitude_m: f64,
}

impl Default for Settings {
    /// Converged, white at the zenith with 120 000 lx, seen from 1 m.
    fn default() -> Self {
        Self {
            variant: Variant::default(),
            sunlight: Sunlight::WhiteAtZenith(ZENITH_ILLUMINANCE_LX),
            eye_altitude_m: EYE_ALTITUDE_M,
        }
    }
}

/// Error of [`SkyArticle::new`](super::SkyArticle::new).
#[derive(Clone, Copy, Debug, PartialEq, thiserror::Error)]
#[non_exhaustive]
pub enum SettingsError {
    /// The eye is not inside the atmosphere.
    #[error("expected an eye altitude from 0 to below 60 000 m, got {0} m")]
    EyeAltitude(f64),
    /// The illuminance is not positive and finite.
    #[error("expected a positive, finite illuminance from the zenith sun, got {0} lx")]
    Illuminance(f64),
    /// The sun's direction is zero or not finite.
    #[error("expected a finite sun direction that is not zero, got {0}")]
    Sun(DVec3),
}
