//! The layers of fog of the options.

use crate::args::{DropletsArg, LayerShape, ModelArg, OverlayArgs};
use crate::atmosphere::contrast;
use crate::error::CliError;
use airlight::fog::visibility::extinction_per_m;
use airlight::fog::{Layer, Profile};
use airlight::spectrum::RgbSpace;

/// The layer of the simple options, then those of `--layer`; nothing for a look, which is no layer.
///
/// # Errors
/// [`CliError::Usage`] for drops that are none.
pub fn of(args: &OverlayArgs) -> Result<Option<Vec<Layer<3>>>, CliError> {
    let scale_height_m = args.scale_height_m;
    let shape = match args.model {
        ModelArg::Uniform => LayerShape::Uniform,
        ModelArg::Height => LayerShape::Height { scale_height_m },
        ModelArg::Clamped => LayerShape::Clamped {
            base_m: args.base_height_m,
            scale_height_m,
        },
        ModelArg::Slab => LayerShape::Slab { top_m: args.top_m },
        ModelArg::Exp2 | ModelArg::Linear | ModelArg::FoggyCityscapes => return Ok(None),
    };
    let layer = |shape, visibility_m, droplets: DropletsArg| -> Result<Layer<3>, CliError> {
        let extinction = extinction_per_m(visibility_m, contrast(&args.contrast));
        Ok(Layer {
            profile: profile(shape),
            matter: droplets.0.in_rgb(extinction, RgbSpace::Srgb)?,
        })
    };
    let first = layer(shape, args.visibility_m, args.droplets);
    let more = args.light.layer.iter();
    let more = more.map(|more| layer(more.shape, more.visibility_m, more.droplets));
    let all: Result<Vec<_>, _> = std::iter::once(first).chain(more).collect();
    all.map(Some)
}

fn profile(shape: LayerShape) -> Profile {
    match shape {
        LayerShape::Uniform => Profile::Uniform,
        LayerShape::Height { scale_height_m } => Profile::Exponential {
            reference_height_m: 0.0,
            scale_height_m,
        },
        LayerShape::Clamped {
            base_m,
            scale_height_m,
        } => Profile::Clamped {
            base_height_m: base_m,
            scale_height_m,
        },
        LayerShape::Slab { top_m } => Profile::Slab {
            top_height_m: top_m,
        },
    }
}
