// requires: exponentials, columns, path_optics
// Fog in sunlight and ambient light: single scattering in closed form, in red, green and blue.

/// Coefficients of fog at density 1.
struct FogMedium {
    /// Extinction, 1/m.
    extinction_per_m: vec3<f32>,
    /// Scattering, 1/m, at most the extinction.
    scattering_per_m: vec3<f32>,
}

/// Light in a fog.
struct FogLight {
    /// Irradiance of the sun above the fog on a surface that faces it, times the phase function at the scattering angle.
    sunlight: vec3<f32>,
    /// Sine of the sun's elevation.
    sin_sun: f32,
    /// Radiance that arrives uniformly from all directions, such as the mean of the sky.
    ambient: vec3<f32>,
}

/// Fog of any profile along a column (m), with sunlight that the fog does not attenuate on its way to the ray: Ishiyama 2018 as
/// printed, eqs. 22 and 23. Correct in thin fog; in dense fog up to three times as bright as all orders of scattering.
///
/// Cost: 6 exp. Error: 1e-6 relative plus 4e-7 absolute.
fn fog_undimmed(medium: FogMedium, column_m: f32, light: FogLight) -> PathOptics {
    let depth = medium.extinction_per_m * column_m;
    // Per metre of column, as the extinction may be 0.
    let opacity = mean_transmittance_rgb(depth) * column_m;
    return PathOptics(exp(-depth), medium.scattering_per_m * (light.sunlight + light.ambient) * opacity);
}

/// Fog of one profile over flat ground, with sunlight attenuated by the fog above the ray: exact for single scattering. The
/// columns (m) are those of the ray, and those from its start and its end to the sun (the column above divided by `sin_sun`).
///
/// Cost: 12 exp. Error: 1e-6 relative plus 4e-7 absolute.
fn fog_single_scattering(medium: FogMedium, column_m: f32, to_sun_near_m: f32, to_sun_far_m: f32, light: FogLight) -> PathOptics {
    let depth = medium.extinction_per_m * column_m;
    let near = medium.extinction_per_m * to_sun_near_m;
    let far = medium.extinction_per_m * (to_sun_far_m + column_m);
    let sunlit = light.sunlight * mean_attenuated_source_rgb(near, far);
    let ambient = light.ambient * mean_transmittance_rgb(depth);
    return PathOptics(exp(-depth), medium.scattering_per_m * ((sunlit + ambient) * column_m));
}

/// Uniform fog over a distance (m). It has no upper end, so sunlight is not attenuated.
///
/// Cost: 6 exp. Error: 1e-6 relative plus 4e-7 absolute.
fn uniform_fog(medium: FogMedium, length_m: f32, light: FogLight) -> PathOptics {
    return fog_undimmed(medium, length_m, light);
}

/// Column between a height and the sun over flat ground, m, from the column above that height; `OPAQUE` if the sun is down.
///
/// Cost: no exp. Error: 3e-7 relative.
fn column_to_sun_m(column_above_m: f32, sin_sun: f32) -> f32 {
    return select(OPAQUE, min(min(column_above_m, OPAQUE) / max(sin_sun, 1e-12), OPAQUE), sin_sun > 0.0);
}

/// Exponential height fog over flat ground, with unattenuated sunlight: Ishiyama 2018 as printed, without its 0/0 on level rays.
///
/// Cost: 8 exp. Error: 3e-6 relative plus 4e-7 absolute.
fn exponential_fog_undimmed(medium: FogMedium, height_m: f32, sin_elevation: f32, length_m: f32, reference_height_m: f32,
    scale_height_m: f32, light: FogLight) -> PathOptics {
    let column_m = flat_exponential_column_m(height_m, sin_elevation, length_m, reference_height_m, scale_height_m);
    return fog_undimmed(medium, column_m, light);
}

/// Exponential height fog over flat ground, with sunlight that the fog above attenuates.
///
/// Cost: 16 exp. Error: 3e-6 relative plus 4e-7 absolute.
fn exponential_fog(medium: FogMedium, height_m: f32, sin_elevation: f32, length_m: f32, reference_height_m: f32,
    scale_height_m: f32, light: FogLight) -> PathOptics {
    let column_m = flat_exponential_column_m(height_m, sin_elevation, length_m, reference_height_m, scale_height_m);
    let end_height_m = height_m + sin_elevation * length_m;
    let near = exponential_column_above_m(height_m, reference_height_m, scale_height_m);
    let far = exponential_column_above_m(end_height_m, reference_height_m, scale_height_m);
    return fog_single_scattering(medium, column_m, column_to_sun_m(near, light.sin_sun), column_to_sun_m(far, light.sin_sun), light);
}

