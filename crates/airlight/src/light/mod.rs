//! What shines.

pub mod ephemeris;
pub mod sun;

pub use ephemeris::{EphemerisError, Place, RefractingAir, SunPosition, sun_position};
pub use sun::{LimbDarkening, SunDisc, SunError};
