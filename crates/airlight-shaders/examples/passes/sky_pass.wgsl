// A pass that draws sky and ground and puts the air in front of geometry, from the tables that airlight_shaders::SkyTables fills: to a
// target of high range, in cd/m^2. The text of the part `sky_tables` goes in front of this file: airlight_shaders::Pass::Sky.source().

struct SkyPass {
    /// From clip coordinates to positions, m, y up.
    world_from_clip: mat4x4<f32>,
    /// Position of the eye, m.
    eye: vec3<f32>,
    /// Depth of what has no geometry: the sky.
    far_depth: f32,
    /// The numbers of the tables, of the same names.
    view: SkyView,
    scales: SkyScales,
    radiance_weights: RgbWeights,
    transmittance_weights: RgbWeights,
}

@group(0) @binding(0) var<uniform> sky: SkyPass;
@group(0) @binding(1) var colours: texture_2d<f32>;
@group(0) @binding(2) var depths: texture_depth_2d;
@group(0) @binding(3) var linear_sampler: sampler;
@group(0) @binding(4) var sky_smooth: texture_2d<f32>;
@group(0) @binding(5) var sky_haze: texture_2d<f32>;
@group(0) @binding(6) var aerial_smooth: texture_3d<f32>;
@group(0) @binding(7) var aerial_haze: texture_3d<f32>;
@group(0) @binding(8) var extinction: texture_2d<f32>;
@group(0) @binding(9) var phase: texture_2d<f32>;

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
    let position = sky.world_from_clip * vec4<f32>(clip, depth, 1.0);
    return position.xyz / position.w;
}

@fragment
fn add_sky(in: Corner) -> @location(0) vec4<f32> {
    let pixel = vec2<i32>(in.position.xy);
    let colour = textureLoad(colours, pixel, 0);
    let depth = textureLoad(depths, pixel, 0);
    if depth == sky.far_depth {
        // The end of the depths that is not far has a position for every pixel.
        let direction = normalize(position_at(in.clip, 1.0 - sky.far_depth) - sky.eye);
        let radiance = sky_radiance(sky.view, sky.scales, sky_smooth, sky_haze, phase, linear_sampler, direction);
        return vec4<f32>(rgb_from_spectrum(sky.radiance_weights, radiance), colour.a);
    }
    let to_point = position_at(in.clip, depth) - sky.eye;
    let air = aerial_perspective(
        sky.view, sky.scales, aerial_smooth, aerial_haze, extinction, phase, linear_sampler,
        normalize(to_point), length(to_point),
    );
    let path = rgb_path(sky.radiance_weights, sky.transmittance_weights, air);
    return vec4<f32>(apply_path_optics(path, colour.rgb), colour.a);
}
