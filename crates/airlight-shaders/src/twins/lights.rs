//! Point, spot and sphere lights in fog: `wgsl/lights.wgsl`.

use super::columns::{INFINITE_M, decayed, flat_exponential_column_m};
use super::fog::FogMedium;
use super::phase::henyey_greenstein;
use glam::{Vec2, Vec3};
use std::f32::consts::PI;

/// Kind of a `LocalLight`: a small light with the same intensity in all directions.
pub const LIGHT_POINT: u32 = 0;
/// Kind of a `LocalLight`: a small light with its intensity in a cone.
pub const LIGHT_SPOT: u32 = 1;
/// Kind of a `LocalLight`: a sphere of uniform radiance.
pub const LIGHT_SPHERE: u32 = 2;

/// Number of Gauss-Legendre nodes in a panel of a ray.
pub const LIGHT_NODES: u32 = 8;
/// Optical depth beyond which the light of a panel is neglected.
pub const LIGHT_CUTOFF: f32 = 12.667;

/// A point, spot or sphere light; made by `point_light`, `spot_light` or `sphere_light`.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct LocalLight {
    /// Position, of a sphere its centre, m.
    pub position: Vec3,
    /// `LIGHT_POINT`, `LIGHT_SPOT` or `LIGHT_SPHERE`.
    pub kind: u32,
    /// Radiant intensity, of a spot light that on its axis, of a sphere `pi R^2` times its radiance.
    pub intensity: Vec3,
    /// Radius, m, above 0. Distances from small lights are at least this.
    pub radius_m: f32,
    /// Unit vector along the axis of a spot light, away from it.
    pub axis: Vec3,
    /// Cosine of the angle from the axis up to which the intensity is full.
    pub cos_inner: f32,
    /// Cosine of the angle from the axis beyond which the intensity is 0; at least 0.
    pub cos_outer: f32,
}

/// A point light.
pub fn point_light(position: Vec3, radius_m: f32, intensity: Vec3) -> LocalLight {
    LocalLight {
        position,
        kind: LIGHT_POINT,
        intensity,
        radius_m,
        axis: Vec3::ZERO,
        cos_inner: 0.0,
        cos_outer: 0.0,
    }
}

/// A spot light, whose intensity falls between the inner and the outer angle as in glTF's `KHR_lights_punctual`.
pub fn spot_light(
    position: Vec3,
    radius_m: f32,
    intensity: Vec3,
    axis: Vec3,
    cos_inner: f32,
    cos_outer: f32,
) -> LocalLight {
    LocalLight {
        position,
        kind: LIGHT_SPOT,
        intensity,
        radius_m,
        axis,
        cos_inner,
        cos_outer,
    }
}

/// A sphere light. Rays that hit it end there.
pub fn sphere_light(position: Vec3, radius_m: f32, radiance: Vec3) -> LocalLight {
    let intensity = PI * radius_m * radius_m * radiance;
    LocalLight {
        position,
        kind: LIGHT_SPHERE,
        intensity,
        radius_m,
        axis: Vec3::ZERO,
        cos_inner: 0.0,
        cos_outer: 0.0,
    }
}

/// A segment of a ray past a light. Places along the ray count from the point closest to the light.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct LightRayGeometry {
    /// Distance of the light from the infinite line of the ray, m, above 0.
    pub nearest_m: f32,
    /// Place of the start, m, negative if the light lies ahead.
    pub start_m: f32,
    /// Length, m, at most `INFINITE_M`.
    pub length_m: f32,
}

/// A segment past a light, from which it is at least `at_least_m` away.
pub fn light_ray_geometry(
    eye: Vec3,
    direction: Vec3,
    length_m: f32,
    light: Vec3,
    at_least_m: f32,
) -> LightRayGeometry {
    let to_light = light - eye;
    LightRayGeometry {
        nearest_m: (to_light.cross(direction).length()).max(at_least_m),
        start_m: -to_light.dot(direction),
        length_m,
    }
}

/// Distance from the light at a place, m.
pub fn light_distance_m(nearest_m: f32, place_m: f32) -> f32 {
    (nearest_m * nearest_m + place_m * place_m).sqrt()
}

