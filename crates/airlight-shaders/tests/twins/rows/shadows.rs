//! Fog with shadows.

use super::air::{exponential, phi};
use super::fog::{in_profile, light, medium, single};
use super::{Row, rows};
use crate::random::Random;
use airlight_shaders::twins;
use glam::Vec3;

/// Path optics of a march so far.
fn before(r: &mut Random) -> Vec<f32> {
    (0..6).map(|_| r.or(&[0.0, 1.0], Random::unit)).collect()
}

/// A step of a march: from and to, m.
fn step(r: &mut Random) -> [f32; 2] {
    let from = r.or(&[0.0], |r| r.decades(0.1, 1e4));
    [from, from + r.or(&[0.0, 1.0], |r| r.decades(0.1, 1e3))]
}

fn visibility(r: &mut Random) -> f32 {
    r.or(&[0.0, 1.0], Random::unit)
}

/// A segment behind what a march has passed.
fn behind(before: &[f64], far: &[f64]) -> Vec<f64> {
    let transmittance = (0..3).map(|c| before[c] * far[c]);
    let radiance = (0..3).map(|c| before[c + 3] + before[c] * far[c + 3]);
    transmittance.chain(radiance).collect()
}

fn lit(light: &[f64], visibility: f64) -> Vec<f64> {
    let mut all = light.to_vec();
    for value in &mut all[..3] {
        *value *= visibility;
    }
    all
}

pub fn shadows() -> Vec<Row> {
    rows!(twins::shadows {
        no_fog: |_| vec![] => |_| vec![1.0, 1.0, 1.0, 0.0, 0.0, 0.0];
        shadow_edge_m: |r| vec![
            r.or(&[0.0, 1.0, 0.5], Random::unit),
            r.decades(1.0, 1e5),
            r.or(&[0.0, 1e-4, 30.0], |r| r.decades(1e-6, 60.0)),
        ] => |x| {
            // Where the opacity is this part of the whole.
            let opacity = x[0] * phi(x[2]) * x[2];
            vec![match x[2] > 0.0 && x[0] < 1.0 {
                true => x[1] * (-(-opacity).ln_1p() / x[2]).min(1.0),
                false => x[0] * x[1],
            }]
        };
        lit_part: |r| {
            let clearance = |r: &mut Random| {
                let size = r.or(&[0.0, 1.0], |r| r.decades(1e-3, 1e4));
                r.one_of(&[1.0, -1.0]) * size
            };
            vec![clearance(r), clearance(r)]
        } => |x| {
            let (least, most) = (x[0].min(x[1]), x[0].max(x[1]));
            vec![match least >= 0.0 {
                true => 1.0,
                false => most.max(0.0) / (most.max(0.0) - least),
            }]
        };
        with_visibility: |r| {
            let mut all = light(r);
            all.push(visibility(r));
            all
        } => |x| lit(&x[..7], x[7]);
        shadowed_uniform_fog: |r| {
            let mut all = [before(r), medium(r), step(r).to_vec(), light(r)].concat();
            all.push(visibility(r));
            all
        } => |x| {
            let fog = single(&x[6..12], &lit(&x[14..21], x[21]), x[13] - x[12], None);
            behind(&x[..6], &fog)
        };
        shadowed_exponential_fog: |r| {
            let mut all = [before(r), medium(r)].concat();
            all.extend([r.height_m(), r.sine()]);
            all.extend(step(r));
            all.extend([r.edge_m(), r.scale_m()]);
            all.extend(light(r));
            all.push(visibility(r));
            all
        } => |x| {
            let mut part = x[6..12].to_vec();
            part.extend([x[12] + x[13] * x[14], x[13], x[15] - x[14], x[16], x[17]]);
            part.extend(lit(&x[18..25], x[25]));
            behind(&x[..6], &in_profile(&exponential(x[16], x[17]), &part, true))
        };
    })
}

/// A march in steps of even light, sampled in the middle of each, through a shadow from one distance to another: each edge of the
/// shadow misplaces at most a step's light, and without shadow there is no error.
#[test]
fn edges_of_shadows_cost_a_step_each() {
    use twins::fog::{FogLight, FogMedium, uniform_fog};
    use twins::shadows::{no_fog, shadow_edge_m, shadowed_uniform_fog, with_visibility};
    let mut random = Random::new(3);
    let light = FogLight {
        sunlight: Vec3::ONE,
        sin_sun: 0.5,
        ambient: Vec3::splat(0.25),
    };
    for _ in 0..500 {
        let extinction = random.decades(1e-4, 0.2);
        let medium = FogMedium {
            extinction_per_m: Vec3::splat(extinction),
            scattering_per_m: Vec3::splat(extinction),
        };
        let length_m = random.decades(10.0, 1e3);
        let mut shadow = [random.unit() * length_m, random.unit() * length_m];
        shadow.sort_by(f32::total_cmp);
        let steps = random.one_of(&[1.0, 4.0, 32.0, 64.0]);
        let march = |shadow: [f32; 2]| {
            let edge = |i: u32| shadow_edge_m(i as f32 / steps, length_m, extinction * length_m);
            (0..steps as u32).fold(no_fog(), |path, i| {
                let middle = 0.5 * (edge(i) + edge(i + 1));
                let visible = f32::from(middle < shadow[0] || middle > shadow[1]);
                shadowed_uniform_fog(path, medium, edge(i), edge(i + 1), light, visible)
            })
        };
        let unshadowed = uniform_fog(medium, length_m, light);
        let lit = march([2.0 * length_m; 2]);
        assert!((lit.path_radiance - unshadowed.path_radiance).abs().x < 4e-6);
        assert!((lit.transmittance - unshadowed.transmittance).abs().x < 4e-6);
        // The sunlight of the shadow's part of the ray is missing.
        let sun = with_visibility(
            FogLight {
                ambient: Vec3::ZERO,
                ..light
            },
            1.0,
        );
        let missing = (-extinction * shadow[0]).exp()
            * uniform_fog(medium, shadow[1] - shadow[0], sun)
                .path_radiance
                .x;
        let exact = unshadowed.path_radiance.x - missing;
        let whole = uniform_fog(medium, length_m, sun).path_radiance.x;
        let error = (march(shadow).path_radiance.x - exact).abs();
        assert!(
            error <= 2.0 * whole / steps + 1e-5,
            "{error} {whole} {steps}"
        );
    }
}
