//! Exponentials, path optics, columns.

use super::{Row, rows};
use crate::flat::flat_struct;
use crate::random::Random;
use airlight::fog::DensityProfile;
use airlight::fog::RaySegment;
use airlight_shaders::twins;

flat_struct! {
    twins::path_optics::PathOptics { transmittance, path_radiance }
    twins::columns::RaySegment { height_m, sin_elevation, curvature_per_m, length_m }
}

/// `(1 - e^-x) / x` for either sign.
pub fn phi(x: f64) -> f64 {
    match x.abs() < 1e-8 {
        true => 1.0 - 0.5 * x,
        false => -(-x).exp_m1() / x,
    }
}

/// `((1 - e^-x) / x - e^-x) / x`.
fn ramp(x: f64) -> f64 {
    match x < 0.5 {
        true => {
            let mut term = 0.5;
            let mut sum = term;
            for k in 1..20 {
                let k = f64::from(k);
                term *= -x * (k + 1.0) / (k * (k + 2.0));
                sum += term;
            }
            sum
        }
        false => (phi(x) - (-x).exp()) / x,
    }
}

/// The divided difference of `e^-x`.
pub fn divided_difference(near: f64, far: f64) -> f64 {
    (-near.min(far)).exp() * phi((far - near).abs())
}

/// `e^(z^2) erfc(z)` by its integral `2 / sqrt(pi) int_0^inf e^(-u^2 - 2 z u) du`.
fn exact_scaled_erfc(z: f64) -> f64 {
    // Simpson's rule over u = v / (1 + z), where the integrand is smooth and ends by v = 7.
    let steps = 20_000;
    let scale = 1.0 / (1.0 + z);
    let at = |v: f64| (-(v * scale).powi(2) - 2.0 * z * v * scale).exp();
    let (end, count) = (12.0, f64::from(steps));
    let step = end / count;
    let sum: f64 = (1..steps)
        .map(|k| f64::from(2 + 2 * (k % 2)) * at(step * f64::from(k)))
        .sum();
    (sum + at(0.0) + at(end)) * step / 3.0 * scale * 2.0 / std::f64::consts::PI.sqrt()
}

pub fn exponentials() -> Vec<Row> {
    rows!(twins::exponentials {
        mean_transmittance: |r| vec![r.depth()] => |x| vec![phi(x[0])];
        mean_transmittance_rgb: |r| r.rgb(Random::depth).to_vec()
            => |x| x.iter().map(|&x| phi(x)).collect();
        ramp_transmittance: |r| vec![r.depth()] => |x| vec![ramp(x[0])];
        mean_attenuated_source: |r| pair_of_depths(r).to_vec()
            => |x| vec![divided_difference(x[0], x[1])];
        mean_attenuated_source_rgb: |r| {
            let pairs: [[f32; 2]; 3] = std::array::from_fn(|_| pair_of_depths(r));
            let of = |end: usize| pairs.map(|pair| pair[end]);
            [of(0), of(1)].concat()
        } => |x| (0..3).map(|c| divided_difference(x[c], x[c + 3])).collect();
        linear_source_mean: |r| vec![r.depth()] => |x| vec![phi(x[0]) - ramp(x[0]), ramp(x[0])];
        scaled_erfc: |r| vec![r.or(&[0.0, 1.0, 1e6, 1e18], |r| r.decades(1e-4, 1e4))]
            => |z| vec![exact_scaled_erfc(z[0])];
    })
}

/// Two optical depths, often nearly equal.
fn pair_of_depths(r: &mut Random) -> [f32; 2] {
    let near = r.depth();
    let far = match r.unit() < 0.3 {
        true => near * (1.0 + r.between(-1e-5, 1e-5)),
        false => r.depth(),
    };
    [near, far]
}

pub fn path_optics() -> Vec<Row> {
    rows!(twins::path_optics {
        apply_path_optics: |r| (0..9).map(|_| r.unit()).collect()
            => |x| (0..3).map(|c| x[c] * x[c + 6] + x[c + 3]).collect();
        near_then_far: |r| (0..12).map(|_| r.unit()).collect() => |x| {
            let transmittance = (0..3).map(|c| x[c] * x[c + 6]);
            transmittance.chain((0..3).map(|c| x[c + 3] + x[c] * x[c + 9])).collect()
        };
        constant_source: |r| [r.rgb(Random::depth), r.rgb(Random::unit)].concat() => |x| {
            let transmittance = (0..3).map(|c| (-x[c]).exp());
            transmittance.chain((0..3).map(|c| x[c + 3] * -(-x[c]).exp_m1())).collect()
        };
    })
}

/// A ray over flat or round ground.
pub fn ray(r: &mut Random) -> Vec<f32> {
    let sine = r.sine();
    let curvature = 0.5 * ((1.0 - sine) * (1.0 + sine)).max(0.0) * r.inverse_radius_per_m();
    vec![r.height_m(), sine, curvature, r.length_m()]
}

