//! Plots of a report, as SVG.

use crate::check::{Check, Unit};
use crate::measured::Published;
use airlight_plot::PlotError;
use airlight_plot::canvas::{COLOURS, FONT, SIZE, draw, draw_legend};
use plotters::prelude::*;

/// Errors of some checks of one unit over the zenith angle of the view, or over the angle from the sun; a colour for each
/// name that `group` gives.
pub fn errors(
    checks: &[Check],
    by_angle_from_sun: bool,
    group: fn(&Check) -> &str,
) -> Result<String, PlotError> {
    let unit = checks.first().map_or(Unit::Percent, |check| check.unit);
    let place = |row: &crate::Row| match by_angle_from_sun {
        true => row.at.from_sun_deg(),
        false => row.at.view_zenith_deg,
    };
    // Beyond this a few points would flatten the others; they lie on the edge.
    let all = || {
        checks
            .iter()
            .flat_map(|c| c.rows.iter().map(|row| c.error(row)))
    };
    let mut sizes: Vec<f64> = all().map(f64::abs).filter(|e| e.is_finite()).collect();
    sizes.sort_by(f64::total_cmp);
    let most = sizes.get((sizes.len() * 995 / 1000).min(sizes.len().saturating_sub(1)));
    let most = 1.1 * most.copied().unwrap_or(1.0).max(1e-3);
    let (right, x) = match by_angle_from_sun {
        true => (180.0, "angle from the sun, degrees"),
        false => {
            let below = checks.iter().flat_map(|check| &check.rows);
            let right = if below.map(place).any(|zenith| zenith > 90.0) {
                180.0
            } else {
                90.0
            };
            (right, "zenith angle of the view, degrees")
        }
    };
    draw(SIZE, |root| {
        let mut chart = ChartBuilder::on(root)
            .margin(12)
            .x_label_area_size(44)
            .y_label_area_size(64)
            .build_cartesian_2d(0.0..right, -most..most)?;
        chart
            .configure_mesh()
            .light_line_style(TRANSPARENT)
            .bold_line_style(BLACK.mix(0.12))
            .x_desc(x)
            .x_label_formatter(&|x| format!("{x:.0}"))
            .y_desc(format!("error, {unit}"))
            .label_style((FONT, 14))
            .axis_desc_style((FONT, 15))
            .draw()?;
        let mut groups: Vec<&str> = checks.iter().map(group).collect();
        groups.sort_unstable();
        groups.dedup();
        for (index, name) in groups.iter().enumerate() {
            let colour = COLOURS[index % COLOURS.len()];
            let of_group = checks.iter().filter(|check| group(check) == *name);
            let rows: Vec<(f64, f64)> = of_group
                .flat_map(|check| check.rows.iter().map(|row| (place(row), check.error(row))))
                .collect();
            // A page needs no more points than can be distinguished.
            let few = rows.iter().step_by(rows.len().div_ceil(2000).max(1));
            let points = few.map(|&(x, error)| {
                Circle::new((x, error.clamp(-most, most)), 2, colour.mix(0.5).filled())
            });
            chart
                .draw_series(points)?
                .label(*name)
                .legend(move |(x, y)| Circle::new((x + 6, y), 4, colour.filled()));
        }
        draw_legend(&mut chart, SeriesLabelPosition::UpperRight)?;
        Ok(())
    })
}

