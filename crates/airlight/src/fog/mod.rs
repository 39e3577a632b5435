//! Fog in closed form.
pub mod lamp;
pub mod lanes;
pub mod line;
pub mod matter;
pub mod profile;
pub mod visibility;
