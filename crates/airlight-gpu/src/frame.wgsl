// What a pass over a frame knows of its pixels: direction and distance.

struct Camera {
    /// Perspective: from clip space to the world. Otherwise from components to the right, up and forward of the centre to the world.
    world_from_clip: mat4x4<f32>,
    exposure: f32,
    far_depth: f32,
    /// 1 with the sun's disc, 0 without.
    disc: f32,
    /// 0: perspective, 1: fisheye, 2: equirectangular.
    projection: u32,
    /// Angles from the centre to the right and to the upper edge.
    half_angles: vec2<f32>,
    /// Angle from the centre of a fisheye to the edge of its circle.
    largest_angle: f32,
}

@group(1) @binding(0) var<uniform> camera: Camera;
// Not `texture_depth_2d`, whose texels WebGL cannot load.
@group(1) @binding(1) var depth_texture: texture_2d<f32>;

/// What a pixel sees: its direction, and the distance of its geometry, negative without any.
struct Pixel {
    direction: vec3<f32>,
    distance_m: f32,
}

fn pixel(in: Corner) -> Pixel {
    let depth = textureLoad(depth_texture, vec2<i32>(in.position.xy), 0).x;
    if camera.projection == 0u {
        return perspective_pixel(in.clip, depth);
    }
    let angles = in.clip * camera.half_angles;
    var direction = vec3<f32>(0.0);
    if camera.projection == 1u {
        if length(angles) > camera.largest_angle {
            discard;
        }
        direction = fisheye_direction(angles);
    } else {
        direction = equirectangular_direction(angles);
    }
    let turned = (camera.world_from_clip * vec4<f32>(direction, 0.0)).xyz;
    return Pixel(normalize(turned), select(-1.0, depth, depth > 0.0));
}

fn perspective_pixel(clip: vec2<f32>, depth: f32) -> Pixel {
    // The depth away from the far end, where positions may be infinite.
    let near = camera.world_from_clip * vec4<f32>(clip, 1.0 - camera.far_depth, 1.0);
    let direction = normalize(near.xyz / near.w);
    if depth == camera.far_depth {
        return Pixel(direction, -1.0);
    }
    let here = camera.world_from_clip * vec4<f32>(clip, depth, 1.0);
    return Pixel(direction, length(here.xyz / here.w));
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
