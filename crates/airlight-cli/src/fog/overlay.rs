//! What lies over a picture: the fog of the options, the light it is in, the lamps in it.

use super::light::{self, Level, LightSource, Shown};
use super::{layers, lights};
use crate::args::{FogScatteringArg, ModelArg, OverlayArgs};
use crate::atmosphere::contrast;
use crate::error::CliError;
use airlight::atmosphere::Constituent;
use airlight::axes;
use airlight::fog::lights::{LightSettings, RgbLightSet};
use airlight::fog::visibility::extinction_per_m;
use airlight::fog::{DirectionalLight, FogLighting, Ground, RgbFog, RgbLayer, legacy};
use airlight::spectrum::{RgbSpace, Spectrum};
use airlight_render::overlay::{FogOverlay, FogSource};
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
        None => (
            alone(args, &rgb(&layers)?, shown.ambient.colour)?,
            shown.ambient,
        ),
    };
    let lights = lights_in_fog(args, &layers, &body, shown)?;
    Ok((FogOverlay::Fog(body, lights), level))
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
    layers: &[RgbLayer],
    ambient: Spectrum<3>,
) -> Result<FogSource, CliError> {
    let sun = args.sun_elevation.map(|elevation| DirectionalLight {
        direction: axes::direction(args.sun_azimuth, elevation),
        irradiance: (ambient * (PI * args.sun_strength as f32)).0,
    });
    let light = FogLighting {
        sun,
        ambient: ambient.0,
        ground_albedo: [args.ground_albedo.unwrap_or(GROUND_ALBEDO) as f32; 3],
    };
    RgbFog::new(layers, Ground::FLAT, &light, args.scattering.scattering())
        .map(FogSource::Alone)
        .map_err(|error| CliError::usage(error.to_string()))
}

/// Layers in red, green and blue.
fn rgb(layers: &[Constituent]) -> Result<Vec<RgbLayer>, CliError> {
    let layers = layers
        .iter()
        .map(|layer| RgbLayer::from_constituent(layer, RgbSpace::Srgb));
    layers
        .collect::<Result<_, _>>()
        .map_err(|error| CliError::usage(error.to_string()))
}

/// The lamps of the options in the fog.
fn lights_in_fog(
    args: &OverlayArgs,
    layers: &[Constituent],
    body: &FogSource,
    shown: &Shown<'_>,
) -> Result<Option<RgbLightSet>, CliError> {
    if args.light.lamp.is_empty() {
        return Ok(None);
    }
    let ground = match body {
        FogSource::Alone(_) => Ground::FLAT,
        FogSource::Sky { sky, .. } => *sky.ground(),
    };
    let lamps = lights::of(
        &args.light.lamp,
        shown.camera,
        shown.depth,
        args.eye_height_m,
    )?;
    let settings = LightSettings {
        form: args.light.lamp_form.form(),
        ..LightSettings::default()
    };
    RgbLightSet::new(lamps, &rgb(layers)?, ground, settings)
        .map(Some)
        .map_err(|error| CliError::usage(error.to_string()))
}
