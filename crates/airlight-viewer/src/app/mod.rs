//! [`Viewer`]: state, light and picture together.

mod comparison;
mod drawing;
mod files;
mod pixel;
mod terrain;
mod time;

use crate::beside::Beside;
use crate::command::command_line;
use crate::compute::{Answer, Facts, Light, Output, Request, Task};
use crate::examples::{self, EXAMPLES};
use crate::options::Options;
#[cfg(target_arch = "wasm32")]
use crate::page_files::{PageFiles, PendingPicture};
#[cfg(not(target_arch = "wasm32"))]
use crate::photograph::{FoggedPhotograph, PhotographWorker};
use crate::picture::{HAS_SHADOWS, Picture, Shot};
use crate::platform::Worker;
use crate::play::Play;
use crate::state::{CompareMode, History, State};
use crate::terrain::LoadedTerrain;
#[cfg(not(target_arch = "wasm32"))]
use crate::time_lapse::TimeLapse;
use crate::timers::Times;
use crate::view::Navigation;
use crate::widgets::choice;
use crate::{panel, style, view};
use airlight::fog::lights::Light as FogLight;
use airlight::scene::{OutputSpec, Scene};
use airlight_gpu::SkyRendererError;
use airlight_image::Frame;
use airlight_image::tone::Exposure;
#[cfg(not(target_arch = "wasm32"))]
use airlight_render::overlay::OverlayScene;
use eframe::egui::{self, Color32, Key, TextureId, Ui};
use eframe::egui_wgpu::RenderState;
use eframe::wgpu;
use glam::DVec3;
use std::collections::BTreeMap;
use std::fmt;
use std::sync::Arc;
#[cfg(not(target_arch = "wasm32"))]
use std::sync::Mutex;
use std::sync::atomic::{AtomicBool, Ordering};

/// Why there is no viewer.
#[derive(Debug, thiserror::Error)]
#[non_exhaustive]
pub enum ViewerError {
    /// There is no graphics device.
    #[error(
        "expected a graphics device, got none; try installing a Vulkan driver, such as mesa-vulkan-drivers on Debian"
    )]
    NoDevice,
    /// The device cannot draw the picture.
    #[error(transparent)]
    Renderer(#[from] SkyRendererError),
    /// The window cannot be opened.
    #[error("cannot open a window: {0}")]
    Window(String),
    /// There is no display to open a window on.
    #[error(
        "cannot open a window: no display is reached; try setting DISPLAY or WAYLAND_DISPLAY, or drawing into a file"
    )]
    NoDisplay,
    /// A picture is larger than the device can draw.
    #[error("expected at most {largest} pixels on a side on this graphics device, got {} x {}", size[0], size[1])]
    TooLarge {
        /// Width and height, pixels.
        size: [u32; 2],
        /// Most pixels on a side.
        largest: u32,
    },
    /// The scene's camera draws no picture.
    #[error("{0}")]
    Camera(String),
    /// The device does not return pixels.
    #[error("cannot read the pixels back: {0}")]
    Pixels(String),
    /// The picture cannot be written.
    #[error(transparent)]
    Image(#[from] airlight_image::ImageError),
}

