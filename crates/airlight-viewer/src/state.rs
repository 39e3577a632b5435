//! [`State`]: what the user has set, and its history.

use airlight::fog::FogScattering;
use airlight::scene::{
    CameraSpec, NightSpec, ObjectsSpec, Projection, Scene, SceneDocument, SceneError, SunSpec,
};
use airlight_gpu::MOST_FOG_LAYERS;
use airlight_render::overlay::{OverlayScene, OverlaySpec};
#[cfg(not(target_arch = "wasm32"))]
use airlight_render::{RenderError, scene_file};
use serde::{Deserialize, Serialize};
#[cfg(not(target_arch = "wasm32"))]
use std::path::Path;

/// Lowest and highest altitude of the eye that the viewer sets, m.
pub const ALTITUDES_M: [f64; 2] = [2.0, 4e5];

/// Everything that the user has set.
#[derive(Clone, Debug, PartialEq)]
pub struct State {
    /// Sun, eye, air, fog, lights, camera and display, as the program `airlight` reads them.
    pub scene: Scene,
    /// Ground in front of the sky.
    pub terrain: Option<Terrain>,
    /// What the picture is compared with.
    pub compare: Option<Compare>,
    /// A photograph with depth in the place of the sky, over which the scene's fog lies.
    pub photograph: Option<OverlaySpec>,
}

/// The tables of a scene file beside those of the scene.
#[derive(Debug, Default, Serialize, Deserialize)]
#[serde(default)]
struct Tables {
    #[serde(skip_serializing_if = "Option::is_none")]
    terrain: Option<Terrain>,
    #[serde(skip_serializing_if = "Option::is_none")]
    compare: Option<Compare>,
    #[serde(skip_serializing_if = "Option::is_none")]
    overlay: Option<OverlaySpec>,
}

/// Ground of given heights, and where the eye stands on it. Beyond its edges it goes on as in mirrors.
#[derive(Clone, Debug, Default, PartialEq, Serialize, Deserialize)]
#[serde(default, deny_unknown_fields)]
pub struct Terrain {
    /// File of heights, m, from north to south: a picture or an array with one number a pixel. Without one, the Cumberland Mountains.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub file: Option<String>,
    /// Distance between the pixels of the file, m. Default: 30.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub spacing_m: Option<f64>,
    /// Place of the eye to the east of the middle, m.
    pub east_m: f64,
    /// Place of the eye to the south of the middle, m.
    pub south_m: f64,
}

/// A comparison with a solver or a published model.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct Compare {
    /// Name of the model on the left; without one, the picture.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub left: Option<String>,
    /// Name of the model on the right.
    pub model: String,
    /// What is shown.
    pub mode: CompareMode,
    /// Place of the line of [`CompareMode::Split`], 0 at the left edge, 1 at the right.
    pub split: f64,
}

/// What is shown of a comparison.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Serialize, Deserialize)]
#[serde(rename_all = "kebab-case")]
pub enum CompareMode {
    /// The picture or a model on the left, the model on the right of a line.
    Split,
    /// Luminance of the left relative to the model on the right, in percent.
    Luminance,
    /// Difference of colour, CIEDE2000.
    Colour,
}

impl Default for State {
    /// A hazy evening, seen from a hill.
    fn default() -> Self {
        let mut scene = Scene {
            sun: SunSpec {
                elevation_deg: Some(4.0),
                azimuth_deg: Some(285.0),
                ..Default::default()
            },
            camera: CameraSpec {
                projection: Some(Projection::Perspective),
                azimuth_deg: Some(262.0),
                elevation_deg: Some(9.0),
                fov_deg: Some(75.0),
                ..Default::default()
            },
            ..Default::default()
        };
        scene.observer.altitude_m = Some(120.0);
        scene.air.atmosphere = Some("average".to_owned());
        Self::of_scene(scene)
    }
}

impl State {
    /// The state that shows a scene, with what the viewer needs filled in.
    pub fn of_scene(mut scene: Scene) -> Self {
        let has_place = scene.sun.latitude_deg.is_some() && scene.sun.longitude_deg.is_some();
        if scene.sun.elevation_deg.is_none() && !has_place {
            scene.sun.elevation_deg = Some(30.0);
        }
        scene
            .camera
            .projection
            .get_or_insert(Projection::Perspective);
        Self {
            scene,
            terrain: None,
            compare: None,
            photograph: None,
        }
    }

