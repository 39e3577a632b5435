//! What the solver and the library compute beside the picture: spectra, errors, comparisons and what the device does not draw.

use super::Viewer;
use crate::beside::{Comparison, Sides, Wanted};
use crate::compute::{GroundLight, Target};
use crate::picture::{Shot, tone_mapper};
use crate::state::CompareMode;
use crate::truth;
use airlight::scene::{OutputSpec, Scene};
use eframe::egui::{self, Color32, Rect, Ui, pos2};

impl Viewer {
    /// What is wanted beside the picture, once it shows the state.
    pub(super) fn wanted(&self) -> Option<Wanted<'_>> {
        let light = self.light.as_deref()?;
        let (_, shot) = self.drawn?;
        if self.asked.is_some() || self.error.is_some() {
            return None;
        }
        let compare = self.state.compare.as_ref();
        Some(Wanted {
            number: self.number,
            light,
            scene: self.answered.as_ref().map(|(scene, _)| scene)?,
            frame: shot.frame,
            target: self.direction.map(|direction| Target {
                direction: direction.to_array(),
                ground: self.terrain_point(direction).map(|point| GroundLight {
                    distance_m: point.distance_m,
                    rgb: point.rgb.to_array(),
                }),
            }),
            sides: compare.map(|compare| {
                let (left, right) = (compare.left.as_deref(), compare.model.as_str());
                Sides {
                    left,
                    right,
                    size: compared_size(shot.size(), [left, Some(right)]),
                }
            }),
            picture: self.state.is_drawn_by_library().then(|| {
                let mut scene = self.state.scene.clone();
                scene.camera.size = Some(shot.size().map(|side| side.div_ceil(2)));
                scene.output = OutputSpec::default();
                scene
            }),
        })
    }

    /// Asks for and takes what is wanted beside the picture.
    pub(super) fn update_beside(&mut self) {
        if let Some(mut beside) = self.beside.take() {
            if let Some(wanted) = self.wanted() {
                beside.update(&wanted);
            }
            self.beside = Some(beside);
        }
    }

    /// Shows what the library draws over what the device draws.
    pub(super) fn show_library_picture(&mut self, ui: &Ui, at: Rect) {
        let Some((_, shot)) = self.drawn else {
            return;
        };
        let beside = self.beside.as_ref().zip(self.wanted());
        let Some((beside, wanted)) = &beside else {
            return;
        };
        let (Some(scene), Some(Ok(picture))) = (&wanted.picture, beside.picture(wanted)) else {
            return;
        };
        let is_shown = |(of, with, _): &(Scene, Shot, _)| (of, with) == (scene, &shot);
        if !self.library_picture.as_ref().is_some_and(is_shown) {
            let size = picture.size.map(|side| side as usize);
            let image = shown(picture.rgb, size, &self.state.scene.output, shot);
            let options = egui::TextureOptions::LINEAR;
            let load = |image| ui.ctx().load_texture("library", image, options);
            let texture = image.map(load);
            self.library_picture = texture.map(|texture| (scene.clone(), shot, texture));
        }
        if let Some((_, _, texture)) = &self.library_picture {
            let whole = Rect::from_min_max(pos2(0.0, 0.0), pos2(1.0, 1.0));
            ui.painter().image(texture.id(), at, whole, Color32::WHITE);
        }
    }

    /// Shows the comparison over the picture.
    pub(super) fn show_comparison(&mut self, ui: &Ui, at: Rect) {
        let (Some(compare), Some((_, shot))) = (self.state.compare.clone(), self.drawn) else {
            self.compared = None;
            return;
        };
        let beside = self.beside.as_ref().zip(self.wanted());
        let Some(comparison) = beside.as_ref().and_then(|(beside, w)| beside.comparison(w)) else {
            return;
        };
        let of = (shot, compare.mode, comparison.number);
        if self.compared.as_ref().is_none_or(|(shown, _)| *shown != of) {
            let images = compared(comparison, compare.mode, &self.state.scene.output, shot);
            let options = egui::TextureOptions::LINEAR;
            let load = |image| ui.ctx().load_texture("comparison", image, options);
            self.compared = Some((of, images.map(|image| image.map(load))));
        }
        let Some((_, [right, left])) = &self.compared else {
            return;
        };
        let line = match compare.mode {
            CompareMode::Split => compare.split.clamp(0.0, 1.0) as f32,
            _ => 0.0,
        };
        let x = at.left() + line * at.width();
        for (texture, [from, to]) in [(left, [0.0, line]), (right, [line, 1.0])] {
            let Some(texture) = texture else {
                continue;
            };
            let place = |part: f32| at.left() + part * at.width();
            let part = Rect::from_x_y_ranges(place(from)..=place(to), at.y_range());
            let texels = Rect::from_x_y_ranges(from..=to, 0.0..=1.0);
            ui.painter()
                .image(texture.id(), part, texels, Color32::WHITE);
        }
        if line > 0.0 {
            let stroke = egui::Stroke::new(1.0, Color32::from_white_alpha(170));
            ui.painter().vline(x, at.y_range(), stroke);
        }
    }

    /// The spectrum of the pixel that was clicked.
    pub fn spectrum(&self) -> Option<&crate::compute::Spectrum> {
        let (beside, wanted) = self.beside.as_ref().zip(self.wanted())?;
        beside.spectrum(&wanted)
    }

    /// What is known of the error of the picture and of its difference from a model: a sentence each, one a line.
    pub fn judgement(&self) -> Option<String> {
        let (beside, wanted) = self.beside.as_ref().zip(self.wanted())?;
        let mut text = beside
            .check(&wanted)
            .map(|s| format!("error against the solver: {}", sentence(s)));
        if let Some(beyond) = self.beyond_device() {
            let line = match beside.picture(&wanted) {
                _ if wanted.picture.is_none() => format!("not drawn: {beyond}"),
                None => format!("drawing {beyond} …"),
                Some(Ok(_)) => {
                    format!("drawn by the library, as the graphics device does not draw {beyond}")
                }
                Some(Err(refusal)) => refusal.to_owned(),
            };
            text = Some(text.map_or(line.clone(), |text| format!("{text}\n{line}")));
        }
        if let Some(sides) = wanted.sides {
            let line = match (beside.comparison(&wanted), beside.refusal(&wanted)) {
                (Some(comparison), _) => {
                    let paths = beside.paths(&wanted);
                    let mode = self.state.compare.as_ref().map(|compare| compare.mode);
                    described(comparison, sides, mode, paths)
                }
                (None, Some(refusal)) => refusal.to_owned(),
                (None, None) => format!("computing {} …", sides.right),
            };
            text = Some(text.map_or(line.clone(), |text| format!("{text}\n{line}")));
        }
        text
    }

    /// What of the scene the device does not draw, as a list in words.
    pub(super) fn beyond_device(&self) -> Option<String> {
        let beyond = self.state.beyond_device();
        (!beyond.is_empty()).then(|| beyond.join(", "))
    }
}

