// Generated from the WGSL of airlight-shaders by its example `translate`: change that, not this.

float2 select_each(bool2 condition, float2 accept, float2 reject) {
    return float2(condition.x ? accept.x : reject.x, condition.y ? accept.y : reject.y);
}

float3 select_each(bool3 condition, float3 accept, float3 reject) {
    return float3(select_each(condition.xy, accept.xy, reject.xy), condition.z ? accept.z : reject.z);
}

float4 select_each(bool4 condition, float4 accept, float4 reject) {
    return float4(select_each(condition.xyz, accept.xyz, reject.xyz), condition.w ? accept.w : reject.w);
}

struct DropletPhase {
    float peak_one_minus_g;
    float wide_g;
    float wide_alpha;
    float wide_weight;
};

struct PathOptics {
    float3 transmittance;
    int _pad1_0;
    float3 path_radiance;
    int _end_pad_0;
};

struct RaySegment {
    float height_m;
    float sin_elevation;
    float curvature_per_m;
    float length_m;
};

struct FogMedium {
    float3 extinction_per_m;
    int _pad1_0;
    float3 scattering_per_m;
    int _end_pad_0;
};

struct FogLight {
    float3 sunlight;
    float sin_sun;
    float3 ambient;
    int _end_pad_0;
};

struct FogLayer {
    float3 extinction_per_m;
    uint profile;
    float3 scattering_per_m;
    float height_m;
    float3 phase;
    float scale_m;
};

struct FogLayers {
    FogLayer layers[4];
    uint count;
    float ground_height_m;
    float inverse_radius_per_m;
    int _pad4_0;
    FogLight light;
};

struct AirMedium {
    float3 molecules_per_m;
    float molecules_scale_m;
    float3 haze_extinction_per_m;
    float haze_scale_m;
    float3 haze_scattering_per_m;
    float top_m;
    float3 ozone_per_m;
    float ozone_bottom_m;
    float ozone_top_m;
    float inverse_radius_per_m;
    int _end_pad_0;
    int _end_pad_1;
};

struct AirLight {
    float3 sunlight;
    float sin_sun;
    float cos_to_sun;
    float molecules_phase;
    float haze_phase;
    int _end_pad_0;
};

struct AirMarch {
    PathOptics path;
    float end_m;
    int _pad2_0;
    int _pad2_1;
    int _pad2_2;
    float3 depth_to_sun;
    float clearance;
};

struct LocalLight {
    float3 position;
    uint kind;
    float3 intensity;
    float radius_m;
    float3 axis;
    float cos_inner;
    float cos_outer;
    int _end_pad_0;
    int _end_pad_1;
    int _end_pad_2;
};

struct LightRayGeometry {
    float nearest_m;
    float start_m;
    float length_m;
};

struct LightRay {
    LightRayGeometry geometry;
    int _pad1_0;
    LocalLight light;
    float nearest_m;
    float across_m;
    float along;
    int _end_pad_0;
};

struct ExponentialFog {
    FogMedium medium;
    float mean_cosine;
    float reference_height_m;
    float scale_height_m;
    int _end_pad_0;
};

struct RgbWeights {
    float4 red;
    float4 green;
    float4 blue;
};

struct SkyView {
    float3 sun;
    float height_m;
    float ground_radius_m;
    float air_height_m;
    float horizon_rad;
    float highest_rad;
    float kink_rad;
    float kink_place;
    float dense_share;
    float dense_azimuth;
    float dense_width;
    float even_below;
    float jump_height_m;
    float jump_place;
    float jump_part;
    int _pad15_0;
    int _pad15_1;
    int _pad15_2;
    float4 extinction_above;
    float4 smooth_above;
    float4 haze_above;
};

struct SkyScales {
    float4 smooth_light;
    float4 haze;
};

struct SpectralPath {
    float4 transmittance;
    float4 path_radiance;
};

struct FogTableView {
    float3 sun;
    float below_per_sine;
    float3 depth_below;
    float above_per_sine;
    float3 depth_above;
    float diffuse_scale;
    float sunlit_scale;
    float layer;
    float layer_count;
    float phase_count;
};

struct ArticleSky {
    float3 eye;
    float sun_radius_rad;
    float3 outer_space;
    float sun_solid_angle;
};

struct LimbDarkening {
    float4 zeroth;
    float4 first;
    float4 second;
    float4 third;
    float4 fourth;
    float4 fifth;
};

static const float OPAQUE = 1e25;
static const float INFINITE_M = 1000000000000.0;
static const float LARGEST_LN_DENSITY = 57.0;
static const uint FOG_UNIFORM = 0u;
static const uint FOG_EXPONENTIAL = 1u;
static const uint FOG_CLAMPED = 2u;
static const uint FOG_SLAB = 3u;
static const uint LIGHT_POINT = 0u;
static const uint LIGHT_SPOT = 1u;
static const uint LIGHT_SPHERE = 2u;
static const uint LIGHT_NODES = 8u;
static const float LIGHT_CUTOFF = 12.667;
static const float SKY_AZIMUTHS = 64.0;
static const float SKY_ROWS_ABOVE = 125.0;
static const float SKY_ROWS_BELOW = 35.0;
static const float AERIAL_AZIMUTHS = 24.0;
static const float AERIAL_FIRST_COLUMN = 0.3;
static const float AERIAL_ROWS_ABOVE = 44.0;
static const float AERIAL_ROWS_BELOW = 18.0;
static const float AERIAL_FIRST_ROW = 0.6;
static const float AERIAL_DISTANCES = 42.0;
static const float BEHIND_JUMP_M = 100000.0;
static const float PHASE_ANGLES = 1024.0;
static const float FOG_AZIMUTHS = 32.0;
static const float FOG_ROWS = 64.0;
static const float FOG_DISTANCES = 32.0;
static const float FOG_LOGARITHMIC = 0.6;
static const int ARTICLE_STEPS = int(8);
static const float ARTICLE_PI = 3.1415927;
static const float ARTICLE_PLANET_RADIUS_M = 6360000.0;
static const float ARTICLE_TOP_RADIUS_M = 6420000.0;
static const float ARTICLE_RAYLEIGH_SCALE_M = 8000.0;
static const float ARTICLE_MIE_SCALE_M = 1200.0;


// Mean transmittance over optical depths from 0 to `x`, not negative: `(1 - e^-x) / x`, 1 at 0.
// Cost: 1 exp.
float mean_transmittance(float x)
{
    float series = (1.0 + (x * (-0.5 + (x * (0.16666667 + (x * (-0.041666668 + (x * (0.008333334 + (x * (-0.0013888889 + (x * (0.0001984127 - (x / 40320.0))))))))))))));
    float direct = ((1.0 - exp(-(x))) / max(x, 0.75));
    return ((x < 0.75) ? series : direct);
}

// `mean_transmittance` of three channels.
// Cost: 3 exp.
float3 mean_transmittance_rgb(float3 x_1)
{
    const float _e2 = mean_transmittance(x_1.x);
    const float _e4 = mean_transmittance(x_1.y);
    const float _e6 = mean_transmittance(x_1.z);
    return float3(_e2, _e4, _e6);
}

// Mean of `e^-t t / x` over optical depths from 0 to `x`, not negative: `((1 - e^-x) / x - e^-x) / x`, 1/2 at 0.
// Cost: 1 exp.
float ramp_transmittance(float x_2)
{
    float series_1 = (0.5 + (x_2 * (-0.33333334 + (x_2 * (0.125 + (x_2 * (-0.033333335 + (x_2 * (0.0069444445 + (x_2 * (-0.0011904762 + (x_2 * (0.00017361112 - (x_2 / 45360.0))))))))))))));
    float divisor = max(x_2, 0.75);
    float transmittance_2 = exp(-(x_2));
    float direct_1 = ((((1.0 - transmittance_2) / divisor) - transmittance_2) / divisor);
    return ((x_2 < 0.75) ? series_1 : direct_1);
}

// Mean of `e^-(d + t)` along a ray of optical depth `tau`, where the light that arrives at optical depth `t` from the eye is attenuated by `d(t)`, linear in `t`: the divided difference `(e^-near - e^-far) / (far - near)`. `near` is `d(0)`, `far` is `d(tau) + tau`; both from 0 to 1e30. No special case: `near` and `far` may be equal.
// Cost: 2 exp.
float mean_attenuated_source(float near, float far)
{
    const float _e7 = mean_transmittance(abs((far - near)));
    return (exp(-(min(near, far))) * _e7);
}

// `mean_attenuated_source` of three channels.
// Cost: 6 exp.
float3 mean_attenuated_source_rgb(float3 near_1, float3 far_1)
{
    const float3 _e7 = mean_transmittance_rgb(abs((far_1 - near_1)));
    return (exp(-(min(near_1, far_1))) * _e7);
}

// Weights of the near (x) and the far (y) end of a segment of optical depth `along` for a source that is linear in optical depth, per unit of optical depth.
// Cost: 2 exp.
float2 linear_source_mean(float along)
{
    const float _e1 = ramp_transmittance(along);
    const float _e2 = mean_transmittance(along);
    return float2((_e2 - _e1), _e1);
}

// Scaled complementary error function `e^(z^2) erfc(z)` for `z` not negative. Chebyshev fit in `1 / (1 + z / 2)`.
// Cost: no exp.
float scaled_erfc(float z)
{
    float t = (1.0 / (1.0 + (0.5 * z)));
    return (t * (0.2820948 + (t * (0.28209376 + (t * (0.24688388 + (t * (0.17532408 + (t * (0.093414746 + (t * (-0.05905091 + (t * (0.13185003 + (t * (-0.4545637 + (t * (0.49338573 + (t * (-0.23460549 + (t * 0.043173067)))))))))))))))))))));
}

// 1 minus the cosine of the angle between two unit vectors, without cancellation for small angles: half the square of their distance. The scattering angle of light from the sun is the angle between the view ray and the direction to the sun.
// Cost: no exp.
float one_minus_cos_between(float3 a, float3 b)
{
    float3 apart = (a - b);
    return (0.5 * dot(apart, apart));
}

// Isotropic scattering.
// Cost: no exp.
float isotropic_phase()
{
    return 0.07957747;
}

// Rayleigh scattering by molecules with a depolarization ratio for natural light in [0, 6/7), 0.028 for air (Bucholtz, Appl. Opt. 34, 2765, 1995, eqs. 10 and 12).
// Cost: no exp.
float rayleigh_phase(float one_minus_cos, float depolarization_ratio)
{
    float gamma = (depolarization_ratio / (2.0 - depolarization_ratio));
    float cos_angle_1 = (1.0 - one_minus_cos);
    return ((0.059683103 / (1.0 + (2.0 * gamma))) * ((1.0 + (3.0 * gamma)) + (((1.0 - gamma) * cos_angle_1) * cos_angle_1)));
}

// Henyey-Greenstein phase function of a forward peak, of mean cosine `1 - one_minus_g`: `one_minus_g` from 1e-6 to 1, which keeps the width of narrow peaks.
// Cost: no exp.
float henyey_greenstein_peak(float one_minus_cos_1, float one_minus_g)
{
    float d = ((one_minus_g * one_minus_g) + ((2.0 * (1.0 - one_minus_g)) * one_minus_cos_1));
    return (((0.07957747 * one_minus_g) * (2.0 - one_minus_g)) / (d * sqrt(d)));
}

// Henyey & Greenstein (1941): mean cosine `g`, -1 < g < 1.
// Cost: no exp.
float henyey_greenstein(float one_minus_cos_2, float g)
{
    const float _e10 = henyey_greenstein_peak(((g >= 0.0) ? one_minus_cos_2 : (2.0 - one_minus_cos_2)), (1.0 - abs(g)));
    return _e10;
}

// Draine (Astrophys. J. 598, 1017, 2003, eq. 6): Henyey-Greenstein times `1 + alpha cos^2`, normalised; `alpha` not negative.
// Cost: no exp.
float draine(float one_minus_cos_3, float g_1, float alpha)
{
    float norm = (1.0 + ((alpha * (1.0 + ((2.0 * g_1) * g_1))) / 3.0));
    float cos_angle_2 = (1.0 - one_minus_cos_3);
    const float _e15 = henyey_greenstein(one_minus_cos_3, g_1);
    return ((_e15 * (1.0 + ((alpha * cos_angle_2) * cos_angle_2))) / norm);
}

// Cornette & Shanks (Appl. Opt. 31, 3152, 1992, eq. 8): Henyey-Greenstein times `1 + cos^2`, normalised.
// Cost: no exp.
float cornette_shanks(float one_minus_cos_4, float g_2)
{
    const float _e3 = draine(one_minus_cos_4, g_2, 1.0);
    return _e3;
}

DropletPhase ConstructDropletPhase(float arg0, float arg1, float arg2, float arg3) {
    DropletPhase ret = (DropletPhase)0;
    ret.peak_one_minus_g = arg0;
    ret.wide_g = arg1;
    ret.wide_alpha = arg2;
    ret.wide_weight = arg3;
    return ret;
}

// Fog droplets of a diameter of 5 to 50 micrometres, to which other diameters are clamped (Jendersie & d'Eon, "An approximate Mie scattering function for fog and cloud rendering", SIGGRAPH 2023 Talks, eqs. 4-7). Compute it once for all pixels.
// Cost: 4 exp.
DropletPhase droplet_phase(float diameter_um)
{
    float d_1 = clamp(diameter_um, 5.0, 50.0);
    float peak = (0.0990567 / (d_1 - 1.67154));
    const float _e8 = mean_transmittance(peak);
    const DropletPhase dropletphase = ConstructDropletPhase((peak * _e8), exp(((-2.20679 / (d_1 + 3.91029)) - 0.428934)), exp((3.62489 - (8.29288 / (d_1 + 5.52825)))), exp(((-0.599085 / (d_1 - 0.641583)) - 0.665888)));
    return dropletphase;
}

// Value of the phase function of fog droplets.
// Cost: no exp.
float evaluate_droplet_phase(DropletPhase phase, float one_minus_cos_5)
{
    const float _e6 = henyey_greenstein_peak(one_minus_cos_5, phase.peak_one_minus_g);
    const float _e11 = draine(one_minus_cos_5, phase.wide_g, phase.wide_alpha);
    return (((1.0 - phase.wide_weight) * _e6) + (phase.wide_weight * _e11));
}

// Radiance at the eye of the radiance behind the segment.
// Cost: no exp.
float3 apply_path_optics(PathOptics path, float3 radiance)
{
    return ((path.transmittance * radiance) + path.path_radiance);
}

PathOptics ConstructPathOptics(float3 arg0, float3 arg1) {
    PathOptics ret = (PathOptics)0;
    ret.transmittance = arg0;
    ret.path_radiance = arg1;
    return ret;
}

// A segment followed by one farther away, as one segment.
// Cost: no exp.
PathOptics near_then_far(PathOptics near_2, PathOptics far_2)
{
    const PathOptics pathoptics = ConstructPathOptics((near_2.transmittance * far_2.transmittance), (near_2.path_radiance + (near_2.transmittance * far_2.path_radiance)));
    return pathoptics;
}

// Segment of an optical depth with a source function (radiance scattered towards the eye per unit of optical depth) that is constant along it: `(1 - T) source`, exact in thin and opaque air.
// Cost: 6 exp.
PathOptics constant_source(float3 optical_depth, float3 source)
{
    const float3 _e4 = mean_transmittance_rgb(optical_depth);
    const PathOptics pathoptics_1 = ConstructPathOptics(exp(-(optical_depth)), (source * (optical_depth * _e4)));
    return pathoptics_1;
}

RaySegment ConstructRaySegment(float arg0, float arg1, float arg2, float arg3) {
    RaySegment ret = (RaySegment)0;
    ret.height_m = arg0;
    ret.sin_elevation = arg1;
    ret.curvature_per_m = arg2;
    ret.length_m = arg3;
    return ret;
}

// A segment over ground of curvature `inverse_radius_per_m` = 1 / R, 0 for flat ground.
// Cost: no exp.
RaySegment ray_segment(float height_m, float sin_elevation, float length_m, float inverse_radius_per_m)
{
    float squared_cos = ((1.0 - sin_elevation) * (1.0 + sin_elevation));
    const RaySegment raysegment = ConstructRaySegment(height_m, sin_elevation, ((0.5 * max(squared_cos, 0.0)) * inverse_radius_per_m), length_m);
    return raysegment;
}

// Height after `s_m` metres, m.
// Cost: no exp.
float height_at(RaySegment ray, float s_m)
{
    return (ray.height_m + (s_m * (ray.sin_elevation + (s_m * ray.curvature_per_m))));
}

// The part from `from_m` to `to_m`, as a segment that starts there.
// Cost: no exp.
RaySegment ray_part(RaySegment ray_1, float from_m, float to_m)
{
    const float _e3 = height_at(ray_1, from_m);
    const RaySegment raysegment_1 = ConstructRaySegment(_e3, (ray_1.sin_elevation + ((2.0 * from_m) * ray_1.curvature_per_m)), ray_1.curvature_per_m, (to_m - from_m));
    return raysegment_1;
}

// Interval of distances (m) in which the segment is below `height_m`; (0, 0) if it never is. Only a ray that grazes this height over round ground has an error above 1e-2 m.
// Cost: no exp.
float2 below_height(RaySegment ray_2, float height_m_1)
{
    float first = 0.0;
    float last = 0.0;

    float above_1 = (ray_2.height_m - height_m_1);
    if ((ray_2.curvature_per_m > 0.0)) {
        float discriminant = ((ray_2.sin_elevation * ray_2.sin_elevation) - ((4.0 * ray_2.curvature_per_m) * above_1));
        if ((discriminant > 0.0)) {
            float root = sqrt(discriminant);
            float q = (-0.5 * (ray_2.sin_elevation + ((ray_2.sin_elevation >= 0.0) ? root : -(root))));
            float a_2 = (q / ray_2.curvature_per_m);
            float b_2 = (above_1 / q);
            first = min(a_2, b_2);
            last = max(a_2, b_2);
        }
    } else {
        if ((ray_2.sin_elevation == 0.0)) {
            last = ((above_1 < 0.0) ? ray_2.length_m : 0.0);
        } else {
            if ((ray_2.sin_elevation > 0.0)) {
                last = (-(above_1) / ray_2.sin_elevation);
            } else {
                first = (above_1 / -(ray_2.sin_elevation));
                last = ray_2.length_m;
            }
        }
    }
    float _e54 = first;
    first = max(_e54, 0.0);
    float _e57 = last;
    last = min(_e57, ray_2.length_m);
    float _e62 = first;
    float _e63 = last;
    float _e65 = last;
    float _e66 = first;
    return ((_e65 > _e66) ? float2(_e62, _e63) : (0.0).xx);
}

