//! Skies and aerial perspective from tables: `wgsl/sky_tables.wgsl`.

use super::colour::{RgbWeights, rgb_from_spectrum};
use super::exponentials::{mean_transmittance, mean_transmittance_rgb};
use super::path_optics::PathOptics;
use super::phase::one_minus_cos_between;
use super::texture::{LinearSampler, Texture2d, Texture3d};
use glam::{FloatExt, Vec2, Vec3, Vec3Swizzles, Vec4, Vec4Swizzles};
use std::f32::consts::{FRAC_1_PI, FRAC_2_PI, FRAC_PI_2, PI};

/// Columns of a sky table, from the azimuth of the sun to the opposite one.
pub const SKY_AZIMUTHS: f32 = 64.0;
/// Rows of a sky table from the horizon to the highest elevation; they come first.
pub const SKY_ROWS_ABOVE: f32 = 125.0;
/// Rows of a sky table from the horizon to the nadir.
pub const SKY_ROWS_BELOW: f32 = 35.0;
/// Columns of an aerial-perspective table.
pub const AERIAL_AZIMUTHS: f32 = 24.0;
/// Width of the first of these columns relative to even ones.
pub const AERIAL_FIRST_COLUMN: f32 = 0.3;
/// Rows of an aerial-perspective table from the horizon to the highest elevation; they come first.
pub const AERIAL_ROWS_ABOVE: f32 = 44.0;
/// Rows of an aerial-perspective table from the horizon to the nadir.
pub const AERIAL_ROWS_BELOW: f32 = 18.0;
/// Height of the first row above the horizon, or above the rays that graze a jump of density, relative to one of [`row_place`].
pub const AERIAL_FIRST_ROW: f32 = 0.6;
/// Distances of an aerial-perspective table.
pub const AERIAL_DISTANCES: f32 = 42.0;
/// Length behind a jump of density at which these distances are a quarter as dense as just behind it, m.
pub const BEHIND_JUMP_M: f32 = 1e5;
/// Angles of a table of phase functions.
pub const PHASE_ANGLES: f32 = 1024.0;

/// What the tables of a sky are made for.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct SkyView {
    /// Unit vector to the sun.
    pub sun: Vec3,
    /// Height of the eye above the ground, m, not negative: tables for an eye below the ground are made on it.
    pub height_m: f32,
    /// Radius of the ground, m.
    pub ground_radius_m: f32,
    /// Height of the top of the air above the ground, m.
    pub air_height_m: f32,
    /// Elevation of the horizon, rad.
    pub horizon_rad: f32,
    /// Elevation above which a ray meets no air, rad.
    pub highest_rad: f32,
    /// Elevation of the rays that graze the highest jump of density below the eye, rad, or 0 just below a jump; that of the horizon without
    /// one.
    pub kink_rad: f32,
    /// Place of the row at that elevation, 0 to 1.
    pub kink_place: f32,
    /// Part of the columns that is dense about an azimuth, where the planet's shadow crosses the limb.
    pub dense_share: f32,
    /// That azimuth from the sun, in half turns.
    pub dense_azimuth: f32,
    /// Width of the dense part, half turns.
    pub dense_width: f32,
    /// Share of the rows below the horizon that are as dense at the nadir as from far away: the sine of the angle by which the horizon dips.
    pub even_below: f32,
    /// Height above the ground of the jump of density that is nearest to the eye, m.
    pub jump_height_m: f32,
    /// Place among the distances of an aerial-perspective table at which rays that do not meet the ground first cross that jump, 0 to 1; 0
    /// without a jump, and for an eye above the air.
    pub jump_place: f32,
    /// Part of the way through the air at which the ray that grazes that jump, or from below the level one, crosses it; 0 if
    /// `jump_place` is.
    pub jump_part: f32,
    /// Extinction just above that jump relative to that just below it; 1 without a jump.
    pub extinction_above: Vec4,
    /// Smooth light that a metre of air scatters just above that jump relative to one just below it; 1 without a jump.
    pub smooth_above: Vec4,
    /// Light that a metre of haze scatters once just above that jump relative to one just below it; 1 without a jump.
    pub haze_above: Vec4,
}

/// Factors from the normalised values in tables to radiance, at four wavelengths.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct SkyScales {
    /// Of the smooth light of the sky, and of its source function.
    pub smooth_light: Vec4,
    /// Of the light scattered once by haze.
    pub haze: Vec4,
}

