// Directions of the pixels of a frame, and distances of the slices of the volume.

const SLICES: f32 = 32.0;
/// Distance of the end of the volume.
const REACH_KM: f32 = 128.0;

/// Direction of a place in clip space.
fn direction_at(clip: vec2<f32>) -> vec3<f32> {
    let near = view.world_from_clip * vec4<f32>(clip, 1.0 - view.far_depth, 1.0);
    return normalize(near.xyz / near.w);
}

/// Distance of the middle of a slice: denser near the eye.
fn slice_distance(slice: f32) -> f32 {
    let part = (slice + 0.5) / SLICES;
    return REACH_KM * part * part;
}

/// Place of a distance among the slices, from 0 at the eye to their number.
fn slice_place(distance_km: f32) -> f32 {
    return SLICES * sqrt(distance_km / REACH_KM);
}
