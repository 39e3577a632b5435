//! A planet's air: what it is made of, what lies under it and what shines on it.

use super::density::{DensityError, DensityProfile};
use crate::optics::{PhaseError, PhaseFunction};
use crate::spectrum::SpectralCurve;
use crate::sun::{SunDisc, SunError};
use std::fmt;

/// Mean radius of the Earth, m (IUGG).
pub const EARTH_RADIUS_M: f64 = 6_371_008.8;

/// The solid ball under the air.
#[derive(Clone, Debug, PartialEq)]
pub struct Planet {
    /// Radius from which altitudes are counted, m.
    pub radius_m: f64,
    /// Altitude above which there is no air, m.
    pub top_altitude_m: f64,
    /// Altitude of the ground that blocks and reflects light, m.
    pub ground_altitude_m: f64,
    /// Lambertian albedo of the ground, in `[0, 1]`.
    pub ground_albedo: SpectralCurve,
}

/// What a constituent is: at most one of each kind in an atmosphere file, which replaces that of its base.
#[derive(Clone, Debug, PartialEq, Eq, Hash)]
#[non_exhaustive]
pub enum ConstituentKind {
    /// Molecules that scatter: "rayleigh". Turbidity and visibility are relative to them ([`Atmosphere::clear_air`]).
    Molecules,
    /// Ozone: "ozone".
    Ozone,
    /// Haze or dust: "aerosol".
    Aerosol,
    /// A layer of fog: "fog".
    Fog,
    /// Any other, by its own name.
    Other(String),
}

/// A constituent of the air: molecules, aerosol, a fog layer.
#[derive(Clone, Debug, PartialEq)]
pub struct Constituent {
    /// What it is.
    pub kind: ConstituentKind,
    /// Density relative to the density of the coefficients.
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
    /// What it is called.
    pub name: String,
    /// The ball under the air.
    pub planet: Planet,
    /// What the air holds.
    pub constituents: Vec<Constituent>,
    /// Solar irradiance at the top of the atmosphere on a surface that faces the sun, at the planet's mean distance,
    /// W m^-2 nm^-1.
    pub solar_irradiance: SpectralCurve,
    /// The sun's disc.
    pub sun: SunDisc,
}

/// Why numbers do not make an atmosphere.
#[derive(Clone, Debug, PartialEq, thiserror::Error)]
pub enum AtmosphereError {
    /// A length of the planet is out of its domain.
    #[error("planet.{field} must be {expected}, got {value}")]
    Planet {
        /// Which field.
        field: &'static str,
        /// What would be right.
        expected: &'static str,
        /// What was given.
        value: f64,
    },
    /// A spectrum takes a value out of its domain.
    #[error("{what} must be {expected}, but is {value} at {wavelength_nm} nm")]
    Spectrum {
        /// Which spectrum.
        what: String,
        /// What would be right.
        expected: &'static str,
        /// The value found.
        value: f64,
        /// Where it was found, nm.
        wavelength_nm: f64,
    },
    /// A constituent's density profile is refused.
    #[error("constituent \"{constituent}\": {error}")]
    Density {
        /// Its name.
        constituent: String,
        /// Why.
        error: DensityError,
    },
    /// A constituent's phase function is refused.
    #[error("constituent \"{constituent}\": {error}")]
    Phase {
        /// Its name.
        constituent: String,
        /// Why.
        error: PhaseError,
    },
    /// The sun's disc is refused.
    #[error("{0}")]
    Sun(#[from] SunError),
}

/// What the other gases do at 550 nm, which turbidity and visibility are stated relative to.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct ClearAir {
    /// Vertical optical depth of the molecules' scattering.
    pub optical_depth_550: f64,
    /// Extinction by molecules at the ground, m^-1.
    pub ground_extinction_per_m: f64,
}

impl Atmosphere {
    /// Checks and takes the parts.
    ///
    /// # Errors
    /// [`AtmosphereError`], see [`Atmosphere::validate`].
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

    /// Checks what a solver relies on: finite lengths in order, albedo in `[0, 1]`, coefficients and irradiance finite
    /// and not negative, densities, phase functions and sun in their domains. Spectra are looked at every 10 nm from
    /// 250 to 1100 nm, and at each sample of a table.
    ///
    /// # Errors
    /// The first fault found.
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

    /// The altitudes of kinks and jumps of all densities strictly between ground and top, rising, m.
    pub fn breakpoints_m(&self) -> Vec<f64> {
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

    /// What turbidity and visibility are stated relative to: the scattering of the molecules at 550 nm, 0 without molecules.
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

    /// Whether the planet is the Earth, by its size.
    pub fn is_earth(&self) -> bool {
        (self.planet.radius_m / EARTH_RADIUS_M - 1.0).abs() < 0.02
    }

    /// The same air at a distance from the sun, over the planet's mean distance: irradiance falls by its square, the disc
    /// shrinks.
    pub fn at_sun_distance(&self, ratio: f64) -> Self {
        let mut air = self.clone();
        air.solar_irradiance = air.solar_irradiance.scaled(1.0 / (ratio * ratio));
        air.sun = air.sun.at_distance_ratio(ratio);
        air
    }
}

impl ConstituentKind {
    /// Its name in atmosphere files.
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
    /// The kind of a name in an atmosphere file.
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

    /// The same constituent with every height raised by `by_m`: from heights above a ground to altitudes. `None` where the
    /// density is tied to sea level ([`DensityProfile::raised`]).
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

/// Every value where it is looked at lies in `[0, most]` and is finite.
fn check_curve(curve: &SpectralCurve, what: &str, most: f64) -> Result<(), AtmosphereError> {
    let expected = match most == 1.0 {
        true => "in [0, 1]",
        false => "finite and not negative",
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
