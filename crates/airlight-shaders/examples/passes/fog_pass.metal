// A pass that adds exponential height fog, lit by the sun and the sky, to a frame with its depth: fog_pass.wgsl in the Metal Shading
// Language.
#include "airlight.metal"

struct FogPass {
    // From clip coordinates to positions, m, y up.
    metal::float4x4 world_from_clip;
    // Position of the eye, m.
    metal::packed_float3 eye;
    // Depth of what has no geometry: the sky.
    float far_depth;
    // Extinction and scattering at the reference height, 1/m.
    metal::packed_float3 extinction_per_m;
    float reference_height_m;
    metal::packed_float3 scattering_per_m;
    float scale_height_m;
    // Unit vector to the sun.
    metal::packed_float3 sun;
    // Mean cosine of the phase function, 0.8 for fog.
    float mean_cosine;
    // Irradiance of the sun on a surface that faces it.
    metal::packed_float3 sunlight;
    float padding;
    // Mean radiance of the sky.
    metal::packed_float3 ambient;
};

struct Corner {
    metal::float4 position [[position]];
    metal::float2 clip;
};

// A triangle that covers the frame.
vertex Corner corner(uint index [[vertex_id]]) {
    metal::float2 clip = metal::float2(index & 1u, index >> 1u) * 4.0 - 1.0;
    return Corner{metal::float4(clip, 0.0, 1.0), clip};
}

metal::float3 position_at(constant FogPass& fog, metal::float2 clip, float depth) {
    metal::float4 position = fog.world_from_clip * metal::float4(clip, depth, 1.0);
    return position.xyz / position.w;
}

fragment metal::float4 add_fog(
    Corner in [[stage_in]],
    constant FogPass& fog [[buffer(0)]],
    metal::texture2d<float> colours [[texture(0)]],
    metal::depth2d<float> depths [[texture(1)]]
) {
    metal::uint2 pixel = metal::uint2(in.position.xy);
    metal::float4 colour = colours.read(pixel);
    float depth = depths.read(pixel);
    bool is_sky = depth == fog.far_depth;
    metal::float3 eye = fog.eye;
    metal::float3 sun = fog.sun;
    metal::float3 sunlight = fog.sunlight;
    // The end of the depths that is not far has a position for every pixel.
    metal::float3 to_point = position_at(fog, in.clip, is_sky ? 1.0 - fog.far_depth : depth) - eye;
    metal::float3 direction = metal::normalize(to_point);
    float distance_m = is_sky ? INFINITE_M : metal::length(to_point);
    float phase = henyey_greenstein(one_minus_cos_between(direction, sun), fog.mean_cosine);
    FogMedium medium = FogMedium{metal::float3(fog.extinction_per_m), metal::float3(fog.scattering_per_m)};
    FogLight light = FogLight{sunlight * phase, sun.y, metal::float3(fog.ambient)};
    PathOptics path = exponential_fog(
        medium, eye.y, direction.y, distance_m, fog.reference_height_m, fog.scale_height_m, light
    );
    return metal::float4(apply_path_optics(path, colour.rgb), colour.a);
}