    /// Reads a scene file, which may have tables `[terrain]`, `[compare]` and `[overlay]`.
    ///
    /// # Errors
    /// [`SceneError`] with line, column, key and the most similar valid key.
    pub fn from_toml(text: &str) -> Result<Self, SceneError> {
        let document = SceneDocument::new(text)?;
        let scene = document.scene(&[""], &["terrain", "compare", "overlay"])?;
        let tables: Tables = document.read(&[""], &[])?;
        Ok(Self {
            terrain: tables.terrain,
            compare: tables.compare,
            photograph: tables.overlay,
            ..Self::of_scene(scene)
        })
    }

    /// Reads a scene file and the files that its scene names.
    ///
    /// # Errors
    /// [`RenderError`] for files that cannot be read or are invalid.
    #[cfg(not(target_arch = "wasm32"))]
    pub fn load(file: &Path) -> Result<Self, RenderError> {
        let text = scene_file::read_text(file, "TOML")?;
        let mut state = Self::from_toml(&text).map_err(|error| {
            RenderError::setting(format!("scene `{}`: {error}", file.display()))
        })?;
        let folder = file.parent().unwrap_or(Path::new(""));
        scene_file::inline_files(&mut state.scene, folder)?;
        Ok(state)
    }

    /// Writes the scene, and the tables of what else is shown.
    ///
    /// # Errors
    /// Why it cannot be written, as a sentence.
    pub fn to_toml(&self) -> Result<String, String> {
        let (scene, overlay) = match &self.photograph {
            Some(photograph) => {
                let fogged = self.fogged(photograph.clone());
                (fogged.scene, Some(fogged.overlay))
            }
            None => (self.scene.clone(), None),
        };
        let tables = Tables {
            terrain: self.terrain.clone(),
            compare: self.compare.clone(),
            overlay,
        };
        let scene = scene.to_toml().map_err(|error| error.to_string())?;
        let tables = toml::to_string(&tables).map_err(|error| error.to_string())?;
        Ok(format!("{scene}\n{tables}"))
    }

    /// A photograph in the scene's fog: what `airlight fog` is given. What it would refuse, as it means nothing to a photograph, is left
    /// out: with a solved sky as light, the sun and the air remain, with a strength of the sun its direction.
    pub fn fogged(&self, photograph: OverlaySpec) -> OverlayScene {
        let scene = &self.scene;
        let (is_lit_by_sky, has_sun) = (photograph.sky_light, photograph.sun_strength.is_some());
        let usual = Scene::default();
        let mut sun = match is_lit_by_sky || has_sun {
            true => scene.sun.clone(),
            false => usual.sun.clone(),
        };
        if !is_lit_by_sky {
            (sun.latitude_deg, sun.longitude_deg, sun.time) = (None, None, None);
        }
        let camera = CameraSpec {
            azimuth_deg: scene.camera.azimuth_deg,
            elevation_deg: scene.camera.elevation_deg,
            roll_deg: scene.camera.roll_deg,
            fov_deg: scene
                .camera
                .fov_deg
                .filter(|_| photograph.focal_px.is_none()),
            ..Default::default()
        };
        OverlayScene {
            scene: Scene {
                sun,
                camera,
                air: match is_lit_by_sky {
                    true => scene.air.clone(),
                    false => usual.air.clone(),
                },
                fog: scene.fog.clone(),
                lights: scene.lights.clone(),
                ..usual
            },
            overlay: OverlaySpec {
                layers: false,
                ..photograph
            },
        }
    }

    /// What of the scene the graphics device does not draw, as phrases.
    pub fn beyond_device(&self) -> Vec<&'static str> {
        let scene = &self.scene;
        let fog = scene.fog.as_ref();
        let orders = fog.and_then(|fog| fog.scattering);
        [
            (
                fog.is_some_and(|fog| fog.layers.len() >= MOST_FOG_LAYERS),
                "more than four layers of fog",
            ),
            (
                orders.is_some_and(|orders| orders != FogScattering::Multiple),
                "fewer orders of scattering in the fog",
            ),
            (
                fog.is_some_and(|fog| fog.patches.is_some()),
                "patches in the fog",
            ),
            (
                scene.objects.as_ref().is_some_and(ObjectsSpec::is_set),
                "objects",
            ),
            (scene.night != NightSpec::default(), "lights of the night"),
        ]
        .into_iter()
        .filter_map(|(is_set, phrase)| is_set.then_some(phrase))
        .collect()
    }

    /// Whether the library draws the picture, once it is still, as there is something that the device does not draw, and nothing that the
    /// library does not draw here.
    pub fn is_drawn_by_library(&self) -> bool {
        !self.beyond_device().is_empty()
            && self.terrain.is_none()
            && self.scene.lights.is_empty()
            && self.photograph.is_none()
    }

    /// The part of the scene that light depends on, which is solved for again when it changes.
    pub fn lit_scene(&self) -> Scene {
        let scene = &self.scene;
        Scene {
            sun: scene.sun.clone(),
            observer: scene.observer.clone(),
            air: scene.air.clone(),
            fog: scene.fog.clone(),
            solver: scene.solver.clone(),
            ..Default::default()
        }
    }
}

