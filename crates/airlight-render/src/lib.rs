//! Cameras, pictures in and out, tone curves.
//!
//! A picture is a [`frame::Frame`], which says where each pixel looks, and a [`rows::RowSource`], which says what is
//! seen there. Writers ask for rows in any order and from many threads, hold only a few bands of the picture at a
//! time, and leave either a whole file or none.
//!
//! # Rooms, each importing only from those above it
//! - [`error`]: what can go wrong, in sentences.
//! - [`frame`]: projections: from pixels to view directions and back.
//! - [`rows`]: where pixels come from; stopping and following a long write.
//! - [`enlarge`]: small pictures made large by splines.
//! - [`tone`]: from linear light to what a display shows: exposure, tone curves, dither.
//! - [`output`]: picture files: OpenEXR (RGB and spectral), Radiance HDR, PNG, JPEG.
//! - [`input`]: pictures and depth maps read from files.
//! - [`overlay`]: fog laid over a picture and its depth.
//! - [`objects`]: simple solids and what they are made of, met by rays.
//! - [`terminal`]: a small picture as coloured text.
//! - [`sequence`]: many pictures: file names, time steps, taking up where an earlier run stopped.

pub mod enlarge;
pub mod error;
pub mod frame;
pub mod input;
pub mod objects;
pub mod output;
pub mod overlay;
pub mod rows;
pub mod sequence;
pub mod terminal;
pub mod tone;

pub use error::RenderError;
pub use frame::{Camera, CubeFace, Fisheye, Frame, Intrinsics, Projection, Size};
pub use input::{DepthMap, DepthOptions, Picture, read_depth, read_picture};
pub use output::{PictureFormat, PictureOptions, write_picture};
pub use rows::{Control, Progress, RowSource};