// Density that has decayed over `heights` scale heights (negative: increased).
// Cost: 1 exp.
float decayed(float heights)
{
    return exp(min(-(heights), LARGEST_LN_DENSITY));
}

// `int_0^length e^-(a s + b s^2) ds` for `a` not negative and `b` above 0.
// Cost: 4 exp.
float falling_column_m(float a_1, float b_1, float length_m_1)
{
    float fall = (length_m_1 * (a_1 + (b_1 * length_m_1)));
    if ((fall < 0.5)) {
        float s1_ = (0.06943184 * length_m_1);
        float s2_ = (0.3300095 * length_m_1);
        float s3_ = (0.66999054 * length_m_1);
        float s4_ = (0.93056816 * length_m_1);
        float outer = (exp((-(s1_) * (a_1 + (b_1 * s1_)))) + exp((-(s4_) * (a_1 + (b_1 * s4_)))));
        float inner = (exp((-(s2_) * (a_1 + (b_1 * s2_)))) + exp((-(s3_) * (a_1 + (b_1 * s3_)))));
        return (length_m_1 * ((0.17392743 * outer) + (0.32607257 * inner)));
    }
    float root_1 = sqrt(b_1);
    float near_3 = ((0.5 * a_1) / root_1);
    const float _e52 = scaled_erfc((near_3 + (root_1 * length_m_1)));
    float far_3 = (exp(-(fall)) * _e52);
    const float _e56 = scaled_erfc(near_3);
    return ((0.88622695 / root_1) * (_e56 - far_3));
}

// Column of the density `e^-((height - reference_height_m) / scale_height_m)` along a ray over flat ground: height fog (Ishiyama 2018, eqs. 14 and 23). Level rays and infinite ones included; at most `OPAQUE`.
// Cost: 2 exp.
float flat_exponential_column_m(float height_m_2, float sin_elevation_1, float length_m_2, float reference_height_m, float scale_height_m)
{
    float rise = ((sin_elevation_1 * length_m_2) / scale_height_m);
    float densest = (((height_m_2 - reference_height_m) / scale_height_m) + min(rise, 0.0));
    const float _e12 = decayed(densest);
    const float _e14 = mean_transmittance(abs(rise));
    return min((_e12 * (length_m_2 * _e14)), OPAQUE);
}

// `flat_exponential_column_m` over flat or round ground: height fog, or a gas.
// Cost: 9 exp; over flat ground 2.
float exponential_column_m(RaySegment ray_3, float reference_height_m_1, float scale_height_m_1)
{
    float column = 0.0;

    float length_ = ray_3.length_m;
    if ((ray_3.curvature_per_m <= 0.0)) {
        const float _e9 = flat_exponential_column_m(ray_3.height_m, ray_3.sin_elevation, length_, reference_height_m_1, scale_height_m_1);
        return _e9;
    }
    float slope = (ray_3.sin_elevation / scale_height_m_1);
    float curvature = (ray_3.curvature_per_m / scale_height_m_1);
    float start = ((ray_3.height_m - reference_height_m_1) / scale_height_m_1);
    float lowest = clamp(((-0.5 * slope) / curvature), 0.0, length_);
    float densest_1 = (start + (lowest * (slope + (lowest * curvature))));
    float back = max(-((slope + ((2.0 * curvature) * lowest))), 0.0);
    float ahead = max((slope + ((2.0 * curvature) * lowest)), 0.0);
    if ((lowest > 0.0)) {
        float _e43 = column;
        const float _e44 = falling_column_m(back, curvature, lowest);
        column = (_e43 + _e44);
    }
    if ((lowest < length_)) {
        float _e47 = column;
        const float _e49 = falling_column_m(ahead, curvature, (length_ - lowest));
        column = (_e47 + _e49);
    }
    const float _e51 = decayed(densest_1);
    float _e52 = column;
    return min((_e51 * _e52), OPAQUE);
}

// Column of a density that is 1 up to the base and falls exponentially above it, `e^-(max(0, height - base) / scale)`, along a ray over flat ground: the height fog after Wenzel, split where the ray crosses the base.
// Cost: 2 exp.
float flat_clamped_column_m(float height_m_3, float sin_elevation_2, float length_m_3, float base_height_m, float scale_height_m_2)
{
    const float2 _e7 = below_height(ConstructRaySegment(height_m_3, sin_elevation_2, 0.0, length_m_3), base_height_m);
    float below_m = (_e7.y - _e7.x);
    if ((below_m <= 0.0)) {
        const float _e13 = flat_exponential_column_m(height_m_3, sin_elevation_2, length_m_3, base_height_m, scale_height_m_2);
        return _e13;
    }
    float beyond_m = (length_m_3 - below_m);
    const float _e18 = flat_exponential_column_m(0.0, abs(sin_elevation_2), beyond_m, 0.0, scale_height_m_2);
    return min((below_m + _e18), OPAQUE);
}

// `flat_clamped_column_m` over flat or round ground.
// Cost: 18 exp; over flat ground 2.
float clamped_column_m(RaySegment ray_4, float base_height_m_1, float scale_height_m_3)
{
    float column_1 = (float)0;

    if ((ray_4.curvature_per_m <= 0.0)) {
        const float _e9 = flat_clamped_column_m(ray_4.height_m, ray_4.sin_elevation, ray_4.length_m, base_height_m_1, scale_height_m_3);
        return _e9;
    }
    const float2 _e10 = below_height(ray_4, base_height_m_1);
    if ((_e10.x == _e10.y)) {
        const float _e14 = exponential_column_m(ray_4, base_height_m_1, scale_height_m_3);
        return _e14;
    }
    column_1 = (_e10.y - _e10.x);
    if ((_e10.x > 0.0)) {
        float _e22 = column_1;
        const RaySegment _e25 = ray_part(ray_4, 0.0, _e10.x);
        const float _e26 = exponential_column_m(_e25, base_height_m_1, scale_height_m_3);
        column_1 = (_e22 + _e26);
    }
    if ((_e10.y < ray_4.length_m)) {
        float _e31 = column_1;
        const RaySegment _e34 = ray_part(ray_4, _e10.y, ray_4.length_m);
        const float _e35 = exponential_column_m(_e34, base_height_m_1, scale_height_m_3);
        column_1 = (_e31 + _e35);
    }
    float _e37 = column_1;
    return min(_e37, OPAQUE);
}

// Column of a density that is 1 from `bottom_m` to `top_m` and 0 elsewhere. Only a ray that grazes an edge over round ground has an error above 1e-2 m.
// Cost: no exp.
float layer_column_m(RaySegment ray_5, float bottom_m, float top_m)
{
    float down = (float)0;
    float up = (float)0;
    bool local = (bool)0;

    const float2 _e3 = below_height(ray_5, top_m);
    const float2 _e4 = below_height(ray_5, bottom_m);
    if ((_e4.x == _e4.y)) {
        return (_e3.y - _e3.x);
    }
    float thickness = (top_m - bottom_m);
    down = max((_e4.x - _e3.x), 0.0);
    if ((_e3.x > 0.0)) {
        down = (-(thickness) / (ray_5.sin_elevation + (ray_5.curvature_per_m * (_e3.x + _e4.x))));
    }
    up = max((_e3.y - _e4.y), 0.0);
    if ((_e3.y < ray_5.length_m)) {
        local = (_e4.y < ray_5.length_m);
    } else {
        local = false;
    }
    bool _e45 = local;
    if (_e45) {
        up = (thickness / (ray_5.sin_elevation + (ray_5.curvature_per_m * (_e3.y + _e4.y))));
    }
    float _e54 = down;
    float _e55 = up;
    return (_e54 + _e55);
}

// Column of the exponential profile above a height, m.
// Cost: 1 exp.
float exponential_column_above_m(float height_m_4, float reference_height_m_2, float scale_height_m_4)
{
    const float _e5 = decayed(((height_m_4 - reference_height_m_2) / scale_height_m_4));
    return (scale_height_m_4 * _e5);
}

// Column of the clamped profile above a height, m.
// Cost: 1 exp.
float clamped_column_above_m(float height_m_5, float base_height_m_2, float scale_height_m_5)
{
    const float _e10 = decayed((max((height_m_5 - base_height_m_2), 0.0) / scale_height_m_5));
    return (max((base_height_m_2 - height_m_5), 0.0) + (scale_height_m_5 * _e10));
}

// Fog of any profile along a column (m), with sunlight that the fog does not attenuate on its way to the ray: Ishiyama 2018 as printed, eqs. 22 and 23. Correct in thin fog; in dense fog up to three times as bright as all orders of scattering.
// Cost: 6 exp.
PathOptics fog_undimmed(FogMedium medium, float column_m, FogLight light)
{
    float3 depth_3 = (medium.extinction_per_m * column_m);
    const float3 _e5 = mean_transmittance_rgb(depth_3);
    float3 opacity_1 = (_e5 * column_m);
    const PathOptics pathoptics_2 = ConstructPathOptics(exp(-(depth_3)), ((medium.scattering_per_m * (light.sunlight + light.ambient)) * opacity_1));
    return pathoptics_2;
}

// Fog of one profile over flat ground, with sunlight attenuated by the fog above the ray: exact for single scattering. The columns (m) are those of the ray, and those from its start and its end to the sun (the column above divided by `sin_sun`).
// Cost: 12 exp.
PathOptics fog_single_scattering(FogMedium medium_1, float column_m_1, float to_sun_near_m, float to_sun_far_m, FogLight light_1)
{
    float3 depth_4 = (medium_1.extinction_per_m * column_m_1);
    float3 near_4 = (medium_1.extinction_per_m * to_sun_near_m);
    float3 far_4 = (medium_1.extinction_per_m * (to_sun_far_m + column_m_1));
    const float3 _e13 = mean_attenuated_source_rgb(near_4, far_4);
    float3 sunlit_2 = (light_1.sunlight * _e13);
    const float3 _e16 = mean_transmittance_rgb(depth_4);
    float3 ambient = (light_1.ambient * _e16);
    const PathOptics pathoptics_3 = ConstructPathOptics(exp(-(depth_4)), (medium_1.scattering_per_m * ((sunlit_2 + ambient) * column_m_1)));
    return pathoptics_3;
}

// Uniform fog over a distance (m). It has no upper end, so sunlight is not attenuated.
// Cost: 6 exp.
PathOptics uniform_fog(FogMedium medium_2, float length_m_4, FogLight light_2)
{
    const PathOptics _e3 = fog_undimmed(medium_2, length_m_4, light_2);
    const PathOptics pathoptics_4 = _e3;
    return pathoptics_4;
}

// Column between a height and the sun over flat ground, m, from the column above that height; `OPAQUE` if the sun is down.
// Cost: no exp.
float column_to_sun_m(float column_above_m, float sin_sun)
{
    return ((sin_sun > 0.0) ? min((min(column_above_m, OPAQUE) / max(sin_sun, 1e-12)), OPAQUE) : OPAQUE);
}

// Exponential height fog over flat ground, with unattenuated sunlight: Ishiyama 2018 as printed, without its 0/0 on level rays.
// Cost: 8 exp.
PathOptics exponential_fog_undimmed(FogMedium medium_3, float height_m_6, float sin_elevation_3, float length_m_5, float reference_height_m_3, float scale_height_m_6, FogLight light_3)
{
    const float _e7 = flat_exponential_column_m(height_m_6, sin_elevation_3, length_m_5, reference_height_m_3, scale_height_m_6);
    const PathOptics _e8 = fog_undimmed(medium_3, _e7, light_3);
    const PathOptics pathoptics_5 = _e8;
    return pathoptics_5;
}

// Exponential height fog over flat ground, with sunlight that the fog above attenuates.
// Cost: 16 exp.
PathOptics exponential_fog(FogMedium medium_4, float height_m_7, float sin_elevation_4, float length_m_6, float reference_height_m_4, float scale_height_m_7, FogLight light_4)
{
    const float _e7 = flat_exponential_column_m(height_m_7, sin_elevation_4, length_m_6, reference_height_m_4, scale_height_m_7);
    float end_height_m = (height_m_7 + (sin_elevation_4 * length_m_6));
    const float _e10 = exponential_column_above_m(height_m_7, reference_height_m_4, scale_height_m_7);
    const float _e11 = exponential_column_above_m(end_height_m, reference_height_m_4, scale_height_m_7);
    const float _e13 = column_to_sun_m(_e10, light_4.sin_sun);
    const float _e15 = column_to_sun_m(_e11, light_4.sin_sun);
    const PathOptics _e16 = fog_single_scattering(medium_4, _e7, _e13, _e15, light_4);
    const PathOptics pathoptics_6 = _e16;
    return pathoptics_6;
}

// Fog that is uniform up to the base and thins exponentially above it (after Wenzel), over flat ground, with sunlight that the fog above attenuates.
// Cost: 16 exp.
PathOptics clamped_fog(FogMedium medium_5, float height_m_8, float sin_elevation_5, float length_m_7, float base_height_m_3, float scale_height_m_8, FogLight light_5)
{
    const float _e7 = flat_clamped_column_m(height_m_8, sin_elevation_5, length_m_7, base_height_m_3, scale_height_m_8);
    float end_height_m_1 = (height_m_8 + (sin_elevation_5 * length_m_7));
    const float _e10 = clamped_column_above_m(height_m_8, base_height_m_3, scale_height_m_8);
    const float _e11 = clamped_column_above_m(end_height_m_1, base_height_m_3, scale_height_m_8);
    const float _e13 = column_to_sun_m(_e10, light_5.sin_sun);
    const float _e15 = column_to_sun_m(_e11, light_5.sin_sun);
    const PathOptics _e16 = fog_single_scattering(medium_5, _e7, _e13, _e15, light_5);
    const PathOptics pathoptics_7 = _e16;
    return pathoptics_7;
}

// Column of a layer along a ray, m.
// Cost: 18 exp; over flat ground 2.
float fog_layer_column_m(FogLayer layer, RaySegment ray_6)
{
    switch(layer.profile) {
        case 1u: {
            const float _e5 = exponential_column_m(ray_6, layer.height_m, layer.scale_m);
            return _e5;
        }
        case 2u: {
            const float _e8 = clamped_column_m(ray_6, layer.height_m, layer.scale_m);
            return _e8;
        }
        case 3u: {
            const float _e13 = layer_column_m(ray_6, layer.height_m, (layer.height_m + layer.scale_m));
            return _e13;
        }
        default: {
            return ray_6.length_m;
        }
    }
}

// Optical depth of all layers along a ray, exact over flat and round ground.
// Cost: 18 exp a step.
float3 fog_optical_depth(FogLayers fog, RaySegment ray_7)
{
    float3 depth = (0.0).xxx;
    uint i = 0u;

    bool loop_init = true;
    while(true) {
        if (!loop_init) {
            uint _e20 = i;
            i = (_e20 + 1u);
        }
        loop_init = false;
        uint _e7 = i;
        if ((_e7 < min(fog.count, 4u))) {
        } else {
            break;
        }
        {
            uint _e13 = i;
            FogLayer layer_2 = fog.layers[_e13];
            float3 _e15 = depth;
            const float _e17 = fog_layer_column_m(layer_2, ray_7);
            depth = (_e15 + (layer_2.extinction_per_m * _e17));
        }
    }
    float3 _e23 = depth;
    return _e23;
}

// Optical depth of all layers between a height and the sun. Uniform layers are ignored, as they would block all light; `OPAQUE` where the ground hides the sun.
// Cost: 18 exp a step.
float3 fog_depth_to_sun(FogLayers fog_1, float height_m_9)
{
    bool local_1 = (bool)0;
    bool local_2 = (bool)0;
    bool local_3 = (bool)0;
    bool local_4 = (bool)0;
    float3 depth_1 = (0.0).xxx;
    uint i_1 = 0u;

    const RaySegment _e6 = ray_segment(height_m_9, fog_1.light.sin_sun, INFINITE_M, fog_1.inverse_radius_per_m);
    if ((_e6.curvature_per_m > 0.0)) {
        local_1 = (_e6.sin_elevation < 0.0);
    } else {
        local_1 = false;
    }
    bool dips = local_1;
    float lowest_m = (height_m_9 - (((0.25 * _e6.sin_elevation) * _e6.sin_elevation) / max(_e6.curvature_per_m, 1e-30)));
    if ((_e6.curvature_per_m <= 0.0)) {
        local_2 = (_e6.sin_elevation <= 0.0);
    } else {
        local_2 = false;
    }
    bool _e36 = local_2;
    if (!(_e36)) {
        if (dips) {
            local_4 = (lowest_m < fog_1.ground_height_m);
        } else {
            local_4 = false;
        }
        bool _e45 = local_4;
        local_3 = _e45;
    } else {
        local_3 = true;
    }
    bool _e47 = local_3;
    if (_e47) {
        return (1e25).xxx;
    }
    bool loop_init_1 = true;
    while(true) {
        if (!loop_init_1) {
            uint _e71 = i_1;
            i_1 = (_e71 + 1u);
        }
        loop_init_1 = false;
        uint _e55 = i_1;
        if ((_e55 < min(fog_1.count, 4u))) {
        } else {
            break;
        }
        {
            uint _e61 = i_1;
            FogLayer layer_3 = fog_1.layers[_e61];
            if ((layer_3.profile != FOG_UNIFORM)) {
                float3 _e66 = depth_1;
                const float _e68 = fog_layer_column_m(layer_3, _e6);
                depth_1 = (_e66 + (layer_3.extinction_per_m * _e68));
            }
        }
    }
    float3 _e74 = depth_1;
    return _e74;
}

typedef float ret_Constructarray14_float_[14];
ret_Constructarray14_float_ Constructarray14_float_(float arg0, float arg1, float arg2, float arg3, float arg4, float arg5, float arg6, float arg7, float arg8, float arg9, float arg10, float arg11, float arg12, float arg13) {
    float ret[14] = { arg0, arg1, arg2, arg3, arg4, arg5, arg6, arg7, arg8, arg9, arg10, arg11, arg12, arg13 };
    return ret;
}

