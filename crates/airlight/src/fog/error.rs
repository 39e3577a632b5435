//! Why numbers do not make a fog.

use super::values::Values;
use crate::atmosphere::DensityError;
use crate::optics::PhaseError;
use glam::DVec3;

/// Why numbers do not make a fog.
#[derive(Clone, Debug, PartialEq, thiserror::Error)]
#[non_exhaustive]
pub enum FogError {
    /// Extinction below 0 or not finite.
    #[error(
        "extinction (1/m): expected finite numbers not below 0, got {got_per_m} in channel {channel}"
    )]
    Extinction {
        /// Which wavelength or colour, counted from 0.
        channel: usize,
        /// Its value, 1/m.
        got_per_m: f64,
    },
    /// A single-scattering albedo outside 0 to 1.
    #[error(
        "single-scattering albedo: expected numbers from 0 to 1, got {got} in channel {channel}"
    )]
    Albedo {
        /// Which wavelength or colour, counted from 0.
        channel: usize,
        /// Its value.
        got: f64,
    },
    /// Light that is negative or not finite.
    #[error("{what}: expected finite numbers not below 0, got {got}")]
    Light {
        /// Which light.
        what: &'static str,
        /// The first such value.
        got: f64,
    },
    /// A number outside its domain.
    #[error("{what}: expected {expected}, got {got}")]
    Number {
        /// Which number, with its unit.
        what: &'static str,
        /// Its value.
        got: f64,
        /// What it must be, and what to try.
        expected: &'static str,
    },
    /// A form of the light of light sources does not hold for these lights or layers.
    #[error(
        "form of light: expected point lights in one layer of uniform fog that scatters equally in all directions, got {got}; \
         try the exact form"
    )]
    LightForm {
        /// What it does not hold for.
        got: &'static str,
    },
    /// The phase function is refused.
    #[error(transparent)]
    Phase(#[from] PhaseError),
    /// The density profile is refused.
    #[error(transparent)]
    Density(#[from] DensityError),
}

/// Light must be finite and not below 0 at all wavelengths.
pub(super) fn check_light(
    what: &'static str,
    light: &(impl Values + ?Sized),
) -> Result<(), FogError> {
    match light.first_invalid() {
        None => Ok(()),
        Some(got) => Err(FogError::Light { what, got }),
    }
}

/// A position must be finite.
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

/// A radius must be above 0.
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
