//! Prints the tables of the book's chapter on the fog note (`scripts/book`).
//!
//! `cargo run --release -p airlight --example fog_note`; with the argument `light`, `base` or `speed` only that one.

mod common;

use airlight::atmosphere::visibility::{Contrast, extinction_per_m};
use airlight::fog::lights::{LightForm, LightRayGeometry, Nodes, airlight_isotropic_fast};
use airlight::fog::{DensityProfile, RaySegment};
use common::Table;
use std::error::Error;
use std::f64::consts::PI;
use std::hint::black_box;
use std::time::Instant;

const TABLES: [Table; 3] = [("light", light_forms), ("base", base), ("speed", speed)];

fn main() -> Result<(), Box<dyn Error>> {
    common::print(&TABLES)
}

/// Airlight of a light by each form relative to the exact one: b = -5, c = 26, d = 20, and the same with the light 5 m beyond
/// the end of the ray.
fn light_forms() {
    println!(
        "| light | extinction, 1/m | printed | printed, in the right unit | no extinction | split sum |\n|---|---|---|---|---|---|"
    );
    for (light, start_m) in [
        ("5 m ahead, passed", -5.0),
        ("25 m ahead, not reached", -25.0),
    ] {
        let passage = LightRayGeometry {
            nearest_m: 1.0,
            start_m,
            length_m: 20.0,
        };
        for extinction in [
            0.003,
            extinction_per_m(100.0, Contrast::FivePercent),
            0.1,
            0.27,
        ] {
            let exact = LightForm::Exact.airlight(&passage, extinction);
            let ratio = |form: LightForm| form.airlight(&passage, extinction) / exact;
            let printed = ratio(LightForm::Printed);
            println!(
                "| {light} | {} | {} | {} | {} | {} |",
                (extinction * 1e3).round() / 1e3,
                figures(printed),
                figures(printed / (4.0 * PI * PI)),
                figures(ratio(LightForm::NoExtinction)),
                figures(ratio(LightForm::SplitSum))
            );
        }
    }
}

/// Optical depth of the note's height fog by its formula, relative to that of the fog that it defines.
fn base() {
    const BASE_M: f64 = 20.0;
    const SCALE_M: f64 = 30.0;
    let printed = DensityProfile::Exponential {
        reference_height_m: BASE_M,
        scale_height_m: SCALE_M,
    };
    let clamped = DensityProfile::Clamped {
        base_height_m: BASE_M,
        scale_height_m: SCALE_M,
    };
    println!(
        "| from | to | length | formula over definition | cut at the base, error |\n|---|---|---|---|---|"
    );
    for (from_m, to_m, length_m) in [
        (60.0, 25.0, 100.0),
        (60.0, 0.0, 100.0),
        (2.0, 60.0, 200.0),
        (2.0, 2.0, 150.0),
        (10.0, -40.0, 300.0),
    ] {
        let line = RaySegment::flat(from_m, (to_m - from_m) / length_m, length_m);
        let definition = integral(&line, BASE_M, |height_m| {
            (-(height_m - BASE_M).max(0.0) / SCALE_M).exp()
        });
        let error = (clamped.column_along_m(&line) / definition - 1.0).abs();
        println!(
            "| {from_m} m | {to_m} m | {length_m} m | {:.2} | {} |",
            printed.column_along_m(&line) / definition,
            match error < 1e-12 {
                true => "< 1e-12".to_owned(),
                false => format!("{error:.0e}"),
            }
        );
    }
}

/// `int density ds` along a ray by Simpson's rule, split at the base.
fn integral(line: &RaySegment, base_m: f64, density: impl Fn(f64) -> f64) -> f64 {
    const STEPS: u32 = 2000;
    let (first, last) = line.below(base_m);
    [(0.0, first), (first, last), (last, line.length_m)]
        .into_iter()
        .filter(|(from, to)| to > from)
        .map(|(from, to)| {
            let step = (to - from) / f64::from(STEPS);
            let at = |k: u32| density(line.height_at(from + step * f64::from(k)));
            let inner: f64 = (1..STEPS).map(|k| f64::from(2 + 2 * (k % 2)) * at(k)).sum();
            step / 3.0 * (at(0) + inner + at(STEPS))
        })
        .sum()
}

/// Time of a ray past a light, relative to the printed form.
fn speed() {
    const LINES: u32 = 50_000;
    let time = |form: &dyn Fn(&LightRayGeometry) -> f64| {
        let once = || {
            let start = Instant::now();
            let sum: f64 = (0..LINES)
                .map(|k| {
                    let part = f64::from(k) / f64::from(LINES);
                    form(&LightRayGeometry {
                        nearest_m: 0.1 + 4.0 * part,
                        start_m: -20.0 + 25.0 * (7.0 * part).fract(),
                        length_m: 20.0 + 40.0 * part,
                    })
                })
                .sum();
            black_box(sum);
            start.elapsed().as_secs_f64()
        };
        let mut times: Vec<f64> = (0..9).map(|_| once()).collect();
        times.sort_by(f64::total_cmp);
        times[4]
    };
    let of = |form: LightForm| time(&|passage| form.airlight(passage, black_box(0.03)));
    let printed = of(LightForm::Printed);
    let nodes = Nodes::new(12);
    println!("| form | time |\n|---|---|");
    for (name, seconds) in [
        ("printed", printed),
        ("no extinction", of(LightForm::NoExtinction)),
        ("split sum", of(LightForm::SplitSum)),
        (
            "exact, by 12 nodes",
            time(&|passage| airlight_isotropic_fast(passage, black_box(0.03), &nodes)),
        ),
        ("exact, closed form", of(LightForm::Exact)),
    ] {
        println!("| {name} | {:.1} |", seconds / printed);
    }
}

/// Formats a ratio with three significant digits.
fn figures(ratio: f64) -> String {
    match ratio.abs() {
        r if r >= 99.95 => format!("{ratio:.0}"),
        r if r >= 9.995 => format!("{ratio:.1}"),
        _ => format!("{ratio:.2}"),
    }
}
