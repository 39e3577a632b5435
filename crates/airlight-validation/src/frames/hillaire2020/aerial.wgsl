// Light between the eye and the slices of a volume in the camera's view (section 5.4): the path radiance, and the mean transmittance of
// red, green and blue.

@group(0) @binding(5) var volume: texture_storage_3d<rgba16float, write>;

@compute @workgroup_size(8, 8)
fn fill(@builtin(global_invocation_id) texel: vec3<u32>) {
    let size = vec2<f32>(textureDimensions(volume).xy);
    let place = (vec2<f32>(texel.xy) + 0.5) / size;
    let ray = eye_ray(direction_at(vec2<f32>(2.0 * place.x - 1.0, 1.0 - 2.0 * place.y)));
    let to_ground = distance_to_ground(ray.height_km, ray.mu);
    let end_km = select(to_ground, distance_to_top(ray.height_km, ray.mu), to_ground < 0.0);
    let light = march(ray, min(slice_distance(f32(texel.z)), end_km), 2u * (texel.z + 1u));
    let transmittance = dot(light.transmittance, vec3<f32>(1.0 / 3.0));
    textureStore(volume, texel, vec4<f32>(light.radiance * view.sunlight, transmittance));
}
