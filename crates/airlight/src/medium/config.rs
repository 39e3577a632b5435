//! Atmospheres written down: a TOML text that names a preset and overrides what differs.
//!
//! ```
//! let air = airlight::medium::config::from_toml(
//!     r#"
//!     base = "clear"
//!     [planet]
//!     ground_albedo = 0.2
//!     [ozone]
//!     column_du = 350
//!     [aerosol]
//!     visibility_m = 23e3
//!     phase = { kind = "draine", g = 0.6, alpha = 0.5 }
//!     [[constituent]]
//!     name = "smoke"
//!     density = { kind = "layer", bottom_m = 2000, top_m = 2500 }
//!     scattering_per_m = { at_550_nm = 4e-5, angstrom_exponent = 1.8 }
//!     absorption_per_m = 1e-5
//!     phase = { kind = "henyey-greenstein", g = 0.6 }
//!     "#,
//! )?;
//! assert_eq!(air.constituents.len(), 4);
//! # Ok::<(), airlight::medium::config::ConfigError>(())
//! ```
//!
//! | key | meaning |
//! |---|---|
//! | `name` | what the atmosphere is called; else the base's name |
//! | `base` | a preset ([`crate::medium::preset_names`]), or `"none"`: the Earth without air. `"average"` where absent |
//! | `remove` | list of constituents of the base to leave out |
//! | `planet.radius_m`, `.top_altitude_m`, `.ground_altitude_m` | lengths in metres |
//! | `planet.ground_albedo` | *spectrum* in `[0, 1]` |
//! | `sun.angular_radius_deg`, `.limb_darkening` | `"neckel"`, `"power-law"` or `"uniform"` |
//! | `sun.irradiance_w_m2_nm`, `.irradiance_factor` | *spectrum* at the top of the atmosphere; factor on it |
//! | `rayleigh.pressure_pa` | sea-level pressure; scales the base's molecules, or adds the Earth's where it has none |
//! | `ozone.column_du` | replaces the base's ozone by the measured cross-section and mid-latitude profile, of this column |
//! | `aerosol.aod_550`, `.turbidity` or `.visibility_m` | one of three ways to say how much ([`AerosolLoad`]) |
//! | `aerosol.contrast` | which contrast visibility means: 0.05 (if absent) or 0.02 |
//! | `aerosol.angstrom_exponent`, `.single_scattering_albedo` | exponent of the extinction; *spectrum* in `[0, 1]` |
//! | `aerosol.scale_height_m` or `.density` | how it thins out with altitude; *density* |
//! | `aerosol.phase` | *phase*; `kind` may be left out to change the parameters the base has |
//! | `[[constituent]]` | `name`, `density`, `scattering_per_m`, `absorption_per_m`, `phase`; replaces one of the same name |
//!
//! A *spectrum* is a number, `{ wavelengths_nm = [...], values = [...] }` or `{ at_550_nm = ..., angstrom_exponent = ... }`.
//! A *density* is `{ kind = "exponential", scale_height_m }`, `{ kind = "layer", bottom_m, top_m }`,
//! `{ kind = "tent", bottom_m, peak_m, top_m }`, `{ kind = "standard-air" }` or
//! `{ kind = "table", altitudes_m, densities, interpolation = "linear" | "log-linear" }`.
//! A *phase* is `{ kind = "isotropic" }`, `"rayleigh"` (optional `depolarization_ratio`), `"henyey-greenstein"` or
//! `"cornette-shanks"` (`g`), `"draine"` (`g`, `alpha`), `"continental"`, `"mixture"`
//! (`parts = [{ weight, kind, ... }, ...]`) or `"table"` (`angles_deg`, `wavelengths_nm`, `values` wavelength by wavelength).

mod error;
mod parts;
mod reader;
#[cfg(test)]
mod tests;

pub use error::{ConfigError, ConfigProblem};

use super::aerosol::{AerosolLoad, AngstromAerosol, continental_phase};
use super::presets::{self, earth};
use super::visibility::Contrast;
use super::{Atmosphere, AtmosphereError, Constituent, DensityProfile, gases};
use crate::light::LimbDarkening;
use crate::optics::{PhaseFunction, rayleigh::STANDARD_PRESSURE_PA};
use crate::spectrum::SpectralCurve;
use reader::Section;
use toml::de::DeTable;

