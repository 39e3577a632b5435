//! The window with the spectrum of a direction.

use crate::compute::{Facts, Spectrum};
use crate::style::{ACCENT, QUIET};
use airlight::axes;
use airlight::glam::DVec3;
use eframe::egui::{self, Align2, Color32, FontId, Pos2, Sense, Stroke, Ui, pos2, vec2};
use std::fmt::Write;

/// Size of the plot, points.
const PLOT: [f32; 2] = [250.0, 110.0];

/// Shows the window. False if it has been closed.
pub fn show(ui: &Ui, direction: DVec3, spectrum: Option<&Spectrum>, facts: &Facts) -> bool {
    let mut is_open = true;
    egui::Window::new("Reading")
        .open(&mut is_open)
        .resizable(false)
        .collapsible(false)
        .default_pos(pos2(14.0, 14.0))
        .show(ui.ctx(), |ui| {
            let (azimuth, elevation) =
                (axes::azimuth_deg(direction), axes::elevation_deg(direction));
            ui.label(format!("azimuth {azimuth:.2}°, elevation {elevation:.2}°"));
            match spectrum {
                Some(spectrum) => numbers(ui, spectrum),
                None => {
                    ui.label("solving …");
                }
            }
            ui.label(format!(
                "on the ground plane: sun {:.4} lx, sky {:.4} lx",
                significant(facts.sun_lx),
                significant(facts.sky_lx)
            ));
            if let Some(spectrum) = spectrum
                && ui.button("Copy spectrum as CSV").clicked()
            {
                ui.ctx().copy_text(csv(spectrum));
            }
        });
    is_open
}

fn numbers(ui: &mut Ui, spectrum: &Spectrum) {
    plot(ui, spectrum);
    let [x, y, z] = spectrum.xyz;
    let sum = x + y + z;
    ui.label(format!("luminance {:.5} cd/m²", significant(y)));
    if sum > 0.0 {
        ui.label(format!("chromaticity x {:.4}, y {:.4}", x / sum, y / sum));
    }
}

/// Radiance over wavelength, from 0.
fn plot(ui: &mut Ui, spectrum: &Spectrum) {
    let (response, painter) = ui.allocate_painter(vec2(PLOT[0], PLOT[1] + 14.0), Sense::hover());
    let area = egui::Rect::from_min_size(response.rect.min, vec2(PLOT[0], PLOT[1]));
    painter.rect_filled(area, 3.0, Color32::from_gray(12));
    let nm = &spectrum.wavelengths_nm;
    let (Some(first), Some(last)) = (nm.first(), nm.last()) else {
        return;
    };
    let most = spectrum.radiance.iter().fold(0.0f32, |a, b| a.max(*b));
    if most <= 0.0 {
        return;
    }
    let place = |nm: f64, value: f32| {
        let x = ((nm - first) / (last - first)) as f32;
        pos2(
            area.left() + x * area.width(),
            area.bottom() - 0.92 * value / most * area.height(),
        )
    };
    let pairs = nm.iter().zip(&spectrum.radiance);
    let points: Vec<Pos2> = pairs.map(|(nm, value)| place(*nm, *value)).collect();
    for point in &points {
        painter.circle_filled(*point, 2.0, ACCENT);
    }
    painter.line(points, Stroke::new(1.5, ACCENT));
    let font = FontId::proportional(10.0);
    let text = |at: Pos2, align: Align2, text: String| {
        painter.text(at, align, text, font.clone(), QUIET);
    };
    text(
        area.left_bottom(),
        Align2::LEFT_TOP,
        format!("{first:.0} nm"),
    );
    text(
        area.right_bottom(),
        Align2::RIGHT_TOP,
        format!("{last:.0} nm"),
    );
    let top = format!("{most:.4} W/(m² sr nm)");
    text(area.right_top() + vec2(-4.0, 2.0), Align2::RIGHT_TOP, top);
}

/// A number to five significant digits.
fn significant(value: f64) -> f64 {
    if value == 0.0 || !value.is_finite() {
        return value;
    }
    let unit = 10f64.powf(value.abs().log10().floor() - 4.0);
    (value / unit).round() * unit
}

/// Wavelengths and radiances, one a line.
fn csv(spectrum: &Spectrum) -> String {
    let mut text = "wavelength_nm,radiance_W_m-2_sr-1_nm-1\n".to_owned();
    for (nm, radiance) in spectrum.wavelengths_nm.iter().zip(&spectrum.radiance) {
        let _ = writeln!(text, "{nm},{radiance}");
    }
    text
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn spectra_are_written_as_csv() {
        let spectrum = Spectrum {
            wavelengths_nm: vec![440.0, 550.5],
            radiance: vec![0.25, 1e-9],
            xyz: [1.0; 3],
        };
        assert_eq!(
            csv(&spectrum),
            "wavelength_nm,radiance_W_m-2_sr-1_nm-1\n440,0.25\n550.5,0.000000001\n"
        );
        assert_eq!(significant(12345.678), 12346.0);
        assert_eq!(significant(0.0), 0.0);
    }
}
