// A pass that adds exponential height fog, lit by the sun and the sky, to a frame with its depth: fog_pass.wgsl in HLSL. In Unity
// it is the fragment program of a full-screen pass, in Unreal the code of a post-process material's Custom node (see the book).
#include "airlight.hlsl"

cbuffer FogPass : register(b0) {
    // From clip coordinates to positions, m, y up.
    float4x4 world_from_clip;
    // Position of the eye, m.
    float3 eye;
    // Depth of what has no geometry: the sky.
    float far_depth;
    // Extinction and scattering at the reference height, 1/m.
    float3 extinction_per_m;
    float reference_height_m;
    float3 scattering_per_m;
    float scale_height_m;
    // Unit vector to the sun.
    float3 sun;
    // Mean cosine of the phase function, 0.8 for fog.
    float mean_cosine;
    // Irradiance of the sun on a surface that faces it.
    float3 sunlight;
    // Mean radiance of the sky.
    float3 ambient;
};

Texture2D<float4> colours : register(t0);
Texture2D<float> depths : register(t1);

struct Corner {
    float4 position : SV_Position;
    float2 clip : TEXCOORD0;
};

float3 position_at(float2 clip, float depth) {
    float4 position = mul(world_from_clip, float4(clip, depth, 1.0));
    return position.xyz / position.w;
}

float4 add_fog(Corner corner) : SV_Target {
    int3 pixel = int3(int2(corner.position.xy), 0);
    float4 colour = colours.Load(pixel);
    float depth = depths.Load(pixel);
    bool is_sky = depth == far_depth;
    // The end of the depths that is not far has a position for every pixel.
    float3 to_point = position_at(corner.clip, is_sky ? 1.0 - far_depth : depth) - eye;
    float3 direction = normalize(to_point);
    float distance_m = is_sky ? INFINITE_M : length(to_point);

    FogMedium medium = (FogMedium)0;
    medium.extinction_per_m = extinction_per_m;
    medium.scattering_per_m = scattering_per_m;
    FogLight light = (FogLight)0;
    light.sunlight = sunlight * henyey_greenstein(one_minus_cos_between(direction, sun), mean_cosine);
    light.sin_sun = sun.y;
    light.ambient = ambient;
    PathOptics path = exponential_fog(medium, eye.y, direction.y, distance_m, reference_height_m, scale_height_m, light);
    return float4(apply_path_optics(path, colour.rgb), colour.a);
}
