//! Settings of the model, their validation and errors.

use super::geometry::{HazePath, SunRay};
use crate::atmosphere::REFERENCE_NM;
use crate::atmosphere::presets::Earth;
use crate::atmosphere::{Atmosphere, AtmosphereError, Constituent, ConstituentKind};
use crate::fog::FogError;
use crate::math::rounded::rounded;
use crate::optics::mie::MieError;
use crate::optics::mie::droplets::Drops;
use crate::optics::{PhaseError, PhaseFunction};
use crate::sky::SkyError;
use crate::spectrum::SpectralCurve;

/// Haze and air of the model. `Default` is the corrected model on the Earth with a moderate haze.
#[derive(Clone, Debug, PartialEq)]
pub struct Klassen1987Settings {
    /// The air without haze: its planet's radius is `R_E`, the scattering of its molecules at the ground `beta_m`, its sun lights
    /// the model, and [`BaseBlue::Solver`] solves for it.
    pub clear_air: Atmosphere,
    /// Density of the molecules relative to `clear_air`: factor of `beta_m` (figure 10). Above 0.
    pub air_density: f64,
    /// Thickness of the air at its density at the ground, `R_A - R_E`, m. At least that of the haze.
    pub air_thickness_m: f64,
    /// Extinction of the haze at 550 nm, `beta_p`, m^-1 (figures 8 and 11). At least 0.
    pub haze_extinction_per_m: f64,
    /// Thickness of the haze, `R_H - R_E`, m (figure 9). Above 0.
    pub haze_thickness_m: f64,
    /// Particles of the haze.
    pub haze: Haze,
    /// Phase function of the haze.
    pub phase: HazePhase,
    /// Integration along the view ray.
    pub path: HazePath,
    /// Path of sunlight.
    pub sun_ray: SunRay,
    /// The sky behind the haze.
    pub base_blue: BaseBlue,
    /// Bits per channel of pictures for [`PublishedModel::walk`](crate::models::PublishedModel::walk), 4 to 16: its colours are
    /// accurate to one step of such a picture.
    pub bits_per_channel: u32,
}

/// Particles of the haze: spectral dependence of extinction, albedo and phase function.
#[derive(Clone, Debug, PartialEq)]
#[non_exhaustive]
pub enum Haze {
    /// Wet haze: water drops of a published distribution, by Mie theory.
    Drops(Drops),
    /// Any other haze.
    Given {
        /// Extinction by wavelength, on an arbitrary scale: only its ratio to that at 550 nm matters.
        extinction: SpectralCurve,
        /// Single-scattering albedo by wavelength.
        single_scattering_albedo: SpectralCurve,
        /// Phase function.
        phase: PhaseFunction,
    },
}

/// Phase function of the haze, `beta_sc(psi)` divided by the scattering coefficient.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
#[non_exhaustive]
pub enum HazePhase {
    /// That of its particles: a table by angle and wavelength, as the paper prefers.
    #[default]
    Particles,
    /// Eq. 1, corrected: `(1 - g^2) / (4 pi (1 + g^2 - 2 g cos psi)^(3/2))`, the Henyey-Greenstein function.
    HenyeyGreenstein {
        /// Mean cosine, `-1 < g < 1`.
        g: f64,
    },
    /// Eq. 1 as printed, `(1 - g)^2 / (1 + g^2 - 2 g cos psi)^(3/2)`, which integrates to `4 pi (1 - g) / (1 + g)` over the
    /// sphere instead of 1: 1.4 for `g = 0.8`, 12.6 for `g = 0`.
    Printed {
        /// Parameter, `-1 < g < 1`.
        g: f64,
    },
}

/// The sky behind the haze.
#[derive(Clone, Copy, Debug, PartialEq)]
#[non_exhaustive]
pub enum BaseBlue {
    /// One colour in all directions, as in the paper: sunlight weighted by the fraction of each wavelength that the molecules
    /// scatter on a vertical path. Its luminance is proportional to the sine of the sun's elevation, down to a hundredth at
    /// sunset (the factor is the paper's, the law between is ours).
    Constant {
        /// Luminance for a sun at the zenith and air of density 1, cd/m^2.
        noon_luminance_cd_m2: f64,
    },
    /// The clear air, solved by [`crate::sky`].
    Solver,
}

impl BaseBlue {
    /// The paper's blue with 3000 cd/m^2, about the mean of a clear sky under a high sun.
    pub const PAPER: Self = Self::Constant {
        noon_luminance_cd_m2: 3000.0,
    };
}

