//! Atmospheres: density profiles, constituents, gases, aerosols, fog droplets, visibility, presets and TOML files.

mod aerosol;
mod aerosol_types;
#[cfg(feature = "config")]
mod config;
mod constituents;
mod density;
pub mod droplets;
pub mod gases;
pub mod presets;
mod ray_segment;
mod standard_air;
pub mod visibility;

pub(crate) use aerosol::REFERENCE_NM;
pub use aerosol::{
    AerosolError, AerosolLoad, AngstromAerosol, turbidity_of_optical_depth,
    visibility_of_extinction_m,
};
pub use aerosol_types::{
    AerosolMixture, AerosolSummary, AerosolType, AerosolTypeError, Component, Ingredient, Smoke,
};
#[cfg(feature = "config")]
pub use config::{ConfigError, ConfigProblem};
pub use constituents::{
    Atmosphere, AtmosphereError, ClearAir, Constituent, ConstituentKind, Planet,
};
pub use density::{AltitudeTable, DensityError, DensityProfile, Interpolation};
pub(crate) use density::{Decay, HeightStructure};
pub use presets::{Preset, preset, reference};
pub use ray_segment::RaySegment;
#[cfg(feature = "ephemeris")]
pub(crate) use standard_air::refracting_air;