/// The base that a text without `base` starts from.
const DEFAULT_BASE: &str = "average";
/// The base that has no air.
const NO_AIR: &str = "none";

/// Reads an atmosphere from TOML.
///
/// # Errors
/// [`ConfigError`]: what is wrong, where, and what would be right.
pub fn from_toml(text: &str) -> Result<Atmosphere, ConfigError> {
    let table = DeTable::parse(text).map_err(|error| {
        let at = error.span().map_or(0, |span| span.start);
        ConfigError::at(
            text,
            at,
            String::new(),
            ConfigProblem::Syntax(error.message().to_owned()),
        )
    })?;
    from_toml_table(text, table.get_ref(), "")
}

/// Reads an atmosphere from a table inside a larger TOML text; `path` is what its keys are called in messages
/// (`"atmosphere"`, or nothing for the whole text).
///
/// # Errors
/// As [`from_toml`].
pub fn from_toml_table(
    text: &str,
    table: &DeTable<'_>,
    path: &str,
) -> Result<Atmosphere, ConfigError> {
    let root = Section::new(text, table, path.to_owned());
    root.check_keys(&[
        "name",
        "base",
        "remove",
        "planet",
        "sun",
        "rayleigh",
        "ozone",
        "aerosol",
        "constituent",
    ])?;
    let base = root.text("base")?.unwrap_or(DEFAULT_BASE);
    let mut atmosphere = match base {
        NO_AIR => earth::airless(NO_AIR),
        name => presets::preset(name).map_err(|_| {
            let names = presets::preset_names()
                .map(|preset| preset.0)
                .chain([NO_AIR]);
            root.unknown("base", "base", name, names.collect())
        })?,
    };
    if let Some(name) = root.text("name")? {
        atmosphere.name = name.to_owned();
    }
    for name in root.texts("remove")?.unwrap_or_default() {
        let names: Vec<&str> = atmosphere
            .constituents
            .iter()
            .map(|part| part.name.as_str())
            .collect();
        if !names.contains(&name) {
            return Err(root.unknown("remove", "constituent", name, names));
        }
        atmosphere.constituents.retain(|part| part.name != name);
    }
    if let Some(section) = root.section("planet")? {
        planet(&section, &mut atmosphere)?;
    }
    if let Some(section) = root.section("sun")? {
        sun(&section, &mut atmosphere)?;
    }
    if let Some(section) = root.section("rayleigh")? {
        molecules(&section, base, &mut atmosphere)?;
    }
    if let Some(section) = root.section("ozone")? {
        section.check_keys(&["column_du"])?;
        if let Some(column_du) = section.not_negative("column_du")? {
            put(&mut atmosphere, gases::ozone(column_du));
        }
    }
    if let Some(section) = root.section("aerosol")? {
        aerosol(&section, &mut atmosphere)?;
    }
    for section in root.sections("constituent")? {
        put(&mut atmosphere, parts::constituent(&section)?);
    }
    // Each value has been looked at where it stands; this is for what only shows together.
    atmosphere.validate().map_err(|error| {
        let key = match error {
            AtmosphereError::Planet { .. } => "planet",
            AtmosphereError::Sun(_) => "sun",
            _ => "base",
        };
        root.error(key, ConfigProblem::Atmosphere(error))
    })?;
    Ok(atmosphere)
}

/// Replaces the constituent of the same name, or adds one.
fn put(atmosphere: &mut Atmosphere, part: Constituent) {
    match atmosphere
        .constituents
        .iter_mut()
        .find(|old| old.name == part.name)
    {
        Some(old) => *old = part,
        None => atmosphere.constituents.push(part),
    }
}

