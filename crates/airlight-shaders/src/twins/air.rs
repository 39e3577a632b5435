//! Marched air: `wgsl/air.wgsl`.

use super::columns::{
    INFINITE_M, RaySegment, below_height, exponential_column_m, height_at, layer_column_m,
    ray_part, ray_segment,
};
use super::exponentials::mean_attenuated_source_rgb;
use super::path_optics::{PathOptics, near_then_far};
use super::shadows::{lit_part, no_fog};
use glam::Vec3;

/// Air whose density falls exponentially, with a uniform layer of ozone. Heights are above the ground.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct AirMedium {
    /// Scattering coefficient of molecules at height 0, 1/m.
    pub molecules_per_m: Vec3,
    /// Scale height of molecules, m, above 0.
    pub molecules_scale_m: f32,
    /// Extinction coefficient of haze at height 0, 1/m.
    pub haze_extinction_per_m: Vec3,
    /// Scale height of haze, m, above 0.
    pub haze_scale_m: f32,
    /// Scattering coefficient of haze at height 0, 1/m.
    pub haze_scattering_per_m: Vec3,
    /// Height of the top of the air, m.
    pub top_m: f32,
    /// Absorption coefficient of ozone in its layer, 1/m.
    pub ozone_per_m: Vec3,
    /// Height of the lower edge of the layer of ozone, m.
    pub ozone_bottom_m: f32,
    /// Height of its upper edge, m.
    pub ozone_top_m: f32,
    /// 1 / R of the ground, 1/m, above 0.
    pub inverse_radius_per_m: f32,
}

/// Sunlight on a ray.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct AirLight {
    /// Irradiance of the sun outside the air on a surface that faces it.
    pub sunlight: Vec3,
    /// Sine of the sun's elevation at the start of the ray.
    pub sin_sun: f32,
    /// Cosine of the angle between the ray and the sun.
    pub cos_to_sun: f32,
    /// Phase function of molecules at that angle, 1/sr.
    pub molecules_phase: f32,
    /// Phase function of haze, 1/sr.
    pub haze_phase: f32,
}

/// Length of a ray in the air, m: up to the ground, the top of the air or its own end.
pub fn air_length_m(air: AirMedium, ray: RaySegment) -> f32 {
    let in_ground = below_height(ray, 0.0);
    let in_air = below_height(ray, air.top_m);
    match in_ground.y > in_ground.x {
        true => in_ground.x,
        false => in_air.y,
    }
}

/// Columns of molecules (x), haze (y) and ozone (z) along a ray, m.
pub fn air_columns_m(air: AirMedium, ray: RaySegment) -> Vec3 {
    Vec3::new(
        exponential_column_m(ray, 0.0, air.molecules_scale_m),
        exponential_column_m(ray, 0.0, air.haze_scale_m),
        layer_column_m(ray, air.ozone_bottom_m, air.ozone_top_m),
    )
}

/// Optical depth of columns of [`air_columns_m`].
pub fn air_optical_depth(air: AirMedium, columns_m: Vec3) -> Vec3 {
    air.molecules_per_m * columns_m.x
        + air.haze_extinction_per_m * columns_m.y
        + air.ozone_per_m * columns_m.z
}

/// Sine of the sun's elevation after `s_m` metres of a ray, where the vertical is another than at its start.
pub fn sin_sun_along(air: AirMedium, ray: RaySegment, s_m: f32, light: AirLight) -> f32 {
    let k = air.inverse_radius_per_m;
    let from_centre = light.sin_sun * (1.0 + k * ray.height_m) + k * s_m * light.cos_to_sun;
    (from_centre / (1.0 + k * height_at(ray, s_m))).clamp(-1.0, 1.0)
}

/// Clearance of the way from a height to the sun: negative if the planet hides the sun.
pub fn sun_clearance(air: AirMedium, height_m: f32, sin_sun: f32) -> f32 {
    let sine = sin_sun.min(0.0);
    2.0 * air.inverse_radius_per_m * height_m * (1.0 - sine) * (1.0 + sine) - sine * sine
}

/// Optical depth from a height to the sun, or to where it sets if the planet hides it.
pub fn air_depth_to_sun(air: AirMedium, height_m: f32, sin_sun: f32) -> Vec3 {
    let above_m = height_m.max(0.0);
    let dip = 2.0 * above_m * air.inverse_radius_per_m;
    let sine = sin_sun.max(-(dip / (1.0 + dip)).sqrt());
    let to_sun = ray_segment(above_m, sine, INFINITE_M, air.inverse_radius_per_m);
    air_optical_depth(air, air_columns_m(air, to_sun))
}

/// A march along a ray as far as it has come.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct AirMarch {
    /// The air up to there.
    pub path: PathOptics,
    /// Distance, m.
    pub end_m: f32,
    /// Optical depth from there to the sun.
    pub depth_to_sun: Vec3,
    /// [`sun_clearance`] there.
    pub clearance: f32,
}

/// A march at the start of a ray.
pub fn air_march(air: AirMedium, ray: RaySegment, light: AirLight) -> AirMarch {
    AirMarch {
        path: no_fog(),
        end_m: 0.0,
        depth_to_sun: air_depth_to_sun(air, ray.height_m, light.sin_sun),
        clearance: sun_clearance(air, ray.height_m, light.sin_sun),
    }
}

/// A march with one step more, to a distance, m, from which the sun is visible in part, 0 to 1.
pub fn air_march_step(
    march: AirMarch,
    air: AirMedium,
    ray: RaySegment,
    to_m: f32,
    light: AirLight,
    visibility: f32,
) -> AirMarch {
    let columns_m = air_columns_m(air, ray_part(ray, march.end_m, to_m));
    let depth = air_optical_depth(air, columns_m);
    let scattered = air.molecules_per_m * (columns_m.x * light.molecules_phase)
        + air.haze_scattering_per_m * (columns_m.y * light.haze_phase);
    let height_m = height_at(ray, to_m);
    let sin_sun = sin_sun_along(air, ray, to_m, light);
    let to_sun = air_depth_to_sun(air, height_m, sin_sun);
    let clearance = sun_clearance(air, height_m, sin_sun);
    let lit = visibility * lit_part(march.clearance, clearance);
    let attenuation = mean_attenuated_source_rgb(march.depth_to_sun, to_sun + depth);
    let step = PathOptics {
        transmittance: (-depth).exp(),
        path_radiance: scattered * (light.sunlight * lit * attenuation),
    };
    AirMarch {
        path: near_then_far(march.path, step),
        end_m: to_m,
        depth_to_sun: to_sun,
        clearance,
    }
}
