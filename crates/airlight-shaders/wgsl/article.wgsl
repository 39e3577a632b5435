// The shader of the article "Sky and Atmosphere rendering: A physical approach" as printed, with its errors: 8 steps of equal
// length, three channels in cd/m^2, ozone with the profile of molecules, no planet in the way (below the horizon, values may not be
// numbers). For skies that are right use `sky_tables`. Directions are unit vectors, y up; positions count from the planet's centre,
// m.

/// Steps along each ray.
const ARTICLE_STEPS: i32 = 8;
/// The article's pi.
const ARTICLE_PI: f32 = 3.14159265359;
/// Radius of the planet, m.
const ARTICLE_PLANET_RADIUS_M: f32 = 6360e3;
/// Radius of the top of the air, m.
const ARTICLE_TOP_RADIUS_M: f32 = 6420e3;
/// Scale height of molecules and ozone, m.
const ARTICLE_RAYLEIGH_SCALE_M: f32 = 8000.0;
/// Scale height of haze, m.
const ARTICLE_MIE_SCALE_M: f32 = 1200.0;

/// What the pixels of a frame share; made by `article_sky`.
struct ArticleSky {
    /// Position of the eye.
    eye: vec3<f32>,
    /// Angular radius of the sun, rad.
    sun_radius_rad: f32,
    /// Luminance of the sun's disc outside the air.
    outer_space: vec3<f32>,
    /// Solid angle of the sun, sr.
    sun_solid_angle: f32,
}

/// Scattering by molecules, 1/m.
///
/// Cost: 1 exp. Error: 3e-4 relative.
fn article_sigma_rayleigh(position: vec3<f32>) -> vec3<f32> {
    let height_m = length(position) - ARTICLE_PLANET_RADIUS_M;
    return vec3<f32>(5.8, 13.5, 33.1) * 1e-6 * exp(-height_m / ARTICLE_RAYLEIGH_SCALE_M);
}

/// Scattering by haze, 1/m.
///
/// Cost: 1 exp. Error: 1.5e-3 relative.
fn article_sigma_mie(position: vec3<f32>) -> vec3<f32> {
    let height_m = length(position) - ARTICLE_PLANET_RADIUS_M;
    return vec3<f32>(21.0) * 1e-6 * exp(-height_m / ARTICLE_MIE_SCALE_M);
}

/// Absorption by ozone, 1/m.
///
/// Cost: 1 exp. Error: 3e-4 relative.
fn article_sigma_ozone(position: vec3<f32>) -> vec3<f32> {
    let height_m = length(position) - ARTICLE_PLANET_RADIUS_M;
    return vec3<f32>(3.426, 8.298, 0.356) * 0.06 * 1e-5 * exp(-height_m / ARTICLE_RAYLEIGH_SCALE_M);
}

/// Extinction, 1/m.
///
/// Cost: 3 exp. Error: 1.5e-3 relative.
fn article_sigma_t(position: vec3<f32>) -> vec3<f32> {
    return article_sigma_rayleigh(position) + 1.11 * article_sigma_mie(position) + article_sigma_ozone(position);
}

/// Transmittance between two points.
///
/// Cost: 3 exp, 3 exp a step; 8 steps. Error: 1e-3 relative plus 2e-4 absolute.
fn article_transmittance(from_m: vec3<f32>, to_m: vec3<f32>) -> vec3<f32> {
    let ds = (to_m - from_m) / f32(ARTICLE_STEPS);
    var sum = vec3<f32>(0.0);
    for (var i = 0; i < ARTICLE_STEPS; i += 1) {
        sum += article_sigma_t(from_m + (f32(i) + 0.5) * ds);
    }
    return exp(-sum * length(ds));
}

/// Distance to a sphere around the centre from a point inside, m.
///
/// Cost: no exp. Error: 1e-3 relative plus 2 absolute.
fn article_distance_m(origin: vec3<f32>, direction: vec3<f32>, radius_m: f32) -> f32 {
    let b = dot(origin, direction);
    return -b + sqrt(b * b - (dot(origin, origin) - radius_m * radius_m));
}

/// Phase function of molecules, 1/sr.
///
/// Cost: no exp. Error: 1e-6 relative.
fn article_rayleigh_phase(mu: f32) -> f32 {
    return 3.0 / (16.0 * ARTICLE_PI) * (1.0 + mu * mu);
}

/// Phase function of haze, 1/sr: Henyey-Greenstein, `g` = 0.76.
///
/// Cost: 1 exp. Error: 4e-6 relative.
fn article_mie_phase(mu: f32) -> f32 {
    let g = 0.76;
    return (1.0 - g * g) / (4.0 * ARTICLE_PI * pow(1.0 + g * g - 2.0 * g * mu, 1.5));
}

