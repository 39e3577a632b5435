//! Skies and aerial perspective from tables.

use super::{Row, rows};
use crate::flat::{FlatFunction, Twin, flat_struct};
use crate::random::Random;
use crate::textures;
use airlight_shaders::twins;
use airlight_shaders::twins::sky_tables::{SkyScales, SkyView};
use airlight_shaders::twins::texture::LinearSampler;
use glam::Vec3;
use std::f64::consts::{FRAC_PI_2, PI};

flat_struct! {
    twins::sky_tables::SkyView { sun, height_m, ground_radius_m, air_height_m, horizon_rad, highest_rad, kink_rad, kink_place,
        dense_share, dense_azimuth, dense_width, even_below, jump_height_m, jump_place, jump_part, extinction_above, smooth_above, haze_above }
    twins::sky_tables::SkyScales { smooth_light, haze }
    twins::sky_tables::SpectralPath { transmittance, path_radiance }
}

const RADIUS_M: f64 = 6.36e6;
const TOP_M: f64 = 1.0e5;

/// A view of the Earth from the ground to orbit.
fn view(r: &mut Random) -> Vec<f32> {
    let height_m = r.or(&[0.0, 2.0, 3e3, 4e5], |r| r.decades(1.0, 4e5));
    let radius_m = RADIUS_M + f64::from(height_m);
    let horizon = -(RADIUS_M / radius_m).min(1.0).acos();
    let highest = match f64::from(height_m) > TOP_M {
        true => -((RADIUS_M + TOP_M) / radius_m).acos(),
        false => FRAC_PI_2,
    };
    let mut all = r.direction().to_vec();
    all.extend([
        height_m,
        RADIUS_M as f32,
        TOP_M as f32,
        horizon as f32,
        highest as f32,
    ]);
    // A jump of density below the eye, and a limb that the planet's shadow crosses.
    let (kink_rad, kink_place) = match r.one_of(&[0.0, 1.0]) {
        0.0 => (horizon as f32, 0.0),
        _ => {
            let part = f64::from(r.between(0.01, 0.9));
            let kink = horizon + (highest - horizon) * part;
            (kink as f32, r.one_of(&[8.0, 20.0]) / 31.0)
        }
    };
    let share = if height_m > 1e4 {
        r.or(&[0.6], Random::unit)
    } else {
        0.0
    };
    all.extend([
        kink_rad,
        kink_place,
        share,
        r.or(&[0.0, 1.0], Random::unit),
        r.or(&[0.05, 10.0], |r| r.decades(0.05, 10.0)),
        -horizon.sin() as f32,
        r.or(&[100.0, 6e3, height_m], |r| r.decades(10.0, 9e4)),
    ]);
    all.extend(match f64::from(height_m) < TOP_M {
        true => [
            r.one_of(&[0.0, 0.2, 0.8]),
            r.or(&[0.1], |r| r.between(0.05, 0.9)),
        ],
        false => [0.0; 2],
    });
    all.extend((0..12).map(|_| r.or(&[1.0, 1e-3], |r| r.decades(1e-3, 10.0))));
    all
}

/// Number of numbers of a view.
const VIEW: usize = 29;

/// A view and a direction, which is not at the horizon or the limb, where radiance jumps.
fn view_and_direction(r: &mut Random) -> Vec<f32> {
    let mut all = view(r);
    loop {
        let direction = r.direction();
        let elevation = direction[1].clamp(-1.0, 1.0).asin();
        if all[6..8].iter().all(|edge| (elevation - edge).abs() > 1e-3) {
            all.extend(direction);
            return all;
        }
    }
}

fn scales(r: &mut Random) -> Vec<f32> {
    (0..8).map(|_| r.between(0.5, 2.0)).collect()
}

pub fn texel(place: f64, count: f64) -> f64 {
    (0.5 + place * (count - 1.0)) / count
}

pub fn azimuth(direction: &[f64], sun: &[f64]) -> f64 {
    let sun = match sun[0].abs() + sun[2].abs() < 1e-9 {
        true => [1.0, 0.0],
        false => [sun[0], sun[2]],
    };
    if direction[0].abs() + direction[2].abs() == 0.0 {
        return 0.0;
    }
    let difference = direction[2].atan2(direction[0]) - sun[1].atan2(sun[0]);
    let turn = difference.rem_euclid(2.0 * PI);
    turn.min(2.0 * PI - turn) / PI
}

