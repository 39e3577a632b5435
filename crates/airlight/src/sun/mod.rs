//! The sun: its position in the sky and its disc.

pub mod disc;
pub mod position;

pub use disc::{LimbDarkening, SunDisc, SunError};
pub use position::{EphemerisError, Place, RefractingAir, SunPosition, sun_position};
