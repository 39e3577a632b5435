// The passes of the sky, before those of medium.wgsl and behind the functions of airlight-shaders and frame.wgsl: air and sky, and the disc of
// the sun, or of the moon in its place.

struct Sky {
    view: SkyView,
    scales: SkyScales,
    radiance_weights: RgbWeights,
    transmittance_weights: RgbWeights,
    disc_weights: RgbWeights,
    disc: Disc,
}

/// The disc of the sun, or of the moon.
struct Disc {
    /// From the moon to the sun; 0 for the sun itself, all of whose disc shines.
    moon_to_sun: vec3<f32>,
    /// 1 minus the cosine of the angular radius.
    one_minus_cos: f32,
    sin_radius: f32,
    /// Factor of the table.
    radiance: f32,
}

@group(0) @binding(0) var<uniform> sky: Sky;
@group(0) @binding(1) var linear_sampler: sampler;
@group(0) @binding(2) var sky_smooth: texture_2d<f32>;
@group(0) @binding(3) var sky_haze: texture_2d<f32>;
@group(0) @binding(4) var aerial_smooth: texture_3d<f32>;
@group(0) @binding(5) var aerial_haze: texture_3d<f32>;
@group(0) @binding(6) var extinction: texture_2d<f32>;
@group(0) @binding(7) var phase: texture_2d<f32>;
@group(0) @binding(8) var disc_table: texture_2d<f32>;

/// Samples on a side of a pixel that the edge of the sun's disc crosses.
const DISC_SAMPLES: u32 = 8u;
/// Longer than any way through the air.
const BEYOND_AIR_M: f32 = 1e9;

/// Air in front of what a pixel sees.
fn air_to(seen: Pixel) -> SpectralPath {
    return aerial_perspective(
        sky.view, sky.scales, aerial_smooth, aerial_haze, extinction, phase, linear_sampler, seen.direction, seen.distance_m,
    );
}

/// Transmittance to the point that a pixel sees, or to space.
fn air_transmittance(seen: Pixel) -> vec4<f32> {
    let distance_m = select(seen.distance_m, BEYOND_AIR_M, seen.distance_m < 0.0);
    return aerial_transmittance(sky.view, extinction, linear_sampler, seen.direction, distance_m);
}

/// Radiance of the sky, or of the ground of the planet.
fn radiance_without_geometry(direction: vec3<f32>) -> vec3<f32> {
    let radiance = sky_radiance(sky.view, sky.scales, sky_smooth, sky_haze, phase, linear_sampler, direction);
    return rgb_from_spectrum(sky.radiance_weights, radiance);
}

fn is_ground(seen: Pixel) -> bool {
    return seen.distance_m < 0.0 && elevation_of(seen.direction) < sky.view.horizon_rad;
}

/// Radiance of the sun's disc outside the air along a direction without geometry; 0 beside it and below the horizon.
fn disc_outside_air(direction: vec3<f32>) -> vec4<f32> {
    let one_minus_cos = one_minus_cos_between(direction, sky.view.sun);
    if one_minus_cos >= sky.disc.one_minus_cos || is_ground(Pixel(direction, -1.0)) {
        return vec4<f32>(0.0);
    }
    let mu = sqrt(1.0 - one_minus_cos / sky.disc.one_minus_cos);
    let relative = textureSampleLevel(disc_table, linear_sampler, vec2<f32>(texel_coordinate(mu, 64.0), 0.5), 0.0);
    if all(sky.disc.moon_to_sun == vec3<f32>(0.0)) {
        return sky.disc.radiance * relative;
    }
    let reflected = moon_reflection(sky.view.sun, sky.disc.moon_to_sun, sky.disc.sin_radius, direction);
    return sky.disc.radiance * reflected * relative;
}

/// Red, green and blue of the sun's disc, dimmed by the air: the mean over a pixel without geometry, of this size in clip space.
fn sun_disc(in: Corner, seen: Pixel, pixel_size: vec2<f32>) -> vec3<f32> {
    let reach = distance(direction_at(in.clip + 0.5 * pixel_size), seen.direction);
    let radius = sqrt(2.0 * sky.disc.one_minus_cos);
    let away = sqrt(2.0 * one_minus_cos_between(seen.direction, sky.view.sun));
    if away > radius + reach {
        return vec3<f32>(0.0);
    }
    var samples = DISC_SAMPLES;
    if away + 8.0 * reach < radius {
        // Brightness is even across a pixel far inside the disc.
        samples = 1u;
    }
    var outside = vec4<f32>(0.0);
    var towards = vec3<f32>(0.0);
    for (var k = 0u; k < samples * samples; k++) {
        let place = (vec2<f32>(vec2<u32>(k % samples, k / samples)) + 0.5) / f32(samples) - 0.5;
        let direction = direction_at(in.clip + place * pixel_size);
        let radiance = disc_outside_air(direction);
        outside += radiance;
        towards += direction * radiance.x;
    }
    if outside.x <= 0.0 {
        return vec3<f32>(0.0);
    }
    let mean = outside / f32(samples * samples);
    let transmittance = air_transmittance(Pixel(normalize(towards), -1.0));
    return rgb_from_spectrum(sky.disc_weights, mean * transmittance);
}

/// What the light behind a pixel is multiplied by: the ground of the planet hides it.
fn transmittance_to(seen: Pixel) -> vec3<f32> {
    if is_ground(seen) {
        return vec3<f32>(0.0);
    }
    return rgb_from_spectrum(sky.transmittance_weights, air_transmittance(seen));
}

/// Light of the air in front of what a pixel sees, or of sky and ground.
fn light_to(seen: Pixel) -> vec3<f32> {
    if seen.distance_m < 0.0 {
        return radiance_without_geometry(seen.direction);
    }
    return rgb_from_spectrum(sky.radiance_weights, air_to(seen).path_radiance);
}

/// Both.
fn path_to(seen: Pixel) -> PathOptics {
    if seen.distance_m < 0.0 {
        return PathOptics(transmittance_to(seen), radiance_without_geometry(seen.direction));
    }
    return rgb_path(sky.radiance_weights, sky.transmittance_weights, air_to(seen));
}

@fragment
fn disc(in: Corner) -> @location(0) vec4<f32> {
    let seen = pixel(in);
    // Not from the size of the depth texture, which is wrong in WebGL.
    let pixel_size = vec2<f32>(dpdx(in.clip.x), dpdy(in.clip.y));
    if seen.distance_m >= 0.0 {
        discard;
    }
    return vec4<f32>(sun_disc(in, seen, pixel_size) * camera.exposure, 0.0);
}
