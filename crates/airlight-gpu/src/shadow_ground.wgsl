// What throws shadows is ground of heights over a grid.

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

/// Distance at which rays end, m.
const FARTHEST_M: f32 = 1e5;

/// Height above the shadow's surface, m, at a distance along a direction.
fn shadow_clearance(direction: vec3<f32>, distance_m: f32) -> f32 {
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

fn lit_share(direction: vec3<f32>, from_m: f32, to_m: f32, from_clearance: f32, to_clearance: f32) -> f32 {
    return lit_part(from_clearance, to_clearance);
}
