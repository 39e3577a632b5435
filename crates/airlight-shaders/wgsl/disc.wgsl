// The sun's disc with limb darkening, at four wavelengths, and the moon's disc with its phase.

/// Limb darkening at four wavelengths: a polynomial in the cosine `mu` between the line of sight and the normal of the sun's
/// surface, 1 at the centre and 0 at the limb. The mean over the disc is 1. A uniform disc has 1 in `zeroth` and 0 elsewhere.
struct LimbDarkening {
    /// Constant term.
    zeroth: vec4<f32>,
    /// Coefficient of `mu`.
    first: vec4<f32>,
    /// Coefficient of `mu^2`.
    second: vec4<f32>,
    /// Coefficient of `mu^3`.
    third: vec4<f32>,
    /// Coefficient of `mu^4`.
    fourth: vec4<f32>,
    /// Coefficient of `mu^5`.
    fifth: vec4<f32>,
}

/// Limb darkening at wavelengths from 423 to 1099 nm, to which others are clamped (Neckel, Sol. Phys. 229, 13, 2005, table 2).
/// Compute it once for all pixels.
///
/// Cost: no exp. Error: 6e-6 relative plus 4e-6 absolute.
fn limb_darkening(wavelengths_nm: vec4<f32>) -> LimbDarkening {
    let per_um = 1000.0 / clamp(wavelengths_nm, vec4<f32>(422.57), vec4<f32>(1099.0));
    let power = per_um * per_um * per_um * per_um * per_um;
    let zeroth = 0.75267 - 0.265577 * per_um;
    let first = 0.93874 + 0.265577 * per_um - 0.004095 * power;
    let second = -1.89287 + 0.012582 * power;
    let third = 2.42234 - 0.017117 * power;
    let fourth = -1.7115 + 0.011977 * power;
    let fifth = 0.49062 - 0.003347 * power;
    let mean = zeroth + first * 0.6666666667 + second * 0.5 + third * 0.4 + fourth * 0.3333333333 + fifth * 0.2857142857;
    return LimbDarkening(zeroth / mean, first / mean, second / mean, third / mean, fourth / mean, fifth / mean);
}

/// Radiance of the disc at `mu`, relative to its mean.
///
/// Cost: no exp. Error: 5e-7 relative plus 2e-7 absolute.
fn limb_profile(limb: LimbDarkening, mu: f32) -> vec4<f32> {
    return limb.zeroth + mu * (limb.first + mu * (limb.second + mu * (limb.third + mu * (limb.fourth + mu * limb.fifth))));
}

/// Place of a direction on the disc: the sine of its angle from the centre divided by the sine of the disc's angular radius, 0 to
/// 1; more than 1 outside. `one_minus_cos` is that between the direction and the sun.
///
/// Cost: no exp. Error: 3e-7 relative.
fn place_on_disc(sin_radius: f32, one_minus_cos: f32) -> f32 {
    return select(2.0, sqrt(max(one_minus_cos * (2.0 - one_minus_cos), 0.0)), one_minus_cos < 1.0) / sin_radius;
}

/// Part of a pixel that the disc covers, 0 to 1: a ramp as wide as a pixel across the edge, so that the edge is smooth and the
/// disc's light is kept, within `(pixel / radius)^2 / 12`. `sin_pixel` is the sine of the angle that a pixel spans; 0 gives a sharp
/// edge.
///
/// Cost: no exp. Error: 1e-6 relative plus 1e-6 absolute.
fn disc_coverage(place: f32, sin_radius: f32, sin_pixel: f32) -> f32 {
    return clamp((1.0 - place) * (sin_radius / max(sin_pixel, 1e-6 * sin_radius)) + 0.5, 0.0, 1.0);
}

/// Radiance of the sun's disc in a pixel whose centre is `one_minus_cos` from the sun, from the disc's mean radiance: the
/// irradiance on a surface that faces the sun, divided by `pi sin_radius^2`. Without attenuation by air.
///
/// Cost: no exp. Error: 2e-6 relative plus 2e-5 absolute.
fn sun_disc_radiance(
    limb: LimbDarkening,
    mean_radiance: vec4<f32>,
    sin_radius: f32,
    sin_pixel: f32,
    one_minus_cos: f32,
) -> vec4<f32> {
    let place = place_on_disc(sin_radius, one_minus_cos);
    let mu = sqrt(max((1.0 - place) * (1.0 + place), 0.0));
    return mean_radiance * limb_profile(limb, mu) * disc_coverage(place, sin_radius, sin_pixel);
}

/// Reflection of sunlight at a place on the moon's disc, from unit vectors to the moon, from the moon to the sun and along the view:
/// the law of Lommel and Seeliger, `mu_0 / (mu_0 + mu)` with the cosines of incidence and emission; 1/2 where they are equal, 0
/// outside the disc and on the night side.
///
/// Cost: no exp. Error: 2e-6 relative plus 2e-5 absolute.
fn moon_reflection(moon: vec3<f32>, to_sun: vec3<f32>, sin_radius: f32, direction: vec3<f32>) -> f32 {
    // Not from the cosine of the angle, which f32 cannot resolve across the disc.
    let apart = direction - moon;
    let aside = (apart - moon * dot(apart, moon)) / sin_radius;
    let emission = sqrt(max(1.0 - dot(aside, aside), 0.0));
    let incidence = dot(aside, to_sun) - emission * dot(moon, to_sun);
    if emission <= 0.0 || incidence <= 0.0 || dot(direction, moon) <= 0.0 {
        return 0.0;
    }
    return incidence / (incidence + emission);
}
