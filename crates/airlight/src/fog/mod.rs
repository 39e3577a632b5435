//! Fog in closed form.
pub mod approximation;
pub mod droplets;
pub mod lanes;
pub mod legacy;
pub mod line;
pub mod matter;
pub mod profile;
pub mod scatter;
pub mod slab1987;
pub mod visibility;
