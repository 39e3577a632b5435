//! Fog from tables.

use super::sky_tables::{azimuth, elevation, one_minus_cos, place_of_phase, sample, texel};
use super::{Row, rows};
use crate::flat::{FlatFunction, Twin, flat_struct};
use crate::random::Random;
use crate::textures;
use airlight_shaders::twins;
use airlight_shaders::twins::fog_table::FogTableView;
use airlight_shaders::twins::texture::LinearSampler;
use glam::Vec3;
use std::f64::consts::FRAC_PI_2;

flat_struct! {
    twins::fog_table::FogTableView {
        sun, below_per_sine, depth_below, above_per_sine, depth_above, diffuse_scale, sunlit_scale, layer, layer_count, phase_count
    }
}

/// Numbers of a view.
const VIEW: usize = 16;

/// Layers and phase functions of the textures of the tests.
const LAYERS: f32 = 2.0;
const PHASES: f32 = 2.0;

/// A view of a layer from inside or above fog, thin or opaque.
fn view(r: &mut Random) -> Vec<f32> {
    let depth = |r: &mut Random| {
        let grey = r.or(&[1e25], |r| r.decades(1e-4, 30.0));
        r.rgb(|r| grey * r.between(1.0, 1.3))
    };
    let mut all = r.direction().to_vec();
    all.push(r.decades(20.0, 1e6));
    all.extend(depth(r));
    all.push(r.decades(20.0, 1e6));
    all.extend(depth(r));
    all.extend([r.between(0.5, 2.0), r.between(0.5, 2.0)]);
    all.extend([r.one_of(&[0.0, 1.0]), LAYERS, PHASES]);
    all
}

fn row_place(per_sine: f64, sine: f64, elevation: f64) -> f64 {
    0.6 * (sine * per_sine).ln_1p() / per_sine.ln_1p() + 0.4 * elevation / FRAC_PI_2
}

fn row(view: &[f64], direction: &[f64]) -> f64 {
    let (per_sine, first) = match direction[1] > 0.0 {
        true => (view[7], 64.0),
        false => (view[3], 0.0),
    };
    let place = row_place(per_sine, direction[1].abs(), elevation(direction).abs());
    (first + 0.5 + place * 63.0) / 128.0
}

fn opacity(depth: f64) -> f64 {
    -(-depth).exp_m1()
}

/// Place of a distance from opacities and transmittances, of which the first are exact in thin fog and the second in dense fog.
fn place(view: &[f64], sine: f64, opacities: &[f64], transmittances: &[f64]) -> f64 {
    let vertical = if sine > 0.0 {
        &view[8..11]
    } else {
        &view[4..7]
    };
    let depths: Vec<f64> = vertical
        .iter()
        .map(|depth| depth / sine.abs().max(1e-10))
        .collect();
    let whole: f64 = depths.iter().map(|&depth| opacity(depth)).sum();
    let left = match whole < 1.5 {
        true => whole - opacities.iter().sum::<f64>(),
        false => (0..3).map(|c| transmittances[c] - (-depths[c]).exp()).sum(),
    };
    1.0 - (left / whole).clamp(0.0, 1.0).powf(0.25)
}

/// Texture coordinate in the stacked tables of a view.
fn stacked(view: &[f64], coordinate: f64) -> f64 {
    (view[13] + coordinate) / view[14]
}

fn stream_light(view: &[f64], place: &[f64], phase: f64, stream: f64) -> Vec<f64> {
    let slice = (3.0 * phase + stream + 0.5) / (3.0 * view[15]);
    let logarithms = sample(
        "stream_table_3d",
        [place[0], place[1], stacked(view, slice)],
    );
    let phase = sample("stream_phase_table_2d", [place[2], slice, 0.5]);
    (0..3).map(|c| logarithms[c].exp() * phase[c]).collect()
}

