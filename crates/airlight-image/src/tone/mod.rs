//! From linear light to what a display shows: exposure, tone curve, sRGB encoding, dither.
//!
//! Linear pixels are red, green and blue with the primaries and white of sRGB (Rec. 709, D65), in any unit; the
//! exposure brings them to the scale on which 0.18 is middle grey and, without a tone curve, 1 is white.

pub mod dither;
pub mod exposure;
mod filmic;
mod mapper;
mod planes;
pub mod srgb;
mod table;

pub use exposure::{Exposure, Metering};
pub use filmic::{Filmic, FilmicSettings, MIDDLE_GREY};
pub use mapper::{ToneCurve, ToneMapper};
