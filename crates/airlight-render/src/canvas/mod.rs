//! Pictures by Monte Carlo: sums over bundles of paths, pixel by pixel and pass by pass.
//!
//! - [`Passes`]: which bundles each [`Pass`] adds; [`pixel_offset`]: where in a pixel a bundle looks.
//! - [`ColorMoments`]: mean and standard error of a pixel.
//! - [`Canvas`]: all pixels of a picture, with maps of their noise and polarisation.

mod moments;
mod passes;
mod picture;

pub use moments::ColorMoments;
pub use passes::{Pass, Passes, pixel_offset};
pub use picture::{Canvas, POLARISATION_CHANNELS};