fn planet(section: &Section<'_>, atmosphere: &mut Atmosphere) -> Result<(), ConfigError> {
    section.check_keys(&[
        "radius_m",
        "top_altitude_m",
        "ground_altitude_m",
        "ground_albedo",
    ])?;
    let planet = &mut atmosphere.planet;
    if let Some(radius_m) = section.positive("radius_m")? {
        planet.radius_m = radius_m;
    }
    if let Some(top_m) = section.positive("top_altitude_m")? {
        planet.top_altitude_m = top_m;
    }
    if let Some(ground_m) =
        section.number("ground_altitude_m", "a finite number", f64::is_finite)?
    {
        planet.ground_altitude_m = ground_m;
    }
    if let Some(albedo) = parts::spectrum(section, "ground_albedo", 1.0)? {
        planet.ground_albedo = albedo;
    }
    Ok(())
}

fn sun(section: &Section<'_>, atmosphere: &mut Atmosphere) -> Result<(), ConfigError> {
    section.check_keys(&[
        "angular_radius_deg",
        "limb_darkening",
        "irradiance_w_m2_nm",
        "irradiance_factor",
    ])?;
    let below_90 = |deg: f64| deg > 0.0 && deg < 90.0;
    if let Some(deg) = section.number("angular_radius_deg", "above 0 and below 90", below_90)? {
        atmosphere.sun.angular_radius_rad = deg.to_radians();
    }
    if let Some(name) = section.text("limb_darkening")? {
        atmosphere.sun.limb_darkening = match name {
            "neckel" => LimbDarkening::Neckel,
            "power-law" => LimbDarkening::PowerLaw,
            "uniform" => LimbDarkening::Uniform,
            _ => {
                let names = vec!["neckel", "power-law", "uniform"];
                return Err(section.unknown("limb_darkening", "limb darkening", name, names));
            }
        };
    }
    if let Some(irradiance) = parts::spectrum(section, "irradiance_w_m2_nm", f64::INFINITY)? {
        atmosphere.solar_irradiance = irradiance;
    }
    if let Some(factor) = section.not_negative("irradiance_factor")? {
        atmosphere.solar_irradiance = atmosphere.solar_irradiance.clone().scaled(factor);
    }
    Ok(())
}

fn molecules(
    section: &Section<'_>,
    base: &str,
    atmosphere: &mut Atmosphere,
) -> Result<(), ConfigError> {
    section.check_keys(&["pressure_pa"])?;
    let Some(pressure_pa) = section.not_negative("pressure_pa")? else {
        return Ok(());
    };
    let base_pressure_pa = match base {
        "mars" => presets::mars::MARS_PRESSURE_PA,
        _ => STANDARD_PRESSURE_PA,
    };
    match atmosphere
        .constituents
        .iter_mut()
        .find(|part| part.name == "rayleigh")
    {
        Some(part) => {
            part.scattering_per_m = part
                .scattering_per_m
                .clone()
                .scaled(pressure_pa / base_pressure_pa);
        }
        None => put(atmosphere, gases::air(pressure_pa)),
    }
    Ok(())
}