pub fn elevation(direction: &[f64]) -> f64 {
    direction[1].atan2(direction[0].hypot(direction[2]))
}

fn column(view: &[f64], azimuth: f64) -> f64 {
    let [share, centre, width] = [view[10], view[11], view[12]];
    let dense = |azimuth: f64| ((azimuth - centre) / width).atan();
    (1.0 - share) * azimuth + share * (dense(azimuth) - dense(0.0)) / (dense(1.0) - dense(0.0))
}

/// Where an increasing function has a value.
fn inverse(function: impl Fn(f64) -> f64, value: f64) -> f64 {
    let (mut below, mut above) = (0.0, 1.0);
    for _ in 0..60 {
        let middle = 0.5 * (below + above);
        match function(middle) < value {
            true => below = middle,
            false => above = middle,
        }
    }
    0.5 * (below + above)
}

fn place(view: &[f64], elevation: f64, below: bool) -> f64 {
    let [horizon, highest, kink, kink_place] = [view[6], view[7], view[8], view[9]];
    let part = |from: f64, to: f64| ((elevation - from) / (to - from)).clamp(0.0, 1.0);
    if below {
        let part = part(horizon, -FRAC_PI_2);
        let even = view[13];
        (1.0 - even) * part.powf(0.25) + even * part.powf(0.5)
    } else if elevation < kink {
        kink_place * (1.0 - 2.0 * part(horizon, kink)).acos() / PI
    } else {
        kink_place + (1.0 - kink_place) * part(kink, highest).sqrt()
    }
}

fn elevation_of_place(view: &[f64], value: f64, below: bool) -> f64 {
    let (horizon, end) = (view[6], if below { -FRAC_PI_2 } else { view[7] });
    // Of the fourth root of the part, which is even near the horizon.
    let root = inverse(
        |root| place(view, horizon + (end - horizon) * root.powi(4), below),
        value,
    );
    horizon + (end - horizon) * root.powi(4)
}

fn row(view: &[f64], elevation: f64, below: bool, rows: [f64; 2]) -> f64 {
    let (count, first) = if below {
        (rows[1], rows[0])
    } else {
        (rows[0], 0.0)
    };
    (first + 0.5 + place(view, elevation, below) * (count - 1.0)) / (rows[0] + rows[1])
}

fn elevation_of_row(view: &[f64], coordinate: f64, rows: [f64; 2]) -> f64 {
    let row = coordinate * (rows[0] + rows[1]);
    let below = row >= rows[0];
    let (count, first) = if below {
        (rows[1], rows[0])
    } else {
        (rows[0], 0.0)
    };
    elevation_of_place(view, (row - first - 0.5) / (count - 1.0), below)
}

const SKY_ROWS: [f64; 2] = [125.0, 35.0];
const AERIAL_ROWS: [f64; 2] = [44.0, 18.0];

/// Place among the rows of aerial perspective of a place among those of the sky: in both, the rays that graze a jump are at a row.
fn aerial_place(view: &[f64], place: f64, below: bool) -> f64 {
    let kink = [view[9], aerial_kink(view)];
    if below {
        place
    } else if place < kink[0] {
        kink[1] * place / kink[0]
    } else {
        let above = (place - kink[0]) / (1.0 - kink[0]);
        kink[1] + (1.0 - kink[1]) * inverse(|place| part(place, 0.6), above)
    }
}

fn aerial_kink(view: &[f64]) -> f64 {
    let steps = AERIAL_ROWS[0] - 1.0;
    (view[9] * steps).round() / steps
}

fn aerial_row(view: &[f64], elevation: f64, below: bool) -> f64 {
    let place = aerial_place(view, place(view, elevation, below), below);
    match below {
        true => (44.5 + 17.0 * place) / 62.0,
        false => (0.5 + 43.0 * place) / 62.0,
    }
}

fn uv(view: &[f64], direction: &[f64]) -> [f64; 2] {
    let elevation = elevation(direction);
    let v = row(view, elevation, elevation < view[6], SKY_ROWS);
    [texel(column(view, azimuth(direction, view)), 64.0), v]
}

