//! Charts, heat maps and contact sheets of pictures, as SVG and PNG.
//!
//! Charts are SVG texts: [`line_chart`], [`polar_plot`], [`heat_map`], and others drawn with the shared style of [`canvas`].
//! [`Raster`] turns SVG into pixels with an embedded font, so that a chart looks the same on every machine.
//! [`ContactSheet`] sets pictures side by side, with titles and colour scales.

mod axis;
pub mod canvas;
mod colormap;
mod contact_sheet;
mod error;
mod heat_map;
mod line_chart;
mod polar_plot;
mod raster;

pub use axis::{Axis, Curve};
pub use colormap::Colormap;
pub use contact_sheet::{ContactSheet, Panel};
pub use error::PlotError;
pub use heat_map::{HeatMap, heat_map};
pub use line_chart::line_chart;
pub use polar_plot::polar_plot;
pub use raster::Raster;
