//! The window with the light of a point of the picture.

use crate::compute::{Facts, SPACE, Spectrum};
use crate::style::{ACCENT, QUIET};
use crate::truth;
use crate::widgets::quiet;
use airlight::axes;
use airlight::glam::DVec3;
use eframe::egui::{self, Align2, Color32, FontId, Pos2, Sense, Stroke, Ui, pos2, vec2};
use std::fmt::Write;

/// Size of the plot, points.
const PLOT: [f32; 2] = [250.0, 110.0];

/// What is read.
#[derive(Clone, Copy, Debug)]
pub struct Reading<'a> {
    /// Direction of the point.
    pub direction: DVec3,
    /// The terrain there: its distance and its height above sea level, m.
    pub ground: Option<[f64; 2]>,
    /// Light by the solver, once it is solved.
    pub spectrum: Option<&'a Spectrum>,
    /// The picture's red, green and blue there, cd/m^2.
    pub drawn: Option<[f32; 3]>,
    /// Numbers of the scene.
    pub facts: Facts,
}

/// Shows the window. False if it has been closed.
pub fn show(ui: &Ui, reading: &Reading<'_>) -> bool {
    let mut is_open = true;
    egui::Window::new("Reading")
        .open(&mut is_open)
        .resizable(false)
        .collapsible(false)
        .default_pos(pos2(14.0, 14.0))
        .show(ui.ctx(), |ui| numbers(ui, reading));
    is_open
}

fn numbers(ui: &mut Ui, reading: &Reading<'_>) {
    let direction = reading.direction;
    let (azimuth, elevation) = (axes::azimuth_deg(direction), axes::elevation_deg(direction));
    ui.label(format!("azimuth {azimuth:.2}°, elevation {elevation:.2}°"));
    if let Some([distance_m, altitude_m]) = reading.ground {
        let distance = length(distance_m);
        ui.label(format!(
            "terrain at {distance}, {altitude_m:.0} m above sea level"
        ));
    }
    match reading.spectrum {
        Some(spectrum) => {
            plot(ui, spectrum);
            colour(ui, spectrum, reading.drawn);
            if reading.ground.is_some() {
                quiet(ui, "by the solver's air, which has no shadows".to_owned());
            }
        }
        None => {
            ui.label("solving …");
        }
    }
    let facts = &reading.facts;
    ui.label(format!(
        "on the ground plane: sun {:.4} lx, sky {:.4} lx",
        significant(facts.sun_lx),
        significant(facts.sky_lx)
    ));
    if facts.visibility_m.is_finite() {
        let visibility = length(facts.visibility_m);
        let text = format!("horizontal visibility at the eye: {visibility}");
        ui.label(text).on_hover_text(
            "Distance at which a black object at the eye's height is just seen: in the air and fog of that height, at 550 nm.",
        );
    }
    if let Some(spectrum) = reading.spectrum
        && ui.button("Copy spectrum as CSV").clicked()
    {
        ui.ctx().copy_text(csv(spectrum));
    }
}

fn colour(ui: &mut Ui, spectrum: &Spectrum, drawn: Option<[f32; 3]>) {
    let [x, y, z] = spectrum.xyz;
    let sum = x + y + z;
    ui.label(format!("luminance {:.5} cd/m²", significant(y)));
    if sum > 0.0 {
        ui.label(format!("chromaticity x {:.4}, y {:.4}", x / sum, y / sum));
    }
    let right = SPACE.from_xyz(spectrum.xyz).map(|v| v as f32);
    if let Some(drawn) = drawn
        && let [Some(apart)] = truth::differences(&[drawn], &[right])[..]
    {
        ui.label(format!(
            "error of the picture: luminance {:+.2} %, CIEDE2000 {:.2}",
            apart.percent, apart.ciede2000
        ));
    }
}

/// A length in metres or kilometres.
fn length(metres: f64) -> String {
    match metres < 1000.0 {
        true => format!("{} m", significant(metres)),
        false => format!("{} km", significant(metres / 1000.0)),
    }
}

/// Radiance over wavelength, from 0, and the transmittance before ground, from 0 to 1.
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
    if let Some(transmittance) = &spectrum.transmittance {
        let pairs = nm.iter().zip(transmittance);
        let points = pairs.map(|(nm, value)| place(*nm, most * value));
        painter.line(points.collect(), Stroke::new(1.0, QUIET));
    }
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
    let top = match spectrum.transmittance {
        Some(_) => format!("air before it: {most:.4} W/(m² sr nm); grey: transmittance to 1"),
        None => format!("{most:.4} W/(m² sr nm)"),
    };
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

/// Wavelengths, radiances and transmittances, one a line.
fn csv(spectrum: &Spectrum) -> String {
    let mut text = match spectrum.transmittance {
        Some(_) => "wavelength_nm,path_radiance_W_m-2_sr-1_nm-1,transmittance\n".to_owned(),
        None => "wavelength_nm,radiance_W_m-2_sr-1_nm-1\n".to_owned(),
    };
    let rows = spectrum.wavelengths_nm.iter().zip(&spectrum.radiance);
    for (k, (nm, radiance)) in rows.enumerate() {
        let _ = write!(text, "{nm},{radiance}");
        if let Some(transmittance) = &spectrum.transmittance {
            let _ = write!(text, ",{}", transmittance[k]);
        }
        text.push('\n');
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
            transmittance: None,
            xyz: [1.0; 3],
        };
        assert_eq!(
            csv(&spectrum),
            "wavelength_nm,radiance_W_m-2_sr-1_nm-1\n440,0.25\n550.5,0.000000001\n"
        );
        let before_ground = Spectrum {
            transmittance: Some(vec![0.5, 0.75]),
            ..spectrum
        };
        assert_eq!(
            csv(&before_ground),
            "wavelength_nm,path_radiance_W_m-2_sr-1_nm-1,transmittance\n440,0.25,0.5\n550.5,0.000000001,0.75\n"
        );
        assert_eq!(
            [length(431.26), length(12_345.6)],
            ["431.26 m", "12.346 km"]
        );
        assert_eq!(significant(12345.678), 12346.0);
        assert_eq!(significant(0.0), 0.0);
    }
}
