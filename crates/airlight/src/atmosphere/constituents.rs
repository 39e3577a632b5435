//! [`Atmosphere`]: a planet, the constituents of its air, and the sun at its top.

use super::density::{DensityError, DensityProfile};
use crate::optics::{PhaseError, PhaseFunction};
use crate::spectrum::SpectralCurve;
use crate::sun::{SunDisc, SunError, SunState};
use std::fmt;

/// Mean radius of the Earth, m (IUGG).
pub const EARTH_RADIUS_M: f64 = 6_371_008.8;

/// Size and ground of the planet: a sphere.
#[derive(Clone, Debug, PartialEq)]
pub struct Planet {
    /// Radius at altitude 0, m.
    pub radius_m: f64,
    /// Altitude of the top of the atmosphere, m; no air above.
    pub top_altitude_m: f64,
    /// Altitude of the ground, m. It blocks and reflects light.
    pub ground_altitude_m: f64,
    /// Lambertian albedo of the ground, in `[0, 1]`.
    pub ground_albedo: SpectralCurve,
}

/// Kind of a constituent. An atmosphere file has at most one constituent of each kind; it replaces that of the base.
#[derive(Clone, Debug, PartialEq, Eq, Hash)]
#[non_exhaustive]
pub enum ConstituentKind {
    /// Scattering molecules: "rayleigh". Turbidity and visibility are relative to them ([`Atmosphere::clear_air`]).
    Molecules,
    /// Ozone: "ozone".
    Ozone,
    /// Haze or dust: "aerosol".
    Aerosol,
    /// A layer of fog: "fog".
    Fog,
    /// Any other constituent, by name.
    Other(String),
}

/// One constituent of the air: a gas, an aerosol or a layer of fog.
#[derive(Clone, Debug, PartialEq)]
pub struct Constituent {
    /// Kind, which also names the constituent in files.
    pub kind: ConstituentKind,
    /// Relative density by height: factor on the coefficients.
    pub density: DensityProfile,
    /// Scattering coefficient at relative density 1, m^-1.
    pub scattering_per_m: SpectralCurve,
    /// Absorption coefficient at relative density 1, m^-1.
    pub absorption_per_m: SpectralCurve,
    /// Phase function.
    pub phase: PhaseFunction,
}

/// A planet, its air and its sun.
#[derive(Clone, Debug, PartialEq)]
pub struct Atmosphere {
    /// Name, for reports and metadata.
    pub name: String,
    /// The planet below the air.
    pub planet: Planet,
    /// Constituents of the air.
    pub constituents: Vec<Constituent>,
    /// Solar irradiance at the top of the atmosphere on a surface that faces the sun, at the planet's mean distance,
    /// W m^-2 nm^-1.
    pub solar_irradiance: SpectralCurve,
    /// The sun's disc.
    pub sun: SunDisc,
}

/// Why an atmosphere is invalid.
#[derive(Clone, Debug, PartialEq, thiserror::Error)]
#[non_exhaustive]
pub enum AtmosphereError {
    /// A length of the planet out of range.
    #[error("planet.{field}: expected a number of metres that is {expected}, got {value}")]
    Planet {
        /// The field.
        field: &'static str,
        /// The values allowed.
        expected: &'static str,
        /// The value given.
        value: f64,
    },
    /// A spectrum with a value out of range.
    #[error("{what}: expected values {expected}, got {value} at {wavelength_nm} nm")]
    Spectrum {
        /// The spectrum.
        what: String,
        /// The values allowed.
        expected: &'static str,
        /// The value found.
        value: f64,
        /// Its wavelength, nm.
        wavelength_nm: f64,
    },
    /// A constituent with an invalid density profile.
    #[error("constituent \"{constituent}\": {error}")]
    Density {
        /// Name of the constituent.
        constituent: String,
        /// What is wrong.
        error: DensityError,
    },
    /// A constituent with an invalid phase function.
    #[error("constituent \"{constituent}\": {error}")]
    Phase {
        /// Name of the constituent.
        constituent: String,
        /// What is wrong.
        error: PhaseError,
    },
    /// An invalid disc of the sun.
    #[error("{0}")]
    Sun(#[from] SunError),
}

/// Scattering of the molecules at 550 nm, which turbidity and visibility are relative to.
#[derive(Clone, Copy, Debug, PartialEq)]
#[non_exhaustive]
pub struct ClearAir {
    /// Vertical optical depth of the molecules.
    pub optical_depth_550: f64,
    /// Extinction coefficient of the molecules at the ground, m^-1.
    pub ground_extinction_per_m: f64,
}

impl Atmosphere {
    /// An atmosphere of these parts, checked by [`Atmosphere::validate`].
    ///
    /// # Errors
    /// [`AtmosphereError`] for the first invalid part.
    pub fn new(
        name: impl Into<String>,
        planet: Planet,
        constituents: Vec<Constituent>,
        solar_irradiance: SpectralCurve,
        sun: SunDisc,
    ) -> Result<Self, AtmosphereError> {
        let atmosphere = Self {
            name: name.into(),
            planet,
            constituents,
            solar_irradiance,
            sun,
        };
        atmosphere.validate()?;
        Ok(atmosphere)
    }

