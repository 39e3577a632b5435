// requires: exponentials, phase, path_optics, sky_tables
// Fog over flat ground with all orders of scattering, from tables that the library fills for one fog, one height of the eye and one
// sun (`FogTables`). The tables hold the source function, path radiance per unit of opacity, in two parts: light that is scattered
// several times, and sunlight that is scattered once, without its phase function, in three streams, of which the fog's forward peak
// removes nothing, half and all. So neither the peak nor its blur needs texels.
//
// Fog of several layers is the sum of what each adds to a ray, per unit of its own opacity: a function of direction and of that
// opacity alone, as a ray outside of a layer gains nothing from it. Their tables are stacked; layers of one density profile count
// as one. A layer adds sunlight by each phase function of the fog, as its forward peak scatters on what other layers have scattered.

/// Columns of the table of diffuse light, from the azimuth of the sun to the opposite one.
const FOG_AZIMUTHS: f32 = 32.0;
/// Rows of falling rays, from the horizontal to the nadir, and again of rising ones.
const FOG_ROWS: f32 = 64.0;
/// Distances of the tables.
const FOG_DISTANCES: f32 = 32.0;
/// Part of the logarithm of the sine of the elevation in the spacing of rows; the rest is that of the elevation.
const FOG_LOGARITHMIC: f32 = 0.6;

/// What the tables of a layer of fog are made for.
struct FogTableView {
    /// Unit vector to the sun.
    sun: vec3<f32>,
    /// 1 over the sine up to which rows of falling rays are even.
    below_per_sine: f32,
    /// Optical depth of the layer straight down to the ground.
    depth_below: vec3<f32>,
    /// 1 over the sine up to which rows of rising rays are even.
    above_per_sine: f32,
    /// Optical depth of the layer straight up.
    depth_above: vec3<f32>,
    /// Factor of diffuse light.
    diffuse_scale: f32,
    /// Factor of sunlight scattered once.
    sunlit_scale: f32,
    /// Index of the layer among those of the tables.
    layer: f32,
    /// Number of layers of the tables.
    layer_count: f32,
    /// Number of phase functions of the fog.
    phase_count: f32,
}

/// Place of a row, 0 to 1, from the absolute elevation and its sine.
///
/// Cost: 2 exp. Error: 1e-6 relative plus 2e-6 absolute.
fn fog_row_place(per_sine: f32, sine: f32, elevation_rad: f32) -> f32 {
    let logarithm = log(1.0 + sine * per_sine) / log(1.0 + per_sine);
    return FOG_LOGARITHMIC * logarithm + (1.0 - FOG_LOGARITHMIC) * 0.6366197723675814 * elevation_rad;
}

/// Texture coordinate of the rows of a direction: falling rays come first.
///
/// Cost: 2 exp. Error: 1e-6 relative plus 2e-6 absolute.
fn fog_row_coordinate(view: FogTableView, direction: vec3<f32>) -> f32 {
    let is_above = direction.y > 0.0;
    let per_sine = select(view.below_per_sine, view.above_per_sine, is_above);
    let place = fog_row_place(per_sine, abs(direction.y), abs(elevation_of(direction)));
    return (select(0.0, FOG_ROWS, is_above) + 0.5 + place * (FOG_ROWS - 1.0)) / (2.0 * FOG_ROWS);
}

/// Texture coordinate in stacked tables from that in the table of the layer.
///
/// Cost: no exp. Error: 2e-7 relative.
fn fog_stacked_coordinate(view: FogTableView, coordinate: f32) -> f32 {
    return (view.layer + coordinate) / view.layer_count;
}

/// Opacity of an optical depth: 1 minus the transmittance, without cancellation.
///
/// Cost: 3 exp. Error: 1e-6 relative.
fn fog_opacity(depth: vec3<f32>) -> vec3<f32> {
    return depth * mean_transmittance_rgb(depth);
}

