//! What lies over a picture: the fog of the options, and the light it is in.

use crate::args::{ModelArg, OverlayArgs};
use crate::error::CliError;
use crate::parse;
use airlight::axes;
use airlight::fog::droplets::Droplets;
use airlight::fog::visibility::extinction_per_m;
use airlight::fog::{Fog, Ground, Layer, Light, Profile, Scattering, Sun, legacy};
use airlight::spectrum::Spectrum;
use airlight_render::input::{DepthMap, Picture};
use airlight_render::overlay::{Ambient, Veil, estimate_ambient};
use std::f32::consts::PI;

/// The ambient light, and where it is from.
///
/// # Errors
/// [`CliError::Usage`] where the option does not say a colour.
pub fn ambient(
    args: &OverlayArgs,
    picture: &Picture,
    depth: &DepthMap,
) -> Result<(Spectrum<3>, &'static str), CliError> {
    if args.ambient != "auto" {
        let given = parse::three_numbers(&args.ambient)
            .map_err(|right| CliError::usage(format!("--ambient {right}, or auto")))?;
        return Ok((Spectrum(given.map(|v| v as f32)), "as given"));
    }
    let (colour, how) = estimate_ambient(picture, depth);
    let how = match how {
        Ambient::Sky => "from the sky of the picture",
        Ambient::DarkChannel => "from the picture's dark channel",
    };
    Ok((colour, how))
}

/// The fog of the options, in this ambient light.
///
/// # Errors
/// [`CliError::Usage`] for a fog that is none.
pub fn veil(args: &OverlayArgs, ambient: Spectrum<3>) -> Result<Veil, CliError> {
    let contrast = args.contrast();
    let extinction = extinction_per_m(args.visibility_m, contrast);
    let profile = match args.model {
        ModelArg::Uniform => Profile::Uniform,
        ModelArg::Height => Profile::Exponential {
            reference_height_m: 0.0,
            scale_height_m: args.scale_height_m,
        },
        ModelArg::Clamped => Profile::Clamped {
            base_height_m: args.base_height_m,
            scale_height_m: args.scale_height_m,
        },
        ModelArg::Slab => Profile::Slab {
            top_height_m: args.top_m,
        },
        ModelArg::Exp2 => {
            let density =
                legacy::exponential_squared_density_per_m(args.visibility_m, contrast.value());
            return Ok(Veil::ExponentialSquared(density, ambient));
        }
        ModelArg::Linear => return Ok(Veil::Linear(0.0, args.visibility_m, ambient)),
        ModelArg::FoggyCityscapes => return Ok(Veil::Encoded(extinction, ambient)),
    };
    let sun = args.sun_elevation.map(|elevation| Sun {
        direction: axes::direction(args.sun_azimuth, elevation),
        irradiance: ambient * (PI * args.sun_strength as f32),
    });
    let light = Light {
        sun,
        ambient,
        ground_albedo: Spectrum::splat(args.ground_albedo as f32),
    };
    let matter = Droplets::from(args.droplets).matter(extinction);
    let layers = [Layer { profile, matter }];
    let fog = Fog::new(&layers, Ground::FLAT, light, Scattering::Multiple)
        .map_err(|error| CliError::usage(error.to_string()))?;
    Ok(Veil::Fog(Box::new(fog)))
}