/// Error of [`Klassen1987Settings::validate`] and of the model's constructors.
#[derive(Clone, Debug, PartialEq, thiserror::Error)]
#[non_exhaustive]
pub enum Klassen1987Error {
    /// An argument is outside its domain.
    #[error("expected {what} {right}, got {got}")]
    Number {
        /// The argument, with its unit.
        what: &'static str,
        /// The domain.
        right: &'static str,
        /// Value of the argument.
        got: f64,
    },
    /// The haze is thicker than the air.
    #[error(
        "expected haze below the effective top of the air at {air_m} m, got a thickness of {haze_m} m"
    )]
    HazeAboveAir {
        /// Thickness of the haze, m.
        haze_m: f64,
        /// Effective thickness of the air, m.
        air_m: f64,
    },
    /// The sun is below the horizon.
    #[error(
        "expected a sun at the horizon or above, got an elevation of {} degrees; the model of 1987 has no twilight",
        rounded(*.0)
    )]
    SunBelowHorizon(f64),
    /// The clear air has no scattering.
    #[error("expected clear air with a constituent that scatters light at 550 nm, got none")]
    NoMolecules,
    /// The clear air is invalid.
    #[error(transparent)]
    Atmosphere(#[from] AtmosphereError),
    /// The haze's drops are invalid.
    #[error(transparent)]
    Mie(#[from] MieError),
    /// The haze's phase function is invalid.
    #[error(transparent)]
    Phase(#[from] PhaseError),
    /// The clear air cannot be solved.
    #[error(transparent)]
    Sky(#[from] SkyError),
    /// The fog's drops are invalid.
    #[error(transparent)]
    Fog(#[from] FogError),
}

impl Default for Klassen1987Settings {
    /// The corrected model on the Earth: 8.4 km of air, 2 km of wet haze L with an extinction of 5e-5 per m (optical depth 0.1,
    /// visibility about 50 km), with the blue from the solver.
    fn default() -> Self {
        let mut clear_air = Earth::with_aerosol(0.0)
            .atmosphere("clear air")
            .expect("the numbers of this file are in their domains");
        clear_air
            .constituents
            .retain(|part| part.kind != ConstituentKind::Aerosol);
        Self {
            clear_air,
            air_density: 1.0,
            air_thickness_m: 8.4e3,
            haze_extinction_per_m: 5e-5,
            haze_thickness_m: 2e3,
            haze: Haze::Drops(Drops::HazeL),
            phase: HazePhase::Particles,
            path: HazePath::Exact,
            sun_ray: SunRay::Exact,
            base_blue: BaseBlue::Solver,
            bits_per_channel: 8,
        }
    }
}

impl Klassen1987Settings {
    /// These settings with the geometry and the blue as printed (signs corrected): eqs. 20 to 31.
    pub fn printed(self) -> Self {
        Self {
            path: HazePath::LinearInRadius,
            sun_ray: SunRay::Printed,
            base_blue: BaseBlue::PAPER,
            ..self
        }
    }

    /// Checks the settings.
    ///
    /// # Errors
    /// [`Klassen1987Error`] for the first setting outside its domain.
    pub fn validate(&self) -> Result<(), Klassen1987Error> {
        let check = |what, got: f64, least: f64, most: f64, right| match got >= least && got <= most
        {
            true => Ok(()),
            false => Err(Klassen1987Error::Number { what, right, got }),
        };
        check(
            "the air's density (factor)",
            self.air_density,
            1e-6,
            1e3,
            "from 1e-6 to 1000",
        )?;
        check(
            "the air's effective thickness (m)",
            self.air_thickness_m,
            1.0,
            1e6,
            "from 1 to 1e6",
        )?;
        check(
            "the haze's extinction at 550 nm (per m)",
            self.haze_extinction_per_m,
            0.0,
            1.0,
            "from 0 to 1",
        )?;
        check(
            "the haze's thickness (m)",
            self.haze_thickness_m,
            1.0,
            1e6,
            "from 1 to 1e6",
        )?;
        if self.haze_thickness_m > self.air_thickness_m {
            return Err(Klassen1987Error::HazeAboveAir {
                haze_m: self.haze_thickness_m,
                air_m: self.air_thickness_m,
            });
        }
        check(
            "the bits of a channel",
            f64::from(self.bits_per_channel),
            4.0,
            16.0,
            "from 4 to 16",
        )?;
        match self.phase {
            HazePhase::HenyeyGreenstein { g } | HazePhase::Printed { g } => {
                PhaseFunction::HenyeyGreenstein { g }.validate()?;
            }
            HazePhase::Particles => {}
        }
        if let BaseBlue::Constant {
            noon_luminance_cd_m2,
        } = self.base_blue
        {
            check(
                "the noon luminance of the blue (cd/m^2)",
                noon_luminance_cd_m2,
                0.0,
                1e9,
                "from 0 to 1e9",
            )?;
        }
        if let Haze::Given {
            extinction, phase, ..
        } = &self.haze
        {
            phase.validate()?;
            let at = extinction.at(REFERENCE_NM);
            check(
                "the haze's extinction curve at 550 nm",
                at,
                1e-300,
                1e300,
                "above 0",
            )?;
        }
        self.clear_air.validate()?;
        match self.clear_air.constituents.iter().any(scatters) {
            true => Ok(()),
            false => Err(Klassen1987Error::NoMolecules),
        }
    }

    /// Scattering of the molecules at the ground, `beta_m`, m^-1.
    pub(super) fn air_extinction_per_m(&self, wavelength_nm: f64) -> f64 {
        let ground_m = self.clear_air.planet.ground_altitude_m;
        self.air_density * self.clear_air.scattering_per_m(ground_m, wavelength_nm)
    }

    /// The clear air with the density of the settings.
    pub(super) fn dense_clear_air(&self) -> Atmosphere {
        let mut air = self.clear_air.clone();
        for part in air.constituents.iter_mut().filter(|part| scatters(part)) {
            for curve in [&mut part.scattering_per_m, &mut part.absorption_per_m] {
                *curve = curve.clone().scaled(self.air_density);
            }
        }
        air
    }
}

pub(super) fn scatters(part: &Constituent) -> bool {
    part.scattering_per_m.at(REFERENCE_NM) > 0.0
}
