//! The picture or photograph on the screen, and the notes on it.

use super::Viewer;
use crate::compute::{Light, SPACE};
use crate::picture::{Shot, tone_of};
#[cfg(not(target_arch = "wasm32"))]
use crate::time_lapse::TimeLapse;
use crate::{lights, reading, view};
use airlight::scene::OutputSpec;
use airlight_image::Frame;
use airlight_image::tone::Exposure;
use airlight_render::exposure::{ExposureSettings, METERED_WIDTH, MeteredPicture};
#[cfg(not(target_arch = "wasm32"))]
use airlight_render::overlay::OverlayScene;
#[cfg(not(target_arch = "wasm32"))]
use eframe::egui;
use eframe::egui::{Align2, Color32, FontId, Rect, Ui, pos2, vec2};
use eframe::wgpu;
use std::sync::atomic::Ordering;

impl Viewer {
    /// What the picture shows in a projection; `None` before the first light.
    pub fn shot(&mut self, frame: Frame) -> Option<Shot> {
        let light = self.light.as_ref()?;
        let output = &self.state.scene.output;
        let metered = (self.number_of_light(), frame, output.clone());
        let exposure = match self.metered.take().filter(|(of, _)| *of == metered) {
            Some((_, exposure)) => exposure,
            None => exposure(light, &frame, output)?,
        };
        self.metered = Some((metered, exposure));
        Some(Shot {
            frame,
            ground: self.ground(),
            exposure: exposure.factor() as f32,
            tone: tone_of(output),
        })
    }

    /// Why no light of the scene shines, as a sentence.
    pub fn light_error(&self) -> Option<&str> {
        self.lights.as_ref().err().map(String::as_str)
    }

    pub(super) fn show_picture(&mut self, ui: &mut Ui) {
        let area = ui.available_rect_before_wrap();
        let rect = view::part_of(area, &self.state);
        let scale = self.pixels_per_point(ui, rect);
        let size = [rect.width(), rect.height()].map(|v| ((v * scale).round() as u32).max(1));
        match view::frame_of(&self.state, size, self.facts().sun_azimuth_deg) {
            Ok(frame) => {
                self.unframed = None;
                self.show_frame(ui, rect, frame);
            }
            Err(sentence) => self.unframed = Some(sentence),
        }
        self.show_notes(ui, area);
        #[cfg(not(target_arch = "wasm32"))]
        self.read_pixel();
        if let Some(direction) = self.direction
            && !reading::show(ui, &self.reading(direction))
        {
            self.direction = None;
        }
    }

    /// Pixels of the picture along a point: as many as the device can draw at most.
    pub(super) fn pixels_per_point(&self, ui: &Ui, rect: Rect) -> f32 {
        let largest = self.render.device.limits().max_texture_dimension_2d as f32;
        let most = largest / rect.size().max_elem().max(1.0);
        (ui.pixels_per_point() * self.resolution).min(most)
    }

    /// Shows the photograph in fog, as large as fits.
    #[cfg(not(target_arch = "wasm32"))]
    pub(super) fn show_photograph(&mut self, ui: &mut Ui) {
        let area = ui.available_rect_before_wrap();
        if let Some(scene) = self.fogged() {
            self.photographs.update(&scene);
        }
        if let Some(Ok(fogged)) = self.photographs.answer() {
            let is_shown = |(of, _): &(OverlayScene, _)| *of == fogged.scene;
            if !self.fogged_texture.as_ref().is_some_and(is_shown) {
                let size = fogged.size.map(|v| v as usize);
                let image = egui::ColorImage::from_rgb(size, &fogged.rgb);
                let options = egui::TextureOptions::LINEAR;
                let texture = ui.ctx().load_texture("photograph", image, options);
                self.fogged_texture = Some((fogged.scene.clone(), texture));
                self.frames += 1;
            }
        }
        if let Some((_, texture)) = &self.fogged_texture {
            let size = texture.size_vec2();
            let scale = (area.size() / size).min_elem();
            let at = Rect::from_center_size(area.center(), size * scale);
            let whole = Rect::from_min_max(pos2(0.0, 0.0), pos2(1.0, 1.0));
            ui.painter().image(texture.id(), at, whole, Color32::WHITE);
        }
        self.show_notes(ui, area);
    }

    /// States that a page reads no files.
    #[cfg(target_arch = "wasm32")]
    pub(super) fn show_photograph(&mut self, ui: &mut Ui) {
        self.notice =
            Some("expected a sky, got a photograph, which the page cannot read".to_owned());
        self.show_notes(ui, ui.available_rect_before_wrap());
    }

