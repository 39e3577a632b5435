//! The lamps of the options: from words to places in the scene.

use crate::args::{LightArg, LightKind, LightPlace};
use crate::error::CliError;
use airlight::axes;
use airlight::fog::lights::{Light, PointLight, SphereLight, SpotLight};
use airlight_image::frame::Intrinsics;
use airlight_image::input::{DepthKind, DepthMap};
use glam::DVec3;
use std::f64::consts::PI;

/// The least size of a lamp whose size is not told, m.
const LEAST_RADIUS_M: f64 = 0.005;
/// Its size in pixels, as the camera sees it: a line of sight through the lamp's own pixel then meets the mean of the glow
/// over a disc as large as a pixel. In a circle of radius `a` round the lamp the glow goes as 1 / h, of which the mean is
/// `2 / a`, the value at `h = a / 2`; and a disc of one square pixel has `a` = 0.56 pixels.
const RADIUS_PX: f64 = 0.28;

/// The lamps of the words.
///
/// # Errors
/// [`CliError::Usage`] for a lamp whose place the picture does not tell, or that cannot be.
pub fn of(
    words: &[LightArg],
    camera: &Intrinsics,
    depth: &DepthMap,
    eye_height_m: f64,
) -> Result<Vec<Light<[f32; 3]>>, CliError> {
    let eye = DVec3::Y * eye_height_m;
    words
        .iter()
        .map(|lamp| one(lamp, camera, depth, eye))
        .collect::<Result<_, String>>()
        .map_err(|error| CliError::usage(format!("--lamp {error}")))
}

fn one(
    lamp: &LightArg,
    camera: &Intrinsics,
    depth: &DepthMap,
    eye: DVec3,
) -> Result<Light<[f32; 3]>, String> {
    let position = match lamp.place {
        LightPlace::At(at) => DVec3::from_array(at),
        LightPlace::Pixel { x, y, distance_m } => {
            let pixel = pixel(x, y, camera)?;
            let direction = camera.pixel_direction(pixel.0, pixel.1);
            let distance_m = match distance_m {
                Some(distance_m) => distance_m,
                None => shown(pixel, camera, depth)?,
            };
            eye + distance_m * direction
        }
    };
    let intensity = lamp.intensity.map(|v| v as f32);
    let pixel_m = position.distance(eye) / camera.focal_px().0.max(camera.focal_px().1);
    let radius_m = lamp
        .radius_m
        .unwrap_or_else(|| (RADIUS_PX * pixel_m).max(LEAST_RADIUS_M));
    let made = match lamp.kind {
        LightKind::Point => PointLight::new(position, intensity, radius_m).map(Light::Point),
        LightKind::Spot {
            azimuth,
            elevation,
            inner,
            outer,
        } => SpotLight::new(
            position,
            axes::direction(azimuth, elevation),
            intensity,
            inner.to_radians(),
            outer.to_radians(),
            radius_m,
        )
        .map(Light::Spot),
        LightKind::Sphere => {
            let area_m2 = PI * radius_m * radius_m;
            SphereLight::new(position, radius_m, intensity.map(|v| v / area_m2 as f32))
                .map(Light::Sphere)
        }
    };
    made.map_err(|error| error.to_string())
}

/// The pixel of whole coordinates within the picture.
fn pixel(x: f64, y: f64, camera: &Intrinsics) -> Result<(u32, u32), String> {
    let size = camera.size();
    let whole = |v: f64, side: u32| {
        (v.fract() == 0.0 && v >= 0.0 && v < f64::from(side)).then_some(v as u32)
    };
    match (whole(x, size.width()), whole(y, size.height())) {
        (Some(x), Some(y)) => Ok((x, y)),
        _ => Err(format!(
            "pixel must be whole numbers within the picture, which has {} x {} pixels, got {x},{y}; a lamp outside it \
             goes by at=EAST,UP,SOUTH",
            size.width(),
            size.height()
        )),
    }
}

/// How far away the picture's surface is in a pixel, m.
fn shown((x, y): (u32, u32), camera: &Intrinsics, depth: &DepthMap) -> Result<f64, String> {
    let shown = f64::from(depth.metres[(y * camera.size().width() + x) as usize]);
    if !(shown.is_finite() && shown > 0.0) {
        return Err(format!(
            "pixel={x},{y} shows nothing at a known distance: say distance=METRES"
        ));
    }
    Ok(match depth.kind {
        DepthKind::Z => shown * camera.ray_length_per_z(x, y),
        DepthKind::Ray => shown,
    })
}
