//! The discs of sun and moon: `wgsl/disc.wgsl`.

use glam::{Vec3, Vec4};

/// Limb darkening at four wavelengths: a polynomial in the cosine `mu` whose mean over the disc is 1.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct LimbDarkening {
    /// Constant term.
    pub zeroth: Vec4,
    /// Coefficient of `mu`.
    pub first: Vec4,
    /// Coefficient of `mu^2`.
    pub second: Vec4,
    /// Coefficient of `mu^3`.
    pub third: Vec4,
    /// Coefficient of `mu^4`.
    pub fourth: Vec4,
    /// Coefficient of `mu^5`.
    pub fifth: Vec4,
}

/// Limb darkening at wavelengths from 423 to 1099 nm.
pub fn limb_darkening(wavelengths_nm: Vec4) -> LimbDarkening {
    let per_um = 1000.0 / wavelengths_nm.clamp(Vec4::splat(422.57), Vec4::splat(1099.0));
    let power = per_um * per_um * per_um * per_um * per_um;
    let zeroth = 0.75267 - 0.265577 * per_um;
    let first = 0.93874 + 0.265577 * per_um - 0.004095 * power;
    let second = -1.89287 + 0.012582 * power;
    let third = 2.42234 - 0.017117 * power;
    let fourth = -1.7115 + 0.011977 * power;
    let fifth = 0.49062 - 0.003347 * power;
    let odd = first * 0.666_666_7 + third * 0.4 + fifth * 0.285_714_3;
    let mean = zeroth + second * 0.5 + fourth * 0.333_333_34 + odd;
    LimbDarkening {
        zeroth: zeroth / mean,
        first: first / mean,
        second: second / mean,
        third: third / mean,
        fourth: fourth / mean,
        fifth: fifth / mean,
    }
}

/// Radiance of the disc at `mu`, relative to its mean.
pub fn limb_profile(limb: LimbDarkening, mu: f32) -> Vec4 {
    limb.zeroth
        + mu * (limb.first
            + mu * (limb.second + mu * (limb.third + mu * (limb.fourth + mu * limb.fifth))))
}

/// Place of a direction on the disc, 0 to 1; more outside.
pub fn place_on_disc(sin_radius: f32, one_minus_cos: f32) -> f32 {
    let sine = match one_minus_cos < 1.0 {
        true => (one_minus_cos * (2.0 - one_minus_cos)).max(0.0).sqrt(),
        false => 2.0,
    };
    sine / sin_radius
}

/// Part of a pixel that the disc covers, 0 to 1.
pub fn disc_coverage(place: f32, sin_radius: f32, sin_pixel: f32) -> f32 {
    ((1.0 - place) * (sin_radius / sin_pixel.max(1e-6 * sin_radius)) + 0.5).clamp(0.0, 1.0)
}

/// Radiance of the sun's disc in a pixel, from the disc's mean radiance.
pub fn sun_disc_radiance(
    limb: LimbDarkening,
    mean_radiance: Vec4,
    sin_radius: f32,
    sin_pixel: f32,
    one_minus_cos: f32,
) -> Vec4 {
    let place = place_on_disc(sin_radius, one_minus_cos);
    let mu = ((1.0 - place) * (1.0 + place)).max(0.0).sqrt();
    mean_radiance * limb_profile(limb, mu) * disc_coverage(place, sin_radius, sin_pixel)
}

/// Reflection of sunlight at a place on the moon's disc, by the law of Lommel and Seeliger.
pub fn moon_reflection(moon: Vec3, to_sun: Vec3, sin_radius: f32, direction: Vec3) -> f32 {
    let apart = direction - moon;
    let aside = (apart - moon * apart.dot(moon)) / sin_radius;
    let emission = (1.0 - aside.length_squared()).max(0.0).sqrt();
    let incidence = aside.dot(to_sun) - emission * moon.dot(to_sun);
    match emission > 0.0 && incidence > 0.0 && direction.dot(moon) > 0.0 {
        true => incidence / (incidence + emission),
        false => 0.0,
    }
}
