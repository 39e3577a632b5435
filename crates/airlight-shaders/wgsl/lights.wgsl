// requires: exponentials, phase, columns, fog
// Point, spot and sphere lights in fog: the radiance that fog scatters from a light into a ray, by single scattering, attenuated on
// the way to the point and from there to the eye. Add it to the path radiance of the fog without the light. Positions are in
// metres; y is the height. A light's radius should be at least 1/1000 of its distance, so that rounding of positions does not show.
// A ray that goes through a small light, or starts at it, counts as one that passes it at its radius, so that all is finite.

/// Kind of a `LocalLight`: a small light with the same intensity in all directions.
const LIGHT_POINT: u32 = 0u;
/// Kind of a `LocalLight`: a small light with its intensity in a cone.
const LIGHT_SPOT: u32 = 1u;
/// Kind of a `LocalLight`: a sphere of uniform radiance.
const LIGHT_SPHERE: u32 = 2u;

/// Number of Gauss-Legendre nodes in a panel of a ray.
const LIGHT_NODES: u32 = 8u;
/// Optical depth beyond which the light of a panel is neglected.
const LIGHT_CUTOFF: f32 = 12.667;

/// A point, spot or sphere light; made by `point_light`, `spot_light` or `sphere_light`.
struct LocalLight {
    /// Position, of a sphere its centre, m.
    position: vec3<f32>,
    /// `LIGHT_POINT`, `LIGHT_SPOT` or `LIGHT_SPHERE`.
    kind: u32,
    /// Radiant intensity, of a spot light that on its axis, of a sphere `pi R^2` times its radiance.
    intensity: vec3<f32>,
    /// Radius, m, above 0. Distances from small lights are at least this.
    radius_m: f32,
    /// Unit vector along the axis of a spot light, away from it.
    axis: vec3<f32>,
    /// Cosine of the angle from the axis up to which the intensity is full.
    cos_inner: f32,
    /// Cosine of the angle from the axis beyond which the intensity is 0; at least 0.
    cos_outer: f32,
}

/// A point light.
///
/// Cost: no exp. Error: 1e-7 relative.
fn point_light(position: vec3<f32>, radius_m: f32, intensity: vec3<f32>) -> LocalLight {
    return LocalLight(position, LIGHT_POINT, intensity, radius_m, vec3<f32>(0.0), 0.0, 0.0);
}

/// A spot light, whose intensity falls between the inner and the outer angle as in glTF's `KHR_lights_punctual`. Cosines that differ
/// by less than 1e-6 count as 1e-6 apart.
///
/// Cost: no exp. Error: 1e-7 relative.
fn spot_light(
    position: vec3<f32>,
    radius_m: f32,
    intensity: vec3<f32>,
    axis: vec3<f32>,
    cos_inner: f32,
    cos_outer: f32,
) -> LocalLight {
    return LocalLight(position, LIGHT_SPOT, intensity, radius_m, axis, cos_inner, cos_outer);
}

/// A sphere light. Rays that hit it end there.
///
/// Cost: no exp. Error: 3e-7 relative.
fn sphere_light(position: vec3<f32>, radius_m: f32, radiance: vec3<f32>) -> LocalLight {
    let intensity = 3.141592653589793 * radius_m * radius_m * radiance;
    return LocalLight(position, LIGHT_SPHERE, intensity, radius_m, vec3<f32>(0.0), 0.0, 0.0);
}

/// A segment of a ray past a light. Places along the ray count from the point closest to the light.
struct LightRayGeometry {
    /// Distance of the light from the infinite line of the ray, m, above 0.
    nearest_m: f32,
    /// Place of the start, m, negative if the light lies ahead.
    start_m: f32,
    /// Length, m, at most `INFINITE_M`.
    length_m: f32,
}

/// A segment past a light, from which it is at least `at_least_m` away.
///
/// Cost: no exp. Error: 1e-6 relative plus 3e-5 absolute.
fn light_ray_geometry(
    eye: vec3<f32>,
    direction: vec3<f32>,
    length_m: f32,
    light: vec3<f32>,
    at_least_m: f32,
) -> LightRayGeometry {
    let to_light = light - eye;
    return LightRayGeometry(max(length(cross(to_light, direction)), at_least_m), -dot(to_light, direction), length_m);
}