/// Distances at which a ray enters and leaves the air, from the two spheres.
fn span(view: &[f64], sine: f64, meets_ground: bool) -> [f64; 2] {
    let radius = view[4] + view[3];
    let roots = |sphere: f64| {
        let c = radius * radius - sphere * sphere;
        let root = (radius * radius * sine * sine - c).max(0.0).sqrt();
        [-radius * sine - root, -radius * sine + root]
    };
    let top = roots(view[4] + view[5]);
    let start = if view[3] > view[5] { top[0] } else { 0.0 };
    let end = if meets_ground {
        roots(view[4])[0]
    } else {
        top[1]
    };
    [start, end.max(start)]
}

/// Distances between which a ray is inside the sphere of the jump.
fn below_jump(view: &[f64], span: [f64; 2], sine: f64, meets_ground: bool) -> [f64; 2] {
    let (radius, jump) = (view[4] + view[3], view[4] + view[14]);
    let c = radius * radius - jump * jump;
    let discriminant = radius * radius * sine * sine - c;
    if discriminant <= 0.0 || (c > 0.0 && sine >= 0.0) {
        return [0.0; 2];
    }
    let exit = match meets_ground {
        true => span[1],
        false => -radius * sine + discriminant.sqrt(),
    };
    // From inside, and at the very surface upwards, rounding must not make a crossing.
    let entry = if c > 0.0 {
        -radius * sine - discriminant.sqrt()
    } else {
        0.0
    };
    let exit = if c == 0.0 && sine >= 0.0 && !meets_ground {
        0.0
    } else {
        exit
    };
    [entry, exit]
}

/// Part of a way in the air inside the sphere of the jump.
fn share(view: &[f64], span: [f64; 2], sine: f64, length: f64, meets_ground: bool) -> f64 {
    let [entry, exit] = below_jump(view, span, sine, meets_ground);
    let inside = (span[0] + length).min(exit) - span[0].max(entry);
    (inside / length.max(1e-6)).clamp(0.0, 1.0)
}

/// Part of a way in the air up to the first crossing of that sphere, or that of the grazing ray.
fn part_up_to_jump(view: &[f64], span: [f64; 2], sine: f64, meets_ground: bool) -> f64 {
    let [entry, exit] = below_jump(view, span, sine, meets_ground);
    let crossing = if entry > span[0] { entry } else { exit };
    if view[15] == 0.0 || meets_ground {
        0.0
    } else if exit == 0.0 {
        view[16]
    } else {
        ((crossing - span[0]) / (span[1] - span[0]).max(1e-6)).clamp(0.0, 1.0)
    }
}

/// What is relative to `above` for a ray with a share below a jump.
fn relative(above: &[f64], share: f64) -> [f64; 4] {
    std::array::from_fn(|k| above[k] + (1.0 - above[k]) * share)
}

/// A view, the interval in the air of a ray that meets air, and whether it meets the ground.
fn ray(r: &mut Random) -> Vec<f32> {
    let mut all = crossing_ray(r);
    all.remove(VIEW + 2);
    all
}

fn step_at_eye(view: &[f64], span: [f64; 2], meets_ground: bool) -> f64 {
    let (height, top) = (view[3], view[5]);
    match (height < top, meets_ground) {
        (false, true) => 2.0,
        (false, false) => 1.0,
        (true, false) => 0.0,
        (true, true) => {
            let slant = 1.0 - (height / span[1].max(1.0)).min(1.0);
            2.0 * (2.5 * height / top).min(1.0) * (1.0 - slant.powi(4))
        }
    }
}

/// Part of the way of a place.
fn part(place: f64, first_step: f64) -> f64 {
    first_step * place + (1.0 - first_step) * place * place
}

/// Part of the way in the air at a place: the square of the place up to a jump, and behind it what [`place_behind`] has there.
fn way_at(view: &[f64], span: [f64; 2], sine: f64, place: f64, meets_ground: bool) -> f64 {
    let at_jump = part_up_to_jump(view, span, sine, meets_ground);
    if at_jump == 0.0 {
        part(place, step_at_eye(view, span, meets_ground))
    } else if place < view[15] {
        at_jump * (place / view[15]).powi(2)
    } else {
        let length = (1.0 - at_jump) * (span[1] - span[0]);
        let place = (place - view[15]) / (1.0 - view[15]);
        at_jump + (1.0 - at_jump) * inverse(|part| place_behind(part, length), place)
    }
}

