//! Drawing with Airlight: fog over pictures, objects, sequences.
//!
//! - [`error`]: why something could not be drawn.
//! - [`pixels`]: points within a pixel; names of files beside a picture.
//! - [`canvas`]: pictures by Monte Carlo, pass by pass.
//! - [`overlay`]: fog laid over a picture and its depth.
//! - [`objects`]: simple solids and their surfaces, intersected by rays.
//! - [`sequence`]: many pictures: file names, time steps, resuming an earlier run.

pub mod canvas;
pub mod error;
pub mod objects;
pub mod overlay;
pub mod pixels;
pub mod sequence;

pub use error::RenderError;
