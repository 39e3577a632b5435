//! Exponentials of optical depth without cancellation: `wgsl/exponentials.wgsl`.

use glam::{Vec2, Vec3};

/// Upper bound of columns (m) and optical depths: opaque, and far below the largest f32.
pub const OPAQUE: f32 = 1e25;

/// Mean transmittance over optical depths from 0 to `x`.
pub fn mean_transmittance(x: f32) -> f32 {
    let coefficients = [
        1.0,
        -1.0 / 2.0,
        1.0 / 6.0,
        -1.0 / 24.0,
        1.0 / 120.0,
        -1.0 / 720.0,
    ];
    let series = polynomial(x, &coefficients, 1.0 / 5040.0 - x / 40320.0);
    let direct = (1.0 - (-x).exp()) / x.max(0.75);
    if x < 0.75 { series } else { direct }
}

/// [`mean_transmittance`] of three channels.
pub fn mean_transmittance_rgb(x: Vec3) -> Vec3 {
    Vec3::new(
        mean_transmittance(x.x),
        mean_transmittance(x.y),
        mean_transmittance(x.z),
    )
}

/// Mean of `e^-t t / x` over optical depths from 0 to `x`.
pub fn ramp_transmittance(x: f32) -> f32 {
    let coefficients = [
        1.0 / 2.0,
        -1.0 / 3.0,
        1.0 / 8.0,
        -1.0 / 30.0,
        1.0 / 144.0,
        -1.0 / 840.0,
    ];
    let series = polynomial(x, &coefficients, 1.0 / 5760.0 - x / 45360.0);
    let divisor = x.max(0.75);
    let transmittance = (-x).exp();
    let direct = ((1.0 - transmittance) / divisor - transmittance) / divisor;
    if x < 0.75 { series } else { direct }
}

/// Mean of `e^-(d + t)` along a ray, from `near` = `d(0)` and `far` = `d(tau) + tau`.
pub fn mean_attenuated_source(near: f32, far: f32) -> f32 {
    (-near.min(far)).exp() * mean_transmittance((far - near).abs())
}

/// [`mean_attenuated_source`] of three channels.
pub fn mean_attenuated_source_rgb(near: Vec3, far: Vec3) -> Vec3 {
    (-near.min(far)).exp() * mean_transmittance_rgb((far - near).abs())
}

/// Weights of the near and the far end of a segment for a source that is linear in optical depth.
pub fn linear_source_mean(along: f32) -> Vec2 {
    let far = ramp_transmittance(along);
    Vec2::new(mean_transmittance(along) - far, far)
}

/// Scaled complementary error function `e^(z^2) erfc(z)`.
#[allow(clippy::excessive_precision)]
pub fn scaled_erfc(z: f32) -> f32 {
    let t = 1.0 / (1.0 + 0.5 * z);
    let coefficients = [
        0.2820947950644331,
        0.2820937767894005,
        0.24688387983317842,
        0.17532407538599315,
        0.09341474848211785,
        -0.05905090994805792,
        0.13185004006021367,
        -0.4545637180107406,
        0.4933857417234322,
        -0.23460549056435415,
    ];
    t * polynomial(t, &coefficients, 0.043173065914306794)
}

/// `c[0] + x (c[1] + x (... + x rest))`, written out in the shader. The formatter takes a minute for parentheses as deep as those.
fn polynomial(x: f32, coefficients: &[f32], rest: f32) -> f32 {
    coefficients.iter().rev().fold(rest, |sum, c| c + x * sum)
}
