//! Fog in sunlight and ambient light, single scattering in closed form: `wgsl/fog.wgsl`.

use super::columns::{
    INFINITE_M, RaySegment, below_height, clamped_column_above_m, clamped_column_m,
    exponential_column_above_m, exponential_column_m, flat_clamped_column_m,
    flat_exponential_column_m, height_at, layer_column_m, ray_part, ray_segment,
};
use super::exponentials::{OPAQUE, mean_attenuated_source_rgb, mean_transmittance_rgb};
use super::path_optics::PathOptics;
use glam::Vec3;

/// Coefficients of fog at density 1.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct FogMedium {
    /// Extinction, 1/m.
    pub extinction_per_m: Vec3,
    /// Scattering, 1/m, at most the extinction.
    pub scattering_per_m: Vec3,
}

/// Light in a fog.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct FogLight {
    /// Irradiance of the sun above the fog on a surface that faces it, times the phase function at the scattering angle.
    pub sunlight: Vec3,
    /// Sine of the sun's elevation.
    pub sin_sun: f32,
    /// Radiance that arrives uniformly from all directions.
    pub ambient: Vec3,
}

/// Fog of any profile along a column (m), with unattenuated sunlight.
pub fn fog_undimmed(medium: FogMedium, column_m: f32, light: FogLight) -> PathOptics {
    let depth = medium.extinction_per_m * column_m;
    let opacity = mean_transmittance_rgb(depth) * column_m;
    PathOptics {
        transmittance: (-depth).exp(),
        path_radiance: medium.scattering_per_m * (light.sunlight + light.ambient) * opacity,
    }
}

/// Fog of one profile over flat ground, with sunlight attenuated by the fog above the ray.
pub fn fog_single_scattering(
    medium: FogMedium,
    column_m: f32,
    to_sun_near_m: f32,
    to_sun_far_m: f32,
    light: FogLight,
) -> PathOptics {
    let depth = medium.extinction_per_m * column_m;
    let near = medium.extinction_per_m * to_sun_near_m;
    let far = medium.extinction_per_m * (to_sun_far_m + column_m);
    let sunlit = light.sunlight * mean_attenuated_source_rgb(near, far);
    let ambient = light.ambient * mean_transmittance_rgb(depth);
    PathOptics {
        transmittance: (-depth).exp(),
        path_radiance: medium.scattering_per_m * ((sunlit + ambient) * column_m),
    }
}

/// Uniform fog over a distance (m).
pub fn uniform_fog(medium: FogMedium, length_m: f32, light: FogLight) -> PathOptics {
    fog_undimmed(medium, length_m, light)
}

/// Column between a height and the sun over flat ground, m, from the column above that height.
pub fn column_to_sun_m(column_above_m: f32, sin_sun: f32) -> f32 {
    if sin_sun > 0.0 {
        (column_above_m.min(OPAQUE) / sin_sun.max(1e-12)).min(OPAQUE)
    } else {
        OPAQUE
    }
}

/// Exponential height fog over flat ground, with unattenuated sunlight.
pub fn exponential_fog_undimmed(
    medium: FogMedium,
    height_m: f32,
    sin_elevation: f32,
    length_m: f32,
    reference_height_m: f32,
    scale_height_m: f32,
    light: FogLight,
) -> PathOptics {
    let column_m = flat_exponential_column_m(
        height_m,
        sin_elevation,
        length_m,
        reference_height_m,
        scale_height_m,
    );
    fog_undimmed(medium, column_m, light)
}

/// Exponential height fog over flat ground, with sunlight that the fog above attenuates.
pub fn exponential_fog(
    medium: FogMedium,
    height_m: f32,
    sin_elevation: f32,
    length_m: f32,
    reference_height_m: f32,
    scale_height_m: f32,
    light: FogLight,
) -> PathOptics {
    let column_m = flat_exponential_column_m(
        height_m,
        sin_elevation,
        length_m,
        reference_height_m,
        scale_height_m,
    );
    let end_height_m = height_m + sin_elevation * length_m;
    let near = exponential_column_above_m(height_m, reference_height_m, scale_height_m);
    let far = exponential_column_above_m(end_height_m, reference_height_m, scale_height_m);
    fog_single_scattering(
        medium,
        column_m,
        column_to_sun_m(near, light.sin_sun),
        column_to_sun_m(far, light.sin_sun),
        light,
    )
}