/// Transmittance and path radiance at four wavelengths.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct SpectralPath {
    /// Transmittance, 0 to 1.
    pub transmittance: Vec4,
    /// Radiance scattered into the ray.
    pub path_radiance: Vec4,
}

/// Texture coordinate of a place from 0 to 1 among `count` texels.
pub fn texel_coordinate(place: f32, count: f32) -> f32 {
    (0.5 + place * (count - 1.0)) / count
}

/// Inverse of [`texel_coordinate`].
pub fn place_from_texel_coordinate(coordinate: f32, count: f32) -> f32 {
    (coordinate * count - 0.5) / (count - 1.0)
}

/// Horizontal direction to the sun; east under a vertical sun.
fn towards_sun(sun: Vec3) -> Vec2 {
    match sun.x.abs() + sun.z.abs() < 1e-9 {
        true => Vec2::X,
        false => sun.xz(),
    }
}

/// Azimuth of a direction from that of the sun as a fraction of half a turn.
pub fn azimuth_place(direction: Vec3, sun: Vec3) -> f32 {
    let towards = towards_sun(sun);
    let across = (direction.x * towards.y - direction.z * towards.x).abs();
    let along = direction.xz().dot(towards);
    if across == 0.0 && along >= 0.0 {
        return 0.0;
    }
    across.atan2(along) * FRAC_1_PI
}

/// Place from 0 to 1 of an azimuth from the sun, in half turns, among the columns of a table:
/// [`airlight::sky::TableCoordinates::column_place`].
pub fn column_place(view: SkyView, azimuth: f32) -> f32 {
    if view.dense_share == 0.0 {
        return azimuth;
    }
    let dense = |azimuth: f32| ((azimuth - view.dense_azimuth) / view.dense_width).atan();
    let place = (dense(azimuth) - dense(0.0)) / (dense(1.0) - dense(0.0));
    azimuth + view.dense_share * (place - azimuth)
}

/// Inverse of [`column_place`], by bisection.
pub fn azimuth_from_column_place(view: SkyView, place: f32) -> f32 {
    if view.dense_share == 0.0 {
        return place;
    }
    let (mut below, mut above) = (0.0, 1.0);
    for _ in 0..24 {
        let middle = 0.5 * (below + above);
        match column_place(view, middle) < place {
            true => below = middle,
            false => above = middle,
        }
    }
    0.5 * (below + above)
}

/// Place from 0 to 1 of an elevation among the rows above or below the horizon:
/// [`airlight::sky::TableCoordinates::row_place`].
pub fn row_place(view: SkyView, elevation_rad: f32, is_below: bool) -> f32 {
    let part = |from: f32, to: f32| ((elevation_rad - from) / (to - from)).clamp(0.0, 1.0);
    if is_below {
        let root = part(view.horizon_rad, -FRAC_PI_2).sqrt().sqrt();
        return root * (1.0 - view.even_below + view.even_below * root);
    }
    if elevation_rad < view.kink_rad {
        let part = part(view.horizon_rad, view.kink_rad);
        return view.kink_place * FRAC_2_PI * part.sqrt().atan2((1.0 - part).sqrt());
    }
    view.kink_place + (1.0 - view.kink_place) * part(view.kink_rad, view.highest_rad).sqrt()
}

/// Inverse of [`row_place`]: elevation of a place, rad.
pub fn elevation_from_row_place(view: SkyView, place: f32, is_below: bool) -> f32 {
    let between = |from: f32, to: f32, part: f32| from + (to - from) * part;
    if is_below {
        let uneven = 1.0 - view.even_below;
        let root =
            2.0 * place / (uneven + (uneven * uneven + 4.0 * view.even_below * place).sqrt());
        return between(view.horizon_rad, -FRAC_PI_2, root.powi(4));
    }
    if place < view.kink_place {
        let sine = (FRAC_PI_2 * place / view.kink_place).sin();
        return between(view.horizon_rad, view.kink_rad, sine * sine);
    }
    let part = (place - view.kink_place) / (1.0 - view.kink_place);
    between(view.kink_rad, view.highest_rad, part * part)
}

