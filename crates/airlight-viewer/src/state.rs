//! [`State`]: what the user has set, and its history.

use airlight::scene::{CameraSpec, Projection, Scene, SunSpec};
use serde::{Deserialize, Serialize};

/// Version of [`State`] that this viewer reads and writes.
pub const STATE_VERSION: u32 = 1;

/// Lowest and highest altitude of the eye that the viewer sets, m.
pub const ALTITUDES_M: [f64; 2] = [2.0, 4e5];

/// Everything that the user has set.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct State {
    /// Version of the format.
    pub version: u32,
    /// Sun, eye, air, fog, camera and display, as the program `airlight` reads them.
    pub scene: Scene,
    /// Ground in front of the sky.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub terrain: Option<Terrain>,
    /// What the picture is compared with.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub compare: Option<Compare>,
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

/// A comparison of the picture with a solver or a published model.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct Compare {
    /// Name of the model.
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
    /// The picture on the left, the model on the right of a line.
    Split,
    /// Luminance of the picture relative to the model, in percent.
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
            version: STATE_VERSION,
            scene,
            terrain: None,
            compare: None,
        }
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