/// Place of a part of a length, m: the integral of 1 / (1 + distance / 100 km)^2 up to there, of that over all.
fn place_behind(part: f64, length: f64) -> f64 {
    let integral = |distance: f64| distance / (1.0 + distance / 1e5);
    match length == 0.0 {
        true => part,
        false => integral(part * length) / integral(length),
    }
}

fn place_of_distance(
    view: &[f64],
    span: [f64; 2],
    sine: f64,
    length: f64,
    meets_ground: bool,
) -> f64 {
    let way = (length / (span[1] - span[0]).max(1e-6)).clamp(0.0, 1.0);
    inverse(|place| way_at(view, span, sine, place, meets_ground), way)
}

/// A view, the interval in the air of a ray that meets air, the sine of its elevation, a number from 0 to 1, and whether it meets the
/// ground.
fn along_ray(r: &mut Random) -> Vec<f32> {
    let mut all = view_and_direction(r);
    let elevation = all[VIEW + 1].clamp(-1.0, 1.0).asin().min(all[7] - 1e-3);
    let below = elevation < all[6];
    all.truncate(VIEW);
    let exact: Vec<f64> = all.iter().copied().map(f64::from).collect();
    let span_m = span(&exact, f64::from(elevation).sin(), below);
    all.extend(span_m.map(|m| m as f32));
    all.extend([
        elevation.sin(),
        r.or(&[0.0, 1.0], Random::unit),
        f32::from(below),
    ]);
    all
}

/// As [`along_ray`], with a length in the air instead of the number.
fn length_along_ray(r: &mut Random) -> Vec<f32> {
    let mut all = along_ray(r);
    all[VIEW + 3] *= all[VIEW + 1] - all[VIEW];
    all
}

/// As [`along_ray`], without the number.
fn crossing_ray(r: &mut Random) -> Vec<f32> {
    let mut all = along_ray(r);
    all.remove(VIEW + 3);
    all
}

fn column_of_aerial(view: &[f64], azimuth: f64) -> f64 {
    inverse(|place| part(place, 0.3), column(view, azimuth))
}

pub fn place_of_phase(one_minus_cos: f64) -> f64 {
    (2.0 * (0.5 * one_minus_cos).sqrt().min(1.0).asin() / PI).sqrt()
}

/// A texture at coordinates, in f64.
pub fn sample(name: &str, uvw: [f64; 3]) -> [f64; 4] {
    let texture = textures::named(name);
    let size = texture.size();
    let axis = |k: usize| {
        let place = (uvw[k] * size[k] as f64 - 0.5).clamp(0.0, size[k] as f64 - 1.0);
        let below = place.floor().min(size[k] as f64 - 2.0).max(0.0);
        (below as usize, place - below)
    };
    let places = [axis(0), axis(1), axis(2)];
    let mut sum = [0.0; 4];
    for corner in 0..8 {
        let mut weight = 1.0;
        let mut index = [0; 3];
        for k in 0..3 {
            let far = corner >> k & 1;
            weight *= if far == 1 {
                places[k].1
            } else {
                1.0 - places[k].1
            };
            index[k] = (places[k].0 + far).min(size[k] - 1);
        }
        let texel = texture.texels()[(index[2] * size[1] + index[1]) * size[0] + index[0]];
        for (sum, value) in sum.iter_mut().zip(texel.to_array()) {
            *sum += weight * f64::from(value);
        }
    }
    sum
}

fn haze_phase(one_minus_cos: f64) -> [f64; 4] {
    sample(
        "phase_table_2d",
        [texel(place_of_phase(one_minus_cos), 1024.0), 0.5, 0.5],
    )
}

pub fn one_minus_cos(a: &[f64], b: &[f64]) -> f64 {
    0.5 * (0..3).map(|k| (a[k] - b[k]).powi(2)).sum::<f64>()
}

/// Smooth light and haze of the tables of a dimension.
fn light(dimension: u32, uvw: [f64; 3], scales: &[f64], phase: [f64; 4]) -> [f64; 4] {
    let smooth = sample(&format!("smooth_table_{dimension}d"), uvw);
    let haze = sample(&format!("haze_table_{dimension}d"), uvw);
    std::array::from_fn(|k| smooth[k].exp() * scales[k] + haze[k].exp() * scales[4 + k] * phase[k])
}

