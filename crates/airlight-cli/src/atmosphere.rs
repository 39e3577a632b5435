//! Atmospheres by name, from files, and with what the options change.

use crate::aerosol;
use crate::args::{AirArgs, AtmospheresArgs};
use crate::error::CliError;
use crate::report;
use airlight::atmosphere::presets::earth::{EARTH_RADIUS_M, Earth};
use airlight::atmosphere::visibility::Contrast;
use airlight::atmosphere::{
    AerosolLoad, AerosolMixture, AerosolType, Atmosphere, Constituent, ConstituentKind, config,
    gases, preset, preset_names,
};
use airlight::spectrum::SpectralCurve;
use std::fmt::Write;
use std::path::Path;

/// The help of `--atmosphere`: every preset with its description.
pub fn option_help() -> String {
    let names: String = preset_names()
        .map(|(name, what)| format!("\n- {name}: {what}"))
        .collect();
    format!("The atmosphere: one of these names, or a TOML file\n{names}\n")
}

/// The atmosphere of a name or a file.
///
/// # Errors
/// [`CliError::Usage`] for an unknown name or a file that says something wrong, [`CliError::Failure`] for a file that
/// cannot be read.
pub fn named(name: &str) -> Result<Atmosphere, CliError> {
    let path = Path::new(name);
    let is_file = path
        .extension()
        .is_some_and(|e| e.eq_ignore_ascii_case("toml"))
        || name.contains(['/', '\\']);
    if !is_file {
        return preset(name).map_err(|error| {
            CliError::usage(format!("{error}; a file of your own must end in .toml"))
        });
    }
    let bytes = std::fs::read(path).map_err(|error| {
        CliError::failure(format!("cannot read the atmosphere `{name}`: {error}"))
    })?;
    let text = String::from_utf8(bytes).map_err(|error| {
        let at = error.utf8_error().valid_up_to();
        CliError::usage(format!(
            "the atmosphere `{name}` must be a text in UTF-8: it is not at byte {at}"
        ))
    })?;
    config::from_toml(&text)
        .map_err(|error| CliError::usage(format!("the atmosphere `{name}`, {error}")))
}

/// The atmosphere that the options ask for; `eye_altitude_m` is where the eye was asked to be.
///
/// # Errors
/// As [`named`], and [`CliError::Usage`] where an option does not fit the atmosphere.
pub fn build(args: &AirArgs, eye_altitude_m: f64) -> Result<Atmosphere, CliError> {
    let mut air = named(&args.atmosphere)?;
    air.planet.ground_altitude_m = args
        .ground_altitude_m
        .unwrap_or_else(|| air.planet.ground_altitude_m.min(eye_altitude_m));
    if let Some(albedo) = args.ground_albedo {
        air.planet.ground_albedo = SpectralCurve::Constant(albedo);
    }
    if let Some(column_du) = args.ozone_du {
        require_earth(&air, "--ozone-du")?;
        put(&mut air, gases::ozone(column_du));
    }
    match (&args.aerosol, haze(args)) {
        (Some(types), amount) => {
            set_type(&mut air, &aerosol::mixture(types, args.humidity)?, amount)?;
        }
        (None, Some((option, load))) => set_haze(&mut air, option, load)?,
        (None, None) => {}
    }
    air.validate()?;
    Ok(air)
}

/// Whether the planet is the Earth, by its size.
pub fn is_earth(air: &Atmosphere) -> bool {
    (air.planet.radius_m / EARTH_RADIUS_M - 1.0).abs() < 0.02
}

fn require_earth(air: &Atmosphere, option: &str) -> Result<(), CliError> {
    match is_earth(air) {
        true => Ok(()),
        false => Err(CliError::usage(format!(
            "{option} is for the Earth's air: describe what the atmosphere \"{}\" holds in a TOML file instead",
            air.name
        ))),
    }
}

/// The contrast that visibility means, of the option's two values.
pub fn contrast(option: &str) -> Contrast {
    match option {
        "0.02" => Contrast::TwoPercent,
        _ => Contrast::FivePercent,
    }
}

fn haze(args: &AirArgs) -> Option<(&'static str, AerosolLoad)> {
    let depth = args
        .aod_550
        .map(|depth| ("--aod-550", AerosolLoad::OpticalDepth550(depth)));
    let turbidity = args
        .turbidity
        .map(|ratio| ("--turbidity", AerosolLoad::Turbidity(ratio)));
    let visibility = args.visibility_m.map(|range_m| {
        (
            "--visibility-m",
            AerosolLoad::Visibility {
                range_m,
                contrast: contrast(&args.contrast),
            },
        )
    });
    depth.or(turbidity).or(visibility)
}