/// Eye at an altitude, and a sun that is white and has an illuminance (120 000 lx in the article) on the ground when it stands at
/// the zenith. Compute it once for all pixels. The solid angle, `1 - cos`, keeps three digits at best.
///
/// Cost: 7 exp. Error: 4e-3 relative.
fn article_sky(eye_altitude_m: f32, zenith_illuminance: f32) -> ArticleSky {
    let eye = vec3<f32>(0.0, ARTICLE_PLANET_RADIUS_M + eye_altitude_m, 0.0);
    let origin_h = eye.y - ARTICLE_PLANET_RADIUS_M;
    let top_h = ARTICLE_TOP_RADIUS_M - ARTICLE_PLANET_RADIUS_M;
    let rayleigh_m = ARTICLE_RAYLEIGH_SCALE_M * (exp(-origin_h / ARTICLE_RAYLEIGH_SCALE_M) - exp(-top_h / ARTICLE_RAYLEIGH_SCALE_M));
    let mie_m = ARTICLE_MIE_SCALE_M * (exp(-origin_h / ARTICLE_MIE_SCALE_M) - exp(-top_h / ARTICLE_MIE_SCALE_M));
    // Without the factor 1.11 of haze, as printed.
    let depth = vec3<f32>(5.8, 13.5, 33.1) * 1e-6 * rayleigh_m + vec3<f32>(21.0) * 1e-6 * mie_m
        + vec3<f32>(3.426, 8.298, 0.356) * 0.06 * 1e-5 * rayleigh_m;
    let sun_radius_rad = radians(0.53 / 2.0);
    let solid_angle = 2.0 * ARTICLE_PI * (1.0 - cos(sun_radius_rad));
    return ArticleSky(eye, sun_radius_rad, vec3<f32>(zenith_illuminance) / solid_angle / exp(-depth), solid_angle);
}

/// Light that a point scatters along a view ray, per metre.
///
/// Cost: 6 exp, 3 exp a step; 8 steps. Error: 2e-3 relative plus 1e-6 absolute.
fn article_source(sky: ArticleSky, position: vec3<f32>, view: vec3<f32>, sun: vec3<f32>) -> vec3<f32> {
    let leaves = position + sun * article_distance_m(position, sun, ARTICLE_TOP_RADIUS_M);
    let to_sun = article_transmittance(position, leaves);
    let mu = dot(view, sun);
    let rayleigh = article_sigma_rayleigh(position) * article_rayleigh_phase(mu);
    let mie = article_sigma_mie(position) * article_mie_phase(mu);
    return sky.outer_space * to_sun * sky.sun_solid_angle * (rayleigh + mie);
}

/// Luminance of the sky along a direction above the horizon, without the sun's disc.
///
/// Cost: 15 exp a step; 8 steps, in each of which two marches of 8 steps take 6 of these, 456 in all. Error: 2e-3 relative plus
/// 1e-2 absolute.
fn article_luminance(sky: ArticleSky, view: vec3<f32>, sun: vec3<f32>) -> vec3<f32> {
    let leaves = sky.eye + view * article_distance_m(sky.eye, view, ARTICLE_TOP_RADIUS_M);
    let ds = (leaves - sky.eye) / f32(ARTICLE_STEPS);
    let direction = ds / length(ds);
    var sum = vec3<f32>(0.0);
    for (var i = 0; i < ARTICLE_STEPS; i += 1) {
        let s = sky.eye + (f32(i) + 0.5) * ds;
        sum += article_transmittance(sky.eye, s) * article_source(sky, s, direction, sun);
    }
    return sum * length(ds);
}

/// Luminance of the sun's disc along a direction above the horizon, whose edge is smooth from 0.95 to 1.05 of its radius. The
/// cosine is clamped to 1, unlike as printed.
///
/// Cost: 3 exp, 3 exp a step; 8 steps. Error: 5e-3 relative plus 1e-2 absolute.
fn article_disc(sky: ArticleSky, view: vec3<f32>, sun: vec3<f32>) -> vec3<f32> {
    let angle = acos(min(dot(view, sun), 1.0));
    let disc = 1.0 - smoothstep(0.95 * sky.sun_radius_rad, 1.05 * sky.sun_radius_rad, angle);
    let leaves = sky.eye + view * article_distance_m(sky.eye, view, ARTICLE_TOP_RADIUS_M);
    return sky.outer_space * disc * article_transmittance(sky.eye, leaves);
}