fn sky(x: &[f64]) -> Vec<f64> {
    let (view, scales, direction) = (&x[..VIEW], &x[VIEW..][..8], &x[VIEW + 8..]);
    if elevation(direction) > view[7] {
        return vec![0.0; 4];
    }
    let [u, v] = uv(view, direction);
    let phase = haze_phase(one_minus_cos(direction, view));
    light(2, [u, v, 0.5], scales, phase).to_vec()
}

fn aerial(x: &[f64]) -> Vec<f64> {
    let (view, scales) = (&x[..VIEW], &x[VIEW..][..8]);
    let (direction, distance_m) = (&x[VIEW + 8..][..3], x[VIEW + 11]);
    let elevation = elevation(direction);
    let below = elevation < view[6];
    let [start, end] = span(view, direction[1], below);
    let length = distance_m.min(end) - start;
    if length <= 0.0 || elevation > view[7] {
        return [[1.0; 4], [0.0; 4]].concat();
    }
    let place = place_of_distance(view, [start, end], direction[1], length, below);
    let w = texel(place, 42.0);
    let v = aerial_row(view, elevation, below);
    let u = texel(column_of_aerial(view, azimuth(direction, view)), 24.0);
    let phase = haze_phase(one_minus_cos(direction, view));
    let share = share(view, [start, end], direction[1], length, below);
    let extinction = relative(&view[17..21], share);
    let [smooth, haze] = [21, 25].map(|first| relative(&view[first..][..4], share));
    let depth = sample("extinction_table_2d", [w, v, 0.5]);
    let depth: [f64; 4] = std::array::from_fn(|k| depth[k] * extinction[k] * length * 1e-3);
    let scales: Vec<f64> = (0..8)
        .map(|k| scales[k] * if k < 4 { smooth[k] } else { haze[k - 4] })
        .collect();
    let source = light(3, [u, v, w], &scales, phase);
    let path = (0..4).map(|k| -(-depth[k]).exp_m1() * source[k] / extinction[k]);
    depth.map(|d| (-d).exp()).into_iter().chain(path).collect()
}

