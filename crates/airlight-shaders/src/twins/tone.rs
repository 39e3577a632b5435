//! Tone curves: `wgsl/tone.wgsl`.

use super::colour::{into_unit_cube, srgb_luminance, without_negatives};
use glam::Vec3;

/// No curve.
pub fn clip_tone(exposed: Vec3) -> Vec3 {
    exposed.clamp(Vec3::ZERO, Vec3::ONE)
}

/// Response of film and retina.
pub fn camera_response(x: Vec3, contrast: f32) -> Vec3 {
    x.map(|x| {
        let ratio = 0.18 / x.max(1e-8);
        let response = 1.0 / (1.0 + 4.555_555_3 * ratio.powf(contrast / 0.82));
        if x <= 1.1e-8 { 0.0 } else { response }
    })
}

/// Curve in the manner of a camera.
pub fn camera_tone(exposed: Vec3, contrast: f32, saturation: f32) -> Vec3 {
    let positive = without_negatives(exposed);
    let linear = positive.lerp(Vec3::splat(srgb_luminance(positive)), 0.01);
    let least = linear.min_element();
    let most = linear.max_element();
    let response = camera_response(linear, contrast);
    let hi = response.max_element();
    let dark = (1.0 - hi) * (1.0 - hi) * (1.0 - hi);
    let curved = response.lerp(linear * (hi / most.max(1e-30)), dark);
    let lo = curved.min_element();
    let kept = lo + (hi - lo) / (most - least).max(1e-30) * (linear - least);
    let toned = kept.lerp(curved, 0.2);
    into_unit_cube(Vec3::splat(srgb_luminance(toned)).lerp(toned, saturation))
}

/// Response of the base look of AgX.
pub fn agx_response(x: Vec3) -> Vec3 {
    x.map(|x| {
        let stops = (x.max(1e-9) / 0.18).log2();
        let from_grey = ((stops + 10.0) / 16.5).clamp(0.0, 1.0) - 0.606_060_6;
        let is_toe = from_grey < 0.0;
        let limit = if is_toe { 0.565_675_6 } else { 0.715_198_3 };
        let u = 2.4 * from_grey.abs();
        let bent = u / limit;
        let rise = u / (1.0 + bent * bent.sqrt()).powf(0.666_666_7);
        let signal = 0.489_437_1 + if is_toe { -rise } else { rise };
        signal.clamp(0.0, 1.0).powf(2.4)
    })
}

/// Base look of AgX.
pub fn agx_tone(exposed: Vec3) -> Vec3 {
    let weights = Vec3::new(0.212, 0.3922, 0.3958);
    let positive = without_negatives(exposed);
    let inset = positive.lerp(Vec3::splat(weights.dot(positive)), 0.2);
    let curved = agx_response(inset);
    into_unit_cube((curved - 0.2 * weights.dot(curved)) / 0.8)
}