/// Distance from the light plus the place, m, without cancellation.
pub fn light_ahead_m(nearest_m: f32, place_m: f32) -> f32 {
    let far = light_distance_m(nearest_m, place_m) + place_m.abs();
    if place_m < 0.0 {
        nearest_m * (nearest_m / far)
    } else {
        far
    }
}

/// Excess of the end: by how much the path from the start to the end and on to the light is longer than from the start to the
/// light, m.
pub fn light_excess_m(geometry: LightRayGeometry) -> f32 {
    let h = geometry.nearest_m;
    let end = geometry.start_m + geometry.length_m;
    let ahead = light_ahead_m(h, geometry.start_m) + light_ahead_m(h, end);
    geometry.length_m * (ahead / (light_distance_m(h, geometry.start_m) + light_distance_m(h, end)))
}

/// Angle that the segment subtends at the light, 0 to pi.
pub fn light_angle(geometry: LightRayGeometry) -> f32 {
    let h = geometry.nearest_m;
    let u = geometry.start_m;
    (h * geometry.length_m).atan2(h * h + u * (u + geometry.length_m))
}

/// Radiance scattered from a point light of unit intensity by uniform fog of unit scattering coefficient that scatters equally in
/// all directions, 1/m, without extinction: `angle / (4 pi h)` (after Macklin 2010, corrected).
pub fn airlight_without_extinction(geometry: LightRayGeometry) -> f32 {
    light_angle(geometry) * 0.079_577_47 / geometry.nearest_m
}

/// Place (x) and weight (y) of a node on the unit interval.
pub fn light_gauss_node(i: u32) -> Vec2 {
    let places = [0.019_855_072, 0.101_666_76, 0.237_233_8, 0.408_282_68];
    let weights = [0.050_614_268, 0.111_190_52, 0.156_853_32, 0.181_341_89f32];
    let k = i.min(7 - i.min(7)) as usize;
    Vec2::new(if i > 3 { 1.0 - places[k] } else { places[k] }, weights[k])
}

/// Interval of `q` that nodes cover: from 1 down to 1 minus this, where the excess is `scale (1 - q^3) / q^3`, from 0 to `end`.
pub fn light_node_span(scale_m: f32, end_m: f32) -> f32 {
    let inverse = (scale_m / end_m.max(1e-30)).min(1e30);
    let covered = 1.0 / (1.0 + inverse);
    let last = ((inverse * covered).max(1e-30)).powf(1.0 / 3.0);
    covered / (1.0 + last + last * last)
}

/// Excess (x) and step (y) of a node, m.
pub fn light_node(i: u32, scale_m: f32, span: f32) -> Vec2 {
    let node = light_gauss_node(i);
    let z = span * node.x;
    let q = 1.0 - z;
    let p = q * q * q;
    Vec2::new(
        scale_m * z * (3.0 - 3.0 * z + z * z) / p,
        3.0 * node.y * span * scale_m / (q * p),
    )
}

/// `airlight_without_extinction` with extinction between light, fog and eye (1/m): the integral of Sun, Ramamoorthi, Narasimhan and
/// Nayar (2005) by quadrature with 8 nodes.
pub fn airlight_isotropic(geometry: LightRayGeometry, extinction_per_m: Vec3) -> Vec3 {
    let h = geometry.nearest_m;
    let ahead = light_ahead_m(h, geometry.start_m);
    let scale = light_distance_m(h, ahead);
    let spread = 2.0 * ahead / scale;
    let x = extinction_per_m * scale;
    // Each channel ends where its light is negligible.
    let inverse =
        Vec3::splat((scale / light_excess_m(geometry).max(1e-30)).min(1e30)).max(x / LIGHT_CUTOFF);
    let covered = 1.0 / (1.0 + inverse);
    let last = ((inverse * covered).max(Vec3::splat(1e-30))).powf(1.0 / 3.0);
    let span = covered / (1.0 + last + last * last);
    let mut sum = Vec3::ZERO;
    for i in 0..LIGHT_NODES {
        let node = light_gauss_node(i);
        let z = span * node.x;
        let q = 1.0 - z;
        let p = q * q * q;
        let y = z * (3.0 + z * (z - 3.0));
        let fall = p * p + y * (spread * p + y);
        let both = 1.0 / (p * fall);
        sum += 3.0 * node.y * q * q * p * both * (-x * y * fall * both).exp();
    }
    let arriving = (-extinction_per_m * light_distance_m(h, geometry.start_m)).exp();
    0.159_154_94 / scale * arriving * span * sum
}

