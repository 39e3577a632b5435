//! Fog with shadows: `wgsl/shadows.wgsl`.

use super::exponentials::mean_transmittance;
use super::fog::{FogLight, FogMedium, exponential_fog, uniform_fog};
use super::path_optics::{PathOptics, near_then_far};
use glam::Vec3;

/// No fog: what a march starts with.
pub fn no_fog() -> PathOptics {
    PathOptics {
        transmittance: Vec3::ONE,
        path_radiance: Vec3::ZERO,
    }
}

/// Distance of a place from 0 to 1 along a segment, m, such that even steps have even shares of the light of uniform fog.
pub fn shadow_edge_m(place: f32, length_m: f32, optical_depth: f32) -> f32 {
    if place >= 1.0 {
        return length_m;
    }
    let mean = place * mean_transmittance(optical_depth);
    let u = mean * optical_depth;
    let series = mean * (1.0 + u * (0.5 + u * (0.333_333_34 + u * (0.25 + u * 0.2))));
    let rest = ((1.0 - place) + place * (-optical_depth).exp()).max(1e-30);
    let direct = -rest.ln() / optical_depth.max(0.05);
    length_m * if u < 0.05 { series } else { direct }.min(1.0)
}

/// Part of a step that is in sunlight, 0 to 1, between heights above the surface of a shadow at its ends.
pub fn lit_part(from_clearance_m: f32, to_clearance_m: f32) -> f32 {
    let least = from_clearance_m.min(to_clearance_m);
    let most = from_clearance_m.max(to_clearance_m);
    match (least >= 0.0, most <= 0.0) {
        (true, _) => 1.0,
        (_, true) => 0.0,
        _ => most / (most - least),
    }
}

/// Light whose sun is visible in part.
pub fn with_visibility(light: FogLight, visibility: f32) -> FogLight {
    FogLight {
        sunlight: light.sunlight * visibility,
        ..light
    }
}

/// A march in uniform fog with one step more.
pub fn shadowed_uniform_fog(
    before: PathOptics,
    medium: FogMedium,
    from_m: f32,
    to_m: f32,
    light: FogLight,
    visibility: f32,
) -> PathOptics {
    let lit = with_visibility(light, visibility);
    near_then_far(before, uniform_fog(medium, to_m - from_m, lit))
}

/// A march in exponential height fog over flat ground with one step more.
#[expect(
    clippy::too_many_arguments,
    reason = "the shape of the shader function"
)]
pub fn shadowed_exponential_fog(
    before: PathOptics,
    medium: FogMedium,
    height_m: f32,
    sin_elevation: f32,
    from_m: f32,
    to_m: f32,
    reference_height_m: f32,
    scale_height_m: f32,
    light: FogLight,
    visibility: f32,
) -> PathOptics {
    let step = exponential_fog(
        medium,
        height_m + sin_elevation * from_m,
        sin_elevation,
        to_m - from_m,
        reference_height_m,
        scale_height_m,
        with_visibility(light, visibility),
    );
    near_then_far(before, step)
}
