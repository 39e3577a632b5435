//! Picture and depth files, projections, exposure and tone curves.
//!
//! A picture consists of a [`frame::Frame`], which maps pixels to view directions, and a [`rows::RowSource`], which provides
//! their values. Writers request rows in any order and from many threads, hold only a few bands of the picture in memory,
//! and leave either a complete file or none.
//!
//! # Modules, each importing only from those above it
//! - [`error`]: error type.
//! - [`Size`]: width and height of pictures.
//! - [`frame`]: projections, from pixels to view directions and back.
//! - [`rows`]: row sources.
//! - [`Notes`]: what was converted, repaired or passed over.
//! - [`enlarge`]: upsampling by cubic splines.
//! - [`tone`]: exposure, tone curves, sRGB encoding, dither: from linear light to display values.
//! - [`output`]: picture writers: OpenEXR (RGB and spectral), Radiance HDR, PNG, JPEG.
//! - [`input`]: picture and depth readers.
//! - [`terminal`]: previews in a terminal.

pub mod enlarge;
pub mod error;
pub mod frame;
pub mod input;
mod notes;
pub mod output;
pub mod rows;
mod size;
pub mod terminal;
pub mod tone;

pub use airlight::{Control, Progress};
pub use error::ImageError;
pub use frame::{Camera, CubeFace, Fisheye, Frame, Intrinsics, Projection};
pub use glam;
pub use input::{
    DepthMap, DepthOptions, Picture, read_depth, read_depth_with, read_picture, read_picture_with,
};
pub use notes::Notes;
pub use output::{PictureFormat, PictureOptions, write_picture};
pub use rows::RowSource;
pub use size::Size;