fn aerosol(section: &Section<'_>, atmosphere: &mut Atmosphere) -> Result<(), ConfigError> {
    section.check_keys(&[
        "aod_550",
        "turbidity",
        "visibility_m",
        "contrast",
        "angstrom_exponent",
        "single_scattering_albedo",
        "scale_height_m",
        "density",
        "phase",
    ])?;
    let (ground, top) = (
        atmosphere.planet.ground_altitude_m,
        atmosphere.planet.top_altitude_m,
    );
    let old = atmosphere.constituent("aerosol").cloned();
    let old_depth = old
        .as_ref()
        .map_or(0.0, |part| part.optical_depth(ground, top, 550.0));
    let loads = ["aod_550", "turbidity", "visibility_m"];
    let contrast = section.number("contrast", "0.05 or 0.02", |c| c == 0.05 || c == 0.02)?;
    let contrast = match contrast {
        Some(0.02) => Contrast::TwoPercent,
        _ => Contrast::FivePercent,
    };
    let mut load = None;
    for key in loads {
        let Some(value) = section.number(key, "a number", |_| true)? else {
            continue;
        };
        if let Some((first, _)) = load {
            return Err(section.error(key, ConfigProblem::Conflict { with: first }));
        }
        let kind = match key {
            "aod_550" => AerosolLoad::OpticalDepth550(value),
            "turbidity" => AerosolLoad::Turbidity(value),
            _ => AerosolLoad::Visibility {
                range_m: value,
                contrast,
            },
        };
        load = Some((key, kind));
    }
    let exponent = section.number("angstrom_exponent", "between -4 and 8", |x| {
        (-4.0..=8.0).contains(&x)
    })?;
    let albedo = parts::spectrum(section, "single_scattering_albedo", 1.0)?;
    let density = match (
        section.positive("scale_height_m")?,
        parts::density(section, "density")?,
    ) {
        (Some(_), Some(_)) => {
            return Err(section.error(
                "density",
                ConfigProblem::Conflict {
                    with: "scale_height_m",
                },
            ));
        }
        (Some(scale_height_m), None) => Some(DensityProfile::Exponential { scale_height_m }),
        (None, given) => given,
    };
    let phase = parts::phase(section, "phase", old.as_ref().map(|part| &part.phase))?;
    if old.is_none() && load.is_none() {
        return Err(section.missing(
            "aod_550",
            "the base has no aerosol: say how much with aod_550, turbidity or visibility_m",
        ));
    }
    let usual = earth::Earth::with_aerosol(old_depth).aerosol;
    let rebuilt = AngstromAerosol {
        load: load.map_or(AerosolLoad::OpticalDepth550(old_depth), |(_, load)| load),
        angstrom_exponent: exponent.unwrap_or_else(|| match &old {
            Some(part) => exponent_of(part).unwrap_or(usual.angstrom_exponent),
            None => usual.angstrom_exponent,
        }),
        single_scattering_albedo: albedo.clone().unwrap_or_else(|| match &old {
            Some(part) => albedo_of(part),
            None => usual.single_scattering_albedo,
        }),
        density: density.unwrap_or_else(|| {
            old.as_ref()
                .map_or(usual.density, |part| part.density.clone())
        }),
        phase: phase.unwrap_or_else(|| {
            old.as_ref()
                .map_or_else(continental_phase, |part| part.phase.clone())
        }),
    };
    let mut part = rebuilt
        .constituent(atmosphere.clear_air(), ground, top)
        .map_err(|error| {
            let key = load.map_or("phase", |(key, _)| key);
            section.error(key, ConfigProblem::Aerosol(error))
        })?;
    // Where only the amount, the place or the direction changes, the base's own spectra stay, scaled.
    if let (Some(old), None, None) = (old, exponent, albedo) {
        let factor = part.extinction_per_m(550.0) / old.extinction_per_m(550.0);
        if factor.is_finite() {
            part.scattering_per_m = old.scattering_per_m.scaled(factor);
            part.absorption_per_m = old.absorption_per_m.scaled(factor);
        }
    }
    put(atmosphere, part);
    Ok(())
}

/// The Angstrom exponent of a constituent's extinction between 440 and 880 nm.
fn exponent_of(part: &Constituent) -> Option<f64> {
    let ratio = part.extinction_per_m(440.0) / part.extinction_per_m(880.0);
    (ratio.is_finite() && ratio > 0.0).then(|| ratio.log2())
}

/// The single-scattering albedo of a constituent: constant where it is, else every 2 nm.
fn albedo_of(part: &Constituent) -> SpectralCurve {
    let at = |nm: f64| match part.extinction_per_m(nm) {
        extinction if extinction > 0.0 => {
            (part.scattering_per_m.at(nm) / extinction).clamp(0.0, 1.0)
        }
        _ => 1.0,
    };
    let wavelengths: Vec<f64> = (125..=550).map(|i| 2.0 * f64::from(i)).collect();
    let values: Vec<f64> = wavelengths.iter().map(|&nm| at(nm)).collect();
    match values.iter().all(|v| (v - values[0]).abs() < 1e-9) {
        true => SpectralCurve::Constant(values[0]),
        false => {
            SpectralCurve::table(wavelengths, values).unwrap_or(SpectralCurve::Constant(at(550.0)))
        }
    }
}

/// The phase function that parameters without a kind belong to.
fn kind_of(phase: &PhaseFunction) -> Option<&'static str> {
    match phase {
        PhaseFunction::HenyeyGreenstein { .. } => Some("henyey-greenstein"),
        PhaseFunction::CornetteShanks { .. } => Some("cornette-shanks"),
        PhaseFunction::Draine { .. } => Some("draine"),
        _ => None,
    }
}
