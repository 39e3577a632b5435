// The fog of the passes of medium.wgsl, behind the functions of airlight-shaders and frame.wgsl.

/// A layer of fog seen from the eye: the view of its tables, and its column.
struct SeenLayer {
    view: FogTableView,
    layer: FogLayer,
}

struct Fog {
    /// The layers, of which the first `count` are used.
    layers: array<SeenLayer, MOST_FOG_LAYERS>,
    count: u32,
    /// Height of the eye above the ground, from which the heights of the layers count, m.
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
    let ray = ray_segment(fog.eye_height_m, sine, length_m, 0.0);
    var path = PathOptics(vec3<f32>(1.0), vec3<f32>(0.0));
    for (var i = 0u; i < fog.count; i += 1u) {
        let layer = fog.layers[i].layer;
        let depth = min(layer.extinction_per_m * fog_layer_column_m(layer, ray), vec3<f32>(OPAQUE));
        let of_layer = tabulated_fog(
            fog.layers[i].view, diffuse, streams, stream_phase, linear_sampler, seen.direction, depth,
        );
        path.transmittance *= of_layer.transmittance;
        path.path_radiance += of_layer.path_radiance;
    }
    return path;
}

fn transmittance_to(seen: Pixel) -> vec3<f32> {
    return path_to(seen).transmittance;
}

fn light_to(seen: Pixel) -> vec3<f32> {
    return path_to(seen).path_radiance;
}