// The nearest height above (`rising`) or below a level at which `layered_fog` splits a ray because of a layer; 1e30 times the direction if there is none. Exponential decays have steps that are dense where most of the fog is.
// Cost: no exp.
float next_fog_break_m(FogLayer layer_1, float level_m, bool rising, float ground_height_m)
{
    float steps[14] = Constructarray14_float_(0.0, 0.12, 0.25, 0.4, 0.57, 0.77, 1.0, 1.3, 1.65, 2.1, 2.7, 3.5, 5.0, 8.0);
    float from_m_1 = (float)0;
    int count = int(14);
    float nearest = (float)0;
    int i_2 = int(0);
    bool local_5 = (bool)0;
    bool local_6 = (bool)0;

    from_m_1 = layer_1.height_m;
    if ((layer_1.profile == FOG_UNIFORM)) {
        count = int(0);
    } else {
        if ((layer_1.profile == FOG_SLAB)) {
            steps[1] = 1.0;
            count = int(2);
        } else {
            if ((layer_1.profile == FOG_EXPONENTIAL)) {
                from_m_1 = ground_height_m;
            } else {
                from_m_1 = max(layer_1.height_m, ground_height_m);
            }
        }
    }
    nearest = (rising ? 1e30 : -1e30);
    bool loop_init_2 = true;
    while(true) {
        if (!loop_init_2) {
            int _e73 = i_2;
            i_2 = asint(asuint(_e73) + asuint(int(1)));
        }
        loop_init_2 = false;
        int _e45 = i_2;
        int _e46 = count;
        if ((_e45 < _e46)) {
        } else {
            break;
        }
        {
            float _e48 = from_m_1;
            int _e49 = i_2;
            float _e51 = steps[_e49];
            float height = (_e48 + (_e51 * layer_1.scale_m));
            if (rising) {
                float _e55 = nearest;
                if ((height > level_m)) {
                    float _e59 = nearest;
                    local_5 = (height < _e59);
                } else {
                    local_5 = false;
                }
                bool _e62 = local_5;
                nearest = (_e62 ? height : _e55);
            } else {
                float _e64 = nearest;
                if ((height < level_m)) {
                    float _e68 = nearest;
                    local_6 = (height > _e68);
                } else {
                    local_6 = false;
                }
                bool _e71 = local_6;
                nearest = (_e71 ? height : _e64);
            }
        }
    }
    float _e76 = nearest;
    return _e76;
}

// Several layers of fog, over flat or round ground. The ray is split at heights, and between them all layers count as one: single scattering of sunlight and ambient light within 0.2 % of exact over flat ground, 1 % over round ground.
// Cost: 3 exp, 84 exp a step; over flat ground 9 a step and 4 a layer.
PathOptics layered_fog(FogLayers fog_2, RaySegment ray_8)
{
    float3 before = (0.0).xxx;
    float3 radiance_1 = (0.0).xxx;
    float at_m = 0.0;
    float level_m_1 = (float)0;
    float3 to_sun = (float3)0;
    bool local_7 = (bool)0;
    bool local_8 = (bool)0;
    bool rising_1 = (bool)0;
    int step_ = int(0);
    float next_level_m = (float)0;
    uint i_3 = (uint)0;
    float end_m = (float)0;
    bool local_9 = (bool)0;
    bool local_10 = (bool)0;
    float3 along_1 = (float3)0;
    float3 sunlit = (float3)0;
    float3 scattered = (float3)0;
    uint i_4 = (uint)0;
    bool local_11 = (bool)0;

    uint count_3 = min(fog_2.count, 4u);
    level_m_1 = ray_8.height_m;
    float _e15 = level_m_1;
    const float3 _e16 = fog_depth_to_sun(fog_2, _e15);
    to_sun = _e16;
    float dip_m = ((ray_8.curvature_per_m > 0.0) ? ((-0.5 * ray_8.sin_elevation) / max(ray_8.curvature_per_m, 1e-30)) : 0.0);
    if (!((ray_8.sin_elevation > 0.0))) {
        if ((ray_8.sin_elevation == 0.0)) {
            local_8 = (ray_8.curvature_per_m > 0.0);
        } else {
            local_8 = false;
        }
        bool _e45 = local_8;
        local_7 = _e45;
    } else {
        local_7 = true;
    }
    bool _e47 = local_7;
    rising_1 = _e47;
    bool loop_init_3 = true;
    while(true) {
        if (!loop_init_3) {
            int _e205 = step_;
            step_ = asint(asuint(_e205) + asuint(int(1)));
        }
        loop_init_3 = false;
        int _e51 = step_;
        if ((_e51 < int(124))) {
        } else {
            break;
        }
        {
            float _e54 = at_m;
            if ((_e54 >= ray_8.length_m)) {
                break;
            }
            bool _e57 = rising_1;
            next_level_m = (_e57 ? 1e30 : -1e30);
            i_3 = 0u;
            bool loop_init_4 = true;
            while(true) {
                if (!loop_init_4) {
                    uint _e79 = i_3;
                    i_3 = (_e79 + 1u);
                }
                loop_init_4 = false;
                uint _e64 = i_3;
                if ((_e64 < count_3)) {
                } else {
                    break;
                }
                {
                    uint _e67 = i_3;
                    float _e69 = level_m_1;
                    bool _e70 = rising_1;
                    const float _e72 = next_fog_break_m(fog_2.layers[_e67], _e69, _e70, fog_2.ground_height_m);
                    float _e73 = next_level_m;
                    float _e75 = next_level_m;
                    bool _e77 = rising_1;
                    next_level_m = (_e77 ? min(_e75, _e72) : max(_e73, _e72));
                }
            }
            end_m = ray_8.length_m;
            float _e84 = next_level_m;
            if ((abs(_e84) < 1e30)) {
                float _e88 = next_level_m;
                const float2 _e89 = below_height(ray_8, _e88);
                if ((_e89.y > _e89.x)) {
                    bool _e95 = rising_1;
                    end_m = (_e95 ? _e89.y : _e89.x);
                } else {
                    bool _e97 = rising_1;
                    if (_e97) {
                        float _e98 = at_m;
                        end_m = _e98;
                    }
                }
            }
            bool _e99 = rising_1;
            if (!(_e99)) {
                float _e103 = at_m;
                local_9 = (dip_m > _e103);
            } else {
                local_9 = false;
            }
            bool _e106 = local_9;
            if (_e106) {
                float _e109 = end_m;
                local_10 = (dip_m < _e109);
            } else {
                local_10 = false;
            }
            bool turns = local_10;
            if (turns) {
                end_m = dip_m;
            }
            float _e113 = end_m;
            float _e114 = at_m;
            if ((_e113 > _e114)) {
                float _e116 = at_m;
                float _e117 = end_m;
                const RaySegment _e118 = ray_part(ray_8, _e116, _e117);
                along_1 = (0.0).xxx;
                sunlit = (0.0).xxx;
                scattered = (0.0).xxx;
                i_4 = 0u;
                bool loop_init_5 = true;
                while(true) {
                    if (!loop_init_5) {
                        uint _e150 = i_4;
                        i_4 = (_e150 + 1u);
                    }
                    loop_init_5 = false;
                    uint _e130 = i_4;
                    if ((_e130 < count_3)) {
                    } else {
                        break;
                    }
                    {
                        uint _e133 = i_4;
                        FogLayer layer_4 = fog_2.layers[_e133];
                        const float _e135 = fog_layer_column_m(layer_4, _e118);
                        float3 _e136 = along_1;
                        along_1 = (_e136 + (layer_4.extinction_per_m * _e135));
                        float3 _e140 = sunlit;
                        sunlit = (_e140 + ((layer_4.scattering_per_m * layer_4.phase) * _e135));
                        float3 _e146 = scattered;
                        scattered = (_e146 + (layer_4.scattering_per_m * _e135));
                    }
                }
                float _e153 = end_m;
                const float _e154 = height_at(ray_8, _e153);
                const float3 _e155 = fog_depth_to_sun(fog_2, _e154);
                float3 _e158 = sunlit;
                float3 _e160 = to_sun;
                float3 _e161 = along_1;
                const float3 _e163 = mean_attenuated_source_rgb(_e160, (_e155 + _e161));
                float3 _e167 = scattered;
                float3 _e169 = along_1;
                const float3 _e170 = mean_transmittance_rgb(_e169);
                float3 arriving = (((fog_2.light.sunlight * _e158) * _e163) + ((fog_2.light.ambient * _e167) * _e170));
                float3 _e173 = radiance_1;
                float3 _e174 = before;
                radiance_1 = (_e173 + (exp(-(_e174)) * arriving));
                float3 _e179 = before;
                float3 _e180 = along_1;
                before = (_e179 + _e180);
                to_sun = _e155;
            }
            float _e182 = at_m;
            float _e183 = end_m;
            at_m = max(_e182, _e183);
            float _e185 = next_level_m;
            float _e186 = end_m;
            const float _e187 = height_at(ray_8, _e186);
            level_m_1 = (turns ? _e187 : _e185);
            bool _e189 = rising_1;
            if (!(_e189)) {
                local_11 = turns;
            } else {
                local_11 = true;
            }
            bool _e194 = local_11;
            rising_1 = _e194;
            float _e196 = before.x;
            float _e198 = before.y;
            float _e200 = before.z;
            if ((min(_e196, min(_e198, _e200)) > 40.0)) {
                break;
            }
        }
    }
    const float3 _e208 = fog_optical_depth(fog_2, ray_8);
    float3 _e211 = radiance_1;
    const PathOptics pathoptics_8 = ConstructPathOptics(exp(-(_e208)), _e211);
    return pathoptics_8;
}

// No fog: what a march starts with.
// Cost: no exp.
PathOptics no_fog()
{
    const PathOptics pathoptics_9 = ConstructPathOptics((1.0).xxx, (0.0).xxx);
    return pathoptics_9;
}

// Distance of a place from 0 to 1 along a segment, m, such that steps that are even in `place` have even shares of the light of uniform fog of this optical depth along the segment: short near the eye.
// Cost: 3 exp.
float shadow_edge_m(float place, float length_m_8, float optical_depth_1)
{
    if ((place >= 1.0)) {
        return length_m_8;
    }
    const float _e5 = mean_transmittance(optical_depth_1);
    float mean = (place * _e5);
    float u = (mean * optical_depth_1);
    float series_2 = (mean * (1.0 + (u * (0.5 + (u * (0.33333334 + (u * (0.25 + (u * 0.2)))))))));
    float direct_2 = (-(log(max(((1.0 - place) + (place * exp(-(optical_depth_1)))), 1e-30))) / max(optical_depth_1, 0.05));
    return (length_m_8 * min(((u < 0.05) ? series_2 : direct_2), 1.0));
}

// Part of a step that is in sunlight, 0 to 1, between heights above the surface of a shadow (or distances before a shadow caster) at its ends, negative in shadow and linear between: the edge of a shadow is found inside a step.
// Cost: no exp.
float lit_part(float from_clearance_m, float to_clearance_m)
{
    float least = min(from_clearance_m, to_clearance_m);
    float most = max(from_clearance_m, to_clearance_m);
    if ((least >= 0.0)) {
        return 1.0;
    }
    if ((most <= 0.0)) {
        return 0.0;
    }
    return (most / (most - least));
}

FogLight ConstructFogLight(float3 arg0, float arg1, float3 arg2) {
    FogLight ret = (FogLight)0;
    ret.sunlight = arg0;
    ret.sin_sun = arg1;
    ret.ambient = arg2;
    return ret;
}

// Light whose sun is visible in part, 0 to 1.
// Cost: no exp.
FogLight with_visibility(FogLight light_6, float visibility)
{
    const FogLight foglight = ConstructFogLight((light_6.sunlight * visibility), light_6.sin_sun, light_6.ambient);
    return foglight;
}

// A march in uniform fog with one step more, from which the sun is visible in part.
// Cost: 6 exp.
PathOptics shadowed_uniform_fog(PathOptics before_1, FogMedium medium_6, float from_m_2, float to_m_1, FogLight light_7, float visibility_1)
{
    const FogLight _e7 = with_visibility(light_7, visibility_1);
    const PathOptics _e8 = uniform_fog(medium_6, (to_m_1 - from_m_2), _e7);
    const PathOptics _e9 = near_then_far(before_1, _e8);
    const PathOptics pathoptics_10 = _e9;
    return pathoptics_10;
}

// A march in exponential height fog over flat ground with one step more, from which the sun is visible in part. The fog above the ray attenuates sunlight.
// Cost: 16 exp.
PathOptics shadowed_exponential_fog(PathOptics before_2, FogMedium medium_7, float height_m_10, float sin_elevation_6, float from_m_3, float to_m_2, float reference_height_m_5, float scale_height_m_9, FogLight light_8, float visibility_2)
{
    const FogLight _e13 = with_visibility(light_8, visibility_2);
    const PathOptics _e14 = exponential_fog(medium_7, (height_m_10 + (sin_elevation_6 * from_m_3)), sin_elevation_6, (to_m_2 - from_m_3), reference_height_m_5, scale_height_m_9, _e13);
    const PathOptics _e15 = near_then_far(before_2, _e14);
    const PathOptics pathoptics_11 = _e15;
    return pathoptics_11;
}

// Length of a ray in the air, m: up to the ground, the top of the air or its own end. 0 for an eye below the ground. Only a ray that grazes the ground has an error above 1 m.
// Cost: no exp.
float air_length_m(AirMedium air, RaySegment ray_9)
{
    const float2 _e3 = below_height(ray_9, 0.0);
    const float2 _e5 = below_height(ray_9, air.top_m);
    return ((_e3.y > _e3.x) ? _e3.x : _e5.y);
}

// Columns of molecules (x), haze (y) and ozone (z) along a ray, m. Only a ray that grazes an edge of the ozone has an error above 1e-2 m.
// Cost: 18 exp.
float3 air_columns_m(AirMedium air_1, RaySegment ray_10)
{
    const float _e4 = exponential_column_m(ray_10, 0.0, air_1.molecules_scale_m);
    const float _e7 = exponential_column_m(ray_10, 0.0, air_1.haze_scale_m);
    const float _e10 = layer_column_m(ray_10, air_1.ozone_bottom_m, air_1.ozone_top_m);
    return float3(_e4, _e7, _e10);
}

// Optical depth of columns of `air_columns_m`.
// Cost: no exp.
float3 air_optical_depth(AirMedium air_2, float3 columns_m)
{
    return (((air_2.molecules_per_m * columns_m.x) + (air_2.haze_extinction_per_m * columns_m.y)) + (air_2.ozone_per_m * columns_m.z));
}

// Sine of the sun's elevation after `s_m` metres of a ray, where the vertical is another than at its start.
// Cost: no exp.
float sin_sun_along(AirMedium air_3, RaySegment ray_11, float s_m_1, AirLight light_9)
{
    float k_1 = air_3.inverse_radius_per_m;
    const float _e15 = height_at(ray_11, s_m_1);
    float sine_1 = (((light_9.sin_sun * (1.0 + (k_1 * ray_11.height_m))) + ((k_1 * s_m_1) * light_9.cos_to_sun)) / (1.0 + (k_1 * _e15)));
    return clamp(sine_1, -1.0, 1.0);
}

// Clearance of the way from a height to the sun: negative if the planet hides the sun. It is the height of the lowest point of the way times `2 / R` and the squared cosine of the sun's elevation.
// Cost: no exp.
float sun_clearance(AirMedium air_4, float height_m_11, float sin_sun_1)
{
    float sine_2 = min(sin_sun_1, 0.0);
    return (((((2.0 * air_4.inverse_radius_per_m) * height_m_11) * (1.0 - sine_2)) * (1.0 + sine_2)) - (sine_2 * sine_2));
}

// Optical depth from a height to the sun, or to where it sets if the planet hides it.
// Cost: 18 exp.
float3 air_depth_to_sun(AirMedium air_5, float height_m_12, float sin_sun_2)
{
    float above_m = max(height_m_12, 0.0);
    float dip = ((2.0 * above_m) * air_5.inverse_radius_per_m);
    float sine_3 = max(sin_sun_2, -(sqrt((dip / (1.0 + dip)))));
    const RaySegment _e17 = ray_segment(above_m, sine_3, INFINITE_M, air_5.inverse_radius_per_m);
    const float3 _e18 = air_columns_m(air_5, _e17);
    const float3 _e19 = air_optical_depth(air_5, _e18);
    return _e19;
}

AirMarch ConstructAirMarch(PathOptics arg0, float arg1, float3 arg2, float arg3) {
    AirMarch ret = (AirMarch)0;
    ret.path = arg0;
    ret.end_m = arg1;
    ret.depth_to_sun = arg2;
    ret.clearance = arg3;
    return ret;
}

// A march at the start of a ray.
// Cost: 18 exp.
AirMarch air_march(AirMedium air_6, RaySegment ray_12, AirLight light_10)
{
    const float3 _e5 = air_depth_to_sun(air_6, ray_12.height_m, light_10.sin_sun);
    const PathOptics _e6 = no_fog();
    const float _e9 = sun_clearance(air_6, ray_12.height_m, light_10.sin_sun);
    const AirMarch airmarch = ConstructAirMarch(_e6, 0.0, _e5, _e9);
    return airmarch;
}

// A march with one step more, to a distance, m. From the step the sun is visible in part, 0 to 1, apart from the planet, which hides it by itself.
// Cost: 45 exp.
AirMarch air_march_step(AirMarch march, AirMedium air_7, RaySegment ray_13, float to_m_3, AirLight light_11, float visibility_3)
{
    const RaySegment _e7 = ray_part(ray_13, march.end_m, to_m_3);
    const float3 _e8 = air_columns_m(air_7, _e7);
    const float3 _e9 = air_optical_depth(air_7, _e8);
    float3 scattered_1 = ((air_7.molecules_per_m * (_e8.x * light_11.molecules_phase)) + (air_7.haze_scattering_per_m * (_e8.y * light_11.haze_phase)));
    const float _e21 = height_at(ray_13, to_m_3);
    const float _e22 = sin_sun_along(air_7, ray_13, to_m_3, light_11);
    const float3 _e23 = air_depth_to_sun(air_7, _e21, _e22);
    const float _e24 = sun_clearance(air_7, _e21, _e22);
    const float _e26 = lit_part(march.clearance, _e24);
    float lit_ = (visibility_3 * _e26);
    const float3 _e32 = mean_attenuated_source_rgb(march.depth_to_sun, (_e23 + _e9));
    float3 arriving_1 = ((light_11.sunlight * lit_) * _e32);
    const PathOptics _e39 = near_then_far(march.path, ConstructPathOptics(exp(-(_e9)), (scattered_1 * arriving_1)));
    const AirMarch airmarch_1 = ConstructAirMarch(_e39, to_m_3, _e23, _e24);
    return airmarch_1;
}