/// Replaces the haze by one of a type, as much of it as asked for or else as published.
fn set_type(
    air: &mut Atmosphere,
    mixture: &AerosolMixture,
    amount: Option<(&'static str, AerosolLoad)>,
) -> Result<(), CliError> {
    require_earth(air, "--aerosol")?;
    let (option, load) = amount.map_or(("--aerosol", None), |(option, load)| (option, Some(load)));
    let (ground, top) = (air.planet.ground_altitude_m, air.planet.top_altitude_m);
    let part = mixture
        .constituent(load, None, air.clear_air(), ground, top)
        .map_err(|error| CliError::usage(format!("{option}: {error}")))?;
    put(air, part);
    Ok(())
}

/// Scales the haze there is to the amount asked for, or adds a continental haze where there is none.
fn set_haze(air: &mut Atmosphere, option: &str, load: AerosolLoad) -> Result<(), CliError> {
    let (ground, top) = (air.planet.ground_altitude_m, air.planet.top_altitude_m);
    let said = |error: &dyn std::fmt::Display| CliError::usage(format!("{option}: {error}"));
    let old = air
        .constituent(&ConstituentKind::Aerosol)
        .filter(|old| old.optical_depth(ground, top, 550.0) > 0.0)
        .cloned();
    let part = match old {
        Some(old) => {
            let column_m = old.density.column_m(ground, top) / old.density.at(ground);
            let depth = load
                .optical_depth_550(air.clear_air(), column_m)
                .map_err(|e| said(&e))?;
            scaled(&old, depth / old.optical_depth(ground, top, 550.0))
        }
        None => {
            require_earth(air, option)?;
            let mut aerosol = Earth::with_aerosol(0.0).aerosol;
            aerosol.load = load;
            aerosol
                .constituent(air.clear_air(), ground, top)
                .map_err(|e| said(&e))?
        }
    };
    put(air, part);
    Ok(())
}

fn scaled(part: &Constituent, factor: f64) -> Constituent {
    Constituent {
        scattering_per_m: part.scattering_per_m.clone().scaled(factor),
        absorption_per_m: part.absorption_per_m.clone().scaled(factor),
        ..part.clone()
    }
}

/// Replaces the constituent of the same name, or adds one.
fn put(air: &mut Atmosphere, part: Constituent) {
    match air
        .constituents
        .iter_mut()
        .find(|old| old.kind == part.kind)
    {
        Some(old) => *old = part,
        None => air.constituents.push(part),
    }
}

/// Runs `airlight atmospheres`.
///
/// # Errors
/// As [`named`], and where standard output cannot be written.
pub fn list(args: &AtmospheresArgs) -> Result<(), CliError> {
    if let Some(name) = &args.atmosphere {
        if let Ok(kind) = AerosolType::named(name) {
            return report::print(&aerosol::describe(kind)?);
        }
        return report::print(&describe(&named(name)?));
    }
    let width = preset_names()
        .map(|(name, _)| name.len())
        .max()
        .unwrap_or(0);
    let lines: String = preset_names()
        .map(|(name, what)| format!("{name:width$}  {what}\n"))
        .collect();
    report::print(&(lines + &aerosol::list()))
}

/// What an atmosphere is made of.
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
    fn haze_comes_out_as_asked_on_every_planet() {
        for name in ["average", "mars", "bruneton", "reference-rayleigh"] {
            let mut air = named(name).unwrap();
            let asked = AerosolLoad::OpticalDepth550(0.4);
            set_haze(&mut air, "--aod-550", asked).unwrap();
            let depth = air
                .constituent(&ConstituentKind::Aerosol)
                .unwrap()
                .optical_depth(0.0, air.planet.top_altitude_m, 550.0);
            assert!((depth - 0.4).abs() < 1e-9, "{name}: {depth}");
        }
        let mut air = named("average").unwrap();
        let endless = AerosolLoad::Visibility {
            range_m: 1e9,
            contrast: Contrast::FivePercent,
        };
        assert!(set_haze(&mut air, "--visibility-m", endless).is_err());
        assert!(set_haze(&mut air, "--turbidity", AerosolLoad::Turbidity(0.5)).is_err());
    }

    #[test]
    fn types_come_out_as_asked() {
        let mut air = named("average").unwrap();
        let desert = aerosol::mixture("desert", None).unwrap();
        let asked = ("--aod-550", AerosolLoad::OpticalDepth550(0.4));
        set_type(&mut air, &desert, Some(asked)).unwrap();
        let depth = |air: &Atmosphere| {
            let part = air.constituent(&ConstituentKind::Aerosol).unwrap();
            part.optical_depth(0.0, air.planet.top_altitude_m, 550.0)
        };
        assert!((depth(&air) - 0.4).abs() < 1e-9);
        set_type(&mut air, &desert, None).unwrap();
        assert!((depth(&air) - 0.275).abs() < 2e-3, "{}", depth(&air));
        let wrong = Some(("--turbidity", AerosolLoad::Turbidity(0.5)));
        let refused = set_type(&mut air, &desert, wrong).unwrap_err();
        assert!(matches!(refused, CliError::Usage(s) if s.starts_with("--turbidity: ")));
        let mut mars = named("mars").unwrap();
        assert!(set_type(&mut mars, &desert, None).is_err());
    }

    #[test]
    fn names_and_files_are_told_apart() {
        assert!(matches!(named("claer"), Err(CliError::Usage(s)) if s.contains("\"clear\"")));
        assert!(matches!(named("no/such"), Err(CliError::Failure(_))));
        assert!(matches!(
            named("nothing-here.toml"),
            Err(CliError::Failure(_))
        ));
        assert!(is_earth(&named("hillaire").unwrap()) && !is_earth(&named("mars").unwrap()));
    }
}
