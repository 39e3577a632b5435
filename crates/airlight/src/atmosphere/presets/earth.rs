//! The Earth: gases from first principles, a continental aerosol, ground of grass and soil.

use super::fixed_table::fixed_table;
use crate::atmosphere::aerosol::{AerosolError, AerosolLoad, AngstromAerosol, continental_phase};
pub use crate::atmosphere::constituents::EARTH_RADIUS_M;
use crate::atmosphere::{Atmosphere, DensityProfile, Planet, gases};
use crate::optics::rayleigh::STANDARD_PRESSURE_PA;
use crate::spectrum::{SpectralCurve, solar};
use crate::sun::SunDisc;

/// Top of the Earth's atmosphere, m: less than 1e-6 of all scattering happens above.
pub(crate) const EARTH_TOP_M: f64 = 100e3;

/// Parameters of an Earth atmosphere.
#[derive(Clone, Debug, PartialEq)]
pub struct Earth {
    /// Pressure at sea level, Pa.
    pub sea_level_pressure_pa: f64,
    /// Ozone column, Dobson units.
    pub ozone_du: f64,
    /// The aerosol.
    pub aerosol: AngstromAerosol,
    /// Albedo of the ground.
    pub ground_albedo: SpectralCurve,
}

impl Earth {
    /// Standard pressure, 300 Dobson units of ozone, ground of grass and soil, and a continental aerosol with this optical
    /// depth at 550 nm: Angstrom exponent 1.3, single-scattering albedo 0.95, scale height 1.5 km, the phase function
    /// measured in continental air (AERONET, Egbert 2013).
    pub fn with_aerosol(optical_depth_550: f64) -> Self {
        Self {
            sea_level_pressure_pa: STANDARD_PRESSURE_PA,
            ozone_du: 300.0,
            aerosol: AngstromAerosol {
                load: AerosolLoad::OpticalDepth550(optical_depth_550),
                angstrom_exponent: 1.3,
                single_scattering_albedo: SpectralCurve::Constant(0.95),
                density: DensityProfile::exponential(1.5e3),
                phase: continental_phase(),
            },
            ground_albedo: grass_and_soil(),
        }
    }

    /// The atmosphere with these parameters.
    ///
    /// # Errors
    /// [`AerosolError`] for an invalid aerosol. Pressure, ozone and albedo are checked by [`Atmosphere::validate`].
    pub fn atmosphere(&self, name: &str) -> Result<Atmosphere, AerosolError> {
        let mut atmosphere = self.gases(name);
        let aerosol = self
            .aerosol
            .constituent(atmosphere.clear_air(), 0.0, EARTH_TOP_M)?;
        atmosphere.constituents.push(aerosol);
        Ok(atmosphere)
    }

    /// The atmosphere without its aerosol.
    pub(super) fn gases(&self, name: &str) -> Atmosphere {
        Atmosphere {
            name: name.to_owned(),
            planet: planet(self.ground_albedo.clone()),
            constituents: vec![
                gases::air(self.sea_level_pressure_pa),
                gases::ozone(self.ozone_du),
            ],
            solar_irradiance: SpectralCurve::Table(solar::extraterrestrial().clone()),
            sun: SunDisc::default(),
        }
    }
}

/// The Earth without an atmosphere.
#[cfg(feature = "config")]
pub(in crate::atmosphere) fn airless(name: &str) -> Atmosphere {
    Atmosphere {
        name: name.to_owned(),
        planet: planet(grass_and_soil()),
        constituents: vec![],
        solar_irradiance: SpectralCurve::Table(solar::extraterrestrial().clone()),
        sun: SunDisc::default(),
    }
}

fn planet(ground_albedo: SpectralCurve) -> Planet {
    Planet {
        radius_m: EARTH_RADIUS_M,
        top_altitude_m: EARTH_TOP_M,
        ground_altitude_m: 0.0,
        ground_albedo,
    }
}

/// Half grass (as in the comparison of clear-sky models, [`super::reference::csm`]), half a soil whose albedo rises
/// from 0.05 at 360 nm to 0.23 at 800 nm: 0.107 at 550 nm, green with a red edge. Rounded.
pub(crate) fn grass_and_soil() -> SpectralCurve {
    fixed_table(&[
        (360.0, 0.034),
        (450.0, 0.058),
        (500.0, 0.070),
        (525.0, 0.089),
        (550.0, 0.107),
        (575.0, 0.107),
        (600.0, 0.105),
        (650.0, 0.106),
        (680.0, 0.108),
        (700.0, 0.140),
        (725.0, 0.240),
        (750.0, 0.355),
        (800.0, 0.410),
    ])
}

/// A clear day: aerosol optical depth 0.05 at 550 nm.
pub fn clear() -> Atmosphere {
    fixed("clear", Earth::with_aerosol(0.05))
}

/// An average day: aerosol optical depth 0.12 at 550 nm.
pub fn average() -> Atmosphere {
    fixed("average", Earth::with_aerosol(0.12))
}

/// A hazy day: aerosol optical depth 0.35 at 550 nm, single-scattering albedo 0.93.
pub fn hazy() -> Atmosphere {
    let mut earth = Earth::with_aerosol(0.35);
    earth.aerosol.single_scattering_albedo = SpectralCurve::Constant(0.93);
    fixed("hazy", earth)
}

fn fixed(name: &str, earth: Earth) -> Atmosphere {
    earth
        .atmosphere(name)
        .expect("constant parameters are valid")
}
