// The air of Hillaire 2020, table 1, in kilometres: molecules and aerosol that thin exponentially, ozone as a tent.

struct Air {
    /// Scattering of molecules at the ground, 1/km.
    rayleigh: vec3<f32>,
    rayleigh_per_height: f32,
    /// Scattering of aerosol at the ground, 1/km.
    mie: vec3<f32>,
    mie_per_height: f32,
    /// Extinction of aerosol at the ground, 1/km.
    mie_extinction: vec3<f32>,
    mie_asymmetry: f32,
    /// Absorption of ozone at its peak, 1/km.
    ozone: vec3<f32>,
    ozone_bottom_km: f32,
    ground_albedo: vec3<f32>,
    ozone_peak_km: f32,
    ozone_top_km: f32,
    ground_radius_km: f32,
    top_height_km: f32,
}

@group(0) @binding(0) var<uniform> air: Air;

const PI: f32 = 3.141592653589793;
/// Zenith angles and altitudes of the transmittance table.
const TRANSMITTANCE_SIZE: vec2<f32> = vec2<f32>(256.0, 64.0);
/// Sun angles and altitudes of the table of multiple scattering.
const MULTIPLE_SIZE: vec2<f32> = vec2<f32>(32.0, 32.0);

/// Coefficients at a height, 1/km.
struct Medium {
    rayleigh: vec3<f32>,
    mie: vec3<f32>,
    extinction: vec3<f32>,
}

fn medium_at(height_km: f32) -> Medium {
    let molecules = exp(-height_km * air.rayleigh_per_height);
    let aerosol = exp(-height_km * air.mie_per_height);
    let rising = (height_km - air.ozone_bottom_km) / (air.ozone_peak_km - air.ozone_bottom_km);
    let falling = (air.ozone_top_km - height_km) / (air.ozone_top_km - air.ozone_peak_km);
    let ozone = max(min(rising, falling), 0.0);
    let rayleigh = air.rayleigh * molecules;
    return Medium(rayleigh, air.mie * aerosol, rayleigh + air.mie_extinction * aerosol + air.ozone * ozone);
}

/// A ray in spherical air under a distant sun: height, and cosines of its zenith angle, of the sun's, and of the angle between them.
struct Ray {
    height_km: f32,
    mu: f32,
    mu_sun: f32,
    nu: f32,
}

/// The ray with its origin moved forward.
fn advanced(ray: Ray, t_km: f32) -> Ray {
    let radius = air.ground_radius_km + ray.height_km;
    let square = t_km * (2.0 * radius * ray.mu + t_km);
    let radius_there = sqrt(radius * radius + square);
    // Without cancellation of two radii.
    let height = ray.height_km + square / (radius_there + radius);
    return Ray(
        height,
        clamp((radius * ray.mu + t_km) / radius_there, -1.0, 1.0),
        clamp((radius * ray.mu_sun + t_km * ray.nu) / radius_there, -1.0, 1.0),
        ray.nu,
    );
}

/// Difference of the squares of the radii at a height and at a lower one.
fn square_difference(height_km: f32, lower_km: f32) -> f32 {
    return max((height_km - lower_km) * (2.0 * air.ground_radius_km + height_km + lower_km), 0.0);
}

/// Distance to the top of the air, from inside.
fn distance_to_top(height_km: f32, mu: f32) -> f32 {
    let b = (air.ground_radius_km + height_km) * mu;
    let over = square_difference(air.top_height_km, height_km);
    let root = sqrt(b * b + over);
    if b > 0.0 {
        return over / (root + b);
    }
    return root - b;
}

/// Distance to the ground; negative if the ray misses it.
fn distance_to_ground(height_km: f32, mu: f32) -> f32 {
    let b = (air.ground_radius_km + height_km) * mu;
    let over = square_difference(height_km, 0.0);
    if b >= 0.0 || b * b < over {
        return -1.0;
    }
    return over / (sqrt(b * b - over) - b);
}

/// From 0 to 1 to the centres of the first and of the last texel.
fn texel_coordinates(place: vec2<f32>, size: vec2<f32>) -> vec2<f32> {
    return (0.5 + clamp(place, vec2<f32>(0.0), vec2<f32>(1.0)) * (size - 1.0)) / size;
}

/// Coordinates in the transmittance table, of Bruneton 2017: by the distance to the horizon, and by that to the top.
fn transmittance_coordinates(height_km: f32, mu: f32) -> vec2<f32> {
    let longest = sqrt(square_difference(air.top_height_km, 0.0));
    let horizon = sqrt(square_difference(height_km, 0.0));
    let least = air.top_height_km - height_km;
    let greatest = horizon + longest;
    let place = vec2<f32>((distance_to_top(height_km, mu) - least) / (greatest - least), horizon / longest);
    return texel_coordinates(place, TRANSMITTANCE_SIZE);
}

/// Height and cosine of the zenith angle of a place in the transmittance table: the inverse.
fn transmittance_ray(place: vec2<f32>) -> vec2<f32> {
    let longest = sqrt(square_difference(air.top_height_km, 0.0));
    let horizon = place.y * longest;
    let height = horizon * horizon / (sqrt(air.ground_radius_km * air.ground_radius_km + horizon * horizon) + air.ground_radius_km);
    let least = air.top_height_km - height;
    let distance = least + place.x * (horizon + longest - least);
    if distance <= 0.0 {
        return vec2<f32>(height, 1.0);
    }
    let mu = (square_difference(air.top_height_km, height) - distance * distance)
        / (2.0 * (air.ground_radius_km + height) * distance);
    return vec2<f32>(height, clamp(mu, -1.0, 1.0));
}
