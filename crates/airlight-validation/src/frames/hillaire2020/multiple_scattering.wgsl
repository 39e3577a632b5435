// Light of the second and all later orders, assumed isotropic (eqs. 5 to 10): one workgroup an entry, one invocation a direction.

@group(0) @binding(1) var table: texture_storage_2d<rgba16float, write>;

/// Square root of the number of directions.
const ROOT: u32 = 8u;
const STEPS: u32 = 20u;

var<workgroup> second_order: array<vec3<f32>, 64>;
var<workgroup> returned: array<vec3<f32>, 64>;

@compute @workgroup_size(64)
fn fill(@builtin(workgroup_id) texel: vec3<u32>, @builtin(local_invocation_index) index: u32) {
    let place = vec2<f32>(texel.xy) / (MULTIPLE_SIZE - 1.0);
    let mu_sun = 2.0 * place.x - 1.0;
    // Uniform over the sphere.
    let mu = 1.0 - 2.0 * (f32(index / ROOT) + 0.5) / f32(ROOT);
    let azimuth = 2.0 * PI * (f32(index % ROOT) + 0.5) / f32(ROOT);
    let nu = mu * mu_sun + sqrt((1.0 - mu * mu) * max(1.0 - mu_sun * mu_sun, 0.0)) * cos(azimuth);
    let ray = Ray(place.y * air.top_height_km, mu, mu_sun, nu);
    let to_ground = distance_to_ground(ray.height_km, mu);
    let length_km = select(to_ground, distance_to_top(ray.height_km, mu), to_ground < 0.0);
    let step_km = length_km / f32(STEPS);
    var throughput = vec3<f32>(1.0);
    var light = vec3<f32>(0.0);
    var back = vec3<f32>(0.0);
    for (var k = 0u; k < STEPS; k++) {
        let here = advanced(ray, (f32(k) + 0.5) * step_km);
        let medium = medium_at(here.height_km);
        let step = step_through(medium.extinction, step_km);
        let scattered = throughput * step.weight_km * (medium.rayleigh + medium.mie);
        light += scattered * transmittance_to_sun(here.height_km, here.mu_sun) / (4.0 * PI);
        back += scattered;
        throughput *= step.transmittance;
    }
    if to_ground >= 0.0 {
        light += throughput * ground_radiance(advanced(ray, to_ground).mu_sun);
    }
    second_order[index] = light;
    returned[index] = back;
    for (var half = 32u; half > 0u; half /= 2u) {
        workgroupBarrier();
        if index < half {
            second_order[index] += second_order[index + half];
            returned[index] += returned[index + half];
        }
    }
    if index == 0u {
        // The series of all orders; the mean over directions of both.
        let series = second_order[0] / 64.0 / (1.0 - returned[0] / 64.0);
        textureStore(table, texel.xy, vec4<f32>(series, 1.0));
    }
}
