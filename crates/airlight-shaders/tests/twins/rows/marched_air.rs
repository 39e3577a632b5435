//! Marched air.

use super::air::{divided_difference, exact_ray, exponential};
use super::{Row, rows};
use crate::flat::flat_struct;
use crate::random::Random;
use airlight::fog::{DensityProfile, RaySegment};
use airlight_shaders::twins;

flat_struct! {
    twins::air::AirMedium { molecules_per_m, molecules_scale_m, haze_extinction_per_m, haze_scale_m, haze_scattering_per_m, top_m,
        ozone_per_m, ozone_bottom_m, ozone_top_m, inverse_radius_per_m }
    twins::air::AirLight { sunlight, sin_sun, cos_to_sun, molecules_phase, haze_phase }
    twins::air::AirMarch { path, end_m, depth_to_sun, clearance }
}

/// Numbers of air, of a ray, of light on it.
const AIR: usize = 18;
const RAY: usize = 4;
const LIGHT: usize = 7;
/// Numbers of a march.
const MARCH: usize = 11;

/// Air from none to thick haze, of the Earth or of a small planet.
fn air(r: &mut Random) -> Vec<f32> {
    let mut all = r
        .rgb(|r| r.or(&[0.0, 1.2e-5], |r| r.decades(1e-6, 5e-5)))
        .to_vec();
    all.push(r.between(5e3, 1.2e4));
    let haze = r.rgb(|r| r.or(&[0.0, 2e-5], |r| r.decades(1e-7, 1e-3)));
    all.extend(haze);
    all.push(r.between(500.0, 3e3));
    all.extend(haze.map(|x| x * r.between(0.5, 1.0)));
    all.push(r.one_of(&[6e4, 1e5]));
    all.extend(r.rgb(|r| r.or(&[0.0], |r| r.decades(1e-8, 3e-6))));
    let bottom = r.between(1e4, 2e4);
    all.extend([bottom, bottom + r.between(5e3, 2e4)]);
    all.push(r.one_of(&[1.0 / 6.371e6, 1e-6]));
    all
}

/// A ray of an eye on the ground, in the air, or below the ground.
fn ray(r: &mut Random, air: &[f32]) -> Vec<f32> {
    let height = r.or(&[0.0, 2.0, 1e4, -5.0], |r| r.decades(1.0, 5e4));
    let sine = r.sine();
    let curvature = 0.5 * ((1.0 - sine) * (1.0 + sine)).max(0.0) * air[17];
    let length = r.or(&[0.0, 1e12], |r| r.decades(10.0, 1e6));
    vec![height, sine, curvature, length]
}

/// Sunlight along a direction of this sine.
fn light(r: &mut Random, sine: f32) -> Vec<f32> {
    let across = ((1.0 - sine) * (1.0 + sine)).max(0.0).sqrt();
    let sun = r.direction();
    let mut all = r.rgb(Random::unit).to_vec();
    all.extend([sun[1], (sun[1] * sine + sun[0] * across).clamp(-1.0, 1.0)]);
    all.extend([r.between(0.05, 0.12), r.decades(1e-2, 10.0)]);
    all
}

/// Height of the lowest point of the way to the sun, in units of `R / (2 cos^2)`.
fn clearance(air: &[f64], height_m: f64, sin_sun: f64) -> f64 {
    let sine = sin_sun.min(0.0);
    let curvature = 0.5 * (1.0 - sine * sine) * air[17];
    match curvature > 1e-12 {
        true => 4.0 * curvature * (height_m - sine * sine / (4.0 * curvature)),
        false => -sine * sine,
    }
}

fn columns(air: &[f64], ray: &RaySegment) -> [f64; 3] {
    let ozone = DensityProfile::Layer {
        bottom_m: air[15],
        top_m: air[16],
    };
    [exponential(0.0, air[3]), exponential(0.0, air[7]), ozone]
        .map(|profile| profile.column_along_m(ray).min(1e25))
}

fn depth(air: &[f64], columns: [f64; 3]) -> [f64; 3] {
    std::array::from_fn(|c| {
        air[c] * columns[0] + air[4 + c] * columns[1] + air[12 + c] * columns[2]
    })
}

/// Optical depth to the sun, or to where it sets: where the way to it grazes the ground.
fn depth_to_sun(air: &[f64], height_m: f64, sin_sun: f64) -> [f64; 3] {
    let above = height_m.max(0.0);
    let horizon = -(2.0 * air[17] * above).sqrt().atan().sin();
    let ray = RaySegment::new(above, sin_sun.max(horizon), f64::INFINITY, 1.0 / air[17]);
    depth(air, columns(air, &ray))
}

fn sin_sun(air: &[f64], ray: &[f64], s_m: f64, light: &[f64]) -> f64 {
    let k = air[17];
    let from_centre = light[3] * (1.0 + k * ray[0]) + k * s_m * light[4];
    (from_centre / (1.0 + k * exact_ray(ray).height_at(s_m))).clamp(-1.0, 1.0)
}