    /// Shows the picture of a frame in a rectangle, and takes the input on it.
    pub(super) fn show_frame(&mut self, ui: &mut Ui, rect: Rect, frame: Frame) {
        let orbit = self.orbit(&frame);
        let navigation = (self.navigation, &orbit);
        let (state, dragged) = (&mut self.state, &mut self.dragged);
        let response = view::interact(ui, rect, state, &frame, navigation, dragged);
        if response.clicked()
            && let Some(at) = response.interact_pointer_pos()
            && let Some(direction) = view::pixel_direction_at(rect, at, &frame)
        {
            self.direction = Some(direction);
        }
        if let Some(shot) = self.shot(frame) {
            self.draw(&shot);
        }
        if let Some(texture) = self.texture {
            let size = [frame.size().width(), frame.size().height()];
            let scale = self.pixels_per_point(ui, rect);
            let shown = vec2(size[0] as f32, size[1] as f32) / scale;
            let whole = Rect::from_min_max(pos2(0.0, 0.0), pos2(1.0, 1.0));
            let at = Rect::from_min_size(rect.min, shown);
            ui.painter().image(texture, at, whole, Color32::WHITE);
            self.show_library_picture(ui, at);
            self.show_comparison(ui, at);
        }
        if self.dragged == Some(view::Handle::Sun) {
            view::mark_sun(ui, rect, &self.state, &frame);
        }
    }

    /// Puts the scene's lights into the picture. True if they are others than before.
    pub(super) fn shine(&mut self, frame: &Frame) -> bool {
        let Some(light) = &self.light else {
            return false;
        };
        let eye_height_m = f64::from(light.tables.first.sky.view.height_m);
        let around = lights::around(&self.state, frame, eye_height_m);
        if around == self.lights {
            return false;
        }
        let shining = around.as_deref().unwrap_or_default();
        let set = self.picture.set_lights(shining);
        self.lights = set.map_err(|error| error.to_string()).and(around);
        true
    }

    /// Draws the picture if it shows something else than before.
    pub(super) fn draw(&mut self, shot: &Shot) {
        if self.is_lost.load(Ordering::Relaxed) {
            self.error =
                Some("the graphics device was lost; save the scene and start again".to_owned());
            return;
        }
        let drawn = (self.number_of_light(), *shot);
        if !self.shine(&shot.frame) && self.drawn == Some(drawn) {
            return;
        }
        let is_new = self.picture.draw(shot);
        self.drawn = Some(drawn);
        self.frames += 1;
        let Some(shown) = self.picture.shown().filter(|_| is_new) else {
            return;
        };
        let mut renderer = self.render.renderer.write();
        // Texels lie on pixels, one on each or on several, or several on each, whose mean is shown.
        let filter = match self.resolution > 1.0 {
            true => wgpu::FilterMode::Linear,
            false => wgpu::FilterMode::Nearest,
        };
        let device = &self.render.device;
        match self.texture {
            Some(texture) => {
                renderer.update_egui_texture_from_wgpu_texture(device, shown, filter, texture);
            }
            None => {
                self.texture = Some(renderer.register_native_texture(device, shown, filter));
            }
        }
    }

    /// What is not in the picture: that light is being computed, or why there is none.
    pub(super) fn show_notes(&self, ui: &Ui, rect: Rect) {
        let note = match (&self.error, &self.asked) {
            _ if self.notice.is_some() => self.notice.clone().unwrap_or_default(),
            _ if self.unframed.is_some() => self.unframed.clone().unwrap_or_default(),
            _ if self.terrain_error().is_some() => {
                self.terrain_error().unwrap_or_default().to_owned()
            }
            #[cfg(not(target_arch = "wasm32"))]
            _ if self.state.photograph.is_some() => match self.photograph() {
                Some(Err(sentence)) => sentence.to_owned(),
                Some(Ok(_)) => return,
                None => "reading …".to_owned(),
            },
            _ if self.light_error().is_some() => self.light_error().unwrap_or_default().to_owned(),
            #[cfg(not(target_arch = "wasm32"))]
            _ if self.time_lapse.is_some() => {
                let [saved, all] = self.time_lapse.as_ref().map_or([0; 2], TimeLapse::progress);
                format!("{saved} of {all} pictures are saved …")
            }
            (Some(error), _) => error.clone(),
            (None, Some(_)) => "solving …".to_owned(),
            (None, None) => match self.judgement().filter(|_| self.has_panel) {
                Some(text) => text,
                None => return,
            },
        };
        let at = rect.left_bottom() + vec2(12.0, -10.0);
        let font = FontId::proportional(12.0);
        let painter = ui.painter();
        let galley = painter.layout(note, font, Color32::from_gray(235), rect.width() - 24.0);
        let place = Align2::LEFT_BOTTOM.anchor_size(at, galley.size());
        painter.rect_filled(place.expand(5.0), 4.0, Color32::from_black_alpha(150));
        painter.galley(place.min, galley, Color32::WHITE);
    }
}

/// The exposure of a picture, metered as the program `airlight` does.
fn exposure(light: &Light, frame: &Frame, output: &OutputSpec) -> Option<Exposure> {
    let frame = frame.preview(METERED_WIDTH);
    let small = frame.size();
    let pixels = (0..small.height()).flat_map(|j| (0..small.width()).map(move |i| (i, j)));
    let colour = |(i, j)| match frame.pixel_direction(i, j) {
        Some(direction) => light.tables.rgb_radiance(direction.as_vec3()).to_array(),
        None => [0.0; 3],
    };
    let colours: Vec<[f32; 3]> = pixels.map(colour).collect();
    let facts = &light.facts;
    let picture = MeteredPicture::of_frame(
        &frame,
        &colours,
        SPACE,
        facts.horizon_deg.to_radians(),
        facts.sun_lx + facts.sky_lx,
    );
    ExposureSettings::of(output).metered(&picture).ok()
}
