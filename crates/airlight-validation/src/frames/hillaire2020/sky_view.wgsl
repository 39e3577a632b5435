// The sky and the ground below it by direction (section 5.3).

@group(0) @binding(5) var table: texture_storage_2d<rgba16float, write>;

const STEPS: u32 = 30u;

@compute @workgroup_size(8, 4)
fn fill(@builtin(global_invocation_id) texel: vec3<u32>) {
    let size = textureDimensions(table);
    let angles = sky_angles((vec2<f32>(texel.xy) + 0.5) / vec2<f32>(size));
    let azimuth = atan2(view.sun.z, view.sun.x) + angles.x;
    let level = cos(angles.y);
    let ray = eye_ray(vec3<f32>(level * cos(azimuth), sin(angles.y), level * sin(azimuth)));
    let to_ground = select(-1.0, distance_to_ground(ray.height_km, ray.mu), angles.y < view.horizon_rad);
    let length_km = select(to_ground, distance_to_top(ray.height_km, ray.mu), to_ground < 0.0);
    let light = march(ray, length_km, STEPS);
    var radiance = light.radiance;
    if to_ground >= 0.0 {
        radiance += light.transmittance * ground_radiance(advanced(ray, to_ground).mu_sun);
    }
    textureStore(table, texel.xy, vec4<f32>(radiance * view.sunlight, 1.0));
}
