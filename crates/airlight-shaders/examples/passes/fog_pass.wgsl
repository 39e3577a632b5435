// A pass that adds exponential height fog, lit by the sun and the sky, to a frame with its depth. The text of the part `fog` and
// `phase` goes in front of this file: airlight_shaders::source(&[Part::Fog, Part::Phase]).

struct FogPass {
    /// From clip coordinates to positions, m, y up.
    world_from_clip: mat4x4<f32>,
    /// Position of the eye, m.
    eye: vec3<f32>,
    /// Depth of what has no geometry: the sky.
    far_depth: f32,
    /// Coefficients at the reference height.
    medium: FogMedium,
    /// Unit vector to the sun.
    sun: vec3<f32>,
    /// Height of density 1, m.
    reference_height_m: f32,
    /// Irradiance of the sun on a surface that faces it.
    sunlight: vec3<f32>,
    /// Scale height, m.
    scale_height_m: f32,
    /// Mean radiance of the sky.
    ambient: vec3<f32>,
    /// Mean cosine of the phase function, 0.8 for fog.
    mean_cosine: f32,
}

@group(0) @binding(0) var<uniform> fog: FogPass;
@group(0) @binding(1) var colours: texture_2d<f32>;
@group(0) @binding(2) var depths: texture_depth_2d;

struct Corner {
    @builtin(position) position: vec4<f32>,
    @location(0) clip: vec2<f32>,
}

/// A triangle that covers the frame.
@vertex
fn corner(@builtin(vertex_index) index: u32) -> Corner {
    let clip = vec2<f32>(f32(index & 1u), f32(index >> 1u)) * 4.0 - 1.0;
    return Corner(vec4<f32>(clip, 0.0, 1.0), clip);
}

/// Position of a depth in a pixel, m.
fn position_at(clip: vec2<f32>, depth: f32) -> vec3<f32> {
    let position = fog.world_from_clip * vec4<f32>(clip, depth, 1.0);
    return position.xyz / position.w;
}

@fragment
fn add_fog(in: Corner) -> @location(0) vec4<f32> {
    let pixel = vec2<i32>(in.position.xy);
    let colour = textureLoad(colours, pixel, 0);
    let depth = textureLoad(depths, pixel, 0);
    // The end of the depths that is not far has a position for every pixel.
    let to_point = position_at(in.clip, select(depth, 1.0 - fog.far_depth, depth == fog.far_depth)) - fog.eye;
    let direction = normalize(to_point);
    let distance_m = select(length(to_point), INFINITE_M, depth == fog.far_depth);
    let phase = henyey_greenstein(one_minus_cos_between(direction, fog.sun), fog.mean_cosine);
    let light = FogLight(fog.sunlight * phase, fog.sun.y, fog.ambient);
    let path = exponential_fog(
        fog.medium,
        fog.eye.y,
        direction.y,
        distance_m,
        fog.reference_height_m,
        fog.scale_height_m,
        light,
    );
    return vec4<f32>(apply_path_optics(path, colour.rgb), colour.a);
}
