//! The SVG canvas under every chart: sizes, font, colours, axes, legend.

use crate::{Axis, PlotError};
use plotters::coord::types::RangedCoordf64;
use plotters::prelude::*;

/// Size of a chart, pixels.
pub const SIZE: (u32, u32) = (960, 420);
/// CSS font family of all texts.
pub const FONT: &str = "system-ui,sans-serif";
/// Colours of curves, distinguishable with red-green colour blindness (after Okabe & Ito 2008).
pub const COLOURS: [RGBColor; 7] = [
    RGBColor(0, 114, 178),
    RGBColor(213, 94, 0),
    RGBColor(0, 158, 115),
    RGBColor(204, 121, 167),
    RGBColor(230, 159, 0),
    RGBColor(86, 180, 233),
    RGBColor(90, 90, 90),
];

/// A chart with two axes.
pub type Chart<'a, 'b> =
    ChartContext<'a, SVGBackend<'b>, Cartesian2d<RangedCoordf64, RangedCoordf64>>;

/// A rectangle of the canvas.
pub type Area<'a> = DrawingArea<SVGBackend<'a>, plotters::coord::Shift>;

/// Result of a drawing closure: any error of plotters.
pub type DrawResult = Result<(), Box<dyn std::error::Error>>;

/// Draws both axes, and faint grid lines where `grid_lines` is set.
pub(crate) fn draw_axes<'a>(
    chart: &mut Chart<'a, 'a>,
    (x, y): (&Axis, &Axis),
    grid_lines: bool,
) -> DrawResult {
    let line = BLACK.mix(if grid_lines { 0.12 } else { 0.0 });
    chart
        .configure_mesh()
        .light_line_style(TRANSPARENT)
        .bold_line_style(line)
        .x_labels(10)
        .x_desc(&x.label)
        .x_label_formatter(&|position| x.tick_label(*position))
        .y_desc(&y.label)
        .y_label_formatter(&|position| y.tick_label(*position))
        .label_style((FONT, 14))
        .axis_desc_style((FONT, 15))
        .draw()?;
    Ok(())
}

/// Draws the legend in a corner of a chart.
///
/// # Errors
/// Those of plotters.
pub fn draw_legend<'a>(chart: &mut Chart<'a, 'a>, corner: SeriesLabelPosition) -> DrawResult {
    chart
        .configure_series_labels()
        .background_style(WHITE.mix(0.85))
        .label_font((FONT, 13))
        .position(corner)
        .draw()?;
    Ok(())
}

/// The SVG text of what `content` draws on a white canvas.
///
/// # Errors
/// [`PlotError::Draw`] with the error of `content`.
pub fn draw(
    size: (u32, u32),
    content: impl FnOnce(&Area<'_>) -> DrawResult,
) -> Result<String, PlotError> {
    let failed = |error: &dyn std::fmt::Display| PlotError::Draw(error.to_string());
    let mut svg = String::new();
    {
        let root = SVGBackend::with_string(&mut svg, size).into_drawing_area();
        root.fill(&WHITE).map_err(|error| failed(&error))?;
        content(&root).map_err(|error| failed(&error))?;
        root.present().map_err(|error| failed(&error))?;
    }
    Ok(svg)
}