LocalLight ConstructLocalLight(float3 arg0, uint arg1, float3 arg2, float arg3, float3 arg4, float arg5, float arg6) {
    LocalLight ret = (LocalLight)0;
    ret.position = arg0;
    ret.kind = arg1;
    ret.intensity = arg2;
    ret.radius_m = arg3;
    ret.axis = arg4;
    ret.cos_inner = arg5;
    ret.cos_outer = arg6;
    return ret;
}

// A point light.
// Cost: no exp.
LocalLight point_light(float3 position, float radius_m, float3 intensity)
{
    const LocalLight locallight = ConstructLocalLight(position, LIGHT_POINT, intensity, radius_m, (0.0).xxx, 0.0, 0.0);
    return locallight;
}

// A spot light, whose intensity falls between the inner and the outer angle as in glTF's `KHR_lights_punctual`. Cosines that differ by less than 1e-6 count as 1e-6 apart.
// Cost: no exp.
LocalLight spot_light(float3 position_1, float radius_m_1, float3 intensity_1, float3 axis, float cos_inner, float cos_outer)
{
    const LocalLight locallight_1 = ConstructLocalLight(position_1, LIGHT_SPOT, intensity_1, radius_m_1, axis, cos_inner, cos_outer);
    return locallight_1;
}

// A sphere light. Rays that hit it end there.
// Cost: no exp.
LocalLight sphere_light(float3 position_2, float radius_m_2, float3 radiance_2)
{
    float3 intensity_2 = (((3.1415927 * radius_m_2) * radius_m_2) * radiance_2);
    const LocalLight locallight_2 = ConstructLocalLight(position_2, LIGHT_SPHERE, intensity_2, radius_m_2, (0.0).xxx, 0.0, 0.0);
    return locallight_2;
}

LightRayGeometry ConstructLightRayGeometry(float arg0, float arg1, float arg2) {
    LightRayGeometry ret = (LightRayGeometry)0;
    ret.nearest_m = arg0;
    ret.start_m = arg1;
    ret.length_m = arg2;
    return ret;
}

// A segment past a light, from which it is at least `at_least_m` away.
// Cost: no exp.
LightRayGeometry light_ray_geometry(float3 eye, float3 direction, float length_m_9, float3 light_12, float at_least_m)
{
    float3 to_light = (light_12 - eye);
    const LightRayGeometry lightraygeometry = ConstructLightRayGeometry(max(length(cross(to_light, direction)), at_least_m), -(dot(to_light, direction)), length_m_9);
    return lightraygeometry;
}

// Distance from the light at a place, m.
// Cost: no exp.
float light_distance_m(float nearest_m, float place_m)
{
    return sqrt(((nearest_m * nearest_m) + (place_m * place_m)));
}

// Distance from the light plus the place, m, without cancellation.
// Cost: no exp.
float light_ahead_m(float nearest_m_1, float place_m_1)
{
    const float _e2 = light_distance_m(nearest_m_1, place_m_1);
    float far_5 = (_e2 + abs(place_m_1));
    return ((place_m_1 < 0.0) ? (nearest_m_1 * (nearest_m_1 / far_5)) : far_5);
}

// Excess of the end: by how much the path from the start to the end and on to the light is longer than from the start to the light, m.
// Cost: no exp.
float light_excess_m(LightRayGeometry geometry)
{
    float h = geometry.nearest_m;
    float end_2 = (geometry.start_m + geometry.length_m);
    const float _e6 = light_ahead_m(h, geometry.start_m);
    const float _e7 = light_ahead_m(h, end_2);
    float ahead_1 = (_e6 + _e7);
    const float _e11 = light_distance_m(h, geometry.start_m);
    const float _e12 = light_distance_m(h, end_2);
    return (geometry.length_m * (ahead_1 / (_e11 + _e12)));
}

// Angle that the segment subtends at the light, 0 to pi.
// Cost: no exp.
float light_angle(LightRayGeometry geometry_1)
{
    float h_1 = geometry_1.nearest_m;
    float u_1 = geometry_1.start_m;
    return atan2((h_1 * geometry_1.length_m), ((h_1 * h_1) + (u_1 * (u_1 + geometry_1.length_m))));
}

// Radiance scattered from a point light of unit intensity by uniform fog of unit scattering coefficient that scatters equally in all directions, 1/m, without extinction: `angle / (4 pi h)` (after Macklin 2010, corrected).
// Cost: no exp.
float airlight_without_extinction(LightRayGeometry geometry_2)
{
    const float _e1 = light_angle(geometry_2);
    return ((_e1 * 0.07957747) / geometry_2.nearest_m);
}

typedef float ret_Constructarray4_float_[4];
ret_Constructarray4_float_ Constructarray4_float_(float arg0, float arg1, float arg2, float arg3) {
    float ret[4] = { arg0, arg1, arg2, arg3 };
    return ret;
}

// Place (x) and weight (y) of a node on the unit interval.
// Cost: no exp.
float2 light_gauss_node(uint i_5)
{
    float places[4] = Constructarray4_float_(0.019855073, 0.10166676, 0.23723379, 0.40828267);
    float weights[4] = Constructarray4_float_(0.050614268, 0.11119052, 0.15685332, 0.18134189);

    uint k_2 = min(i_5, (7u - min(i_5, 7u)));
    float _e19 = places[k_2];
    float _e21 = places[k_2];
    float _e28 = weights[k_2];
    return float2(((i_5 > 3u) ? (1.0 - _e21) : _e19), _e28);
}

// Interval of `q` that nodes cover: from 1 down to 1 minus this, where the excess is `scale (1 - q^3) / q^3`, from 0 to `end`.
// Cost: 1 exp.
float light_node_span(float scale_m, float end_m_1)
{
    float inverse = min((scale_m / max(end_m_1, 1e-30)), 1e30);
    float covered = (1.0 / (1.0 + inverse));
    float last_1 = pow(max((inverse * covered), 1e-30), 0.33333334);
    return (covered / ((1.0 + last_1) + (last_1 * last_1)));
}

// Excess (x) and step (y) of a node, m.
// Cost: no exp.
float2 light_node(uint i_6, float scale_m_1, float span)
{
    const float2 _e3 = light_gauss_node(i_6);
    float z_1 = (span * _e3.x);
    float q_1 = (1.0 - z_1);
    float p = ((q_1 * q_1) * q_1);
    return float2((((scale_m_1 * z_1) * ((3.0 - (3.0 * z_1)) + (z_1 * z_1))) / p), ((((3.0 * _e3.y) * span) * scale_m_1) / (q_1 * p)));
}

// `airlight_without_extinction` with extinction between light, fog and eye (1/m): the integral of Sun, Ramamoorthi, Narasimhan and Nayar (2005) by quadrature with 8 nodes.
// Cost: 6 exp, 3 exp a step; 8 steps.
float3 airlight_isotropic(LightRayGeometry geometry_3, float3 extinction_per_m)
{
    float3 sum = (0.0).xxx;
    uint i_7 = 0u;

    float h_2 = geometry_3.nearest_m;
    const float _e4 = light_ahead_m(h_2, geometry_3.start_m);
    const float _e5 = light_distance_m(h_2, _e4);
    float spread = ((2.0 * _e4) / _e5);
    float3 x_5 = (extinction_per_m * _e5);
    const float _e10 = light_excess_m(geometry_3);
    float3 inverse_1 = max((min((_e5 / max(_e10, 1e-30)), 1e30)).xxx, (x_5 / (12.667).xxx));
    float3 covered_1 = ((1.0).xxx / ((1.0).xxx + inverse_1));
    float3 last_2 = pow(max((inverse_1 * covered_1), (1e-30).xxx), (0.33333334).xxx);
    float3 span_1 = (covered_1 / (((1.0).xxx + last_2) + (last_2 * last_2)));
    bool loop_init_6 = true;
    while(true) {
        if (!loop_init_6) {
            uint _e89 = i_7;
            i_7 = (_e89 + 1u);
        }
        loop_init_6 = false;
        uint _e45 = i_7;
        if ((_e45 < LIGHT_NODES)) {
        } else {
            break;
        }
        {
            uint _e48 = i_7;
            const float2 _e49 = light_gauss_node(_e48);
            float3 z_2 = (span_1 * _e49.x);
            float3 q_2 = ((1.0).xxx - z_2);
            float3 p_1 = ((q_2 * q_2) * q_2);
            float3 y = (z_2 * ((3.0).xxx + (z_2 * (z_2 - (3.0).xxx))));
            float3 fall_1 = ((p_1 * p_1) + (y * ((spread * p_1) + y)));
            float3 both = ((1.0).xxx / (p_1 * fall_1));
            float3 _e74 = sum;
            sum = (_e74 + ((((((3.0 * _e49.y) * q_2) * q_2) * p_1) * both) * exp((((-(x_5) * y) * fall_1) * both))));
        }
    }
    const float _e94 = light_distance_m(h_2, geometry_3.start_m);
    float3 arriving_2 = exp((-(extinction_per_m) * _e94));
    float3 _e101 = sum;
    return ((((0.15915494 / _e5) * arriving_2) * span_1) * _e101);
}

// A point light in uniform fog that scatters equally in all directions.
// Cost: 6 exp, 3 exp a step; 8 steps.
float3 point_light_in_isotropic_fog(FogMedium medium_8, LocalLight light_13, float3 eye_1, float3 direction_1, float length_m_10)
{
    const LightRayGeometry _e7 = light_ray_geometry(eye_1, direction_1, length_m_10, light_13.position, light_13.radius_m);
    const float3 _e12 = airlight_isotropic(_e7, medium_8.extinction_per_m);
    return ((medium_8.scattering_per_m * light_13.intensity) * _e12);
}

LightRay ConstructLightRay(LightRayGeometry arg0, LocalLight arg1, float arg2, float arg3, float arg4) {
    LightRay ret = (LightRay)0;
    ret.geometry = arg0;
    ret.light = arg1;
    ret.nearest_m = arg2;
    ret.across_m = arg3;
    ret.along = arg4;
    return ret;
}

// A ray past a light.
// Cost: no exp.
LightRay light_ray(LocalLight light_14, float3 eye_2, float3 direction_2, float length_m_11)
{
    LightRayGeometry geometry_4 = (LightRayGeometry)0;
    bool local_12 = (bool)0;

    const LightRayGeometry _e6 = light_ray_geometry(eye_2, direction_2, length_m_11, light_14.position, light_14.radius_m);
    geometry_4 = _e6;
    float3 to_light_1 = (light_14.position - eye_2);
    float nearest_m_2 = length(cross(to_light_1, direction_2));
    if ((light_14.kind == LIGHT_SPHERE)) {
        float distance_m_3 = length(to_light_1);
        float inside = ((light_14.radius_m - nearest_m_2) * (light_14.radius_m + nearest_m_2));
        if ((distance_m_3 <= light_14.radius_m)) {
            geometry_4.length_m = 0.0;
        } else {
            float _e26 = geometry_4.start_m;
            if ((_e26 < 0.0)) {
                local_12 = (inside > 0.0);
            } else {
                local_12 = false;
            }
            bool _e34 = local_12;
            if (_e34) {
                float _e42 = geometry_4.start_m;
                float hit_m = (((distance_m_3 - light_14.radius_m) * (distance_m_3 + light_14.radius_m)) / (sqrt(inside) - _e42));
                geometry_4.length_m = min(length_m_11, hit_m);
            }
        }
    }
    float _e49 = geometry_4.start_m;
    float3 closest = (-(to_light_1) - (_e49 * direction_2));
    LightRayGeometry _e52 = geometry_4;
    const LightRay lightray = ConstructLightRay(_e52, light_14, nearest_m_2, dot(closest, light_14.axis), dot(direction_2, light_14.axis));
    return lightray;
}

// Interval of a ray, m from its start, in which the direction from a spot light is within a cone of this cosine of its half-angle; the whole ray for other lights, (0, 0) outside.
// Cost: no exp.
float2 lit_interval(LightRay ray_14, float cos_angle)
{
    float from_m_4 = -1000000000000.0;
    bool local_13 = (bool)0;
    float to_m_4 = INFINITE_M;
    bool local_14 = (bool)0;

    float length_m_18 = ray_14.geometry.length_m;
    if ((ray_14.light.kind != LIGHT_SPOT)) {
        return float2(0.0, length_m_18);
    }
    float h_3 = ray_14.geometry.nearest_m;
    float across = (ray_14.across_m / h_3);
    const float _e15 = light_distance_m(across, ray_14.along);
    if ((cos_angle >= _e15)) {
        return (0.0).xx;
    }
    float2 middle = (float2(across, ray_14.along) / (_e15).xx);
    float width = (cos_angle / _e15);
    float sin_width = sqrt(max(((1.0 - width) * (1.0 + width)), 0.0));
    float2 first_1 = float2(((middle.x * width) + (middle.y * sin_width)), ((middle.y * width) - (middle.x * sin_width)));
    float2 last_3 = float2(((middle.x * width) - (middle.y * sin_width)), ((middle.y * width) + (middle.x * sin_width)));
    if ((first_1.x > 0.0)) {
        from_m_4 = ((h_3 * first_1.y) / first_1.x);
    } else {
        if ((across <= 0.0)) {
            local_13 = (ray_14.along >= 0.0);
        } else {
            local_13 = false;
        }
        bool _e71 = local_13;
        if (_e71) {
            return (0.0).xx;
        }
    }
    if ((last_3.x > 0.0)) {
        to_m_4 = ((h_3 * last_3.y) / last_3.x);
    } else {
        if ((across <= 0.0)) {
            local_14 = (ray_14.along <= 0.0);
        } else {
            local_14 = false;
        }
        bool _e91 = local_14;
        if (_e91) {
            return (0.0).xx;
        }
    }
    float _e94 = from_m_4;
    float _e95 = to_m_4;
    float2 interval = clamp((float2(_e94, _e95) - (ray_14.geometry.start_m).xx), (0.0).xx, (length_m_18).xx);
    return ((interval.y > interval.x) ? interval : (0.0).xx);
}

// Light at a place of a ray: its intensity there relative to `intensity` (x), times the ratio of the squared distances `geometry` and the light have; the distance to the light's surface, m (y); 1 minus the cosine of the scattering angle (z).
// Cost: no exp.
float3 light_at(LightRay ray_15, float place_m_2)
{
    float h_4 = ray_15.geometry.nearest_m;
    const float _e4 = light_distance_m(h_4, place_m_2);
    const float _e5 = light_ahead_m(h_4, place_m_2);
    float one_minus_cos_10 = (_e5 / _e4);
    if ((ray_15.light.kind == LIGHT_SPOT)) {
        float cos_angle_3 = ((ray_15.across_m + (place_m_2 * ray_15.along)) / _e4);
        float range = max((ray_15.light.cos_inner - ray_15.light.cos_outer), 1e-6);
        float part_3 = clamp(((cos_angle_3 - ray_15.light.cos_outer) / range), 0.0, 1.0);
        return float3((part_3 * part_3), _e4, one_minus_cos_10);
    }
    if ((ray_15.light.kind == LIGHT_SPHERE)) {
        float radius_m_4 = ray_15.light.radius_m;
        const float _e39 = light_distance_m(ray_15.nearest_m, place_m_2);
        float centre_m = max(_e39, radius_m_4);
        float sine_4 = (radius_m_4 / centre_m);
        float closeness = (2.0 / (1.0 + sqrt(max(((1.0 - sine_4) * (1.0 + sine_4)), 0.0))));
        return float3(((closeness * (_e4 / centre_m)) * (_e4 / centre_m)), (centre_m - radius_m_4), min((1.0 + (place_m_2 / centre_m)), 2.0));
    }
    return float3(1.0, _e4, one_minus_cos_10);
}

// Width of the forward peak of a Henyey-Greenstein function in the tangent of half the scattering angle, at most 1.
// Cost: no exp.
float light_peak(float mean_cosine)
{
    return min(((1.0 - mean_cosine) / (1.0 + mean_cosine)), 1.0);
}

// Part of a ray past a light in uniform fog, for unit intensity and unit scattering coefficient, 1/m.
// Cost: 1 exp, 3 exp a step; 8 steps.
float3 light_panel_in_uniform_fog(float3 extinction_per_m_1, float mean_cosine_1, LightRay ray_16, float from_m_5, float to_m_5)
{
    float3 sum_1 = (0.0).xxx;
    uint i_8 = 0u;

    float h_5 = ray_16.geometry.nearest_m;
    float start_1 = (ray_16.geometry.start_m + from_m_5);
    const float _e10 = light_distance_m(h_5, start_1);
    const float _e11 = light_ahead_m(h_5, start_1);
    float least_1 = min(extinction_per_m_1.x, min(extinction_per_m_1.y, extinction_per_m_1.z));
    float rate = max(extinction_per_m_1.x, max(extinction_per_m_1.y, extinction_per_m_1.z));
    const float _e24 = light_excess_m(ConstructLightRayGeometry(h_5, start_1, (to_m_5 - from_m_5)));
    float end_3 = min(_e24, (LIGHT_CUTOFF / max(least_1, 1e-12)));
    const float _e30 = light_peak(mean_cosine_1);
    const float _e32 = light_distance_m((_e30 * h_5), _e11);
    const float _e37 = light_distance_m(1.0, ((rate * _e32) / 12.0));
    float scale = (_e32 / _e37);
    const float _e39 = light_node_span(scale, end_3);
    bool loop_init_7 = true;
    while(true) {
        if (!loop_init_7) {
            uint _e89 = i_8;
            i_8 = (_e89 + 1u);
        }
        loop_init_7 = false;
        uint _e45 = i_8;
        if ((_e45 < LIGHT_NODES)) {
        } else {
            break;
        }
        {
            uint _e48 = i_8;
            const float2 _e49 = light_node(_e48, scale, _e39);
            float s = (_e49.x + _e11);
            float t_1 = ((0.5 * _e49.x) * ((_e49.x + (2.0 * _e10)) / s));
            const float3 _e67 = light_at(ray_16, ((0.5 * (s - h_5)) * ((s + h_5) / s)));
            const float _e69 = henyey_greenstein(_e67.z, mean_cosine_1);
            float weight = ((((2.0 * _e49.y) / ((h_5 * h_5) + (s * s))) * _e67.x) * _e69);
            float3 _e80 = sum_1;
            sum_1 = (_e80 + (weight * exp((-(extinction_per_m_1) * ((from_m_5 + t_1) + _e67.y)))));
        }
    }
    float3 _e92 = sum_1;
    return _e92;
}

