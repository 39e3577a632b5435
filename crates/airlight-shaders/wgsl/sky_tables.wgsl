// requires: exponentials, phase, path_optics, colour
// Skies and aerial perspective from tables at four wavelengths, made for one position of the eye and one of the sun and fixed to
// the world's axes: nothing changes when the camera turns. World axes: y up at the eye. Two tables hold the sky, as logarithms
// of normalised radiance: the light that haze scatters once, divided by its phase function, and all other light. Two more hold
// the source function of aerial perspective in the same way, and one the mean extinction: as if the whole ray were below the jump of
// density that is nearest to the eye, so that they do not jump where rays pass it.

/// Columns of a sky table, from the azimuth of the sun to the opposite one.
const SKY_AZIMUTHS: f32 = 64.0;
/// Rows of a sky table from the horizon to the highest elevation; they come first.
const SKY_ROWS_ABOVE: f32 = 125.0;
/// Rows of a sky table from the horizon to the nadir.
const SKY_ROWS_BELOW: f32 = 35.0;
/// Columns of an aerial-perspective table, as those of a sky table but denser beside the sun.
const AERIAL_AZIMUTHS: f32 = 24.0;
/// Width of the first of these columns relative to even ones.
const AERIAL_FIRST_COLUMN: f32 = 0.3;
/// Rows of an aerial-perspective table from the horizon to the highest elevation; they come first.
const AERIAL_ROWS_ABOVE: f32 = 44.0;
/// Rows of an aerial-perspective table from the horizon to the nadir.
const AERIAL_ROWS_BELOW: f32 = 18.0;
/// Height of the first row above the horizon, or above the rays that graze a jump of density, relative to one of `row_place`.
const AERIAL_FIRST_ROW: f32 = 0.6;
/// Distances of an aerial-perspective table.
const AERIAL_DISTANCES: f32 = 42.0;
/// Length behind a jump of density at which these distances are a quarter as dense as just behind it, m.
const BEHIND_JUMP_M: f32 = 1e5;
/// Angles of a table of phase functions.
const PHASE_ANGLES: f32 = 1024.0;

/// What the tables of a sky are made for.
struct SkyView {
    /// Unit vector to the sun.
    sun: vec3<f32>,
    /// Height of the eye above the ground, m, not negative: tables for an eye below the ground are made on it.
    height_m: f32,
    /// Radius of the ground, m.
    ground_radius_m: f32,
    /// Height of the top of the air above the ground, m.
    air_height_m: f32,
    /// Elevation of the horizon, rad.
    horizon_rad: f32,
    /// Elevation above which a ray meets no air, rad: the zenith, or from space the limb.
    highest_rad: f32,
    /// Elevation of the rays that graze the highest jump of density below the eye, rad, or 0 just below a jump; that of the horizon
    /// without one.
    kink_rad: f32,
    /// Place of the row at that elevation, 0 to 1.
    kink_place: f32,
    /// Part of the columns that is dense about an azimuth, where the planet's shadow crosses the limb.
    dense_share: f32,
    /// That azimuth from the sun, in half turns.
    dense_azimuth: f32,
    /// Width of the dense part, half turns.
    dense_width: f32,
    /// Share of the rows below the horizon that are as dense at the nadir as from far away: the sine of the angle by which the horizon dips.
    even_below: f32,
    /// Height above the ground of the jump of density that is nearest to the eye, m.
    jump_height_m: f32,
    /// Place among the distances of an aerial-perspective table at which rays that do not meet the ground first cross that jump, 0 to 1; 0
    /// without a jump, and for an eye above the air.
    jump_place: f32,
    /// Part of the way through the air at which the ray that grazes that jump, or from below the level one, crosses it; 0 if `jump_place` is.
    jump_part: f32,
    /// Extinction just above that jump relative to that just below it; 1 without a jump.
    extinction_above: vec4<f32>,
    /// Smooth light that a metre of air scatters just above that jump relative to one just below it; 1 without a jump.
    smooth_above: vec4<f32>,
    /// Light that a metre of haze scatters once just above that jump relative to one just below it; 1 without a jump.
    haze_above: vec4<f32>,
}