/// A point light in uniform fog that scatters equally in all directions.
pub fn point_light_in_isotropic_fog(
    medium: FogMedium,
    light: LocalLight,
    eye: Vec3,
    direction: Vec3,
    length_m: f32,
) -> Vec3 {
    let geometry = light_ray_geometry(eye, direction, length_m, light.position, light.radius_m);
    medium.scattering_per_m
        * light.intensity
        * airlight_isotropic(geometry, medium.extinction_per_m)
}

/// A ray past a light of any kind.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct LightRay {
    /// The segment, which ends at the light if that is a sphere and the ray hits it.
    pub geometry: LightRayGeometry,
    /// The light.
    pub light: LocalLight,
    /// Distance of the light from the line, m, at least 0.
    pub nearest_m: f32,
    /// Component along a spot light's axis of the vector from the light to the closest point of the ray, m.
    pub across_m: f32,
    /// Cosine between the ray and a spot light's axis.
    pub along: f32,
}

/// A ray past a light.
pub fn light_ray(light: LocalLight, eye: Vec3, direction: Vec3, length_m: f32) -> LightRay {
    let mut geometry = light_ray_geometry(eye, direction, length_m, light.position, light.radius_m);
    let to_light = light.position - eye;
    let nearest_m = to_light.cross(direction).length();
    if light.kind == LIGHT_SPHERE {
        let distance_m = to_light.length();
        let inside = (light.radius_m - nearest_m) * (light.radius_m + nearest_m);
        if distance_m <= light.radius_m {
            geometry.length_m = 0.0;
        } else if geometry.start_m < 0.0 && inside > 0.0 {
            let hit_m = (distance_m - light.radius_m) * (distance_m + light.radius_m)
                / (inside.sqrt() - geometry.start_m);
            geometry.length_m = length_m.min(hit_m);
        }
    }
    let closest = -to_light - geometry.start_m * direction;
    LightRay {
        geometry,
        light,
        nearest_m,
        across_m: closest.dot(light.axis),
        along: direction.dot(light.axis),
    }
}

/// Interval of a ray, m from its start, in which the direction from a spot light is within a cone of this cosine of its half-angle;
/// the whole ray for other lights, (0, 0) outside.
pub fn lit_interval(ray: LightRay, cos_angle: f32) -> Vec2 {
    let length_m = ray.geometry.length_m;
    if ray.light.kind != LIGHT_SPOT {
        return Vec2::new(0.0, length_m);
    }
    // In the angle at the light the cosine to the axis is a sinusoid, so that the ray is in the cone in one interval.
    let h = ray.geometry.nearest_m;
    let across = ray.across_m / h;
    let size = light_distance_m(across, ray.along);
    if cos_angle >= size {
        return Vec2::ZERO;
    }
    let middle = Vec2::new(across, ray.along) / size;
    let width = cos_angle / size;
    let sin_width = (((1.0 - width) * (1.0 + width)).max(0.0)).sqrt();
    let first = Vec2::new(
        middle.x * width + middle.y * sin_width,
        middle.y * width - middle.x * sin_width,
    );
    let last = Vec2::new(
        middle.x * width - middle.y * sin_width,
        middle.y * width + middle.x * sin_width,
    );
    // Beyond a right angle an edge, or the whole interval, is at infinity.
    let mut from_m = -INFINITE_M;
    if first.x > 0.0 {
        from_m = h * first.y / first.x;
    } else if across <= 0.0 && ray.along >= 0.0 {
        return Vec2::ZERO;
    }
    let mut to_m = INFINITE_M;
    if last.x > 0.0 {
        to_m = h * last.y / last.x;
    } else if across <= 0.0 && ray.along <= 0.0 {
        return Vec2::ZERO;
    }
    let interval =
        (Vec2::new(from_m, to_m) - ray.geometry.start_m).clamp(Vec2::ZERO, Vec2::splat(length_m));
    if interval.y > interval.x {
        interval
    } else {
        Vec2::ZERO
    }
}