/// The program.
pub struct Viewer {
    state: State,
    /// The state that undo does not leave: the last one that was not under change.
    settled: State,
    history: History,
    has_panel: bool,
    play: Play,
    /// Pixels of the picture along a pixel of the display: fewer draw faster, more smooth the edges of terrain.
    resolution: f32,
    navigation: Navigation,
    dragged: Option<view::Handle>,
    worker: Worker,
    /// Taken out while it works with what else is here.
    beside: Option<Beside>,
    /// Direction whose light is read.
    direction: Option<DVec3>,
    /// A pixel of terrain: the picture that it was read in, its direction, and its red, green and blue, cd/m^2.
    pixel: Option<(Drawn, DVec3, [f32; 3])>,
    /// The comparison on the screen, and what of it: the right side or the map, and the left side if that is a model.
    compared: Option<(Compared, [Option<egui::TextureHandle>; 2])>,
    /// The picture that the library has drawn: its scene, and the shot that it is exposed as.
    library_picture: Option<(Scene, Shot, egui::TextureHandle)>,
    number: u64,
    /// The scene that light is being computed for.
    asked: Option<Lit>,
    /// The scene that was answered last, with light or not.
    answered: Option<Lit>,
    error: Option<String>,
    light: Option<Box<Light>>,
    metered: Option<(Metered, Exposure)>,
    picture: Picture,
    /// Whether the picture has timers.
    is_timed: bool,
    render: RenderState,
    texture: Option<TextureId>,
    drawn: Option<Drawn>,
    frames: u64,
    /// Why the camera draws no picture.
    unframed: Option<String>,
    terrain: Option<LoadedTerrain>,
    /// The lights in the picture, or why there are none.
    lights: Result<Vec<FogLight<[f32; 3]>>, String>,
    #[cfg(not(target_arch = "wasm32"))]
    photographs: PhotographWorker,
    /// The photograph on the screen, and what it was fogged with.
    #[cfg(not(target_arch = "wasm32"))]
    fogged_texture: Option<(OverlayScene, egui::TextureHandle)>,
    /// Why a file was not opened or saved.
    notice: Option<String>,
    /// Name of a file to open or save.
    file: String,
    /// Contents of files of heights that were opened from memory, by name.
    contents: BTreeMap<String, Vec<u8>>,
    #[cfg(target_arch = "wasm32")]
    page_files: PageFiles,
    /// The picture that is being saved.
    #[cfg(target_arch = "wasm32")]
    saving: Option<PendingPicture>,
    /// Whether the graphics device is gone.
    is_lost: Arc<AtomicBool>,
    /// Where to leave what is shown when it goes.
    #[cfg(not(target_arch = "wasm32"))]
    left: Option<Arc<Mutex<Option<Options>>>>,
    /// Times of the passes of the last picture, where they are wanted.
    times: Times,
    /// Pictures that are being saved.
    #[cfg(not(target_arch = "wasm32"))]
    time_lapse: Option<TimeLapse>,
}

/// What an exposure was metered for: the number of the light, projection and settings.
type Metered = (u64, Frame, OutputSpec);

/// What light is solved for: the scene, and whether it has terrain that throws shadows.
type Lit = (Scene, bool);

/// What a comparison on the screen shows: shot, mode and the number of the comparison.
type Compared = (Shot, CompareMode, u64);

/// What the picture was drawn for: the number of the light and the shot.
type Drawn = (u64, Shot);

impl fmt::Debug for Viewer {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.debug_struct("Viewer")
            .field("state", &self.state)
            .field("error", &self.error)
            .field("frames", &self.frames)
            .finish_non_exhaustive()
    }
}

impl Viewer {
    /// A viewer on a device.
    ///
    /// # Errors
    /// [`ViewerError::Renderer`] where the device cannot draw the picture, [`ViewerError::Camera`] for a camera that draws none.
    pub fn new(
        context: &egui::Context,
        render: RenderState,
        options: Options,
    ) -> Result<Self, ViewerError> {
        let size = options.size.map(|v| v.max(1.0) as u32);
        view::frame_of(&options.state, size, 0.0).map_err(ViewerError::Camera)?;
        style::apply(context);
        let repaint = context.clone();
        let beside = context.clone();
        #[cfg(not(target_arch = "wasm32"))]
        let photographs = context.clone();
        #[cfg(target_arch = "wasm32")]
        let files = context.clone();
        let is_lost = Arc::new(AtomicBool::new(false));
        let lost = is_lost.clone();
        render
            .device
            .set_device_lost_callback(move |_, _| lost.store(true, Ordering::Relaxed));
        Ok(Self {
            is_lost,
            settled: options.state.clone(),
            state: options.state,
            history: History::default(),
            has_panel: options.panel,
            play: Play::default(),
            resolution: 1.0,
            navigation: Navigation::default(),
            dragged: None,
            worker: Worker::new(move || repaint.request_repaint()),
            beside: Some(Beside::new(move || beside.request_repaint())),
            direction: None,
            pixel: None,
            compared: None,
            library_picture: None,
            number: 0,
            asked: None,
            answered: None,
            error: None,
            light: None,
            metered: None,
            picture: Picture::new(&render.device, &render.queue)?,
            is_timed: false,
            render,
            texture: None,
            drawn: None,
            frames: 0,
            unframed: None,
            terrain: None,
            lights: Ok(Vec::new()),
            #[cfg(not(target_arch = "wasm32"))]
            photographs: PhotographWorker::new(move || photographs.request_repaint()),
            #[cfg(not(target_arch = "wasm32"))]
            fogged_texture: None,
            notice: None,
            file: "scene.toml".to_owned(),
            contents: BTreeMap::new(),
            #[cfg(target_arch = "wasm32")]
            page_files: PageFiles::new(move || files.request_repaint()),
            #[cfg(target_arch = "wasm32")]
            saving: None,
            #[cfg(not(target_arch = "wasm32"))]
            left: None,
            times: Times::default(),
            #[cfg(not(target_arch = "wasm32"))]
            time_lapse: None,
        })
    }