/// State of a march: path, distance, optical depth to the sun, clearance.
fn march_at(air: &[f64], ray: &[f64], s_m: f64, light: &[f64], path: Vec<f64>) -> Vec<f64> {
    let height = exact_ray(ray).height_at(s_m);
    let sine = sin_sun(air, ray, s_m, light);
    let mut all = path;
    all.push(s_m);
    all.extend(depth_to_sun(air, height, sine));
    all.push(clearance(air, height, sine));
    all
}

/// A march that has come to a distance.
fn march(r: &mut Random) -> Vec<f32> {
    let mut all: Vec<f32> = (0..6).map(|_| r.or(&[0.0, 1.0], Random::unit)).collect();
    all.push(r.or(&[0.0], |r| r.decades(1.0, 1e5)));
    all.extend(r.rgb(Random::depth));
    all.push(r.or(&[0.0, 1e-3, -1e-3], |r| r.between(-0.02, 0.02)));
    all
}

pub fn marched_air() -> Vec<Row> {
    rows!(twins::air {
        air_length_m: |r| {
            let air = air(r);
            let ray = ray(r, &air);
            [air, ray].concat()
        } => |x| {
            let ray = exact_ray(&x[AIR..]);
            let (ground, air) = (ray.below(0.0), ray.below(x[11]));
            vec![if ground.1 > ground.0 { ground.0 } else { air.1 }]
        };
        air_columns_m: |r| {
            let air = air(r);
            let ray = ray(r, &air);
            [air, ray].concat()
        } => |x| columns(x, &exact_ray(&x[AIR..])).to_vec();
        air_optical_depth: |r| {
            let mut all = air(r);
            all.extend(r.rgb(|r| r.or(&[0.0, 1e25], |r| r.decades(1.0, 1e7))));
            all
        } => |x| depth(x, [x[AIR], x[AIR + 1], x[AIR + 2]]).to_vec();
        sin_sun_along: |r| {
            let mut all = air(r);
            let ray = ray(r, &all);
            let sine = ray[1];
            all.extend(ray);
            all.push(r.or(&[0.0], |r| r.decades(1.0, 5e5)));
            all.extend(light(r, sine));
            all
        } => |x| vec![sin_sun(x, &x[AIR..], x[AIR + RAY], &x[AIR + RAY + 1..])];
        sun_clearance: |r| {
            let mut all = air(r);
            all.extend([r.height_m(), r.sine()]);
            all
        } => |x| vec![clearance(x, x[AIR], x[AIR + 1])];
        air_depth_to_sun: |r| {
            let mut all = air(r);
            all.extend([r.or(&[0.0, 2.0, 1e4, -5.0], |r| r.decades(1.0, 5e4)), r.sine()]);
            all
        } => |x| depth_to_sun(x, x[AIR], x[AIR + 1]).to_vec();
        air_march: |r| {
            let mut all = air(r);
            let ray = ray(r, &all);
            let sine = ray[1];
            all.extend(ray);
            all.extend(light(r, sine));
            all
        } => |x| {
            let none = vec![1.0, 1.0, 1.0, 0.0, 0.0, 0.0];
            march_at(x, &x[AIR..], 0.0, &x[AIR + RAY..], none)
        };
        air_march_step: |r| loop {
            let march = march(r);
            let air = air(r);
            let ray = ray(r, &air);
            let to = march[6] + r.or(&[0.0], |r| r.decades(1.0, 1e5));
            // Not through the ground.
            let exact: Vec<f64> = ray.iter().map(|&x| f64::from(x)).collect();
            let heights = [march[6], to].map(|s| exact_ray(&exact).height_at(f64::from(s)));
            if heights.iter().all(|&height| height > -10.0) {
                let light = light(r, ray[1]);
                let mut all = [march, air, ray, vec![to], light].concat();
                all.push(r.or(&[0.0, 1.0], Random::unit));
                return all;
            }
        } => |x| {
            let (march, x) = x.split_at(MARCH);
            let (air, ray) = (&x[..AIR], &x[AIR..][..RAY]);
            let to = x[AIR + RAY];
            let (light, visibility) = (&x[AIR + RAY + 1..][..LIGHT], x[AIR + RAY + 1 + LIGHT]);
            let columns = columns(air, &exact_ray(ray).part(march[6], to));
            let depth = depth(air, columns);
            let mut all = march_at(air, ray, to, light, Vec::new());
            let (near, far) = (march[10], all[4]);
            let lit = match near.min(far) >= 0.0 {
                true => 1.0,
                false => near.max(far).max(0.0) / (near.max(far).max(0.0) - near.min(far)),
            };
            let transmittance = (0..3).map(|c| march[c] * (-depth[c]).exp());
            let radiance = (0..3).map(|c| {
                let scattered = air[c] * columns[0] * light[5] + air[8 + c] * columns[1] * light[6];
                let arriving = light[c] * visibility * lit;
                let attenuation = divided_difference(march[7 + c], all[1 + c] + depth[c]);
                march[3 + c] + march[c] * scattered * arriving * attenuation
            });
            let mut path: Vec<f64> = transmittance.chain(radiance).collect();
            path.append(&mut all);
            path
        };
    })
}
