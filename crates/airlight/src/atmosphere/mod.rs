//! Atmospheres: density profiles, constituents, gases, aerosols, fog droplets, visibility, presets and TOML files.

pub mod aerosol;
pub mod aerosol_types;
pub mod config;
mod constituents;
mod density;
pub mod droplets;
pub mod gases;
pub mod presets;
mod ray_segment;
mod standard_air;
pub mod visibility;

pub use aerosol::{AerosolError, AerosolLoad, AngstromAerosol};
pub use aerosol_types::{AerosolMixture, AerosolType, AerosolTypeError};
pub use constituents::{
    Atmosphere, AtmosphereError, ClearAir, Constituent, ConstituentKind, Planet,
};
pub use density::{AltitudeTable, DensityError, DensityProfile, Interpolation};
pub(crate) use density::{Decay, HeightStructure};
pub use presets::{Preset, preset, reference};
pub use ray_segment::RaySegment;
pub(crate) use standard_air::refracting_air;
