//! Positions of a description's lights in front of a picture's camera.

use crate::RenderError;
use airlight::fog::lights::Light;
use airlight::scene::LightSpec;
use airlight_image::frame::Intrinsics;
use airlight_image::input::{DepthKind, DepthMap};
use glam::DVec3;

/// Smallest default radius of a light, m.
const MIN_RADIUS_M: f64 = 0.005;
/// Default radius of a light, in pixels of the camera. The view ray through the light's pixel then gives the mean of the glow over
/// a disc with the area of a pixel: within the distance `a` from the light the glow is proportional to 1 / h, whose mean `2 / a`
/// is the value at `h = a / 2`, and a disc with the area of a pixel has `a` = 0.56 pixels.
const RADIUS_PX: f64 = 0.28;

/// Places lights in front of a camera at a height above the ground, m.
///
/// # Errors
/// [`RenderError::Setting`] for a light without a position in the picture, or with invalid numbers.
pub(super) fn place(
    lights: &[LightSpec],
    camera: &Intrinsics,
    depth: &DepthMap,
    eye_height_m: f64,
) -> Result<Vec<Light<[f32; 3]>>, RenderError> {
    let eye = DVec3::Y * eye_height_m;
    lights
        .iter()
        .enumerate()
        .map(|(index, light)| {
            place_one(light, camera, depth, eye)
                .map_err(|error| RenderError::setting(format!("light {}: {error}", index + 1)))
        })
        .collect()
}

fn place_one(
    light: &LightSpec,
    camera: &Intrinsics,
    depth: &DepthMap,
    eye: DVec3,
) -> Result<Light<[f32; 3]>, String> {
    let position = match (light.position_m, light.pixel) {
        (Some(position_m), _) => DVec3::from_array(position_m),
        (None, Some([x, y])) => {
            let pixel = whole_pixel(x, y, camera)?;
            let direction = camera.pixel_direction(pixel.0, pixel.1);
            let distance_m = match light.distance_m {
                Some(distance_m) => distance_m,
                None => surface_distance_m(pixel, camera, depth)?,
            };
            eye + distance_m * direction
        }
        (None, None) => {
            return Err("expected a position, got none; try position_m or pixel".to_owned());
        }
    };
    let pixel_m = position.distance(eye) / camera.focal_px().0.max(camera.focal_px().1);
    let usual_radius_m = (RADIUS_PX * pixel_m).max(MIN_RADIUS_M);
    let placed = light.at(position, usual_radius_m);
    placed.map_err(|error| error.to_string())
}

/// The pixel with whole coordinates in the picture.
fn whole_pixel(x: f64, y: f64, camera: &Intrinsics) -> Result<(u32, u32), String> {
    let size = camera.size();
    let whole = |v: f64, side: u32| {
        (v.fract() == 0.0 && v >= 0.0 && v < f64::from(side)).then_some(v as u32)
    };
    match (whole(x, size.width()), whole(y, size.height())) {
        (Some(x), Some(y)) => Ok((x, y)),
        _ => Err(format!(
            "pixel: expected whole numbers in a picture of {} x {} pixels, got {x},{y}; try a position in metres for a light \
             outside it",
            size.width(),
            size.height()
        )),
    }
}

/// Distance of the surface in a pixel, m.
fn surface_distance_m(
    (x, y): (u32, u32),
    camera: &Intrinsics,
    depth: &DepthMap,
) -> Result<f64, String> {
    let shown = f64::from(depth.metres[(y * camera.size().width() + x) as usize]);
    if !(shown.is_finite() && shown > 0.0) {
        return Err(format!(
            "pixel: expected a surface at a known distance, got none at {x},{y}; try a distance in metres"
        ));
    }
    Ok(match depth.kind {
        DepthKind::Z => shown * camera.ray_length_per_z(x, y),
        DepthKind::Ray => shown,
    })
}
