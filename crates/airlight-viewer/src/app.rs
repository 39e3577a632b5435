//! [`Viewer`]: state, light and picture together.

use crate::beside::{Beside, Comparison, Sides, Wanted};
use crate::command::command_line;
use crate::compute::{Answer, Facts, GroundLight, Light, Output, Request, SPACE, Target, Task};
use crate::examples::{self, EXAMPLES};
use crate::options::Options;
#[cfg(target_arch = "wasm32")]
use crate::page_files::{self, PageFile, PageFiles, PendingPicture};
#[cfg(not(target_arch = "wasm32"))]
use crate::photograph::{self, FoggedPhotograph, PhotographWorker};
use crate::picture::{Ground, HAS_SHADOWS, Picture, Shot, tone_mapper, tone_of};
use crate::platform::Worker;
use crate::play::Play;
use crate::reading::Reading;
use crate::state::{CompareMode, History, State};
#[cfg(not(target_arch = "wasm32"))]
use crate::time_lapse::{Step, TimeLapse};
use crate::timers::Times;
use crate::view::{Navigation, Orbit};
use crate::widgets::choice;
use crate::{lights, panel, reading, style, terrain, truth, view};
use airlight::fog::lights::Light as FogLight;
use airlight::scene::{OutputSpec, Scene};
use airlight_gpu::{HeightField, SkyRendererError, TerrainPoint};
use airlight_image::Frame;
#[cfg(not(target_arch = "wasm32"))]
use airlight_image::rows::StoredRows;
use airlight_image::tone::{Exposure, ToneMapper};
#[cfg(not(target_arch = "wasm32"))]
use airlight_image::{Control, PictureOptions, Size, write_picture};
use airlight_render::exposure::{ExposureSettings, METERED_WIDTH, MeteredPicture};
#[cfg(not(target_arch = "wasm32"))]
use airlight_render::overlay::{OverlayScene, OverlaySpec};
#[cfg(not(target_arch = "wasm32"))]
use airlight_render::{RenderError, Renderer};
use eframe::egui::{self, Align2, Color32, FontId, Key, Rect, TextureId, Ui, pos2, vec2};
use eframe::egui_wgpu::RenderState;
use eframe::wgpu;
use glam::DVec3;
use std::collections::BTreeMap;
use std::fmt;
use std::path::Path;
use std::sync::Arc;
#[cfg(not(target_arch = "wasm32"))]
use std::sync::Mutex;
use std::sync::atomic::{AtomicBool, Ordering};

/// What the field of a file takes.
#[cfg(not(target_arch = "wasm32"))]
const FILE_HELP: &str = "A scene (.toml) to open or save, heights of terrain to open, or the picture to save: .exr, .hdr, .png, .jpg";
#[cfg(target_arch = "wasm32")]
const FILE_HELP: &str = "Name of the scene (.toml) or picture (.png, .hdr) to save";

/// Longest time that passes between two frames, s: after a pause, time goes on from where it stood.
const LONGEST_FRAME_S: f32 = 0.1;

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

/// Heights of a terrain's file, or why there are none.
#[derive(Debug)]
struct LoadedTerrain {
    file: Option<String>,
    spacing_m: Option<f64>,
    number: u64,
    heights: Result<HeightField, String>,
}

/// What an exposure was metered for: the number of the light, projection and settings.
type Metered = (u64, Frame, OutputSpec);

