//! The sky article's shader.

use super::{Row, rows};
use crate::flat::flat_struct;
use crate::random::Random;
use airlight::glam::DVec3;
use airlight::models::single_scattering::{Settings, SkyArticle, Sunlight, Variant};
use airlight_shaders::twins;
use std::f64::consts::PI;

flat_struct! {
    twins::article::ArticleSky { eye, sun_radius_rad, outer_space, sun_solid_angle }
}

const PLANET_M: f64 = 6360e3;
const TOP_M: f64 = 6420e3;
const STEPS: i32 = 8;

/// A position in the air.
fn position(r: &mut Random) -> Vec<f32> {
    let radius = PLANET_M as f32 + r.or(&[1.0, 6e4], |r| r.decades(1.0, 6e4));
    r.direction().map(|x| x * radius).to_vec()
}

/// A direction above the horizon.
fn above(r: &mut Random) -> Vec<f32> {
    let mut direction = r.direction().to_vec();
    direction[1] = direction[1].abs();
    direction
}

/// A direction to the sun, at most some degrees below the horizon.
fn sun(r: &mut Random) -> Vec<f32> {
    let mut sun = r.direction().to_vec();
    while sun[1] < -0.06 {
        sun = r.direction().to_vec();
    }
    sun
}

fn altitude(r: &mut Random) -> f32 {
    r.or(&[1.0], |r| r.decades(1.0, 5e4))
}

/// An eye and the disc's luminance.
fn sky(r: &mut Random) -> Vec<f32> {
    exact_sky(f64::from(altitude(r)), 120_000.0)
        .iter()
        .map(|&x| x as f32)
        .collect()
}

fn vector(x: &[f64]) -> DVec3 {
    DVec3::new(x[0], x[1], x[2])
}

const RAYLEIGH: [f64; 3] = [5.8e-6, 13.5e-6, 33.1e-6];
const MIE: f64 = 21e-6;
const OZONE: [f64; 3] = [3.426 * 0.06e-5, 8.298 * 0.06e-5, 0.356 * 0.06e-5];

fn density(position: DVec3, scale_m: f64) -> f64 {
    (-(position.length() - PLANET_M) / scale_m).exp()
}

fn extinction(position: DVec3) -> [f64; 3] {
    let (air, haze) = (density(position, 8000.0), density(position, 1200.0));
    [0, 1, 2].map(|c| (RAYLEIGH[c] + OZONE[c]) * air + 1.11 * MIE * haze)
}

fn transmittance(from: DVec3, to: DVec3) -> [f64; 3] {
    let step = (to - from) / f64::from(STEPS);
    let mut sum = [0.0; 3];
    for i in 0..STEPS {
        let here = extinction(from + (f64::from(i) + 0.5) * step);
        sum = [0, 1, 2].map(|c| sum[c] + here[c] * step.length());
    }
    sum.map(|depth| (-depth).exp())
}

fn distance(origin: DVec3, direction: DVec3, radius_m: f64) -> f64 {
    let b = origin.dot(direction);
    -b + (b * b - origin.length_squared() + radius_m * radius_m).sqrt()
}

fn rayleigh_phase(mu: f64) -> f64 {
    3.0 / (16.0 * PI) * (1.0 + mu * mu)
}

fn mie_phase(mu: f64) -> f64 {
    (1.0 - 0.76 * 0.76) / (4.0 * PI * (1.0 + 0.76 * 0.76 - 1.52 * mu).powf(1.5))
}

fn exact_sky(altitude_m: f64, illuminance: f64) -> Vec<f64> {
    let column = |scale: f64| scale * ((-altitude_m / scale).exp() - (-6e4 / scale).exp());
    let (air, haze) = (column(8000.0), column(1200.0));
    let radius = (0.53f64 / 2.0).to_radians();
    let solid_angle = 2.0 * PI * (1.0 - radius.cos());
    let outer =
        |c: usize| illuminance / solid_angle * ((RAYLEIGH[c] + OZONE[c]) * air + MIE * haze).exp();
    vec![
        0.0,
        PLANET_M + altitude_m,
        0.0,
        radius,
        outer(0),
        outer(1),
        outer(2),
        solid_angle,
    ]
}

