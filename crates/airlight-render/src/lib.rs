//! Drawing scenes with Airlight.
//!
//! [`Renderer`] draws a [`Scene`](airlight::scene::Scene) with the solver or published model that the scene names, to files or
//! to memory, at one time or at a sequence of times.
//!
//! - [`error`]: errors; [`scene_file`]: scenes from files; [`summary`]: descriptions of scenes in words.
//! - [`layout`], [`channels`], [`pixels`]: files of a picture, values of a pixel, and directions within a pixel.
//! - [`sun_disc`], [`sky_rows`], [`objects`]: rows of sky, sun's disc and objects; [`canvas`]: Monte Carlo in passes.
//! - [`illuminance`], [`exposure`], [`metadata`]: illuminances, exposure and metadata of a picture.
//! - [`renderer`], [`frame`], [`solutions`], [`image`], [`sequence`]: a scene, one moment of it, light that pictures share, a picture
//!   in memory, and many moments. [`openjd`]: jobs for render farms.
//! - [`compare`], [`contact_sheet`], [`probe`]: comparison of solvers, pictures of several scenes, and light as numbers.
//! - [`overlay`]: fog over a picture with a depth map; [`batch`]: fog over many pictures, with varied settings and a manifest.

pub mod batch;
pub mod canvas;
pub mod channels;
pub mod compare;
pub mod contact_sheet;
pub mod display;
mod draw;
pub mod error;
pub mod exposure;
pub mod frame;
mod gamut;
mod ignored;
pub mod illuminance;
pub mod image;
pub mod layout;
mod manifest;
pub mod metadata;
pub mod objects;
pub mod openjd;
pub mod overlay;
pub mod pixels;
pub mod probe;
pub mod renderer;
pub mod scene_file;
pub mod sequence;
mod shard;
pub mod sky_rows;
pub mod solutions;
pub mod star_points;
pub mod summary;
pub mod sun_disc;
#[cfg(test)]
mod test_view;

pub use error::RenderError;
pub use frame::{PreparedFrame, WrittenFile, WrittenFrame};
pub use glam;
pub use image::RenderedImage;
pub use manifest::ManifestError;
pub use renderer::Renderer;
pub use shard::Shard;
pub use solutions::Solutions;

/// An example of the book, compiled as a test.
#[cfg(doctest)]
#[doc = include_str!("../../../docs/src/scenes.md")]
struct BookOfScenes;