/// Distance from the light at a place, m.
///
/// Cost: no exp. Error: 4e-7 relative.
fn light_distance_m(nearest_m: f32, place_m: f32) -> f32 {
    return sqrt(nearest_m * nearest_m + place_m * place_m);
}

/// Distance from the light plus the place, m, without cancellation.
///
/// Cost: no exp. Error: 1e-6 relative.
fn light_ahead_m(nearest_m: f32, place_m: f32) -> f32 {
    let far = light_distance_m(nearest_m, place_m) + abs(place_m);
    return select(far, nearest_m * (nearest_m / far), place_m < 0.0);
}

/// Excess of the end: by how much the path from the start to the end and on to the light is longer than from the start to the
/// light, m.
///
/// Cost: no exp. Error: 2e-6 relative.
fn light_excess_m(geometry: LightRayGeometry) -> f32 {
    let h = geometry.nearest_m;
    let end = geometry.start_m + geometry.length_m;
    let ahead = light_ahead_m(h, geometry.start_m) + light_ahead_m(h, end);
    return geometry.length_m * (ahead / (light_distance_m(h, geometry.start_m) + light_distance_m(h, end)));
}

/// Angle that the segment subtends at the light, 0 to pi.
///
/// Cost: no exp. Error: 3e-5 relative.
fn light_angle(geometry: LightRayGeometry) -> f32 {
    let h = geometry.nearest_m;
    let u = geometry.start_m;
    return atan2(h * geometry.length_m, h * h + u * (u + geometry.length_m));
}

/// Radiance scattered from a point light of unit intensity by uniform fog of unit scattering coefficient that scatters equally in
/// all directions, 1/m, without extinction: `angle / (4 pi h)` (after Macklin 2010, corrected).
///
/// Cost: no exp. Error: 3e-5 relative.
fn airlight_without_extinction(geometry: LightRayGeometry) -> f32 {
    return light_angle(geometry) * 0.07957747154594767 / geometry.nearest_m;
}

/// Place (x) and weight (y) of a node on the unit interval.
///
/// Cost: no exp. Error: 1e-7 relative.
fn light_gauss_node(i: u32) -> vec2<f32> {
    var places = array<f32, 4>(0.0198550718, 0.1016667613, 0.2372337950, 0.4082826788);
    var weights = array<f32, 4>(0.0506142681, 0.1111905172, 0.1568533229, 0.1813418917);
    let k = min(i, 7u - min(i, 7u));
    return vec2<f32>(select(places[k], 1.0 - places[k], i > 3u), weights[k]);
}

/// Interval of `q` that nodes cover: from 1 down to 1 minus this, where the excess is `scale (1 - q^3) / q^3`, from 0 to `end`.
///
/// Cost: 1 exp. Error: 3e-6 relative.
fn light_node_span(scale_m: f32, end_m: f32) -> f32 {
    let inverse = min(scale_m / max(end_m, 1e-30), 1e30);
    let covered = 1.0 / (1.0 + inverse);
    let last = pow(max(inverse * covered, 1e-30), 0.3333333333);
    return covered / (1.0 + last + last * last);
}

/// Excess (x) and step (y) of a node, m.
///
/// Cost: no exp. Error: 4e-5 relative.
fn light_node(i: u32, scale_m: f32, span: f32) -> vec2<f32> {
    let node = light_gauss_node(i);
    let z = span * node.x;
    let q = 1.0 - z;
    let p = q * q * q;
    return vec2<f32>(scale_m * z * (3.0 - 3.0 * z + z * z) / p, 3.0 * node.y * span * scale_m / (q * p));
}

/// `airlight_without_extinction` with extinction between light, fog and eye (1/m): the integral of Sun, Ramamoorthi, Narasimhan and
/// Nayar (2005) by quadrature with 8 nodes.
///
/// Cost: 6 exp, 3 exp a step; 8 steps. Error: 1.5e-4 relative plus 1e-12 absolute.
fn airlight_isotropic(geometry: LightRayGeometry, extinction_per_m: vec3<f32>) -> vec3<f32> {
    let h = geometry.nearest_m;
    let ahead = light_ahead_m(h, geometry.start_m);
    let scale = light_distance_m(h, ahead);
    let spread = 2.0 * ahead / scale;
    let x = extinction_per_m * scale;
    // Each channel ends where its light is negligible.
    let inverse = max(vec3<f32>(min(scale / max(light_excess_m(geometry), 1e-30), 1e30)), x / LIGHT_CUTOFF);
    let covered = 1.0 / (1.0 + inverse);
    let last = pow(max(inverse * covered, vec3<f32>(1e-30)), vec3<f32>(0.3333333333));
    let span = covered / (1.0 + last + last * last);
    var sum = vec3<f32>(0.0);
    for (var i = 0u; i < LIGHT_NODES; i += 1u) {
        let node = light_gauss_node(i);
        let z = span * node.x;
        let q = 1.0 - z;
        let p = q * q * q;
        let y = z * (3.0 + z * (z - 3.0));
        let fall = p * p + y * (spread * p + y);
        let both = 1.0 / (p * fall);
        sum += 3.0 * node.y * q * q * p * both * exp(-x * y * fall * both);
    }
    let arriving = exp(-extinction_per_m * light_distance_m(h, geometry.start_m));
    return 0.15915494309189535 / scale * arriving * span * sum;
}

