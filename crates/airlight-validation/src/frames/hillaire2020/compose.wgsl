// The pass over a frame: the sky and the sun's disc where there is no geometry, the air in front of it elsewhere.

@group(0) @binding(5) var depths: texture_2d<f32>;
@group(0) @binding(6) var sky: texture_2d<f32>;
@group(0) @binding(7) var volume: texture_3d<f32>;
@group(0) @binding(8) var sky_sampler: sampler;

struct Corner {
    @builtin(position) position: vec4<f32>,
    @location(0) clip: vec2<f32>,
}

/// A triangle that covers the frame.
@vertex
fn corner(@builtin(vertex_index) index: u32) -> Corner {
    let clip = vec2<f32>(f32(index & 1u), f32(index >> 1u)) * 4.0 - 1.0;
    return Corner(vec4<f32>(clip, 0.0, 1.0), clip);
}

/// What is added to a pixel, and in alpha what it is multiplied by.
@fragment
fn compose(in: Corner) -> @location(0) vec4<f32> {
    let direction = direction_at(in.clip);
    let depth = textureLoad(depths, vec2<i32>(in.position.xy), 0).x;
    if depth == view.far_depth {
        var light = textureSampleLevel(sky, sky_sampler, sky_coordinates(direction), 0.0).rgb;
        if dot(direction, view.sun) > view.cos_radius && distance_to_ground(view.eye_height_km, direction.y) < 0.0 {
            light += view.sunlight * view.disc_per_sunlight * transmittance_to_top(view.eye_height_km, direction.y);
        }
        return vec4<f32>(light, 0.0);
    }
    let here = view.world_from_clip * vec4<f32>(in.clip, depth, 1.0);
    let place = slice_place(1e-3 * length(here.xyz / here.w));
    let uvw = vec3<f32>(0.5 + 0.5 * in.clip.x, 0.5 - 0.5 * in.clip.y, max(place, 0.5) / SLICES);
    let light = textureSampleLevel(volume, linear_sampler, uvw, 0.0);
    // From the eye to the middle of the first slice.
    return mix(vec4<f32>(0.0, 0.0, 0.0, 1.0), light, min(2.0 * place, 1.0));
}
