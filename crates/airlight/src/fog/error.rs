//! [`FogError`] and the checks of fog inputs.

use super::values::Values;
use crate::atmosphere::DensityError;
use crate::control::Cancelled;
use crate::optics::PhaseError;
use glam::DVec3;

/// Why a fog or its lights are invalid.
#[derive(Clone, Debug, PartialEq, thiserror::Error)]
#[non_exhaustive]
pub enum FogError {
    /// An extinction that is negative or not finite.
    #[error(
        "extinction (1/m): expected finite numbers not below 0, got {got_per_m} in channel {channel}"
    )]
    Extinction {
        /// Index of the wavelength or colour channel.
        channel: usize,
        /// Its value, 1/m.
        got_per_m: f64,
    },
    /// A single-scattering albedo outside 0 to 1.
    #[error(
        "single-scattering albedo: expected numbers from 0 to 1, got {got} in channel {channel}"
    )]
    Albedo {
        /// Index of the wavelength or colour channel.
        channel: usize,
        /// Its value.
        got: f64,
    },
    /// A radiance, irradiance or intensity that is negative or not finite.
    #[error("{what}: expected finite numbers not below 0, got {got}")]
    Light {
        /// The quantity.
        what: &'static str,
        /// The first invalid value.
        got: f64,
    },
    /// A number out of range.
    #[error("{what}: expected {expected}, got {got}")]
    Number {
        /// The quantity, with its unit.
        what: &'static str,
        /// Its value.
        got: f64,
        /// The range allowed, and what to try.
        expected: &'static str,
    },
    /// Lights or layers for which a [`LightForm`](super::lights::LightForm) is not valid.
    #[error(
        "light form: expected point lights in one layer of uniform, isotropically scattering fog, got {got}; \
         try the exact form"
    )]
    LightForm {
        /// The light or layer for which it is not valid.
        got: &'static str,
    },
    /// An invalid phase function.
    #[error(transparent)]
    Phase(#[from] PhaseError),
    /// An invalid density profile.
    #[error(transparent)]
    Density(#[from] DensityError),
    /// The caller cancelled the computation.
    #[error(transparent)]
    Cancelled(#[from] Cancelled),
}

/// Checks that all values are finite and not negative.
pub(super) fn check_light(
    what: &'static str,
    light: &(impl Values + ?Sized),
) -> Result<(), FogError> {
    match light.first_invalid() {
        None => Ok(()),
        Some(got) => Err(FogError::Light { what, got }),
    }
}

/// Checks that a position is finite.
pub(super) fn check_position(position: DVec3) -> Result<(), FogError> {
    match position.to_array().into_iter().find(|c| !c.is_finite()) {
        None => Ok(()),
        Some(got) => Err(FogError::Number {
            what: "position of a light (m)",
            got,
            expected: "finite coordinates",
        }),
    }
}

/// Checks that a radius is positive and finite.
pub(super) fn check_radius(radius_m: f64) -> Result<(), FogError> {
    match radius_m > 0.0 && radius_m.is_finite() {
        true => Ok(()),
        false => Err(FogError::Number {
            what: "radius of a light (m)",
            got: radius_m,
            expected: "a finite number above 0",
        }),
    }
}