fn fog(x: &[f64]) -> Vec<f64> {
    let (direction, depth) = (&x[VIEW..], &x[VIEW + 3..]);
    let opacities: Vec<f64> = depth.iter().map(|&d| opacity(d)).collect();
    let u = texel(azimuth(direction, x), 32.0);
    let v = row(x, direction);
    let transmittances: Vec<f64> = depth.iter().map(|d| (-d).exp()).collect();
    let w = texel(place(x, direction[1], &opacities, &transmittances), 32.0);
    let diffuse = sample("diffuse_table_3d", [u, v, stacked(x, w)]);
    let angle = texel(place_of_phase(one_minus_cos(direction, x)), 1024.0);
    let streams = (0..PHASES as usize).flat_map(|phase| {
        [0.0, 1.0, 2.0].map(|stream| stream_light(x, &[w, v, angle], phase as f64, stream))
    });
    let streams: Vec<Vec<f64>> = streams.collect();
    let radiance = (0..3).map(|c| {
        let sunlit: f64 = streams.iter().map(|light| light[c]).sum();
        opacities[c] * (x[11] * diffuse[c] + x[12] * sunlit)
    });
    depth.iter().map(|d| (-d).exp()).chain(radiance).collect()
}

/// Twins with the textures of the tests.
fn with_textures() -> [(&'static str, FlatFunction); 2] {
    use twins::fog_table::{fog_stream_light, tabulated_fog};
    let stream = |view: FogTableView, place: Vec3, phase: f32, stream: f32| {
        let [streams, phases] = ["stream_table_3d", "stream_phase_table_2d"].map(textures::named);
        fog_stream_light(view, streams, phases, LinearSampler, place, phase, stream)
    };
    let fog = |view: FogTableView, direction: Vec3, depth: Vec3| {
        let [diffuse, streams, phase] = [
            "diffuse_table_3d",
            "stream_table_3d",
            "stream_phase_table_2d",
        ]
        .map(textures::named);
        tabulated_fog(
            view,
            diffuse,
            streams,
            phase,
            LinearSampler,
            direction,
            depth,
        )
    };
    [
        ("fog_stream_light", stream.flat()),
        ("tabulated_fog", fog.flat()),
    ]
}

/// A direction that is not level, where rows end.
fn direction(r: &mut Random) -> [f32; 3] {
    loop {
        let direction = r.direction();
        if direction[1] != 0.0 {
            return direction;
        }
    }
}

pub fn fog_table() -> Vec<Row> {
    let mut all = rows!(twins::fog_table {
        fog_row_place: |r| {
            let sine = r.sine().abs();
            vec![r.decades(20.0, 1e6), sine, sine.asin()]
        } => |x| vec![row_place(x[0], x[1], x[2])];
        fog_row_coordinate: |r| {
            let mut all = view(r);
            all.extend(r.direction());
            all
        } => |x| vec![row(x, &x[VIEW..])];
        fog_stacked_coordinate: |r| {
            let mut all = view(r);
            all.push(r.unit());
            all
        } => |x| vec![stacked(x, x[VIEW])];
        fog_opacity: |r| r.rgb(Random::depth).to_vec()
            => |x| x.iter().map(|&depth| opacity(depth)).collect();
        fog_distance_place: |r| {
            let mut all = view(r);
            all.push(direction(r)[1]);
            let depth = r.rgb(|r| r.or(&[0.0, 40.0], |r| r.decades(1e-4, 10.0)));
            all.extend(depth.map(|depth| -(-depth).exp_m1()));
            all.extend(depth.map(|depth| (-depth).exp()));
            all
        } => |x| vec![place(x, x[VIEW], &x[VIEW + 1..VIEW + 4], &x[VIEW + 4..])];
    });
    for (name, twin) in with_textures() {
        all.push(match name {
            "tabulated_fog" => Row {
                name,
                twin,
                inputs: |r| {
                    let mut all = view(r);
                    all.extend(direction(r));
                    let grey = r.or(&[0.0, 40.0], |r| r.decades(1e-4, 10.0));
                    all.extend(r.rgb(|r| grey * r.between(1.0, 1.3)));
                    all
                },
                exact: Box::new(fog),
            },
            _ => Row {
                name,
                twin,
                inputs: |r| {
                    let mut all = view(r);
                    all.extend(r.rgb(Random::unit));
                    all.push(r.one_of(&[0.0, 1.0]));
                    all.push(r.one_of(&[0.0, 1.0, 2.0]));
                    all
                },
                exact: Box::new(|x| stream_light(x, &x[VIEW..], x[VIEW + 3], x[VIEW + 4])),
            },
        });
    }
    all
}