/// A ray followed by other numbers.
pub fn ray_and<const N: usize>(r: &mut Random, others: [fn(&mut Random) -> f32; N]) -> Vec<f32> {
    let mut all = ray(r);
    all.extend(others.map(|other| other(r)));
    all
}

/// A ray and a height, which or `thickness` above which a ray over round ground often almost touches from above.
fn near_the_dip(r: &mut Random, thickness: f32) -> Vec<f32> {
    let mut all = ray_and(r, [Random::edge_m]);
    if all[2] > 0.0 && r.unit() < 0.5 {
        let sine = -r.decades(1e-4, 0.06);
        let deepest = 0.25 * sine * sine / all[2];
        let touched = all[4] + r.one_of(&[0.0, thickness]);
        all[0] = touched + deepest * (1.0 - r.decades(1e-6, 0.1));
        all[1] = sine;
    }
    all
}

/// The same ray of the f64 library.
pub fn exact_ray(x: &[f64]) -> RaySegment {
    RaySegment {
        height_m: x[0],
        sin_elevation: x[1],
        curvature_per_m: x[2],
        length_m: if x[3] > 0.9e18 { f64::INFINITY } else { x[3] },
    }
}

/// Column of a profile along a ray.
fn column(profile: DensityProfile, x: &[f64]) -> Vec<f64> {
    vec![profile.column_along_m(&exact_ray(x)).min(1e25)]
}

pub fn exponential(reference_height_m: f64, scale_height_m: f64) -> DensityProfile {
    DensityProfile::Exponential {
        reference_height_m,
        scale_height_m,
    }
}

pub fn clamped(base_height_m: f64, scale_height_m: f64) -> DensityProfile {
    DensityProfile::Clamped {
        base_height_m,
        scale_height_m,
    }
}

/// `int_0^length e^-(a s + b s^2) ds`: the column of an exponential profile of scale 1.
fn falling(a: f64, b: f64, length: f64) -> f64 {
    let ray = RaySegment {
        height_m: 0.0,
        sin_elevation: a,
        curvature_per_m: b,
        length_m: length,
    };
    exponential(0.0, 1.0).column_along_m(&ray)
}

pub fn columns() -> Vec<Row> {
    rows!(twins::columns {
        ray_segment: |r| vec![r.height_m(), r.sine(), r.length_m(), r.inverse_radius_per_m()]
            => |x| vec![x[0], x[1], 0.5 * (1.0 - x[1] * x[1]).max(0.0) * x[3], x[2]];
        height_at: |r| ray_and(r, [|r| r.decades(1e-2, 1e5)])
            => |x| vec![exact_ray(x).height_at(x[4])];
        ray_part: |r| ray_and(r, [|r| r.decades(1e-2, 1e4), |r| r.decades(1e4, 1e5)]) => |x| {
            let part = exact_ray(x).part(x[4], x[5]);
            vec![part.height_m, part.sin_elevation, part.curvature_per_m, part.length_m]
        };
        below_height: |r| near_the_dip(r, 0.0) => |x| {
            let (first, last) = exact_ray(x).below(x[4]);
            [first, last].map(|s| if s.is_finite() { s } else { x[3] }).to_vec()
        };
        decayed: |r| vec![r.or(&[0.0, -40.0, -60.0, 80.0], |r| r.between(-60.0, 100.0))]
            => |x| vec![(-x[0]).min(57.0).exp()];
        falling_column_m: |r| vec![
            r.or(&[0.0, 1e-3], |r| r.decades(1e-7, 0.2)),
            r.decades(1e-13, 1e-5),
            r.or(&[1e12], |r| r.decades(1e-2, 1e5)),
        ] => |x| vec![falling(x[0], x[1], x[2])];
        flat_exponential_column_m: |r| vec![
            r.height_m(), r.sine(), r.length_m(), r.edge_m(), r.scale_m(),
        ] => |x| column(exponential(x[3], x[4]), &[x[0], x[1], 0.0, x[2]]);
        flat_clamped_column_m: |r| vec![
            r.height_m(), r.sine(), r.length_m(), r.edge_m(), r.scale_m(),
        ] => |x| column(clamped(x[3], x[4]), &[x[0], x[1], 0.0, x[2]]);
        exponential_column_m: |r| ray_and(r, [Random::edge_m, Random::scale_m])
            => |x| column(exponential(x[4], x[5]), x);
        clamped_column_m: |r| ray_and(r, [Random::edge_m, Random::scale_m])
            => |x| column(clamped(x[4], x[5]), x);
        layer_column_m: |r| {
            let thickness = r.between(1.0, 500.0);
            let mut all = near_the_dip(r, thickness);
            all.push(all[4] + thickness);
            all
        } => |x| column(DensityProfile::Layer { bottom_m: x[4], top_m: x[5] }, x);
        exponential_column_above_m: |r| vec![r.height_m(), r.edge_m(), r.scale_m()]
            => |x| vec![exponential(x[1], x[2]).column_above_m(x[0])];
        clamped_column_above_m: |r| vec![r.height_m(), r.edge_m(), r.scale_m()]
            => |x| vec![clamped(x[1], x[2]).column_above_m(x[0])];
    })
}