/// Factors from the normalised values in tables to radiance, at four wavelengths.
struct SkyScales {
    /// Of the smooth light of the sky, and of its source function.
    smooth_light: vec4<f32>,
    /// Of the light scattered once by haze.
    haze: vec4<f32>,
}

/// Transmittance and path radiance at four wavelengths.
struct SpectralPath {
    /// Transmittance, 0 to 1.
    transmittance: vec4<f32>,
    /// Radiance scattered into the ray.
    path_radiance: vec4<f32>,
}

/// Texture coordinate of a place from 0 (centre of the first texel) to 1 (centre of the last) among `count` texels.
///
/// Cost: no exp. Error: 2e-7 relative.
fn texel_coordinate(place: f32, count: f32) -> f32 {
    return (0.5 + place * (count - 1.0)) / count;
}

/// Inverse of `texel_coordinate`.
///
/// Cost: no exp. Error: 5e-7 relative plus 3e-7 absolute.
fn place_from_texel_coordinate(coordinate: f32, count: f32) -> f32 {
    return (coordinate * count - 0.5) / (count - 1.0);
}

/// Azimuth of a direction from that of the sun as a fraction of half a turn. Under a vertical sun azimuths count from east.
///
/// Cost: no exp. Error: 1e-6 relative plus 2e-6 absolute.
fn azimuth_place(direction: vec3<f32>, sun: vec3<f32>) -> f32 {
    let is_vertical = abs(sun.x) + abs(sun.z) < 1e-9;
    let towards = select(sun.xz, vec2<f32>(1.0, 0.0), is_vertical);
    let across = abs(direction.x * towards.y - direction.z * towards.x);
    let along = dot(direction.xz, towards);
    if across == 0.0 && along >= 0.0 {
        return 0.0;
    }
    return atan2(across, along) * 0.3183098861837907;
}

/// Place from 0 to 1 of an azimuth from the sun, in half turns, among the columns of a table. From space they are dense where the
/// planet's shadow crosses the limb.
///
/// Cost: no exp. Error: 1e-6 relative plus 1e-5 absolute.
fn column_place(view: SkyView, azimuth: f32) -> f32 {
    if view.dense_share == 0.0 {
        return azimuth;
    }
    let dense = atan((vec3<f32>(azimuth, 0.0, 1.0) - view.dense_azimuth) / view.dense_width);
    return mix(azimuth, (dense.x - dense.y) / (dense.z - dense.y), view.dense_share);
}

/// Inverse of `column_place`, by bisection.
///
/// Cost: no exp. Error: 1e-6 relative plus 1e-5 absolute.
fn azimuth_from_column_place(view: SkyView, place: f32) -> f32 {
    if view.dense_share == 0.0 {
        return place;
    }
    var below = 0.0;
    var above = 1.0;
    for (var k = 0; k < 24; k++) {
        let middle = 0.5 * (below + above);
        if column_place(view, middle) < place {
            below = middle;
        } else {
            above = middle;
        }
    }
    return 0.5 * (below + above);
}

/// Place from 0 to 1 of an elevation among the rows above or below the horizon. Above it they are dense towards the horizon, at the square
/// of the place, and towards the rays that graze a jump of density, from below; below it at the fourth power of the place for a low eye,
/// whose rays soon meet the ground, and the more at its square the farther the horizon dips.
///
/// Cost: no exp. Error: 1e-6 relative plus 1e-6 absolute.
fn row_place(view: SkyView, elevation_rad: f32, is_below: bool) -> f32 {
    if is_below {
        let part = (elevation_rad - view.horizon_rad) / (-1.5707963267948966 - view.horizon_rad);
        let root = sqrt(sqrt(clamp(part, 0.0, 1.0)));
        return root * (1.0 - view.even_below + view.even_below * root);
    }
    if elevation_rad < view.kink_rad {
        let part = clamp((elevation_rad - view.horizon_rad) / (view.kink_rad - view.horizon_rad), 0.0, 1.0);
        return view.kink_place * 0.6366197723675814 * atan2(sqrt(part), sqrt(1.0 - part));
    }
    let part = clamp((elevation_rad - view.kink_rad) / (view.highest_rad - view.kink_rad), 0.0, 1.0);
    return view.kink_place + (1.0 - view.kink_place) * sqrt(part);
}

