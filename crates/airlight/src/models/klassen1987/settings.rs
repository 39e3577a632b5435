//! What the model is told, and what it refuses.

use super::geometry::{HazePath, SunRay};
use crate::atmosphere::aerosol::REFERENCE_NM;
use crate::atmosphere::presets::earth::Earth;
use crate::atmosphere::{Atmosphere, AtmosphereError, Constituent, ConstituentKind};
use crate::fog::FogError;
use crate::optics::mie::MieError;
use crate::optics::mie::droplets::Drops;
use crate::optics::{PhaseError, PhaseFunction};
use crate::sky::SkyError;
use crate::spectrum::SpectralCurve;

/// Haze and air of the model of 1987. `Default` is the corrected model on the Earth with a moderate haze.
#[derive(Clone, Debug, PartialEq)]
pub struct Klassen1987Settings {
    /// The air without haze: its planet's radius is `R_E`, its molecules' scattering at the ground `beta_m`, its sun
    /// lights the model, and [`BaseBlue::Solver`] is solved for it.
    pub clear_air: Atmosphere,
    /// Density of the molecules over that of `clear_air`: factor of `beta_m` (figure 10). Above 0.
    pub air_density: f64,
    /// Height that the air would have if it were as dense everywhere as at the ground, `R_A - R_E`, m. Not below the haze's.
    pub air_thickness_m: f64,
    /// Extinction of the haze at 550 nm, `beta_p`, m^-1 (figures 8 and 11). Not below 0.
    pub haze_extinction_per_m: f64,
    /// Height of the haze, `R_H - R_E`, m (figure 9). Above 0.
    pub haze_thickness_m: f64,
    /// What the haze is made of.
    pub haze: Haze,
    /// Where the haze scatters to.
    pub phase: HazePhase,
    /// How the line of sight is integrated along.
    pub path: HazePath,
    /// How the sun's ray gets there.
    pub sun_ray: SunRay,
    /// The sky behind the haze.
    pub base_blue: BaseBlue,
    /// Bits of each channel of the pictures that [`PublishedModel::walk`](crate::models::PublishedModel::walk) is for, 4 to 16:
    /// its colours lie within one step of such a picture.
    pub bits_per_channel: u32,
}

/// What the haze is made of: how its extinction goes with wavelength, and how much of it is scattering.
#[derive(Clone, Debug, PartialEq)]
pub enum Haze {
    /// Drops of water of a published kind, by Mie's theory: a wet haze.
    Drops(Drops),
    /// Any other haze.
    Given {
        /// Extinction by wavelength, to any scale: only its ratio to that at 550 nm counts.
        extinction: SpectralCurve,
        /// Scattering over extinction.
        single_scattering_albedo: SpectralCurve,
        /// Angular scattering function, normalised.
        phase: PhaseFunction,
    },
}

/// Where the haze scatters to, `beta_sc(psi)` over the scattering coefficient.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub enum HazePhase {
    /// As its particles do: a table by angle and wavelength, as the paper prefers.
    #[default]
    Particles,
    /// Eq. 1 as it must be: `(1 - g^2) / (4 pi (1 + g^2 - 2 g cos psi)^(3/2))`, Henyey and Greenstein's.
    HenyeyGreenstein {
        /// Mean cosine, `-1 < g < 1`.
        g: f64,
    },
    /// Eq. 1 as printed, `(1 - g)^2 / (1 + g^2 - 2 g cos psi)^(3/2)`: its integral over the sphere is not 1 but
    /// `4 pi (1 - g) / (1 + g)`, 1.4 for `g = 0.8`, 12.6 for `g = 0`.
    Printed {
        /// Parameter, `-1 < g < 1`.
        g: f64,
    },
}

/// The sky behind the haze.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum BaseBlue {
    /// One colour all over, as in the paper: sunlight weighted by the part of each wavelength that the molecules scatter
    /// on a vertical way. Its luminance falls in proportion to the sine of the sun's elevation, to a hundredth at sunset
    /// (the factor is the paper's, the law between is ours).
    Constant {
        /// Luminance under a sun in the zenith and air of density 1, cd/m^2.
        noon_luminance_cd_m2: f64,
    },
    /// The air without haze, solved for ([`crate::sky`]).
    Solver,
}

impl BaseBlue {
    /// The paper's blue with 3000 cd/m^2: about what a clear sky has in the mean under a high sun.
    pub const PAPER: Self = Self::Constant {
        noon_luminance_cd_m2: 3000.0,
    };
}

/// Why numbers do not make the model of 1987.
#[derive(Clone, Debug, PartialEq, thiserror::Error)]
pub enum Klassen1987Error {
    /// A number out of its domain.
    #[error("{what} must be {right}, got {got}")]
    Number {
        /// Which, with its unit.
        what: &'static str,
        /// What would be right.
        right: &'static str,
        /// What was given.
        got: f64,
    },
    /// The haze reaches above the air.
    #[error(
        "the haze must not reach above the effective top of the air, {air_m} m: its thickness is {haze_m} m"
    )]
    HazeAboveAir {
        /// Thickness of the haze, m.
        haze_m: f64,
        /// Effective thickness of the air, m.
        air_m: f64,
    },
    /// The sun is below the horizon.
    #[error(
        "the model of 1987 has no twilight: the sun must be at the horizon or above, got an elevation of {0} degrees"
    )]
    SunBelowHorizon(f64),
    /// The clear air has no constituent that scatters.
    #[error("the clear air has no constituent that scatters light at 550 nm")]
    NoMolecules,
    /// The clear air is refused.
    #[error(transparent)]
    Atmosphere(#[from] AtmosphereError),
    /// The haze's drops are refused.
    #[error(transparent)]
    Mie(#[from] MieError),
    /// The haze's phase function is refused.
    #[error(transparent)]
    Phase(#[from] PhaseError),
    /// The clear air cannot be solved for.
    #[error(transparent)]
    Sky(#[from] SkyError),
    /// The fog's drops are refused.
    #[error(transparent)]
    Fog(#[from] FogError),
}

impl Default for Klassen1987Settings {
    /// The corrected model over the Earth: 8.4 km of air, 2 km of wet haze L with an extinction of 5e-5 per m (optical depth
    /// 0.1; one sees for 50 km), the blue from the solver.
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
    /// These with the geometry and the blue as printed (signs corrected): eqs. 20 to 31.
    pub fn printed(self) -> Self {
        Self {
            path: HazePath::LinearInRadius,
            sun_ray: SunRay::Printed,
            base_blue: BaseBlue::PAPER,
            ..self
        }
    }

    /// Checks every number.
    ///
    /// # Errors
    /// [`Klassen1987Error`] for the first that is out of its domain.
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

    /// Molecules' scattering at the ground, `beta_m`, m^-1.
    pub(super) fn air_extinction_per_m(&self, wavelength_nm: f64) -> f64 {
        let ground_m = self.clear_air.planet.ground_altitude_m;
        self.air_density * self.clear_air.scattering_per_m(ground_m, wavelength_nm)
    }

    /// The clear air, as dense as it is asked to be.
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
