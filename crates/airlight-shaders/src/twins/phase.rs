//! Phase functions by 1 minus the cosine of the scattering angle: `wgsl/phase.wgsl`.

use super::exponentials::mean_transmittance;
use glam::Vec3;

/// 1 / (4 pi).
const ISOTROPIC: f32 = 0.079_577_47;

/// 1 minus the cosine of the angle between two unit vectors.
pub fn one_minus_cos_between(a: Vec3, b: Vec3) -> f32 {
    let apart = a - b;
    0.5 * apart.dot(apart)
}

/// Isotropic scattering.
pub fn isotropic_phase() -> f32 {
    ISOTROPIC
}

/// Rayleigh scattering with a depolarization ratio.
pub fn rayleigh_phase(one_minus_cos: f32, depolarization_ratio: f32) -> f32 {
    let gamma = depolarization_ratio / (2.0 - depolarization_ratio);
    let cos_angle = 1.0 - one_minus_cos;
    0.059_683_103 / (1.0 + 2.0 * gamma)
        * (1.0 + 3.0 * gamma + (1.0 - gamma) * cos_angle * cos_angle)
}

/// Henyey-Greenstein phase function of a forward peak, of mean cosine `1 - one_minus_g`.
pub fn henyey_greenstein_peak(one_minus_cos: f32, one_minus_g: f32) -> f32 {
    let d = one_minus_g * one_minus_g + 2.0 * (1.0 - one_minus_g) * one_minus_cos;
    ISOTROPIC * one_minus_g * (2.0 - one_minus_g) / (d * d.sqrt())
}

/// Henyey-Greenstein phase function.
pub fn henyey_greenstein(one_minus_cos: f32, g: f32) -> f32 {
    let from_peak = if g >= 0.0 {
        one_minus_cos
    } else {
        2.0 - one_minus_cos
    };
    henyey_greenstein_peak(from_peak, 1.0 - g.abs())
}

/// Draine's phase function.
pub fn draine(one_minus_cos: f32, g: f32, alpha: f32) -> f32 {
    let norm = 1.0 + alpha * (1.0 + 2.0 * g * g) / 3.0;
    let cos_angle = 1.0 - one_minus_cos;
    henyey_greenstein(one_minus_cos, g) * (1.0 + alpha * cos_angle * cos_angle) / norm
}

/// Cornette-Shanks phase function.
pub fn cornette_shanks(one_minus_cos: f32, g: f32) -> f32 {
    draine(one_minus_cos, g, 1.0)
}

/// Parameters of the phase function of fog droplets.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct DropletPhase {
    /// 1 minus the mean cosine of the diffraction peak.
    pub peak_one_minus_g: f32,
    /// Parameter `g` of the rest, a Draine function.
    pub wide_g: f32,
    /// Parameter `alpha` of the rest.
    pub wide_alpha: f32,
    /// Weight of the rest; that of the peak is 1 minus it.
    pub wide_weight: f32,
}

/// Fog droplets of a diameter in micrometres.
pub fn droplet_phase(diameter_um: f32) -> DropletPhase {
    let d = diameter_um.clamp(5.0, 50.0);
    let peak = 0.0990567 / (d - 1.67154);
    DropletPhase {
        peak_one_minus_g: peak * mean_transmittance(peak),
        wide_g: (-2.20679 / (d + 3.91029) - 0.428934).exp(),
        wide_alpha: (3.62489 - 8.29288 / (d + 5.52825)).exp(),
        wide_weight: (-0.599085 / (d - 0.641583) - 0.665888).exp(),
    }
}

/// Value of the phase function of fog droplets.
pub fn evaluate_droplet_phase(phase: DropletPhase, one_minus_cos: f32) -> f32 {
    (1.0 - phase.wide_weight) * henyey_greenstein_peak(one_minus_cos, phase.peak_one_minus_g)
        + phase.wide_weight * draine(one_minus_cos, phase.wide_g, phase.wide_alpha)
}
