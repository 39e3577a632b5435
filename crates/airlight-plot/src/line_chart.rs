//! Line charts.

use crate::canvas::{COLOURS, SIZE, draw, draw_axes, draw_legend};
use crate::{Axis, Curve, PlotError};
use plotters::prelude::*;

/// Draws curves over two axes, as SVG. A linear vertical axis without a range begins at 0, or at the least value below it.
///
/// # Errors
/// [`PlotError::NoRange`] where the curves span no range of the horizontal axis.
pub fn line_chart(x: &Axis, y: &Axis, curves: &[Curve]) -> Result<String, PlotError> {
    let points = || curves.iter().flat_map(|curve| &curve.points);
    let (left, right) = x.extent(points().map(|p| p.0));
    let (low, high) = y.extent(points().map(|p| p.1));
    if !(left < right && low <= high) {
        return Err(PlotError::NoRange {
            expected: "curves with finite values at two or more positions",
            got: format!("{} points", points().count()),
        });
    }
    let (low, high) = match (y.range, y.logarithmic) {
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
        draw_axes(&mut chart, (x, y), true)?;
        for (index, curve) in curves.iter().enumerate() {
            let colour = COLOURS[index % COLOURS.len()];
            let line = curve
                .points
                .iter()
                .map(|p| (x.position(p.0), y.position(p.1)))
                .filter(|p| p.1.is_finite());
            chart
                .draw_series(LineSeries::new(line, colour.stroke_width(2)))?
                .label(&curve.name)
                .legend(move |(x, y)| Circle::new((x + 6, y), 4, colour.filled()));
        }
        draw_legend(
            &mut chart,
            emptiest_corner((x, y), ((left, right), (low, high)), curves),
        )
    })
}

/// The corner in which the legend hides the least of the curves.
fn emptiest_corner(
    (x, y): (&Axis, &Axis),
    (across, up): ((f64, f64), (f64, f64)),
    curves: &[Curve],
) -> SeriesLabelPosition {
    /// Samples between two points of a curve.
    const SAMPLES: u32 = 16;
    // Estimated size of the legend as a fraction of the chart.
    let width = curves
        .iter()
        .map(|curve| curve.name.len())
        .max()
        .unwrap_or(0) as f64
        * 0.008
        + 0.04;
    let height = 0.055 * curves.len() as f64 + 0.03;
    let part = |value: f64, (low, high): (f64, f64)| (value - low) / (high - low);
    let positions = |curve: &Curve| -> Vec<(f64, f64)> {
        let points = curve.points.iter();
        let parts = points.map(|p| (part(x.position(p.0), across), part(y.position(p.1), up)));
        parts.filter(|p| p.1.is_finite()).collect()
    };
    let curves: Vec<Vec<(f64, f64)>> = curves.iter().map(positions).collect();
    let hidden = |right: bool, top: bool| -> usize {
        let covers = |(x, y): (f64, f64)| {
            let (x, y) = (
                if right { 1.0 - x } else { x },
                if top { 1.0 - y } else { y },
            );
            (0.0..width).contains(&x) && (0.0..height).contains(&y)
        };
        let on = |pair: &[(f64, f64)]| {
            let step = |k: u32| {
                let t = f64::from(k) / f64::from(SAMPLES);
                let mix = |a: f64, b: f64| a + t * (b - a);
                (mix(pair[0].0, pair[1].0), mix(pair[0].1, pair[1].1))
            };
            (0..SAMPLES).filter(|k| covers(step(*k))).count()
        };
        curves
            .iter()
            .flat_map(|positions| positions.windows(2))
            .map(on)
            .sum()
    };
    [
        (SeriesLabelPosition::UpperRight, hidden(true, true)),
        (SeriesLabelPosition::UpperLeft, hidden(false, true)),
        (SeriesLabelPosition::LowerRight, hidden(true, false)),
        (SeriesLabelPosition::LowerLeft, hidden(false, false)),
    ]
    .into_iter()
    .min_by_key(|(_, hidden)| *hidden)
    .map_or(SeriesLabelPosition::UpperRight, |(corner, _)| corner)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_legend_stands_where_no_curve_is() {
        let falling = |from: f64, to: f64| Curve {
            name: "a curve".to_owned(),
            points: vec![(0.0, from), (1.0, to)],
        };
        let unit = ((0.0, 1.0), (0.0, 1.0));
        let corner = |curves: &[Curve]| {
            emptiest_corner((&Axis::linear("x"), &Axis::linear("y")), unit, curves)
        };
        let [down, up] = [falling(1.0, 0.0), falling(0.0, 1.0)];
        assert!(matches!(
            corner(std::slice::from_ref(&down)),
            SeriesLabelPosition::UpperRight
        ));
        assert!(matches!(
            corner(std::slice::from_ref(&up)),
            SeriesLabelPosition::UpperLeft
        ));
        let above = falling(0.95, 0.95);
        assert!(matches!(
            corner(&[above, up]),
            SeriesLabelPosition::LowerRight
        ));
    }

    #[test]
    fn curves_without_a_range_are_refused() {
        let (x, y) = (Axis::linear("x"), Axis::linear("y"));
        let point = Curve {
            name: "a point".to_owned(),
            points: vec![(1.0, 2.0)],
        };
        for curves in [&[][..], &[point]] {
            let error = line_chart(&x, &y, curves).unwrap_err();
            assert!(matches!(error, PlotError::NoRange { .. }), "{error}");
        }
    }

    #[test]
    fn a_curve_is_named_and_drawn() {
        let curve = Curve {
            name: "a straight line".to_owned(),
            points: vec![(0.0, 1.0), (1.0, 2.0)],
        };
        let (x, y) = (Axis::linear("across, m"), Axis::logarithmic("up, s"));
        let svg = line_chart(&x, &y, &[curve]).unwrap();
        for text in ["a straight line", "across, m", "up, s", "polyline"] {
            assert!(svg.contains(text), "{text}");
        }
    }
}