/// Texture coordinate of an elevation in a table with rows above and below the horizon.
pub fn row_coordinate(
    view: SkyView,
    elevation_rad: f32,
    is_below: bool,
    rows_above: f32,
    rows_below: f32,
) -> f32 {
    let (rows, first) = match is_below {
        true => (rows_below, rows_above),
        false => (rows_above, 0.0),
    };
    let place = row_place(view, elevation_rad, is_below);
    (first + 0.5 + place * (rows - 1.0)) / (rows_above + rows_below)
}

/// Inverse of [`row_coordinate`]: elevation of a texture coordinate, rad.
pub fn elevation_from_row_coordinate(
    view: SkyView,
    coordinate: f32,
    rows_above: f32,
    rows_below: f32,
) -> f32 {
    let row = coordinate * (rows_above + rows_below);
    let is_below = row >= rows_above;
    let (rows, first) = match is_below {
        true => (rows_below, rows_above),
        false => (rows_above, 0.0),
    };
    elevation_from_row_place(view, (row - first - 0.5) / (rows - 1.0), is_below)
}

/// Elevation of a direction, rad.
pub fn elevation_of(direction: Vec3) -> f32 {
    direction.y.atan2(direction.xz().length())
}

/// Texture coordinates of a direction in a sky table.
pub fn uv_from_direction(view: SkyView, direction: Vec3) -> Vec2 {
    let elevation_rad = elevation_of(direction);
    let is_below = elevation_rad < view.horizon_rad;
    let azimuth = azimuth_place(direction, view.sun);
    Vec2::new(
        texel_coordinate(column_place(view, azimuth), SKY_AZIMUTHS),
        row_coordinate(
            view,
            elevation_rad,
            is_below,
            SKY_ROWS_ABOVE,
            SKY_ROWS_BELOW,
        ),
    )
}

/// Unit vector at an azimuth from the sun, as a fraction of half a turn, and an elevation.
pub fn direction_from_azimuth_elevation(view: SkyView, azimuth: f32, elevation_rad: f32) -> Vec3 {
    let towards = towards_sun(view.sun).normalize();
    let along = (azimuth * PI).cos() * elevation_rad.cos();
    let across = (azimuth * PI).sin() * elevation_rad.cos();
    Vec3::new(
        towards.x * along - towards.y * across,
        elevation_rad.sin(),
        towards.y * along + towards.x * across,
    )
}

/// Interval of a ray inside the air, m from the eye.
pub fn air_span_m(view: SkyView, sin_elevation: f32, meets_ground: bool) -> Vec2 {
    let b = (view.ground_radius_m + view.height_m) * sin_elevation;
    let over_ground = view.height_m * (2.0 * view.ground_radius_m + view.height_m);
    let over_top = (view.height_m - view.air_height_m)
        * (2.0 * view.ground_radius_m + view.height_m + view.air_height_m);
    let root = (b * b - over_top).max(0.0).sqrt();
    let start = match over_top > 0.0 {
        true => over_top / (root - b),
        false => 0.0,
    };
    let mut end = root - b;
    if meets_ground {
        end = over_ground / ((b * b - over_ground).max(0.0).sqrt() - b);
    } else if b > 0.0 {
        end = -over_top / (root + b);
    }
    Vec2::new(start, end.max(start))
}

/// Interval of a ray inside the air that is below the jump of density nearest to the eye, m from the eye; (0, 0) if none is.
pub fn below_jump_m(view: SkyView, span_m: Vec2, sin_elevation: f32, meets_ground: bool) -> Vec2 {
    let b = (view.ground_radius_m + view.height_m) * sin_elevation;
    let over_jump = (view.height_m - view.jump_height_m)
        * (2.0 * view.ground_radius_m + view.height_m + view.jump_height_m);
    let squared_root = b * b - over_jump;
    if over_jump > 0.0 && (b >= 0.0 || squared_root <= 0.0) {
        return Vec2::ZERO;
    }
    let root = squared_root.max(0.0).sqrt();
    let entry = match over_jump > 0.0 {
        true => over_jump / (root - b),
        false => 0.0,
    };
    let mut exit = root - b;
    if meets_ground {
        exit = span_m.y;
    } else if b > 0.0 {
        exit = -over_jump / (root + b);
    }
    Vec2::new(entry, exit)
}

