//! Fog in closed form.
pub mod approximation;
pub mod droplets;
pub mod lanes;
pub mod legacy;
mod levels;
mod light;
pub mod line;
pub mod matter;
mod model;
mod multiple;
mod once;
pub mod profile;
pub mod scatter;
pub mod slab1987;
mod strata;
pub mod visibility;
mod walk;

pub use light::{Ground, Light, Scattering, Sun};
pub use line::Line;
pub use matter::{FogError, Layer, Matter};
pub use model::Fog;
pub use profile::{Profile, ProfileError};