/// A point light in uniform fog that scatters equally in all directions.
///
/// Cost: 6 exp, 3 exp a step; 8 steps. Error: 1e-3 relative plus 1e-12 absolute.
fn point_light_in_isotropic_fog(
    medium: FogMedium,
    light: LocalLight,
    eye: vec3<f32>,
    direction: vec3<f32>,
    length_m: f32,
) -> vec3<f32> {
    let geometry = light_ray_geometry(eye, direction, length_m, light.position, light.radius_m);
    return medium.scattering_per_m * light.intensity * airlight_isotropic(geometry, medium.extinction_per_m);
}

/// A ray past a light of any kind.
struct LightRay {
    /// The segment, which ends at the light if that is a sphere and the ray hits it.
    geometry: LightRayGeometry,
    /// The light.
    light: LocalLight,
    /// Distance of the light from the line, m, at least 0.
    nearest_m: f32,
    /// Component along a spot light's axis of the vector from the light to the closest point of the ray, m.
    across_m: f32,
    /// Cosine between the ray and a spot light's axis.
    along: f32,
}

/// A ray past a light.
///
/// Cost: no exp. Error: 1e-6 relative plus 5e-4 absolute.
fn light_ray(light: LocalLight, eye: vec3<f32>, direction: vec3<f32>, length_m: f32) -> LightRay {
    var geometry = light_ray_geometry(eye, direction, length_m, light.position, light.radius_m);
    let to_light = light.position - eye;
    let nearest_m = length(cross(to_light, direction));
    if light.kind == LIGHT_SPHERE {
        let distance_m = length(to_light);
        let inside = (light.radius_m - nearest_m) * (light.radius_m + nearest_m);
        if distance_m <= light.radius_m {
            geometry.length_m = 0.0;
        } else if geometry.start_m < 0.0 && inside > 0.0 {
            let hit_m = (distance_m - light.radius_m) * (distance_m + light.radius_m) / (sqrt(inside) - geometry.start_m);
            geometry.length_m = min(length_m, hit_m);
        }
    }
    let closest = -to_light - geometry.start_m * direction;
    return LightRay(geometry, light, nearest_m, dot(closest, light.axis), dot(direction, light.axis));
}

/// Interval of a ray, m from its start, in which the direction from a spot light is within a cone of this cosine of its half-angle;
/// the whole ray for other lights, (0, 0) outside.
///
/// Cost: no exp. Error: 1e-4 relative plus 1e-3 absolute.
fn lit_interval(ray: LightRay, cos_angle: f32) -> vec2<f32> {
    let length_m = ray.geometry.length_m;
    if ray.light.kind != LIGHT_SPOT {
        return vec2<f32>(0.0, length_m);
    }
    // In the angle at the light the cosine to the axis is a sinusoid, so that the ray is in the cone in one interval.
    let h = ray.geometry.nearest_m;
    let across = ray.across_m / h;
    let size = light_distance_m(across, ray.along);
    if cos_angle >= size {
        return vec2<f32>(0.0);
    }
    let middle = vec2<f32>(across, ray.along) / size;
    let width = cos_angle / size;
    let sin_width = sqrt(max((1.0 - width) * (1.0 + width), 0.0));
    let first = vec2<f32>(middle.x * width + middle.y * sin_width, middle.y * width - middle.x * sin_width);
    let last = vec2<f32>(middle.x * width - middle.y * sin_width, middle.y * width + middle.x * sin_width);
    // Beyond a right angle an edge, or the whole interval, is at infinity.
    var from_m = -INFINITE_M;
    if first.x > 0.0 {
        from_m = h * first.y / first.x;
    } else if across <= 0.0 && ray.along >= 0.0 {
        return vec2<f32>(0.0);
    }
    var to_m = INFINITE_M;
    if last.x > 0.0 {
        to_m = h * last.y / last.x;
    } else if across <= 0.0 && ray.along <= 0.0 {
        return vec2<f32>(0.0);
    }
    let interval = clamp(vec2<f32>(from_m, to_m) - ray.geometry.start_m, vec2<f32>(0.0), vec2<f32>(length_m));
    return select(vec2<f32>(0.0), interval, interval.y > interval.x);
}

