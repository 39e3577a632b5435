//! The layers of fog of the options.

use crate::args::{DropletsArg, LayerShape, ModelArg, OverlayArgs};
use crate::atmosphere::contrast;
use crate::error::CliError;
use crate::foggy_air::FogInAir;
use airlight::atmosphere::{Constituent, DensityProfile};
use airlight::fog::visibility::extinction_per_m;
use airlight::spectrum::WavelengthGrid;

/// The layer of the simple options, then those of `--layer`; nothing for a look, which is no layer.
///
/// # Errors
/// [`CliError::Usage`] for drops that are refused.
pub fn of(args: &OverlayArgs) -> Result<Option<Vec<Constituent>>, CliError> {
    let Some(layers) = in_air(args) else {
        return Ok(None);
    };
    let grid = WavelengthGrid::standard();
    let layers = layers.iter().map(|fog| fog.layer(grid.wavelengths_nm()));
    layers.collect::<Result<_, _>>().map(Some)
}

/// The same before their optics are worked out.
pub fn in_air(args: &OverlayArgs) -> Option<Vec<FogInAir>> {
    let scale_height_m = args.scale_height_m;
    let shape = match args.model {
        ModelArg::Uniform => LayerShape::Uniform,
        ModelArg::Height => LayerShape::Height { scale_height_m },
        ModelArg::Clamped => LayerShape::Clamped {
            base_m: args.base_height_m,
            scale_height_m,
        },
        ModelArg::Unclamped => LayerShape::Unclamped {
            base_m: args.base_height_m,
            scale_height_m,
        },
        ModelArg::Slab => LayerShape::Slab { top_m: args.top_m },
        ModelArg::Exp2 | ModelArg::Linear | ModelArg::FoggyCityscapes => return None,
    };
    let layer = |shape, visibility_m, droplets: DropletsArg| FogInAir {
        profile: profile(shape),
        droplets: droplets.0,
        extinction_per_m: extinction_per_m(visibility_m, contrast(&args.contrast)),
    };
    let first = layer(shape, args.visibility_m, args.droplets);
    let more = args.light.layer.iter();
    let more = more.map(|more| layer(more.shape, more.visibility_m, more.droplets));
    Some(std::iter::once(first).chain(more).collect())
}

fn profile(shape: LayerShape) -> DensityProfile {
    match shape {
        LayerShape::Uniform => DensityProfile::Uniform,
        LayerShape::Height { scale_height_m } => DensityProfile::Exponential {
            reference_height_m: 0.0,
            scale_height_m,
        },
        LayerShape::Clamped {
            base_m,
            scale_height_m,
        } => DensityProfile::Clamped {
            base_height_m: base_m,
            scale_height_m,
        },
        LayerShape::Unclamped {
            base_m,
            scale_height_m,
        } => DensityProfile::Exponential {
            reference_height_m: base_m,
            scale_height_m,
        },
        LayerShape::Slab { top_m } => DensityProfile::slab(top_m),
    }
}