/// Place of a distance, 0 to 1, from the opacity and the transmittance up to there, relative to those of the whole ray to the
/// ground or through the fog.
///
/// Cost: 6 exp. Error: 1e-5 absolute.
fn fog_distance_place(view: FogTableView, sin_elevation: f32, opacity: vec3<f32>, transmittance: vec3<f32>) -> f32 {
    let vertical = select(view.depth_below, view.depth_above, sin_elevation > 0.0);
    let depth = min(vertical / max(abs(sin_elevation), 1e-10), vec3<f32>(OPAQUE));
    let whole = dot(fog_opacity(depth), vec3<f32>(1.0));
    // What is left of the opacity: that of thin fog would cancel in transmittances, that of dense fog in opacities.
    let thin = whole - dot(opacity, vec3<f32>(1.0));
    let dense = dot(transmittance - exp(-depth), vec3<f32>(1.0));
    let left = clamp(select(dense, thin, whole < 1.5) / max(whole, 1e-30), 0.0, 1.0);
    return 1.0 - sqrt(sqrt(left));
}

/// Sunlight that is scattered once with a phase function, by its index, in a stream (0, 1 or 2), per unit of opacity, before its
/// scale: from the texture coordinates of distance, row and angle.
///
/// Cost: 3 exp, 2 reads. Error: 2e-3 relative plus 1e-5 absolute.
fn fog_stream_light(
    view: FogTableView,
    stream_table: texture_3d<f32>,
    stream_phase_table: texture_2d<f32>,
    linear_sampler: sampler,
    place: vec3<f32>,
    phase: f32,
    stream: f32,
) -> vec3<f32> {
    let slice = (3.0 * phase + stream + 0.5) / (3.0 * view.phase_count);
    let uvw = vec3<f32>(place.xy, fog_stacked_coordinate(view, slice));
    let logarithms = textureSampleLevel(stream_table, linear_sampler, uvw, 0.0);
    let scattered = textureSampleLevel(stream_phase_table, linear_sampler, vec2<f32>(place.z, slice), 0.0);
    return exp(logarithms.xyz) * scattered.xyz;
}

/// A layer of fog between the eye and a point, by its optical depth on the way: extinction times `exponential_column_m`, or the
/// column of another profile. Rays end at the ground. Of several layers, transmittances multiply and path radiances add up. A step is
/// a phase function of the fog.
///
/// Cost: 14 exp, 9 exp a step, 1 read, 6 reads a step. Error: 3e-3 relative plus 1e-5 absolute.
fn tabulated_fog(
    view: FogTableView,
    diffuse_table: texture_3d<f32>,
    stream_table: texture_3d<f32>,
    stream_phase_table: texture_2d<f32>,
    linear_sampler: sampler,
    direction: vec3<f32>,
    optical_depth: vec3<f32>,
) -> PathOptics {
    let opacity = fog_opacity(optical_depth);
    let transmittance = exp(-optical_depth);
    let u = texel_coordinate(azimuth_place(direction, view.sun), FOG_AZIMUTHS);
    let v = fog_row_coordinate(view, direction);
    let w = texel_coordinate(fog_distance_place(view, direction.y, opacity, transmittance), FOG_DISTANCES);
    let uvw = vec3<f32>(u, v, fog_stacked_coordinate(view, w));
    let diffuse = textureSampleLevel(diffuse_table, linear_sampler, uvw, 0.0).xyz;
    let angle = texel_coordinate(phase_place(one_minus_cos_between(direction, view.sun)), PHASE_ANGLES);
    let place = vec3<f32>(w, v, angle);
    var sunlit = vec3<f32>(0.0);
    for (var phase = 0.0; phase < view.phase_count; phase += 1.0) {
        sunlit += fog_stream_light(view, stream_table, stream_phase_table, linear_sampler, place, phase, 0.0)
            + fog_stream_light(view, stream_table, stream_phase_table, linear_sampler, place, phase, 1.0)
            + fog_stream_light(view, stream_table, stream_phase_table, linear_sampler, place, phase, 2.0);
    }
    // Shares of the streams can be negative.
    let source = view.diffuse_scale * diffuse + view.sunlit_scale * max(sunlit, vec3<f32>(0.0));
    return PathOptics(transmittance, opacity * source);
}
