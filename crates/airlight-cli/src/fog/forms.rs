//! What the forms that fog has been given in print go with.

use crate::args::{
    DropletsArg, FogScatteringArg, LightFormArg, LightKind, ModelArg, OverlayArgs, Variation,
};
use crate::error::CliError;
use airlight::fog::droplets::DropletKind;

/// Refuses forms where they do not hold, or do nothing.
///
/// # Errors
/// [`CliError::Usage`]: what would be right.
pub fn check(args: &OverlayArgs, random: bool) -> Result<(), CliError> {
    if random && args.scattering != FogScatteringArg::All {
        return Err(CliError::usage(
            "random paths scatter in fog as often as it happens: leave out --scattering, or --solver monte-carlo",
        ));
    }
    match args.light.lamp_form {
        LightFormArg::Exact => Ok(()),
        form => lamp_form(args, &crate::parse::name(&form)),
    }
}

/// The note's forms are for even fog that scatters equally in all directions.
fn lamp_form(args: &OverlayArgs, form: &str) -> Result<(), CliError> {
    let light = &args.light;
    let vary = &args.batch.vary;
    let (models, droplets) = ([args.model], [args.droplets]);
    let models = vary.iter().find_map(Variation::models).unwrap_or(&models);
    let droplets = vary
        .iter()
        .find_map(Variation::droplets)
        .unwrap_or(&droplets);
    let isotropic = DropletsArg(DropletKind::Isotropic);
    let right = if light.lamp.is_empty() {
        "there is no lamp: give --lamp as well"
    } else if models.iter().any(|model| *model != ModelArg::Uniform) || light.sky_light {
        "it holds in even fog: give --model uniform, without --sky-light"
    } else if !light.layer.is_empty() {
        "it holds in one layer of fog: leave out --layer"
    } else if droplets.iter().any(|kind| *kind != isotropic) {
        "it holds in fog that scatters equally in all directions: give --droplets isotropic"
    } else if light.lamp.iter().any(|lamp| lamp.kind != LightKind::Point) {
        "it holds for lamps that shine equally in all directions: give each --lamp kind=point"
    } else {
        return Ok(());
    };
    Err(CliError::usage(format!(
        "--lamp-form {form}: {right}, or leave out --lamp-form"
    )))
}
