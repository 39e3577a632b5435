// requires: exponentials, columns, path_optics, fog
// Fog with shadows (god rays): a march in which the program supplies the visibility of the sun, as from its shadow map. WGSL and
// its translations have no function pointers, so the loop is the program's:
//
//     var path = no_fog();
//     for (var i = 0u; i < steps; i++) {
//         let from_m = shadow_edge_m(f32(i) / f32(steps), length_m, optical_depth);
//         let to_m = shadow_edge_m(f32(i + 1u) / f32(steps), length_m, optical_depth);
//         let visible = YOUR_SHADOW_MAP(eye + direction * mix(from_m, to_m, noise));
//         path = shadowed_uniform_fog(path, medium, from_m, to_m, light, visible);
//     }
//
// Light and attenuation of a step are in closed form: where all is visible the result is that without a march, for any number of
// steps. Each edge of a shadow adds an error of at most a step's light.

/// No fog: what a march starts with.
///
/// Cost: no exp. Error: 1e-7 relative.
fn no_fog() -> PathOptics {
    return PathOptics(vec3<f32>(1.0), vec3<f32>(0.0));
}

/// Distance of a place from 0 to 1 along a segment, m, such that steps that are even in `place` have even shares of the light of
/// uniform fog of this optical depth along the segment: short near the eye.
///
/// Cost: 3 exp. Error: 4e-6 relative.
fn shadow_edge_m(place: f32, length_m: f32, optical_depth: f32) -> f32 {
    if place >= 1.0 {
        return length_m;
    }
    let mean = place * mean_transmittance(optical_depth);
    // Opacity up to the place.
    let u = mean * optical_depth;
    let series = mean * (1.0 + u * (0.5 + u * (0.3333333333 + u * (0.25 + u * 0.2))));
    let direct = -log(max((1.0 - place) + place * exp(-optical_depth), 1e-30)) / max(optical_depth, 0.05);
    return length_m * min(select(direct, series, u < 0.05), 1.0);
}

/// Part of a step that is in sunlight, 0 to 1, between heights above the surface of a shadow (or distances before a shadow caster) at its
/// ends, negative in shadow and linear between: the edge of a shadow is found inside a step.
///
/// Cost: no exp. Error: 4e-7 relative.
fn lit_part(from_clearance_m: f32, to_clearance_m: f32) -> f32 {
    let least = min(from_clearance_m, to_clearance_m);
    let most = max(from_clearance_m, to_clearance_m);
    if least >= 0.0 {
        return 1.0;
    }
    if most <= 0.0 {
        return 0.0;
    }
    return most / (most - least);
}

/// Light whose sun is visible in part, 0 to 1.
///
/// Cost: no exp. Error: 2e-7 relative.
fn with_visibility(light: FogLight, visibility: f32) -> FogLight {
    return FogLight(light.sunlight * visibility, light.sin_sun, light.ambient);
}

/// A march in uniform fog with one step more, from which the sun is visible in part.
///
/// Cost: 6 exp. Error: 2e-6 relative plus 1e-6 absolute.
fn shadowed_uniform_fog(
    before: PathOptics,
    medium: FogMedium,
    from_m: f32,
    to_m: f32,
    light: FogLight,
    visibility: f32,
) -> PathOptics {
    return near_then_far(before, uniform_fog(medium, to_m - from_m, with_visibility(light, visibility)));
}

/// A march in exponential height fog over flat ground with one step more, from which the sun is visible in part. The fog above the
/// ray attenuates sunlight.
///
/// Cost: 16 exp. Error: 1e-5 relative plus 3e-6 absolute.
fn shadowed_exponential_fog(
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
    return near_then_far(before, step);
}
