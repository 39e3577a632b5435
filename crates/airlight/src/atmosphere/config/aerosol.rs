//! The section `[aerosol]`.

use super::error::{ConfigError, ConfigProblem};
use super::parts;
use super::reader::Section;
use crate::atmosphere::aerosol::{AerosolLoad, AngstromAerosol, continental_phase};
use crate::atmosphere::presets::earth;
use crate::atmosphere::visibility::Contrast;
use crate::atmosphere::{AerosolMixture, AerosolType, AerosolTypeError, Ingredient};
use crate::atmosphere::{Atmosphere, Constituent, ConstituentKind, DensityProfile};
use crate::spectrum::SpectralCurve;

/// Changes or adds the aerosol of an atmosphere.
pub(super) fn aerosol(
    section: &Section<'_>,
    atmosphere: &mut Atmosphere,
) -> Result<(), ConfigError> {
    section.check_keys(&[
        "type",
        "mixture",
        "relative_humidity",
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
    match section.has("type") || section.has("mixture") {
        true => published_type(section, atmosphere),
        false if section.has("relative_humidity") => Err(section.error(
            "relative_humidity",
            ConfigProblem::Needs {
                with: "type or mixture",
            },
        )),
        false => angstrom(section, atmosphere),
    }
}

/// The load, with its key.
fn load(section: &Section<'_>) -> Result<Option<(&'static str, AerosolLoad)>, ConfigError> {
    let contrast = section.number("contrast", "0.05 or 0.02", |c| c == 0.05 || c == 0.02)?;
    let contrast = match contrast {
        Some(0.02) => Contrast::TwoPercent,
        _ => Contrast::FivePercent,
    };
    let mut load = None;
    for key in ["aod_550", "turbidity", "visibility_m"] {
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
    Ok(load)
}

/// The density profile, if given.
fn density(section: &Section<'_>) -> Result<Option<DensityProfile>, ConfigError> {
    match (
        section.positive("scale_height_m")?,
        parts::density(section, "density")?,
    ) {
        (Some(_), Some(_)) => {
            let with = "scale_height_m";
            Err(section.error("density", ConfigProblem::Conflict { with }))
        }
        (Some(scale_height_m), None) => Ok(Some(DensityProfile::exponential(scale_height_m))),
        (None, given) => Ok(given),
    }
}

/// Sets an aerosol of a published type, or a mixture.
fn published_type(section: &Section<'_>, atmosphere: &mut Atmosphere) -> Result<(), ConfigError> {
    let (own, other) = match section.has("type") {
        true => ("type", "mixture"),
        false => ("mixture", "type"),
    };
    for key in [
        other,
        "angstrom_exponent",
        "single_scattering_albedo",
        "phase",
    ] {
        if section.has(key) {
            return Err(section.error(key, ConfigProblem::Conflict { with: own }));
        }
    }
    let humidity = section.number("relative_humidity", "a number from 0 to 0.99", |h| {
        (0.0..=0.99).contains(&h)
    })?;
    let parts = match own {
        "type" => vec![(1.0, Ingredient::Type(named_type(section)?))],
        _ => mixture_parts(section)?,
    };
    let report = |error| {
        let key = match error {
            AerosolTypeError::Aerosol(_) => load(section).ok().flatten().map_or(own, |load| load.0),
            _ => own,
        };
        section.error(key, ConfigProblem::AerosolType(error))
    };
    let mixture = AerosolMixture::new(parts, humidity.unwrap_or(AerosolMixture::USUAL_HUMIDITY))
        .map_err(report)?;
    if humidity.is_some() && !mixture.grows() {
        return Err(section.error("relative_humidity", ConfigProblem::Dry));
    }
    let part = mixture.constituent(
        load(section)?.map(|load| load.1),
        density(section)?,
        atmosphere.clear_air(),
        atmosphere.planet.ground_altitude_m,
        atmosphere.planet.top_altitude_m,
    );
    atmosphere.put(part.map_err(report)?);
    Ok(())
}

fn named_type(section: &Section<'_>) -> Result<AerosolType, ConfigError> {
    section
        .named("type")?
        .ok_or_else(|| section.missing("type", "the name of an aerosol type"))
}

/// Parts of a mixture with their shares.
fn mixture_parts(section: &Section<'_>) -> Result<Vec<(f64, Ingredient)>, ConfigError> {
    let mut parts = Vec::new();
    for part in section.sections("mixture")? {
        part.check_keys(&["type", "component", "share"])?;
        let share = part
            .positive("share")?
            .ok_or_else(|| part.missing("share", "the share of the extinction at 550 nm"))?;
        let ingredient = match (part.has("type"), part.named("component")?) {
            (true, Some(_)) => {
                return Err(part.error("component", ConfigProblem::Conflict { with: "type" }));
            }
            (false, Some(component)) => Ingredient::Component(component),
            (_, None) => Ingredient::Type(named_type(&part)?),
        };
        parts.push((share, ingredient));
    }
    Ok(parts)
}

/// Sets an aerosol whose extinction follows Angstrom's law; values not given are those of the base.
fn angstrom(section: &Section<'_>, atmosphere: &mut Atmosphere) -> Result<(), ConfigError> {
    let (ground, top) = (
        atmosphere.planet.ground_altitude_m,
        atmosphere.planet.top_altitude_m,
    );
    let old = atmosphere.constituent(&ConstituentKind::Aerosol).cloned();
    let old_depth = old
        .as_ref()
        .map_or(0.0, |part| part.optical_depth(ground, top, 550.0));
    let load = load(section)?;
    let exponent = section.number("angstrom_exponent", "a number from -4 to 8", |x| {
        (-4.0..=8.0).contains(&x)
    })?;
    let albedo = parts::spectrum(section, "single_scattering_albedo", 1.0)?;
    let density = density(section)?;
    let phase = parts::phase(section, "phase", old.as_ref().map(|part| &part.phase))?;
    if old.is_none() && load.is_none() {
        return Err(section.missing(
            "aod_550",
            "aod_550, turbidity or visibility_m, as the base has no aerosol",
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
    // If only amount, density or phase function change, keep the spectra of the base, scaled.
    if let (Some(old), None, None) = (old, exponent, albedo) {
        let factor = part.extinction_per_m(550.0) / old.extinction_per_m(550.0);
        if factor.is_finite() {
            part.scattering_per_m = old.scattering_per_m.scaled(factor);
            part.absorption_per_m = old.absorption_per_m.scaled(factor);
        }
    }
    atmosphere.put(part);
    Ok(())
}

/// Angstrom exponent of a constituent's extinction between 440 and 880 nm.
fn exponent_of(part: &Constituent) -> Option<f64> {
    let ratio = part.extinction_per_m(440.0) / part.extinction_per_m(880.0);
    (ratio.is_finite() && ratio > 0.0).then(|| ratio.log2())
}

/// The single-scattering albedo of a constituent: a constant if possible, otherwise sampled every 2 nm.
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
