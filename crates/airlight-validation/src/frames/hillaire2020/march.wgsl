// The light of a frame along a ray, marched in steps that are denser near the eye (eqs. 1 to 4 and 11).

/// What a frame is drawn for.
struct View {
    /// Perspective: from clip space to the world around the eye, y up.
    world_from_clip: mat4x4<f32>,
    /// Unit vector to the sun.
    sun: vec3<f32>,
    eye_height_km: f32,
    /// Red, green and blue of sunlight outside the air, times the exposure.
    sunlight: vec3<f32>,
    /// Elevation of the horizon, rad.
    horizon_rad: f32,
    far_depth: f32,
    /// Of the sun's disc.
    cos_radius: f32,
    /// Radiance of the disc outside the air per unit of sunlight, 1/sr.
    disc_per_sunlight: f32,
}

@group(0) @binding(1) var<uniform> view: View;

/// Light along a ray, and what the air lets through.
struct Light {
    radiance: vec3<f32>,
    transmittance: vec3<f32>,
}

fn rayleigh_phase(nu: f32) -> f32 {
    return 3.0 / (16.0 * PI) * (1.0 + nu * nu);
}

/// Cornette and Shanks 1992.
fn mie_phase(g: f32, nu: f32) -> f32 {
    let square = 1.0 + g * g - 2.0 * g * nu;
    return 3.0 / (8.0 * PI) * (1.0 - g * g) * (1.0 + nu * nu) / ((2.0 + g * g) * square * sqrt(square));
}

/// The ray of the eye along a unit vector.
fn eye_ray(direction: vec3<f32>) -> Ray {
    return Ray(view.eye_height_km, direction.y, view.sun.y, dot(direction, view.sun));
}

/// Light that the air scatters into the first `length_km` of a ray, per unit of sunlight.
fn march(ray: Ray, length_km: f32, steps: u32) -> Light {
    let rayleigh = rayleigh_phase(ray.nu);
    let mie = mie_phase(air.mie_asymmetry, ray.nu);
    var radiance = vec3<f32>(0.0);
    var throughput = vec3<f32>(1.0);
    var from_km = 0.0;
    for (var k = 0u; k < steps; k++) {
        let edge = f32(k + 1u) / f32(steps);
        let to_km = length_km * edge * edge;
        let here = advanced(ray, 0.5 * (from_km + to_km));
        let medium = medium_at(here.height_km);
        let step = step_through(medium.extinction, to_km - from_km);
        let sunlight = transmittance_to_sun(here.height_km, here.mu_sun);
        let place = vec2<f32>(0.5 + 0.5 * here.mu_sun, here.height_km / air.top_height_km);
        let psi = textureSampleLevel(multiple, linear_sampler, texel_coordinates(place, MULTIPLE_SIZE), 0.0).rgb;
        let source = sunlight * (medium.rayleigh * rayleigh + medium.mie * mie) + psi * (medium.rayleigh + medium.mie);
        radiance += throughput * step.weight_km * source;
        throughput *= step.transmittance;
        from_km = to_km;
    }
    return Light(radiance, throughput);
}

@group(0) @binding(4) var multiple: texture_2d<f32>;
