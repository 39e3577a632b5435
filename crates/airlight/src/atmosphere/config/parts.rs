//! Spectra, density profiles, phase functions and constituents in TOML.

use super::error::{ConfigError, ConfigProblem};
use super::reader::Section;
use crate::atmosphere::aerosol::continental_phase;
use crate::atmosphere::{Constituent, DensityProfile, Interpolation};
use crate::optics::{Depolarization, PhaseFunction, TabulatedPhase};
use crate::spectrum::SpectralCurve;

/// A spectrum with values in `[0, most]`.
pub(super) fn spectrum(
    section: &Section<'_>,
    key: &str,
    most: f64,
) -> Result<Option<SpectralCurve>, ConfigError> {
    let expected = match most == 1.0 {
        true => "values in [0, 1]",
        false => "finite values not below 0",
    };
    let allowed = |x: f64| x.is_finite() && x >= 0.0 && x <= most;
    if !section.has(key) {
        return Ok(None);
    }
    if !section.is_section(key) {
        return Ok(section
            .number(key, expected, allowed)?
            .map(SpectralCurve::Constant));
    }
    let Some(inner) = section.section(key)? else {
        return Ok(None);
    };
    inner.check_keys(&["wavelengths_nm", "values", "at_550_nm", "angstrom_exponent"])?;
    let table = inner.has("wavelengths_nm") || inner.has("values");
    if table && inner.has("at_550_nm") {
        return Err(inner.error("at_550_nm", ConfigProblem::Conflict { with: "values" }));
    }
    if !table {
        let value = inner.number("at_550_nm", expected, allowed)?;
        let exponent = inner.number("angstrom_exponent", "a number from -8 to 8", |x| {
            x.abs() <= 8.0
        })?;
        return Ok(Some(SpectralCurve::PowerLaw {
            value_at_550_nm: value
                .ok_or_else(|| inner.missing("at_550_nm", "the value at 550 nm"))?,
            exponent: exponent.unwrap_or(0.0),
        }));
    }
    let (wavelengths, values) = (
        inner.required_numbers("wavelengths_nm")?,
        inner.required_numbers("values")?,
    );
    if let Some(&got) = values.iter().find(|&&x| !allowed(x)) {
        return Err(inner.error("values", ConfigProblem::OutOfRange { expected, got }));
    }
    SpectralCurve::table(wavelengths, values)
        .map(Some)
        .map_err(|error| inner.error("wavelengths_nm", ConfigProblem::Curve(error)))
}

/// A density profile.
pub(super) fn density(
    section: &Section<'_>,
    key: &str,
) -> Result<Option<DensityProfile>, ConfigError> {
    let Some(inner) = section.section(key)? else {
        return Ok(None);
    };
    let kinds = [
        "uniform",
        "exponential",
        "clamped",
        "layer",
        "tent",
        "standard-air",
        "table",
    ];
    let kind = inner.text("kind")?.ok_or_else(|| {
        inner.missing(
            "kind",
            "one of uniform, exponential, clamped, layer, tent, standard-air, table",
        )
    })?;
    let profile = match kind {
        "uniform" => {
            inner.check_keys(&["kind"])?;
            DensityProfile::Uniform
        }
        "exponential" => {
            inner.check_keys(&["kind", "scale_height_m", "reference_height_m"])?;
            DensityProfile::Exponential {
                scale_height_m: inner.required("scale_height_m")?,
                reference_height_m: inner.finite("reference_height_m")?.unwrap_or(0.0),
            }
        }
        "clamped" => {
            inner.check_keys(&["kind", "base_height_m", "scale_height_m"])?;
            DensityProfile::Clamped {
                base_height_m: inner.required("base_height_m")?,
                scale_height_m: inner.required("scale_height_m")?,
            }
        }
        "layer" => {
            inner.check_keys(&["kind", "bottom_m", "top_m"])?;
            DensityProfile::Layer {
                bottom_m: inner.finite("bottom_m")?.unwrap_or(f64::NEG_INFINITY),
                top_m: inner.required("top_m")?,
            }
        }
        "tent" => {
            inner.check_keys(&["kind", "bottom_m", "peak_m", "top_m"])?;
            DensityProfile::Tent {
                bottom_m: inner.required("bottom_m")?,
                peak_m: inner.required("peak_m")?,
                top_m: inner.required("top_m")?,
            }
        }
        "standard-air" => {
            inner.check_keys(&["kind"])?;
            DensityProfile::StandardAir1976
        }
        "table" => {
            inner.check_keys(&["kind", "altitudes_m", "densities", "interpolation"])?;
            let interpolation = inner
                .named("interpolation")?
                .unwrap_or(Interpolation::Linear);
            let (altitudes, densities) = (
                inner.required_numbers("altitudes_m")?,
                inner.required_numbers("densities")?,
            );
            DensityProfile::tabulated(altitudes, densities, interpolation)
                .map_err(|error| inner.error("altitudes_m", ConfigProblem::Density(error)))?
        }
        other => return Err(inner.unknown("kind", "a density", other, kinds.to_vec())),
    };
    match profile.validate() {
        Ok(()) => Ok(Some(profile)),
        Err(error) => Err(section.error(key, ConfigProblem::Density(error))),
    }
}

/// A phase function. Parameters without a kind replace those of `old`.
pub(super) fn phase(
    section: &Section<'_>,
    key: &str,
    old: Option<&PhaseFunction>,
) -> Result<Option<PhaseFunction>, ConfigError> {
    section
        .section(key)?
        .map(|inner| phase_of(&inner, old, &[]))
        .transpose()
}