// A light of any kind in uniform fog whose phase function is that of Henyey and Greenstein, of mean cosine from -0.3 to 0.95.
// Cost: 3 exp, 9 exp a step; 8 steps, for point and sphere lights a third.
float3 light_in_uniform_fog(FogMedium medium_9, float mean_cosine_2, LocalLight light_15, float3 eye_3, float3 direction_3, float length_m_12)
{
    float3 sum_2 = (0.0).xxx;

    const LightRay _e6 = light_ray(light_15, eye_3, direction_3, length_m_12);
    const float2 _e8 = lit_interval(_e6, light_15.cos_outer);
    const float2 _e10 = lit_interval(_e6, light_15.cos_inner);
    float2 inner_1 = clamp(_e10, (_e8.x).xx, (_e8.y).xx);
    if ((inner_1.x > _e8.x)) {
        float3 _e22 = sum_2;
        const float3 _e26 = light_panel_in_uniform_fog(medium_9.extinction_per_m, mean_cosine_2, _e6, _e8.x, inner_1.x);
        sum_2 = (_e22 + _e26);
    }
    if ((inner_1.y > inner_1.x)) {
        float3 _e31 = sum_2;
        const float3 _e35 = light_panel_in_uniform_fog(medium_9.extinction_per_m, mean_cosine_2, _e6, inner_1.x, inner_1.y);
        sum_2 = (_e31 + _e35);
    }
    if ((_e8.y > inner_1.y)) {
        float3 _e40 = sum_2;
        const float3 _e44 = light_panel_in_uniform_fog(medium_9.extinction_per_m, mean_cosine_2, _e6, inner_1.y, _e8.y);
        sum_2 = (_e40 + _e44);
    }
    float3 _e49 = sum_2;
    return ((medium_9.scattering_per_m * light_15.intensity) * _e49);
}

// Column from the eye to a distance along a ray and from there to a light, m.
// Cost: 4 exp.
float column_by_light_m(ExponentialFog fog_3, float eye_height_m, float sin_elevation_7, float distance_m, float light_height_m, float to_centre_m, float to_light_m)
{
    float height_m_13 = (eye_height_m + (sin_elevation_7 * distance_m));
    float sine_5 = ((light_height_m - height_m_13) / max(to_centre_m, 1e-6));
    const float _e15 = flat_exponential_column_m(eye_height_m, sin_elevation_7, distance_m, fog_3.reference_height_m, fog_3.scale_height_m);
    const float _e18 = flat_exponential_column_m(height_m_13, sine_5, to_light_m, fog_3.reference_height_m, fog_3.scale_height_m);
    return (_e15 + _e18);
}

// Part of a ray past a light in exponential height fog, for unit intensity and unit scattering coefficient, 1/m.
// Cost: 5 exp, 12 exp a step; 8 steps of 8, and 1 to 8 of 4.
float3 light_panel_in_exponential_fog(ExponentialFog fog_4, float eye_height_m_1, float sin_elevation_8, LightRay ray_17, float from_m_6, float to_m_6)
{
    float end = (float)0;
    float reached = 0.0;
    uint i_9 = 0u;
    bool local_15 = (bool)0;
    float origin_m = (float)0;
    float forward = 1.0;
    float anchor = (float)0;
    float3 sum_3 = (0.0).xxx;
    uint i_10 = 0u;

    float h_6 = ray_17.geometry.nearest_m;
    float start_2 = (ray_17.geometry.start_m + from_m_6);
    float3 extinction = fog_4.medium.extinction_per_m;
    float least_2 = max(min(extinction.x, min(extinction.y, extinction.z)), 1e-12);
    float most_1 = max(extinction.x, max(extinction.y, extinction.z));
    float light_height_m_1 = ray_17.light.position.y;
    const float _e28 = light_distance_m(h_6, start_2);
    const float _e29 = light_ahead_m(h_6, start_2);
    const float _e32 = light_excess_m(ConstructLightRayGeometry(h_6, start_2, (to_m_6 - from_m_6)));
    const float _e33 = column_by_light_m(fog_4, eye_height_m_1, sin_elevation_8, from_m_6, light_height_m_1, _e28, _e28);
    end = _e32;
    bool loop_init_8 = true;
    while(true) {
        if (!loop_init_8) {
            uint _e70 = i_9;
            i_9 = (_e70 + 1u);
        }
        loop_init_8 = false;
        uint _e39 = i_9;
        if ((_e39 < 8u)) {
        } else {
            break;
        }
        {
            float _e42 = end;
            float _e45 = end;
            float _e49 = end;
            float t_2 = ((0.5 * _e42) * ((_e45 + (2.0 * _e28)) / (_e49 + _e29)));
            const float _e54 = light_distance_m(h_6, (start_2 + t_2));
            const float _e56 = column_by_light_m(fog_4, eye_height_m_1, sin_elevation_8, (from_m_6 + t_2), light_height_m_1, _e54, _e54);
            reached = (least_2 * (_e56 - _e33));
            float _e59 = reached;
            if ((_e59 <= 25.334)) {
                break;
            }
            float _e62 = end;
            float _e63 = reached;
            end = (_e62 * ((_e63 > 253.34) ? 0.1 : 0.5));
        }
    }
    float _e73 = reached;
    float _e74 = end;
    float rate_1 = (max((_e73 / max(_e74, 1e-30)), 0.0) * (most_1 / least_2));
    if (((start_2 + (to_m_6 - from_m_6)) <= 0.0)) {
        float _e88 = end;
        local_15 = ((rate_1 * _e88) < 4.0);
    } else {
        local_15 = false;
    }
    bool outwards = local_15;
    origin_m = from_m_6;
    anchor = start_2;
    if (outwards) {
        float _e98 = end;
        float _e101 = end;
        float _e105 = end;
        float reach = min(((0.5 * _e98) * ((_e101 + (2.0 * _e28)) / (_e105 + _e29))), (to_m_6 - from_m_6));
        origin_m = (from_m_6 + reach);
        forward = -1.0;
        anchor = -((start_2 + reach));
        float _e115 = anchor;
        const float _e117 = light_excess_m(ConstructLightRayGeometry(h_6, _e115, reach));
        end = _e117;
    }
    float _e118 = anchor;
    const float _e119 = light_distance_m(h_6, _e118);
    float _e120 = anchor;
    const float _e121 = light_ahead_m(h_6, _e120);
    const float _e123 = light_peak(fog_4.mean_cosine);
    const float _e127 = light_distance_m(((outwards ? 1.0 : _e123) * h_6), _e121);
    const float _e134 = light_distance_m(1.0, (((outwards ? 0.0 : rate_1) * _e127) / 12.0));
    float scale_1 = (_e127 / _e134);
    float _e136 = end;
    const float _e137 = light_node_span(scale_1, _e136);
    bool loop_init_9 = true;
    while(true) {
        if (!loop_init_9) {
            uint _e213 = i_10;
            i_10 = (_e213 + 1u);
        }
        loop_init_9 = false;
        uint _e143 = i_10;
        if ((_e143 < LIGHT_NODES)) {
        } else {
            break;
        }
        {
            uint _e146 = i_10;
            const float2 _e147 = light_node(_e146, scale_1, _e137);
            float s_1 = (_e147.x + _e121);
            float _e150 = origin_m;
            float _e151 = forward;
            float t_3 = max((_e150 + (((_e151 * 0.5) * _e147.x) * ((_e147.x + (2.0 * _e119)) / s_1))), 0.0);
            float _e165 = forward;
            float place_11 = (((_e165 * 0.5) * (s_1 - h_6)) * ((s_1 + h_6) / s_1));
            const float3 _e173 = light_at(ray_17, place_11);
            float centre_m_1 = ((ray_17.light.kind == LIGHT_SPHERE) ? (_e173.y + ray_17.light.radius_m) : _e173.y);
            const float _e185 = column_by_light_m(fog_4, eye_height_m_1, sin_elevation_8, t_3, light_height_m_1, centre_m_1, _e173.y);
            const float _e192 = decayed((((eye_height_m_1 + (sin_elevation_8 * t_3)) - fog_4.reference_height_m) / fog_4.scale_height_m));
            const float _e195 = henyey_greenstein(_e173.z, fog_4.mean_cosine);
            float weight_1 = (((((2.0 * _e147.y) / ((h_6 * h_6) + (s_1 * s_1))) * _e173.x) * _e195) * _e192);
            float3 _e207 = sum_3;
            sum_3 = (_e207 + (weight_1 * exp((-(extinction) * _e185))));
        }
    }
    float3 _e216 = sum_3;
    return _e216;
}

// A light of any kind in exponential height fog over flat ground.
// Cost: 2 exp, 17 exp a step; 1 to 6 steps of 73 to 101.
float3 light_in_exponential_fog(ExponentialFog fog_5, LocalLight light_16, float3 eye_4, float3 direction_4, float length_m_13)
{
    float last_m = (float)0;
    float floor_ = (float)0;
    float3 height_cuts = (float3)0;
    float3 sum_4 = (0.0).xxx;
    float from_m_7 = (float)0;
    uint i_11 = 0u;

    const LightRay _e5 = light_ray(light_16, eye_4, direction_4, length_m_13);
    const float2 _e7 = lit_interval(_e5, light_16.cos_outer);
    const float2 _e9 = lit_interval(_e5, light_16.cos_inner);
    last_m = _e7.y;
    float rise_1 = (direction_4.y / fog_5.scale_height_m);
    float start_3 = ((eye_4.y - fog_5.reference_height_m) / fog_5.scale_height_m);
    floor_ = (start_3 + min((rise_1 * _e5.geometry.length_m), 0.0));
    if ((rise_1 < 0.0)) {
        float3 extinction_1 = fog_5.medium.extinction_per_m;
        float least_3 = max(min(extinction_1.x, min(extinction_1.y, extinction_1.z)), 1e-12);
        const float _e38 = decayed(start_3);
        float dark = -(log((_e38 + ((90.0 * -(rise_1)) / least_3))));
        float _e46 = floor_;
        if ((dark > _e46)) {
            floor_ = dark;
            float _e48 = last_m;
            last_m = min(_e48, max(((dark - start_3) / rise_1), 0.0));
        }
    }
    float3 light_cuts = float3(_e9, -(_e5.geometry.start_m));
    float _e58 = last_m;
    height_cuts = (_e58).xxx;
    if ((rise_1 != 0.0)) {
        float _e63 = floor_;
        height_cuts = ((((_e63).xxx + float3(3.0, 10.0, 40.0)) - (start_3).xxx) / (rise_1).xxx);
        if ((rise_1 > 0.0)) {
            float _e76 = last_m;
            float _e78 = height_cuts.z;
            last_m = min(_e76, max(_e78, 0.0));
        }
    }
    from_m_7 = _e7.x;
    bool loop_init_10 = true;
    while(true) {
        if (!loop_init_10) {
            uint _e123 = i_11;
            i_11 = (_e123 + 1u);
        }
        loop_init_10 = false;
        uint _e89 = i_11;
        if ((_e89 < 7u)) {
        } else {
            break;
        }
        {
            float _e92 = from_m_7;
            float _e93 = last_m;
            if ((_e92 >= _e93)) {
                break;
            }
            float _e95 = last_m;
            float _e97 = from_m_7;
            float3 beside_light = select_each((light_cuts > (_e97).xxx), light_cuts, (_e95).xxx);
            float _e101 = last_m;
            float3 _e103 = height_cuts;
            float3 _e104 = height_cuts;
            float _e105 = from_m_7;
            float3 at_height = select_each((_e104 > (_e105).xxx), _e103, (_e101).xxx);
            float3 next = min(beside_light, at_height);
            float _e111 = last_m;
            float to_m_8 = min(min(next.x, _e111), min(next.y, next.z));
            float3 _e117 = sum_4;
            float _e120 = from_m_7;
            const float3 _e121 = light_panel_in_exponential_fog(fog_5, eye_4.y, direction_4.y, _e5, _e120, to_m_8);
            sum_4 = (_e117 + _e121);
            from_m_7 = to_m_8;
        }
    }
    float3 _e130 = sum_4;
    return ((fog_5.medium.scattering_per_m * light_16.intensity) * _e130);
}

// Red, green and blue of a radiance at four wavelengths.
// Cost: no exp.
float3 rgb_from_spectrum(RgbWeights weights_1, float4 spectrum)
{
    return float3(dot(weights_1.red, spectrum), dot(weights_1.green, spectrum), dot(weights_1.blue, spectrum));
}

// XYZ of linear sRGB (IEC 61966-2-1), in the unit of its components.
// Cost: no exp.
float3 xyz_from_srgb(float3 rgb)
{
    return float3(dot(float3(0.4123908, 0.35758433, 0.1804808), rgb), dot(float3(0.212639, 0.71516865, 0.07219232), rgb), dot(float3(0.019330818, 0.11919478, 0.95053214), rgb));
}

// Linear sRGB of XYZ, with negative components outside the gamut.
// Cost: no exp.
float3 srgb_from_xyz(float3 xyz)
{
    return float3(dot(float3(3.24097, -1.5373832, -0.49861076), xyz), dot(float3(-0.96924365, 1.8759675, 0.04155506), xyz), dot(float3(0.05563008, -0.20397696, 1.0569715), xyz));
}

// XYZ of linear BT.2020.
// Cost: no exp.
float3 xyz_from_rec2020_rgb(float3 rgb_1)
{
    return float3(dot(float3(0.63695806, 0.1446169, 0.16888097), rgb_1), dot(float3(0.2627002, 0.67799807, 0.059301715), rgb_1), dot(float3(0.0, 0.028072692, 1.0609851), rgb_1));
}

// Linear BT.2020 of XYZ, with negative components outside the gamut.
// Cost: no exp.
float3 rec2020_from_xyz(float3 xyz_1)
{
    return float3(dot(float3(1.7166512, -0.35567078, -0.2533663), xyz_1), dot(float3(-0.6666843, 1.6164812, 0.015768547), xyz_1), dot(float3(0.017639857, -0.042770613, 0.94210315), xyz_1));
}

// XYZ of ACEScg, whose white is adapted to D65 by Bradford's transform: what is neutral stays neutral.
// Cost: no exp.
float3 xyz_from_acescg(float3 rgb_2)
{
    return float3(dot(float3(0.65223753, 0.12823613, 0.16998225), rgb_2), dot(float3(0.26767218, 0.67434, 0.05798783), rgb_2), dot(float3(-0.0053818156, 0.0013690602, 1.0930705), rgb_2));
}

// ACEScg of XYZ, D65 adapted to its white by Bradford's transform.
// Cost: no exp.
float3 acescg_from_xyz(float3 xyz_2)
{
    return float3(dot(float3(1.6605853, -0.31529555, -0.24150933), xyz_2), dot(float3(-0.65992606, 1.6083915, 0.017298594), xyz_2), dot(float3(0.009002569, -0.0035668763, 0.9136433), xyz_2));
}

// sRGB signal of linear components (IEC 61966-2-1), odd below 0 and not clipped above 1.
// Cost: 3 exp.
float3 srgb_encode(float3 linear_)
{
    float3 v = abs(linear_);
    float3 curved = ((1.055 * pow(max(v, (0.0031308).xxx), (0.41666666).xxx)) - (0.055).xxx);
    return (sign(linear_) * select_each((v <= (0.0031308).xxx), (12.92 * v), curved));
}

// Linear components of an sRGB signal, the inverse of `srgb_encode`.
// Cost: 3 exp.
float3 srgb_decode(float3 signal)
{
    float3 v_1 = abs(signal);
    float3 curved_1 = pow(((v_1 + (0.055).xxx) / (1.055).xxx), (2.4).xxx);
    return (sign(signal) * select_each((v_1 <= (0.04045).xxx), (v_1 / (12.92).xxx), curved_1));
}

// Luminance of linear sRGB with the rounded weights of BT.709, in the unit of its components.
// Cost: no exp.
float srgb_luminance(float3 rgb_3)
{
    return dot(float3(0.2126, 0.7152, 0.0722), rgb_3);
}

// Linear sRGB moved towards grey of the same luminance until no component is negative; black where the luminance is not positive.
// Cost: no exp.
float3 without_negatives(float3 rgb_4)
{
    float bottom = min(rgb_4.x, min(rgb_4.y, rgb_4.z));
    if ((bottom >= 0.0)) {
        return rgb_4;
    }
    const float _e8 = srgb_luminance(rgb_4);
    float grey = max(_e8, 0.0);
    return max(((grey).xxx + ((grey / (grey - bottom)) * (rgb_4 - (grey).xxx))), (0.0).xxx);
}

// Linear sRGB moved towards grey of the same luminance until all components are from 0 to 1.
// Cost: no exp.
float3 into_unit_cube(float3 rgb_5)
{
    const float3 _e1 = without_negatives(rgb_5);
    float top = max(_e1.x, max(_e1.y, _e1.z));
    if ((top <= 1.0)) {
        return _e1;
    }
    const float _e9 = srgb_luminance(_e1);
    if ((_e9 >= 1.0)) {
        return (1.0).xxx;
    }
    return clamp(((_e9).xxx + (((1.0 - _e9) / (top - _e9)) * (_e1 - (_e9).xxx))), (0.0).xxx, (1.0).xxx);
}

// Texture coordinate of a place from 0 (centre of the first texel) to 1 (centre of the last) among `count` texels.
// Cost: no exp.
float texel_coordinate(float place_1, float count_1)
{
    return ((0.5 + (place_1 * (count_1 - 1.0))) / count_1);
}

// Inverse of `texel_coordinate`.
// Cost: no exp.
float place_from_texel_coordinate(float coordinate, float count_2)
{
    return (((coordinate * count_2) - 0.5) / (count_2 - 1.0));
}

