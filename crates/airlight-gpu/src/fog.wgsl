// The passes of the fog, behind the functions of airlight-shaders and frame.wgsl: one multiplies the frame, sky included, by the
// transmittance of the fog, one adds the light of the fog.

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

fn fog_to(seen: Pixel) -> PathOptics {
    let sine = seen.direction.y;
    var length_m = select(seen.distance_m, INFINITE_M, seen.distance_m < 0.0);
    if sine < 0.0 {
        length_m = min(length_m, fog.eye_height_m / -sine);
    }
    let column_m = fog_layer_column_m(fog.layer, ray_segment(fog.eye_height_m, sine, length_m, 0.0));
    let depth = min(fog.layer.extinction_per_m * column_m, vec3<f32>(OPAQUE));
    return tabulated_fog(fog.view, diffuse, streams, stream_phase, linear_sampler, seen.direction, depth);
}

@fragment
fn dim(in: Corner) -> @location(0) vec4<f32> {
    return vec4<f32>(fog_to(pixel(in)).transmittance, 1.0);
}

@fragment
fn add(in: Corner) -> @location(0) vec4<f32> {
    return vec4<f32>(fog_to(pixel(in)).path_radiance * camera.exposure, 0.0);
}
