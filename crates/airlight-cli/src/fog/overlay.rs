//! What lies over a picture: the fog of the options, the light it is in, the lamps in it.

use super::light::{self, Level, LightSource, Shown};
use super::{layers, lights};
use crate::args::{FogScatteringArg, ModelArg, OverlayArgs};
use crate::atmosphere::contrast;
use crate::error::CliError;
use airlight::axes;
use airlight::fog::visibility::extinction_per_m;
use airlight::fog::{DirectionalLight, Fog, FogLighting, Ground, Layer, legacy};
use airlight::spectrum::Spectrum;
use airlight::spectrum::rgb::DOMINANT_NM;
use airlight_render::overlay::{FogOverlay, FogSource, LightGlow};
use std::f32::consts::PI;

/// Albedo of the ground where nothing is said.
const GROUND_ALBEDO: f64 = 0.2;

/// What lies over a picture, and how bright the light is in it.
///
/// # Errors
/// [`CliError::Usage`] for options that do not fit together, and for a fog or a lamp that is none.
pub fn overlay(
    args: &OverlayArgs,
    source: &LightSource<'_>,
    shown: &Shown<'_>,
) -> Result<(FogOverlay, Level), CliError> {
    let Some(layers) = layers::of(args)? else {
        refuse_with_looks(args)?;
        return Ok((look(args, shown.ambient.colour), shown.ambient));
    };
    let (body, level) = match source.foggy(&layers)? {
        Some(sky) => light::at_level(args, sky, shown)?,
        None => (alone(args, &layers, shown.ambient.colour)?, shown.ambient),
    };
    let light_glow = light_glow(args, &layers, &body, shown)?;
    Ok((FogOverlay::Fog(body, light_glow), level))
}

/// Looks have a colour, and nothing shines on them.
fn refuse_with_looks(args: &OverlayArgs) -> Result<(), CliError> {
    let given = [
        (!args.light.lamp.is_empty(), "--lamp"),
        (!args.light.layer.is_empty(), "--layer"),
        (args.light.sky_light, "--sky-light"),
        (args.scattering != FogScatteringArg::All, "--scattering"),
    ];
    match given.iter().find(|(given, _)| *given) {
        None => Ok(()),
        Some((_, option)) => Err(CliError::usage(format!(
            "{option} is for fog that scatters light: the looks exp2, linear and foggy-cityscapes are one colour; choose \
             --model uniform, height, clamped, unclamped or slab"
        ))),
    }
}

fn look(args: &OverlayArgs, ambient: Spectrum<3>) -> FogOverlay {
    let (visibility_m, contrast) = (args.visibility_m, contrast(&args.contrast));
    match args.model {
        ModelArg::Exp2 => {
            let density = legacy::exponential_squared_density_per_m(visibility_m, contrast.value());
            FogOverlay::ExponentialSquared(density, ambient)
        }
        ModelArg::Linear => FogOverlay::Linear(0.0, visibility_m, ambient),
        _ => FogOverlay::Encoded(extinction_per_m(visibility_m, contrast), ambient),
    }
}

/// Fog in ambient light, and in the sun's of the options.
fn alone(
    args: &OverlayArgs,
    layers: &[Layer<3>],
    ambient: Spectrum<3>,
) -> Result<FogSource, CliError> {
    let sun = args.sun_elevation.map(|elevation| DirectionalLight {
        direction: axes::direction(args.sun_azimuth, elevation),
        irradiance: ambient * (PI * args.sun_strength as f32),
    });
    let light = FogLighting {
        sun,
        ambient,
        ground_albedo: Spectrum::splat(args.ground_albedo.unwrap_or(GROUND_ALBEDO) as f32),
    };
    let fog = Fog::at_wavelengths_nm(
        layers,
        Ground::FLAT,
        light,
        args.scattering.scattering(),
        DOMINANT_NM,
    )
    .map_err(|error| CliError::usage(error.to_string()))?;
    Ok(FogSource::Alone(Box::new(fog)))
}

/// The lamps of the options in the fog.
fn light_glow(
    args: &OverlayArgs,
    layers: &[Layer<3>],
    body: &FogSource,
    shown: &Shown<'_>,
) -> Result<Option<LightGlow>, CliError> {
    if args.light.lamp.is_empty() {
        return Ok(None);
    }
    let ground = match body {
        FogSource::Alone(_) => Ground::FLAT,
        FogSource::Sky { sky, .. } => *sky.fog().ground(),
    };
    let lamps = lights::of(
        &args.light.lamp,
        shown.camera,
        shown.depth,
        args.eye_height_m,
    )?;
    LightGlow::new(lamps, layers, ground)
        .and_then(|light_glow| light_glow.by(args.light.lamp_form.form()))
        .map(Some)
        .map_err(|error| CliError::usage(error.to_string()))
}
