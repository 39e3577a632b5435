// Sunlight in the air, per unit of solar irradiance, from the transmittance table.

@group(0) @binding(2) var linear_sampler: sampler;
@group(0) @binding(3) var transmittances: texture_2d<f32>;

fn transmittance_to_top(height_km: f32, mu: f32) -> vec3<f32> {
    return textureSampleLevel(transmittances, linear_sampler, transmittance_coordinates(height_km, mu), 0.0).rgb;
}

/// Transmittance to the sun; 0 in the shadow of the planet.
fn transmittance_to_sun(height_km: f32, mu_sun: f32) -> vec3<f32> {
    let b = (air.ground_radius_km + height_km) * mu_sun;
    if b < 0.0 && b * b > square_difference(height_km, 0.0) {
        return vec3<f32>(0.0);
    }
    return transmittance_to_top(height_km, mu_sun);
}

/// Radiance of the ground in direct sunlight.
fn ground_radiance(mu_sun: f32) -> vec3<f32> {
    if mu_sun <= 0.0 {
        return vec3<f32>(0.0);
    }
    return transmittance_to_top(0.0, mu_sun) * air.ground_albedo * (mu_sun / PI);
}

/// Transmittance of a step, and the integral of transmittance over it, km.
struct Step {
    transmittance: vec3<f32>,
    weight_km: vec3<f32>,
}

/// A step in which the coefficients are constant.
fn step_through(extinction: vec3<f32>, length_km: f32) -> Step {
    let transmittance = exp(-extinction * length_km);
    return Step(transmittance, (1.0 - transmittance) / extinction);
}
