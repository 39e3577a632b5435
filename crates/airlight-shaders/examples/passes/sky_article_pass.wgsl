// A pass that draws the sky article's scene for a target of 8 bits: sky, sun's disc, tone curve and dither. The text of the parts
// `article`, `tone` and `dither` goes in front of this file: airlight_shaders::Pass::SkyArticle.source().

struct SkyArticlePass {
    /// From clip coordinates to directions from the eye, y up.
    direction_from_clip: mat4x4<f32>,
    /// Eye and sun, of `article_sky`.
    sky: ArticleSky,
    /// Unit vector to the sun.
    sun: vec3<f32>,
    /// Factor from cd/m^2 to where middle grey is 0.18.
    exposure: f32,
}

@group(0) @binding(0) var<uniform> scene: SkyArticlePass;

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

@fragment
fn draw_sky(in: Corner) -> @location(0) vec4<f32> {
    let view = normalize((scene.direction_from_clip * vec4<f32>(in.clip, 1.0, 1.0)).xyz);
    var light = article_luminance(scene.sky, view, scene.sun) + article_disc(scene.sky, view, scene.sun);
    // Rays deep into the planet, which does not stop them, are not numbers.
    if !(all(light >= vec3<f32>(0.0)) && all(light < vec3<f32>(1e20))) {
        light = vec3<f32>(0.0);
    }
    let signal = srgb_encode(camera_tone(light * scene.exposure, 1.2, 1.0));
    let pixel = vec2<u32>(in.position.xy);
    return vec4<f32>(dithered(signal, 255.0, pixel.x, pixel.y), 1.0);
}