// Azimuth of a direction from that of the sun as a fraction of half a turn. Under a vertical sun azimuths count from east.
// Cost: no exp.
float azimuth_place(float3 direction_5, float3 sun)
{
    bool local_16 = (bool)0;

    bool is_vertical = ((abs(sun.x) + abs(sun.z)) < 1e-9);
    float2 towards = (is_vertical ? float2(1.0, 0.0) : sun.xz);
    float across_1 = abs(((direction_5.x * towards.y) - (direction_5.z * towards.x)));
    float along_2 = dot(direction_5.xz, towards);
    if ((across_1 == 0.0)) {
        local_16 = (along_2 >= 0.0);
    } else {
        local_16 = false;
    }
    bool _e31 = local_16;
    if (_e31) {
        return 0.0;
    }
    return (atan2(across_1, along_2) * 0.31830987);
}

// Place from 0 to 1 of an azimuth from the sun, in half turns, among the columns of a table. From space they are dense where the planet's shadow crosses the limb.
// Cost: no exp.
float column_place(SkyView view, float azimuth)
{
    if ((view.dense_share == 0.0)) {
        return azimuth;
    }
    float3 dense = atan(((float3(azimuth, 0.0, 1.0) - (view.dense_azimuth).xxx) / (view.dense_width).xxx));
    return lerp(azimuth, ((dense.x - dense.y) / (dense.z - dense.y)), view.dense_share);
}

// Inverse of `column_place`, by bisection.
// Cost: no exp.
float azimuth_from_column_place(SkyView view_1, float place_2)
{
    float below = 0.0;
    float above = 1.0;
    int k = int(0);

    if ((view_1.dense_share == 0.0)) {
        return place_2;
    }
    bool loop_init_11 = true;
    while(true) {
        if (!loop_init_11) {
            int _e22 = k;
            k = asint(asuint(_e22) + asuint(int(1)));
        }
        loop_init_11 = false;
        int _e11 = k;
        if ((_e11 < int(24))) {
        } else {
            break;
        }
        {
            float _e14 = below;
            float _e15 = above;
            float middle_1 = (0.5 * (_e14 + _e15));
            const float _e19 = column_place(view_1, middle_1);
            if ((_e19 < place_2)) {
                below = middle_1;
            } else {
                above = middle_1;
            }
        }
    }
    float _e24 = below;
    float _e25 = above;
    return (0.5 * (_e24 + _e25));
}

// Place from 0 to 1 of an elevation among the rows above or below the horizon. Above it they are dense towards the horizon, at the square of the place, and towards the rays that graze a jump of density, from below; below it at the fourth power of the place for a low eye, whose rays soon meet the ground, and the more at its square the farther the horizon dips.
// Cost: no exp.
float row_place(SkyView view_2, float elevation_rad, bool is_below)
{
    if (is_below) {
        float part_4 = ((elevation_rad - view_2.horizon_rad) / (-1.5707964 - view_2.horizon_rad));
        float root_2 = sqrt(sqrt(clamp(part_4, 0.0, 1.0)));
        return (root_2 * ((1.0 - view_2.even_below) + (view_2.even_below * root_2)));
    }
    if ((elevation_rad < view_2.kink_rad)) {
        float part_5 = clamp(((elevation_rad - view_2.horizon_rad) / (view_2.kink_rad - view_2.horizon_rad)), 0.0, 1.0);
        return ((view_2.kink_place * 0.63661975) * atan2(sqrt(part_5), sqrt((1.0 - part_5))));
    }
    float part_6 = clamp(((elevation_rad - view_2.kink_rad) / (view_2.highest_rad - view_2.kink_rad)), 0.0, 1.0);
    return (view_2.kink_place + ((1.0 - view_2.kink_place) * sqrt(part_6)));
}

// Inverse of `row_place`: elevation of a place, rad.
// Cost: no exp.
float elevation_from_row_place(SkyView view_3, float place_3, bool is_below_1)
{
    if (is_below_1) {
        float uneven = (1.0 - view_3.even_below);
        float root_3 = ((2.0 * place_3) / (uneven + sqrt(((uneven * uneven) + ((4.0 * view_3.even_below) * place_3)))));
        float squared = (root_3 * root_3);
        return (view_3.horizon_rad + (((-1.5707964 - view_3.horizon_rad) * squared) * squared));
    }
    if ((place_3 < view_3.kink_place)) {
        float sine_6 = sin(((1.5707964 * place_3) / view_3.kink_place));
        return (view_3.horizon_rad + (((view_3.kink_rad - view_3.horizon_rad) * sine_6) * sine_6));
    }
    float part_7 = ((place_3 - view_3.kink_place) / (1.0 - view_3.kink_place));
    return (view_3.kink_rad + (((view_3.highest_rad - view_3.kink_rad) * part_7) * part_7));
}

// Texture coordinate of an elevation in a table with rows above and below the horizon, at their `row_place`. The first rows hold the elevations from the horizon on; both parts end in texel centres, so that filtering does not mix them.
// Cost: no exp.
float row_coordinate(SkyView view_4, float elevation_rad_1, bool is_below_2, float rows_above, float rows_below)
{
    float rows = (is_below_2 ? rows_below : rows_above);
    float first_2 = (is_below_2 ? rows_above : 0.0);
    const float _e10 = row_place(view_4, elevation_rad_1, is_below_2);
    return (((first_2 + 0.5) + (_e10 * (rows - 1.0))) / (rows_above + rows_below));
}

// Inverse of `row_coordinate`: elevation of a texture coordinate, rad.
// Cost: no exp.
float elevation_from_row_coordinate(SkyView view_5, float coordinate_1, float rows_above_1, float rows_below_1)
{
    float row_2 = (coordinate_1 * (rows_above_1 + rows_below_1));
    bool is_below_6 = (row_2 >= rows_above_1);
    float rows_1 = (is_below_6 ? rows_below_1 : rows_above_1);
    float place_12 = (((row_2 - (is_below_6 ? rows_above_1 : 0.0)) - 0.5) / (rows_1 - 1.0));
    const float _e16 = elevation_from_row_place(view_5, place_12, is_below_6);
    return _e16;
}

// Elevation of a direction, rad.
// Cost: no exp.
float elevation_of(float3 direction_6)
{
    return atan2(direction_6.y, length(direction_6.xz));
}

// Texture coordinates of a direction in a sky table.
// Cost: no exp.
float2 uv_from_direction(SkyView view_6, float3 direction_7)
{
    const float _e2 = elevation_of(direction_7);
    bool is_below_7 = (_e2 < view_6.horizon_rad);
    const float _e6 = azimuth_place(direction_7, view_6.sun);
    const float _e7 = column_place(view_6, _e6);
    const float _e9 = texel_coordinate(_e7, SKY_AZIMUTHS);
    const float _e12 = row_coordinate(view_6, _e2, is_below_7, SKY_ROWS_ABOVE, SKY_ROWS_BELOW);
    return float2(_e9, _e12);
}

// Unit vector at an azimuth from the sun, as a fraction of half a turn, and an elevation.
// Cost: no exp.
float3 direction_from_azimuth_elevation(SkyView view_7, float azimuth_1, float elevation_rad_2)
{
    bool is_vertical_1 = ((abs(view_7.sun.x) + abs(view_7.sun.z)) < 1e-9);
    float2 towards_1 = normalize((is_vertical_1 ? float2(1.0, 0.0) : view_7.sun.xz));
    float along_3 = (cos((azimuth_1 * 3.1415927)) * cos(elevation_rad_2));
    float across_2 = (sin((azimuth_1 * 3.1415927)) * cos(elevation_rad_2));
    return float3(((towards_1.x * along_3) - (towards_1.y * across_2)), sin(elevation_rad_2), ((towards_1.y * along_3) + (towards_1.x * across_2)));
}

// Interval of a ray inside the air, m from the eye: up to the ground, if it meets that, or to the top. From space, a ray that misses the air has an empty interval.
// Cost: no exp.
float2 air_span_m(SkyView view_8, float sin_elevation_9, bool meets_ground)
{
    float end_1 = (float)0;

    float b_3 = ((view_8.ground_radius_m + view_8.height_m) * sin_elevation_9);
    float over_ground = (view_8.height_m * ((2.0 * view_8.ground_radius_m) + view_8.height_m));
    float over_top = ((view_8.height_m - view_8.air_height_m) * (((2.0 * view_8.ground_radius_m) + view_8.height_m) + view_8.air_height_m));
    float root_4 = sqrt(max(((b_3 * b_3) - over_top), 0.0));
    float start_4 = ((over_top > 0.0) ? (over_top / (root_4 - b_3)) : 0.0);
    end_1 = (root_4 - b_3);
    if (meets_ground) {
        end_1 = (over_ground / (sqrt(max(((b_3 * b_3) - over_ground), 0.0)) - b_3));
    } else {
        if ((b_3 > 0.0)) {
            end_1 = (-(over_top) / (root_4 + b_3));
        }
    }
    float _e50 = end_1;
    return float2(start_4, max(_e50, start_4));
}

// Interval of a ray inside the air that is below the jump of density nearest to the eye, m from the eye; (0, 0) if none is.
// Cost: no exp.
float2 below_jump_m(SkyView view_9, float2 span_m, float sin_elevation_10, bool meets_ground_1)
{
    bool local_17 = (bool)0;
    bool local_18 = (bool)0;
    float exit = (float)0;

    float b_4 = ((view_9.ground_radius_m + view_9.height_m) * sin_elevation_10);
    float over_jump = ((view_9.height_m - view_9.jump_height_m) * (((2.0 * view_9.ground_radius_m) + view_9.height_m) + view_9.jump_height_m));
    float squared_root = ((b_4 * b_4) - over_jump);
    if ((over_jump > 0.0)) {
        if (!((b_4 >= 0.0))) {
            local_18 = (squared_root <= 0.0);
        } else {
            local_18 = true;
        }
        bool _e33 = local_18;
        local_17 = _e33;
    } else {
        local_17 = false;
    }
    bool _e35 = local_17;
    if (_e35) {
        return (0.0).xx;
    }
    float root_5 = sqrt(max(squared_root, 0.0));
    float entry = ((over_jump > 0.0) ? (over_jump / (root_5 - b_4)) : 0.0);
    exit = (root_5 - b_4);
    if (meets_ground_1) {
        exit = span_m.y;
    } else {
        if ((b_4 > 0.0)) {
            exit = (-(over_jump) / (root_5 + b_4));
        }
    }
    float _e55 = exit;
    return float2(entry, _e55);
}

// Part of the way of a ray through the air, up to a length, that is below the jump of density nearest to the eye.
// Cost: no exp.
float share_below_jump(SkyView view_10, float2 span_m_1, float sin_elevation_11, float length_m_14, bool meets_ground_2)
{
    const float2 _e5 = below_jump_m(view_10, span_m_1, sin_elevation_11, meets_ground_2);
    float below_m_1 = (min((span_m_1.x + length_m_14), _e5.y) - max(span_m_1.x, _e5.x));
    return clamp((below_m_1 / max(length_m_14, 1e-6)), 0.0, 1.0);
}

// Length of the first step between the distances of a ray with an interval in the air, relative to even steps. From inside the air distances are dense near the eye, at the square of the place: 0; from above it towards the ground, where most air is, dense there: 2. Steep rays from high in the air are between.
// Cost: no exp.
float first_step(SkyView view_11, float2 span_m_2, bool meets_ground_3)
{
    if ((view_11.height_m >= view_11.air_height_m)) {
        return (meets_ground_3 ? 2.0 : 1.0);
    }
    if (!(meets_ground_3)) {
        return 0.0;
    }
    float slant = (1.0 - min((view_11.height_m / max(span_m_2.y, 1.0)), 1.0));
    float high = min(((2.5 * view_11.height_m) / view_11.air_height_m), 1.0);
    return ((2.0 * high) * (1.0 - (((slant * slant) * slant) * slant)));
}

// Place from 0 to 1 of a part of the way through the air among distances with a `first_step`.
// Cost: no exp.
float place_from_part(float part, float first_step_1)
{
    float last_step = (2.0 - first_step_1);
    float root_6 = sqrt(((((1.0 - part) * first_step_1) * first_step_1) + ((part * last_step) * last_step)));
    return ((2.0 * part) / max((first_step_1 + root_6), 1e-20));
}

// Inverse of `place_from_part`.
// Cost: no exp.
float part_from_place(float place_4, float first_step_2)
{
    return (place_4 * (first_step_2 + ((1.0 - first_step_2) * place_4)));
}

// Place from 0 to 1 of an azimuth from the sun, in half turns, among the columns of an aerial-perspective table.
// Cost: no exp.
float aerial_column_place(SkyView view_12, float azimuth_2)
{
    const float _e2 = column_place(view_12, azimuth_2);
    const float _e4 = place_from_part(_e2, AERIAL_FIRST_COLUMN);
    return _e4;
}

// Place among the rows of an aerial-perspective table of the rays that graze a jump of density: that of the nearest row.
// Cost: no exp.
float aerial_kink_place(SkyView view_13)
{
    return (round((view_13.kink_place * 43.0)) / 43.0);
}

// Place from 0 to 1 among the rows of an aerial-perspective table of the place that an elevation has by `row_place`: that of the rays that graze a jump of density is at a row, and rows are dense above it.
// Cost: no exp.
float aerial_row_place(SkyView view_14, float row_place_1, bool is_below_3)
{
    if (is_below_3) {
        return row_place_1;
    }
    const float _e3 = aerial_kink_place(view_14);
    if ((row_place_1 < view_14.kink_place)) {
        return ((row_place_1 * _e3) / view_14.kink_place);
    }
    const float _e16 = place_from_part(((row_place_1 - view_14.kink_place) / (1.0 - view_14.kink_place)), AERIAL_FIRST_ROW);
    return lerp(_e3, 1.0, _e16);
}

// Inverse of `aerial_row_place`: place by `row_place`.
// Cost: no exp.
float row_place_from_aerial(SkyView view_15, float place_5, bool is_below_4)
{
    if (is_below_4) {
        return place_5;
    }
    const float _e3 = aerial_kink_place(view_15);
    if ((place_5 < _e3)) {
        return ((place_5 * view_15.kink_place) / _e3);
    }
    const float _e14 = part_from_place(((place_5 - _e3) / (1.0 - _e3)), AERIAL_FIRST_ROW);
    return lerp(view_15.kink_place, 1.0, _e14);
}

// Texture coordinate of an elevation in an aerial-perspective table.
// Cost: no exp.
float aerial_row_coordinate(SkyView view_16, float elevation_rad_3, bool is_below_5)
{
    const float _e3 = row_place(view_16, elevation_rad_3, is_below_5);
    const float _e4 = aerial_row_place(view_16, _e3, is_below_5);
    float rows_2 = (is_below_5 ? AERIAL_ROWS_BELOW : AERIAL_ROWS_ABOVE);
    float first_3 = (is_below_5 ? AERIAL_ROWS_ABOVE : 0.0);
    return (((first_3 + 0.5) + (_e4 * (rows_2 - 1.0))) / 62.0);
}

// Part of the way of a ray through the air at which it first crosses the jump of density nearest to the eye, or if it does not, at which the ray that grazes the jump does; 0 if the ray meets the ground.
// Cost: no exp.
float part_at_jump(SkyView view_17, float2 span_m_3, float sin_elevation_12, bool meets_ground_4)
{
    bool local_19 = (bool)0;

    if (!((view_17.jump_place == 0.0))) {
        local_19 = meets_ground_4;
    } else {
        local_19 = true;
    }
    bool _e11 = local_19;
    if (_e11) {
        return 0.0;
    }
    const float2 _e13 = below_jump_m(view_17, span_m_3, sin_elevation_12, meets_ground_4);
    if ((_e13.y == 0.0)) {
        return view_17.jump_part;
    }
    float crossing = ((_e13.x > span_m_3.x) ? _e13.x : _e13.y);
    return clamp(((crossing - span_m_3.x) / max((span_m_3.y - span_m_3.x), 1e-6)), 0.0, 1.0);
}

// Place from 0 to 1 of a part of the way behind a jump of density, of a length (m), among the distances there: dense behind the jump.
// Cost: no exp.
float place_behind_jump(float part_1, float length_m_15)
{
    float length_1 = (length_m_15 / BEHIND_JUMP_M);
    return ((part_1 * (1.0 + length_1)) / (1.0 + (part_1 * length_1)));
}

// Inverse of `place_behind_jump`.
// Cost: no exp.
float part_behind_jump(float place_6, float length_m_16)
{
    float length_2 = (length_m_16 / BEHIND_JUMP_M);
    return (place_6 / (1.0 + ((1.0 - place_6) * length_2)));
}

// Place from 0 to 1 of a length in the air among the distances of a ray with an interval in the air. Where rays cross a jump of density, so does a distance of the table, as light and extinction bend there.
// Cost: no exp.
float distance_place(SkyView view_18, float2 span_m_4, float sin_elevation_13, float length_m_17, bool meets_ground_5)
{
    float part_8 = clamp((length_m_17 / max((span_m_4.y - span_m_4.x), 1e-6)), 0.0, 1.0);
    const float _e14 = part_at_jump(view_18, span_m_4, sin_elevation_13, meets_ground_5);
    if ((_e14 == 0.0)) {
        const float _e17 = first_step(view_18, span_m_4, meets_ground_5);
        const float _e18 = place_from_part(part_8, _e17);
        return _e18;
    }
    if ((part_8 < _e14)) {
        return (view_18.jump_place * sqrt((part_8 / _e14)));
    }
    float behind = clamp(((part_8 - _e14) / max((1.0 - _e14), 1e-6)), 0.0, 1.0);
    float behind_m = ((1.0 - _e14) * (span_m_4.y - span_m_4.x));
    const float _e40 = place_behind_jump(behind, behind_m);
    return lerp(view_18.jump_place, 1.0, _e40);
}

// Inverse of `distance_place`: length in the air, m.
// Cost: no exp.
float length_from_distance_place(SkyView view_19, float2 span_m_5, float sin_elevation_14, float place_7, bool meets_ground_6)
{
    float part_2 = (float)0;
    bool local_20 = (bool)0;

    const float _e5 = part_at_jump(view_19, span_m_5, sin_elevation_14, meets_ground_6);
    const float _e6 = first_step(view_19, span_m_5, meets_ground_6);
    const float _e7 = part_from_place(place_7, _e6);
    part_2 = _e7;
    if ((_e5 > 0.0)) {
        local_20 = (place_7 < view_19.jump_place);
    } else {
        local_20 = false;
    }
    bool _e16 = local_20;
    if (_e16) {
        part_2 = ((_e5 * (place_7 / view_19.jump_place)) * (place_7 / view_19.jump_place));
    } else {
        if ((_e5 > 0.0)) {
            float behind_m_1 = ((1.0 - _e5) * (span_m_5.y - span_m_5.x));
            const float _e37 = part_behind_jump(((place_7 - view_19.jump_place) / (1.0 - view_19.jump_place)), behind_m_1);
            part_2 = lerp(_e5, 1.0, _e37);
        }
    }
    float _e40 = part_2;
    return (_e40 * (span_m_5.y - span_m_5.x));
}

