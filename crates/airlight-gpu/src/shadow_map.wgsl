// What throws shadows is in the shadow map of a program.

struct ShadowMap {
    /// From the world around the eye to the clip space of the map.
    clip_from_world: mat4x4<f32>,
    /// Width and height of the map, texels.
    size: vec2<f32>,
    /// Distance from the eye up to which there are shadows, m.
    reach_m: f32,
    /// 1 if depths increase away from the sun, -1 if they decrease.
    depth_sign: f32,
}

@group(2) @binding(0) var<uniform> shadow_map: ShadowMap;
@group(2) @binding(1) var shadow_depth: texture_2d<f32>;

/// Bisections by which the edge of a shadow is found inside a step.
const EDGE_STEPS: u32 = 5u;

fn span_in_shadow(seen: Pixel) -> vec2<f32> {
    let length_m = select(seen.distance_m, shadow_map.reach_m, seen.distance_m < 0.0);
    return vec2<f32>(0.0, min(length_m, shadow_map.reach_m));
}

/// 1 in sunlight and outside the map, -1 in shadow.
fn shadow_clearance(direction: vec3<f32>, distance_m: f32) -> f32 {
    let clip = shadow_map.clip_from_world * vec4<f32>(direction * distance_m, 1.0);
    let place = clip.xyz / clip.w;
    let texel = (place.xy * vec2<f32>(0.5, -0.5) + 0.5) * shadow_map.size;
    if any(texel < vec2<f32>(0.0)) || any(texel >= shadow_map.size) {
        return 1.0;
    }
    let nearest = textureLoad(shadow_depth, vec2<i32>(texel), 0).x;
    return select(1.0, -1.0, shadow_map.depth_sign * (place.z - nearest) > 0.0);
}

fn lit_share(direction: vec3<f32>, from_m: f32, to_m: f32, from_clearance: f32, to_clearance: f32) -> f32 {
    if from_clearance == to_clearance {
        return select(0.0, 1.0, from_clearance > 0.0);
    }
    var before_m = from_m;
    var behind_m = to_m;
    for (var k = 0u; k < EDGE_STEPS; k++) {
        let middle_m = 0.5 * (before_m + behind_m);
        if shadow_clearance(direction, middle_m) == from_clearance {
            before_m = middle_m;
        } else {
            behind_m = middle_m;
        }
    }
    let share = (0.5 * (before_m + behind_m) - from_m) / (to_m - from_m);
    return select(1.0 - share, share, from_clearance > 0.0);
}
