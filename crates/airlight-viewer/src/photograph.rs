//! [`PhotographWorker`]: fog over a photograph with depth, computed on a thread beside the window.

use crate::state::State;
use airlight::scene::{FogSpec, Scene};
use airlight_image::Control;
use airlight_image::input::read_picture;
use airlight_image::output::PictureFormat;
use airlight_image::rows::draw_rows;
use airlight_render::RenderError;
use airlight_render::overlay::{
    OverlayImage, OverlayScene, OverlaySpec, PreparedOverlay, SkyLight,
};
use std::path::Path;
use std::sync::mpsc::{Receiver, Sender, channel};

/// Visibility in the fog of a photograph that is opened, m.
const VISIBILITY_M: f64 = 50.0;

/// A photograph in fog, as a display shows it.
#[derive(Clone, Debug, PartialEq)]
pub struct FoggedPhotograph {
    /// What was fogged.
    pub scene: OverlayScene,
    /// Width and height, pixels.
    pub size: [u32; 2],
    /// Red, green and blue, encoded as sRGB.
    pub rgb: Vec<u8>,
}

/// A request, and what became of it: a picture, or why there is none, as a sentence.
type Answer = (OverlayScene, Result<FoggedPhotograph, String>);

/// Puts fog over photographs, the newest request first.
#[derive(Debug)]
pub struct PhotographWorker {
    requests: Sender<OverlayScene>,
    answers: Receiver<Answer>,
    asked: Option<OverlayScene>,
    answer: Option<Answer>,
}

impl PhotographWorker {
    /// Starts the thread, which calls `wake` after each picture.
    pub fn new(wake: impl Fn() + Send + 'static) -> Self {
        let (requests, to_do) = channel::<OverlayScene>();
        let (done, answers) = channel();
        // Ends with the viewer, which drops the other end of `to_do`. Without threads, no answer comes.
        let _ = std::thread::Builder::new()
            .name("airlight photograph".to_owned())
            .spawn(move || {
                let mut prepared = PreparedPhotograph::default();
                while let Ok(scene) = to_do.recv() {
                    let result = prepared.fog(&scene).map_err(|error| error.to_string());
                    if done.send((scene, result)).is_err() {
                        return;
                    }
                    wake();
                }
            });
        Self {
            requests,
            answers,
            asked: None,
            answer: None,
        }
    }

    /// Takes answers, and asks for a scene unless another is being fogged.
    pub fn update(&mut self, scene: &OverlayScene) {
        while let Ok(answer) = self.answers.try_recv() {
            self.take(answer);
        }
        if self.asked.is_none()
            && !self.is_current(scene)
            && self.requests.send(scene.clone()).is_ok()
        {
            self.asked = Some(scene.clone());
        }
    }

    /// Waits for the answer to what was asked.
    pub fn wait(&mut self) {
        if self.asked.is_some()
            && let Ok(answer) = self.answers.recv()
        {
            self.take(answer);
        }
    }

    fn take(&mut self, answer: Answer) {
        self.asked = None;
        self.answer = Some(answer);
    }

    /// Whether the last answer is that of a scene.
    pub fn is_current(&self, scene: &OverlayScene) -> bool {
        self.answer.as_ref().is_some_and(|(of, _)| of == scene)
    }

    /// The last answer.
    pub fn answer(&self) -> Option<Result<&FoggedPhotograph, &str>> {
        let (_, result) = self.answer.as_ref()?;
        Some(result.as_ref().map_err(String::as_str))
    }
}

/// What of a photograph stays while its fog changes.
#[derive(Debug, Default)]
struct PreparedPhotograph {
    image: Option<(OverlaySpec, OverlayImage)>,
    sky: Option<(OverlayScene, Option<SkyLight>)>,
}

impl PreparedPhotograph {
    fn fog(&mut self, scene: &OverlayScene) -> Result<FoggedPhotograph, RenderError> {
        // Without opacity, which the window does not show.
        const SHOWN: PictureFormat = PictureFormat::JPEG;
        scene.check()?;
        if self
            .image
            .as_ref()
            .is_none_or(|(of, _)| *of != scene.overlay)
        {
            let image = OverlayImage::read(scene, SHOWN)?;
            self.image = Some((scene.overlay.clone(), image));
        }
        let lit = OverlayScene {
            scene: Scene {
                fog: None,
                lights: Vec::new(),
                ..scene.scene.clone()
            },
            overlay: scene.overlay.clone(),
        };
        if self.sky.as_ref().is_none_or(|(of, _)| *of != lit) {
            let sky = scene.solve_sky()?;
            self.sky = Some((lit, sky));
        }
        let (Some((_, image)), Some((_, sky))) = (&self.image, &self.sky) else {
            unreachable!("both were made above");
        };
        let prepared = PreparedOverlay::new(scene, image, sky.as_ref())?;
        let rows = prepared.output(scene, image, SHOWN)?;
        let size = image.picture.size;
        let linear = draw_rows(&rows, size, Control::default())?;
        let row = 3 * size.width() as usize;
        let mut rgb = vec![0; linear.len()];
        for (y, (linear, out)) in (0..).zip(linear.chunks(row).zip(rgb.chunks_mut(row))) {
            rows.tone().row_to_u8(y, linear, out);
        }
        Ok(FoggedPhotograph {
            scene: scene.clone(),
            size: [size.width(), size.height()],
            rgb,
        })
    }
}

/// Writes a photograph in fog, in the format of the file's ending: what `airlight fog` writes.
///
/// # Errors
/// [`RenderError`] where it cannot be read or written.
pub fn save(scene: &OverlayScene, file: &Path) -> Result<(), RenderError> {
    scene.check()?;
    let format = scene.output_format(file)?;
    let image = OverlayImage::read(scene, format)?;
    let sky = scene.solve_sky()?;
    let prepared = PreparedOverlay::new(scene, &image, sky.as_ref())?;
    let rows = prepared.output(scene, &image, format)?;
    rows.write(file, Control::default())?;
    Ok(())
}

/// The state in which a photograph is opened: in fog.
pub fn usual_state() -> State {
    State::of_scene(Scene {
        fog: Some(FogSpec {
            visibility_m: Some(VISIBILITY_M),
            ..Default::default()
        }),
        ..Default::default()
    })
}

/// Whether a file is a picture with colours, and not one of heights or distances.
pub fn has_colours(file: &Path) -> bool {
    let has_colour = |rgb: &[f32; 3]| rgb[0] != rgb[1] || rgb[1] != rgb[2];
    let picture = read_picture(file, None);
    picture.is_ok_and(|picture| picture.rgb.as_chunks().0.iter().any(has_colour))
}
