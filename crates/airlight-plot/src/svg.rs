//! The canvas that charts are drawn on.

use crate::axis::Axis;
use plotters::coord::types::RangedCoordf64;
use plotters::prelude::*;

/// An SVG, or why it could not be drawn.
pub type Drawn = Result<String, Box<dyn std::error::Error>>;

/// Size of a chart, pixels.
pub const SIZE: (u32, u32) = (960, 420);
/// The letters' family.
pub const FONT: &str = "system-ui,sans-serif";
/// Told apart without red and green (after Okabe & Ito 2008).
pub const COLOURS: [RGBColor; 7] = [
    RGBColor(0, 114, 178),
    RGBColor(213, 94, 0),
    RGBColor(0, 158, 115),
    RGBColor(204, 121, 167),
    RGBColor(230, 159, 0),
    RGBColor(86, 180, 233),
    RGBColor(90, 90, 90),
];

/// A chart over two axes.
pub type Chart<'a, 'b> =
    ChartContext<'a, SVGBackend<'b>, Cartesian2d<RangedCoordf64, RangedCoordf64>>;

/// A part of the canvas.
pub type Area<'a> = DrawingArea<SVGBackend<'a>, plotters::coord::Shift>;

/// Draws both axes, with faint lines across the chart or without.
///
/// # Errors
/// Where they could not be drawn.
pub fn axes<'a>(
    chart: &mut Chart<'a, 'a>,
    (x, y): (&Axis, &Axis),
    lines: bool,
) -> Result<(), Box<dyn std::error::Error>> {
    let line = BLACK.mix(if lines { 0.12 } else { 0.0 });
    chart
        .configure_mesh()
        .light_line_style(TRANSPARENT)
        .bold_line_style(line)
        .x_labels(10)
        .x_desc(&x.name)
        .x_label_formatter(&|place| x.label(*place))
        .y_desc(&y.name)
        .y_label_formatter(&|place| y.label(*place))
        .label_style((FONT, 14))
        .axis_desc_style((FONT, 15))
        .draw()?;
    Ok(())
}

/// Writes the names of the colours into a corner of a chart.
///
/// # Errors
/// Where they could not be drawn.
pub fn labels<'a>(
    chart: &mut Chart<'a, 'a>,
    corner: SeriesLabelPosition,
) -> Result<(), Box<dyn std::error::Error>> {
    chart
        .configure_series_labels()
        .background_style(WHITE.mix(0.85))
        .label_font((FONT, 13))
        .position(corner)
        .draw()?;
    Ok(())
}

/// An SVG on white.
///
/// # Errors
/// Those of `content`.
pub fn draw(
    size: (u32, u32),
    content: impl FnOnce(&Area<'_>) -> Result<(), Box<dyn std::error::Error>>,
) -> Drawn {
    let mut svg = String::new();
    {
        let root = SVGBackend::with_string(&mut svg, size).into_drawing_area();
        root.fill(&WHITE).map_err(|error| error.to_string())?;
        content(&root)?;
        root.present().map_err(|error| error.to_string())?;
    }
    Ok(svg)
}
