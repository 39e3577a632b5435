// The fog of the passes of medium.wgsl, behind the functions of airlight-shaders and frame.wgsl.

struct Fog {
    view: FogTableView,
    layer: FogLayer,
    /// Height of the eye above the ground, from which the heights of the layer count, m.
    eye_height_m: f32,
}

@group(0) @binding(0) var<uniform> fog: Fog;
@group(0) @binding(1) var linear_sampler: sampler;
@group(0) @binding(2) var diffuse: texture_3d<f32>;
@group(0) @binding(3) var streams: texture_3d<f32>;
@group(0) @binding(4) var stream_phase: texture_2d<f32>;

/// Fog in front of what a pixel sees.
fn path_to(seen: Pixel) -> PathOptics {
    let sine = seen.direction.y;
    var length_m = select(seen.distance_m, INFINITE_M, seen.distance_m < 0.0);
    if sine < 0.0 {
        length_m = min(length_m, fog.eye_height_m / -sine);
    }
    let column_m = fog_layer_column_m(fog.layer, ray_segment(fog.eye_height_m, sine, length_m, 0.0));
    let depth = min(fog.layer.extinction_per_m * column_m, vec3<f32>(OPAQUE));
    return tabulated_fog(fog.view, diffuse, streams, stream_phase, linear_sampler, seen.direction, depth);
}

fn transmittance_to(seen: Pixel) -> vec3<f32> {
    return path_to(seen).transmittance;
}

fn light_to(seen: Pixel) -> vec3<f32> {
    return path_to(seen).path_radiance;
}