/// Inverse of `row_place`: elevation of a place, rad.
///
/// Cost: no exp. Error: 2e-6 relative plus 4e-6 absolute.
fn elevation_from_row_place(view: SkyView, place: f32, is_below: bool) -> f32 {
    if is_below {
        let uneven = 1.0 - view.even_below;
        let root = 2.0 * place / (uneven + sqrt(uneven * uneven + 4.0 * view.even_below * place));
        let squared = root * root;
        return view.horizon_rad + (-1.5707963267948966 - view.horizon_rad) * squared * squared;
    }
    if place < view.kink_place {
        let sine = sin(1.5707963267948966 * place / view.kink_place);
        return view.horizon_rad + (view.kink_rad - view.horizon_rad) * sine * sine;
    }
    let part = (place - view.kink_place) / (1.0 - view.kink_place);
    return view.kink_rad + (view.highest_rad - view.kink_rad) * part * part;
}

/// Texture coordinate of an elevation in a table with rows above and below the horizon, at their `row_place`. The first rows hold the
/// elevations from the horizon on; both parts end in texel centres, so that filtering does not mix them.
///
/// Cost: no exp. Error: 1e-6 relative plus 1e-6 absolute.
fn row_coordinate(view: SkyView, elevation_rad: f32, is_below: bool, rows_above: f32, rows_below: f32) -> f32 {
    let rows = select(rows_above, rows_below, is_below);
    let first = select(0.0, rows_above, is_below);
    return (first + 0.5 + row_place(view, elevation_rad, is_below) * (rows - 1.0)) / (rows_above + rows_below);
}

/// Inverse of `row_coordinate`: elevation of a texture coordinate, rad.
///
/// Cost: no exp. Error: 2e-6 relative plus 1e-5 absolute.
fn elevation_from_row_coordinate(view: SkyView, coordinate: f32, rows_above: f32, rows_below: f32) -> f32 {
    let row = coordinate * (rows_above + rows_below);
    let is_below = row >= rows_above;
    let rows = select(rows_above, rows_below, is_below);
    let place = (row - select(0.0, rows_above, is_below) - 0.5) / (rows - 1.0);
    return elevation_from_row_place(view, place, is_below);
}

/// Elevation of a direction, rad.
///
/// Cost: no exp. Error: 1e-6 relative plus 4e-6 absolute.
fn elevation_of(direction: vec3<f32>) -> f32 {
    return atan2(direction.y, length(direction.xz));
}

/// Texture coordinates of a direction in a sky table.
///
/// Cost: no exp. Error: 2e-6 relative plus 1e-4 absolute.
fn uv_from_direction(view: SkyView, direction: vec3<f32>) -> vec2<f32> {
    let elevation_rad = elevation_of(direction);
    let is_below = elevation_rad < view.horizon_rad;
    return vec2<f32>(
        texel_coordinate(column_place(view, azimuth_place(direction, view.sun)), SKY_AZIMUTHS),
        row_coordinate(view, elevation_rad, is_below, SKY_ROWS_ABOVE, SKY_ROWS_BELOW),
    );
}

/// Unit vector at an azimuth from the sun, as a fraction of half a turn, and an elevation.
///
/// Cost: no exp. Error: 1e-6 relative plus 2e-6 absolute.
fn direction_from_azimuth_elevation(view: SkyView, azimuth: f32, elevation_rad: f32) -> vec3<f32> {
    let is_vertical = abs(view.sun.x) + abs(view.sun.z) < 1e-9;
    let towards = normalize(select(view.sun.xz, vec2<f32>(1.0, 0.0), is_vertical));
    let along = cos(azimuth * 3.141592653589793) * cos(elevation_rad);
    let across = sin(azimuth * 3.141592653589793) * cos(elevation_rad);
    return vec3<f32>(towards.x * along - towards.y * across, sin(elevation_rad), towards.y * along + towards.x * across);
}

