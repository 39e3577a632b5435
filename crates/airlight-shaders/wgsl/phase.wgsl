// requires: exponentials
// Phase functions, 1/sr, with integral 1 over the sphere. All take 1 minus the cosine of the scattering angle (0: forward): a
// cosine in f32 cannot resolve the forward peak of fog droplets, where it is rounded by up to 3 % of the peak's width.

/// 1 minus the cosine of the angle between two unit vectors, without cancellation for small angles: half the square of their
/// distance. The scattering angle of light from the sun is the angle between the view ray and the direction to the sun.
///
/// Cost: no exp. Error: 3e-7 relative plus 3e-7 absolute.
fn one_minus_cos_between(a: vec3<f32>, b: vec3<f32>) -> f32 {
    let apart = a - b;
    return 0.5 * dot(apart, apart);
}

/// Isotropic scattering.
///
/// Cost: no exp. Error: 1e-7 relative.
fn isotropic_phase() -> f32 {
    return 0.07957747154594767;
}

/// Rayleigh scattering by molecules with a depolarization ratio for natural light in [0, 6/7), 0.028 for air (Bucholtz, Appl.
/// Opt. 34, 2765, 1995, eqs. 10 and 12).
///
/// Cost: no exp. Error: 1e-6 relative.
fn rayleigh_phase(one_minus_cos: f32, depolarization_ratio: f32) -> f32 {
    let gamma = depolarization_ratio / (2.0 - depolarization_ratio);
    let cos_angle = 1.0 - one_minus_cos;
    return 0.05968310365946075 / (1.0 + 2.0 * gamma) * (1.0 + 3.0 * gamma + (1.0 - gamma) * cos_angle * cos_angle);
}

/// Henyey-Greenstein phase function of a forward peak, of mean cosine `1 - one_minus_g`: `one_minus_g` from 1e-6 to 1, which
/// keeps the width of narrow peaks.
///
/// Cost: no exp. Error: 1.5e-6 relative.
fn henyey_greenstein_peak(one_minus_cos: f32, one_minus_g: f32) -> f32 {
    let d = one_minus_g * one_minus_g + 2.0 * (1.0 - one_minus_g) * one_minus_cos;
    return 0.07957747154594767 * one_minus_g * (2.0 - one_minus_g) / (d * sqrt(d));
}

/// Henyey & Greenstein (1941): mean cosine `g`, -1 < g < 1.
///
/// Cost: no exp. Error: 1.5e-6 relative.
fn henyey_greenstein(one_minus_cos: f32, g: f32) -> f32 {
    return henyey_greenstein_peak(select(2.0 - one_minus_cos, one_minus_cos, g >= 0.0), 1.0 - abs(g));
}

/// Draine (Astrophys. J. 598, 1017, 2003, eq. 6): Henyey-Greenstein times `1 + alpha cos^2`, normalised; `alpha` not negative.
///
/// Cost: no exp. Error: 1.5e-6 relative.
fn draine(one_minus_cos: f32, g: f32, alpha: f32) -> f32 {
    let norm = 1.0 + alpha * (1.0 + 2.0 * g * g) / 3.0;
    let cos_angle = 1.0 - one_minus_cos;
    return henyey_greenstein(one_minus_cos, g) * (1.0 + alpha * cos_angle * cos_angle) / norm;
}

/// Cornette & Shanks (Appl. Opt. 31, 3152, 1992, eq. 8): Henyey-Greenstein times `1 + cos^2`, normalised.
///
/// Cost: no exp. Error: 1.5e-6 relative.
fn cornette_shanks(one_minus_cos: f32, g: f32) -> f32 {
    return draine(one_minus_cos, g, 1.0);
}

/// Parameters of the phase function of fog droplets.
struct DropletPhase {
    /// 1 minus the mean cosine of the diffraction peak.
    peak_one_minus_g: f32,
    /// Parameter `g` of the rest, a Draine function.
    wide_g: f32,
    /// Parameter `alpha` of the rest.
    wide_alpha: f32,
    /// Weight of the rest; that of the peak is 1 minus it.
    wide_weight: f32,
}

/// Fog droplets of a diameter of 5 to 50 micrometres, to which other diameters are clamped (Jendersie & d'Eon, "An approximate
/// Mie scattering function for fog and cloud rendering", SIGGRAPH 2023 Talks, eqs. 4-7). Compute it once for all pixels.
///
/// Cost: 4 exp. Error: 1e-6 relative.
fn droplet_phase(diameter_um: f32) -> DropletPhase {
    let d = clamp(diameter_um, 5.0, 50.0);
    let peak = 0.0990567 / (d - 1.67154);
    return DropletPhase(
        peak * mean_transmittance(peak),
        exp(-2.20679 / (d + 3.91029) - 0.428934),
        exp(3.62489 - 8.29288 / (d + 5.52825)),
        exp(-0.599085 / (d - 0.641583) - 0.665888),
    );
}

/// Value of the phase function of fog droplets.
///
/// Cost: no exp. Error: 1.5e-6 relative.
fn evaluate_droplet_phase(phase: DropletPhase, one_minus_cos: f32) -> f32 {
    return (1.0 - phase.wide_weight) * henyey_greenstein_peak(one_minus_cos, phase.peak_one_minus_g)
        + phase.wide_weight * draine(one_minus_cos, phase.wide_g, phase.wide_alpha);
}