/// Part of the way of a ray through the air, up to a length, that is below the jump of density nearest to the eye.
pub fn share_below_jump(
    view: SkyView,
    span_m: Vec2,
    sin_elevation: f32,
    length_m: f32,
    meets_ground: bool,
) -> f32 {
    let below = below_jump_m(view, span_m, sin_elevation, meets_ground);
    let below_m = (span_m.x + length_m).min(below.y) - span_m.x.max(below.x);
    (below_m / length_m.max(1e-6)).clamp(0.0, 1.0)
}

/// Length of the first step between the distances of a ray with an interval in the air, relative to even steps: 0 where they are dense near
/// the eye, 2 where they are dense at the end.
pub fn first_step(view: SkyView, span_m: Vec2, meets_ground: bool) -> f32 {
    if view.height_m >= view.air_height_m {
        return if meets_ground { 2.0 } else { 1.0 };
    }
    if !meets_ground {
        return 0.0;
    }
    let slant = 1.0 - (view.height_m / span_m.y.max(1.0)).min(1.0);
    let high = (2.5 * view.height_m / view.air_height_m).min(1.0);
    2.0 * high * (1.0 - slant.powi(4))
}

/// Place from 0 to 1 of a part of the way through the air among distances with a [`first_step`].
pub fn place_from_part(part: f32, first_step: f32) -> f32 {
    let last_step = 2.0 - first_step;
    let root = ((1.0 - part) * first_step * first_step + part * last_step * last_step).sqrt();
    2.0 * part / (first_step + root).max(1e-20)
}

/// Inverse of [`place_from_part`].
pub fn part_from_place(place: f32, first_step: f32) -> f32 {
    place * (first_step + (1.0 - first_step) * place)
}

/// Place from 0 to 1 of an azimuth from the sun, in half turns, among the columns of an aerial-perspective table.
pub fn aerial_column_place(view: SkyView, azimuth: f32) -> f32 {
    place_from_part(column_place(view, azimuth), AERIAL_FIRST_COLUMN)
}

/// Place among the rows of an aerial-perspective table of the rays that graze a jump of density: that of the nearest row.
pub fn aerial_kink_place(view: SkyView) -> f32 {
    let steps = AERIAL_ROWS_ABOVE - 1.0;
    (view.kink_place * steps).round() / steps
}

/// Place from 0 to 1 among the rows of an aerial-perspective table of the place that an elevation has by [`row_place`].
pub fn aerial_row_place(view: SkyView, row_place: f32, is_below: bool) -> f32 {
    if is_below {
        return row_place;
    }
    let kink_place = aerial_kink_place(view);
    if row_place < view.kink_place {
        return row_place * kink_place / view.kink_place;
    }
    let part = (row_place - view.kink_place) / (1.0 - view.kink_place);
    kink_place.lerp(1.0, place_from_part(part, AERIAL_FIRST_ROW))
}

/// Inverse of [`aerial_row_place`]: place by [`row_place`].
pub fn row_place_from_aerial(view: SkyView, place: f32, is_below: bool) -> f32 {
    if is_below {
        return place;
    }
    let kink_place = aerial_kink_place(view);
    if place < kink_place {
        return place * view.kink_place / kink_place;
    }
    let place = (place - kink_place) / (1.0 - kink_place);
    view.kink_place
        .lerp(1.0, part_from_place(place, AERIAL_FIRST_ROW))
}

/// Texture coordinate of an elevation in an aerial-perspective table.
pub fn aerial_row_coordinate(view: SkyView, elevation_rad: f32, is_below: bool) -> f32 {
    let place = aerial_row_place(view, row_place(view, elevation_rad, is_below), is_below);
    let (rows, first) = match is_below {
        true => (AERIAL_ROWS_BELOW, AERIAL_ROWS_ABOVE),
        false => (AERIAL_ROWS_ABOVE, 0.0),
    };
    (first + 0.5 + place * (rows - 1.0)) / (AERIAL_ROWS_ABOVE + AERIAL_ROWS_BELOW)
}

/// Part of the way of a ray through the air at which it first crosses the jump of density nearest to the eye, or if it does not, at which
/// the ray that grazes the jump does; 0 if the ray meets the ground.
pub fn part_at_jump(view: SkyView, span_m: Vec2, sin_elevation: f32, meets_ground: bool) -> f32 {
    if view.jump_place == 0.0 || meets_ground {
        return 0.0;
    }
    let below = below_jump_m(view, span_m, sin_elevation, meets_ground);
    if below.y == 0.0 {
        return view.jump_part;
    }
    let crossing = match below.x > span_m.x {
        true => below.x,
        false => below.y,
    };
    ((crossing - span_m.x) / (span_m.y - span_m.x).max(1e-6)).clamp(0.0, 1.0)
}

