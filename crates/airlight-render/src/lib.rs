//! Drawing with Airlight: fog over pictures, objects, sequences.
//!
//! - [`error`]: why something could not be drawn.
//! - [`pixels`]: points within a pixel; names of files beside a picture.
//! - [`channels`]: from the values of a view to those of a pixel; [`illuminance`], [`exposure`].
//! - [`sun_disc`], [`sky_rows`]: sky and sun's disc, row by row.
//! - [`canvas`]: pictures by Monte Carlo, pass by pass.
//! - [`overlay`]: fog over a picture and its depth map.
//! - [`batch`]: the same over many pictures, with varied settings and a manifest.
//! - [`objects`]: simple solids and their surfaces, intersected by rays.
//! - [`sequence`]: many pictures: file names, time steps, resuming an earlier run.

pub mod batch;
pub mod canvas;
pub mod channels;
pub mod error;
pub mod exposure;
pub mod illuminance;
pub mod objects;
pub mod overlay;
pub mod pixels;
pub mod sequence;
pub mod sky_rows;
pub mod sun_disc;
#[cfg(test)]
mod test_view;

pub use error::RenderError;