/// Root mean square errors against the measured sky: ours and published ones.
pub fn models(ours: &[Check], published: &[Published]) -> Result<String, PlotError> {
    let mut bars: Vec<(String, f64, bool)> = published
        .iter()
        .map(|model| (model.model.clone(), model.rmse, false))
        .collect();
    for check in ours.iter().take(2) {
        if let Some(s) = check.statistics() {
            bars.push((format!("Airlight: {}", check.what), s.rms, true));
        }
    }
    bars.sort_by(|a, b| a.1.total_cmp(&b.1));
    let (count, most) = (
        bars.len() as f64,
        bars.iter().map(|b| b.1).fold(0.0, f64::max),
    );
    draw(SIZE, |root| {
        let mut chart = ChartBuilder::on(root)
            .margin(12)
            .x_label_area_size(44)
            .build_cartesian_2d(0.0..1.9 * most, count..0.0)?;
        chart
            .configure_mesh()
            .disable_y_mesh()
            .disable_y_axis()
            .light_line_style(TRANSPARENT)
            .bold_line_style(BLACK.mix(0.12))
            .x_desc("root mean square error, mW/(m² sr nm)")
            .x_label_formatter(&|x| format!("{x:.0}"))
            .label_style((FONT, 14))
            .axis_desc_style((FONT, 15))
            .draw()?;
        for (row, (name, rms, is_ours)) in bars.iter().enumerate() {
            let top = row as f64;
            let colour = COLOURS[if *is_ours { 1 } else { 0 }];
            chart.draw_series([Rectangle::new(
                [(0.0, top + 0.15), (*rms, top + 0.85)],
                colour.filled(),
            )])?;
            let text = format!("{rms:.1}  {name}");
            let style = (FONT, 15).into_font();
            chart.draw_series([Text::new(text, (rms + 0.01 * most, top + 0.22), style)])?;
        }
        Ok(())
    })
}

/// Spectra of four directions of the first scan of the air of the day.
pub fn spectra(checks: &[Check]) -> Result<String, PlotError> {
    let Some(check) = checks.get(1) else {
        return Ok(String::new());
    };
    let nm = |row: &crate::Row| row.at.wavelength_nm.unwrap_or_default();
    // Rows come wavelength by wavelength, direction after direction.
    let directions: Vec<&[crate::Row]> = check.rows.chunk_by(|a, b| nm(a) < nm(b)).collect();
    let wanted = [15.0, 40.0, 90.0, 120.0].map(|angle: f64| {
        let far = |rows: &&&[crate::Row]| (rows[0].at.from_sun_deg() - angle).abs();
        let of_scan = directions.iter().take(81);
        of_scan.min_by(|a, b| far(a).total_cmp(&far(b))).copied()
    });
    let rows: Vec<&[crate::Row]> = wanted.into_iter().flatten().collect();
    let values = || rows.iter().flat_map(|r| r.iter());
    let most = values()
        .map(|r| r.reference.max(r.ours))
        .fold(0.0, f64::max);
    let ends = values().fold((f64::INFINITY, 0.0f64), |(low, high), r| {
        (low.min(nm(r)), high.max(nm(r)))
    });
    draw(SIZE, |root| {
        let mut chart = ChartBuilder::on(root)
            .margin(12)
            .x_label_area_size(44)
            .y_label_area_size(64)
            .build_cartesian_2d(ends.0..ends.1, 0.0..1.15 * most)?;
        chart
            .configure_mesh()
            .light_line_style(TRANSPARENT)
            .bold_line_style(BLACK.mix(0.12))
            .x_desc("wavelength, nm")
            .x_label_formatter(&|x| format!("{x:.0}"))
            .y_desc("radiance, W/(m² sr nm)")
            .label_style((FONT, 14))
            .axis_desc_style((FONT, 15))
            .draw()?;
        for (index, rows) in rows.iter().enumerate() {
            let colour = COLOURS[index];
            let line = rows.iter().map(|row| (nm(row), row.ours));
            let dots = rows.iter();
            chart
                .draw_series(LineSeries::new(line, colour.stroke_width(2)))?
                .label(format!(
                    "{:.0} degrees from the sun",
                    rows[0].at.from_sun_deg()
                ))
                .legend(move |(x, y)| Circle::new((x + 6, y), 4, colour.filled()));
            chart.draw_series(
                dots.map(|row| Circle::new((nm(row), row.reference), 3, colour.filled())),
            )?;
        }
        draw_legend(&mut chart, SeriesLabelPosition::UpperRight)?;
        Ok(())
    })
}
