// What a pass over a frame knows of its pixels: direction and distance.

struct Camera {
    world_from_clip: mat4x4<f32>,
    exposure: f32,
    far_depth: f32,
    /// 1 with the sun's disc, 0 without.
    disc: f32,
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
    // The depth away from the far end, where positions may be infinite.
    let near = camera.world_from_clip * vec4<f32>(in.clip, 1.0 - camera.far_depth, 1.0);
    let direction = normalize(near.xyz / near.w);
    let depth = textureLoad(depth_texture, vec2<i32>(in.position.xy), 0).x;
    if depth == camera.far_depth {
        return Pixel(direction, -1.0);
    }
    let here = camera.world_from_clip * vec4<f32>(in.clip, depth, 1.0);
    return Pixel(direction, length(here.xyz / here.w));
}
