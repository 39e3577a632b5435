//! Charts, maps and boards of pictures.
//!
//! - [`svg`]: the canvas that all are drawn on; [`raster`]: from SVG to pixels, with a font of its own, so that a chart
//!   looks the same on every machine.
//! - [`curves`]: curves over an axis; [`polar`]: curves around a point; [`map`]: values over two axes.
//! - [`ramp`]: values into colours; [`contact_sheet`]: pictures side by side, with titles and scales.

pub mod axis;
pub mod contact_sheet;
pub mod curves;
pub mod map;
pub mod polar;
pub mod ramp;
pub mod raster;
pub mod svg;

pub use axis::{Axis, Curve};
pub use svg::Drawn;
