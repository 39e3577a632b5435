//! The sun: its disc, its position in the sky, and times to compute that for.

mod disc;
mod moment;
mod position;
mod state;

pub use disc::{LimbDarkening, SunDisc, SunError};
pub use moment::{Moment, MomentError};
pub use position::{EphemerisError, Place, RefractingAir, SunPosition, sun_position};
pub use state::SunState;
