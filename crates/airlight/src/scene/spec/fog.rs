//! Fog near the ground.

use crate::atmosphere::DensityProfile;
use crate::fog::FogScattering;
use crate::fog::droplets::DropletKind;
use crate::names::named;

/// Default scale height, m.
const SCALE_HEIGHT_M: f64 = 50.0;
/// Default height of the top of a slab, m.
const TOP_M: f64 = 50.0;

/// How fog thins with height, or which look it has.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
#[non_exhaustive]
pub enum FogProfile {
    /// The same everywhere: for pictures with depth, as no sky shines through it.
    Uniform,
    /// Thins exponentially from height 0 up, and is thicker below it.
    Height,
    /// The same up to the base height, thins exponentially above.
    Clamped,
    /// Thins exponentially from the base height up, and is as much thicker below it: Ishiyama's formula as printed.
    Unclamped,
    /// The same up to the top, nothing above.
    Slab,
    /// Exponential-squared, a look of pictures with depth.
    Exp2,
    /// Linear from 0 to the visibility, a look of pictures with depth.
    Linear,
    /// Uniform fog blended in encoded values, as the data set Foggy Cityscapes has it.
    FoggyCityscapes,
}

named! { FogProfile, "a fog profile", [
    ("uniform", (Uniform), "the same everywhere; for pictures with depth"),
    ("height", (Height), "decreases exponentially from height 0 up, and increases below"),
    ("clamped", (Clamped), "constant up to the base height, decreases exponentially above"),
    ("unclamped", (Unclamped), "decreases exponentially from the base height up and increases below it: the fog note's formula as printed"),
    ("slab", (Slab), "constant up to the top, zero above"),
    ("exp2", (Exp2), "exponential-squared fog of one colour; for pictures with depth"),
    ("linear", (Linear), "linear fog of one colour from 0 to the visibility; for pictures with depth"),
    ("foggy-cityscapes", (FoggyCityscapes), "uniform fog of one colour blended in encoded values, as in the data set Foggy Cityscapes; for pictures with depth"),
] }

/// Fog: one layer, and more of them in `layers`. Heights are above the ground.
#[derive(Clone, Debug, Default, PartialEq)]
#[cfg_attr(feature = "serde", derive(serde::Serialize, serde::Deserialize))]
#[cfg_attr(feature = "serde", serde(default, deny_unknown_fields))]
#[cfg_attr(feature = "schema", derive(schemars::JsonSchema))]
pub struct FogSpec {
    /// Distance at which the scene's contrast is left where the fog is thickest, m, above 0.
    pub visibility_m: Option<f64>,
    /// How it thins with height. Default: slab with `top_m`, else clamped.
    pub profile: Option<FogProfile>,
    /// Height over which it thins to 1/e, m, above 0. Default: 50.
    pub scale_height_m: Option<f64>,
    /// Height from which it thins, m. Default: 0.
    pub base_height_m: Option<f64>,
    /// Height of the top of a slab, m, above 0. Default: 50.
    pub top_m: Option<f64>,
    /// Droplets by name. Default: radiation.
    pub droplets: Option<DropletKind>,
    /// Which light it scatters: "all" orders, "single", or "undimmed", where the fog does not dim the sun. Default: all.
    pub scattering: Option<FogScattering>,
    /// More layers.
    #[cfg_attr(feature = "serde", serde(skip_serializing_if = "Vec::is_empty"))]
    pub layers: Vec<FogLayerSpec>,
}

/// A layer of fog. Heights are above the ground.
#[derive(Clone, Debug, Default, PartialEq)]
#[cfg_attr(feature = "serde", derive(serde::Serialize, serde::Deserialize))]
#[cfg_attr(feature = "serde", serde(default, deny_unknown_fields))]
#[cfg_attr(feature = "schema", derive(schemars::JsonSchema))]
pub struct FogLayerSpec {
    /// Distance at which the scene's contrast is left where the layer is thickest, m, above 0.
    pub visibility_m: Option<f64>,
    /// How it thins with height. Default: slab with `top_m`, else clamped.
    pub profile: Option<FogProfile>,
    /// Height over which it thins to 1/e, m, above 0. Default: 50.
    pub scale_height_m: Option<f64>,
    /// Height from which it thins, m. Default: 0.
    pub base_height_m: Option<f64>,
    /// Height of the top of a slab, m, above 0. Default: 50.
    pub top_m: Option<f64>,
    /// Droplets by name. Default: radiation.
    pub droplets: Option<DropletKind>,
}

impl FogSpec {
    /// The first layer without the others.
    pub fn first_layer(&self) -> FogLayerSpec {
        FogLayerSpec {
            visibility_m: self.visibility_m,
            profile: self.profile,
            scale_height_m: self.scale_height_m,
            base_height_m: self.base_height_m,
            top_m: self.top_m,
            droplets: self.droplets,
        }
    }

    /// All layers.
    pub(crate) fn all_layers(&self) -> impl Iterator<Item = FogLayerSpec> {
        std::iter::once(self.first_layer()).chain(self.layers.iter().cloned())
    }
}

impl FogLayerSpec {
    /// How it thins with height: as set, or as the heights that are set imply.
    pub fn implied_profile(&self) -> FogProfile {
        match (self.profile, self.top_m) {
            (Some(profile), _) => profile,
            (None, Some(_)) => FogProfile::Slab,
            (None, None) => FogProfile::Clamped,
        }
    }

    /// Density by height of the layer's profile; `None` for profiles without an upper end, which are for pictures with depth.
    pub fn density(&self) -> Option<DensityProfile> {
        let scale_height_m = self.scale_height_m.unwrap_or(SCALE_HEIGHT_M);
        let base_height_m = self.base_height_m.unwrap_or(0.0);
        Some(match self.implied_profile() {
            FogProfile::Height => DensityProfile::exponential(scale_height_m),
            FogProfile::Clamped => DensityProfile::Clamped {
                base_height_m,
                scale_height_m,
            },
            FogProfile::Unclamped => DensityProfile::Exponential {
                reference_height_m: base_height_m,
                scale_height_m,
            },
            FogProfile::Slab => DensityProfile::slab(self.top_m.unwrap_or(TOP_M)),
            FogProfile::Uniform
            | FogProfile::Exp2
            | FogProfile::Linear
            | FogProfile::FoggyCityscapes => return None,
        })
    }
}
