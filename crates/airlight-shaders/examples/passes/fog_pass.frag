#version 450
#extension GL_GOOGLE_include_directive : require
// A pass that adds exponential height fog, lit by the sun and the sky, to a frame with its depth: fog_pass.wgsl in GLSL for Vulkan.
// Draw a triangle that covers the frame with it, and pass on its clip coordinates.
#include "airlight.glsl"

layout(set = 0, binding = 0) uniform FogPass {
    // From clip coordinates to positions, m, y up.
    mat4 world_from_clip;
    // Position of the eye, m.
    vec3 eye;
    // Depth of what has no geometry: the sky.
    float far_depth;
    // Extinction and scattering at the reference height, 1/m.
    vec3 extinction_per_m;
    float reference_height_m;
    vec3 scattering_per_m;
    float scale_height_m;
    // Unit vector to the sun.
    vec3 sun;
    // Mean cosine of the phase function, 0.8 for fog.
    float mean_cosine;
    // Irradiance of the sun on a surface that faces it.
    vec3 sunlight;
    // Mean radiance of the sky.
    vec3 ambient;
};

layout(set = 0, binding = 1) uniform sampler2D colours;
layout(set = 0, binding = 2) uniform sampler2D depths;

layout(location = 0) in vec2 clip;
layout(location = 0) out vec4 seen;

vec3 position_at(float depth) {
    vec4 position = world_from_clip * vec4(clip, depth, 1.0);
    return position.xyz / position.w;
}

void main() {
    ivec2 pixel = ivec2(gl_FragCoord.xy);
    vec4 colour = texelFetch(colours, pixel, 0);
    float depth = texelFetch(depths, pixel, 0).x;
    bool is_sky = depth == far_depth;
    // The end of the depths that is not far has a position for every pixel.
    vec3 to_point = position_at(is_sky ? 1.0 - far_depth : depth) - eye;
    vec3 direction = normalize(to_point);
    float distance_m = is_sky ? INFINITE_M : length(to_point);
    float phase = henyey_greenstein(one_minus_cos_between(direction, sun), mean_cosine);
    FogMedium medium = FogMedium(extinction_per_m, scattering_per_m);
    FogLight light = FogLight(sunlight * phase, sun.y, ambient);
    PathOptics path = exponential_fog(medium, eye.y, direction.y, distance_m, reference_height_m, scale_height_m, light);
    seen = vec4(apply_path_optics(path, colour.rgb), colour.a);
}
