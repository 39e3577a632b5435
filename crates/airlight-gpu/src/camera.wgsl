// The camera of a frame: directions, distances and depths of its pixels.

struct Camera {
    /// Perspective: from clip space to the world. Otherwise from components to the right, up and forward of the centre to the world.
    world_from_clip: mat4x4<f32>,
    exposure: f32,
    far_depth: f32,
    /// 0: perspective, 1: fisheye, 2: equirectangular.
    projection: u32,
    /// Angles from the centre to the right and to the upper edge.
    half_angles: vec2<f32>,
    /// Angle from the centre of a fisheye to the edge of its circle.
    largest_angle: f32,
}

@group(1) @binding(0) var<uniform> camera: Camera;

/// Direction of a place in clip space.
fn direction_at(clip: vec2<f32>) -> vec3<f32> {
    if camera.projection == 0u {
        // The depth away from the far end, where positions may be infinite.
        let near = camera.world_from_clip * vec4<f32>(clip, 1.0 - camera.far_depth, 1.0);
        return normalize(near.xyz / near.w);
    }
    let angles = clip * camera.half_angles;
    var direction = equirectangular_direction(angles);
    if camera.projection == 1u {
        direction = fisheye_direction(angles);
    }
    return normalize((camera.world_from_clip * vec4<f32>(direction, 0.0)).xyz);
}

/// Whether a place in clip space is outside the circle of a fisheye.
fn is_outside(clip: vec2<f32>) -> bool {
    return camera.projection == 1u && length(clip * camera.half_angles) > camera.largest_angle;
}

/// Distance of a depth, m.
fn distance_at(clip: vec2<f32>, depth: f32) -> f32 {
    if camera.projection != 0u {
        return depth;
    }
    let here = camera.world_from_clip * vec4<f32>(clip, depth, 1.0);
    return length(here.xyz / here.w);
}

/// Depth of a distance along the direction of a place: the inverse of `distance_at`.
fn depth_at(clip: vec2<f32>, direction: vec3<f32>, distance_m: f32) -> f32 {
    if camera.projection != 0u {
        return distance_m;
    }
    let plane = camera.world_from_clip * vec4<f32>(clip, 0.0, 1.0);
    let per_depth = camera.world_from_clip[2];
    return (distance_m * plane.w - dot(plane.xyz, direction)) / (dot(per_depth.xyz, direction) - distance_m * per_depth.w);
}

/// Right, up and forward of a direction from its angle from the centre, as components to the right and up.
fn fisheye_direction(angles: vec2<f32>) -> vec3<f32> {
    let angle = length(angles);
    return vec3<f32>(angles * (sin(angle) / max(angle, 1e-9)), cos(angle));
}

/// Right, up and forward of a direction from its angle to the right and its elevation.
fn equirectangular_direction(angles: vec2<f32>) -> vec3<f32> {
    let level = cos(angles.y);
    return vec3<f32>(level * sin(angles.x), sin(angles.y), level * cos(angles.x));
}
