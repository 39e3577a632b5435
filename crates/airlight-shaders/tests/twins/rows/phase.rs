//! Phase functions.

use super::{Row, rows};
use crate::flat::flat_struct;
use crate::random::Random;
use airlight::fog::droplets;
use airlight::optics::PhaseFunction;
use airlight_shaders::twins;
use std::f64::consts::PI;

flat_struct! {
    twins::phase::DropletPhase { peak_one_minus_g, wide_g, wide_alpha, wide_weight }
}

/// A mean cosine.
fn g(r: &mut Random) -> f32 {
    r.or(&[0.0, 0.76, 0.99, -0.99, 0.9999], |r| {
        r.between(-0.999, 0.999)
    })
}

/// Henyey-Greenstein from 1 minus the cosine and 1 minus `g`, which the library rounds.
fn peak(one_minus_cos: f64, one_minus_g: f64) -> f64 {
    let d = one_minus_g * one_minus_g + 2.0 * (1.0 - one_minus_g) * one_minus_cos;
    one_minus_g * (2.0 - one_minus_g) / (4.0 * PI * d.powf(1.5))
}

fn value(phase: &PhaseFunction, one_minus_cos: f64) -> Vec<f64> {
    vec![phase.evaluate(1.0 - one_minus_cos, 550.0)]
}

fn droplet_parameters(diameter_um: f64) -> Vec<f64> {
    let PhaseFunction::Mixture(parts) = droplets::phase(diameter_um) else {
        panic!("a mixture");
    };
    let (PhaseFunction::HenyeyGreenstein { g: peak }, PhaseFunction::Draine { g: wide, alpha }) =
        (&parts[0].1, &parts[1].1)
    else {
        panic!("a peak and a Draine function");
    };
    vec![1.0 - peak, *wide, *alpha, parts[1].0]
}

pub fn phase() -> Vec<Row> {
    rows!(twins::phase {
        one_minus_cos_between: |r| {
            let a = r.direction();
            let b = match r.unit() < 0.5 {
                true => r.direction(),
                false => a.map(|x| x + r.between(-1e-3, 1e-3)),
            };
            let length = b.iter().map(|x| x * x).sum::<f32>().sqrt();
            [a, b.map(|x| x / length)].concat()
        } => |x| {
            let dot: f64 = (0..3).map(|k| (x[k] - x[k + 3]).powi(2)).sum();
            vec![0.5 * dot]
        };
        isotropic_phase: |_| vec![] => |_| vec![0.25 / PI];
        rayleigh_phase: |r| vec![r.one_minus_cos(), r.or(&[0.0, 0.0279, 0.85], |r| r.between(0.0, 0.5))]
            => |x| value(&PhaseFunction::rayleigh(x[1]).unwrap(), x[0]);
        henyey_greenstein_peak: |r| vec![r.one_minus_cos(), r.decades(1e-6, 1.0)]
            => |x| vec![peak(x[0], x[1])];
        henyey_greenstein: |r| vec![r.one_minus_cos(), g(r)]
            => |x| value(&PhaseFunction::henyey_greenstein(x[1]).unwrap(), x[0]);
        draine: |r| vec![r.one_minus_cos(), g(r), r.or(&[0.0, 1.0], |r| r.between(0.0, 30.0))]
            => |x| value(&PhaseFunction::draine(x[1], x[2]).unwrap(), x[0]);
        cornette_shanks: |r| vec![r.one_minus_cos(), g(r)]
            => |x| value(&PhaseFunction::cornette_shanks(x[1]).unwrap(), x[0]);
        droplet_phase: |r| vec![r.or(&[1.0, 5.0, 50.0, 99.0], |r| r.between(4.0, 60.0))]
            => |x| droplet_parameters(x[0]);
        evaluate_droplet_phase: |r| {
            let diameter_um = r.between(5.0, 50.0);
            let mut all: Vec<f32> =
                droplet_parameters(f64::from(diameter_um)).iter().map(|&x| x as f32).collect();
            all.push(r.one_minus_cos());
            all
        } => |x| {
            let wide = PhaseFunction::draine(x[1], x[2]).unwrap();
            let rest = value(&wide, x[4])[0];
            vec![(1.0 - x[3]) * peak(x[4], x[0]) + x[3] * rest]
        };
    })
}
