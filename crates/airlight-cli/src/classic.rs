//! Published models of the sky, made from the options.

use crate::args::{AirArgs, ClassicArgs, SolverArg, VariantArg};
use crate::error::CliError;
use crate::scene::{Scene, Sun};
use airlight::classic::ClassicSky;
use airlight::classic::klassen1987::{Klassen1987, Klassen1987Error, Klassen1987Settings};
use std::sync::Arc;

/// The model asked for, under a sun.
///
/// # Errors
/// [`CliError::Usage`] for what the model refuses.
pub fn model(
    air: &AirArgs,
    args: &ClassicArgs,
    scene: &Scene,
    sun: &Sun,
) -> Result<Arc<dyn ClassicSky>, CliError> {
    let direction = sun.direction();
    Ok(match air.solver {
        SolverArg::Klassen1987 => {
            let refuse =
                |error: Klassen1987Error| CliError::usage(format!("--solver klassen1987: {error}"));
            let settings = klassen(args, scene, sun)?;
            Arc::new(Klassen1987::new(&settings, direction).map_err(refuse)?)
        }
        SolverArg::Orders | SolverArg::MonteCarlo => {
            return Err(CliError::failure("this solver is no published model"));
        }
    })
}

/// Bits that the model of 1987 remembers colours for: files may hold more than 8, and are exposed later.
const BITS: u32 = 12;
/// How far above the ground an eye may be whose height a model leaves out, m.
const ON_THE_GROUND_M: f64 = 100.0;

/// The layers of 1987 that stand for the scene's air, with what the options change.
fn klassen(args: &ClassicArgs, scene: &Scene, sun: &Sun) -> Result<Klassen1987Settings, CliError> {
    if scene.eye_altitude_m > scene.atmosphere.planet.ground_altitude_m + ON_THE_GROUND_M {
        return Err(CliError::usage(
            "--solver klassen1987 looks from the ground: leave out --altitude-m and --eye-height-m",
        ));
    }
    let mut settings = Klassen1987Settings {
        bits_per_channel: BITS,
        ..Klassen1987Settings::of(&scene.atmosphere)
    };
    let air = &mut settings.clear_air;
    let ratio = sun.distance_ratio;
    air.solar_irradiance = air.solar_irradiance.clone().scaled(1.0 / (ratio * ratio));
    air.sun.angular_radius_rad = (air.sun.angular_radius_rad.sin() / ratio).asin();
    if args.variant == Some(VariantArg::Printed) {
        settings = settings.printed();
    }
    args.klassen.apply(&mut settings);
    Ok(settings)
}
