// Passes that filter an environment map: each draws over one face of a cube.

struct Face {
    right: vec4<f32>,
    up: vec4<f32>,
    forward: vec4<f32>,
    /// Roughness of the surface that the level is for.
    roughness: f32,
    /// Texels on a side of the source.
    side: f32,
}

@group(0) @binding(0) var<uniform> face: Face;
@group(0) @binding(1) var linear_sampler: sampler;
@group(0) @binding(2) var source: texture_cube<f32>;

fn direction(in: Corner) -> vec3<f32> {
    return normalize(face.forward.xyz + face.right.xyz * in.clip.x + face.up.xyz * in.clip.y);
}

/// Mean of four texels of the next larger level, between which the direction lies.
@fragment
fn halve(in: Corner) -> @location(0) vec4<f32> {
    return textureSampleLevel(source, linear_sampler, direction(in), 0.0);
}

const SAMPLES: u32 = 256u;
const PI: f32 = 3.141592653589793;

/// Radiance that a surface of microfacets (GGX) reflects, seen from above, by importance sampling: each sample is the mean over the part
/// of the sphere that it stands for, from a smaller level of the source.
@fragment
fn reflect_rough(in: Corner) -> @location(0) vec4<f32> {
    let normal = direction(in);
    let helper = select(vec3<f32>(0.0, 1.0, 0.0), vec3<f32>(1.0, 0.0, 0.0), abs(normal.y) > 0.9);
    let across = normalize(cross(helper, normal));
    let other = cross(normal, across);
    let alpha = face.roughness * face.roughness;
    let texel_solid_angle = 4.0 * PI / (6.0 * face.side * face.side);
    var sum = vec3<f32>(0.0);
    var weight = 0.0;
    for (var k = 0u; k < SAMPLES; k++) {
        let u = (f32(k) + 0.5) / f32(SAMPLES);
        let azimuth = 2.0 * PI * f32(reverseBits(k)) * 2.3283064365386963e-10;
        let cos_half = sqrt((1.0 - u) / (1.0 + (alpha * alpha - 1.0) * u));
        let sin_half = sqrt(max(1.0 - cos_half * cos_half, 0.0));
        let half_way = (across * cos(azimuth) + other * sin(azimuth)) * sin_half + normal * cos_half;
        let light = 2.0 * cos_half * half_way - normal;
        let cosine = dot(normal, light);
        if cosine > 0.0 {
            let spread = 1.0 + (alpha * alpha - 1.0) * cos_half * cos_half;
            let density = alpha * alpha / (4.0 * PI * spread * spread);
            let solid_angle = 1.0 / (f32(SAMPLES) * density);
            let level = max(0.5 * log2(solid_angle / texel_solid_angle), 0.0);
            sum += textureSampleLevel(source, linear_sampler, light, level).rgb * cosine;
            weight += cosine;
        }
    }
    return vec4<f32>(sum / max(weight, 1e-6), 1.0);
}
