// The passes of a medium over a frame: the light behind each pixel is multiplied by `transmittance_to(seen)`, and `light_to(seen)` is added.

@fragment
fn dim(in: Corner) -> @location(0) vec4<f32> {
    return vec4<f32>(transmittance_to(pixel(in)), 1.0);
}

@fragment
fn add(in: Corner) -> @location(0) vec4<f32> {
    return vec4<f32>(light_to(pixel(in)) * camera.exposure, 0.0);
}
