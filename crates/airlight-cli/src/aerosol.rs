//! Haze of published types: `--aerosol`, `--humidity`, and what is told of them.

use crate::error::CliError;
use crate::report;
use airlight::atmosphere::aerosol_types::Ingredient;
use airlight::atmosphere::{AerosolMixture, AerosolType, AerosolTypeError};
use std::fmt::Write;

/// The help of `--aerosol`: every type with its description.
pub fn option_help() -> String {
    let names: String = AerosolType::ALL
        .iter()
        .map(|(name, _, what)| format!("\n- {name}: {what}"))
        .collect();
    format!(
        "Haze of a published type instead of the atmosphere's, or a mixture by shares of the extinction (urban:0.7,desert:0.3); without an amount as much as published\n{names}\n"
    )
}

/// What `--aerosol` and `--humidity` ask for.
///
/// # Errors
/// [`CliError::Usage`] for an unknown type, a share that is no positive number, a humidity out of range or one of
/// particles that take up no water.
pub fn mixture(types: &str, humidity: Option<f64>) -> Result<AerosolMixture, CliError> {
    let said = |error: AerosolTypeError| match error {
        AerosolTypeError::Humidity(_) => CliError::usage(format!("--humidity: {error}")),
        _ => CliError::usage(format!("--aerosol: {error}")),
    };
    let mut parts = Vec::new();
    for part in types.split(',') {
        let (name, share) = part.split_once(':').unwrap_or((part, "1"));
        let kind = AerosolType::named(name.trim()).map_err(said)?;
        let share = share.trim().parse().map_err(|_| {
            CliError::usage(format!(
                "--aerosol: the share of {name} must be a number above 0, got `{share}`"
            ))
        })?;
        parts.push((share, Ingredient::Type(kind)));
    }
    let mixture = AerosolMixture::new(parts, humidity.unwrap_or(AerosolMixture::USUAL_HUMIDITY));
    let mixture = mixture.map_err(said)?;
    match humidity.is_some() && !mixture.grows() {
        true => Err(CliError::usage(format!(
            "--humidity makes no difference to {types}, whose particles are those of ambient air: leave it out"
        ))),
        false => Ok(mixture),
    }
}

/// The types, one a line.
pub fn list() -> String {
    let width = AerosolType::ALL
        .map(|known| known.0.len())
        .into_iter()
        .max();
    let width = width.unwrap_or(0);
    let lines: String = AerosolType::ALL
        .iter()
        .map(|(name, _, what)| format!("  {name:width$}  {what}\n"))
        .collect();
    format!("\nTypes of haze, for --aerosol:\n{lines}")
}

/// What a type does to light.
///
/// # Errors
/// [`CliError::Usage`] where its particles are refused.
pub fn describe(kind: AerosolType) -> Result<String, CliError> {
    let said = |error: AerosolTypeError| CliError::usage(error.to_string());
    let mut text = format!("{}\n", kind.name());
    let moist = AerosolMixture::of(kind, AerosolMixture::USUAL_HUMIDITY).map_err(said)?;
    let humidities: &[f64] = match moist.grows() {
        true => &[0.0, 0.5, 0.8, 0.95],
        false => &[AerosolMixture::USUAL_HUMIDITY],
    };
    for &humidity in humidities {
        let mixture = AerosolMixture::of(kind, humidity).map_err(said)?;
        let bulk = mixture.summary().map_err(said)?;
        let depth = mixture.usual_optical_depth_550().map_err(said)?;
        let air = match moist.grows() {
            true => format!("humidity {humidity:4}"),
            false => "ambient air".to_owned(),
        };
        // Writing to a string cannot fail.
        let _ = writeln!(
            text,
            "  {air}  vertical optical depth {} at 550 nm, albedo {:.3}, mean cosine {:.3}, Angstrom exponent {:.2} (350-500 nm), {:.2} (500-800 nm)",
            report::short(depth),
            bulk.single_scattering_albedo,
            bulk.asymmetry,
            bulk.angstrom_350_500,
            bulk.angstrom_500_800,
        );
    }
    Ok(text)
}

#[cfg(test)]
mod tests {
    use super::*;

    fn refused(types: &str, humidity: Option<f64>) -> String {
        match mixture(types, humidity) {
            Err(CliError::Usage(text)) => text,
            other => panic!("{types}: {other:?}"),
        }
    }

    #[test]
    fn types_and_shares_are_read() {
        let alone = mixture("urban", None).unwrap();
        assert_eq!(alone, AerosolMixture::of(AerosolType::Urban, 0.8).unwrap());
        let two = mixture("urban:3, desert", Some(0.5)).unwrap();
        let parts = vec![
            (0.75, Ingredient::Type(AerosolType::Urban)),
            (0.25, Ingredient::Type(AerosolType::Desert)),
        ];
        assert_eq!(two, AerosolMixture::new(parts, 0.5).unwrap());
    }

    #[test]
    fn refusals_say_what_would_be_right() {
        assert!(refused("urbam", None).contains("did you mean \"urban\""));
        assert!(refused("biomass", None).contains("biomass-savanna"));
        assert!(refused("urban:x", None).contains("number above 0"));
        assert!(refused("urban:-1", None).contains("above 0"));
        assert!(refused("urban", Some(80.0)).contains("0.8 is 80 %"));
        assert!(refused("biomass-boreal", Some(0.5)).contains("leave it out"));
    }
}
