// Exponentials of optical depth without cancellation. "exp" counts exponentials in the costs of all functions.

/// Upper bound of columns (m) and optical depths: opaque, and far below the largest f32.
const OPAQUE: f32 = 1e25;

/// Mean transmittance over optical depths from 0 to `x`, not negative: `(1 - e^-x) / x`, 1 at 0.
///
/// Cost: 1 exp. Error: 8e-7 relative.
fn mean_transmittance(x: f32) -> f32 {
    // Taylor series to x^7 / 8!.
    let series = 1.0 + x * (-1.0 / 2.0 + x * (1.0 / 6.0 + x * (-1.0 / 24.0 + x * (1.0 / 120.0
        + x * (-1.0 / 720.0 + x * (1.0 / 5040.0 - x / 40320.0))))));
    let direct = (1.0 - exp(-x)) / max(x, 0.75);
    return select(direct, series, x < 0.75);
}

/// `mean_transmittance` of three channels.
///
/// Cost: 3 exp. Error: 8e-7 relative.
fn mean_transmittance_rgb(x: vec3<f32>) -> vec3<f32> {
    return vec3<f32>(mean_transmittance(x.x), mean_transmittance(x.y), mean_transmittance(x.z));
}

/// Mean of `e^-t t / x` over optical depths from 0 to `x`, not negative: `((1 - e^-x) / x - e^-x) / x`, 1/2 at 0.
///
/// Cost: 1 exp. Error: 3e-6 relative.
fn ramp_transmittance(x: f32) -> f32 {
    // The k-th coefficient is (-1)^k (k + 1) / (k + 2)!.
    let series = 1.0 / 2.0 + x * (-1.0 / 3.0 + x * (1.0 / 8.0 + x * (-1.0 / 30.0 + x * (1.0 / 144.0
        + x * (-1.0 / 840.0 + x * (1.0 / 5760.0 - x / 45360.0))))));
    let divisor = max(x, 0.75);
    let transmittance = exp(-x);
    let direct = ((1.0 - transmittance) / divisor - transmittance) / divisor;
    return select(direct, series, x < 0.75);
}

/// Mean of `e^-(d + t)` along a ray of optical depth `tau`, where the light that arrives at optical depth `t` from the eye is
/// attenuated by `d(t)`, linear in `t`: the divided difference `(e^-near - e^-far) / (far - near)`. `near` is `d(0)`, `far` is
/// `d(tau) + tau`; both from 0 to 1e30. No special case: `near` and `far` may be equal.
///
/// Cost: 2 exp. Error: 2e-6 relative plus 2e-7 absolute.
fn mean_attenuated_source(near: f32, far: f32) -> f32 {
    return exp(-min(near, far)) * mean_transmittance(abs(far - near));
}

/// `mean_attenuated_source` of three channels.
///
/// Cost: 6 exp. Error: 2e-6 relative plus 2e-7 absolute.
fn mean_attenuated_source_rgb(near: vec3<f32>, far: vec3<f32>) -> vec3<f32> {
    return exp(-min(near, far)) * mean_transmittance_rgb(abs(far - near));
}

/// Weights of the near (x) and the far (y) end of a segment of optical depth `along` for a source that is linear in optical
/// depth, per unit of optical depth.
///
/// Cost: 2 exp. Error: 3e-6 relative.
fn linear_source_mean(along: f32) -> vec2<f32> {
    let far = ramp_transmittance(along);
    return vec2<f32>(mean_transmittance(along) - far, far);
}

/// Scaled complementary error function `e^(z^2) erfc(z)` for `z` not negative. Chebyshev fit in `1 / (1 + z / 2)`.
///
/// Cost: no exp. Error: 8e-7 relative.
fn scaled_erfc(z: f32) -> f32 {
    let t = 1.0 / (1.0 + 0.5 * z);
    return t * (0.2820947950644331 + t * (0.2820937767894005 + t * (0.24688387983317842
        + t * (0.17532407538599315 + t * (0.09341474848211785 + t * (-0.05905090994805792
        + t * (0.13185004006021367 + t * (-0.4545637180107406 + t * (0.4933857417234322
        + t * (-0.23460549056435415 + t * 0.043173065914306794))))))))));
}