/// Interval of a ray inside the air, m from the eye: up to the ground, if it meets that, or to the top. From space, a ray that
/// misses the air has an empty interval.
///
/// Cost: no exp. Error: 3e-5 relative plus 50 absolute.
fn air_span_m(view: SkyView, sin_elevation: f32, meets_ground: bool) -> vec2<f32> {
    // Roots of t^2 + 2 b t + c = 0 without cancellation: the smaller root is c over the larger. c is the power of the eye with
    // respect to a sphere.
    let b = (view.ground_radius_m + view.height_m) * sin_elevation;
    let over_ground = view.height_m * (2.0 * view.ground_radius_m + view.height_m);
    let over_top = (view.height_m - view.air_height_m) * (2.0 * view.ground_radius_m + view.height_m + view.air_height_m);
    let root = sqrt(max(b * b - over_top, 0.0));
    let start = select(0.0, over_top / (root - b), over_top > 0.0);
    var end = root - b;
    if meets_ground {
        end = over_ground / (sqrt(max(b * b - over_ground, 0.0)) - b);
    } else if b > 0.0 {
        end = -over_top / (root + b);
    }
    return vec2<f32>(start, max(end, start));
}

/// Interval of a ray inside the air that is below the jump of density nearest to the eye, m from the eye; (0, 0) if none is.
///
/// Cost: no exp. Error: 3e-5 relative plus 300 absolute.
fn below_jump_m(view: SkyView, span_m: vec2<f32>, sin_elevation: f32, meets_ground: bool) -> vec2<f32> {
    let b = (view.ground_radius_m + view.height_m) * sin_elevation;
    let over_jump = (view.height_m - view.jump_height_m) * (2.0 * view.ground_radius_m + view.height_m + view.jump_height_m);
    let squared_root = b * b - over_jump;
    if over_jump > 0.0 && (b >= 0.0 || squared_root <= 0.0) {
        return vec2<f32>(0.0);
    }
    let root = sqrt(max(squared_root, 0.0));
    let entry = select(0.0, over_jump / (root - b), over_jump > 0.0);
    var exit = root - b;
    if meets_ground {
        exit = span_m.y;
    } else if b > 0.0 {
        exit = -over_jump / (root + b);
    }
    return vec2<f32>(entry, exit);
}

/// Part of the way of a ray through the air, up to a length, that is below the jump of density nearest to the eye.
///
/// Cost: no exp. Error: 1e-3 absolute.
fn share_below_jump(view: SkyView, span_m: vec2<f32>, sin_elevation: f32, length_m: f32, meets_ground: bool) -> f32 {
    let below = below_jump_m(view, span_m, sin_elevation, meets_ground);
    let below_m = min(span_m.x + length_m, below.y) - max(span_m.x, below.x);
    return clamp(below_m / max(length_m, 1e-6), 0.0, 1.0);
}

/// Length of the first step between the distances of a ray with an interval in the air, relative to even steps. From inside the air
/// distances are dense near the eye, at the square of the place: 0; from above it towards the ground, where most air is, dense there: 2. Steep rays from high in the air are between.
///
/// Cost: no exp. Error: 1e-5 relative plus 1e-5 absolute.
fn first_step(view: SkyView, span_m: vec2<f32>, meets_ground: bool) -> f32 {
    if view.height_m >= view.air_height_m {
        return select(1.0, 2.0, meets_ground);
    }
    if !meets_ground {
        return 0.0;
    }
    let slant = 1.0 - min(view.height_m / max(span_m.y, 1.0), 1.0);
    let high = min(2.5 * view.height_m / view.air_height_m, 1.0);
    return 2.0 * high * (1.0 - slant * slant * slant * slant);
}

/// Place from 0 to 1 of a part of the way through the air among distances with a `first_step`.
///
/// Cost: no exp. Error: 1e-6 relative plus 1e-6 absolute.
fn place_from_part(part: f32, first_step: f32) -> f32 {
    let last_step = 2.0 - first_step;
    let root = sqrt((1.0 - part) * first_step * first_step + part * last_step * last_step);
    return 2.0 * part / max(first_step + root, 1e-20);
}

/// Inverse of `place_from_part`.
///
/// Cost: no exp. Error: 1e-6 relative plus 4e-7 absolute.
fn part_from_place(place: f32, first_step: f32) -> f32 {
    return place * (first_step + (1.0 - first_step) * place);
}

