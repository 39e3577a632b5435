//! The terrain under the eye.

use super::Viewer;
use crate::picture::Ground;
use crate::terrain::{self, LoadedTerrain};
use crate::view;
use crate::view::Orbit;
use airlight_gpu::TerrainPoint;
use airlight_image::Frame;
use glam::DVec3;

impl Viewer {
    /// The ground that is drawn.
    pub(super) fn ground(&self) -> Option<Ground> {
        let (terrain, loaded) = (self.state.terrain.as_ref()?, self.terrain.as_ref()?);
        loaded.heights.as_ref().ok()?;
        Some(Ground {
            number: loaded.number,
            place_m: [terrain.east_m, terrain.south_m],
        })
    }

    /// The terrain in a direction; `None` where there is none.
    pub(super) fn terrain_point(&self, direction: DVec3) -> Option<TerrainPoint> {
        let view = self.picture.terrain_view(&self.ground()?)?;
        let heights = self.terrain.as_ref()?.heights.as_ref().ok()?;
        TerrainPoint::along(heights, &view, direction)
    }

    /// The eye, and the point of terrain or of the ground that it orbits, or where the picture shows the sky a point before it.
    pub(super) fn orbit(&self, frame: &Frame) -> Orbit {
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

    /// Reads the heights of the terrain, and keeps the eye above them.
    pub(super) fn stand_on_terrain(&mut self) {
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
            let heights = heights.and_then(|heights| {
                let drawn = self.picture.set_heights(&heights);
                drawn.map(|()| heights).map_err(|error| error.to_string())
            });
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
}