/// Fog that is uniform up to the base and thins exponentially above it, over flat ground.
pub fn clamped_fog(
    medium: FogMedium,
    height_m: f32,
    sin_elevation: f32,
    length_m: f32,
    base_height_m: f32,
    scale_height_m: f32,
    light: FogLight,
) -> PathOptics {
    let column_m = flat_clamped_column_m(
        height_m,
        sin_elevation,
        length_m,
        base_height_m,
        scale_height_m,
    );
    let end_height_m = height_m + sin_elevation * length_m;
    let near = clamped_column_above_m(height_m, base_height_m, scale_height_m);
    let far = clamped_column_above_m(end_height_m, base_height_m, scale_height_m);
    fog_single_scattering(
        medium,
        column_m,
        column_to_sun_m(near, light.sin_sun),
        column_to_sun_m(far, light.sin_sun),
        light,
    )
}

/// Profile of a [`FogLayer`]: density 1 everywhere.
pub const FOG_UNIFORM: u32 = 0;
/// Profile of a [`FogLayer`]: `e^-((height - height_m) / scale_m)`.
pub const FOG_EXPONENTIAL: u32 = 1;
/// Profile of a [`FogLayer`]: 1 up to `height_m`, `e^-((height - height_m) / scale_m)` above.
pub const FOG_CLAMPED: u32 = 2;
/// Profile of a [`FogLayer`]: 1 from `height_m` to `height_m + scale_m`, 0 elsewhere.
pub const FOG_SLAB: u32 = 3;

/// One of several layers of fog.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct FogLayer {
    /// Extinction at density 1, 1/m.
    pub extinction_per_m: Vec3,
    /// [`FOG_UNIFORM`], [`FOG_EXPONENTIAL`], [`FOG_CLAMPED`] or [`FOG_SLAB`].
    pub profile: u32,
    /// Scattering at density 1, 1/m.
    pub scattering_per_m: Vec3,
    /// Reference height, base or bottom, m.
    pub height_m: f32,
    /// Phase function at the scattering angle of sunlight, 1/sr.
    pub phase: Vec3,
    /// Scale height or thickness, m, above 0.
    pub scale_m: f32,
}

/// Up to four layers of fog over one ground, and its light; `light.sunlight` is the irradiance alone.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct FogLayers {
    /// The layers, of which the first `count` are used.
    pub layers: [FogLayer; 4],
    /// Number of layers, 0 to 4.
    pub count: u32,
    /// Height of the ground, m.
    pub ground_height_m: f32,
    /// 1 / R of the ground, 1/m, 0 for flat ground.
    pub inverse_radius_per_m: f32,
    /// The light.
    pub light: FogLight,
}

/// Column of a layer along a ray, m.
pub fn fog_layer_column_m(layer: FogLayer, ray: RaySegment) -> f32 {
    match layer.profile {
        FOG_EXPONENTIAL => exponential_column_m(ray, layer.height_m, layer.scale_m),
        FOG_CLAMPED => clamped_column_m(ray, layer.height_m, layer.scale_m),
        FOG_SLAB => layer_column_m(ray, layer.height_m, layer.height_m + layer.scale_m),
        _ => ray.length_m,
    }
}

/// Optical depth of all layers along a ray.
pub fn fog_optical_depth(fog: FogLayers, ray: RaySegment) -> Vec3 {
    let mut depth = Vec3::ZERO;
    for layer in &fog.layers[..fog.count.min(4) as usize] {
        depth += layer.extinction_per_m * fog_layer_column_m(*layer, ray);
    }
    depth
}

/// Optical depth of all layers between a height and the sun.
pub fn fog_depth_to_sun(fog: FogLayers, height_m: f32) -> Vec3 {
    let ray = ray_segment(
        height_m,
        fog.light.sin_sun,
        INFINITE_M,
        fog.inverse_radius_per_m,
    );
    let dips = ray.curvature_per_m > 0.0 && ray.sin_elevation < 0.0;
    let lowest_m =
        height_m - 0.25 * ray.sin_elevation * ray.sin_elevation / ray.curvature_per_m.max(1e-30);
    if (ray.curvature_per_m <= 0.0 && ray.sin_elevation <= 0.0)
        || (dips && lowest_m < fog.ground_height_m)
    {
        return Vec3::splat(OPAQUE);
    }
    let mut depth = Vec3::ZERO;
    for layer in &fog.layers[..fog.count.min(4) as usize] {
        if layer.profile != FOG_UNIFORM {
            depth += layer.extinction_per_m * fog_layer_column_m(*layer, ray);
        }
    }
    depth
}

