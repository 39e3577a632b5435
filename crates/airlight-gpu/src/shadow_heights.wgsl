// The pass that finds how far up the shadow of the ground reaches, behind terrain.wgsl's functions of heights.

/// Largest distance of ground that throws shadows, m, and growth of the steps with it.
const FARTHEST_SHADOW_M: f32 = 3e5;
const STEP_GROWTH: f32 = 0.005;

/// Height of the shadow's surface above a place, in multiples of 16 m and the rest: a point is in sunlight if it is higher. The sun stands
/// at the elevation that it has at the eye.
@fragment
fn shadow_height(in: Corner) -> @location(0) vec4<f32> {
    let place = vec2<f32>(in.clip.x, -in.clip.y) * 0.5 * terrain.extent_m;
    let level = length(terrain.sun.xz);
    let towards = terrain.sun.xz / level;
    let rise = terrain.sun.y / level;
    var highest_m = 0.0;
    var here_m = 0.5 * terrain.spacing_m;
    while here_m < FARTHEST_SHADOW_M {
        let ray_m = here_m * rise + here_m * here_m / (2.0 * terrain.planet_radius_m);
        if terrain.highest_m - ray_m <= highest_m {
            break;
        }
        highest_m = max(highest_m, ground(place + towards * here_m).x - ray_m);
        here_m += max(0.5 * terrain.spacing_m, STEP_GROWTH * here_m);
    }
    let whole_m = 16.0 * floor(highest_m / 16.0);
    return vec4<f32>(whole_m, highest_m - whole_m, 0.0, 1.0);
}
