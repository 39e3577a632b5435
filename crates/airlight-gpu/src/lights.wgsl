// The pass of lights in fog, behind the functions of airlight-shaders and frame.wgsl: it adds the light that the fog scatters from each.

const MOST_LIGHTS: u32 = 16u;

struct Lights {
    /// The fog, in which heights count from the ground.
    fog: ExponentialFog,
    /// Number of lights.
    count: u32,
    /// Height of the eye above the ground, m.
    eye_height_m: f32,
    /// The lights, around the point of the ground below the eye.
    all: array<LocalLight, MOST_LIGHTS>,
}

@group(0) @binding(0) var<uniform> lights: Lights;

@fragment
fn add(in: Corner) -> @location(0) vec4<f32> {
    let seen = pixel(in);
    let eye = vec3<f32>(0.0, lights.eye_height_m, 0.0);
    let sine = seen.direction.y;
    var length_m = select(seen.distance_m, INFINITE_M, seen.distance_m < 0.0);
    if sine < 0.0 {
        length_m = min(length_m, lights.eye_height_m / -sine);
    }
    var sum = vec3<f32>(0.0);
    for (var i = 0u; i < lights.count; i += 1u) {
        sum += light_in_exponential_fog(lights.fog, lights.all[i], eye, seen.direction, length_m);
    }
    return vec4<f32>(sum * camera.exposure, 0.0);
}
