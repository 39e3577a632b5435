//! Charts as SVG: curves over an axis, curves around a point.

use plotters::prelude::*;

/// An SVG, or why it could not be drawn.
pub type Drawn = Result<String, Box<dyn std::error::Error>>;

/// Size of a chart, pixels.
pub(crate) const SIZE: (u32, u32) = (960, 420);
pub(crate) const FONT: &str = "system-ui,sans-serif";
/// Told apart without red and green (after Okabe & Ito 2008).
pub(crate) const COLOURS: [RGBColor; 7] = [
    RGBColor(0, 114, 178),
    RGBColor(213, 94, 0),
    RGBColor(0, 158, 115),
    RGBColor(204, 121, 167),
    RGBColor(230, 159, 0),
    RGBColor(86, 180, 233),
    RGBColor(90, 90, 90),
];

/// One curve: its name and its points.
#[derive(Clone, Debug, PartialEq)]
pub struct Curve {
    /// Its name.
    pub name: String,
    /// Places and values; around a point: angles (rad) and distances.
    pub points: Vec<(f64, f64)>,
}

/// What an axis shows.
#[derive(Clone, Debug, PartialEq)]
pub struct Axis {
    /// The quantity and its unit.
    pub name: String,
    /// Whether it goes by powers of ten; values must then be above 0.
    pub by_powers: bool,
}

impl Axis {
    fn place(&self, value: f64) -> f64 {
        match self.by_powers {
            true => value.log10(),
            false => value,
        }
    }

    /// What is written at a place.
    fn label(&self, place: f64) -> String {
        match self.by_powers {
            true if (place - place.round()).abs() > 1e-6 => String::new(),
            true => format!("1e{place:.0}"),
            false => ((place * 1e6).round() / 1e6).to_string(),
        }
    }
}

/// Curves over an axis.
///
/// # Errors
/// Where the SVG could not be drawn.
pub fn curves(x: &Axis, y: &Axis, curves: &[Curve]) -> Drawn {
    let points = || curves.iter().flat_map(|curve| &curve.points);
    let ends = |values: &mut dyn Iterator<Item = f64>| {
        values.fold((f64::INFINITY, f64::NEG_INFINITY), |(low, high), value| {
            (low.min(value), high.max(value))
        })
    };
    let (left, right) = ends(&mut points().map(|p| x.place(p.0)));
    let (low, high) = ends(&mut points().map(|p| y.place(p.1)));
    let (low, high) = match y.by_powers {
        true => (low.floor(), high.ceil()),
        false => (low.min(0.0), 1.1 * high),
    };
    draw(SIZE, |root| {
        let mut chart = ChartBuilder::on(root)
            .margin(12)
            .x_label_area_size(44)
            .y_label_area_size(64)
            .build_cartesian_2d(left..right, low..high)?;
        chart
            .configure_mesh()
            .light_line_style(TRANSPARENT)
            .bold_line_style(BLACK.mix(0.12))
            .x_labels(10)
            .x_desc(&x.name)
            .x_label_formatter(&|place| x.label(*place))
            .y_desc(&y.name)
            .y_label_formatter(&|place| y.label(*place))
            .label_style((FONT, 14))
            .axis_desc_style((FONT, 15))
            .draw()?;
        for (index, curve) in curves.iter().enumerate() {
            let colour = COLOURS[index % COLOURS.len()];
            let line = curve.points.iter().map(|p| (x.place(p.0), y.place(p.1)));
            chart
                .draw_series(LineSeries::new(line, colour.stroke_width(2)))?
                .label(&curve.name)
                .legend(move |(x, y)| Circle::new((x + 6, y), 4, colour.filled()));
        }
        labels(&mut chart)
    })
}

/// Curves around a point, angle 0 to the right: a panel for each, its farthest point at the panel's edge.
///
/// # Errors
/// Where the SVG could not be drawn.
pub fn around(curves: &[Curve]) -> Drawn {
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
            let most = curve.points.iter().map(|p| p.1).fold(0.0, f64::max);
            let middle = PANEL as i32 / 2;
            let reach = f64::from(middle) - 14.0;
            let place = |(angle, distance): (f64, f64)| {
                let r = reach * distance / most;
                let (x, y) = (r * angle.cos(), -r * angle.sin());
                (middle + x.round() as i32, TITLE + middle + y.round() as i32)
            };
            for part in [0.5, 1.0] {
                let radius = (part * reach) as i32;
                let style = BLACK.mix(0.12);
                panel.draw(&Circle::new((middle, TITLE + middle), radius, style))?;
            }
            let across = [place((0.0, most)), place((std::f64::consts::PI, most))];
            panel.draw(&PathElement::new(across.to_vec(), BLACK.mix(0.12)))?;
            let line: Vec<(i32, i32)> = curve.points.iter().map(|&p| place(p)).collect();
            let colour = COLOURS[index % COLOURS.len()];
            panel.draw(&PathElement::new(line, colour.stroke_width(2)))?;
            let titles = [curve.name.clone(), format!("outer circle: {most:.2e}")];
            for (row, text) in titles.into_iter().enumerate() {
                panel.draw(&Text::new(text, (10, 6 + 17 * row as i32), (FONT, 14)))?;
            }
        }
        Ok(())
    })
}

pub(crate) type Chart<'a, 'b> = ChartContext<
    'a,
    SVGBackend<'b>,
    Cartesian2d<plotters::coord::types::RangedCoordf64, plotters::coord::types::RangedCoordf64>,
>;

/// Names of colours, top right.
pub(crate) fn labels<'a>(chart: &mut Chart<'a, 'a>) -> Result<(), Box<dyn std::error::Error>> {
    chart
        .configure_series_labels()
        .background_style(WHITE.mix(0.85))
        .label_font((FONT, 13))
        .position(SeriesLabelPosition::UpperRight)
        .draw()?;
    Ok(())
}

pub(crate) type Area<'a> = DrawingArea<SVGBackend<'a>, plotters::coord::Shift>;

/// An SVG on white.
pub(crate) fn draw(
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
