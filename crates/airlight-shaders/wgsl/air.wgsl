// requires: exponentials, columns, path_optics, shadows
// Air of molecules, haze and ozone over round ground, marched by single scattering: skies without tables, of any planet, and shadows
// in air, for an eye in the air. Three channels: red, green and blue, or three wavelengths. Light that is scattered more than once is
// missing. The loop is the program's, and with it the visibility of the sun, as from a shadow map:
//
//     let ray = ray_segment(eye_height_m, direction.y, distance_m, air.inverse_radius_per_m);
//     let length_m = air_length_m(air, ray);
//     var march = air_march(air, ray, light);
//     for (var i = 0u; i < steps; i++) {
//         let part = f32(i + 1u) / f32(steps);
//         march = air_march_step(march, air, ray, length_m * part * part, light, visible);
//     }
//
// Optical depths are in closed form. Inside a step that to the sun is linear in that along the ray, as it is in air of one profile over
// flat ground, and the edge of the planet's shadow is found.

/// Air whose density falls exponentially, with a uniform layer of ozone. Heights are above the ground.
struct AirMedium {
    /// Scattering coefficient of molecules at height 0, 1/m.
    molecules_per_m: vec3<f32>,
    /// Scale height of molecules, m, above 0.
    molecules_scale_m: f32,
    /// Extinction coefficient of haze at height 0, 1/m.
    haze_extinction_per_m: vec3<f32>,
    /// Scale height of haze, m, above 0.
    haze_scale_m: f32,
    /// Scattering coefficient of haze at height 0, 1/m.
    haze_scattering_per_m: vec3<f32>,
    /// Height of the top of the air, m.
    top_m: f32,
    /// Absorption coefficient of ozone in its layer, 1/m.
    ozone_per_m: vec3<f32>,
    /// Height of the lower edge of the layer of ozone, m.
    ozone_bottom_m: f32,
    /// Height of its upper edge, m.
    ozone_top_m: f32,
    /// 1 / R of the ground, 1/m, above 0.
    inverse_radius_per_m: f32,
}

/// Sunlight on a ray.
struct AirLight {
    /// Irradiance of the sun outside the air on a surface that faces it.
    sunlight: vec3<f32>,
    /// Sine of the sun's elevation at the start of the ray.
    sin_sun: f32,
    /// Cosine of the angle between the ray and the sun.
    cos_to_sun: f32,
    /// Phase function of molecules at that angle, 1/sr.
    molecules_phase: f32,
    /// Phase function of haze, 1/sr.
    haze_phase: f32,
}

/// Length of a ray in the air, m: up to the ground, the top of the air or its own end. 0 for an eye below the ground. Only a ray that
/// grazes the ground has an error above 1 m.
///
/// Cost: no exp. Error: 3e-6 relative plus 2 absolute.
fn air_length_m(air: AirMedium, ray: RaySegment) -> f32 {
    let in_ground = below_height(ray, 0.0);
    let in_air = below_height(ray, air.top_m);
    return select(in_air.y, in_ground.x, in_ground.y > in_ground.x);
}

/// Columns of molecules (x), haze (y) and ozone (z) along a ray, m. Only a ray that grazes an edge of the ozone has an error above
/// 1e-2 m.
///
/// Cost: 18 exp. Error: 1.5e-5 relative plus 15 absolute.
fn air_columns_m(air: AirMedium, ray: RaySegment) -> vec3<f32> {
    return vec3<f32>(
        exponential_column_m(ray, 0.0, air.molecules_scale_m),
        exponential_column_m(ray, 0.0, air.haze_scale_m),
        layer_column_m(ray, air.ozone_bottom_m, air.ozone_top_m),
    );
}

/// Optical depth of columns of `air_columns_m`.
///
/// Cost: no exp. Error: 3e-7 relative.
fn air_optical_depth(air: AirMedium, columns_m: vec3<f32>) -> vec3<f32> {
    return air.molecules_per_m * columns_m.x + air.haze_extinction_per_m * columns_m.y + air.ozone_per_m * columns_m.z;
}

/// Sine of the sun's elevation after `s_m` metres of a ray, where the vertical is another than at its start.
///
/// Cost: no exp. Error: 1e-6 relative plus 4e-7 absolute.
fn sin_sun_along(air: AirMedium, ray: RaySegment, s_m: f32, light: AirLight) -> f32 {
    let k = air.inverse_radius_per_m;
    let sine = (light.sin_sun * (1.0 + k * ray.height_m) + k * s_m * light.cos_to_sun) / (1.0 + k * height_at(ray, s_m));
    return clamp(sine, -1.0, 1.0);
}

/// Clearance of the way from a height to the sun: negative if the planet hides the sun. It is the height of the lowest point of the way
/// times `2 / R` and the squared cosine of the sun's elevation.
///
/// Cost: no exp. Error: 1e-6 relative plus 4e-7 absolute.
fn sun_clearance(air: AirMedium, height_m: f32, sin_sun: f32) -> f32 {
    let sine = min(sin_sun, 0.0);
    return 2.0 * air.inverse_radius_per_m * height_m * (1.0 - sine) * (1.0 + sine) - sine * sine;
}

/// Optical depth from a height to the sun, or to where it sets if the planet hides it.
///
/// Cost: 18 exp. Error: 2e-5 relative plus 1e-5 absolute.
fn air_depth_to_sun(air: AirMedium, height_m: f32, sin_sun: f32) -> vec3<f32> {
    let above_m = max(height_m, 0.0);
    let dip = 2.0 * above_m * air.inverse_radius_per_m;
    let sine = max(sin_sun, -sqrt(dip / (1.0 + dip)));
    return air_optical_depth(air, air_columns_m(air, ray_segment(above_m, sine, INFINITE_M, air.inverse_radius_per_m)));
}

/// A march along a ray as far as it has come.
struct AirMarch {
    /// The air up to there.
    path: PathOptics,
    /// Distance, m.
    end_m: f32,
    /// Optical depth from there to the sun.
    depth_to_sun: vec3<f32>,
    /// `sun_clearance` there.
    clearance: f32,
}

/// A march at the start of a ray.
///
/// Cost: 18 exp. Error: 2e-5 relative plus 1e-5 absolute.
fn air_march(air: AirMedium, ray: RaySegment, light: AirLight) -> AirMarch {
    let depth = air_depth_to_sun(air, ray.height_m, light.sin_sun);
    return AirMarch(no_fog(), 0.0, depth, sun_clearance(air, ray.height_m, light.sin_sun));
}

/// A march with one step more, to a distance, m. From the step the sun is visible in part, 0 to 1, apart from the planet, which hides it
/// by itself.
///
/// Cost: 45 exp. Error: 3e-5 relative plus 2e-5 absolute.
fn air_march_step(
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
    let arriving = light.sunlight * lit * mean_attenuated_source_rgb(march.depth_to_sun, to_sun + depth);
    let path = near_then_far(march.path, PathOptics(exp(-depth), scattered * arriving));
    return AirMarch(path, to_m, to_sun, clearance);
}
