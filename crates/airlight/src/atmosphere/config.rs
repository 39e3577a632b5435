//! Atmospheres in TOML: a preset and the values that differ from it; [`Atmosphere::from_toml`] lists the keys.

mod aerosol;
mod error;
mod parts;
mod reader;
#[cfg(test)]
mod tests;

pub use error::{ConfigError, ConfigProblem};

use super::presets::{self, Preset, earth};
use super::{Atmosphere, AtmosphereError, ConstituentKind, gases};
use crate::names::Named;
use crate::optics::rayleigh::STANDARD_PRESSURE_PA;
use reader::Section;
use toml::de::DeTable;

/// The default base.
const DEFAULT_BASE: &str = "average";
/// The base without air.
const NO_AIR: &str = "none";

impl Atmosphere {
    /// Reads an atmosphere from TOML: a preset and the values that differ from it.
    ///
    /// ```
    /// use airlight::atmosphere::Atmosphere;
    ///
    /// let air = Atmosphere::from_toml(
    ///     r#"
    ///     base = "clear"
    ///     [planet]
    ///     ground_albedo = 0.2
    ///     [ozone]
    ///     column_du = 350
    ///     [aerosol]
    ///     visibility_m = 23e3
    ///     phase = { kind = "draine", g = 0.6, alpha = 0.5 }
    ///     [[constituent]]
    ///     name = "smoke"
    ///     density = { kind = "layer", bottom_m = 2000, top_m = 2500 }
    ///     scattering_per_m = { at_550_nm = 4e-5, angstrom_exponent = 1.8 }
    ///     absorption_per_m = 1e-5
    ///     phase = { kind = "henyey-greenstein", g = 0.6 }
    ///     "#,
    /// )?;
    /// assert_eq!(air.constituents.len(), 4);
    /// # Ok::<(), airlight::atmosphere::ConfigError>(())
    /// ```
    ///
    /// | key | meaning |
    /// |---|---|
    /// | `name` | name of the atmosphere; default: name of the base |
    /// | `base` | a preset ([`crate::atmosphere::Preset`]), or `"none"`: the Earth without air; default `"average"` |
    /// | `remove` | names of constituents of the base to remove |
    /// | `planet.radius_m`, `.top_altitude_m`, `.ground_altitude_m` | lengths in metres |
    /// | `planet.ground_albedo` | *spectrum* in `[0, 1]` |
    /// | `sun.angular_radius_deg`, `.limb_darkening` | `"neckel"`, `"power-law"` or `"uniform"` |
    /// | `sun.irradiance_w_m2_nm`, `.irradiance_factor` | *spectrum* at the top of the atmosphere; a factor on it |
    /// | `rayleigh.pressure_pa` | sea-level pressure; scales the molecules of the base, or adds those of the Earth if it has none |
    /// | `ozone.column_du` | replaces the ozone of the base: measured cross-section, mid-latitude profile, this column |
    /// | `aerosol.type`, `.relative_humidity` | a published type ([`crate::atmosphere::AerosolType`]) at a humidity from 0 to 0.99 |
    /// | `aerosol.mixture` | instead of `type`: list of `{ type, share }` or `{ component, share }`, shares of the extinction |
    /// | `aerosol.aod_550`, `.turbidity` or `.visibility_m` | amount ([`crate::atmosphere::AerosolLoad`]) |
    /// | `aerosol.contrast` | contrast threshold of the visibility: 0.05 (default) or 0.02 |
    /// | `aerosol.angstrom_exponent`, `.single_scattering_albedo` | exponent of the extinction; *spectrum* in `[0, 1]` |
    /// | `aerosol.scale_height_m` or `.density` | scale height of an exponential profile, or a *density* |
    /// | `aerosol.phase` | *phase*; without `kind`, changes parameters of the base's phase function |
    /// | `[[constituent]]` | `name`, `density`, `scattering_per_m`, `absorption_per_m`, `phase`; replaces one of the same name |
    ///
    /// A *spectrum* is a number, `{ wavelengths_nm = [...], values = [...] }` or `{ at_550_nm = ..., angstrom_exponent = ... }`.
    /// A *density* is `{ kind = "exponential", scale_height_m }` (optional `reference_height_m`),
    /// `{ kind = "clamped", base_height_m, scale_height_m }`, `{ kind = "layer", top_m }` (optional `bottom_m`),
    /// `{ kind = "tent", bottom_m, peak_m, top_m }`, `{ kind = "uniform" }`, `{ kind = "standard-air" }` or
    /// `{ kind = "table", altitudes_m, densities, interpolation = "linear" | "log-linear" }`.
    /// A *phase* is `{ kind = "isotropic" }`, `"rayleigh"` (optional `depolarization_ratio`), `"henyey-greenstein"` or
    /// `"cornette-shanks"` (`g`), `"draine"` (`g`, `alpha`), `"continental"`, `"mixture"`
    /// (`parts = [{ weight, kind, ... }, ...]`) or `"table"` (`angles_deg`, `wavelengths_nm`, `values` by wavelength, then angle).
    ///
    /// # Errors
    /// [`ConfigError`] with place, problem and allowed values.
    pub fn from_toml(text: &str) -> Result<Self, ConfigError> {
        let table = DeTable::parse(text).map_err(|error| {
            let at = error.span().map_or(0, |span| span.start);
            ConfigError::at(
                text,
                at,
                String::new(),
                ConfigProblem::Syntax(error.message().to_owned()),
            )
        })?;
        from_table(&Section::new(text, table.get_ref(), String::new()))
    }
}

fn from_table(root: &Section<'_>) -> Result<Atmosphere, ConfigError> {
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
            let names = Preset::ALL
                .iter()
                .map(|preset| preset.name())
                .chain([NO_AIR]);
            root.unknown("base", "a base", name, names.collect())
        })?,
    };
    if let Some(name) = root.text("name")? {
        atmosphere.name = name.to_owned();
    }
    for name in root.texts("remove")?.unwrap_or_default() {
        let names: Vec<&str> = atmosphere
            .constituents
            .iter()
            .map(|part| part.kind.name())
            .collect();
        if !names.contains(&name) {
            return Err(root.unknown("remove", "a constituent", name, names));
        }
        let kind = ConstituentKind::from(name);
        atmosphere.constituents.retain(|part| part.kind != kind);
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
            atmosphere.put(gases::ozone(column_du));
        }
    }
    if let Some(section) = root.section("aerosol")? {
        aerosol::aerosol(&section, &mut atmosphere)?;
    }
    for section in root.sections("constituent")? {
        atmosphere.put(parts::constituent(&section)?);
    }
    // Single values are checked above; this checks their combination.
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
    if let Some(deg) = section.number(
        "angular_radius_deg",
        "a number above 0 and below 90",
        below_90,
    )? {
        atmosphere.sun.angular_radius_rad = deg.to_radians();
    }
    if let Some(limb_darkening) = section.named("limb_darkening")? {
        atmosphere.sun.limb_darkening = limb_darkening;
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
        "mars" | "dust-storm" => presets::mars::MARS_PRESSURE_PA,
        "venus" => presets::venus::VENUS_PRESSURE_PA,
        "titan" => presets::titan::TITAN_PRESSURE_PA,
        _ => STANDARD_PRESSURE_PA,
    };
    match atmosphere
        .constituents
        .iter_mut()
        .find(|part| part.kind == ConstituentKind::Molecules)
    {
        Some(part) => {
            part.scattering_per_m = part
                .scattering_per_m
                .clone()
                .scaled(pressure_pa / base_pressure_pa);
        }
        None => atmosphere.put(gases::air(pressure_pa)),
    }
    Ok(())
}