fn source(x: &[f64]) -> Vec<f64> {
    let (here, view, sun) = (vector(&x[8..]), vector(&x[11..]), vector(&x[14..]));
    let to_sun = transmittance(here, here + sun * distance(here, sun, TOP_M));
    let mu = view.dot(sun);
    let haze = MIE * density(here, 1200.0) * mie_phase(mu);
    let air = density(here, 8000.0) * rayleigh_phase(mu);
    (0..3)
        .map(|c| x[4 + c] * x[7] * to_sun[c] * (RAYLEIGH[c] * air + haze))
        .collect()
}

/// The library's model in f64, for the luminance of the disc in the sky.
fn luminance(x: &[f64]) -> Vec<f64> {
    let settings = Settings {
        variant: Variant::PrintedF64,
        sunlight: Sunlight::WhiteAtZenith(120_000.0),
        eye_altitude_m: x[1] - PLANET_M,
    };
    let model = SkyArticle::new(&settings, vector(&x[11..])).expect("a sky");
    model.luminance(vector(&x[8..])).to_vec()
}

fn disc(x: &[f64]) -> Vec<f64> {
    let (eye, view, sun) = (vector(x), vector(&x[8..]), vector(&x[11..]));
    let angle = view.dot(sun).min(1.0).acos();
    let t = ((angle / x[3] - 0.95) / 0.1).clamp(0.0, 1.0);
    let part = 1.0 - t * t * (3.0 - 2.0 * t);
    let through = transmittance(eye, eye + view * distance(eye, view, TOP_M));
    (0..3).map(|c| x[4 + c] * part * through[c]).collect()
}

pub fn article() -> Vec<Row> {
    rows!(twins::article {
        article_sigma_rayleigh: position
            => |x| RAYLEIGH.map(|s| s * density(vector(x), 8000.0)).to_vec();
        article_sigma_mie: position => |x| vec![MIE * density(vector(x), 1200.0); 3];
        article_sigma_ozone: position
            => |x| OZONE.map(|s| s * density(vector(x), 8000.0)).to_vec();
        article_sigma_t: position => |x| extinction(vector(x)).to_vec();
        article_transmittance: |r| [position(r), position(r)].concat()
            => |x| transmittance(vector(x), vector(&x[3..])).to_vec();
        article_distance_m: |r| {
            let mut all = position(r);
            all.extend(r.direction());
            all.push(6.421e6);
            all
        } => |x| vec![distance(vector(x), vector(&x[3..]), x[6])];
        article_rayleigh_phase: |r| vec![1.0 - r.one_minus_cos()] => |x| vec![rayleigh_phase(x[0])];
        article_mie_phase: |r| vec![1.0 - r.one_minus_cos()] => |x| vec![mie_phase(x[0])];
        article_sky: |r| vec![altitude(r), r.or(&[120_000.0], |r| r.decades(1.0, 1e5))]
            => |x| exact_sky(x[0], x[1]);
        article_source: |r| {
            let mut all = sky(r);
            let altitude = altitude(r);
            all.extend([0.0, PLANET_M as f32 + altitude, 0.0]);
            all.extend([above(r), sun(r)].concat());
            all
        } => source;
        article_luminance: |r| [sky(r), above(r), sun(r)].concat() => luminance;
        article_disc: |r| loop {
            let view = above(r);
            let offset = r.one_of(&[0.0, 0.001, 0.003, 0.006, 0.5]);
            let beside = glam::Vec3::from_slice(&view) + glam::Vec3::from(r.direction()) * offset;
            let sun = beside.normalize().to_array();
            // On the disc and beside it, not at its edge, as the angle has two digits in f32.
            let apart = vector(&[0, 1, 2].map(|k| f64::from(view[k]) - f64::from(sun[k]))).length();
            if (apart / 4.625e-3 - 1.0).abs() > 0.1 {
                return [sky(r), view, sun.to_vec()].concat();
            }
        } => disc;
    })
}