/// Twins with the textures of the tests.
fn with_textures() -> [(&'static str, FlatFunction); 4] {
    use twins::sky_tables::{aerial_perspective, aerial_transmittance, haze_phase, sky_radiance};
    let haze = |one_minus_cos: f32| {
        haze_phase(
            textures::named("phase_table_2d"),
            LinearSampler,
            one_minus_cos,
        )
    };
    let sky = |view: SkyView, scales: SkyScales, direction: Vec3| {
        let [smooth, haze, phase] =
            ["smooth_table_2d", "haze_table_2d", "phase_table_2d"].map(textures::named);
        sky_radiance(view, scales, smooth, haze, phase, LinearSampler, direction)
    };
    let aerial = |view: SkyView, scales: SkyScales, direction: Vec3, distance_m: f32| {
        let [smooth, haze, extinction, phase] = [
            "smooth_table_3d",
            "haze_table_3d",
            "extinction_table_2d",
            "phase_table_2d",
        ]
        .map(textures::named);
        let sampler = LinearSampler;
        aerial_perspective(
            view, scales, smooth, haze, extinction, phase, sampler, direction, distance_m,
        )
    };
    let transmittance = |view: SkyView, direction: Vec3, distance_m: f32| {
        let extinction = textures::named("extinction_table_2d");
        aerial_transmittance(view, extinction, LinearSampler, direction, distance_m)
    };
    [
        ("haze_phase", haze.flat()),
        ("sky_radiance", sky.flat()),
        ("aerial_perspective", aerial.flat()),
        ("aerial_transmittance", transmittance.flat()),
    ]
}

pub fn weighted(weights: &[f64], spectrum: &[f64]) -> Vec<f64> {
    let channel = |c: usize| (0..4).map(|k| weights[4 * c + k] * spectrum[k]).sum();
    (0..3).map(channel).collect()
}

pub fn sky_tables() -> Vec<Row> {
    let mut all = rows!(twins::sky_tables {
        texel_coordinate: |r| vec![r.or(&[0.0, 1.0], Random::unit), r.one_of(&[2.0, 64.0])]
            => |x| vec![texel(x[0], x[1])];
        place_from_texel_coordinate: |r| vec![r.unit(), r.one_of(&[2.0, 64.0])]
            => |x| vec![(x[0] * x[1] - 0.5) / (x[1] - 1.0)];
        azimuth_place: |r| [r.direction(), r.direction()].concat()
            => |x| vec![azimuth(&x[..3], &x[3..])];
        column_place: |r| [view(r), vec![r.or(&[0.0, 1.0], Random::unit)]].concat()
            => |x| vec![column(x, x[VIEW])];
        azimuth_from_column_place: |r| [view(r), vec![r.or(&[0.0, 1.0], Random::unit)]].concat()
            => |x| vec![inverse(|azimuth| column(x, azimuth), x[VIEW])];
        row_place: |r| {
            let mut all = view_and_direction(r);
            let elevation = all[VIEW + 1].clamp(-1.0, 1.0).asin();
            all.truncate(VIEW);
            let below = elevation < all[6];
            all.extend([elevation, f32::from(below)]);
            all
        } => |x| vec![place(x, x[VIEW], x[VIEW + 1] != 0.0)];
        elevation_from_row_place: |r| {
            let mut all = view(r);
            all.extend([r.or(&[0.0, 1.0], Random::unit), r.one_of(&[0.0, 1.0])]);
            all
        } => |x| vec![elevation_of_place(x, x[VIEW], x[VIEW + 1] != 0.0)];
        row_coordinate: |r| {
            let mut all = view_and_direction(r);
            let elevation = all[VIEW + 1].clamp(-1.0, 1.0).asin();
            let below = elevation < all[6];
            all.truncate(VIEW);
            all.extend([elevation, f32::from(below), 64.0, 32.0]);
            all
        } => |x| vec![row(x, x[VIEW], x[VIEW + 1] != 0.0, [x[VIEW + 2], x[VIEW + 3]])];
        elevation_from_row_coordinate: |r| {
            let mut all = view(r);
            // A texel's centre, as rows from different halves do not mix.
            let row = (r.unit() * 96.0).floor();
            all.extend([(row + 0.5) / 96.0, 64.0, 32.0]);
            all
        } => |x| vec![elevation_of_row(x, x[VIEW], [x[VIEW + 1], x[VIEW + 2]])];
        elevation_of: |r| r.direction().to_vec() => |x| vec![elevation(x)];
        uv_from_direction: view_and_direction => |x| uv(x, &x[VIEW..]).to_vec();
        direction_from_azimuth_elevation: |r| {
            let mut all = view(r);
            all.extend([r.or(&[0.0, 1.0], Random::unit), r.or(&[0.0, 1.57], |r| r.between(-1.57, 1.57))]);
            all
        } => |x| {
            let sun = if x[0].abs() + x[2].abs() < 1e-9 { 0.0 } else { x[2].atan2(x[0]) };
            let (turn, cos) = (sun + PI * x[VIEW], x[VIEW + 1].cos());
            vec![turn.cos() * cos, x[VIEW + 1].sin(), turn.sin() * cos]
        };
        air_span_m: |r| {
            let mut all = view_and_direction(r);
            // From space, rays that meet the air.
            let elevation = all[VIEW + 1].clamp(-1.0, 1.0).asin().min(all[7] - 1e-3);
            let below = elevation < all[6];
            all.truncate(VIEW);
            all.extend([elevation.sin(), f32::from(below)]);
            all
        } => |x| span(x, x[VIEW], x[VIEW + 1] != 0.0).to_vec();
        below_jump_m: crossing_ray => |x| {
            let of = &x[VIEW..];
            below_jump(x, [of[0], of[1]], of[2], of[3] != 0.0).to_vec()
        };
        share_below_jump: length_along_ray => |x| {
            let of = &x[VIEW..];
            vec![share(x, [of[0], of[1]], of[2], of[3], of[4] != 0.0)]
        };
        part_at_jump: crossing_ray => |x| {
            let of = &x[VIEW..];
            vec![part_up_to_jump(x, [of[0], of[1]], of[2], of[3] != 0.0)]
        };
        place_behind_jump: |r| vec![r.or(&[0.0, 1.0], Random::unit), r.or(&[0.0, 1e5], |r| r.decades(10.0, 2e6))]
            => |x| vec![place_behind(x[0], x[1])];
        part_behind_jump: |r| vec![r.or(&[0.0, 1.0], Random::unit), r.or(&[0.0, 1e5], |r| r.decades(10.0, 2e6))]
            => |x| vec![inverse(|part| place_behind(part, x[1]), x[0])];
        aerial_kink_place: view => |x| vec![aerial_kink(x)];
        aerial_row_place: |r| {
            let mut all = view(r);
            all.extend([r.or(&[0.0, 1.0, all[9]], Random::unit), r.one_of(&[0.0, 1.0])]);
            all
        } => |x| vec![aerial_place(x, x[VIEW], x[VIEW + 1] != 0.0)];
        row_place_from_aerial: |r| {
            let mut all = view(r);
            all.extend([r.or(&[0.0, 1.0], Random::unit), r.one_of(&[0.0, 1.0])]);
            all
        } => |x| vec![inverse(|place| aerial_place(x, place, x[VIEW + 1] != 0.0), x[VIEW])];
        aerial_row_coordinate: |r| {
            let mut all = view_and_direction(r);
            let elevation = all[VIEW + 1].clamp(-1.0, 1.0).asin();
            let below = elevation < all[6];
            all.truncate(VIEW);
            all.extend([elevation, f32::from(below)]);
            all
        } => |x| vec![aerial_row(x, x[VIEW], x[VIEW + 1] != 0.0)];
        aerial_column_place: |r| [view(r), vec![r.or(&[0.0, 1.0], Random::unit)]].concat()
            => |x| vec![column_of_aerial(x, x[VIEW])];
        first_step: |r| ray(r) => |x| vec![step_at_eye(x, [x[VIEW], x[VIEW + 1]], x[VIEW + 2] != 0.0)];
        place_from_part: |r| vec![r.or(&[0.0, 1.0], Random::unit), r.or(&[0.0, 1.0, 2.0], |r| r.between(0.0, 2.0))]
            => |x| vec![inverse(|place| part(place, x[1]), x[0])];
        part_from_place: |r| vec![r.or(&[0.0, 1.0], Random::unit), r.or(&[0.0, 1.0, 2.0], |r| r.between(0.0, 2.0))]
            => |x| vec![part(x[0], x[1])];
        distance_place: length_along_ray => |x| {
            let of = &x[VIEW..];
            vec![place_of_distance(x, [of[0], of[1]], of[2], of[3], of[4] != 0.0)]
        };
        length_from_distance_place: along_ray => |x| {
            let of = &x[VIEW..];
            let way = way_at(x, [of[0], of[1]], of[2], of[3], of[4] != 0.0);
            vec![way * (of[1] - of[0])]
        };
        phase_place: |r| vec![r.one_minus_cos()] => |x| vec![place_of_phase(x[0])];
        one_minus_cos_from_phase_place: |r| vec![r.or(&[0.0, 1.0], Random::unit)]
            => |x| vec![2.0 * (FRAC_PI_2 * x[0] * x[0]).sin().powi(2)];
        rgb_path: |r| (0..32).map(|_| r.unit()).collect() => |x| {
            [weighted(&x[12..24], &x[24..28]), weighted(&x[..12], &x[28..])].concat()
        };
    });
    for (name, twin) in with_textures() {
        all.push(Row {
            name,
            twin,
            inputs: match name {
                "haze_phase" => |r| vec![r.one_minus_cos()],
                "sky_radiance" => |r| {
                    let mut all = view_and_direction(r);
                    let direction = all.split_off(VIEW);
                    [all, scales(r), direction].concat()
                },
                "aerial_transmittance" => |r| {
                    let mut all = view_and_direction(r);
                    all.push(r.length_m());
                    all
                },
                _ => |r| {
                    let mut all = view_and_direction(r);
                    let direction = all.split_off(VIEW);
                    [all, scales(r), direction, vec![r.length_m()]].concat()
                },
            },
            exact: match name {
                "haze_phase" => Box::new(|x| haze_phase(x[0]).to_vec()),
                "sky_radiance" => Box::new(sky),
                // As of the path, whose scales do not matter.
                "aerial_transmittance" => Box::new(|x| {
                    let path = aerial(&[&x[..VIEW], &[1.0; 8], &x[VIEW..]].concat());
                    path[..4].to_vec()
                }),
                _ => Box::new(aerial),
            },
        });
    }
    all
}