fn phase_of(
    inner: &Section<'_>,
    old: Option<&PhaseFunction>,
    also: &[&str],
) -> Result<PhaseFunction, ConfigError> {
    let kinds = vec![
        "isotropic",
        "rayleigh",
        "henyey-greenstein",
        "cornette-shanks",
        "draine",
        "continental",
        "mixture",
        "table",
    ];
    let kind = match inner.text("kind")? {
        Some(kind) => kind,
        None => old.and_then(kind_of).ok_or_else(|| {
            inner.missing(
                "kind",
                "one of isotropic, rayleigh, henyey-greenstein, cornette-shanks, draine, continental, mixture, table",
            )
        })?,
    };
    let keys = |own: &[&'static str]| inner.check_keys(&[&["kind"], own, also].concat());
    let (old_g, old_alpha) = match old {
        Some(PhaseFunction::HenyeyGreenstein { g } | PhaseFunction::CornetteShanks { g }) => {
            (Some(*g), None)
        }
        Some(PhaseFunction::Draine { g, alpha }) => (Some(*g), Some(*alpha)),
        _ => (None, None),
    };
    let g = || {
        let given = inner.number("g", "a number strictly between -1 and 1", |g| g.abs() < 1.0)?;
        given
            .or(old_g)
            .ok_or_else(|| inner.missing("g", "an asymmetry parameter strictly between -1 and 1"))
    };
    let built = match kind {
        "isotropic" => {
            keys(&[])?;
            Ok(PhaseFunction::Isotropic)
        }
        "rayleigh" => {
            keys(&["depolarization_ratio"])?;
            let ratio = inner.number("depolarization_ratio", "a number in [0, 6/7)", |x| {
                (0.0..6.0 / 7.0).contains(&x)
            })?;
            Ok(PhaseFunction::Rayleigh(
                ratio.map_or(Depolarization::Air, Depolarization::Factor),
            ))
        }
        "henyey-greenstein" => {
            keys(&["g"])?;
            PhaseFunction::henyey_greenstein(g()?)
        }
        "cornette-shanks" => {
            keys(&["g"])?;
            PhaseFunction::cornette_shanks(g()?)
        }
        "draine" => {
            keys(&["g", "alpha"])?;
            let alpha = inner.not_negative("alpha")?.or(old_alpha);
            PhaseFunction::draine(
                g()?,
                alpha.ok_or_else(|| inner.missing("alpha", "a number not below 0"))?,
            )
        }
        "continental" => {
            keys(&[])?;
            Ok(continental_phase())
        }
        "mixture" => {
            keys(&["parts"])?;
            let mut parts = Vec::new();
            for part in inner.sections("parts")? {
                // A nested mixture can always be written as a flat one.
                if part.text("kind")? == Some("mixture") {
                    let flat = kinds
                        .into_iter()
                        .filter(|kind| *kind != "mixture")
                        .collect();
                    return Err(part.unknown("kind", "a part of a mixture", "mixture", flat));
                }
                parts.push((
                    part.required("weight")?,
                    phase_of(&part, None, &["weight"])?,
                ));
            }
            PhaseFunction::mixture(parts)
        }
        "table" => {
            keys(&["angles_deg", "wavelengths_nm", "values"])?;
            let wavelengths = inner
                .numbers("wavelengths_nm")?
                .unwrap_or_else(|| vec![550.0]);
            let (angles, values) = (
                inner.required_numbers("angles_deg")?,
                inner.required_numbers("values")?,
            );
            TabulatedPhase::new(angles, wavelengths, values).map(PhaseFunction::Tabulated)
        }
        other => return Err(inner.unknown("kind", "a phase function", other, kinds)),
    };
    built.map_err(|error| inner.error("kind", ConfigProblem::Phase(error)))
}

/// A constituent.
pub(super) fn constituent(section: &Section<'_>) -> Result<Constituent, ConfigError> {
    section.check_keys(&[
        "name",
        "density",
        "scattering_per_m",
        "absorption_per_m",
        "phase",
    ])?;
    let name = section
        .text("name")?
        .ok_or_else(|| section.missing("name", "the name of the constituent"))?;
    let scattering = spectrum(section, "scattering_per_m", f64::INFINITY)?;
    let absorption = spectrum(section, "absorption_per_m", f64::INFINITY)?;
    if scattering.is_none() && absorption.is_none() {
        return Err(section.missing(
            "scattering_per_m",
            "scattering_per_m, absorption_per_m or both",
        ));
    }
    let phase = phase(section, "phase", None)?;
    if scattering.is_some() && phase.is_none() {
        return Err(section.missing("phase", "a phase function for the scattering"));
    }
    Ok(Constituent {
        kind: name.into(),
        density: density(section, "density")?
            .ok_or_else(|| section.missing("density", "a density profile"))?,
        scattering_per_m: scattering.unwrap_or(SpectralCurve::Constant(0.0)),
        absorption_per_m: absorption.unwrap_or(SpectralCurve::Constant(0.0)),
        phase: phase.unwrap_or(PhaseFunction::Isotropic),
    })
}

/// The kind to which phase parameters without a kind refer.
fn kind_of(phase: &PhaseFunction) -> Option<&'static str> {
    match phase {
        PhaseFunction::HenyeyGreenstein { .. } => Some("henyey-greenstein"),
        PhaseFunction::CornetteShanks { .. } => Some("cornette-shanks"),
        PhaseFunction::Draine { .. } => Some("draine"),
        _ => None,
    }
}