/// Light at a place of a ray: its intensity there relative to `intensity` (x), times the ratio of the squared distances `geometry`
/// and the light have; the distance to the light's surface, m (y); 1 minus the cosine of the scattering angle (z).
///
/// Cost: no exp. Error: 4e-5 relative plus 4e-5 absolute.
fn light_at(ray: LightRay, place_m: f32) -> vec3<f32> {
    let h = ray.geometry.nearest_m;
    let r = light_distance_m(h, place_m);
    // r + place, without cancellation.
    let one_minus_cos = light_ahead_m(h, place_m) / r;
    if ray.light.kind == LIGHT_SPOT {
        let cos_angle = (ray.across_m + place_m * ray.along) / r;
        let range = max(ray.light.cos_inner - ray.light.cos_outer, 1e-6);
        let part = clamp((cos_angle - ray.light.cos_outer) / range, 0.0, 1.0);
        return vec3<f32>(part * part, r, one_minus_cos);
    }
    if ray.light.kind == LIGHT_SPHERE {
        let radius_m = ray.light.radius_m;
        let centre_m = max(light_distance_m(ray.nearest_m, place_m), radius_m);
        let sine = radius_m / centre_m;
        // The scalar irradiance near a sphere.
        let closeness = 2.0 / (1.0 + sqrt(max((1.0 - sine) * (1.0 + sine), 0.0)));
        return vec3<f32>(closeness * (r / centre_m) * (r / centre_m), centre_m - radius_m, min(1.0 + place_m / centre_m, 2.0));
    }
    return vec3<f32>(1.0, r, one_minus_cos);
}

/// Width of the forward peak of a Henyey-Greenstein function in the tangent of half the scattering angle, at most 1.
///
/// Cost: no exp. Error: 3e-7 relative.
fn light_peak(mean_cosine: f32) -> f32 {
    return min((1.0 - mean_cosine) / (1.0 + mean_cosine), 1.0);
}

/// Part of a ray past a light in uniform fog, for unit intensity and unit scattering coefficient, 1/m.
///
/// Cost: 1 exp, 3 exp a step; 8 steps. Error: 6e-3 relative plus 1e-9 absolute.
fn light_panel_in_uniform_fog(
    extinction_per_m: vec3<f32>,
    mean_cosine: f32,
    ray: LightRay,
    from_m: f32,
    to_m: f32,
) -> vec3<f32> {
    let h = ray.geometry.nearest_m;
    let start = ray.geometry.start_m + from_m;
    let r0 = light_distance_m(h, start);
    let ahead = light_ahead_m(h, start);
    let least = min(extinction_per_m.x, min(extinction_per_m.y, extinction_per_m.z));
    let rate = max(extinction_per_m.x, max(extinction_per_m.y, extinction_per_m.z));
    let end = min(light_excess_m(LightRayGeometry(h, start, to_m - from_m)), LIGHT_CUTOFF / max(least, 1e-12));
    // The smallest scale of geometry, phase function and extinction.
    let wide = light_distance_m(light_peak(mean_cosine) * h, ahead);
    let scale = wide / light_distance_m(1.0, rate * wide / 12.0);
    let span = light_node_span(scale, end);
    var sum = vec3<f32>(0.0);
    for (var i = 0u; i < LIGHT_NODES; i += 1u) {
        let node = light_node(i, scale, span);
        let s = node.x + ahead;
        let t = 0.5 * node.x * ((node.x + 2.0 * r0) / s);
        let at = light_at(ray, 0.5 * (s - h) * ((s + h) / s));
        let phase = henyey_greenstein(at.z, mean_cosine);
        let weight = 2.0 * node.y / (h * h + s * s) * at.x * phase;
        sum += weight * exp(-extinction_per_m * (from_m + t + at.y));
    }
    return sum;
}

