//! The layers of fog of the options.

use crate::args::{LayerShape, ModelArg, OverlayArgs};
use crate::atmosphere::contrast;
use airlight::fog::droplets::Droplets;
use airlight::fog::visibility::extinction_per_m;
use airlight::fog::{Layer, Profile};

/// The layer of the simple options, then those of `--layer`; nothing for a look, which is no layer.
pub fn of(args: &OverlayArgs) -> Option<Vec<Layer<3>>> {
    let scale_height_m = args.scale_height_m;
    let shape = match args.model {
        ModelArg::Uniform => LayerShape::Uniform,
        ModelArg::Height => LayerShape::Height { scale_height_m },
        ModelArg::Clamped => LayerShape::Clamped {
            base_m: args.base_height_m,
            scale_height_m,
        },
        ModelArg::Slab => LayerShape::Slab { top_m: args.top_m },
        ModelArg::Exp2 | ModelArg::Linear | ModelArg::FoggyCityscapes => return None,
    };
    let layer = |shape, visibility_m, droplets| Layer {
        profile: profile(shape),
        matter: Droplets::from(droplets)
            .matter(extinction_per_m(visibility_m, contrast(&args.contrast))),
    };
    let first = layer(shape, args.visibility_m, args.droplets);
    let more = args.light.layer.iter();
    let more = more.map(|more| layer(more.shape, more.visibility_m, more.droplets));
    Some(std::iter::once(first).chain(more).collect())
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
