// Ground of heights over a grid, behind camera.wgsl: its reflected light, and its depth.

struct Terrain {
    /// Place of the eye: metres to the east of the middle of the grid, above the ground of the planet, to the south.
    eye: vec3<f32>,
    planet_radius_m: f32,
    sun: vec3<f32>,
    /// Tangent of the angular radius of the sun's disc.
    sun_tangent: f32,
    /// Illuminance of a surface that faces the sun.
    sun_illuminance: vec3<f32>,
    highest_m: f32,
    second: vec3<f32>,
    /// Illuminance of a surface that faces a second source, 0 without one.
    second_illuminance: vec3<f32>,
    /// Size of the grid, m.
    extent_m: vec2<f32>,
    /// Tangent of the steepest slope.
    steepest: f32,
    /// Distance between posts, m.
    spacing_m: f32,
    /// Albedo of level ground, and of ground that is steeper than 45 degrees.
    level_albedo: vec3<f32>,
    steep_albedo: vec3<f32>,
    /// Coefficients of the light of sky and ground.
    sky: array<vec4<f32>, 9>,
}

@group(0) @binding(0) var<uniform> terrain: Terrain;
@group(0) @binding(1) var mirrored_sampler: sampler;
/// Height in multiples of 16 m, the rest of it, and its rise per metre to the east and to the south.
@group(0) @binding(2) var heights: texture_2d<f32>;

/// Distance beyond which nothing is drawn, m.
const FARTHEST_M: f32 = 3e5;
const STEPS: u32 = 400u;
const SHADOW_STEPS: u32 = 100u;

/// Height of the ground, and its rise per metre to the east and to the south.
fn ground(place: vec2<f32>) -> vec3<f32> {
    let uv = place / terrain.extent_m + 0.5;
    let texel = textureSampleLevel(heights, mirrored_sampler, uv, 0.0);
    // Every other repetition is a mirror image.
    let tile = floor(uv);
    let odd = tile - 2.0 * floor(0.5 * tile);
    return vec3<f32>(texel.x + texel.y, texel.zw * (1.0 - 2.0 * odd));
}

/// Height above the ground of the planet, which curves away below the horizontal plane of the eye, at a distance along a direction from
/// a point.
fn height_along(from_point: vec3<f32>, direction: vec3<f32>, distance_m: f32) -> f32 {
    let point = from_point + distance_m * direction;
    let from_eye = point.xz - terrain.eye.xz;
    return point.y + dot(from_eye, from_eye) / (2.0 * terrain.planet_radius_m);
}

/// Height above the terrain, at a distance along a direction from a point.
fn clearance(from_point: vec3<f32>, direction: vec3<f32>, distance_m: f32) -> f32 {
    let place = from_point.xz + distance_m * direction.xz;
    return height_along(from_point, direction, distance_m) - ground(place).x;
}

/// Part of a clearance that a ray can go without meeting ground of the steepest slope.
fn step_per_clearance(direction: vec3<f32>) -> f32 {
    return 1.0 / max(terrain.steepest * length(direction.xz) - direction.y, 0.05);
}

/// Distance of the ground along a direction from the eye, m; negative where there is none.
fn terrain_distance(direction: vec3<f32>) -> f32 {
    let per_clearance = step_per_clearance(direction);
    var before_m = 0.0;
    var here_m = max(terrain.eye.y - terrain.highest_m, 0.0) / max(-direction.y, 1e-4);
    // Above the terrain, the ground curves away from a ray by less than a ray that falls approaches it.
    here_m = min(here_m * 0.5, FARTHEST_M);
    for (var k = 0u; k < STEPS; k++) {
        let above_m = clearance(terrain.eye, direction, here_m);
        if above_m < 0.0 {
            return first_crossing(direction, before_m, here_m);
        }
        let falls = direction.y + here_m * dot(direction.xz, direction.xz) / terrain.planet_radius_m < 0.0;
        let is_past = !falls && height_along(terrain.eye, direction, here_m) > terrain.highest_m;
        if is_past || here_m > FARTHEST_M {
            return -1.0;
        }
        before_m = here_m;
        here_m += max(above_m * per_clearance, 0.05 * terrain.spacing_m + 1e-3 * here_m);
    }
    // A ray that keeps close to the ground.
    return here_m;
}

