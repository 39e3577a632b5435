//! Monte Carlo pictures, accumulated from bundles of paths in passes.
//!
//! - [`Passes`]: the bundles of each [`Pass`]; [`pixel_offset`]: position of a bundle's rays in a pixel.
//! - [`ColorMoments`]: mean and standard error of a pixel.
//! - [`Canvas`]: all pixels of a picture, with noise and polarisation maps.

mod moments;
mod passes;
mod picture;

pub use moments::ColorMoments;
pub use passes::{Pass, Passes, pixel_offset};
pub use picture::{Canvas, POLARISATION_CHANNELS, polarisation};