/// Place from 0 to 1 of an azimuth from the sun, in half turns, among the columns of an aerial-perspective table.
///
/// Cost: no exp. Error: 1e-6 relative plus 1e-5 absolute.
fn aerial_column_place(view: SkyView, azimuth: f32) -> f32 {
    return place_from_part(column_place(view, azimuth), AERIAL_FIRST_COLUMN);
}

/// Place among the rows of an aerial-perspective table of the rays that graze a jump of density: that of the nearest row.
///
/// Cost: no exp. Error: 1e-6 relative.
fn aerial_kink_place(view: SkyView) -> f32 {
    let steps = AERIAL_ROWS_ABOVE - 1.0;
    return round(view.kink_place * steps) / steps;
}

/// Place from 0 to 1 among the rows of an aerial-perspective table of the place that an elevation has by `row_place`: that of the rays that
/// graze a jump of density is at a row, and rows are dense above it.
///
/// Cost: no exp. Error: 1e-6 relative plus 1e-5 absolute.
fn aerial_row_place(view: SkyView, row_place: f32, is_below: bool) -> f32 {
    if is_below {
        return row_place;
    }
    let kink_place = aerial_kink_place(view);
    if row_place < view.kink_place {
        return row_place * kink_place / view.kink_place;
    }
    return mix(kink_place, 1.0, place_from_part((row_place - view.kink_place) / (1.0 - view.kink_place), AERIAL_FIRST_ROW));
}

/// Inverse of `aerial_row_place`: place by `row_place`.
///
/// Cost: no exp. Error: 1e-6 relative plus 2e-6 absolute.
fn row_place_from_aerial(view: SkyView, place: f32, is_below: bool) -> f32 {
    if is_below {
        return place;
    }
    let kink_place = aerial_kink_place(view);
    if place < kink_place {
        return place * view.kink_place / kink_place;
    }
    return mix(view.kink_place, 1.0, part_from_place((place - kink_place) / (1.0 - kink_place), AERIAL_FIRST_ROW));
}

/// Texture coordinate of an elevation in an aerial-perspective table.
///
/// Cost: no exp. Error: 2e-6 relative plus 1e-4 absolute.
fn aerial_row_coordinate(view: SkyView, elevation_rad: f32, is_below: bool) -> f32 {
    let place = aerial_row_place(view, row_place(view, elevation_rad, is_below), is_below);
    let rows = select(AERIAL_ROWS_ABOVE, AERIAL_ROWS_BELOW, is_below);
    let first = select(0.0, AERIAL_ROWS_ABOVE, is_below);
    return (first + 0.5 + place * (rows - 1.0)) / (AERIAL_ROWS_ABOVE + AERIAL_ROWS_BELOW);
}

/// Part of the way of a ray through the air at which it first crosses the jump of density nearest to the eye, or if it does not, at which
/// the ray that grazes the jump does; 0 if the ray meets the ground.
///
/// Cost: no exp. Error: 1e-3 absolute.
fn part_at_jump(view: SkyView, span_m: vec2<f32>, sin_elevation: f32, meets_ground: bool) -> f32 {
    if view.jump_place == 0.0 || meets_ground {
        return 0.0;
    }
    let below = below_jump_m(view, span_m, sin_elevation, meets_ground);
    if below.y == 0.0 {
        return view.jump_part;
    }
    let crossing = select(below.y, below.x, below.x > span_m.x);
    return clamp((crossing - span_m.x) / max(span_m.y - span_m.x, 1e-6), 0.0, 1.0);
}

/// Place from 0 to 1 of a part of the way behind a jump of density, of a length (m), among the distances there: dense behind the jump.
///
/// Cost: no exp. Error: 1e-6 relative.
fn place_behind_jump(part: f32, length_m: f32) -> f32 {
    let length = length_m / BEHIND_JUMP_M;
    return part * (1.0 + length) / (1.0 + part * length);
}

/// Inverse of `place_behind_jump`.
///
/// Cost: no exp. Error: 3e-6 relative plus 1e-9 absolute.
fn part_behind_jump(place: f32, length_m: f32) -> f32 {
    let length = length_m / BEHIND_JUMP_M;
    return place / (1.0 + (1.0 - place) * length);
}