/// Fog that is uniform up to the base and thins exponentially above it (after Wenzel), over flat ground, with sunlight that the
/// fog above attenuates.
///
/// Cost: 16 exp. Error: 3e-6 relative plus 4e-7 absolute.
fn clamped_fog(medium: FogMedium, height_m: f32, sin_elevation: f32, length_m: f32, base_height_m: f32, scale_height_m: f32,
    light: FogLight) -> PathOptics {
    let column_m = flat_clamped_column_m(height_m, sin_elevation, length_m, base_height_m, scale_height_m);
    let end_height_m = height_m + sin_elevation * length_m;
    let near = clamped_column_above_m(height_m, base_height_m, scale_height_m);
    let far = clamped_column_above_m(end_height_m, base_height_m, scale_height_m);
    return fog_single_scattering(medium, column_m, column_to_sun_m(near, light.sin_sun), column_to_sun_m(far, light.sin_sun), light);
}

/// Profile of a `FogLayer`: density 1 everywhere.
const FOG_UNIFORM: u32 = 0u;
/// Profile of a `FogLayer`: `e^-((height - height_m) / scale_m)`.
const FOG_EXPONENTIAL: u32 = 1u;
/// Profile of a `FogLayer`: 1 up to `height_m`, `e^-((height - height_m) / scale_m)` above.
const FOG_CLAMPED: u32 = 2u;
/// Profile of a `FogLayer`: 1 from `height_m` to `height_m + scale_m`, 0 elsewhere.
const FOG_SLAB: u32 = 3u;

/// One of several layers of fog.
struct FogLayer {
    /// Extinction at density 1, 1/m.
    extinction_per_m: vec3<f32>,
    /// `FOG_UNIFORM`, `FOG_EXPONENTIAL`, `FOG_CLAMPED` or `FOG_SLAB`.
    profile: u32,
    /// Scattering at density 1, 1/m.
    scattering_per_m: vec3<f32>,
    /// Reference height, base or bottom, m.
    height_m: f32,
    /// Phase function at the scattering angle of sunlight, 1/sr.
    phase: vec3<f32>,
    /// Scale height or thickness, m, above 0.
    scale_m: f32,
}

/// Up to four layers of fog over one ground, and its light. `light.sunlight` is the irradiance alone, as each layer has its
/// phase function.
struct FogLayers {
    /// The layers, of which the first `count` are used.
    layers: array<FogLayer, 4>,
    /// Number of layers, 0 to 4.
    count: u32,
    /// Height of the ground, m.
    ground_height_m: f32,
    /// 1 / R of the ground, 1/m, 0 for flat ground.
    inverse_radius_per_m: f32,
    /// The light.
    light: FogLight,
}

/// Column of a layer along a ray, m.
///
/// Cost: 18 exp; over flat ground 2. Error: 1.5e-5 relative plus 1e-2 absolute.
fn fog_layer_column_m(layer: FogLayer, ray: RaySegment) -> f32 {
    switch layer.profile {
        case 1u: {
            return exponential_column_m(ray, layer.height_m, layer.scale_m);
        }
        case 2u: {
            return clamped_column_m(ray, layer.height_m, layer.scale_m);
        }
        case 3u: {
            return layer_column_m(ray, layer.height_m, layer.height_m + layer.scale_m);
        }
        default: {
            return ray.length_m;
        }
    }
}

/// Optical depth of all layers along a ray, exact over flat and round ground.
///
/// Cost: 18 exp a step. Error: 2e-5 relative plus 1e-6 absolute.
fn fog_optical_depth(fog: FogLayers, ray: RaySegment) -> vec3<f32> {
    var depth = vec3<f32>(0.0);
    for (var i = 0u; i < min(fog.count, 4u); i += 1u) {
        let layer = fog.layers[i];
        depth += layer.extinction_per_m * fog_layer_column_m(layer, ray);
    }
    return depth;
}

/// Optical depth of all layers between a height and the sun. Uniform layers are ignored, as they would block all light;
/// `OPAQUE` where the ground hides the sun.
///
/// Cost: 18 exp a step. Error: 2e-5 relative plus 1e-6 absolute.
fn fog_depth_to_sun(fog: FogLayers, height_m: f32) -> vec3<f32> {
    let ray = ray_segment(height_m, fog.light.sin_sun, INFINITE_M, fog.inverse_radius_per_m);
    let dips = ray.curvature_per_m > 0.0 && ray.sin_elevation < 0.0;
    let lowest_m = height_m - 0.25 * ray.sin_elevation * ray.sin_elevation / max(ray.curvature_per_m, 1e-30);
    if (ray.curvature_per_m <= 0.0 && ray.sin_elevation <= 0.0) || (dips && lowest_m < fog.ground_height_m) {
        return vec3<f32>(OPAQUE);
    }
    var depth = vec3<f32>(0.0);
    for (var i = 0u; i < min(fog.count, 4u); i += 1u) {
        let layer = fog.layers[i];
        if layer.profile != FOG_UNIFORM {
            depth += layer.extinction_per_m * fog_layer_column_m(layer, ray);
        }
    }
    return depth;
}

