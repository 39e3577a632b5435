//! What shines.

pub mod sun;

pub use sun::{LimbDarkening, SunDisc, SunError};