/// Place from 0 to 1 of a length in the air among the distances of a ray with an interval in the air. Where rays cross a jump of density,
/// so does a distance of the table, as light and extinction bend there.
///
/// Cost: no exp. Error: 2e-3 absolute.
fn distance_place(view: SkyView, span_m: vec2<f32>, sin_elevation: f32, length_m: f32, meets_ground: bool) -> f32 {
    let part = clamp(length_m / max(span_m.y - span_m.x, 1e-6), 0.0, 1.0);
    let at_jump = part_at_jump(view, span_m, sin_elevation, meets_ground);
    if at_jump == 0.0 {
        return place_from_part(part, first_step(view, span_m, meets_ground));
    }
    if part < at_jump {
        return view.jump_place * sqrt(part / at_jump);
    }
    let behind = clamp((part - at_jump) / max(1.0 - at_jump, 1e-6), 0.0, 1.0);
    let behind_m = (1.0 - at_jump) * (span_m.y - span_m.x);
    return mix(view.jump_place, 1.0, place_behind_jump(behind, behind_m));
}

/// Inverse of `distance_place`: length in the air, m.
///
/// Cost: no exp. Error: 1e-4 relative plus 300 absolute.
fn length_from_distance_place(view: SkyView, span_m: vec2<f32>, sin_elevation: f32, place: f32, meets_ground: bool) -> f32 {
    let at_jump = part_at_jump(view, span_m, sin_elevation, meets_ground);
    var part = part_from_place(place, first_step(view, span_m, meets_ground));
    if at_jump > 0.0 && place < view.jump_place {
        part = at_jump * (place / view.jump_place) * (place / view.jump_place);
    } else if at_jump > 0.0 {
        let behind_m = (1.0 - at_jump) * (span_m.y - span_m.x);
        part = mix(at_jump, 1.0, part_behind_jump((place - view.jump_place) / (1.0 - view.jump_place), behind_m));
    }
    return part * (span_m.y - span_m.x);
}

/// Place from 0 to 1 of a scattering angle in a table of phase functions, dense forwards, by 1 minus the cosine.
///
/// Cost: no exp. Error: 2e-5 relative plus 1e-7 absolute.
fn phase_place(one_minus_cos: f32) -> f32 {
    let half_angle = atan2(sqrt(max(one_minus_cos, 0.0)), sqrt(max(2.0 - one_minus_cos, 0.0)));
    return sqrt(half_angle * 0.6366197723675814);
}

/// Inverse of `phase_place`.
///
/// Cost: no exp. Error: 3e-6 relative.
fn one_minus_cos_from_phase_place(place: f32) -> f32 {
    let half_sine = sin(1.5707963267948966 * place * place);
    return 2.0 * half_sine * half_sine;
}

/// Phase function of haze between a direction and the sun at four wavelengths, 1/sr.
///
/// Cost: 1 read. Error: 1e-3 relative plus 1e-5 absolute.
fn haze_phase(phase_table: texture_2d<f32>, linear_sampler: sampler, one_minus_cos: f32) -> vec4<f32> {
    let u = texel_coordinate(phase_place(one_minus_cos), PHASE_ANGLES);
    return textureSampleLevel(phase_table, linear_sampler, vec2<f32>(u, 0.5), 0.0);
}

/// Radiance of the sky, or of the ground below the horizon, along a direction at four wavelengths, without the sun's disc.
///
/// Cost: 8 exp, 3 reads. Error: 2e-3 relative plus 1e-6 absolute.
fn sky_radiance(
    view: SkyView,
    scales: SkyScales,
    smooth_table: texture_2d<f32>,
    haze_table: texture_2d<f32>,
    phase_table: texture_2d<f32>,
    linear_sampler: sampler,
    direction: vec3<f32>,
) -> vec4<f32> {
    if elevation_of(direction) > view.highest_rad {
        return vec4<f32>(0.0);
    }
    let uv = uv_from_direction(view, direction);
    let phase = haze_phase(phase_table, linear_sampler, one_minus_cos_between(direction, view.sun));
    let smooth_light = exp(textureSampleLevel(smooth_table, linear_sampler, uv, 0.0)) * scales.smooth_light;
    let haze = exp(textureSampleLevel(haze_table, linear_sampler, uv, 0.0)) * scales.haze;
    return smooth_light + haze * phase;
}

