// requires: colour
// Tone curves from exposed linear sRGB, in which 0.18 is middle grey, to linear light of a display, from 0 to 1. Encode the result
// with `srgb_encode`, unless the target does.

/// No curve: components above 1 and below 0 are clipped.
///
/// Cost: no exp. Error: 1e-7 relative.
fn clip_tone(exposed: vec3<f32>) -> vec3<f32> {
    return clamp(exposed, vec3<f32>(0.0), vec3<f32>(1.0));
}

/// Response `x^n / (x^n + q)` of film and retina (Naka & Rushton 1966), at which 0.18 stays 0.18. `contrast` is its slope there on
/// logarithmic axes, 0.5 to 3.
///
/// Cost: 3 exp. Error: 1e-6 relative plus 1e-6 absolute.
fn camera_response(x: vec3<f32>, contrast: f32) -> vec3<f32> {
    let ratio = 0.18 / max(x, vec3<f32>(1e-8));
    let response = 1.0 / (1.0 + 4.5555556 * pow(ratio, vec3<f32>(contrast / 0.82)));
    return select(response, vec3<f32>(0.0), x <= vec3<f32>(1.1e-8));
}

/// Curve in the manner of a camera: contrast around middle grey, highlights that roll off to white, hue kept. `contrast` is usually
/// 1.2, `saturation` 1 (0: grey).
///
/// Cost: 3 exp. Error: 2e-5 relative plus 4e-6 absolute.
fn camera_tone(exposed: vec3<f32>, contrast: f32, saturation: f32) -> vec3<f32> {
    let positive = without_negatives(exposed);
    let linear = mix(positive, vec3<f32>(srgb_luminance(positive)), 0.01);
    let least = min(linear.x, min(linear.y, linear.z));
    let most = max(linear.x, max(linear.y, linear.z));
    let response = camera_response(linear, contrast);
    let hi = max(response.x, max(response.y, response.z));
    // In the dark, components keep their ratios.
    let dark = (1.0 - hi) * (1.0 - hi) * (1.0 - hi);
    let curved = mix(response, linear * (hi / max(most, 1e-30)), dark);
    let lo = min(curved.x, min(curved.y, curved.z));
    // The middle component mostly keeps its place between the others: the hue. Grey has none.
    let kept = lo + (hi - lo) / max(most - least, 1e-30) * (linear - least);
    let toned = mix(kept, curved, 0.2);
    return into_unit_cube(mix(vec3<f32>(srgb_luminance(toned)), toned, saturation));
}

/// Response of the base look of AgX (T. Sobotka 2022): a sigmoid of the logarithm from 10 stops below middle grey to 6.5 stops
/// above.
///
/// Cost: 9 exp. Error: 4e-6 relative plus 1e-6 absolute.
fn agx_response(x: vec3<f32>) -> vec3<f32> {
    let stops = log2(max(x, vec3<f32>(1e-9)) / 0.18);
    let place = clamp((stops + 10.0) / 16.5, vec3<f32>(0.0), vec3<f32>(1.0));
    let from_grey = place - 0.6060606061;
    let is_toe = from_grey < vec3<f32>(0.0);
    let limit = select(vec3<f32>(0.7151982863), vec3<f32>(0.5656756067), is_toe);
    let u = 2.4 * abs(from_grey);
    let bent = u / limit;
    let rise = u / pow(1.0 + bent * sqrt(bent), vec3<f32>(0.6666666667));
    let signal = clamp(0.4894370896 + select(rise, -rise, is_toe), vec3<f32>(0.0), vec3<f32>(1.0));
    return pow(signal, vec3<f32>(2.4));
}

/// Base look of AgX: highlights roll off, and bright saturated colours turn white early.
///
/// Cost: 9 exp. Error: 4e-5 relative plus 2e-5 absolute.
fn agx_tone(exposed: vec3<f32>) -> vec3<f32> {
    let weights = vec3<f32>(0.212, 0.3922, 0.3958);
    let positive = without_negatives(exposed);
    let inset = mix(positive, vec3<f32>(dot(weights, positive)), 0.2);
    let curved = agx_response(inset);
    return into_unit_cube((curved - 0.2 * dot(weights, curved)) / 0.8);
}