/// A light of any kind in uniform fog whose phase function is that of Henyey and Greenstein, of mean cosine from -0.3 to 0.95.
///
/// Cost: 3 exp, 9 exp a step; 8 steps, for point and sphere lights a third. Error: 6e-3 relative plus 1e-9 absolute.
fn light_in_uniform_fog(
    medium: FogMedium,
    mean_cosine: f32,
    light: LocalLight,
    eye: vec3<f32>,
    direction: vec3<f32>,
    length_m: f32,
) -> vec3<f32> {
    let ray = light_ray(light, eye, direction, length_m);
    let outer = lit_interval(ray, light.cos_outer);
    let inner = clamp(lit_interval(ray, light.cos_inner), vec2<f32>(outer.x), vec2<f32>(outer.y));
    var sum = vec3<f32>(0.0);
    if inner.x > outer.x {
        sum += light_panel_in_uniform_fog(medium.extinction_per_m, mean_cosine, ray, outer.x, inner.x);
    }
    if inner.y > inner.x {
        sum += light_panel_in_uniform_fog(medium.extinction_per_m, mean_cosine, ray, inner.x, inner.y);
    }
    if outer.y > inner.y {
        sum += light_panel_in_uniform_fog(medium.extinction_per_m, mean_cosine, ray, inner.y, outer.y);
    }
    return medium.scattering_per_m * light.intensity * sum;
}

/// Exponential height fog over flat ground for lights.
struct ExponentialFog {
    /// Coefficients at the reference height.
    medium: FogMedium,
    /// Mean cosine of the Henyey-Greenstein phase function, -0.3 to 0.95.
    mean_cosine: f32,
    /// Height of density 1, m.
    reference_height_m: f32,
    /// Scale height, m, above 0.
    scale_height_m: f32,
}

/// Column from the eye to a distance along a ray and from there to a light, m.
///
/// Cost: 4 exp. Error: 3e-5 relative plus 1e-3 absolute.
fn column_by_light_m(
    fog: ExponentialFog,
    eye_height_m: f32,
    sin_elevation: f32,
    distance_m: f32,
    light_height_m: f32,
    to_centre_m: f32,
    to_light_m: f32,
) -> f32 {
    let height_m = eye_height_m + sin_elevation * distance_m;
    let sine = (light_height_m - height_m) / max(to_centre_m, 1e-6);
    return flat_exponential_column_m(eye_height_m, sin_elevation, distance_m, fog.reference_height_m, fog.scale_height_m)
        + flat_exponential_column_m(height_m, sine, to_light_m, fog.reference_height_m, fog.scale_height_m);
}

