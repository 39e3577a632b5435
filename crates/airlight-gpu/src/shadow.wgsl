// The pass of shadows in a medium, behind its functions: it subtracts the sunlight that the medium would scatter once towards the eye where
// the ground throws its shadow. `once_to(direction, distance_m)` is that light up to a distance, in red, green and blue.

struct Shadow {
    /// Place of the eye: metres to the east of the middle of the grid, above the ground of the planet, to the south.
    eye: vec3<f32>,
    planet_radius_m: f32,
    /// Size of the grid, m.
    extent_m: vec2<f32>,
    /// Height above which there is no shadow, m.
    highest_m: f32,
}

@group(2) @binding(0) var<uniform> shadow: Shadow;
@group(2) @binding(1) var mirrored_sampler: sampler;
/// Height of the shadow's surface, in multiples of 16 m, and the rest of it.
@group(2) @binding(2) var shadow_heights: texture_2d<f32>;

/// Steps along a ray, and the distance at which they end, m.
const SHADOW_STEPS: u32 = 64u;
const FARTHEST_M: f32 = 1e5;

/// Height above the shadow's surface, m, at a distance along a direction.
fn shadow_clearance_m(direction: vec3<f32>, distance_m: f32) -> f32 {
    let from_eye = distance_m * direction.xz;
    let height_m = shadow.eye.y + distance_m * direction.y + dot(from_eye, from_eye) / (2.0 * shadow.planet_radius_m);
    let uv = (shadow.eye.xz + from_eye) / shadow.extent_m + 0.5;
    let texel = textureSampleLevel(shadow_heights, mirrored_sampler, uv, 0.0);
    return height_m - (texel.x + texel.y);
}

/// Interval of distances in which a ray can be in shadow, m.
fn span_in_shadow(seen: Pixel) -> vec2<f32> {
    let length_m = select(seen.distance_m, FARTHEST_M, seen.distance_m < 0.0);
    let ray = ray_segment(shadow.eye.y, seen.direction.y, min(length_m, FARTHEST_M), 1.0 / shadow.planet_radius_m);
    return below_height(ray, shadow.highest_m);
}

@fragment
fn shade(in: Corner) -> @location(0) vec4<f32> {
    let seen = pixel(in);
    let span = span_in_shadow(seen);
    if span.y <= span.x {
        discard;
    }
    var lost = vec3<f32>(0.0);
    var before_m = span.x;
    var before_clear_m = shadow_clearance_m(seen.direction, before_m);
    // Light up to the last step, once it is known.
    var light = vec3<f32>(-1.0);
    for (var k = 1u; k <= SHADOW_STEPS; k++) {
        let place = f32(k) / f32(SHADOW_STEPS);
        let here_m = mix(span.x, span.y, place * place);
        let clear_m = shadow_clearance_m(seen.direction, here_m);
        let dark = 1.0 - lit_part(before_clear_m, clear_m);
        if dark > 0.0 {
            if light.x < 0.0 {
                light = once_to(seen.direction, before_m);
            }
            let here = once_to(seen.direction, here_m);
            lost += dark * (here - light);
            light = here;
        } else {
            light.x = -1.0;
        }
        before_m = here_m;
        before_clear_m = clear_m;
    }
    return vec4<f32>(lost * camera.exposure, 0.0);
}
