//! Files that the viewer opens and saves: scenes, photographs, terrain and pictures.

use super::Viewer;
#[cfg(not(target_arch = "wasm32"))]
use super::luminances;
use crate::compute::Light;
#[cfg(target_arch = "wasm32")]
use crate::page_files::{self, PageFile, PendingPicture};
#[cfg(not(target_arch = "wasm32"))]
use crate::photograph;
use crate::picture::{Shot, tone_mapper};
use crate::state::State;
#[cfg(not(target_arch = "wasm32"))]
use crate::time_lapse::TimeLapse;
use crate::{terrain, view};
#[cfg(not(target_arch = "wasm32"))]
use airlight::scene::Scene;
#[cfg(not(target_arch = "wasm32"))]
use airlight_image::rows::StoredRows;
use airlight_image::tone::ToneMapper;
#[cfg(not(target_arch = "wasm32"))]
use airlight_image::{Control, PictureOptions, Size, write_picture};
#[cfg(not(target_arch = "wasm32"))]
use airlight_render::overlay::OverlaySpec;
#[cfg(not(target_arch = "wasm32"))]
use airlight_render::{RenderError, Renderer};
use eframe::egui::{self, Ui};
#[cfg(target_arch = "wasm32")]
use eframe::wgpu;
use std::path::Path;

/// What the field of a file takes.
#[cfg(not(target_arch = "wasm32"))]
const FILE_HELP: &str = "A scene (.toml) to open or save, heights of terrain to open, or the picture to save: .exr, .hdr, .png, .jpg";
#[cfg(target_arch = "wasm32")]
const FILE_HELP: &str = "Name of the scene (.toml) or picture (.png, .hdr) to save";

impl Viewer {
    /// Opens the files that were dropped.
    #[cfg(not(target_arch = "wasm32"))]
    pub(super) fn take_files(&mut self, ui: &Ui) {
        for file in ui.input(|i| i.raw.dropped_files.clone()) {
            self.notice = self.open(file.path()).err();
        }
    }

    /// Reads the files that were dropped, opens those that have been read, and saves the picture whose pixels have come.
    #[cfg(target_arch = "wasm32")]
    pub(super) fn take_files(&mut self, ui: &Ui) {
        for file in ui.input(|i| i.raw.dropped_files.clone()) {
            self.page_files.read(file);
        }
        while let Some(PageFile { path, contents }) = self.page_files.take() {
            let opened = contents.and_then(|contents| self.open_contents(&path, contents));
            self.notice = opened.err();
        }
        if let Some(picture) = self.saving.take() {
            // Devices of WebGL find out only here.
            let _ = self.render.device.poll(wgpu::PollType::Poll);
            match picture.pixels.has_arrived() {
                true => self.notice = picture.save().err(),
                false => {
                    self.saving = Some(picture);
                    ui.ctx().request_repaint();
                }
            }
        }
    }

    /// A file to open or to save: a scene, or the picture.
    pub(super) fn show_files(&mut self, ui: &mut Ui) {
        ui.horizontal(|ui| {
            let name = crate::widgets::name(ui, "File", true);
            let field = egui::TextEdit::singleline(&mut self.file).desired_width(84.0);
            ui.add(field).labelled_by(name.id).on_hover_text(FILE_HELP);
            #[cfg(not(target_arch = "wasm32"))]
            if let Some(lapse) = &self.time_lapse {
                let [saved, all] = lapse.progress();
                if ui.button("Stop").clicked() {
                    self.stop_time_lapse(format!("{saved} of {all} pictures are saved"));
                }
                return;
            }
            match [ui.button("Open").clicked(), ui.button("Save").clicked()] {
                [true, _] => self.open_file(),
                [_, true] => self.save_file(),
                _ => {}
            }
        });
    }

    /// Opens the file that is named, or on a page one that the user chooses.
    pub(super) fn open_file(&mut self) {
        #[cfg(not(target_arch = "wasm32"))]
        let opened = self.open(self.file.clone().as_ref());
        #[cfg(target_arch = "wasm32")]
        let opened = self.page_files.choose();
        self.notice = opened.err();
    }

