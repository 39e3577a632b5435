//! Fog near the ground.

use crate::atmosphere::DensityProfile;
use crate::fog::droplets::DropletKind;
use crate::fog::{FogPatches, FogScattering};
use crate::names::named;

/// Default scale height, m.
const SCALE_HEIGHT_M: f64 = 50.0;
/// Default height of the top of a slab, m.
const TOP_M: f64 = 50.0;

/// Density of fog by height, or a fog factor that is not physical.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
#[non_exhaustive]
pub enum FogProfile {
    /// Constant. For pictures with depth only, as it hides the sky.
    Uniform,
    /// Decreases exponentially from height 0 up, and increases below.
    Height,
    /// Constant up to the base height, decreases exponentially above.
    Clamped,
    /// Decreases exponentially from the base height up and increases below it: the fog note's formula as printed.
    Unclamped,
    /// Constant up to the top, zero above.
    Slab,
    /// Exponential-squared fog of one colour. For pictures with depth only.
    Exp2,
    /// Linear fog of one colour from 0 to the visibility. For pictures with depth only.
    Linear,
    /// Uniform fog of one colour blended in encoded values, as in the data set Foggy Cityscapes. For pictures with depth only.
    FoggyCityscapes,
}

named! { FogProfile, "a fog profile", [
    ("uniform", (Uniform), "constant; for pictures with depth"),
    ("height", (Height), "decreases exponentially from height 0 up, and increases below"),
    ("clamped", (Clamped), "constant up to the base height, decreases exponentially above"),
    ("unclamped", (Unclamped), "decreases exponentially from the base height up and increases below it: the fog note's formula as printed"),
    ("slab", (Slab), "constant up to the top, zero above"),
    ("exp2", (Exp2), "exponential-squared fog of one colour; for pictures with depth"),
    ("linear", (Linear), "linear fog of one colour from 0 to the visibility; for pictures with depth"),
    ("foggy-cityscapes", (FoggyCityscapes), "uniform fog of one colour blended in encoded values, as in the data set Foggy Cityscapes; for pictures with depth"),
] }

/// Fog: one layer, and further ones in `layers`. Heights are above the ground.
#[derive(Clone, Debug, Default, PartialEq)]
#[cfg_attr(feature = "serde", derive(serde::Serialize, serde::Deserialize))]
#[cfg_attr(feature = "serde", serde(default, deny_unknown_fields))]
#[cfg_attr(feature = "schema", derive(schemars::JsonSchema))]
pub struct FogSpec {
    /// Visibility where the fog is densest, m, above 0: the distance at which contrast falls to the scene's threshold.
    pub visibility_m: Option<f64>,
    /// Density by height. Default: slab with `top_m`, otherwise clamped.
    pub profile: Option<FogProfile>,
    /// Height over which the density falls by a factor e, m, above 0. Default: 50.
    pub scale_height_m: Option<f64>,
    /// Height from which the density decreases, m. Default: 0.
    pub base_height_m: Option<f64>,
    /// Height of the top of a slab, m, above 0. Default: 50.
    pub top_m: Option<f64>,
    /// Kind of droplets. Default: radiation.
    pub droplets: Option<DropletKind>,
    /// Orders of scattering: "all", "single", or "undimmed" for single scattering of unattenuated sunlight. Default: all.
    pub scattering: Option<FogScattering>,
    /// Patches: random variation of the density; even fog without them.
    pub patches: Option<FogPatchesSpec>,
    /// Further layers.
    #[cfg_attr(feature = "serde", serde(skip_serializing_if = "Vec::is_empty"))]
    pub layers: Vec<FogLayerSpec>,
}

/// A layer of fog. Heights are above the ground.
#[derive(Clone, Debug, Default, PartialEq)]
#[cfg_attr(feature = "serde", derive(serde::Serialize, serde::Deserialize))]
#[cfg_attr(feature = "serde", serde(default, deny_unknown_fields))]
#[cfg_attr(feature = "schema", derive(schemars::JsonSchema))]
pub struct FogLayerSpec {
    /// Visibility where the layer is densest, m, above 0: the distance at which contrast falls to the scene's threshold.
    pub visibility_m: Option<f64>,
    /// Density by height. Default: slab with `top_m`, otherwise clamped.
    pub profile: Option<FogProfile>,
    /// Height over which the density falls by a factor e, m, above 0. Default: 50.
    pub scale_height_m: Option<f64>,
    /// Height from which the density decreases, m. Default: 0.
    pub base_height_m: Option<f64>,
    /// Height of the top of a slab, m, above 0. Default: 50.
    pub top_m: Option<f64>,
    /// Kind of droplets. Default: radiation.
    pub droplets: Option<DropletKind>,
}

/// Patches in fog: a random factor on the density of all layers, with a mean of 1. The visibility is that of the mean extinction.
#[derive(Clone, Debug, Default, PartialEq)]
#[cfg_attr(feature = "serde", derive(serde::Serialize, serde::Deserialize))]
#[cfg_attr(feature = "serde", serde(default, deny_unknown_fields))]
#[cfg_attr(feature = "schema", derive(schemars::JsonSchema))]
pub struct FogPatchesSpec {
    /// Standard deviation of the density relative to its mean, 0 to 2. Default: 0.5.
    pub strength: Option<f64>,
    /// Width of a typical patch, m, above 0. Default: 30.
    pub size_m: Option<f64>,
    /// Height of a typical patch, m, above 0. Default: a third of `size_m`.
    pub height_m: Option<f64>,
    /// Seed of the patches, a whole number. Default: 0.
    pub seed: Option<u64>,
    /// Velocity of the wind that moves the patches, to the east and to the north, m/s. Default: [0, 0].
    pub wind_m_s: Option<[f64; 2]>,
    /// Time for which the wind has moved the patches, s; in a sequence, at its first picture. Default: 0.
    pub time_s: Option<f64>,
}

impl FogPatchesSpec {
    /// The same patches a time later, s.
    pub fn after(&self, elapsed_s: f64) -> Self {
        Self {
            time_s: Some(self.time_s.unwrap_or(0.0) + elapsed_s),
            ..self.clone()
        }
    }

    /// The patches, with defaults for what is not set.
    pub fn patches(&self) -> FogPatches {
        let usual = FogPatches::default();
        let size_m = self.size_m.unwrap_or(usual.size_m);
        let time_s = self.time_s.unwrap_or(0.0);
        FogPatches {
            strength: self.strength.unwrap_or(usual.strength),
            size_m,
            height_m: self.height_m.unwrap_or(size_m / 3.0),
            seed: self.seed.unwrap_or(usual.seed),
            drift_m: self.wind_m_s.unwrap_or_default().map(|v| v * time_s),
        }
    }
}

impl FogSpec {
    /// The first layer, without those in `layers`.
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

    /// All layers, the first included.
    pub(crate) fn all_layers(&self) -> impl Iterator<Item = FogLayerSpec> {
        std::iter::once(self.first_layer()).chain(self.layers.iter().cloned())
    }
}

impl FogLayerSpec {
    /// The profile that is set, or the one that the heights imply.
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
