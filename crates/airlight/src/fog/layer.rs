//! What hangs in the air, at N wavelengths.

use crate::atmosphere::{DensityError, DensityProfile};
use crate::optics::{PhaseError, PhaseFunction};
use crate::spectrum::Spectrum;

/// Droplets, particles or molecules where their density is 1.
#[derive(Clone, Debug, PartialEq)]
pub struct Medium<const N: usize> {
    /// Extinction coefficient, 1/m.
    pub extinction_per_m: Spectrum<N>,
    /// The part of the extinction that is scattering, 0 to 1.
    pub single_scattering_albedo: Spectrum<N>,
    /// Where it scatters to.
    pub phase: PhaseFunction,
}

/// Matter and how it thins with height.
#[derive(Clone, Debug, PartialEq)]
pub struct Layer<const N: usize> {
    /// Density against height.
    pub profile: DensityProfile,
    /// What it is made of.
    pub medium: Medium<N>,
}

/// Why numbers do not make a fog.
#[derive(Clone, Debug, PartialEq, thiserror::Error)]
pub enum FogError {
    /// Extinction below 0 or not finite.
    #[error(
        "the extinction must be finite and not below 0 per metre, got {got_per_m} in lane {lane}"
    )]
    Extinction {
        /// Which wavelength or colour, counted from 0.
        lane: usize,
        /// What was given, 1/m.
        got_per_m: f32,
    },
    /// A single-scattering albedo outside 0 to 1.
    #[error("the single-scattering albedo must lie from 0 to 1, got {got} in lane {lane}")]
    Albedo {
        /// Which wavelength or colour, counted from 0.
        lane: usize,
        /// What was given.
        got: f32,
    },
    /// Light that is negative or not finite.
    #[error("{what} must be finite and not below 0, got {got}")]
    Light {
        /// Which light.
        what: &'static str,
        /// What was given.
        got: f32,
    },
    /// A number of the scene that cannot be.
    #[error("{what} must be {right}, got {got}")]
    Number {
        /// Which number, with its unit.
        what: &'static str,
        /// What was given.
        got: f64,
        /// What would be right.
        right: &'static str,
    },
    /// A form of a lamp's light does not hold for what there is.
    #[error(
        "this form of a lamp's light is for point lamps in one layer of uniform fog that scatters equally in all directions, \
         not for {what}"
    )]
    LightForm {
        /// What there is.
        what: &'static str,
    },
    /// The phase function is refused.
    #[error(transparent)]
    Phase(#[from] PhaseError),
    /// The density profile is refused.
    #[error(transparent)]
    Density(#[from] DensityError),
}

/// Light must be finite and not below 0 in every lane.
///
/// # Errors
/// [`FogError::Light`] for the first lane that is not.
pub(super) fn check_light<const N: usize>(
    what: &'static str,
    light: Spectrum<N>,
) -> Result<(), FogError> {
    match light.0.iter().find(|v| !(v.is_finite() && **v >= 0.0)) {
        None => Ok(()),
        Some(&got) => Err(FogError::Light { what, got }),
    }
}

impl<const N: usize> Medium<N> {
    /// Checks every number.
    ///
    /// # Errors
    /// The first that cannot be.
    pub fn validate(&self) -> Result<(), FogError> {
        for lane in 0..N {
            let extinction = self.extinction_per_m[lane];
            if !(extinction.is_finite() && extinction >= 0.0) {
                return Err(FogError::Extinction {
                    lane,
                    got_per_m: extinction,
                });
            }
            let albedo = self.single_scattering_albedo[lane];
            if !(0.0..=1.0).contains(&albedo) {
                return Err(FogError::Albedo { lane, got: albedo });
            }
        }
        Ok(self.phase.validate()?)
    }

    /// Scattering coefficient, 1/m.
    pub fn scattering_per_m(&self) -> Spectrum<N> {
        self.extinction_per_m * self.single_scattering_albedo
    }

    /// The phase function at a cosine of the scattering angle in every lane, 1/sr.
    #[inline]
    pub fn phase_lanes(&self, cos_angle: f64, wavelengths_nm: &[f64; N]) -> Spectrum<N> {
        match &self.phase {
            PhaseFunction::Tabulated(table) => Spectrum(
                table
                    .evaluate_all(cos_angle, wavelengths_nm)
                    .map(|p| p as f32),
            ),
            phase if phase.depends_on_wavelength() => {
                Spectrum::from_fn(|lane| phase.evaluate(cos_angle, wavelengths_nm[lane]) as f32)
            }
            phase => Spectrum::splat(phase.evaluate(cos_angle, 550.0) as f32),
        }
    }
}

impl<const N: usize> Layer<N> {
    /// Checks every number.
    ///
    /// # Errors
    /// The first that cannot be.
    pub fn validate(&self) -> Result<(), FogError> {
        self.profile.validate()?;
        self.medium.validate()
    }
}
