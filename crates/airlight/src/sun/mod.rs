//! The sun: its disc, its position in the sky, and times to compute that for.

mod disc;
#[cfg(feature = "ephemeris")]
mod moment;
#[cfg(feature = "ephemeris")]
mod position;
mod state;

pub(crate) use disc::ASTRONOMICAL_UNIT_M;
pub use disc::{LimbDarkening, SunDisc, SunError};
#[cfg(feature = "ephemeris")]
pub use moment::{Moment, MomentError};
#[cfg(feature = "ephemeris")]
pub(crate) use position::raised;
#[cfg(feature = "ephemeris")]
pub use position::{EphemerisError, Place, RefractingAir, SunPosition, sun_position};
pub use state::SunState;

/// Length of a day, s.
pub(crate) const DAY_S: f64 = 86_400.0;
/// Julian date of 1970-01-01T00:00:00Z.
pub(crate) const UNIX_EPOCH_JD: f64 = 2_440_587.5;
