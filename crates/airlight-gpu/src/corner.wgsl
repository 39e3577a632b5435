// The vertex stage of passes over a whole target.

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
