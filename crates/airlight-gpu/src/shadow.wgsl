// The pass of shadows in a medium, behind its functions and those of what throws the shadows: it subtracts the sunlight that the medium would
// scatter once towards the eye where the sun is hidden. `once_to(direction, distance_m)` is that light up to a distance, in red, green
// and blue; `span_in_shadow(seen)` the interval of distances in which a ray can be in shadow, `shadow_clearance(direction, distance_m)` is
// positive in sunlight, and `lit_share(direction, from_m, to_m, from_clearance, to_clearance)` is the part of a step that is in sunlight.

/// Steps along a ray.
const SHADOW_STEPS: u32 = 64u;

@fragment
fn shade(in: Corner) -> @location(0) vec4<f32> {
    let seen = pixel(in);
    let span = span_in_shadow(seen);
    if span.y <= span.x {
        discard;
    }
    var lost = vec3<f32>(0.0);
    var before_m = span.x;
    var before_clear = shadow_clearance(seen.direction, before_m);
    // Light up to the last step, once it is known.
    var light = vec3<f32>(-1.0);
    for (var k = 1u; k <= SHADOW_STEPS; k++) {
        let place = f32(k) / f32(SHADOW_STEPS);
        let here_m = mix(span.x, span.y, place * place);
        let clear = shadow_clearance(seen.direction, here_m);
        let dark = 1.0 - lit_share(seen.direction, before_m, here_m, before_clear, clear);
        if dark > 0.0 {
            if light.x < 0.0 {
                light = once_to(seen.direction, before_m);
            }
            let here = once_to(seen.direction, here_m);
            lost += dark * (here - light);
            light = here;
        } else {
            light.x = -1.0;
        }
        before_m = here_m;
        before_clear = clear;
    }
    return vec4<f32>(lost * camera.exposure, 0.0);
}
