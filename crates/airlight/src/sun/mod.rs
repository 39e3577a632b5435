//! The sun: its disc, its position in the sky, and times to compute that for.

mod disc;
#[cfg(feature = "ephemeris")]
mod moment;
#[cfg(feature = "ephemeris")]
mod position;
mod state;

pub use disc::{LimbDarkening, SunDisc, SunError};
#[cfg(feature = "ephemeris")]
pub use moment::{Moment, MomentError};
#[cfg(feature = "ephemeris")]
#[cfg(feature = "ephemeris")]
pub(crate) use position::raised;
#[cfg(feature = "ephemeris")]
pub use position::{EphemerisError, Place, RefractingAir, SunPosition, sun_position};
pub use state::SunState;
