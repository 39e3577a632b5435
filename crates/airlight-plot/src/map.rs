//! Values over two axes, as a map of colours with lines of equal value.

use crate::axis::Axis;
use crate::ramp::Ramp;
use crate::svg::{Drawn, FONT, axes, draw};
use plotters::prelude::*;

/// Size of a map, pixels.
const SIZE: (u32, u32) = (820, 520);
/// Room for the scale at the right.
const SCALE: u32 = 130;

/// Values over two axes.
#[derive(Clone, Debug, PartialEq)]
pub struct Grid {
    /// Places across, rising.
    pub x: Vec<f64>,
    /// Places upwards, rising.
    pub y: Vec<f64>,
    /// The value at each place, `values[row of y][column of x]`.
    pub values: Vec<Vec<f64>>,
}

/// A map of `grid`; `quantity` names its values and their unit, `levels` are drawn as lines.
///
/// # Errors
/// Where there are fewer than two places on an axis, or the SVG could not be drawn.
pub fn map(
    (x, y): (&Axis, &Axis),
    grid: &Grid,
    (quantity, ramp): (&str, &Ramp),
    levels: &[f64],
) -> Drawn {
    if grid.x.len() < 2 || grid.y.len() < 2 {
        return Err("there is nothing to draw: a map needs two places on each axis".into());
    }
    let across: Vec<f64> = grid.x.iter().map(|&v| x.place(v)).collect();
    let up: Vec<f64> = grid.y.iter().map(|&v| y.place(v)).collect();
    let ends = |places: &[f64]| (places[0], places[places.len() - 1]);
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
        let cells = grid.values.iter().enumerate().flat_map(|(row, values)| {
            let (columns, rows) = (&columns, &rows);
            values.iter().enumerate().map(move |(column, &value)| {
                let [r, g, b] = ramp.colour(value);
                let corners = [
                    (columns[column], rows[row]),
                    (columns[column + 1], rows[row + 1]),
                ];
                Rectangle::new(corners, RGBColor(r, g, b).filled())
            })
        });
        chart.draw_series(cells)?;
        for &level in levels {
            let lines = contour(&across, &up, &grid.values, level);
            let style = BLACK.mix(0.75).stroke_width(1);
            chart.draw_series(
                lines
                    .into_iter()
                    .map(|ends| PathElement::new(ends.to_vec(), style)),
            )?;
        }
        axes(&mut chart, (x, y), false)?;
        let bar = ramp.ends;
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
            let [r, g, b] = ramp.colour(0.5 * (at(i) + at(i + 1)));
            Rectangle::new([(0.0, at(i)), (1.0, at(i + 1))], RGBColor(r, g, b).filled())
        }))?;
        let mut marks: Vec<f64> = levels.to_vec();
        marks.extend([bar.0, bar.1]);
        marks.retain(|mark| (bar.0..=bar.1).contains(mark));
        for mark in marks {
            let (px, py) = chart.backend_coord(&(1.0, mark));
            let text = format!("\u{2013} {}", Axis::even("").label(mark));
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

/// Edges of the cells around places: halfway between neighbours, and the first and last place themselves.
fn edges(places: &[f64]) -> Vec<f64> {
    let last = places.len() - 1;
    (0..=places.len())
        .map(|i| match i {
            0 => places[0],
            i if i > last => places[last],
            i => 0.5 * (places[i - 1] + places[i]),
        })
        .collect()
}

/// Pieces of the line on which values between places, taken as straight along the edges, are `level`.
fn contour(x: &[f64], y: &[f64], values: &[Vec<f64>], level: f64) -> Vec<[(f64, f64); 2]> {
    let mut pieces = Vec::new();
    for j in 1..y.len() {
        for i in 1..x.len() {
            let corner = |i: usize, j: usize| ((x[i], y[j]), values[j][i] - level);
            let around = [
                corner(i - 1, j - 1),
                corner(i, j - 1),
                corner(i, j),
                corner(i - 1, j),
            ];
            let mut crossings = Vec::with_capacity(4);
            for k in 0..4 {
                let ((a, va), (b, vb)) = (around[k], around[(k + 1) % 4]);
                if (va < 0.0) != (vb < 0.0) && va.is_finite() && vb.is_finite() {
                    let t = va / (va - vb);
                    crossings.push((a.0 + t * (b.0 - a.0), a.1 + t * (b.1 - a.1)));
                }
            }
            for pair in crossings.chunks_exact(2) {
                pieces.push([pair[0], pair[1]]);
            }
        }
    }
    pieces
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn lines_lie_where_the_value_is() {
        let places: Vec<f64> = (0..5).map(f64::from).collect();
        let values: Vec<Vec<f64>> = (0..5)
            .map(|j| (0..5).map(|i| f64::from(i + 2 * j)).collect())
            .collect();
        let pieces = contour(&places, &places, &values, 4.5);
        assert!(pieces.len() >= 4);
        for (x, y) in pieces.into_iter().flatten() {
            assert!((x + 2.0 * y - 4.5).abs() < 1e-12, "{x} {y}");
        }
    }

    #[test]
    fn a_map_has_axes_and_a_scale() {
        let grid = Grid {
            x: vec![1.0, 10.0],
            y: vec![0.0, 1.0],
            values: vec![vec![0.0, 1.0], vec![2.0, 3.0]],
        };
        let axes = (&Axis::powers("across, m"), &Axis::even("up, deg"));
        let svg = map(axes, &grid, ("error, %", &Ramp::from_zero(3.0)), &[1.0]).unwrap();
        for text in ["across, m", "up, deg", "error, %", "rect"] {
            assert!(svg.contains(text), "{text}");
        }
    }
}