/// Air between the eye and a point at a distance along a direction, at four wavelengths. The extinction table holds the mean
/// extinction from the first air on, 1/km, as if all of it were below the jump of density nearest to the eye.
///
/// Cost: 12 exp, 4 reads. Error: 3e-3 relative plus 1e-5 absolute.
fn aerial_perspective(
    view: SkyView,
    scales: SkyScales,
    smooth_table: texture_3d<f32>,
    haze_table: texture_3d<f32>,
    extinction_table: texture_2d<f32>,
    phase_table: texture_2d<f32>,
    linear_sampler: sampler,
    direction: vec3<f32>,
    distance_m: f32,
) -> SpectralPath {
    let elevation_rad = elevation_of(direction);
    let is_below = elevation_rad < view.horizon_rad;
    let span = air_span_m(view, direction.y, is_below);
    let length_m = min(distance_m, span.y) - span.x;
    if length_m <= 0.0 || elevation_rad > view.highest_rad {
        return SpectralPath(vec4<f32>(1.0), vec4<f32>(0.0));
    }
    let share = share_below_jump(view, span, direction.y, length_m, is_below);
    let extinction = mix(view.extinction_above, vec4<f32>(1.0), share);
    let place = distance_place(view, span, direction.y, length_m, is_below);
    let row = aerial_row_coordinate(view, elevation_rad, is_below);
    let uvw = vec3<f32>(
        texel_coordinate(aerial_column_place(view, azimuth_place(direction, view.sun)), AERIAL_AZIMUTHS),
        row,
        texel_coordinate(place, AERIAL_DISTANCES),
    );
    let phase = haze_phase(phase_table, linear_sampler, one_minus_cos_between(direction, view.sun));
    let depth = textureSampleLevel(extinction_table, linear_sampler, uvw.zy, 0.0) * extinction * (length_m * 1e-3);
    var smooth_light = exp(textureSampleLevel(smooth_table, linear_sampler, uvw, 0.0)) * scales.smooth_light;
    var haze = exp(textureSampleLevel(haze_table, linear_sampler, uvw, 0.0)) * scales.haze;
    smooth_light *= mix(view.smooth_above, vec4<f32>(1.0), share);
    haze *= mix(view.haze_above, vec4<f32>(1.0), share);
    let opacity = depth * vec4<f32>(mean_transmittance_rgb(depth.xyz), mean_transmittance(depth.w));
    return SpectralPath(1.0 - opacity, (smooth_light + haze * phase) / extinction * opacity);
}

/// Transmittance of the air between the eye and a point at a distance along a direction, at four wavelengths: that of
/// `aerial_perspective` alone.
///
/// Cost: 4 exp, 1 read. Error: 3e-3 relative plus 1e-5 absolute.
fn aerial_transmittance(
    view: SkyView,
    extinction_table: texture_2d<f32>,
    linear_sampler: sampler,
    direction: vec3<f32>,
    distance_m: f32,
) -> vec4<f32> {
    let elevation_rad = elevation_of(direction);
    let is_below = elevation_rad < view.horizon_rad;
    let span = air_span_m(view, direction.y, is_below);
    let length_m = min(distance_m, span.y) - span.x;
    if length_m <= 0.0 || elevation_rad > view.highest_rad {
        return vec4<f32>(1.0);
    }
    let share = share_below_jump(view, span, direction.y, length_m, is_below);
    let extinction = mix(view.extinction_above, vec4<f32>(1.0), share);
    let place = distance_place(view, span, direction.y, length_m, is_below);
    let row = aerial_row_coordinate(view, elevation_rad, is_below);
    let uv = vec2<f32>(texel_coordinate(place, AERIAL_DISTANCES), row);
    return exp(textureSampleLevel(extinction_table, linear_sampler, uv, 0.0) * extinction * (length_m * -1e-3));
}

/// Transmittance and path radiance in red, green and blue, for scenes in these: the transmittance of a channel is that of sunlight.
///
/// Cost: no exp. Error: 2e-6 relative plus 1e-6 absolute.
fn rgb_path(radiance: RgbWeights, transmittance: RgbWeights, path: SpectralPath) -> PathOptics {
    return PathOptics(
        rgb_from_spectrum(transmittance, path.transmittance),
        rgb_from_spectrum(radiance, path.path_radiance),
    );
}
