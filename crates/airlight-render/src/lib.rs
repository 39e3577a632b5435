//! Drawing scenes with Airlight.
//!
//! [`Renderer`] draws a [`Scene`](airlight::scene::Scene) by whichever solver or published model the scene names: into files,
//! into memory, or a sequence of times.
//!
//! - [`error`]: why something could not be drawn; [`scene_file`]: scenes from files; [`summary`]: scenes in words.
//! - [`layout`], [`channels`], [`pixels`]: which files a picture consists of, the values of a pixel, and points within one.
//! - [`sun_disc`], [`sky_rows`], [`objects`]: sky, sun's disc and solids, row by row; [`canvas`]: Monte Carlo, pass by pass.
//! - [`illuminance`], [`exposure`], [`metadata`]: what is measured and said of a picture.
//! - [`renderer`], [`frame`], [`image`], [`sequence`]: the scene, one moment of it, a picture in memory, many moments.
//! - [`compare`], [`contact_sheet`], [`probe`]: two solvers, many scenes, light in numbers.
//! - [`overlay`]: fog over a picture and its depth map; [`batch`]: the same over many pictures, with varied settings and a
//!   manifest.

pub mod batch;
pub mod canvas;
pub mod channels;
pub mod compare;
pub mod contact_sheet;
mod draw;
pub mod error;
pub mod exposure;
pub mod frame;
pub mod illuminance;
pub mod image;
pub mod layout;
pub mod metadata;
pub mod objects;
pub mod overlay;
pub mod pixels;
pub mod probe;
pub mod renderer;
pub mod scene_file;
pub mod sequence;
pub mod sky_rows;
pub mod summary;
pub mod sun_disc;
#[cfg(test)]
mod test_view;

pub use error::RenderError;
pub use frame::{PreparedFrame, WrittenFile, WrittenFrame};
pub use glam;
pub use image::RenderedImage;
pub use renderer::Renderer;
