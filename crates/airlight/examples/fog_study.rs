//! Prints tables on the validity of fog approximations, for the book's chapters on fog and on lights (`scripts/book`).
//!
//! `cargo run --release -p airlight --example fog_study`; with the argument `split-sum`, `light`, `dimming` or `extinction` only
//! that one.

mod common;

use airlight::atmosphere::visibility::{Contrast, extinction_per_m, visibility_m};
use airlight::axes::direction;
use airlight::fog::lights::{LightRayGeometry, airlight_isotropic, airlight_without_extinction};
use airlight::fog::{
    DensityProfile, DirectionalLight, FogLighting, FogScattering, Ground, RgbFog, RgbLayer,
    droplets::Droplets, split_sum_error,
};
use common::Table;
use std::error::Error;

const TABLES: [Table; 4] = [
    ("split-sum", split_sum_map),
    ("light", light_beside_the_ray),
    ("dimming", sun_undimmed),
    ("extinction", light_without_extinction),
];

fn main() -> Result<(), Box<dyn Error>> {
    common::print(&TABLES)
}

/// Formats a number with two digits, or more if it has more before the decimal point; at most `most` after it.
fn short(v: f64, most: i32) -> String {
    let before = v.abs().max(1e-9).log10().floor() as i32;
    let text = format!("{v:.0$}", (1 - before).clamp(0, most) as usize);
    match text.trim_start_matches('-').parse() {
        Ok(0.0) => text.trim_start_matches('-').to_owned(),
        _ => text,
    }
}

/// Error of the split sum, percent, for sources that change as `e^-(k t)` with the optical depth t from the eye.
fn split_sum_map() {
    let rates = [-0.9, -0.5, -0.2, 0.2, 0.5, 1.0, 2.0, 5.0];
    println!("| τ \\ k | {} |", rates.map(|k| k.to_string()).join(" | "));
    println!("|---|---|---|---|---|---|---|---|---|");
    for tau in [0.1, 0.5, 1.0, 2.0, 4.0, 8.0] {
        let errors = rates.map(|k| short(100.0 * split_sum_error(tau, k), 1));
        println!("| {tau} | {} |", errors.join(" | "));
    }
}

/// Error of the split sum and of omitting extinction, for a light halfway along the view ray and h ray lengths to its side.
fn light_beside_the_ray() {
    println!("| τ | h | split sum | no extinction |\n|---|---|---|---|");
    for (tau, aside) in [
        (0.1, 0.1),
        (0.5, 0.1),
        (1.0, 0.01),
        (1.0, 0.1),
        (1.0, 0.5),
        (3.0, 0.1),
        (3.0, 0.5),
    ] {
        // A ray of length 1 with extinction tau; source e^-(tau r) / r^2 up to a constant.
        let source = |s: f64| {
            let r2 = (s - 0.5).powi(2) + aside * aside;
            (-tau * r2.sqrt()).exp() / r2
        };
        let exact = mean(aside, |s| source(s) * (-tau * s).exp());
        let split = mean(aside, source) * -f64::exp_m1(-tau) / tau;
        let none = mean(aside, |s| 1.0 / ((s - 0.5).powi(2) + aside * aside));
        println!(
            "| {tau} | {aside} | {} % | {:.0} % |",
            short(100.0 * (split / exact - 1.0), 1),
            100.0 * (none / exact - 1.0)
        );
    }
}

/// Overestimate of a light's airlight without extinction: 5 m ahead and 1 m beside a ray of 20 m.
fn light_without_extinction() {
    println!(
        "| extinction, 1/m | visibility (5 %) | without extinction it is too bright by |\n|---|---|---|"
    );
    let passage = LightRayGeometry {
        nearest_m: 1.0,
        start_m: -5.0,
        length_m: 20.0,
    };
    let five = Contrast::FivePercent;
    for extinction in [
        extinction_per_m(100.0, five),
        0.27,
        extinction_per_m(10.0, five),
    ] {
        let ratio =
            airlight_without_extinction(&passage) / airlight_isotropic(&passage, extinction);
        println!(
            "| {extinction:.2} | {:.0} m | {ratio:.2} |",
            visibility_m(extinction, five)
        );
    }
}

/// `int_0^1 f ds` with steps uniform in angle, and so dense near a light at 1/2, `aside` away.
fn mean(aside: f64, f: impl Fn(f64) -> f64) -> f64 {
    const STEPS: u32 = 20_000;
    let end = (0.5 / aside).atan();
    (0..STEPS)
        .map(|k| {
            let angle = end * (2.0 * (f64::from(k) + 0.5) / f64::from(STEPS) - 1.0);
            f(0.5 + aside * angle.tan()) * aside / angle.cos().powi(2)
        })
        .sum::<f64>()
        * 2.0
        * end
        / f64::from(STEPS)
}

/// Ishiyama's model as printed relative to the same model with attenuation of sunlight in the fog: ratio of the path
/// radiances. Height fog with a scale height of 50 m, the given visibility at the ground, a horizontal ray of 150 m away from
/// the sun, the eye at 2 m.
fn sun_undimmed() {
    println!("| visibility | sun 5° | 15° | 30° | 60° | 90° |\n|---|---|---|---|---|---|");
    let suns = [5.0, 15.0, 30.0, 60.0, 90.0];
    for visibility in [5000.0, 1000.0, 300.0, 100.0] {
        print!("| {visibility} m |");
        for elevation in suns {
            let path = |scattering| {
                let layer = RgbLayer {
                    density: DensityProfile::exponential(50.0),
                    extinction_per_m: [(3.0 / visibility) as f32; 3],
                    single_scattering_albedo: [1.0; 3],
                    phase: Droplets::Radiation.phase(),
                };
                let light = FogLighting {
                    sun: Some(DirectionalLight {
                        direction: direction(0.0, elevation),
                        irradiance: [1.0; 3],
                    }),
                    ambient: [0.0; 3],
                    ground_albedo: [0.0; 3],
                };
                let fog = RgbFog::new(&[layer], Ground::FLAT, &light, scattering).expect("a fog");
                fog.path(2.0, direction(180.0, 0.0), 150.0).path_radiance[0]
            };
            let ratio = path(FogScattering::Undimmed) / path(FogScattering::Single);
            let text = match ratio {
                1e3.. => "> 1000".to_owned(),
                1e2.. => format!("{ratio:.0}"),
                1e1.. => format!("{ratio:.1}"),
                _ => format!("{ratio:.2}"),
            };
            print!(" {text} |");
        }
        println!();
    }
}