/// States that can be returned to.
#[derive(Clone, Debug, Default)]
pub struct History {
    before: Vec<State>,
    after: Vec<State>,
}

/// Number of states that are kept.
const KEPT: usize = 200;

impl History {
    /// Keeps a state that is about to be left.
    pub fn push(&mut self, state: State) {
        if self.before.last() != Some(&state) {
            self.before.push(state);
            let more = self.before.len().saturating_sub(KEPT);
            self.before.drain(..more);
        }
        self.after.clear();
    }

    /// The state before this one.
    pub fn undo(&mut self, state: &State) -> Option<State> {
        let before = self.before.pop()?;
        self.after.push(state.clone());
        Some(before)
    }

    /// The state that was undone last.
    pub fn redo(&mut self, state: &State) -> Option<State> {
        let after = self.after.pop()?;
        self.before.push(state.clone());
        Some(after)
    }

    /// Whether there is a state to undo to, and one to redo.
    pub fn can(&self) -> [bool; 2] {
        [!self.before.is_empty(), !self.after.is_empty()]
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn states_are_written_and_read() {
        let photograph = OverlaySpec {
            colour: "garage.png".into(),
            depth: Some("depth.png".into()),
            depth_scale: 0.001,
            focal_px: Some(995.0),
            ..Default::default()
        };
        let scene =
            "fog.visibility_m = 8\n[[lights]]\nposition_m = [0, 2, -3]\nintensity = [1, 1, 1]";
        let ridge = State {
            terrain: Some(Terrain {
                east_m: 120.0,
                ..Default::default()
            }),
            ..Default::default()
        };
        for state in [State::default(), ridge] {
            let text = state.to_toml().unwrap();
            assert_eq!(State::from_toml(&text).unwrap(), state, "{text}");
        }
        let foggy = State {
            photograph: Some(photograph.clone()),
            ..State::of_scene(Scene::from_toml(scene).unwrap())
        };
        let text = foggy.to_toml().unwrap();
        let read = State::from_toml(&text).unwrap();
        assert_eq!(read.fogged(photograph.clone()), foggy.fogged(photograph));
        // What the program fogs.
        let program = OverlayScene::from_toml(&text).unwrap();
        assert_eq!(program.check().err().map(|error| error.to_string()), None);
        let error = State::from_toml("[terain]\neast_m = 3")
            .unwrap_err()
            .to_string();
        assert!(error.contains("terain"), "{error}");
    }

    #[test]
    fn states_are_undone_and_redone() {
        let states: Vec<State> = (0..4)
            .map(|k| {
                let mut state = State::default();
                state.scene.sun.elevation_deg = Some(f64::from(k));
                state
            })
            .collect();
        let mut history = History::default();
        assert_eq!(history.can(), [false, false]);
        history.push(states[0].clone());
        history.push(states[1].clone());
        assert_eq!(history.undo(&states[2]), Some(states[1].clone()));
        assert_eq!(history.undo(&states[1]), Some(states[0].clone()));
        assert_eq!(history.undo(&states[0]), None);
        assert_eq!(history.redo(&states[0]), Some(states[1].clone()));
        // A change forgets what was undone.
        history.push(states[1].clone());
        assert_eq!(history.redo(&states[3]), None);
        for k in 0..2 * KEPT {
            let mut state = State::default();
            state.scene.sun.azimuth_deg = Some(k as f64);
            history.push(state);
        }
        assert_eq!(history.before.len(), KEPT);
    }

    #[test]
    fn light_does_not_depend_on_camera_and_display() {
        let mut state = State::default();
        let lit = state.lit_scene();
        state.scene.camera.azimuth_deg = Some(10.0);
        state.scene.output.brighten = Some(1.0);
        assert_eq!(state.lit_scene(), lit);
        state.scene.air.ozone_du = Some(200.0);
        assert_ne!(state.lit_scene(), lit);
    }
}