/// Part of a ray past a light in exponential height fog, for unit intensity and unit scattering coefficient, 1/m.
///
/// Cost: 5 exp, 12 exp a step; 8 steps of 8, and 1 to 8 of 4. Error: 1e-2 relative plus 1e-9 absolute.
fn light_panel_in_exponential_fog(
    fog: ExponentialFog,
    eye_height_m: f32,
    sin_elevation: f32,
    ray: LightRay,
    from_m: f32,
    to_m: f32,
) -> vec3<f32> {
    let h = ray.geometry.nearest_m;
    let start = ray.geometry.start_m + from_m;
    let extinction = fog.medium.extinction_per_m;
    let least = max(min(extinction.x, min(extinction.y, extinction.z)), 1e-12);
    let most = max(extinction.x, max(extinction.y, extinction.z));
    let light_height_m = ray.light.position.y;
    let first_r = light_distance_m(h, start);
    let first_ahead = light_ahead_m(h, start);
    let whole = light_excess_m(LightRayGeometry(h, start, to_m - from_m));
    // Shorten the panel to where there is light.
    let before = column_by_light_m(fog, eye_height_m, sin_elevation, from_m, light_height_m, first_r, first_r);
    var end = whole;
    var reached = 0.0;
    for (var i = 0u; i < 8u; i += 1u) {
        let t = 0.5 * end * ((end + 2.0 * first_r) / (end + first_ahead));
        let r = light_distance_m(h, start + t);
        let column = column_by_light_m(fog, eye_height_m, sin_elevation, from_m + t, light_height_m, r, r);
        reached = least * (column - before);
        if reached <= 2.0 * LIGHT_CUTOFF {
            break;
        }
        end *= select(0.5, 0.1, reached > 20.0 * LIGHT_CUTOFF);
    }
    let rate = max(reached / max(end, 1e-30), 0.0) * (most / least);
    // Before the light, in thin fog, nodes are dense at the end near the light.
    let outwards = start + (to_m - from_m) <= 0.0 && rate * end < 4.0;
    var origin_m = from_m;
    var forward = 1.0;
    var anchor = start;
    if outwards {
        let reach = min(0.5 * end * ((end + 2.0 * first_r) / (end + first_ahead)), to_m - from_m);
        origin_m = from_m + reach;
        forward = -1.0;
        anchor = -(start + reach);
        end = light_excess_m(LightRayGeometry(h, anchor, reach));
    }
    let r0 = light_distance_m(h, anchor);
    let ahead = light_ahead_m(h, anchor);
    let wide = light_distance_m(select(light_peak(fog.mean_cosine), 1.0, outwards) * h, ahead);
    let scale = wide / light_distance_m(1.0, select(rate, 0.0, outwards) * wide / 12.0);
    let span = light_node_span(scale, end);
    var sum = vec3<f32>(0.0);
    for (var i = 0u; i < LIGHT_NODES; i += 1u) {
        let node = light_node(i, scale, span);
        let s = node.x + ahead;
        let t = max(origin_m + forward * 0.5 * node.x * ((node.x + 2.0 * r0) / s), 0.0);
        let place = forward * 0.5 * (s - h) * ((s + h) / s);
        let at = light_at(ray, place);
        let centre_m = select(at.y, at.y + ray.light.radius_m, ray.light.kind == LIGHT_SPHERE);
        let column = column_by_light_m(fog, eye_height_m, sin_elevation, t, light_height_m, centre_m, at.y);
        let density = decayed((eye_height_m + sin_elevation * t - fog.reference_height_m) / fog.scale_height_m);
        let phase = henyey_greenstein(at.z, fog.mean_cosine);
        let weight = 2.0 * node.y / (h * h + s * s) * at.x * phase * density;
        sum += weight * exp(-extinction * column);
    }
    return sum;
}

/// A light of any kind in exponential height fog over flat ground.
///
/// Cost: 2 exp, 17 exp a step; 1 to 6 steps of 73 to 101. Error: 4e-2 relative plus 1e-9 absolute.
fn light_in_exponential_fog(
    fog: ExponentialFog,
    light: LocalLight,
    eye: vec3<f32>,
    direction: vec3<f32>,
    length_m: f32,
) -> vec3<f32> {
    let ray = light_ray(light, eye, direction, length_m);
    let outer = lit_interval(ray, light.cos_outer);
    let inner = lit_interval(ray, light.cos_inner);
    var last_m = outer.y;
    // The densest height that light reaches, and places some scale heights above it.
    let rise = direction.y / fog.scale_height_m;
    let start = (eye.y - fog.reference_height_m) / fog.scale_height_m;
    var floor = start + min(rise * ray.geometry.length_m, 0.0);
    if rise < 0.0 {
        let extinction = fog.medium.extinction_per_m;
        let least = max(min(extinction.x, min(extinction.y, extinction.z)), 1e-12);
        let dark = -log(decayed(start) + 90.0 * -rise / least);
        if dark > floor {
            floor = dark;
            last_m = min(last_m, max((dark - start) / rise, 0.0));
        }
    }
    let light_cuts = vec3<f32>(inner, -ray.geometry.start_m);
    var height_cuts = vec3<f32>(last_m);
    if rise != 0.0 {
        height_cuts = (floor + vec3<f32>(3.0, 10.0, 40.0) - start) / rise;
        if rise > 0.0 {
            last_m = min(last_m, max(height_cuts.z, 0.0));
        }
    }
    var sum = vec3<f32>(0.0);
    var from_m = outer.x;
    for (var i = 0u; i < 7u; i += 1u) {
        if from_m >= last_m {
            break;
        }
        let beside_light = select(vec3<f32>(last_m), light_cuts, light_cuts > vec3<f32>(from_m));
        let at_height = select(vec3<f32>(last_m), height_cuts, height_cuts > vec3<f32>(from_m));
        let next = min(beside_light, at_height);
        let to_m = min(min(next.x, last_m), min(next.y, next.z));
        sum += light_panel_in_exponential_fog(fog, eye.y, direction.y, ray, from_m, to_m);
        from_m = to_m;
    }
    return fog.medium.scattering_per_m * light.intensity * sum;
}
