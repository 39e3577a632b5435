//! Prints the tables of the book's chapter on height fog (Ishiyama 2018) (`scripts/book`).
//!
//! `cargo run --release -p airlight --example height_fog`; with the argument `level`, `closed` or `solved` only that one.

mod common;

use airlight::atmosphere::visibility::{Contrast, extinction_per_m};
use airlight::axes::direction;
use airlight::fog::{
    DensityProfile, DirectionalLight, FogLighting, FogScattering, Ground, RaySegment, RgbFog,
    RgbLayer, droplets::Droplets,
};
use airlight::optics::PhaseFunction;
use common::Table;
use std::error::Error;
use std::f64::consts::PI;

const TABLES: [Table; 3] = [
    ("level", level_lines),
    ("closed", closed_forms),
    ("solved", against_all_orders),
];

/// Scale height of all fogs, m; the eye is 2 m high unless stated otherwise.
const SCALE_M: f64 = 50.0;
const EYE_M: f64 = 2.0;

fn main() -> Result<(), Box<dyn Error>> {
    common::print(&TABLES)
}

/// Optical depth of (23) as printed, in f32: light travels from the background, at the distance `length_m`, to the eye.
fn printed_depth(extinction_per_m: f32, climb: f32, length_m: f32) -> f32 {
    let scale = SCALE_M as f32;
    let y0 = EYE_M as f32 + climb * length_m;
    let omega = -climb;
    scale / omega
        * extinction_per_m
        * (-y0 / scale).exp()
        * (1.0 - (-omega * length_m / scale).exp())
}

/// Errors of (23) as printed in f32, and of the profile's column.
fn level_lines() {
    println!("| ray | as printed, f32 | this crate |\n|---|---|---|");
    let profile = exponential();
    for (elevation, length_m) in [
        (10.0f64, 150.0),
        (1.0, 150.0),
        (0.1, 150.0),
        (0.01, 150.0),
        (0.001, 150.0),
        (0.0, 150.0),
        (60.0, 5000.0),
        (60.0, 5400.0),
        (60.0, 6500.0),
    ] {
        let climb = elevation.to_radians().sin();
        let line = RaySegment::flat(EYE_M, climb, length_m);
        let right = integral(length_m, |s| profile.at(line.height_at(s)));
        let here = profile.column_along_m(&line);
        let printed = printed_depth(1.0, climb as f32, length_m as f32);
        println!(
            "| {elevation}° up, {length_m} m | {} | {} |",
            error(f64::from(printed), right),
            error(here, right)
        );
    }
}

/// Singly scattered sunlight per unit irradiance and phase function: a ray by the closed form of the errata, by the divided
/// difference, by `Fog` in f32, and by quadrature.
fn closed_forms() {
    println!(
        "| visibility | ray | closed form with C, f64 | divided difference, f64 | `Fog`, f32 |\n|---|---|---|---|---|"
    );
    let sine_sun = 15f64.to_radians().sin();
    for (visibility_m, eye_m, elevation, length_m) in [
        (300.0, EYE_M, 5.0f64, 150.0),
        (300.0, EYE_M, 1e-3, 150.0),
        (300.0, EYE_M, 0.0, 150.0),
        (300.0, EYE_M, 15.0, 150.0),
        (300.0, 40.0, -10.0, 230.0),
        (300.0, EYE_M, 60.0, 2000.0),
        (30.0, EYE_M, 5.0, 150.0),
        (30.0, EYE_M, 0.3, 150.0),
    ] {
        let extinction = extinction_of(visibility_m);
        let climb = elevation.to_radians().sin();
        let line = RaySegment::flat(eye_m, climb, length_m);
        let profile = exponential();
        let to_sun = |height_m: f64| extinction * profile.column_above_m(height_m) / sine_sun;
        let right = integral(length_m, |s| {
            let depth = extinction * profile.column_along_m(&line.part(0.0, s));
            let height = line.height_at(s);
            extinction * profile.at(height) * (-depth - to_sun(height)).exp()
        });

        // Ishiyama's notation, with C.
        let (y0, omega) = (line.end_height_m(), -climb);
        let a = omega / SCALE_M;
        let b = extinction * (-y0 / SCALE_M).exp();
        let c = extinction * SCALE_M * (-y0 / SCALE_M).exp() / sine_sun;
        let u = (-a * length_m).exp();
        let k = b / a + c;
        let with_c =
            extinction * (-y0 / SCALE_M).exp() * (b / a * u).exp() * ((-k * u).exp() - (-k).exp())
                / (a * k);

        let along = extinction * profile.column_along_m(&line);
        let divided = divided_difference(to_sun(eye_m), along * (1.0 - climb / sine_sun), along);

        let layer = grey_layer(extinction, PhaseFunction::Isotropic);
        let light = FogLighting {
            sun: Some(DirectionalLight {
                direction: direction(0.0, 15.0),
                irradiance: [4.0 * PI as f32; 3],
            }),
            ambient: [0.0; 3],
            ground_albedo: [0.0; 3],
        };
        let fog = RgbFog::new(&[layer], Ground::FLAT, &light, FogScattering::Single);
        let here = fog
            .expect("a fog")
            .path(eye_m, direction(120.0, elevation), length_m);
        println!(
            "| {visibility_m} m | from {eye_m} m, {}, {length_m} m | {} | {} | {} |",
            match elevation {
                0.0 => "level".to_owned(),
                15.0 => "15° up as the sun".to_owned(),
                e if e < 0.0 => format!("{}° down", -e),
                e => format!("{e}° up"),
            },
            error(with_c, right),
            error(divided, right),
            error(f64::from(here.path_radiance[0]), right)
        );
    }
}

