//! The camera of the frames.

use glam::{DVec3, Mat4, Vec3};

/// Pixels on a side.
pub const SIZE: u32 = 64;
/// Distance of the near plane, m.
pub const NEAR_M: f32 = 0.5;

/// From clip coordinates of a reversed, infinite perspective to the world: a point at the depth `d` is `NEAR_M / d` before the eye.
pub fn world_from_clip(eye: Vec3) -> Mat4 {
    let forward = Vec3::new(0.2, -0.1, -1.0).normalize();
    let right = forward.cross(Vec3::Y).normalize();
    let up = right.cross(forward);
    let tangent = 0.6 * NEAR_M;
    Mat4::from_cols(
        (tangent * right).extend(0.0),
        (tangent * up).extend(0.0),
        eye.extend(1.0),
        (NEAR_M * forward).extend(0.0),
    )
}

/// Direction and distance, m, of what a pixel with a depth sees; infinite at depth 0.
pub fn place_of(eye: Vec3, pixel: u32, depth: f32) -> (Vec3, f32) {
    let at = |x: u32| 2.0 * (f64::from(x) + 0.5) / f64::from(SIZE) - 1.0;
    let clip = [at(pixel % SIZE), -at(pixel / SIZE)];
    let seen = if depth > 0.0 { f64::from(depth) } else { 1.0 };
    let matrix = world_from_clip(eye).as_dmat4();
    let to_point = matrix.project_point3(DVec3::new(clip[0], clip[1], seen)) - eye.as_dvec3();
    let distance_m = match depth > 0.0 {
        true => to_point.length(),
        false => f64::INFINITY,
    };
    (to_point.normalize().as_vec3(), distance_m as f32)
}