// Place from 0 to 1 of a scattering angle in a table of phase functions, dense forwards, by 1 minus the cosine.
// Cost: no exp.
float phase_place(float one_minus_cos_6)
{
    float half_angle = atan2(sqrt(max(one_minus_cos_6, 0.0)), sqrt(max((2.0 - one_minus_cos_6), 0.0)));
    return sqrt((half_angle * 0.63661975));
}

// Inverse of `phase_place`.
// Cost: no exp.
float one_minus_cos_from_phase_place(float place_8)
{
    float half_sine = sin(((1.5707964 * place_8) * place_8));
    return ((2.0 * half_sine) * half_sine);
}

// Phase function of haze between a direction and the sun at four wavelengths, 1/sr.
// Cost: 1 read.
float4 haze_phase(Texture2D<float4> phase_table, SamplerState linear_sampler, float one_minus_cos_7)
{
    const float _e3 = phase_place(one_minus_cos_7);
    const float _e5 = texel_coordinate(_e3, PHASE_ANGLES);
    float4 _e9 = phase_table.SampleLevel(linear_sampler, float2(_e5, 0.5), 0.0);
    return _e9;
}

// Radiance of the sky, or of the ground below the horizon, along a direction at four wavelengths, without the sun's disc.
// Cost: 8 exp, 3 reads.
float4 sky_radiance(SkyView view_20, SkyScales scales, Texture2D<float4> smooth_table, Texture2D<float4> haze_table, Texture2D<float4> phase_table_1, SamplerState linear_sampler_1, float3 direction_8)
{
    const float _e7 = elevation_of(direction_8);
    if ((_e7 > view_20.highest_rad)) {
        return (0.0).xxxx;
    }
    const float2 _e12 = uv_from_direction(view_20, direction_8);
    const float _e14 = one_minus_cos_between(direction_8, view_20.sun);
    const float4 _e15 = haze_phase(phase_table_1, linear_sampler_1, _e14);
    float4 _e17 = smooth_table.SampleLevel(linear_sampler_1, _e12, 0.0);
    float4 smooth_light_1 = (exp(_e17) * scales.smooth_light);
    float4 _e22 = haze_table.SampleLevel(linear_sampler_1, _e12, 0.0);
    float4 haze_1 = (exp(_e22) * scales.haze);
    return (smooth_light_1 + (haze_1 * _e15));
}

SpectralPath ConstructSpectralPath(float4 arg0, float4 arg1) {
    SpectralPath ret = (SpectralPath)0;
    ret.transmittance = arg0;
    ret.path_radiance = arg1;
    return ret;
}

// Air between the eye and a point at a distance along a direction, at four wavelengths. The extinction table holds the mean extinction from the first air on, 1/km, as if all of it were below the jump of density nearest to the eye.
// Cost: 12 exp, 4 reads.
SpectralPath aerial_perspective(SkyView view_21, SkyScales scales_1, Texture3D<float4> smooth_table_1, Texture3D<float4> haze_table_1, Texture2D<float4> extinction_table, Texture2D<float4> phase_table_2, SamplerState linear_sampler_2, float3 direction_9, float distance_m_1)
{
    bool local_21 = (bool)0;
    float4 smooth_light = (float4)0;
    float4 haze = (float4)0;

    const float _e9 = elevation_of(direction_9);
    bool is_below_8 = (_e9 < view_21.horizon_rad);
    const float2 _e13 = air_span_m(view_21, direction_9.y, is_below_8);
    float length_m_19 = (min(distance_m_1, _e13.y) - _e13.x);
    if (!((length_m_19 <= 0.0))) {
        local_21 = (_e9 > view_21.highest_rad);
    } else {
        local_21 = true;
    }
    bool _e26 = local_21;
    if (_e26) {
        const SpectralPath spectralpath = ConstructSpectralPath((1.0).xxxx, (0.0).xxxx);
        return spectralpath;
    }
    const float _e33 = share_below_jump(view_21, _e13, direction_9.y, length_m_19, is_below_8);
    float4 extinction_2 = lerp(view_21.extinction_above, (1.0).xxxx, _e33);
    const float _e39 = distance_place(view_21, _e13, direction_9.y, length_m_19, is_below_8);
    const float _e40 = aerial_row_coordinate(view_21, _e9, is_below_8);
    const float _e42 = azimuth_place(direction_9, view_21.sun);
    const float _e43 = aerial_column_place(view_21, _e42);
    const float _e45 = texel_coordinate(_e43, AERIAL_AZIMUTHS);
    const float _e47 = texel_coordinate(_e39, AERIAL_DISTANCES);
    float3 uvw = float3(_e45, _e40, _e47);
    const float _e50 = one_minus_cos_between(direction_9, view_21.sun);
    const float4 _e51 = haze_phase(phase_table_2, linear_sampler_2, _e50);
    float4 _e54 = extinction_table.SampleLevel(linear_sampler_2, uvw.zy, 0.0);
    float4 depth_5 = ((_e54 * extinction_2) * (length_m_19 * 0.001));
    float4 _e60 = smooth_table_1.SampleLevel(linear_sampler_2, uvw, 0.0);
    smooth_light = (exp(_e60) * scales_1.smooth_light);
    float4 _e66 = haze_table_1.SampleLevel(linear_sampler_2, uvw, 0.0);
    haze = (exp(_e66) * scales_1.haze);
    float4 _e71 = smooth_light;
    smooth_light = (_e71 * lerp(view_21.smooth_above, (1.0).xxxx, _e33));
    float4 _e77 = haze;
    haze = (_e77 * lerp(view_21.haze_above, (1.0).xxxx, _e33));
    const float3 _e84 = mean_transmittance_rgb(depth_5.xyz);
    const float _e86 = mean_transmittance(depth_5.w);
    float4 opacity_2 = (depth_5 * float4(_e84, _e86));
    float4 _e92 = smooth_light;
    float4 _e93 = haze;
    const SpectralPath spectralpath_1 = ConstructSpectralPath(((1.0).xxxx - opacity_2), (((_e92 + (_e93 * _e51)) / extinction_2) * opacity_2));
    return spectralpath_1;
}

// Transmittance of the air between the eye and a point at a distance along a direction, at four wavelengths: that of `aerial_perspective` alone.
// Cost: 4 exp, 1 read.
float4 aerial_transmittance(SkyView view_22, Texture2D<float4> extinction_table_1, SamplerState linear_sampler_3, float3 direction_10, float distance_m_2)
{
    bool local_22 = (bool)0;

    const float _e5 = elevation_of(direction_10);
    bool is_below_9 = (_e5 < view_22.horizon_rad);
    const float2 _e9 = air_span_m(view_22, direction_10.y, is_below_9);
    float length_m_20 = (min(distance_m_2, _e9.y) - _e9.x);
    if (!((length_m_20 <= 0.0))) {
        local_22 = (_e5 > view_22.highest_rad);
    } else {
        local_22 = true;
    }
    bool _e22 = local_22;
    if (_e22) {
        return (1.0).xxxx;
    }
    const float _e26 = share_below_jump(view_22, _e9, direction_10.y, length_m_20, is_below_9);
    float4 extinction_3 = lerp(view_22.extinction_above, (1.0).xxxx, _e26);
    const float _e32 = distance_place(view_22, _e9, direction_10.y, length_m_20, is_below_9);
    const float _e33 = aerial_row_coordinate(view_22, _e5, is_below_9);
    const float _e35 = texel_coordinate(_e32, AERIAL_DISTANCES);
    float2 uv = float2(_e35, _e33);
    float4 _e38 = extinction_table_1.SampleLevel(linear_sampler_3, uv, 0.0);
    return exp(((_e38 * extinction_3) * (length_m_20 * -0.001)));
}

// Transmittance and path radiance in red, green and blue, for scenes in these: the transmittance of a channel is that of sunlight.
// Cost: no exp.
PathOptics rgb_path(RgbWeights radiance_3, RgbWeights transmittance, SpectralPath path_1)
{
    const float3 _e4 = rgb_from_spectrum(transmittance, path_1.transmittance);
    const float3 _e6 = rgb_from_spectrum(radiance_3, path_1.path_radiance);
    const PathOptics pathoptics_12 = ConstructPathOptics(_e4, _e6);
    return pathoptics_12;
}

// Place of a row, 0 to 1, from the absolute elevation and its sine.
// Cost: 2 exp.
float fog_row_place(float per_sine, float sine, float elevation_rad_4)
{
    float logarithm = (log((1.0 + (sine * per_sine))) / log((1.0 + per_sine)));
    return ((FOG_LOGARITHMIC * logarithm) + (0.25464788 * elevation_rad_4));
}

// Texture coordinate of the rows of a direction: falling rays come first.
// Cost: 2 exp.
float fog_row_coordinate(FogTableView view_23, float3 direction_11)
{
    bool is_above = (direction_11.y > 0.0);
    float per_sine_1 = (is_above ? view_23.above_per_sine : view_23.below_per_sine);
    const float _e10 = elevation_of(direction_11);
    const float _e12 = fog_row_place(per_sine_1, abs(direction_11.y), abs(_e10));
    return ((((is_above ? FOG_ROWS : 0.0) + 0.5) + (_e12 * 63.0)) / 128.0);
}

// Texture coordinate in stacked tables from that in the table of the layer.
// Cost: no exp.
float fog_stacked_coordinate(FogTableView view_24, float coordinate_2)
{
    return ((view_24.layer + coordinate_2) / view_24.layer_count);
}

// Opacity of an optical depth: 1 minus the transmittance, without cancellation.
// Cost: 3 exp.
float3 fog_opacity(float3 depth_2)
{
    const float3 _e1 = mean_transmittance_rgb(depth_2);
    return (depth_2 * _e1);
}

// Place of a distance, 0 to 1, from the opacity and the transmittance up to there, relative to those of the whole ray to the ground or through the fog.
// Cost: 6 exp.
float fog_distance_place(FogTableView view_25, float sin_elevation_15, float3 opacity, float3 transmittance_1)
{
    float3 vertical = ((sin_elevation_15 > 0.0) ? view_25.depth_above : view_25.depth_below);
    float3 depth_6 = min((vertical / (max(abs(sin_elevation_15), 1e-10)).xxx), (1e25).xxx);
    const float3 _e17 = fog_opacity(depth_6);
    float whole = dot(_e17, (1.0).xxx);
    float thin = (whole - dot(opacity, (1.0).xxx));
    float dense_1 = dot((transmittance_1 - exp(-(depth_6))), (1.0).xxx);
    float left = clamp((((whole < 1.5) ? thin : dense_1) / max(whole, 1e-30)), 0.0, 1.0);
    return (1.0 - sqrt(sqrt(left)));
}

// Sunlight that is scattered once with a phase function, by its index, in a stream (0, 1 or 2), per unit of opacity, before its scale: from the texture coordinates of distance, row and angle.
// Cost: 3 exp, 2 reads.
float3 fog_stream_light(FogTableView view_26, Texture3D<float4> stream_table, Texture2D<float4> stream_phase_table, SamplerState linear_sampler_4, float3 place_9, float phase_1, float stream)
{
    float slice = ((((3.0 * phase_1) + stream) + 0.5) / (3.0 * view_26.phase_count));
    const float _e17 = fog_stacked_coordinate(view_26, slice);
    float3 uvw_1 = float3(place_9.xy, _e17);
    float4 logarithms = stream_table.SampleLevel(linear_sampler_4, uvw_1, 0.0);
    float4 scattered_2 = stream_phase_table.SampleLevel(linear_sampler_4, float2(place_9.z, slice), 0.0);
    return (exp(logarithms.xyz) * scattered_2.xyz);
}

// A layer of fog between the eye and a point, by its optical depth on the way: extinction times `exponential_column_m`, or the column of another profile. Rays end at the ground. Of several layers, transmittances multiply and path radiances add up. A step is a phase function of the fog.
// Cost: 14 exp, 9 exp a step, 1 read, 6 reads a step.
PathOptics tabulated_fog(FogTableView view_27, Texture3D<float4> diffuse_table, Texture3D<float4> stream_table_1, Texture2D<float4> stream_phase_table_1, SamplerState linear_sampler_5, float3 direction_12, float3 optical_depth_2)
{
    float3 sunlit_1 = (0.0).xxx;
    float phase_2 = 0.0;

    const float3 _e7 = fog_opacity(optical_depth_2);
    float3 transmittance_3 = exp(-(optical_depth_2));
    const float _e11 = azimuth_place(direction_12, view_27.sun);
    const float _e13 = texel_coordinate(_e11, FOG_AZIMUTHS);
    const float _e14 = fog_row_coordinate(view_27, direction_12);
    const float _e16 = fog_distance_place(view_27, direction_12.y, _e7, transmittance_3);
    const float _e18 = texel_coordinate(_e16, FOG_DISTANCES);
    const float _e19 = fog_stacked_coordinate(view_27, _e18);
    float3 uvw_2 = float3(_e13, _e14, _e19);
    float4 _e22 = diffuse_table.SampleLevel(linear_sampler_5, uvw_2, 0.0);
    float3 diffuse = _e22.xyz;
    const float _e25 = one_minus_cos_between(direction_12, view_27.sun);
    const float _e26 = phase_place(_e25);
    const float _e28 = texel_coordinate(_e26, PHASE_ANGLES);
    float3 place_13 = float3(_e18, _e14, _e28);
    bool loop_init_12 = true;
    while(true) {
        if (!loop_init_12) {
            float _e51 = phase_2;
            phase_2 = (_e51 + 1.0);
        }
        loop_init_12 = false;
        float _e35 = phase_2;
        if ((_e35 < view_27.phase_count)) {
        } else {
            break;
        }
        {
            float3 _e38 = sunlit_1;
            float _e39 = phase_2;
            const float3 _e41 = fog_stream_light(view_27, stream_table_1, stream_phase_table_1, linear_sampler_5, place_13, _e39, 0.0);
            float _e42 = phase_2;
            const float3 _e44 = fog_stream_light(view_27, stream_table_1, stream_phase_table_1, linear_sampler_5, place_13, _e42, 1.0);
            float _e46 = phase_2;
            const float3 _e48 = fog_stream_light(view_27, stream_table_1, stream_phase_table_1, linear_sampler_5, place_13, _e46, 2.0);
            sunlit_1 = (_e38 + ((_e41 + _e44) + _e48));
        }
    }
    float3 _e57 = sunlit_1;
    float3 source_1 = ((view_27.diffuse_scale * diffuse) + (view_27.sunlit_scale * max(_e57, (0.0).xxx)));
    const PathOptics pathoptics_13 = ConstructPathOptics(transmittance_3, (_e7 * source_1));
    return pathoptics_13;
}

// Scattering by molecules, 1/m.
// Cost: 1 exp.
float3 article_sigma_rayleigh(float3 position_3)
{
    float height_m_14 = (length(position_3) - ARTICLE_PLANET_RADIUS_M);
    return (float3(5.8e-6, 1.35e-5, 3.3099997e-5) * exp((-(height_m_14) / ARTICLE_RAYLEIGH_SCALE_M)));
}

// Scattering by haze, 1/m.
// Cost: 1 exp.
float3 article_sigma_mie(float3 position_4)
{
    float height_m_15 = (length(position_4) - ARTICLE_PLANET_RADIUS_M);
    return (float3(2.1e-5, 2.1e-5, 2.1e-5) * exp((-(height_m_15) / ARTICLE_MIE_SCALE_M)));
}

// Absorption by ozone, 1/m.
// Cost: 1 exp.
float3 article_sigma_ozone(float3 position_5)
{
    float height_m_16 = (length(position_5) - ARTICLE_PLANET_RADIUS_M);
    return (float3(2.0556e-6, 4.9788e-6, 2.136e-7) * exp((-(height_m_16) / ARTICLE_RAYLEIGH_SCALE_M)));
}

// Extinction, 1/m.
// Cost: 3 exp.
float3 article_sigma_t(float3 position_6)
{
    const float3 _e1 = article_sigma_rayleigh(position_6);
    const float3 _e2 = article_sigma_mie(position_6);
    const float3 _e6 = article_sigma_ozone(position_6);
    return ((_e1 + (1.11 * _e2)) + _e6);
}

// Transmittance between two points.
// Cost: 3 exp, 3 exp a step; 8 steps.
float3 article_transmittance(float3 from_m_8, float3 to_m_7)
{
    float3 sum_5 = (0.0).xxx;
    int i_12 = int(0);

    float3 ds = ((to_m_7 - from_m_8) / (8.0).xxx);
    bool loop_init_13 = true;
    while(true) {
        if (!loop_init_13) {
            int _e23 = i_12;
            i_12 = asint(asuint(_e23) + asuint(int(1)));
        }
        loop_init_13 = false;
        int _e11 = i_12;
        if ((_e11 < ARTICLE_STEPS)) {
        } else {
            break;
        }
        {
            float3 _e14 = sum_5;
            int _e15 = i_12;
            const float3 _e21 = article_sigma_t((from_m_8 + ((float(_e15) + 0.5) * ds)));
            sum_5 = (_e14 + _e21);
        }
    }
    float3 _e26 = sum_5;
    return exp((-(_e26) * length(ds)));
}

// Distance to a sphere around the centre from a point inside, m.
// Cost: no exp.
float article_distance_m(float3 origin, float3 direction_13, float radius_m_3)
{
    float b_5 = dot(origin, direction_13);
    return (-(b_5) + sqrt(((b_5 * b_5) - (dot(origin, origin) - (radius_m_3 * radius_m_3)))));
}

// Phase function of molecules, 1/sr.
// Cost: no exp.
float article_rayleigh_phase(float mu)
{
    return (0.059683103 * (1.0 + (mu * mu)));
}

// Phase function of haze, 1/sr: Henyey-Greenstein, `g` = 0.76.
// Cost: 1 exp.
float article_mie_phase(float mu_1)
{
    return ((1.0 - (0.76 * 0.76)) / (12.566371 * pow(((1.0 + (0.76 * 0.76)) - ((2.0 * 0.76) * mu_1)), 1.5)));
}

