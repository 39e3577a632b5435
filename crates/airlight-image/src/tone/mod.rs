//! From linear light to display values: exposure, tone curve, sRGB encoding, dither.
//!
//! Linear pixels have the primaries and white of sRGB (Rec. 709, D65), in any unit; the exposure scales them so that 0.18 is middle
//! grey and, without a tone curve, 1 is white.

mod agx;
mod blocks;
mod camera;
mod dither;
mod exposure;
mod mapper;
mod scotopic;
mod white_balance;

pub use agx::AgxSettings;
pub use blocks::{luminance, without_negatives};
pub use camera::CameraSettings;
pub use exposure::{Exposure, MIDDLE_GREY, Metering};
pub use mapper::{ToneCurve, ToneMapper};
pub use white_balance::WhiteBalance;