/// Light at a place of a ray: its intensity there relative to `intensity` (x), times the ratio of the squared distances `geometry`
/// and the light have; the distance to the light's surface, m (y); 1 minus the cosine of the scattering angle (z).
pub fn light_at(ray: LightRay, place_m: f32) -> Vec3 {
    let h = ray.geometry.nearest_m;
    let r = light_distance_m(h, place_m);
    // r + place, without cancellation.
    let one_minus_cos = light_ahead_m(h, place_m) / r;
    if ray.light.kind == LIGHT_SPOT {
        let cos_angle = (ray.across_m + place_m * ray.along) / r;
        let range = (ray.light.cos_inner - ray.light.cos_outer).max(1e-6);
        let part = ((cos_angle - ray.light.cos_outer) / range).clamp(0.0, 1.0);
        return Vec3::new(part * part, r, one_minus_cos);
    }
    if ray.light.kind == LIGHT_SPHERE {
        let radius_m = ray.light.radius_m;
        let centre_m = light_distance_m(ray.nearest_m, place_m).max(radius_m);
        let sine = radius_m / centre_m;
        // The scalar irradiance near a sphere.
        let closeness = 2.0 / (1.0 + (((1.0 - sine) * (1.0 + sine)).max(0.0)).sqrt());
        return Vec3::new(
            closeness * (r / centre_m) * (r / centre_m),
            centre_m - radius_m,
            (1.0 + place_m / centre_m).min(2.0),
        );
    }
    Vec3::new(1.0, r, one_minus_cos)
}

/// Width of the forward peak of a Henyey-Greenstein function in the tangent of half the scattering angle, at most 1.
pub fn light_peak(mean_cosine: f32) -> f32 {
    ((1.0 - mean_cosine) / (1.0 + mean_cosine)).min(1.0)
}

/// Part of a ray past a light in uniform fog, for unit intensity and unit scattering coefficient, 1/m.
pub fn light_panel_in_uniform_fog(
    extinction_per_m: Vec3,
    mean_cosine: f32,
    ray: LightRay,
    from_m: f32,
    to_m: f32,
) -> Vec3 {
    let h = ray.geometry.nearest_m;
    let start = ray.geometry.start_m + from_m;
    let r0 = light_distance_m(h, start);
    let ahead = light_ahead_m(h, start);
    let least = extinction_per_m
        .x
        .min(extinction_per_m.y.min(extinction_per_m.z));
    let rate = extinction_per_m
        .x
        .max(extinction_per_m.y.max(extinction_per_m.z));
    let end = light_excess_m(LightRayGeometry {
        nearest_m: h,
        start_m: start,
        length_m: to_m - from_m,
    })
    .min(LIGHT_CUTOFF / least.max(1e-12));
    // The smallest scale of geometry, phase function and extinction.
    let wide = light_distance_m(light_peak(mean_cosine) * h, ahead);
    let scale = wide / light_distance_m(1.0, rate * wide / 12.0);
    let span = light_node_span(scale, end);
    let mut sum = Vec3::ZERO;
    for i in 0..LIGHT_NODES {
        let node = light_node(i, scale, span);
        let s = node.x + ahead;
        let t = 0.5 * node.x * ((node.x + 2.0 * r0) / s);
        let at = light_at(ray, 0.5 * (s - h) * ((s + h) / s));
        let phase = henyey_greenstein(at.z, mean_cosine);
        let weight = 2.0 * node.y / (h * h + s * s) * at.x * phase;
        sum += weight * (-extinction_per_m * (from_m + t + at.y)).exp();
    }
    sum
}

