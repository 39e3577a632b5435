// The pass that shows a frame on a display, behind the functions of airlight-shaders and corner.wgsl.

struct Tone {
    /// Rows of a linear map of colours.
    red: vec4<f32>,
    green: vec4<f32>,
    blue: vec4<f32>,
    exposure: f32,
    /// 0: camera, 1: AgX, 2: none.
    curve: u32,
    contrast: f32,
    saturation: f32,
    /// Levels of the target above black; 0 without dither.
    levels: f32,
    /// 1 if the target holds signals, 0 if it encodes linear light itself.
    encodes: f32,
}

@group(0) @binding(0) var<uniform> tone: Tone;
@group(0) @binding(1) var source: texture_2d<f32>;

/// Largest half float, as light beyond it is infinite.
const BRIGHTEST: f32 = 65504.0;

fn curved(exposed: vec3<f32>) -> vec3<f32> {
    switch tone.curve {
        case 0u: {
            return camera_tone(exposed, tone.contrast, tone.saturation);
        }
        case 1u: {
            return agx_tone(exposed);
        }
        default: {
            return clip_tone(exposed);
        }
    }
}

@fragment
fn show(in: Corner) -> @location(0) vec4<f32> {
    let place = vec2<u32>(in.position.xy);
    let light = clamp(textureLoad(source, place, 0).rgb, vec3<f32>(-BRIGHTEST), vec3<f32>(BRIGHTEST));
    let balanced = vec3<f32>(dot(tone.red.xyz, light), dot(tone.green.xyz, light), dot(tone.blue.xyz, light));
    let shown = curved(balanced * tone.exposure);
    if tone.encodes == 0.0 {
        return vec4<f32>(shown, 1.0);
    }
    let signal = srgb_encode(shown);
    if tone.levels == 0.0 {
        return vec4<f32>(signal, 1.0);
    }
    return vec4<f32>(dithered(signal, tone.levels, place.x, place.y), 1.0);
}
