//! Polar plots.

use crate::canvas::{COLOURS, FONT, draw};
use crate::{Curve, PlotError};
use plotters::prelude::*;
use std::f64::consts::PI;

/// Draws each curve in a panel of its own around a point, angle 0 to the right, as SVG. The outer circle is at the largest
/// distance of the curve.
///
/// # Errors
/// [`PlotError::Draw`] where the drawing library fails.
pub fn polar_plot(curves: &[Curve]) -> Result<String, PlotError> {
    const PANEL: u32 = 320;
    const TITLE: i32 = 40;
    let columns = curves.len().clamp(1, 3);
    let rows = curves.len().div_ceil(columns).max(1);
    let size = (PANEL * columns as u32, (PANEL + TITLE as u32) * rows as u32);
    draw(size, |root| {
        for (index, (panel, curve)) in root
            .split_evenly((rows, columns))
            .iter()
            .zip(curves)
            .enumerate()
        {
            let max = curve.points.iter().map(|p| p.1).fold(0.0, f64::max);
            let middle = PANEL as i32 / 2;
            let reach = f64::from(middle) - 14.0;
            let position = |(angle, distance): (f64, f64)| {
                let r = reach * distance / max;
                let (x, y) = (r * angle.cos(), -r * angle.sin());
                (middle + x.round() as i32, TITLE + middle + y.round() as i32)
            };
            for part in [0.5, 1.0] {
                let radius = (part * reach) as i32;
                let style = BLACK.mix(0.12);
                panel.draw(&Circle::new((middle, TITLE + middle), radius, style))?;
            }
            let across = [position((0.0, max)), position((PI, max))];
            panel.draw(&PathElement::new(across.to_vec(), BLACK.mix(0.12)))?;
            let line: Vec<(i32, i32)> = curve.points.iter().map(|&p| position(p)).collect();
            let colour = COLOURS[index % COLOURS.len()];
            panel.draw(&PathElement::new(line, colour.stroke_width(2)))?;
            let titles = [curve.name.clone(), format!("outer circle: {max:.2e}")];
            for (row, text) in titles.into_iter().enumerate() {
                panel.draw(&Text::new(text, (10, 6 + 17 * row as i32), (FONT, 14)))?;
            }
        }
        Ok(())
    })
}