    /// Checks what solvers assume: finite lengths in order, albedo in `[0, 1]`, coefficients and irradiance finite and
    /// not negative, valid densities, phase functions and sun. Spectra are checked every 10 nm from 250 to 1100 nm, and
    /// at each sample of a table.
    ///
    /// # Errors
    /// [`AtmosphereError`] for the first invalid value.
    pub fn validate(&self) -> Result<(), AtmosphereError> {
        let planet = &self.planet;
        let check = |ok: bool, field, expected, value| match ok {
            true => Ok(()),
            false => Err(AtmosphereError::Planet {
                field,
                expected,
                value,
            }),
        };
        let radius = planet.radius_m;
        check(
            radius.is_finite() && radius > 0.0,
            "radius_m",
            "positive and finite",
            radius,
        )?;
        let ground = planet.ground_altitude_m;
        check(
            ground.is_finite() && ground > -radius,
            "ground_altitude_m",
            "finite and above the planet's centre",
            ground,
        )?;
        let top = planet.top_altitude_m;
        check(
            top.is_finite() && top > ground,
            "top_altitude_m",
            "finite and above the ground",
            top,
        )?;
        check_curve(&planet.ground_albedo, "planet.ground_albedo", 1.0)?;
        check_curve(&self.solar_irradiance, "solar irradiance", f64::INFINITY)?;
        for part in &self.constituents {
            part.density
                .validate()
                .map_err(|error| AtmosphereError::Density {
                    constituent: part.kind.to_string(),
                    error,
                })?;
            part.phase
                .validate()
                .map_err(|error| AtmosphereError::Phase {
                    constituent: part.kind.to_string(),
                    error,
                })?;
            let name = &part.kind;
            check_curve(
                &part.scattering_per_m,
                &format!("scattering of \"{name}\""),
                f64::INFINITY,
            )?;
            check_curve(
                &part.absorption_per_m,
                &format!("absorption of \"{name}\""),
                f64::INFINITY,
            )?;
        }
        self.sun.validate()?;
        Ok(())
    }

    /// Scattering coefficient at an altitude (m), m^-1.
    pub fn scattering_per_m(&self, altitude_m: f64, wavelength_nm: f64) -> f64 {
        let of = |part: &Constituent| {
            part.density.at(altitude_m) * part.scattering_per_m.at(wavelength_nm)
        };
        self.constituents.iter().map(of).sum()
    }

    /// Extinction coefficient at an altitude (m), m^-1.
    pub fn extinction_per_m(&self, altitude_m: f64, wavelength_nm: f64) -> f64 {
        let of =
            |part: &Constituent| part.density.at(altitude_m) * part.extinction_per_m(wavelength_nm);
        self.constituents.iter().map(of).sum()
    }

    /// Optical depth of the vertical path from the ground to the top.
    pub fn vertical_optical_depth(&self, wavelength_nm: f64) -> f64 {
        let (ground, top) = (self.planet.ground_altitude_m, self.planet.top_altitude_m);
        let of = |part: &Constituent| {
            part.density.column_m(ground, top) * part.extinction_per_m(wavelength_nm)
        };
        self.constituents.iter().map(of).sum()
    }

    /// Altitudes of kinks and jumps of all densities strictly between ground and top, in increasing order, m.
    pub(crate) fn breakpoints_m(&self) -> Vec<f64> {
        let (ground, top) = (self.planet.ground_altitude_m, self.planet.top_altitude_m);
        let mut all: Vec<f64> = self
            .constituents
            .iter()
            .flat_map(|part| part.density.breakpoints_m())
            .filter(|&z| z > ground && z < top)
            .collect();
        all.sort_by(f64::total_cmp);
        all.dedup();
        all
    }

