// What a pass over a frame knows of its pixels, behind camera.wgsl: direction and distance.

// Not `texture_depth_2d`, whose texels WebGL cannot load.
@group(1) @binding(1) var depth_texture: texture_2d<f32>;

/// What a pixel sees: its direction, and the distance of its geometry, negative without any.
struct Pixel {
    direction: vec3<f32>,
    distance_m: f32,
}

fn pixel(in: Corner) -> Pixel {
    let depth = textureLoad(depth_texture, vec2<i32>(in.position.xy), 0).x;
    let direction = direction_at(in.clip);
    if is_outside(in.clip) {
        discard;
    }
    if depth == camera.far_depth {
        return Pixel(direction, -1.0);
    }
    return Pixel(direction, distance_at(in.clip, depth));
}
