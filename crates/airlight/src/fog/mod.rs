//! Fog: transmittance and path radiance, in closed form and with multiple scattering.
//!
//! A layer of fog is a [`Constituent`](crate::atmosphere::Constituent) of the air
//! ([`Constituent::fog`](crate::atmosphere::Constituent::fog)) with any [`DensityProfile`]; for real-time use there is
//! [`RgbLayer`], with coefficients in red, green and blue. Fog is lit by sun and sky ([`FogLighting`]) and by [`lights`].
//!
//! - [`Fog`], [`RgbFog`]: transmittance and path radiance along rays, over the wavelengths of a grid and in RGB.
//! - [`FogTable`], [`RgbFogTable`]: the same, tabulated for the many rays of a picture.
//! - [`EvenFog`]: uniform fog in ambient light alone, for whole rows of a picture.
//! - [`FogPatches`], [`PatchField`], [`PatchView`]: fog whose density varies at random, and its optical depth along rays.
//! - [`lights`]: point, spot and sphere lights in fog.
//! - [`legacy`]: fog factors of older graphics hardware.
//!
//! The book's chapters on fog and on lights derive the formulas.

mod closed_forms;
mod error;
mod even;
mod fog_lanes;
mod layer;
pub mod legacy;
mod lighting;
pub mod lights;
mod multiple;
mod patch_view;
mod patches;
mod ray_block;
mod ray_cuts;
mod rays;
mod single_scattering;
mod spectral;
mod table;
mod values;

pub use crate::atmosphere::{DensityError, DensityProfile, RaySegment, droplets, visibility};
pub use closed_forms::split_sum_error;
pub use error::FogError;
pub use even::EvenFog;
pub use layer::RgbLayer;
pub use lighting::{
    DirectionalLight, FogLighting, FogScattering, Ground, effective_top_of_layers_m,
};
pub use patch_view::PatchView;
pub use patches::{FogPatches, PatchField};
pub use spectral::{FOG_STREAMS, Fog, FogTable, RgbFog, RgbFogParts, RgbFogTable};
pub use values::ChannelValues;

pub(crate) use closed_forms::{Lanes, constant_source, mean_attenuated_source};
pub(crate) use fog_lanes::FogLanes;
pub(crate) use layer::LayerLanes;
