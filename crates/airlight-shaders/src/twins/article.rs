//! The sky article's shader as printed: `wgsl/article.wgsl`.

use glam::Vec3;

/// Steps along each ray.
pub const ARTICLE_STEPS: i32 = 8;
/// The article's pi.
#[allow(clippy::approx_constant, clippy::excessive_precision)]
pub const ARTICLE_PI: f32 = 3.14159265359;
/// Radius of the planet, m.
pub const ARTICLE_PLANET_RADIUS_M: f32 = 6360e3;
/// Radius of the top of the air, m.
pub const ARTICLE_TOP_RADIUS_M: f32 = 6420e3;
/// Scale height of molecules and ozone, m.
pub const ARTICLE_RAYLEIGH_SCALE_M: f32 = 8000.0;
/// Scale height of haze, m.
pub const ARTICLE_MIE_SCALE_M: f32 = 1200.0;

const RAYLEIGH: Vec3 = Vec3::new(5.8, 13.5, 33.1);
const OZONE: Vec3 = Vec3::new(3.426, 8.298, 0.356);

/// What the pixels of a frame share.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct ArticleSky {
    /// Position of the eye.
    pub eye: Vec3,
    /// Angular radius of the sun, rad.
    pub sun_radius_rad: f32,
    /// Luminance of the sun's disc outside the air.
    pub outer_space: Vec3,
    /// Solid angle of the sun, sr.
    pub sun_solid_angle: f32,
}

/// Scattering by molecules, 1/m.
pub fn article_sigma_rayleigh(position: Vec3) -> Vec3 {
    let height_m = position.length() - ARTICLE_PLANET_RADIUS_M;
    RAYLEIGH * 1e-6 * (-height_m / ARTICLE_RAYLEIGH_SCALE_M).exp()
}

/// Scattering by haze, 1/m.
pub fn article_sigma_mie(position: Vec3) -> Vec3 {
    let height_m = position.length() - ARTICLE_PLANET_RADIUS_M;
    Vec3::splat(21.0) * 1e-6 * (-height_m / ARTICLE_MIE_SCALE_M).exp()
}

/// Absorption by ozone, 1/m.
pub fn article_sigma_ozone(position: Vec3) -> Vec3 {
    let height_m = position.length() - ARTICLE_PLANET_RADIUS_M;
    OZONE * 0.06 * 1e-5 * (-height_m / ARTICLE_RAYLEIGH_SCALE_M).exp()
}

/// Extinction, 1/m.
pub fn article_sigma_t(position: Vec3) -> Vec3 {
    article_sigma_rayleigh(position)
        + 1.11 * article_sigma_mie(position)
        + article_sigma_ozone(position)
}

/// Transmittance between two points.
pub fn article_transmittance(from_m: Vec3, to_m: Vec3) -> Vec3 {
    let ds = (to_m - from_m) / ARTICLE_STEPS as f32;
    let mut sum = Vec3::ZERO;
    for i in 0..ARTICLE_STEPS {
        sum += article_sigma_t(from_m + (i as f32 + 0.5) * ds);
    }
    (-sum * ds.length()).exp()
}

/// Distance to a sphere around the centre from a point inside, m.
pub fn article_distance_m(origin: Vec3, direction: Vec3, radius_m: f32) -> f32 {
    let b = origin.dot(direction);
    -b + (b * b - (origin.dot(origin) - radius_m * radius_m)).sqrt()
}

/// Phase function of molecules, 1/sr.
pub fn article_rayleigh_phase(mu: f32) -> f32 {
    3.0 / (16.0 * ARTICLE_PI) * (1.0 + mu * mu)
}

/// Phase function of haze, 1/sr.
pub fn article_mie_phase(mu: f32) -> f32 {
    let g = 0.76f32;
    (1.0 - g * g) / (4.0 * ARTICLE_PI * (1.0 + g * g - 2.0 * g * mu).powf(1.5))
}

/// Eye at an altitude, and a sun that is white and has an illuminance on the ground when it stands at the zenith.
pub fn article_sky(eye_altitude_m: f32, zenith_illuminance: f32) -> ArticleSky {
    let eye = Vec3::new(0.0, ARTICLE_PLANET_RADIUS_M + eye_altitude_m, 0.0);
    let origin_h = eye.y - ARTICLE_PLANET_RADIUS_M;
    let top_h = ARTICLE_TOP_RADIUS_M - ARTICLE_PLANET_RADIUS_M;
    let column_m =
        |scale_m: f32| scale_m * ((-origin_h / scale_m).exp() - (-top_h / scale_m).exp());
    let rayleigh_m = column_m(ARTICLE_RAYLEIGH_SCALE_M);
    let mie_m = column_m(ARTICLE_MIE_SCALE_M);
    let depth = RAYLEIGH * 1e-6 * rayleigh_m
        + Vec3::splat(21.0) * 1e-6 * mie_m
        + OZONE * 0.06 * 1e-5 * rayleigh_m;
    let sun_radius_rad = (0.53f32 / 2.0).to_radians();
    let sun_solid_angle = 2.0 * ARTICLE_PI * (1.0 - sun_radius_rad.cos());
    ArticleSky {
        eye,
        sun_radius_rad,
        outer_space: Vec3::splat(zenith_illuminance) / sun_solid_angle / (-depth).exp(),
        sun_solid_angle,
    }
}

/// Light that a point scatters along a view ray, per metre.
pub fn article_source(sky: ArticleSky, position: Vec3, view: Vec3, sun: Vec3) -> Vec3 {
    let leaves = position + sun * article_distance_m(position, sun, ARTICLE_TOP_RADIUS_M);
    let to_sun = article_transmittance(position, leaves);
    let mu = view.dot(sun);
    let rayleigh = article_sigma_rayleigh(position) * article_rayleigh_phase(mu);
    let mie = article_sigma_mie(position) * article_mie_phase(mu);
    sky.outer_space * to_sun * sky.sun_solid_angle * (rayleigh + mie)
}

/// Luminance of the sky along a direction above the horizon, without the sun's disc.
pub fn article_luminance(sky: ArticleSky, view: Vec3, sun: Vec3) -> Vec3 {
    let leaves = sky.eye + view * article_distance_m(sky.eye, view, ARTICLE_TOP_RADIUS_M);
    let ds = (leaves - sky.eye) / ARTICLE_STEPS as f32;
    let direction = ds / ds.length();
    let mut sum = Vec3::ZERO;
    for i in 0..ARTICLE_STEPS {
        let s = sky.eye + (i as f32 + 0.5) * ds;
        sum += article_transmittance(sky.eye, s) * article_source(sky, s, direction, sun);
    }
    sum * ds.length()
}

/// Luminance of the sun's disc along a direction above the horizon.
pub fn article_disc(sky: ArticleSky, view: Vec3, sun: Vec3) -> Vec3 {
    let angle = view.dot(sun).min(1.0).acos();
    let [inner, outer] = [0.95, 1.05].map(|edge| edge * sky.sun_radius_rad);
    let t = ((angle - inner) / (outer - inner)).clamp(0.0, 1.0);
    let disc = 1.0 - t * t * (3.0 - 2.0 * t);
    let leaves = sky.eye + view * article_distance_m(sky.eye, view, ARTICLE_TOP_RADIUS_M);
    sky.outer_space * disc * article_transmittance(sky.eye, leaves)
}