/// Errors of the two single-scattering forms relative to multiple scattering, percent, for a ray of 150 m at an elevation of 20
/// degrees (the error of the solver itself is larger near the horizontal).
fn against_all_orders() {
    // Irradiance on a horizontal surface from the sky, relative to that on a surface facing the sun: from `airlight probe`, lux.
    const SKY_OVER_SUN: [(f64, f32); 4] = [
        (5.0, 4334.0 / 11312.0),
        (15.0, 9787.0 / 53377.0),
        (30.0, 13720.0 / 82380.0),
        (60.0, 16938.0 / 100771.0),
    ];
    println!("| visibility | looking | sun 5° | 15° | 30° | 60° |\n|---|---|---|---|---|---|");
    for visibility_m in [5000.0, 1000.0, 300.0, 100.0] {
        for (looking, azimuth) in [
            ("towards the sun", 0.0),
            ("60° aside", 60.0),
            ("away from it", 180.0),
        ] {
            let cells = SKY_OVER_SUN.map(|(elevation, sky)| {
                let of = |scattering| {
                    let fog = lit_fog(visibility_m, elevation, sky, scattering);
                    let line = fog.path(EYE_M, direction(azimuth, 20.0), 150.0);
                    f64::from(line.path_radiance[0])
                };
                let all = of(FogScattering::Multiple);
                let [undimmed, single] = [FogScattering::Undimmed, FogScattering::Single]
                    .map(|scattering| signed(100.0 * (of(scattering) / all - 1.0)));
                format!("{undimmed} / {single}")
            });
            println!("| {visibility_m} m | {looking} | {} |", cells.join(" | "));
        }
    }
}

fn exponential() -> DensityProfile {
    DensityProfile::exponential(SCALE_M)
}

/// Height fog of the same extinction (1/m) in all channels.
fn grey_layer(extinction_per_m: f64, phase: PhaseFunction) -> RgbLayer {
    RgbLayer {
        density: exponential(),
        extinction_per_m: [extinction_per_m as f32; 3],
        single_scattering_albedo: [1.0; 3],
        phase,
    }
}

/// Divided difference of `e^-x` times the optical depth `along`: sunlight scattered into a ray whose exponent grows from `near`
/// by `growth`.
fn divided_difference(near: f64, growth: f64, along: f64) -> f64 {
    let size = growth.abs();
    let mean = match size < 1e-8 {
        true => 1.0 - 0.5 * size,
        false => -(-size).exp_m1() / size,
    };
    along * (-(near + growth.min(0.0))).exp() * mean
}

fn extinction_of(visibility_m: f64) -> f64 {
    extinction_per_m(visibility_m, Contrast::FivePercent)
}

/// Height fog of drops of 10 micrometres with the sun in the north, a uniform sky and ground of albedo 0.2.
fn lit_fog(
    visibility_m: f64,
    sun_deg: f64,
    sky_over_sun: f32,
    scattering: FogScattering,
) -> RgbFog {
    let layer = grey_layer(extinction_of(visibility_m), Droplets::Radiation.phase());
    let light = FogLighting {
        sun: Some(DirectionalLight {
            direction: direction(0.0, sun_deg),
            irradiance: [1.0; 3],
        }),
        ambient: [sky_over_sun / PI as f32; 3],
        ground_albedo: [0.2; 3],
    };
    RgbFog::new(&[layer], Ground::FLAT, &light, scattering).expect("a fog of ordinary numbers")
}

/// `int_0^length f ds`: five-point Gauss rule in segments that grow with the distance from the eye.
fn integral(length_m: f64, f: impl Fn(f64) -> f64) -> f64 {
    const RULE: [(f64, f64); 3] = [
        (0.0, 0.568_888_888_888_888_9),
        (0.538_469_310_105_683_1, 0.478_628_670_499_366_47),
        (0.906_179_845_938_664, 0.236_926_885_056_189_08),
    ];
    const SEGMENTS: u32 = 4000;
    let edges: Vec<f64> = (0..=SEGMENTS)
        .map(|k| length_m * (f64::from(k) / f64::from(SEGMENTS)).powi(2))
        .collect();
    edges
        .windows(2)
        .map(|edge| {
            let (middle, half) = (0.5 * (edge[0] + edge[1]), 0.5 * (edge[1] - edge[0]));
            let sides = RULE.iter().map(|&(x, w)| match x {
                0.0 => w * f(middle),
                _ => w * (f(middle - half * x) + f(middle + half * x)),
            });
            half * sides.sum::<f64>()
        })
        .sum()
}

/// Formats a relative error with one digit.
fn error(got: f64, right: f64) -> String {
    match (got / right - 1.0).abs() {
        e if e.is_nan() => "not a number".to_owned(),
        f64::INFINITY => "infinite".to_owned(),
        e if e < 1e-12 => "< 1e-12".to_owned(),
        e => format!("{e:.0e}"),
    }
}

/// Formats a signed percentage with about two digits.
fn signed(percent: f64) -> String {
    match percent.abs() {
        p if p < 9.95 => format!("{percent:+.1} %"),
        _ => format!("{percent:+.0} %"),
    }
}