/// A light of any kind in uniform fog whose phase function is that of Henyey and Greenstein, of mean cosine from -0.3 to 0.95.
pub fn light_in_uniform_fog(
    medium: FogMedium,
    mean_cosine: f32,
    light: LocalLight,
    eye: Vec3,
    direction: Vec3,
    length_m: f32,
) -> Vec3 {
    let ray = light_ray(light, eye, direction, length_m);
    let outer = lit_interval(ray, light.cos_outer);
    let inner =
        lit_interval(ray, light.cos_inner).clamp(Vec2::splat(outer.x), Vec2::splat(outer.y));
    let mut sum = Vec3::ZERO;
    if inner.x > outer.x {
        sum +=
            light_panel_in_uniform_fog(medium.extinction_per_m, mean_cosine, ray, outer.x, inner.x);
    }
    if inner.y > inner.x {
        sum +=
            light_panel_in_uniform_fog(medium.extinction_per_m, mean_cosine, ray, inner.x, inner.y);
    }
    if outer.y > inner.y {
        sum +=
            light_panel_in_uniform_fog(medium.extinction_per_m, mean_cosine, ray, inner.y, outer.y);
    }
    medium.scattering_per_m * light.intensity * sum
}

/// Exponential height fog over flat ground for lights.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct ExponentialFog {
    /// Coefficients at the reference height.
    pub medium: FogMedium,
    /// Mean cosine of the Henyey-Greenstein phase function, -0.3 to 0.95.
    pub mean_cosine: f32,
    /// Height of density 1, m.
    pub reference_height_m: f32,
    /// Scale height, m, above 0.
    pub scale_height_m: f32,
}

/// Column from the eye to a distance along a ray and from there to a light, m.
pub fn column_by_light_m(
    fog: ExponentialFog,
    eye_height_m: f32,
    sin_elevation: f32,
    distance_m: f32,
    light_height_m: f32,
    to_centre_m: f32,
    to_light_m: f32,
) -> f32 {
    let height_m = eye_height_m + sin_elevation * distance_m;
    let sine = (light_height_m - height_m) / to_centre_m.max(1e-6);
    flat_exponential_column_m(
        eye_height_m,
        sin_elevation,
        distance_m,
        fog.reference_height_m,
        fog.scale_height_m,
    ) + flat_exponential_column_m(
        height_m,
        sine,
        to_light_m,
        fog.reference_height_m,
        fog.scale_height_m,
    )
}

/// Part of a ray past a light in exponential height fog, for unit intensity and unit scattering coefficient, 1/m.
pub fn light_panel_in_exponential_fog(
    fog: ExponentialFog,
    eye_height_m: f32,
    sin_elevation: f32,
    ray: LightRay,
    from_m: f32,
    to_m: f32,
) -> Vec3 {
    let h = ray.geometry.nearest_m;
    let start = ray.geometry.start_m + from_m;
    let extinction = fog.medium.extinction_per_m;
    let least = extinction.x.min(extinction.y.min(extinction.z)).max(1e-12);
    let most = extinction.x.max(extinction.y.max(extinction.z));
    let light_height_m = ray.light.position.y;
    let first_r = light_distance_m(h, start);
    let first_ahead = light_ahead_m(h, start);
    let whole = light_excess_m(LightRayGeometry {
        nearest_m: h,
        start_m: start,
        length_m: to_m - from_m,
    });
    // Shorten the panel to where there is light.
    let before = column_by_light_m(
        fog,
        eye_height_m,
        sin_elevation,
        from_m,
        light_height_m,
        first_r,
        first_r,
    );
    let mut end = whole;
    let mut reached = 0.0;
    for _ in 0..8 {
        let t = 0.5 * end * ((end + 2.0 * first_r) / (end + first_ahead));
        let r = light_distance_m(h, start + t);
        let column = column_by_light_m(
            fog,
            eye_height_m,
            sin_elevation,
            from_m + t,
            light_height_m,
            r,
            r,
        );
        reached = least * (column - before);
        if reached <= 2.0 * LIGHT_CUTOFF {
            break;
        }
        end *= if reached > 20.0 * LIGHT_CUTOFF {
            0.1
        } else {
            0.5
        };
    }
    let rate = (reached / end.max(1e-30)).max(0.0) * (most / least);
    // Before the light, in thin fog, nodes are dense at the end near the light.
    let outwards = start + (to_m - from_m) <= 0.0 && rate * end < 4.0;
    let mut origin_m = from_m;
    let mut forward = 1.0;
    let mut anchor = start;
    if outwards {
        let reach = (0.5 * end * ((end + 2.0 * first_r) / (end + first_ahead))).min(to_m - from_m);
        origin_m = from_m + reach;
        forward = -1.0;
        anchor = -(start + reach);
        end = light_excess_m(LightRayGeometry {
            nearest_m: h,
            start_m: anchor,
            length_m: reach,
        });
    }
    let r0 = light_distance_m(h, anchor);
    let ahead = light_ahead_m(h, anchor);
    let (peak, rate) = match outwards {
        true => (1.0, 0.0),
        false => (light_peak(fog.mean_cosine), rate),
    };
    let wide = light_distance_m(peak * h, ahead);
    let scale = wide / light_distance_m(1.0, rate * wide / 12.0);
    let span = light_node_span(scale, end);
    let mut sum = Vec3::ZERO;
    for i in 0..LIGHT_NODES {
        let node = light_node(i, scale, span);
        let s = node.x + ahead;
        let t = (origin_m + forward * 0.5 * node.x * ((node.x + 2.0 * r0) / s)).max(0.0);
        let place = forward * 0.5 * (s - h) * ((s + h) / s);
        let at = light_at(ray, place);
        let centre_m = if ray.light.kind == LIGHT_SPHERE {
            at.y + ray.light.radius_m
        } else {
            at.y
        };
        let column = column_by_light_m(
            fog,
            eye_height_m,
            sin_elevation,
            t,
            light_height_m,
            centre_m,
            at.y,
        );
        let density = decayed(
            (eye_height_m + sin_elevation * t - fog.reference_height_m) / fog.scale_height_m,
        );
        let phase = henyey_greenstein(at.z, fog.mean_cosine);
        let weight = 2.0 * node.y / (h * h + s * s) * at.x * phase * density;
        sum += weight * (-extinction * column).exp();
    }
    sum
}

