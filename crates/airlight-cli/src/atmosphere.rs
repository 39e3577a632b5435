//! `airlight atmospheres`: list of atmospheres, and description of one.

use crate::aerosol;
use crate::args::AtmospheresArgs;
use crate::error::CliError;
use crate::report;
use airlight::atmosphere::{AerosolType, Atmosphere, Preset};
use airlight::scene::Scene;
use airlight_render::scene_file;
use std::fmt::Write;
use std::path::Path;

/// The atmosphere with a name or in a file.
fn named(name: &str) -> Result<Atmosphere, CliError> {
    let mut scene = Scene::default();
    scene.air.atmosphere = Some(name.to_owned());
    scene_file::inline_files(&mut scene, Path::new(""))?;
    scene
        .air
        .named_atmosphere()
        .map_err(|error| match error.into() {
            // The name is an argument here.
            CliError::Usage(sentence) => {
                CliError::Usage(sentence.replacen("--atmosphere", "NAME", 1))
            }
            error => error,
        })
}

/// Runs `airlight atmospheres`.
///
/// # Errors
/// [`CliError`] for an unknown name, an invalid file, and if standard output cannot be written.
pub fn list(args: &AtmospheresArgs) -> Result<(), CliError> {
    if let Some(name) = &args.atmosphere {
        if let Ok(kind) = name.parse::<AerosolType>() {
            return report::print(&aerosol::describe(kind)?);
        }
        return report::print(&describe(&named(name)?));
    }
    report::print(&(report::named::<Preset>("") + &aerosol::list()))
}

/// Describes planet, sun and constituents of an atmosphere.
fn describe(air: &Atmosphere) -> String {
    let planet = &air.planet;
    let (ground, top) = (planet.ground_altitude_m, planet.top_altitude_m);
    let mut text = format!(
        "{}\n  planet        radius {} km, air up to {} km, ground albedo {} at 550 nm\n  sun           {} W m^-2 nm^-1 at 550 nm, {} degrees across\n",
        air.name,
        report::short(planet.radius_m / 1e3),
        report::short(top / 1e3),
        report::short(planet.ground_albedo.at(550.0)),
        report::short(air.solar_irradiance.at(550.0)),
        report::short(2.0 * air.sun.angular_radius_rad.to_degrees()),
    );
    for part in &air.constituents {
        let depth = part.optical_depth(ground, top, 550.0);
        let extinction = part.extinction_per_m(550.0);
        let albedo = if extinction > 0.0 {
            part.scattering_per_m.at(550.0) / extinction
        } else {
            0.0
        };
        // Writing to a string cannot fail.
        let _ = writeln!(
            text,
            "  {:13} vertical optical depth {} at 550 nm, of which scattering {}",
            part.kind.name(),
            report::short(depth),
            report::short(depth * albedo)
        );
    }
    text
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn names_are_distinguished_from_files() {
        assert!(matches!(named("claer"), Err(CliError::Usage(s)) if s.contains("\"clear\"")));
        assert!(matches!(named("no/such"), Err(CliError::Failure(_))));
        assert!(matches!(
            named("nothing-here.toml"),
            Err(CliError::Failure(_))
        ));
    }
}