/// What light is solved for: the scene, and whether it has terrain that throws shadows.
type Lit = (Scene, bool);

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

    /// The ground that is drawn.
    fn ground(&self) -> Option<Ground> {
        let (terrain, loaded) = (self.state.terrain.as_ref()?, self.terrain.as_ref()?);
        loaded.heights.as_ref().ok()?;
        Some(Ground {
            number: loaded.number,
            place_m: [terrain.east_m, terrain.south_m],
        })
    }

    /// The terrain in a direction; `None` where there is none.
    fn terrain_point(&self, direction: DVec3) -> Option<TerrainPoint> {
        let view = self.picture.terrain_view(&self.ground()?)?;
        let heights = self.terrain.as_ref()?.heights.as_ref().ok()?;
        TerrainPoint::along(heights, &view, direction)
    }

    /// The eye, and the point of terrain or of the ground that it orbits, or where the picture shows the sky a point before it.
    fn orbit(&self, frame: &Frame) -> Orbit {
        /// Distance of a point before the sky relative to the height of the eye, and its least, m.
        const AHEAD: f64 = 10.0;
        const LEAST_AHEAD_M: f64 = 100.0;
        let facts = self.facts();
        let direction = view::centre(frame);
        let [height_m, ground_radius_m] = self.picture.eye_m();
        let altitude_m = self.state.scene.observer.altitude_m;
        let terrain_m = self.terrain_point(direction).map(|point| point.distance_m);
        let ground_m = || {
            // The nearer crossing of the sphere.
            let towards_m = -direction.y * (ground_radius_m + height_m);
            let square = towards_m * towards_m - height_m * (2.0 * ground_radius_m + height_m);
            (towards_m > 0.0 && square >= 0.0).then(|| towards_m - square.sqrt())
        };
        let ahead_m = (AHEAD * height_m).max(LEAST_AHEAD_M);
        Orbit {
            distance_m: terrain_m.or_else(ground_m).unwrap_or(ahead_m).max(1.0),
            altitude_m: altitude_m.unwrap_or(facts.altitude_m),
            lowest_m: facts.altitude_m - height_m + terrain::CLEARANCE_M,
        }
    }

    /// What is known of the light from a direction.
    fn reading(&self, direction: DVec3) -> Reading<'_> {
        let facts = self.facts();
        let point = self.terrain_point(direction);
        let beside = self.beside.as_ref().zip(self.wanted());
        let spectrum = beside.and_then(|(beside, wanted)| beside.spectrum(&wanted));
        Reading {
            direction,
            ground: point.map(|point| {
                let light = self.light.as_deref();
                let ground_m = light.map_or(0.0, Light::ground_altitude_m);
                [point.distance_m, ground_m + point.height_m]
            }),
            spectrum,
            drawn: match point {
                Some(_) => self.pixel_of(direction),
                None => self.sky_colour(direction),
            },
            facts,
        }
    }

    /// Red, green and blue of the sky that is drawn in a direction, cd/m^2.
    fn sky_colour(&self, direction: DVec3) -> Option<[f32; 3]> {
        let light = self.light.as_ref()?;
        let drawn = truth::drawn(light, &[direction.as_vec3().to_array()]);
        drawn.first().copied()
    }

    /// Red, green and blue of terrain that is drawn in a direction, cd/m^2; `None` where the device does not return them.
    fn pixel_of(&self, direction: DVec3) -> Option<[f32; 3]> {
        let (drawn, of, rgb) = self.pixel.as_ref()?;
        (Some(*drawn) == self.drawn && *of == direction).then_some(*rgb)
    }

    /// Reads back the pixel of terrain that the reading is open on, unless it is that of the picture before.
    #[cfg(not(target_arch = "wasm32"))]
    fn read_pixel(&mut self) {
        let (Some(direction), Some(drawn)) = (self.direction, self.drawn) else {
            return;
        };
        if self.pixel_of(direction).is_some() || self.terrain_point(direction).is_none() {
            return;
        }
        let (_, shot) = drawn;
        let Some((x, y)) = shot.frame.pixel_of(direction) else {
            return;
        };
        let [width, height] = shot.size();
        let [x, y] = [(x as u32).min(width - 1), (y as u32).min(height - 1)];
        if let Ok((_, pixels)) = self.pixels() {
            let rgb = pixels[(y * width + x) as usize];
            self.pixel = Some((drawn, direction, rgb));
        }
    }

    /// Reads the heights of the terrain, and keeps the eye above them.
    fn stand_on_terrain(&mut self) {
        let Some(wanted) = &self.state.terrain else {
            return;
        };
        let is_loaded = |loaded: &LoadedTerrain| {
            loaded.file == wanted.file && loaded.spacing_m == wanted.spacing_m
        };
        if !self.terrain.as_ref().is_some_and(is_loaded) {
            let contents = wanted
                .file
                .as_ref()
                .and_then(|file| self.contents.get(file));
            let heights = terrain::heights(wanted, contents.map(Vec::as_slice));
            if let Ok(heights) = &heights {
                self.picture.set_heights(heights);
            }
            self.terrain = Some(LoadedTerrain {
                file: wanted.file.clone(),
                spacing_m: wanted.spacing_m,
                number: self.terrain.as_ref().map_or(0, |loaded| loaded.number + 1),
                heights,
            });
        }
        let (Some(light), Some(loaded)) = (&self.light, &self.terrain) else {
            return;
        };
        if let Ok(heights) = &loaded.heights {
            let height_m = heights.height_m([wanted.east_m, wanted.south_m]);
            let ground_m = light.ground_altitude_m() + height_m;
            let lowest_m = ground_m + terrain::CLEARANCE_M;
            let altitude_m = &mut self.state.scene.observer.altitude_m;
            if altitude_m.unwrap_or(light.facts.altitude_m) < lowest_m {
                *altitude_m = Some(lowest_m.ceil());
            }
        }
    }

    /// Why there is no terrain, as a sentence.
    pub fn terrain_error(&self) -> Option<&str> {
        self.state.terrain.as_ref()?;
        let heights = self.terrain.as_ref().map(|loaded| &loaded.heights);
        heights?.as_ref().err().map(String::as_str)
    }

    /// Why no light of the scene shines, as a sentence.
    pub fn light_error(&self) -> Option<&str> {
        self.lights.as_ref().err().map(String::as_str)
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

    /// Lets time pass in a scene whose sun follows from it.
    fn pass_time(&mut self, ui: &Ui) {
        let sun = &mut self.state.scene.sun;
        self.play.is_on &= sun.elevation_deg.is_none();
        if self.play.is_on {
            let elapsed_s = f64::from(ui.input(|i| i.stable_dt.min(LONGEST_FRAME_S)));
            self.play.advance(&mut sun.time, elapsed_s);
            ui.ctx().request_repaint();
        }
    }

    /// Turns the timers of passes on or off, and takes what they measured.
    fn take_times(&mut self, ui: &Ui) {
        let is_wanted = !matches!(self.times, Times::Off);
        if is_wanted != self.is_timed {
            self.is_timed = is_wanted;
            if !self.picture.set_timed(is_wanted) {
                self.times = Times::Missing;
            }
            // A picture to time.
            self.drawn = None;
        }
        if let Some(times) = self.picture.take_times() {
            self.times = Times::On(Some(times));
        }
        if self.picture.awaits_times() {
            ui.ctx().request_repaint();
        }
    }

    /// Shows the next picture of a time-lapse, or meters or saves the one that is shown.
    #[cfg(not(target_arch = "wasm32"))]
    fn advance_time_lapse(&mut self, ui: &Ui) {
        let Some(lapse) = &mut self.time_lapse else {
            return;
        };
        ui.ctx().request_repaint();
        let Some((scene, to_do)) = lapse.step() else {
            let [saved, _] = lapse.progress();
            self.state.scene = lapse.before().clone();
            self.time_lapse = None;
            self.notice = Some(format!("{saved} pictures are saved"));
            return;
        };
        if self.state.scene != scene {
            self.state.scene = scene;
            return;
        }
        let is_lit = self.is_lit();
        if let Some(sentence) = self.error.clone().filter(|_| is_lit) {
            return self.stop_time_lapse(sentence);
        }
        let (true, Some((_, exposure))) = (is_lit && self.is_drawn(), &self.metered) else {
            return;
        };
        let ev100 = exposure.ev100();
        if let Step::Save(file) = &to_do
            && let Err(sentence) = self.save(file)
        {
            return self.stop_time_lapse(sentence);
        }
        if let Some(lapse) = &mut self.time_lapse {
            lapse.finish_step(ev100);
        }
    }

    /// Whether the last picture is that of the last light.
    #[cfg(not(target_arch = "wasm32"))]
    fn is_drawn(&self) -> bool {
        self.drawn.is_some_and(|(number, _)| number == self.number)
    }

    /// Ends a time-lapse before its end.
    #[cfg(not(target_arch = "wasm32"))]
    fn stop_time_lapse(&mut self, sentence: String) {
        if let Some(lapse) = self.time_lapse.take() {
            self.state.scene = lapse.before().clone();
            self.notice = Some(sentence);
        }
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

    /// Opens the files that were dropped.
    #[cfg(not(target_arch = "wasm32"))]
    fn take_files(&mut self, ui: &Ui) {
        for file in ui.input(|i| i.raw.dropped_files.clone()) {
            self.notice = self.open(file.path()).err();
        }
    }

    /// Reads the files that were dropped, opens those that have been read, and saves the picture whose pixels have come.
    #[cfg(target_arch = "wasm32")]
    fn take_files(&mut self, ui: &Ui) {
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
    fn show_files(&mut self, ui: &mut Ui) {
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
    fn open_file(&mut self) {
        #[cfg(not(target_arch = "wasm32"))]
        let opened = self.open(self.file.clone().as_ref());
        #[cfg(target_arch = "wasm32")]
        let opened = self.page_files.choose();
        self.notice = opened.err();
    }

    /// Saves the file that is named.
    fn save_file(&mut self) {
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
    fn saved_shot(&mut self) -> Result<(Shot, ToneMapper), String> {
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
    fn saved_size(&self) -> Result<[u32; 2], String> {
        let drawn = self.drawn;
        let (_, shot) = drawn.ok_or("expected a picture to save, got none yet")?;
        Ok(self.state.scene.camera.size.unwrap_or(shot.size()))
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

    /// What is wanted beside the picture, once it shows the state.
    fn wanted(&self) -> Option<Wanted<'_>> {
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
    fn update_beside(&mut self) {
        if let Some(mut beside) = self.beside.take() {
            if let Some(wanted) = self.wanted() {
                beside.update(&wanted);
            }
            self.beside = Some(beside);
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

    fn show_picture(&mut self, ui: &mut Ui) {
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
    fn pixels_per_point(&self, ui: &Ui, rect: Rect) -> f32 {
        let largest = self.render.device.limits().max_texture_dimension_2d as f32;
        let most = largest / rect.size().max_elem().max(1.0);
        (ui.pixels_per_point() * self.resolution).min(most)
    }

    /// Shows the photograph in fog, as large as fits.
    #[cfg(not(target_arch = "wasm32"))]
    fn show_photograph(&mut self, ui: &mut Ui) {
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
    fn show_photograph(&mut self, ui: &mut Ui) {
        self.notice =
            Some("expected a sky, got a photograph, which the page cannot read".to_owned());
        self.show_notes(ui, ui.available_rect_before_wrap());
    }

    /// Shows the picture of a frame in a rectangle, and takes the input on it.
    fn show_frame(&mut self, ui: &mut Ui, rect: Rect, frame: Frame) {
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
    fn shine(&mut self, frame: &Frame) -> bool {
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
    fn draw(&mut self, shot: &Shot) {
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

    /// Shows what the library draws over what the device draws.
    fn show_library_picture(&mut self, ui: &Ui, at: Rect) {
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
    fn show_comparison(&mut self, ui: &Ui, at: Rect) {
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
    fn beyond_device(&self) -> Option<String> {
        let beyond = self.state.beyond_device();
        (!beyond.is_empty()).then(|| beyond.join(", "))
    }

    /// What is not in the picture: that light is being computed, or why there is none.
    fn show_notes(&self, ui: &Ui, rect: Rect) {
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

impl eframe::App for Viewer {
    fn ui(&mut self, ui: &mut Ui, _frame: &mut eframe::Frame) {
        self.show(ui);
    }
}

/// What a comparison on the screen shows: shot, mode and the number of the comparison.
type Compared = (Shot, CompareMode, u64);

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

/// Exposed light as luminances, cd/m^2.
#[cfg(not(target_arch = "wasm32"))]
fn luminances(mut exposed: Vec<[f32; 3]>, exposure: f32) -> Vec<[f32; 3]> {
    for channel in exposed.as_flattened_mut() {
        *channel /= exposure;
    }
    exposed
}

/// Exposure at which half floats hold the sun's disc, whose centre is at most twice as bright as its mean.
fn sun_exposure(light: &Light) -> f32 {
    let solid_angle = std::f32::consts::TAU * light.tables.first.disc.one_minus_cos;
    let mean = light.tables.lighting.sun_illuminance_lx.max_element() / solid_angle;
    f32::from(half::f16::MAX) / (2.0 * mean).max(1.0)
}
