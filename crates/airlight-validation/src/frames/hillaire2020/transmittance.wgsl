// The transmittance to the top of the air by height and zenith angle (eqs. 2 and 3).

@group(0) @binding(1) var table: texture_storage_2d<rgba16float, write>;

const STEPS: u32 = 40u;

@compute @workgroup_size(8, 8)
fn fill(@builtin(global_invocation_id) texel: vec3<u32>) {
    let ray = transmittance_ray(vec2<f32>(texel.xy) / (TRANSMITTANCE_SIZE - 1.0));
    let step_km = distance_to_top(ray.x, ray.y) / f32(STEPS);
    var depth = vec3<f32>(0.0);
    for (var k = 0u; k < STEPS; k++) {
        let here = advanced(Ray(ray.x, ray.y, 0.0, 0.0), (f32(k) + 0.5) * step_km);
        depth += medium_at(here.height_km).extinction * step_km;
    }
    textureStore(table, texel.xy, vec4<f32>(exp(-depth), 1.0));
}