    /// Closes the window when the graphics device is lost, and leaves there what it showed, with which another can be opened.
    #[cfg(not(target_arch = "wasm32"))]
    pub fn close_on_loss(&mut self, left: Arc<Mutex<Option<Options>>>) {
        // What else reports errors of a device that is lost would end the program.
        let is_lost = self.is_lost.clone();
        self.render
            .device
            .on_uncaptured_error(Arc::new(move |error| {
                assert!(is_lost.load(Ordering::Relaxed), "wgpu error: {error}");
            }));
        self.left = Some(left);
    }

    /// Leaves what is shown and closes the window once the device is lost. True if it closes, and nothing can be drawn.
    #[cfg(not(target_arch = "wasm32"))]
    fn leaves(&mut self, ui: &Ui) -> bool {
        let Some(left) = &self.left else {
            return false;
        };
        if !self.is_lost.load(Ordering::Relaxed) {
            return false;
        }
        if let Ok(mut left) = left.lock() {
            *left = Some(Options {
                state: self.state.clone(),
                size: ui.ctx().content_rect().size().into(),
                panel: self.has_panel,
            });
        }
        ui.ctx().send_viewport_cmd(egui::ViewportCommand::Close);
        true
    }

    /// What the user has set.
    pub fn state(&self) -> &State {
        &self.state
    }

    /// Sets everything, as a step that can be undone.
    pub fn set_state(&mut self, state: State) {
        self.state = state;
    }

    /// The light that is shown.
    pub fn light(&self) -> Option<&Light> {
        self.light.as_deref()
    }

    /// Why the scene has no light, as a sentence.
    pub fn error(&self) -> Option<&str> {
        self.error.as_deref()
    }

    /// Whether the picture shows the state: nothing is being computed.
    pub fn is_current(&self) -> bool {
        #[cfg(not(target_arch = "wasm32"))]
        if let Some(scene) = self.fogged() {
            return self.photographs.is_current(&scene);
        }
        let has_light = self.is_lit();
        let beside = self.beside.as_ref().zip(self.wanted());
        has_light && beside.is_none_or(|(beside, wanted)| beside.is_current(&wanted))
    }

    /// What light the state needs.
    fn lit(&self) -> Lit {
        let has_shadows = HAS_SHADOWS && self.state.terrain.is_some();
        (self.state.lit_scene(), has_shadows)
    }

    /// Whether the last answer is that of the state.
    fn is_lit(&self) -> bool {
        self.asked.is_none() && self.answered.as_ref() == Some(&self.lit())
    }

    /// The device that draws.
    pub fn device(&self) -> &wgpu::Device {
        &self.render.device
    }

    /// Number of frames drawn so far. A window that shows the same again draws none.
    pub fn frames(&self) -> u64 {
        self.frames
    }