/// A light of any kind in exponential height fog over flat ground.
pub fn light_in_exponential_fog(
    fog: ExponentialFog,
    light: LocalLight,
    eye: Vec3,
    direction: Vec3,
    length_m: f32,
) -> Vec3 {
    let ray = light_ray(light, eye, direction, length_m);
    let outer = lit_interval(ray, light.cos_outer);
    let inner = lit_interval(ray, light.cos_inner);
    let mut last_m = outer.y;
    // The densest height that light reaches, and places some scale heights above it.
    let rise = direction.y / fog.scale_height_m;
    let start = (eye.y - fog.reference_height_m) / fog.scale_height_m;
    let mut floor = start + (rise * ray.geometry.length_m).min(0.0);
    if rise < 0.0 {
        let extinction = fog.medium.extinction_per_m;
        let least = extinction.x.min(extinction.y.min(extinction.z)).max(1e-12);
        let dark = -(decayed(start) + 90.0 * -rise / least).ln();
        if dark > floor {
            floor = dark;
            last_m = last_m.min(((dark - start) / rise).max(0.0));
        }
    }
    let light_cuts = inner.extend(-ray.geometry.start_m);
    let mut height_cuts = Vec3::splat(last_m);
    if rise != 0.0 {
        height_cuts = (floor + Vec3::new(3.0, 10.0, 40.0) - start) / rise;
        if rise > 0.0 {
            last_m = last_m.min(height_cuts.z.max(0.0));
        }
    }
    let mut sum = Vec3::ZERO;
    let mut from_m = outer.x;
    for _ in 0..7 {
        if from_m >= last_m {
            break;
        }
        let ahead = |cuts: Vec3| {
            let from = Vec3::splat(from_m);
            Vec3::select(cuts.cmpgt(from), cuts, Vec3::splat(last_m))
        };
        let next = ahead(light_cuts).min(ahead(height_cuts));
        let to_m = next.x.min(last_m).min(next.y.min(next.z));
        sum += light_panel_in_exponential_fog(fog, eye.y, direction.y, ray, from_m, to_m);
        from_m = to_m;
    }
    fog.medium.scattering_per_m * light.intensity * sum
}