ArticleSky ConstructArticleSky(float3 arg0, float arg1, float3 arg2, float arg3) {
    ArticleSky ret = (ArticleSky)0;
    ret.eye = arg0;
    ret.sun_radius_rad = arg1;
    ret.outer_space = arg2;
    ret.sun_solid_angle = arg3;
    return ret;
}

// Eye at an altitude, and a sun that is white and has an illuminance (120 000 lx in the article) on the ground when it stands at the zenith. Compute it once for all pixels. The solid angle, `1 - cos`, keeps three digits at best.
// Cost: 7 exp.
ArticleSky article_sky(float eye_altitude_m, float zenith_illuminance)
{
    float3 eye_5 = float3(0.0, (ARTICLE_PLANET_RADIUS_M + eye_altitude_m), 0.0);
    float origin_h = (eye_5.y - ARTICLE_PLANET_RADIUS_M);
    float rayleigh_m = (ARTICLE_RAYLEIGH_SCALE_M * (exp((-(origin_h) / ARTICLE_RAYLEIGH_SCALE_M)) - exp((-(60000.0) / ARTICLE_RAYLEIGH_SCALE_M))));
    float mie_m = (ARTICLE_MIE_SCALE_M * (exp((-(origin_h) / ARTICLE_MIE_SCALE_M)) - exp((-(60000.0) / ARTICLE_MIE_SCALE_M))));
    float3 depth_7 = (((float3(5.8e-6, 1.35e-5, 3.3099997e-5) * rayleigh_m) + (float3(2.1e-5, 2.1e-5, 2.1e-5) * mie_m)) + (float3(2.0556e-6, 4.9788e-6, 2.136e-7) * rayleigh_m));
    float solid_angle = (6.2831855 * (1.0 - cos(0.0046251225)));
    const ArticleSky articlesky = ConstructArticleSky(eye_5, 0.0046251225, (((zenith_illuminance).xxx / (solid_angle).xxx) / exp(-(depth_7))), solid_angle);
    return articlesky;
}

// Light that a point scatters along a view ray, per metre.
// Cost: 6 exp, 3 exp a step; 8 steps.
float3 article_source(ArticleSky sky, float3 position_7, float3 view_28, float3 sun_1)
{
    const float _e5 = article_distance_m(position_7, sun_1, ARTICLE_TOP_RADIUS_M);
    float3 leaves = (position_7 + (sun_1 * _e5));
    const float3 _e8 = article_transmittance(position_7, leaves);
    float mu_3 = dot(view_28, sun_1);
    const float3 _e10 = article_sigma_rayleigh(position_7);
    const float _e11 = article_rayleigh_phase(mu_3);
    float3 rayleigh = (_e10 * _e11);
    const float3 _e13 = article_sigma_mie(position_7);
    const float _e14 = article_mie_phase(mu_3);
    float3 mie = (_e13 * _e14);
    return (((sky.outer_space * _e8) * sky.sun_solid_angle) * (rayleigh + mie));
}

// Luminance of the sky along a direction above the horizon, without the sun's disc.
// Cost: 15 exp a step; 8 steps, in each of which two marches of 8 steps take 6 of these, 456 in all.
float3 article_luminance(ArticleSky sky_1, float3 view_29, float3 sun_2)
{
    float3 sum_6 = (0.0).xxx;
    int i_13 = int(0);

    const float _e6 = article_distance_m(sky_1.eye, view_29, ARTICLE_TOP_RADIUS_M);
    float3 leaves_1 = (sky_1.eye + (view_29 * _e6));
    float3 ds_1 = ((leaves_1 - sky_1.eye) / (8.0).xxx);
    float3 direction_15 = (ds_1 / (length(ds_1)).xxx);
    bool loop_init_14 = true;
    while(true) {
        if (!loop_init_14) {
            int _e38 = i_13;
            i_13 = asint(asuint(_e38) + asuint(int(1)));
        }
        loop_init_14 = false;
        int _e22 = i_13;
        if ((_e22 < ARTICLE_STEPS)) {
        } else {
            break;
        }
        {
            int _e26 = i_13;
            float3 s_2 = (sky_1.eye + ((float(_e26) + 0.5) * ds_1));
            float3 _e32 = sum_6;
            const float3 _e34 = article_transmittance(sky_1.eye, s_2);
            const float3 _e35 = article_source(sky_1, s_2, direction_15, sun_2);
            sum_6 = (_e32 + (_e34 * _e35));
        }
    }
    float3 _e41 = sum_6;
    return (_e41 * length(ds_1));
}

// Luminance of the sun's disc along a direction above the horizon, whose edge is smooth from 0.95 to 1.05 of its radius. The cosine is clamped to 1, unlike as printed.
// Cost: 3 exp, 3 exp a step; 8 steps.
float3 article_disc(ArticleSky sky_2, float3 view_30, float3 sun_3)
{
    float angle = acos(min(dot(view_30, sun_3), 1.0));
    float disc = (1.0 - smoothstep((0.95 * sky_2.sun_radius_rad), (1.05 * sky_2.sun_radius_rad), angle));
    const float _e19 = article_distance_m(sky_2.eye, view_30, ARTICLE_TOP_RADIUS_M);
    float3 leaves_2 = (sky_2.eye + (view_30 * _e19));
    const float3 _e25 = article_transmittance(sky_2.eye, leaves_2);
    return ((sky_2.outer_space * disc) * _e25);
}

LimbDarkening ConstructLimbDarkening(float4 arg0, float4 arg1, float4 arg2, float4 arg3, float4 arg4, float4 arg5) {
    LimbDarkening ret = (LimbDarkening)0;
    ret.zeroth = arg0;
    ret.first = arg1;
    ret.second = arg2;
    ret.third = arg3;
    ret.fourth = arg4;
    ret.fifth = arg5;
    return ret;
}

// Limb darkening at wavelengths from 423 to 1099 nm, to which others are clamped (Neckel, Sol. Phys. 229, 13, 2005, table 2). Compute it once for all pixels.
// Cost: no exp.
LimbDarkening limb_darkening(float4 wavelengths_nm)
{
    float4 per_um = ((1000.0).xxxx / clamp(wavelengths_nm, (422.57).xxxx, (1099.0).xxxx));
    float4 power = ((((per_um * per_um) * per_um) * per_um) * per_um);
    float4 zeroth = ((0.75267).xxxx - (0.265577 * per_um));
    float4 first_4 = (((0.93874).xxxx + (0.265577 * per_um)) - (0.004095 * power));
    float4 second = ((-1.89287).xxxx + (0.012582 * power));
    float4 third = ((2.42234).xxxx - (0.017117 * power));
    float4 fourth = ((-1.7115).xxxx + (0.011977 * power));
    float4 fifth = ((0.49062).xxxx - (0.003347 * power));
    float4 mean_1 = (((((zeroth + (first_4 * 0.6666667)) + (second * 0.5)) + (third * 0.4)) + (fourth * 0.33333334)) + (fifth * 0.2857143));
    const LimbDarkening limbdarkening = ConstructLimbDarkening((zeroth / mean_1), (first_4 / mean_1), (second / mean_1), (third / mean_1), (fourth / mean_1), (fifth / mean_1));
    return limbdarkening;
}

// Radiance of the disc at `mu`, relative to its mean.
// Cost: no exp.
float4 limb_profile(LimbDarkening limb, float mu_2)
{
    return (limb.zeroth + (mu_2 * (limb.first + (mu_2 * (limb.second + (mu_2 * (limb.third + (mu_2 * (limb.fourth + (mu_2 * limb.fifth))))))))));
}

// Place of a direction on the disc: the sine of its angle from the centre divided by the sine of the disc's angular radius, 0 to 1; more than 1 outside. `one_minus_cos` is that between the direction and the sun.
// Cost: no exp.
float place_on_disc(float sin_radius, float one_minus_cos_8)
{
    return (((one_minus_cos_8 < 1.0) ? sqrt(max((one_minus_cos_8 * (2.0 - one_minus_cos_8)), 0.0)) : 2.0) / sin_radius);
}

// Part of a pixel that the disc covers, 0 to 1: a ramp as wide as a pixel across the edge, so that the edge is smooth and the disc's light is kept, within `(pixel / radius)^2 / 12`. `sin_pixel` is the sine of the angle that a pixel spans; 0 gives a sharp edge.
// Cost: no exp.
float disc_coverage(float place_10, float sin_radius_1, float sin_pixel)
{
    return clamp((((1.0 - place_10) * (sin_radius_1 / max(sin_pixel, (1e-6 * sin_radius_1)))) + 0.5), 0.0, 1.0);
}

// Radiance of the sun's disc in a pixel whose centre is `one_minus_cos` from the sun, from the disc's mean radiance: the irradiance on a surface that faces the sun, divided by `pi sin_radius^2`. Without attenuation by air.
// Cost: no exp.
float4 sun_disc_radiance(LimbDarkening limb_1, float4 mean_radiance, float sin_radius_2, float sin_pixel_1, float one_minus_cos_9)
{
    const float _e5 = place_on_disc(sin_radius_2, one_minus_cos_9);
    float mu_4 = sqrt(max(((1.0 - _e5) * (1.0 + _e5)), 0.0));
    const float4 _e14 = limb_profile(limb_1, mu_4);
    const float _e16 = disc_coverage(_e5, sin_radius_2, sin_pixel_1);
    return ((mean_radiance * _e14) * _e16);
}

// Reflection of sunlight at a place on the moon's disc, from unit vectors to the moon, from the moon to the sun and along the view: the law of Lommel and Seeliger, `mu_0 / (mu_0 + mu)` with the cosines of incidence and emission; 1/2 where they are equal, 0 outside the disc and on the night side.
// Cost: no exp.
float moon_reflection(float3 moon, float3 to_sun_1, float sin_radius_3, float3 direction_14)
{
    bool local_23 = (bool)0;
    bool local_24 = (bool)0;

    float3 apart_1 = (direction_14 - moon);
    float3 aside = ((apart_1 - (moon * dot(apart_1, moon))) / (sin_radius_3).xxx);
    float emission = sqrt(max((1.0 - dot(aside, aside)), 0.0));
    float incidence = (dot(aside, to_sun_1) - (emission * dot(moon, to_sun_1)));
    if (!((emission <= 0.0))) {
        local_23 = (incidence <= 0.0);
    } else {
        local_23 = true;
    }
    bool _e28 = local_23;
    if (!(_e28)) {
        local_24 = (dot(direction_14, moon) <= 0.0);
    } else {
        local_24 = true;
    }
    bool _e36 = local_24;
    if (_e36) {
        return 0.0;
    }
    return (incidence / (incidence + emission));
}

// No curve: components above 1 and below 0 are clipped.
// Cost: no exp.
float3 clip_tone(float3 exposed)
{
    return clamp(exposed, (0.0).xxx, (1.0).xxx);
}

// Response `x^n / (x^n + q)` of film and retina (Naka & Rushton 1966), at which 0.18 stays 0.18. `contrast` is its slope there on logarithmic axes, 0.5 to 3.
// Cost: 3 exp.
float3 camera_response(float3 x_3, float contrast)
{
    float3 ratio = ((0.18).xxx / max(x_3, (1e-8).xxx));
    float3 response = ((1.0).xxx / ((1.0).xxx + (4.555556 * pow(ratio, ((contrast / 0.82)).xxx))));
    return select_each((x_3 <= (1.1e-8).xxx), (0.0).xxx, response);
}

// Curve in the manner of a camera: contrast around middle grey, highlights that roll off to white, hue kept. `contrast` is usually 1.2, `saturation` 1 (0: grey).
// Cost: 3 exp.
float3 camera_tone(float3 exposed_1, float contrast_1, float saturation)
{
    const float3 _e3 = without_negatives(exposed_1);
    const float _e4 = srgb_luminance(_e3);
    float3 linear_1 = lerp(_e3, (_e4).xxx, 0.01);
    float least_4 = min(linear_1.x, min(linear_1.y, linear_1.z));
    float most_2 = max(linear_1.x, max(linear_1.y, linear_1.z));
    const float3 _e18 = camera_response(linear_1, contrast_1);
    float hi = max(_e18.x, max(_e18.y, _e18.z));
    float dark_1 = (((1.0 - hi) * (1.0 - hi)) * (1.0 - hi));
    float3 curved_2 = lerp(_e18, (linear_1 * (hi / max(most_2, 1e-30))), dark_1);
    float lo = min(curved_2.x, min(curved_2.y, curved_2.z));
    float3 kept = ((lo).xxx + (((hi - lo) / max((most_2 - least_4), 1e-30)) * (linear_1 - (least_4).xxx)));
    float3 toned = lerp(kept, curved_2, 0.2);
    const float _e54 = srgb_luminance(toned);
    const float3 _e57 = into_unit_cube(lerp((_e54).xxx, toned, saturation));
    return _e57;
}

// Response of the base look of AgX (T. Sobotka 2022): a sigmoid of the logarithm from 10 stops below middle grey to 6.5 stops above.
// Cost: 9 exp.
float3 agx_response(float3 x_4)
{
    float3 stops = log2((max(x_4, (1e-9).xxx) / (0.18).xxx));
    float3 place_14 = clamp(((stops + (10.0).xxx) / (16.5).xxx), (0.0).xxx, (1.0).xxx);
    float3 from_grey = (place_14 - (0.6060606).xxx);
    bool3 is_toe = (from_grey < (0.0).xxx);
    float3 limit = select_each(is_toe, (0.5656756).xxx, (0.7151983).xxx);
    float3 u_2 = (2.4 * abs(from_grey));
    float3 bent = (u_2 / limit);
    float3 rise_2 = (u_2 / pow(((1.0).xxx + (bent * sqrt(bent))), (0.6666667).xxx));
    float3 signal_2 = clamp(((0.4894371).xxx + select_each(is_toe, -(rise_2), rise_2)), (0.0).xxx, (1.0).xxx);
    return pow(signal_2, (2.4).xxx);
}

// Base look of AgX: highlights roll off, and bright saturated colours turn white early.
// Cost: 9 exp.
float3 agx_tone(float3 exposed_2)
{
    float3 weights_2 = float3(0.212, 0.3922, 0.3958);
    const float3 _e5 = without_negatives(exposed_2);
    float3 inset = lerp(_e5, (dot(weights_2, _e5)).xxx, 0.2);
    const float3 _e10 = agx_response(inset);
    const float3 _e19 = into_unit_cube(((_e10 - ((0.2 * dot(weights_2, _e10))).xxx) / (0.8).xxx));
    return _e19;
}

// Hash of a number: neighbours are unrelated.
// Cost: no exp.
uint dither_hash(uint n)
{
    uint once = ((n ^ (n >> 16u)) * 569420461u);
    uint twice = ((once ^ (once >> 15u)) * 1935289751u);
    return (twice ^ (twice >> 15u));
}

// Three numbers from 0 to below 1 from the bits of a hash.
// Cost: no exp.
float3 numbers_from_bits(uint bits)
{
    return (float3(float((bits >> 22u)), float(((bits >> 11u) & 1023u)), float((bits & 1023u))) / (1024.0).xxx);
}

// Noise of a pixel, in levels: between -1 and 1, mean 0, variance 1/6. Along a row it is the difference of successive hashes.
// Cost: no exp.
float3 triangular_noise(uint column_2, uint row)
{
    const uint _e4 = dither_hash((row ^ 1540483477u));
    const uint _e8 = dither_hash((_e4 + (column_2 * 2654435769u)));
    const float3 _e9 = numbers_from_bits(_e8);
    const uint _e15 = dither_hash((_e4 + ((column_2 + 1u) * 2654435769u)));
    const float3 _e16 = numbers_from_bits(_e15);
    return (_e16 - _e9);
}

// A signal from 0 to 1 with noise, to be stored in a target of `levels` levels above 0 (255 for 8 bits), which rounds to the nearest. Black and white stay unchanged, and no noise exceeds them.
// Cost: no exp.
float3 dithered(float3 signal_1, float levels, uint column_3, uint row_1)
{
    float3 level = (signal_1 * levels);
    float3 room = min(min(level, ((levels).xxx - level)), (1.0).xxx);
    const float3 _e11 = triangular_noise(column_3, row_1);
    return ((level + (_e11 * room)) / (levels).xxx);
}

float ZeroValuefloat() {
    return (float)0;
}

float3 ZeroValuefloat3() {
    return (float3)0;
}

DropletPhase ZeroValueDropletPhase() {
    return (DropletPhase)0;
}

PathOptics ZeroValuePathOptics() {
    return (PathOptics)0;
}

RaySegment ZeroValueRaySegment() {
    return (RaySegment)0;
}

FogMedium ZeroValueFogMedium() {
    return (FogMedium)0;
}

FogLight ZeroValueFogLight() {
    return (FogLight)0;
}

FogLayer ZeroValueFogLayer() {
    return (FogLayer)0;
}

FogLayers ZeroValueFogLayers() {
    return (FogLayers)0;
}

bool ZeroValuebool() {
    return (bool)0;
}

AirMedium ZeroValueAirMedium() {
    return (AirMedium)0;
}

AirLight ZeroValueAirLight() {
    return (AirLight)0;
}

AirMarch ZeroValueAirMarch() {
    return (AirMarch)0;
}

LightRayGeometry ZeroValueLightRayGeometry() {
    return (LightRayGeometry)0;
}

uint ZeroValueuint() {
    return (uint)0;
}

LocalLight ZeroValueLocalLight() {
    return (LocalLight)0;
}

LightRay ZeroValueLightRay() {
    return (LightRay)0;
}

ExponentialFog ZeroValueExponentialFog() {
    return (ExponentialFog)0;
}

RgbWeights ZeroValueRgbWeights() {
    return (RgbWeights)0;
}

float4 ZeroValuefloat4() {
    return (float4)0;
}

SkyView ZeroValueSkyView() {
    return (SkyView)0;
}

float2 ZeroValuefloat2() {
    return (float2)0;
}

SkyScales ZeroValueSkyScales() {
    return (SkyScales)0;
}

SpectralPath ZeroValueSpectralPath() {
    return (SpectralPath)0;
}

FogTableView ZeroValueFogTableView() {
    return (FogTableView)0;
}

ArticleSky ZeroValueArticleSky() {
    return (ArticleSky)0;
}

LimbDarkening ZeroValueLimbDarkening() {
    return (LimbDarkening)0;
}