    /// Size of the picture, pixels, and the light of its pixels: red, green and blue of linear sRGB, cd/m^2. Empty before the first frame.
    ///
    /// # Errors
    /// [`ViewerError::Pixels`] where the device does not return them.
    #[cfg(not(target_arch = "wasm32"))]
    pub fn pixels(&self) -> Result<([u32; 2], Vec<[f32; 3]>), ViewerError> {
        let Some((_, shot)) = self.drawn else {
            return Ok(([0, 0], Vec::new()));
        };
        let exposed = self.picture.light().map_err(ViewerError::Pixels)?;
        Ok((shot.size(), luminances(exposed, shot.exposure)))
    }

    /// The photograph in fog that is shown.
    #[cfg(not(target_arch = "wasm32"))]
    pub fn photograph(&self) -> Option<Result<&FoggedPhotograph, &str>> {
        self.state.photograph.as_ref()?;
        self.photographs.answer()
    }

    /// The photograph and its fog.
    #[cfg(not(target_arch = "wasm32"))]
    fn fogged(&self) -> Option<OverlayScene> {
        let photograph = self.state.photograph.clone()?;
        Some(self.state.fogged(photograph))
    }

    /// Shows the controls and the picture.
    pub fn show(&mut self, ui: &mut Ui) {
        #[cfg(not(target_arch = "wasm32"))]
        if self.leaves(ui) {
            return;
        }
        self.take_answers();
        self.shortcuts(ui);
        self.pass_time(ui);
        self.take_files(ui);
        self.take_times(ui);
        #[cfg(not(target_arch = "wasm32"))]
        self.advance_time_lapse(ui);
        if self.has_panel {
            let facts = self.facts();
            let ev100 = self.metered.as_ref().map_or(15.0, |(_, e)| e.ev100());
            egui::Panel::right("controls")
                .resizable(false)
                .exact_size(style::PANEL_WIDTH)
                .frame(style::panel_frame())
                .show(ui, |ui| {
                    egui::ScrollArea::vertical().show(ui, |ui| {
                        ui.set_width(ui.available_width());
                        ui.heading("Airlight");
                        self.show_actions(ui);
                        let state = &mut self.state;
                        let shown = panel::Shown {
                            play: &mut self.play,
                            navigation: &mut self.navigation,
                            resolution: &mut self.resolution,
                            times: &mut self.times,
                        };
                        panel::show(ui, state, shown, &facts, ev100);
                    });
                });
        }
        egui::CentralPanel::default()
            .frame(egui::Frame::NONE.fill(Color32::BLACK))
            .show(ui, |ui| match self.state.photograph.is_some() {
                true => self.show_photograph(ui),
                false => self.show_picture(ui),
            });
        if self.state.photograph.is_none() {
            self.stand_on_terrain();
            self.ask();
            self.update_beside();
        }
        self.settle(ui);
    }

    /// Undo, examples, files and the command line.
    fn show_actions(&mut self, ui: &mut Ui) {
        ui.horizontal(|ui| {
            let [undo, redo] = self.history.can();
            let button = |ui: &mut Ui, enabled, text| {
                ui.add_enabled(enabled, egui::Button::new(text)).clicked()
            };
            if button(ui, undo, "Undo") {
                self.step_back();
            }
            if button(ui, redo, "Redo") {
                self.step_forward();
            }
            if button(ui, true, "Reset") {
                self.state = State::default();
            }
            let command = command_line(&self.state);
            let copy = ui.button("Copy command").on_hover_text(&command);
            if copy.clicked() {
                ui.ctx().copy_text(command);
            }
        });
        let mut chosen = "";
        let mut named = vec![("", "choose a scene".to_owned())];
        named.extend(
            EXAMPLES
                .iter()
                .map(|(name, toml)| (*toml, (*name).to_owned())),
        );
        if choice(ui, "Examples", &mut chosen, &named)
            && let Some(state) = examples::state(chosen)
        {
            self.state = state;
        }
        self.show_files(ui);
    }

    fn step_back(&mut self) {
        if let Some(state) = self.history.undo(&self.state) {
            self.settled = state.clone();
            self.state = state;
        }
    }