    /// Saves the file that is named.
    pub(super) fn save_file(&mut self) {
        let file = self.file.clone();
        #[cfg(not(target_arch = "wasm32"))]
        let saved = self.save_all(file.as_ref());
        #[cfg(target_arch = "wasm32")]
        let saved = self.save(file.as_ref());
        self.notice = saved.err();
    }

    /// Opens a file whose contents are in memory: a scene, or heights as terrain (PNG, NPY, PFM).
    ///
    /// # Errors
    /// A sentence where a scene is invalid.
    pub fn open_contents(&mut self, file: &Path, contents: Vec<u8>) -> Result<(), String> {
        if terrain::is_name(file) {
            let name = file.display().to_string();
            self.contents.insert(name.clone(), contents);
            // Read again, also under a name that was read before.
            self.terrain = None;
            self.state.terrain = Some(crate::state::Terrain {
                file: Some(name),
                ..Default::default()
            });
            return Ok(());
        }
        let text = String::from_utf8(contents);
        let text = text.map_err(|_| {
            format!(
                "expected a scene (.toml) or heights of terrain (.png, .npy, .pfm), got `{}`",
                file.display()
            )
        })?;
        let state = State::from_toml(&text);
        self.state = state.map_err(|error| format!("scene `{}`: {error}", file.display()))?;
        Ok(())
    }

    /// Opens a scene file, a photograph (a picture with colours), its depth if there is one, or else heights as terrain.
    ///
    /// # Errors
    /// A sentence where a scene cannot be read or is invalid.
    #[cfg(not(target_arch = "wasm32"))]
    pub fn open(&mut self, file: &Path) -> Result<(), String> {
        if photograph::has_colours(file) {
            self.state = State {
                photograph: Some(OverlaySpec {
                    colour: file.to_owned(),
                    ..Default::default()
                }),
                ..photograph::usual_state()
            };
        } else if let Some(photograph) = &mut self.state.photograph
            && terrain::is_name(file)
        {
            photograph.depth = Some(file.to_owned());
        } else if terrain::is_name(file) {
            self.state.terrain = Some(crate::state::Terrain {
                file: Some(file.display().to_string()),
                ..Default::default()
            });
        } else {
            self.state = State::load(file).map_err(|error| error.to_string())?;
        }
        Ok(())
    }

    /// Saves as [`Self::save`] does, or begins to save the pictures of the scene's sequence.
    ///
    /// # Errors
    /// A sentence where the file cannot be written, or the sequence cannot be drawn.
    #[cfg(not(target_arch = "wasm32"))]
    pub fn save_all(&mut self, file: &Path) -> Result<(), String> {
        let is_scene = file.extension().is_some_and(|ending| ending == "toml");
        if is_scene || self.state.photograph.is_some() || self.state.scene.sequence.is_none() {
            return self.save(file);
        }
        let size = self.saved_size()?;
        let lapse = TimeLapse::new(&self.state.scene, size, file);
        self.time_lapse = Some(lapse.map_err(|error| error.to_string())?);
        self.play.is_on = false;
        Ok(())
    }

    /// Whether pictures of a sequence are being saved.
    #[cfg(not(target_arch = "wasm32"))]
    pub fn is_saving(&self) -> bool {
        self.time_lapse.is_some()
    }

