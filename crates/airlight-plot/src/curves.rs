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
        labels(
            &mut chart,
            emptiest((x, y), ((left, right), (low, high)), curves),
        )
    })
}

/// The corner in which names hide the least of the curves.
fn emptiest(
    (x, y): (&Axis, &Axis),
    (across, up): ((f64, f64), (f64, f64)),
    curves: &[Curve],
) -> SeriesLabelPosition {
    /// Points looked at between two of a curve.
    const BETWEEN: u32 = 16;
    // Parts of the chart that the names take.
    let wide = curves
        .iter()
        .map(|curve| curve.name.len())
        .max()
        .unwrap_or(0) as f64
        * 0.008
        + 0.04;
    let tall = 0.055 * curves.len() as f64 + 0.03;
    let part = |value: f64, (low, high): (f64, f64)| (value - low) / (high - low);
    let places = |curve: &Curve| -> Vec<(f64, f64)> {
        let places = curve.points.iter();
        let places = places.map(|p| (part(x.place(p.0), across), part(y.place(p.1), up)));
        places.filter(|p| p.1.is_finite()).collect()
    };
    let curves: Vec<Vec<(f64, f64)>> = curves.iter().map(places).collect();
    let hidden = |right: bool, top: bool| -> usize {
        let covers = |(x, y): (f64, f64)| {
            let (x, y) = (
                if right { 1.0 - x } else { x },
                if top { 1.0 - y } else { y },
            );
            (0.0..wide).contains(&x) && (0.0..tall).contains(&y)
        };
        let on = |pair: &[(f64, f64)]| {
            let step = |k: u32| {
                let t = f64::from(k) / f64::from(BETWEEN);
                let mix = |a: f64, b: f64| a + t * (b - a);
                (mix(pair[0].0, pair[1].0), mix(pair[0].1, pair[1].1))
            };
            (0..BETWEEN).filter(|k| covers(step(*k))).count()
        };
        curves
            .iter()
            .flat_map(|places| places.windows(2))
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
    fn names_stand_where_no_curve_is() {
        let falling = |from: f64, to: f64| Curve {
            name: "a curve".to_owned(),
            points: vec![(0.0, from), (1.0, to)],
        };
        let unit = ((0.0, 1.0), (0.0, 1.0));
        let corner =
            |curves: &[Curve]| emptiest((&Axis::even("x"), &Axis::even("y")), unit, curves);
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
