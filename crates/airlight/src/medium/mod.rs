//! What fills the air and where.

mod atmosphere;
mod density;
pub mod presets;
mod standard_air;

pub use atmosphere::{Atmosphere, AtmosphereError, Constituent, Planet};
pub use density::{AltitudeTable, DensityError, DensityProfile, Interpolation};
pub use presets::reference;