/// Where a ray enters the ground between two distances.
fn first_crossing(direction: vec3<f32>, above_m: f32, below_m: f32) -> f32 {
    var from_m = above_m;
    var to_m = below_m;
    for (var k = 0u; k < 12u; k++) {
        let middle_m = 0.5 * (from_m + to_m);
        if clearance(terrain.eye, direction, middle_m) < 0.0 {
            to_m = middle_m;
        } else {
            from_m = middle_m;
        }
    }
    return 0.5 * (from_m + to_m);
}

/// Part of the disc of a source that a point of the ground sees.
fn disc_visibility(point: vec3<f32>, towards: vec3<f32>) -> f32 {
    let per_clearance = step_per_clearance(towards);
    var visible = 1.0;
    var here_m = 0.5 * terrain.spacing_m;
    for (var k = 0u; k < SHADOW_STEPS; k++) {
        let above_m = clearance(point, towards, here_m);
        visible = min(visible, 0.5 + 0.5 * above_m / (here_m * terrain.sun_tangent));
        if visible <= 0.0 {
            return 0.0;
        }
        if height_along(point, towards, here_m) > terrain.highest_m && towards.y > 0.0 {
            break;
        }
        here_m += max(above_m * per_clearance, 0.1 * terrain.spacing_m + 0.02 * here_m);
    }
    return visible;
}

/// Illuminance of a surface with a unit normal by sky and ground.
fn sky_illuminance(n: vec3<f32>) -> vec3<f32> {
    let sum = terrain.sky[0] + terrain.sky[1] * n.x + terrain.sky[2] * n.y + terrain.sky[3] * n.z
        + terrain.sky[4] * (n.x * n.y) + terrain.sky[5] * (n.y * n.z) + terrain.sky[6] * (n.z * n.x)
        + terrain.sky[7] * (3.0 * n.y * n.y - 1.0) + terrain.sky[8] * (n.x * n.x - n.z * n.z);
    return max(sum.xyz, vec3<f32>(0.0));
}

/// Illuminance of a surface at a point by the disc of a source, from its illuminance of a surface that faces it.
fn direct_illuminance(point: vec3<f32>, normal: vec3<f32>, towards: vec3<f32>, facing_it: vec3<f32>) -> vec3<f32> {
    let cosine = dot(normal, towards);
    if cosine <= 0.0 || facing_it.y <= 0.0 {
        return vec3<f32>(0.0);
    }
    return facing_it * (cosine * disc_visibility(point, towards));
}

/// Luminance of the ground at a point.
fn reflected(point: vec3<f32>) -> vec3<f32> {
    let slope = ground(point.xz).yz;
    let normal = normalize(vec3<f32>(-slope.x, 1.0, -slope.y));
    let albedo = mix(terrain.level_albedo, terrain.steep_albedo, smoothstep(0.5, 1.0, length(slope)));
    let illuminance = sky_illuminance(normal)
        + direct_illuminance(point, normal, terrain.sun, terrain.sun_illuminance)
        + direct_illuminance(point, normal, terrain.second, terrain.second_illuminance);
    return albedo * illuminance / 3.14159265;
}

struct Drawn {
    @location(0) light: vec4<f32>,
    @location(1) depth: vec4<f32>,
}

@fragment
fn draw(in: Corner) -> Drawn {
    let direction = direction_at(in.clip);
    if is_outside(in.clip) {
        discard;
    }
    let distance_m = terrain_distance(direction);
    if distance_m < 0.0 {
        discard;
    }
    let light = reflected(terrain.eye + distance_m * direction) * camera.exposure;
    return Drawn(vec4<f32>(light, 1.0), vec4<f32>(depth_at(in.clip, direction, distance_m), 0.0, 0.0, 0.0));
}