    fn step_forward(&mut self) {
        if let Some(state) = self.history.redo(&self.state) {
            self.settled = state.clone();
            self.state = state;
        }
    }

    fn facts(&self) -> Facts {
        self.light
            .as_ref()
            .map(|light| light.facts)
            .unwrap_or_default()
    }

    fn number_of_light(&self) -> u64 {
        self.number
    }

    fn take_answers(&mut self) {
        while let Some(answer) = self.worker.receive() {
            self.take(answer);
        }
    }

    fn take(&mut self, answer: Answer) {
        self.answered = self.asked.take();
        self.notice = None;
        if self.is_lost.load(Ordering::Relaxed) {
            return;
        }
        match answer.result {
            Ok(Output::Light(light)) => {
                self.picture.set_light(&light);
                self.light = Some(light);
                self.number = answer.number;
                self.error = None;
            }
            Ok(_) => {}
            Err(sentence) => self.error = Some(sentence),
        }
    }

    /// Waits for the light or the photograph that is being computed.
    #[cfg(not(target_arch = "wasm32"))]
    pub fn wait(&mut self) {
        if self.state.photograph.is_some() {
            self.photographs.wait();
            return;
        }
        if self.asked.is_some()
            && let Some(answer) = self.worker.wait()
        {
            self.take(answer);
        } else {
            let Some(mut beside) = self.beside.take() else {
                return;
            };
            if let Some(wanted) = self.wanted() {
                beside.wait(&wanted);
            }
            self.beside = Some(beside);
        }
    }

    /// Asks for the light of the state, unless other light is being computed.
    fn ask(&mut self) {
        let lit = self.lit();
        if self.asked.is_none() && self.answered.as_ref() != Some(&lit) {
            let (scene, has_terrain) = lit.clone();
            let request = Request {
                number: self.number + 1,
                scene,
                task: Task::Light { has_terrain },
            };
            match self.worker.send(request) {
                true => self.asked = Some(lit),
                false => self.error = Some("expected a thread that computes, got none".to_owned()),
            }
        }
    }

    fn shortcuts(&mut self, ui: &Ui) {
        let pressed = |modifiers, key| ui.input_mut(|i| i.consume_key(modifiers, key));
        let command = egui::Modifiers::COMMAND;
        let redo = pressed(command | egui::Modifiers::SHIFT, Key::Z) || pressed(command, Key::Y);
        match (redo, pressed(command, Key::Z)) {
            (true, _) => self.step_forward(),
            (false, true) => self.step_back(),
            _ => {}
        }
        if pressed(egui::Modifiers::NONE, Key::F2) {
            self.has_panel = !self.has_panel;
        }
        if pressed(command, Key::O) {
            self.open_file();
        }
        if pressed(command, Key::S) {
            self.save_file();
        }
    }

    /// Keeps the state for undo, once the pointer is released and time does not pass.
    fn settle(&mut self, ui: &Ui) {
        #[cfg(not(target_arch = "wasm32"))]
        let is_saving = self.is_saving();
        #[cfg(target_arch = "wasm32")]
        let is_saving = false;
        let is_changing = self.play.is_on || is_saving || ui.input(|i| i.pointer.any_down());
        if self.state != self.settled && !is_changing {
            let left = std::mem::replace(&mut self.settled, self.state.clone());
            self.history.push(left);
            #[cfg(target_arch = "wasm32")]
            crate::platform::keep(&self.state.to_fragment());
        }
    }
}

impl eframe::App for Viewer {
    fn ui(&mut self, ui: &mut Ui, _frame: &mut eframe::Frame) {
        self.show(ui);
    }
}

/// Exposed light as luminances, cd/m^2.
#[cfg(not(target_arch = "wasm32"))]
fn luminances(mut exposed: Vec<[f32; 3]>, exposure: f32) -> Vec<[f32; 3]> {
    for channel in exposed.as_flattened_mut() {
        *channel /= exposure;
    }
    exposed
}
