//! Heat maps: values over two axes as colours, with contour lines.

use crate::axis::number;
use crate::canvas::{FONT, draw, draw_axes};
use crate::{Axis, Colormap, PlotError};
use plotters::prelude::*;

/// Size of a heat map, pixels.
const SIZE: (u32, u32) = (820, 520);
/// Width of the colour scale at the right.
const SCALE: u32 = 130;

/// Values on a grid.
#[derive(Clone, Debug, PartialEq)]
pub struct HeatMap {
    /// Columns: ascending values of the horizontal axis.
    pub x: Vec<f64>,
    /// Rows: ascending values of the vertical axis.
    pub y: Vec<f64>,
    /// `values[row][column]`.
    pub values: Vec<Vec<f64>>,
}

/// Draws values as colours, with a contour line at each of `levels`, as SVG. `quantity` labels the colour scale.
///
/// # Errors
/// [`PlotError::NoRange`] where an axis has fewer than two values.
pub fn heat_map(
    (x, y): (&Axis, &Axis),
    data: &HeatMap,
    (quantity, colormap): (&str, &Colormap),
    levels: &[f64],
) -> Result<String, PlotError> {
    if data.x.len() < 2 || data.y.len() < 2 {
        return Err(PlotError::NoRange {
            expected: "two or more columns and rows",
            got: format!("{} x {}", data.x.len(), data.y.len()),
        });
    }
    let across: Vec<f64> = data.x.iter().map(|&v| x.position(v)).collect();
    let up: Vec<f64> = data.y.iter().map(|&v| y.position(v)).collect();
    let ends = |positions: &[f64]| (positions[0], positions[positions.len() - 1]);
    let ((left, right), (low, high)) = (ends(&across), ends(&up));
    draw(SIZE, |root| {
        let (plot, scale) = root.split_horizontally(SIZE.0 - SCALE);
        let mut chart = ChartBuilder::on(&plot)
            .margin(12)
            .margin_top(34)
            .x_label_area_size(44)
            .y_label_area_size(72)
            .build_cartesian_2d(left..right, low..high)?;
        let (columns, rows) = (edges(&across), edges(&up));
        let cells = data.values.iter().enumerate().flat_map(|(row, values)| {
            let (columns, rows) = (&columns, &rows);
            values.iter().enumerate().map(move |(column, &value)| {
                let [r, g, b] = colormap.colour(value);
                let corners = [
                    (columns[column], rows[row]),
                    (columns[column + 1], rows[row + 1]),
                ];
                Rectangle::new(corners, RGBColor(r, g, b).filled())
            })
        });
        chart.draw_series(cells)?;
        for &level in levels {
            let lines = contour(&across, &up, &data.values, level);
            let style = BLACK.mix(0.75).stroke_width(1);
            chart.draw_series(
                lines
                    .into_iter()
                    .map(|ends| PathElement::new(ends.to_vec(), style)),
            )?;
        }
        draw_axes(&mut chart, (x, y), false)?;
        let bar = colormap.range;
        let mut chart = ChartBuilder::on(&scale)
            .margin(12)
            .margin_top(34)
            .margin_right(84)
            .x_label_area_size(44)
            .right_y_label_area_size(0)
            .build_cartesian_2d(0.0..1.0, bar.0..bar.1)?;
        const STEPS: usize = 64;
        chart.draw_series((0..STEPS).map(|i| {
            let at = |i: usize| bar.0 + (bar.1 - bar.0) * i as f64 / STEPS as f64;
            let [r, g, b] = colormap.colour(0.5 * (at(i) + at(i + 1)));
            Rectangle::new([(0.0, at(i)), (1.0, at(i + 1))], RGBColor(r, g, b).filled())
        }))?;
        let mut marks: Vec<f64> = levels.to_vec();
        marks.extend([bar.0, bar.1]);
        marks.retain(|mark| (bar.0..=bar.1).contains(mark));
        for mark in marks {
            let (px, py) = chart.backend_coord(&(1.0, mark));
            let text = format!("\u{2013} {}", number(mark));
            root.draw(&Text::new(text, (px + 2, py - 8), (FONT, 14)))?;
        }
        root.draw(&Text::new(
            quantity.to_owned(),
            ((SIZE.0 - SCALE) as i32 - 70, 10),
            (FONT, 14),
        ))?;
        Ok(())
    })
}

/// Edges of the cells around positions: halfway between neighbours, and the first and last position themselves.
fn edges(positions: &[f64]) -> Vec<f64> {
    let last = positions.len() - 1;
    (0..=positions.len())
        .map(|i| match i {
            0 => positions[0],
            i if i > last => positions[last],
            i => 0.5 * (positions[i - 1] + positions[i]),
        })
        .collect()
}

/// Segments of the contour line of `level`, with values interpolated linearly along the edges of cells (marching squares).
fn contour(x: &[f64], y: &[f64], values: &[Vec<f64>], level: f64) -> Vec<[(f64, f64); 2]> {
    let mut segments = Vec::new();
    for j in 1..y.len() {
        for i in 1..x.len() {
            let corner = |i: usize, j: usize| ((x[i], y[j]), values[j][i] - level);
            let corners = [
                corner(i - 1, j - 1),
                corner(i, j - 1),
                corner(i, j),
                corner(i - 1, j),
            ];
            let mut crossings = Vec::with_capacity(4);
            for k in 0..4 {
                let ((a, va), (b, vb)) = (corners[k], corners[(k + 1) % 4]);
                if (va < 0.0) != (vb < 0.0) && va.is_finite() && vb.is_finite() {
                    let t = va / (va - vb);
                    crossings.push((a.0 + t * (b.0 - a.0), a.1 + t * (b.1 - a.1)));
                }
            }
            for pair in crossings.chunks_exact(2) {
                segments.push([pair[0], pair[1]]);
            }
        }
    }
    segments
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn contour_lines_lie_where_the_value_is() {
        let positions: Vec<f64> = (0..5).map(f64::from).collect();
        let values: Vec<Vec<f64>> = (0..5)
            .map(|j| (0..5).map(|i| f64::from(i + 2 * j)).collect())
            .collect();
        let segments = contour(&positions, &positions, &values, 4.5);
        assert!(segments.len() >= 4);
        for (x, y) in segments.into_iter().flatten() {
            assert!((x + 2.0 * y - 4.5).abs() < 1e-12, "{x} {y}");
        }
    }

    #[test]
    fn a_heat_map_has_cells_axes_and_a_scale() {
        let data = HeatMap {
            x: vec![1.0, 10.0],
            y: vec![0.0, 1.0],
            values: vec![vec![0.0, 1.0], vec![2.0, 3.0]],
        };
        let axes = (&Axis::logarithmic("across, m"), &Axis::linear("up, deg"));
        let colormap = Colormap::sequential(3.0);
        let svg = heat_map(axes, &data, ("error, %", &colormap), &[1.0]).unwrap();
        for text in ["across, m", "up, deg", "error, %", "rect"] {
            assert!(svg.contains(text), "{text}");
        }
        // Each value has a cell of its colour.
        for value in [0.0, 1.0, 2.0, 3.0] {
            let [r, g, b] = colormap.colour(value);
            let fill = format!("fill=\"#{r:02X}{g:02X}{b:02X}\"");
            assert!(svg.contains(&fill), "{fill}");
        }
    }
}
