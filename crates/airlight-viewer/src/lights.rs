//! [`around`]: the lights of a scene, around the eye.

use crate::state::State;
use airlight::fog::lights::Light;
use airlight::glam::DVec3;
use airlight_image::Frame;

/// Default radius of a light in pixels, as fog over photographs has it, and its least, m.
const RADIUS_PX: f64 = 0.28;
const LEAST_RADIUS_M: f64 = 0.005;

/// The lights of a scene around an eye at a height above the ground, m. With terrain their places count from its middle.
///
/// # Errors
/// A sentence for a light without a position, or with numbers out of range.
pub fn around(
    state: &State,
    frame: &Frame,
    eye_height_m: f64,
) -> Result<Vec<Light<[f32; 3]>>, String> {
    let [east_m, south_m] = match &state.terrain {
        Some(terrain) => [terrain.east_m, terrain.south_m],
        None => [0.0; 2],
    };
    let eye = DVec3::new(east_m, eye_height_m, south_m);
    let pixel_rad = pixel_rad(frame);
    let lights = state.scene.lights.iter().enumerate();
    lights
        .map(|(k, light)| {
            let position = light.position_m.map(DVec3::from_array);
            let position = position.ok_or(
                "expected a position, got a pixel of a photograph; try position_m".to_owned(),
            );
            let placed = position.and_then(|position| {
                let from_eye = position - eye;
                let radius_m = (RADIUS_PX * pixel_rad * from_eye.length()).max(LEAST_RADIUS_M);
                let light = light.at(from_eye, radius_m);
                light.map_err(|error| error.to_string())
            });
            placed.map_err(|sentence| format!("light {}: {sentence}", k + 1))
        })
        .collect()
}

/// Angle of a pixel in the centre of a picture, radians.
fn pixel_rad(frame: &Frame) -> f64 {
    let [x, y] = [frame.size().width(), frame.size().height()].map(|n| 0.5 * f64::from(n));
    let towards = |x| frame.direction(x, y).unwrap_or(DVec3::Y);
    towards(x - 0.5).angle_between(towards(x + 0.5))
}