    /// Saves the scene as TOML, or the picture in the format of the file's ending: in the size of the scene's camera, or as large as on
    /// the screen.
    ///
    /// # Errors
    /// A sentence where it cannot be written.
    #[cfg(not(target_arch = "wasm32"))]
    pub fn save(&mut self, file: &Path) -> Result<(), String> {
        if file.extension().is_some_and(|ending| ending == "toml") {
            let text = self.state.to_toml()?;
            return std::fs::write(file, text)
                .map_err(|error| format!("cannot write `{}`: {error}", file.display()));
        }
        if let Some(scene) = self.fogged() {
            return photograph::save(&scene, file).map_err(|error| error.to_string());
        }
        if self.state.is_drawn_by_library() {
            let size = self.saved_size()?;
            return save_by_library(&self.state.scene, size, file).map_err(|e| e.to_string());
        }
        let (shot, mapper) = self.saved_shot()?;
        let exposed = self.picture.light_of(&shot)?;
        let pixels = luminances(exposed, shot.exposure);
        let [width, height] = shot.size();
        let write = || {
            let rows = StoredRows::new(width, 3, pixels.as_flattened().to_vec())?;
            let size = Size::new(width, height)?;
            let options = PictureOptions::default();
            write_picture(file, size, &rows, &mapper, &options, Control::default())
        };
        write().map(drop).map_err(|error| error.to_string())
    }

    /// Saves the scene as TOML, or the picture as PNG or Radiance HDR by the ending of the name, as a download.
    ///
    /// # Errors
    /// A sentence where there is no picture yet, or for another ending.
    #[cfg(target_arch = "wasm32")]
    pub fn save(&mut self, file: &Path) -> Result<(), String> {
        if file.extension().is_some_and(|ending| ending == "toml") {
            return page_files::download(file, self.state.to_toml()?.as_bytes());
        }
        if self.state.is_drawn_by_library() {
            return Err("expected a scene that the graphics device draws whole; try saving it as .toml, for the program to draw".to_owned());
        }
        PendingPicture::check_name(file)?;
        let (shot, tone) = self.saved_shot()?;
        let pixels = self.picture.pending_light_of(&shot, || {})?;
        self.saving = Some(PendingPicture {
            file: file.to_owned(),
            size: shot.size(),
            pixels,
            exposure: shot.exposure,
            tone,
        });
        Ok(())
    }

    /// The picture that is saved, exposed so that its texture holds the sun, and how a display shows its light.
    pub(super) fn saved_shot(&mut self) -> Result<(Shot, ToneMapper), String> {
        let size = self.saved_size()?;
        let frame = view::frame_of(&self.state, size, self.facts().sun_azimuth_deg)?;
        let metered = self.metered.take();
        let shot = self.shot(frame);
        self.metered = metered;
        let shot = shot.ok_or("expected light to save, got none yet")?;
        let tone = tone_mapper(&self.state.scene.output, shot.exposure);
        let tone = tone.ok_or("expected tone settings in their ranges")?;
        let exposure = shot.exposure.min(self.light().map_or(1.0, sun_exposure));
        Ok((Shot { exposure, ..shot }, tone))
    }

    /// Width and height of the picture that is saved, pixels.
    pub(super) fn saved_size(&self) -> Result<[u32; 2], String> {
        let drawn = self.drawn;
        let (_, shot) = drawn.ok_or("expected a picture to save, got none yet")?;
        Ok(self.state.scene.camera.size.unwrap_or(shot.size()))
    }
}

/// Writes the picture of a scene as `airlight sky` does.
#[cfg(not(target_arch = "wasm32"))]
fn save_by_library(scene: &Scene, size: [u32; 2], file: &Path) -> Result<(), RenderError> {
    let mut scene = scene.clone();
    scene.camera.size = Some(size);
    scene.output.file = Some(file.display().to_string());
    let renderer = Renderer::new(&scene)?;
    let suns = renderer.suns_near(&renderer.sun(None)?);
    let prepared = renderer.prepare(suns, Control::default())?;
    let frame = renderer.frame(prepared.as_ref(), None)?;
    frame.write(file, Control::default()).map(drop)
}

/// Exposure at which half floats hold the sun's disc, whose centre is at most twice as bright as its mean.
fn sun_exposure(light: &Light) -> f32 {
    let solid_angle = std::f32::consts::TAU * light.tables.first.disc.one_minus_cos;
    let mean = light.tables.lighting.sun_illuminance_lx.max_element() / solid_angle;
    f32::from(half::f16::MAX) / (2.0 * mean).max(1.0)
}