/// The nearest height above (`rising`) or below a level at which [`layered_fog`] splits a ray because of a layer.
pub fn next_fog_break_m(layer: FogLayer, level_m: f32, rising: bool, ground_height_m: f32) -> f32 {
    let mut steps = [
        0.0, 0.12, 0.25, 0.4, 0.57, 0.77, 1.0, 1.3, 1.65, 2.1, 2.7, 3.5, 5.0, 8.0,
    ];
    let mut from_m = layer.height_m;
    let mut count = 14;
    if layer.profile == FOG_UNIFORM {
        count = 0;
    } else if layer.profile == FOG_SLAB {
        steps[1] = 1.0;
        count = 2;
    } else if layer.profile == FOG_EXPONENTIAL {
        from_m = ground_height_m;
    } else {
        from_m = layer.height_m.max(ground_height_m);
    }
    let mut nearest = if rising { 1e30 } else { -1e30 };
    for step in &steps[..count] {
        let height = from_m + step * layer.scale_m;
        let nearer = if rising {
            height > level_m && height < nearest
        } else {
            height < level_m && height > nearest
        };
        if nearer {
            nearest = height;
        }
    }
    nearest
}

/// Several layers of fog, over flat or round ground.
pub fn layered_fog(fog: FogLayers, ray: RaySegment) -> PathOptics {
    let layers = &fog.layers[..fog.count.min(4) as usize];
    let mut before = Vec3::ZERO;
    let mut radiance = Vec3::ZERO;
    let mut at_m = 0.0;
    let mut level_m = ray.height_m;
    let mut to_sun = fog_depth_to_sun(fog, level_m);
    let dip_m = if ray.curvature_per_m > 0.0 {
        -0.5 * ray.sin_elevation / ray.curvature_per_m.max(1e-30)
    } else {
        0.0
    };
    let mut rising =
        ray.sin_elevation > 0.0 || (ray.sin_elevation == 0.0 && ray.curvature_per_m > 0.0);
    for _ in 0..124 {
        if at_m >= ray.length_m {
            break;
        }
        let mut next_level_m: f32 = if rising { 1e30 } else { -1e30 };
        for layer in layers {
            let height = next_fog_break_m(*layer, level_m, rising, fog.ground_height_m);
            next_level_m = if rising {
                next_level_m.min(height)
            } else {
                next_level_m.max(height)
            };
        }
        let mut end_m = ray.length_m;
        if next_level_m.abs() < 1e30 {
            let below = below_height(ray, next_level_m);
            if below.y > below.x {
                end_m = if rising { below.y } else { below.x };
            } else if rising {
                end_m = at_m;
            }
        }
        let turns = !rising && dip_m > at_m && dip_m < end_m;
        if turns {
            end_m = dip_m;
        }
        if end_m > at_m {
            let part = ray_part(ray, at_m, end_m);
            let mut along = Vec3::ZERO;
            let mut sunlit = Vec3::ZERO;
            let mut scattered = Vec3::ZERO;
            for layer in layers {
                let column_m = fog_layer_column_m(*layer, part);
                along += layer.extinction_per_m * column_m;
                sunlit += layer.scattering_per_m * layer.phase * column_m;
                scattered += layer.scattering_per_m * column_m;
            }
            let far_to_sun = fog_depth_to_sun(fog, height_at(ray, end_m));
            let arriving = fog.light.sunlight
                * sunlit
                * mean_attenuated_source_rgb(to_sun, far_to_sun + along)
                + fog.light.ambient * scattered * mean_transmittance_rgb(along);
            radiance += (-before).exp() * arriving;
            before += along;
            to_sun = far_to_sun;
        }
        at_m = at_m.max(end_m);
        level_m = if turns {
            height_at(ray, end_m)
        } else {
            next_level_m
        };
        rising = rising || turns;
        if before.min_element() > 40.0 {
            break;
        }
    }
    PathOptics {
        transmittance: (-fog_optical_depth(fog, ray)).exp(),
        path_radiance: radiance,
    }
}