/// Place from 0 to 1 of a part of the way behind a jump of density, of a length (m), among the distances there: dense behind the jump.
pub fn place_behind_jump(part: f32, length_m: f32) -> f32 {
    let length = length_m / BEHIND_JUMP_M;
    part * (1.0 + length) / (1.0 + part * length)
}

/// Inverse of [`place_behind_jump`].
pub fn part_behind_jump(place: f32, length_m: f32) -> f32 {
    let length = length_m / BEHIND_JUMP_M;
    place / (1.0 + (1.0 - place) * length)
}

/// Place from 0 to 1 of a length in the air among the distances of a ray with an interval in the air.
pub fn distance_place(
    view: SkyView,
    span_m: Vec2,
    sin_elevation: f32,
    length_m: f32,
    meets_ground: bool,
) -> f32 {
    let part = (length_m / (span_m.y - span_m.x).max(1e-6)).clamp(0.0, 1.0);
    let at_jump = part_at_jump(view, span_m, sin_elevation, meets_ground);
    if at_jump == 0.0 {
        return place_from_part(part, first_step(view, span_m, meets_ground));
    }
    if part < at_jump {
        return view.jump_place * (part / at_jump).sqrt();
    }
    let behind = ((part - at_jump) / (1.0 - at_jump).max(1e-6)).clamp(0.0, 1.0);
    let behind_m = (1.0 - at_jump) * (span_m.y - span_m.x);
    view.jump_place
        .lerp(1.0, place_behind_jump(behind, behind_m))
}

/// Inverse of [`distance_place`]: length in the air, m.
pub fn length_from_distance_place(
    view: SkyView,
    span_m: Vec2,
    sin_elevation: f32,
    place: f32,
    meets_ground: bool,
) -> f32 {
    let at_jump = part_at_jump(view, span_m, sin_elevation, meets_ground);
    let mut part = part_from_place(place, first_step(view, span_m, meets_ground));
    if at_jump > 0.0 && place < view.jump_place {
        part = at_jump * (place / view.jump_place).powi(2);
    } else if at_jump > 0.0 {
        let behind = (place - view.jump_place) / (1.0 - view.jump_place);
        let behind_m = (1.0 - at_jump) * (span_m.y - span_m.x);
        part = at_jump.lerp(1.0, part_behind_jump(behind, behind_m));
    }
    part * (span_m.y - span_m.x)
}

/// Place from 0 to 1 of a scattering angle in a table of phase functions.
pub fn phase_place(one_minus_cos: f32) -> f32 {
    let half_angle = one_minus_cos
        .max(0.0)
        .sqrt()
        .atan2((2.0 - one_minus_cos).max(0.0).sqrt());
    (half_angle * FRAC_2_PI).sqrt()
}

/// Inverse of [`phase_place`].
pub fn one_minus_cos_from_phase_place(place: f32) -> f32 {
    let half_sine = (FRAC_PI_2 * place * place).sin();
    2.0 * half_sine * half_sine
}

/// Phase function of haze between a direction and the sun at four wavelengths, 1/sr.
pub fn haze_phase(
    phase_table: &Texture2d,
    linear_sampler: LinearSampler,
    one_minus_cos: f32,
) -> Vec4 {
    let u = texel_coordinate(phase_place(one_minus_cos), PHASE_ANGLES);
    phase_table.sample(linear_sampler, Vec2::new(u, 0.5))
}

/// Radiance of the sky, or of the ground below the horizon, along a direction at four wavelengths, without the sun's disc.
pub fn sky_radiance(
    view: SkyView,
    scales: SkyScales,
    smooth_table: &Texture2d,
    haze_table: &Texture2d,
    phase_table: &Texture2d,
    linear_sampler: LinearSampler,
    direction: Vec3,
) -> Vec4 {
    if elevation_of(direction) > view.highest_rad {
        return Vec4::ZERO;
    }
    let uv = uv_from_direction(view, direction);
    let one_minus_cos = one_minus_cos_between(direction, view.sun);
    let phase = haze_phase(phase_table, linear_sampler, one_minus_cos);
    let smooth_light = smooth_table.sample(linear_sampler, uv).exp() * scales.smooth_light;
    let haze = haze_table.sample(linear_sampler, uv).exp() * scales.haze;
    smooth_light + haze * phase
}