/// The nearest height above (`rising`) or below a level at which `layered_fog` splits a ray because of a layer; 1e30 times the
/// direction if there is none. Exponential decays have steps that are dense where most of the fog is.
///
/// Cost: no exp. Error: 2e-6 relative plus 1e-3 absolute.
fn next_fog_break_m(layer: FogLayer, level_m: f32, rising: bool, ground_height_m: f32) -> f32 {
    var steps = array<f32, 14>(0.0, 0.12, 0.25, 0.4, 0.57, 0.77, 1.0, 1.3, 1.65, 2.1, 2.7, 3.5, 5.0, 8.0);
    var from_m = layer.height_m;
    var count = 14;
    if layer.profile == FOG_UNIFORM {
        count = 0;
    } else if layer.profile == FOG_SLAB {
        steps[1] = 1.0;
        count = 2;
    } else if layer.profile == FOG_EXPONENTIAL {
        from_m = ground_height_m;
    } else {
        from_m = max(layer.height_m, ground_height_m);
    }
    var nearest = select(-1e30, 1e30, rising);
    for (var i = 0; i < count; i += 1) {
        let height = from_m + steps[i] * layer.scale_m;
        if rising {
            nearest = select(nearest, height, height > level_m && height < nearest);
        } else {
            nearest = select(nearest, height, height < level_m && height > nearest);
        }
    }
    return nearest;
}

/// Several layers of fog, over flat or round ground. The ray is split at heights, and between them all layers count as one:
/// single scattering of sunlight and ambient light within 0.2 % of exact over flat ground, 1 % over round ground.
///
/// Cost: 3 exp, 84 exp a step; over flat ground 9 a step and 4 a layer. Error: 3e-5 relative plus 3e-6 absolute.
fn layered_fog(fog: FogLayers, ray: RaySegment) -> PathOptics {
    let count = min(fog.count, 4u);
    var before = vec3<f32>(0.0);
    var radiance = vec3<f32>(0.0);
    var at_m = 0.0;
    var level_m = ray.height_m;
    var to_sun = fog_depth_to_sun(fog, level_m);
    let dip_m = select(0.0, -0.5 * ray.sin_elevation / max(ray.curvature_per_m, 1e-30), ray.curvature_per_m > 0.0);
    var rising = ray.sin_elevation > 0.0 || (ray.sin_elevation == 0.0 && ray.curvature_per_m > 0.0);
    for (var step = 0; step < 124; step += 1) {
        if at_m >= ray.length_m {
            break;
        }
        var next_level_m = select(-1e30, 1e30, rising);
        for (var i = 0u; i < count; i += 1u) {
            let height = next_fog_break_m(fog.layers[i], level_m, rising, fog.ground_height_m);
            next_level_m = select(max(next_level_m, height), min(next_level_m, height), rising);
        }
        var end_m = ray.length_m;
        if abs(next_level_m) < 1e30 {
            let below = below_height(ray, next_level_m);
            if below.y > below.x {
                end_m = select(below.x, below.y, rising);
            } else if rising {
                // A break that rounding puts below the lowest point.
                end_m = at_m;
            }
        }
        let turns = !rising && dip_m > at_m && dip_m < end_m;
        if turns {
            end_m = dip_m;
        }
        if end_m > at_m {
            let part = ray_part(ray, at_m, end_m);
            var along = vec3<f32>(0.0);
            var sunlit = vec3<f32>(0.0);
            var scattered = vec3<f32>(0.0);
            for (var i = 0u; i < count; i += 1u) {
                let layer = fog.layers[i];
                let column_m = fog_layer_column_m(layer, part);
                along += layer.extinction_per_m * column_m;
                sunlit += layer.scattering_per_m * layer.phase * column_m;
                scattered += layer.scattering_per_m * column_m;
            }
            let far_to_sun = fog_depth_to_sun(fog, height_at(ray, end_m));
            let arriving = fog.light.sunlight * sunlit * mean_attenuated_source_rgb(to_sun, far_to_sun + along)
                + fog.light.ambient * scattered * mean_transmittance_rgb(along);
            radiance += exp(-before) * arriving;
            before += along;
            to_sun = far_to_sun;
        }
        at_m = max(at_m, end_m);
        level_m = select(next_level_m, height_at(ray, end_m), turns);
        rising = rising || turns;
        if min(before.x, min(before.y, before.z)) > 40.0 {
            break;
        }
    }
    return PathOptics(exp(-fog_optical_depth(fog, ray)), radiance);
}
