//! Curves over an axis.

use crate::axis::{Axis, Curve};
use crate::svg::{COLOURS, Drawn, SIZE, axes, draw, labels};
use plotters::prelude::*;

/// Curves over an axis. An even axis upwards begins at 0, or at the least value below it.
///
/// # Errors
/// Where there is no value to draw, or the SVG could not be drawn.
pub fn curves(x: &Axis, y: &Axis, curves: &[Curve]) -> Drawn {
    let points = || curves.iter().flat_map(|curve| &curve.points);
    let (left, right) = x.ends_of(points().map(|p| p.0));
    let (low, high) = y.ends_of(points().map(|p| p.1));
    if !(left < right && low <= high) {
        return Err("there is nothing to draw: no curve has two places".into());
    }
    let (low, high) = match (y.ends, y.by_powers) {
        (Some(_), _) => (low, high),
        (None, true) => (low.floor(), high.ceil().max(low.floor() + 1.0)),
        (None, false) => (low.min(0.0), 1.1 * high.max(1e-300)),
    };
    draw(SIZE, |root| {
        let mut chart = ChartBuilder::on(root)
            .margin(12)
            .x_label_area_size(44)
            .y_label_area_size(72)
            .build_cartesian_2d(left..right, low..high)?;
        axes(&mut chart, (x, y), true)?;
        for (index, curve) in curves.iter().enumerate() {
            let colour = COLOURS[index % COLOURS.len()];
            let line = curve
                .points
                .iter()
                .map(|p| (x.place(p.0), y.place(p.1)))
                .filter(|p| p.1.is_finite());
            chart
                .draw_series(LineSeries::new(line, colour.stroke_width(2)))?
                .label(&curve.name)
                .legend(move |(x, y)| Circle::new((x + 6, y), 4, colour.filled()));
        }
        labels(&mut chart)
    })
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn nothing_is_told() {
        let empty = curves(&Axis::even("x"), &Axis::even("y"), &[]);
        assert!(empty.unwrap_err().to_string().contains("nothing to draw"));
    }

    #[test]
    fn a_curve_is_named_and_drawn() {
        let curve = Curve {
            name: "a straight line".to_owned(),
            points: vec![(0.0, 1.0), (1.0, 2.0)],
        };
        let svg = curves(&Axis::even("across, m"), &Axis::powers("up, s"), &[curve]).unwrap();
        for text in ["a straight line", "across, m", "up, s", "polyline"] {
            assert!(svg.contains(text), "{text}");
        }
    }
}
