//! Pictures and depth maps read from files.
//!
//! Formats are told by what a file holds, not by its ending. Whatever the bytes, the outcome is a picture or an error
//! that names the file and says what is wrong.

pub mod depth;
mod exr;
mod exr_names;
mod fault;
mod fill;
mod hdr;
mod jpeg;
mod metres;
mod npy;
mod pfm;
pub mod picture;
mod png;
mod read_depth;
mod read_picture;
mod source;

pub use depth::{DepthKind, DepthMap, DepthMeaning, DepthOptions, Unknown};
pub use picture::{LightReference, Picture, SampleBits};
pub use read_depth::read_depth;
pub use read_picture::read_picture;