    /// Scattering of the molecules at 550 nm, which turbidity and visibility are relative to; 0 without molecules.
    pub fn clear_air(&self) -> ClearAir {
        let (ground, top) = (self.planet.ground_altitude_m, self.planet.top_altitude_m);
        let molecules = || {
            self.constituents
                .iter()
                .filter(|part| part.kind == ConstituentKind::Molecules)
        };
        let at_550 = |part: &Constituent| part.scattering_per_m.at(550.0);
        ClearAir {
            optical_depth_550: molecules()
                .map(|m| at_550(m) * m.density.column_m(ground, top))
                .sum(),
            ground_extinction_per_m: molecules().map(|m| at_550(m) * m.density.at(ground)).sum(),
        }
    }

    /// The first constituent of a kind.
    pub fn constituent(&self, kind: &ConstituentKind) -> Option<&Constituent> {
        self.constituents.iter().find(|part| part.kind == *kind)
    }

    /// Replaces the constituent of the same kind, or adds one.
    pub fn put(&mut self, part: Constituent) {
        match self
            .constituents
            .iter_mut()
            .find(|old| old.kind == part.kind)
        {
            Some(old) => *old = part,
            None => self.constituents.push(part),
        }
    }

    /// Whether the planet is the Earth, judged by its radius.
    pub fn is_earth(&self) -> bool {
        (self.planet.radius_m / EARTH_RADIUS_M - 1.0).abs() < 0.02
    }

    /// The same atmosphere with the sun at its present distance, instead of the planet's mean distance: irradiance and size
    /// of the disc.
    pub fn under(&self, sun: &SunState) -> Self {
        let mut air = self.clone();
        air.solar_irradiance = air.solar_irradiance.scaled(sun.irradiance_factor());
        air.sun = sun.disc(&air.sun);
        air
    }
}

impl ConstituentKind {
    /// Name in atmosphere files.
    pub fn name(&self) -> &str {
        match self {
            Self::Molecules => "rayleigh",
            Self::Ozone => "ozone",
            Self::Aerosol => "aerosol",
            Self::Fog => "fog",
            Self::Other(name) => name,
        }
    }
}

impl From<&str> for ConstituentKind {
    /// The kind with this name in atmosphere files.
    fn from(name: &str) -> Self {
        let known = [Self::Molecules, Self::Ozone, Self::Aerosol, Self::Fog];
        known
            .into_iter()
            .find(|kind| kind.name() == name)
            .unwrap_or_else(|| Self::Other(name.to_owned()))
    }
}

impl fmt::Display for ConstituentKind {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.write_str(self.name())
    }
}

impl Constituent {
    /// Extinction coefficient at relative density 1, m^-1.
    pub fn extinction_per_m(&self, wavelength_nm: f64) -> f64 {
        self.scattering_per_m.at(wavelength_nm) + self.absorption_per_m.at(wavelength_nm)
    }

    /// The same constituent with every height raised by `by_m`, to convert heights above ground to altitudes. `None` if
    /// the density is tied to sea level ([`DensityProfile::raised`]).
    pub fn raised(&self, by_m: f64) -> Option<Self> {
        Some(Self {
            density: self.density.raised(by_m)?,
            ..self.clone()
        })
    }

    /// Optical depth of the vertical path between two altitudes, m.
    pub fn optical_depth(
        &self,
        from_altitude_m: f64,
        top_altitude_m: f64,
        wavelength_nm: f64,
    ) -> f64 {
        self.density.column_m(from_altitude_m, top_altitude_m)
            * self.extinction_per_m(wavelength_nm)
    }
}

/// Checks that values are finite and in `[0, most]`.
fn check_curve(curve: &SpectralCurve, what: &str, most: f64) -> Result<(), AtmosphereError> {
    let expected = match most == 1.0 {
        true => "in [0, 1]",
        false => "that are finite and not negative",
    };
    let mut wavelengths: Vec<f64> = (25..=110).map(|i| 10.0 * f64::from(i)).collect();
    samples_of(curve, &mut wavelengths);
    for wavelength_nm in wavelengths {
        let value = curve.at(wavelength_nm);
        if !(value.is_finite() && value >= 0.0 && value <= most) {
            return Err(AtmosphereError::Spectrum {
                what: what.to_owned(),
                expected,
                value,
                wavelength_nm,
            });
        }
    }
    Ok(())
}

fn samples_of(curve: &SpectralCurve, into: &mut Vec<f64>) {
    match curve {
        SpectralCurve::Table(table) => into.extend_from_slice(table.abscissae()),
        SpectralCurve::Scaled(_, curve) => samples_of(curve, into),
        _ => {}
    }
}