/// Size of compared pictures: half that of the picture, or few pixels where a model needs many paths for each.
fn compared_size(size: [u32; 2], models: [Option<&str>; 2]) -> [u32; 2] {
    /// Pixels across with Monte Carlo.
    const TRACED_WIDTH: u32 = 48;
    let half = size.map(|v| v.div_ceil(2));
    match models.contains(&Some("monte-carlo")) && half[0] > TRACED_WIDTH {
        true => [TRACED_WIDTH, (TRACED_WIDTH * half[1]).div_ceil(half[0])],
        false => half,
    }
}

/// Statistics in a sentence.
fn sentence(s: &truth::Statistics) -> String {
    format!(
        "luminance {:.2} % rms (largest {:+.1} %), CIEDE2000 {:.2} rms",
        s.rms_percent, s.worst_percent, s.rms_ciede2000
    )
}

/// A comparison in a sentence, with what its map means.
fn described(
    comparison: &Comparison,
    sides: Sides<'_>,
    mode: Option<CompareMode>,
    paths: Option<u64>,
) -> String {
    let statistics = comparison.statistics.as_ref();
    let mut line = match sides.left {
        Some(left) => format!("difference of {left} from {}: ", sides.right),
        None => format!("difference of the sky from {}: ", sides.right),
    };
    line += &statistics.map(sentence).unwrap_or_default();
    if let (Some(paths), Some(noise)) = (paths, comparison.noise) {
        line += &format!("; {paths} paths a direction, noise {:.1} %", 100.0 * noise);
    }
    if !comparison.ignored.is_empty() {
        line += &format!("; ignored: {}", comparison.ignored.join(", "));
    }
    match (statistics, mode) {
        (Some(s), Some(CompareMode::Luminance)) => {
            let left = sides.left.unwrap_or("the picture");
            let end = truth::end(s.rms_percent);
            line += &format!("; red: {left} is brighter, blue: darker, to {end} %");
        }
        (Some(s), Some(CompareMode::Colour)) => {
            let end = truth::end(s.rms_ciede2000);
            line += &format!("; black: none, white: {end} or more");
        }
        _ => {}
    }
    line
}

/// The pictures of a comparison: the right side or the map, and the left side if that is a model.
fn compared(
    comparison: &Comparison,
    mode: CompareMode,
    output: &OutputSpec,
    shot: Shot,
) -> [Option<egui::ColorImage>; 2] {
    let size = comparison.size.map(|v| v as usize);
    let shades = |end: Option<f64>, colour: fn(&truth::Difference, f64) -> Color32| {
        let end = end?;
        let differences = comparison.differences.iter();
        let pixels = differences.map(|d| d.as_ref().map_or(Color32::BLACK, |d| colour(d, end)));
        Some(egui::ColorImage::new(size, pixels.collect()))
    };
    let statistics = comparison.statistics;
    match mode {
        CompareMode::Split => {
            let left = comparison.left.as_ref();
            let right = shown(&comparison.right, size, output, shot);
            [right, left.and_then(|rgb| shown(rgb, size, output, shot))]
        }
        CompareMode::Luminance => {
            let end = statistics.map(|s| truth::end(s.rms_percent));
            [
                shades(end, |d, end| truth::percent_colour(d.percent, end)),
                None,
            ]
        }
        CompareMode::Colour => {
            let end = statistics.map(|s| truth::end(s.rms_ciede2000));
            [
                shades(end, |d, end| truth::ciede2000_colour(d.ciede2000, end)),
                None,
            ]
        }
    }
}

/// Light as the picture shows it; `None` for settings out of range.
fn shown(
    rgb: &[[f32; 3]],
    size: [usize; 2],
    output: &OutputSpec,
    shot: Shot,
) -> Option<egui::ColorImage> {
    let mapper = tone_mapper(output, shot.exposure)?;
    let row = 3 * size[0];
    let mut bytes = vec![0; row * size[1]];
    let rows = rgb.as_flattened().chunks(row);
    for (y, (linear, out)) in rows.zip(bytes.chunks_mut(row)).enumerate() {
        mapper.row_to_u8(y as u32, linear, out);
    }
    Some(egui::ColorImage::from_rgb(size, &bytes))
}
