
// Both at once by `path_to(seen)`, where the device blends with two colours.

struct AtOnce {
    @location(0) @blend_src(0) light: vec4<f32>,
    @location(0) @blend_src(1) transmittance: vec4<f32>,
}

@fragment
fn dim_and_add(in: Corner) -> AtOnce {
    let path = path_to(pixel(in));
    return AtOnce(vec4<f32>(path.path_radiance * camera.exposure, 0.0), vec4<f32>(path.transmittance, 1.0));
}
