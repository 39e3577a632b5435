//! List of published aerosol types, and optical properties of one.

use crate::error::CliError;
use crate::report;
use airlight::Named;
use airlight::atmosphere::{AerosolMixture, AerosolType, AerosolTypeError};
use std::fmt::Write;

/// The types, one on each line.
pub fn list() -> String {
    let lines = report::named::<AerosolType>("  ");
    format!("\nTypes of haze, for --aerosol:\n{lines}")
}

/// Describes the optical properties of a type.
///
/// # Errors
/// [`CliError::Usage`] for invalid particles.
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