/// Air between the eye and a point at a distance along a direction, at four wavelengths.
#[expect(
    clippy::too_many_arguments,
    reason = "the shape of the shader function"
)]
pub fn aerial_perspective(
    view: SkyView,
    scales: SkyScales,
    smooth_table: &Texture3d,
    haze_table: &Texture3d,
    extinction_table: &Texture2d,
    phase_table: &Texture2d,
    linear_sampler: LinearSampler,
    direction: Vec3,
    distance_m: f32,
) -> SpectralPath {
    let elevation_rad = elevation_of(direction);
    let is_below = elevation_rad < view.horizon_rad;
    let span = air_span_m(view, direction.y, is_below);
    let length_m = distance_m.min(span.y) - span.x;
    if length_m <= 0.0 || elevation_rad > view.highest_rad {
        return SpectralPath {
            transmittance: Vec4::ONE,
            path_radiance: Vec4::ZERO,
        };
    }
    let share = share_below_jump(view, span, direction.y, length_m, is_below);
    let extinction = view.extinction_above.lerp(Vec4::ONE, share);
    let place = distance_place(view, span, direction.y, length_m, is_below);
    let row = aerial_row_coordinate(view, elevation_rad, is_below);
    let azimuth = azimuth_place(direction, view.sun);
    let uvw = Vec3::new(
        texel_coordinate(aerial_column_place(view, azimuth), AERIAL_AZIMUTHS),
        row,
        texel_coordinate(place, AERIAL_DISTANCES),
    );
    let one_minus_cos = one_minus_cos_between(direction, view.sun);
    let phase = haze_phase(phase_table, linear_sampler, one_minus_cos);
    let depth = extinction_table.sample(linear_sampler, uvw.zy()) * extinction * (length_m * 1e-3);
    let mut smooth_light = smooth_table.sample_3d(linear_sampler, uvw).exp() * scales.smooth_light;
    let mut haze = haze_table.sample_3d(linear_sampler, uvw).exp() * scales.haze;
    smooth_light *= view.smooth_above.lerp(Vec4::ONE, share);
    haze *= view.haze_above.lerp(Vec4::ONE, share);
    let opacity = depth * mean_transmittance_rgb(depth.xyz()).extend(mean_transmittance(depth.w));
    SpectralPath {
        transmittance: 1.0 - opacity,
        path_radiance: (smooth_light + haze * phase) / extinction * opacity,
    }
}

/// Transmittance of the air between the eye and a point at a distance along a direction, at four wavelengths: that of
/// [`aerial_perspective`] alone.
pub fn aerial_transmittance(
    view: SkyView,
    extinction_table: &Texture2d,
    linear_sampler: LinearSampler,
    direction: Vec3,
    distance_m: f32,
) -> Vec4 {
    let elevation_rad = elevation_of(direction);
    let is_below = elevation_rad < view.horizon_rad;
    let span = air_span_m(view, direction.y, is_below);
    let length_m = distance_m.min(span.y) - span.x;
    if length_m <= 0.0 || elevation_rad > view.highest_rad {
        return Vec4::ONE;
    }
    let share = share_below_jump(view, span, direction.y, length_m, is_below);
    let extinction = view.extinction_above.lerp(Vec4::ONE, share);
    let place = distance_place(view, span, direction.y, length_m, is_below);
    let row = aerial_row_coordinate(view, elevation_rad, is_below);
    let uv = Vec2::new(texel_coordinate(place, AERIAL_DISTANCES), row);
    (extinction_table.sample(linear_sampler, uv) * extinction * (length_m * -1e-3)).exp()
}

/// Transmittance and path radiance in red, green and blue, for scenes in these.
pub fn rgb_path(radiance: RgbWeights, transmittance: RgbWeights, path: SpectralPath) -> PathOptics {
    PathOptics {
        transmittance: rgb_from_spectrum(transmittance, path.transmittance),
        path_radiance: rgb_from_spectrum(radiance, path.path_radiance),
    }
}
