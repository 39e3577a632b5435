//! Prints the tables of the book's chapter on the fog of 1987.
//!
//! `cargo run --release -p airlight --example klassen1987_fog -- flat|depth|solved|ambient|speed`

use airlight::atmosphere::{Constituent, ConstituentKind};
use airlight::axes;
use airlight::fog::droplets::Droplets;
use airlight::fog::visibility::{Contrast, extinction_per_m};
use airlight::fog::{
    DensityProfile, DirectionalLight, FogLighting, FogScattering, Ground, RgbFog, RgbLayer,
};
use airlight::models::klassen1987::{RgbSlab1987, SunDepth};
use airlight::optics::{Depolarization, PhaseFunction};
use airlight::spectrum::{RgbSpace, SpectralCurve};
use std::f64::consts::PI;
use std::time::Instant;

/// Height of the fog, m.
const TOP_M: f64 = 25.0;
/// Elevation of the sun, degrees.
const SUN_DEG: f64 = 35.0;
/// Length of the view rays, m.
const LINE_M: f64 = 100.0;
/// Elevation of the rays compared with the solver, degrees: for horizontal rays in thin fog the solver is up to 31 % too bright.
const UP_DEG: f64 = 10.0;
/// Irradiance on a horizontal surface from the sky, relative to that facing the sun: about that of the model at 35 degrees.
const SKY_OVER_SUN: f32 = 0.15;
const VISIBILITIES_M: [f64; 4] = [1000.0, 300.0, 150.0, 90.0];

fn main() {
    match std::env::args().nth(1).as_deref() {
        Some("flat") => flat(),
        Some("depth") => depth(),
        Some("solved") => solved(),
        Some("ambient") => ambient(),
        Some("speed") => speed(),
        other => {
            eprintln!(
                "expected the name of a table: flat, depth, solved, ambient or speed; got {other:?}"
            );
            std::process::exit(2);
        }
    }
}

/// Path lengths through air and fog with flat ground (eqs. 37, 38) compared with spheres (eqs. 20, 21), and the effect on light.
fn flat() {
    const EARTH_M: f64 = 6.371e6;
    const AIR_M: f64 = 8.4e3;
    const FOG_M: f64 = 50.0;
    let sphere = |height_m: f64, base_m: f64, sin: f64| {
        let (outer, inner) = (EARTH_M + height_m, EARTH_M + base_m);
        let cos2 = 1.0 - sin * sin;
        let root = (outer * outer - inner * inner * cos2).sqrt();
        (height_m - base_m) * (outer + inner) / (root + inner * sin)
    };
    println!("| sun | air, d₁ | light at 440 nm after it | fog of 50 m, d₂ |");
    println!("|---|---|---|---|");
    for deg in [60.0, 30.0, 20.0, 15.0, 10.0, 5.0, 2.0, 1.0, 0.5] {
        let sin = f64::to_radians(deg).sin();
        let air = ((AIR_M - FOG_M) / sin, sphere(AIR_M, FOG_M, sin));
        let fog = (FOG_M / sin, sphere(FOG_M, 0.0, sin));
        // Molecules at the ground, 440 nm.
        let light = (-3.0e-5 * (air.0 - air.1)).exp_m1();
        let percent = |(flat, round): (f64, f64)| 100.0 * (flat / round - 1.0);
        println!(
            "| {deg}° | {} | {} | {} |",
            signed(percent(air)),
            signed(100.0 * light),
            signed(percent(fog))
        );
    }
}

/// The sun's depth as printed compared with the exact one.
fn depth() {
    println!("| visibility | eye at 2 m | 10 m | 20 m | from 60 m, 20° down |");
    println!("|---|---|---|---|---|");
    for visibility_m in VISIBILITIES_M {
        let slab = slab(visibility_m);
        let cells = [(2.0, 0.0), (10.0, 0.0), (20.0, 0.0), (60.0, -20.0)].map(|(eye_m, deg)| {
            let climb = f64::to_radians(deg).sin();
            let length_m = match climb < 0.0 {
                true => eye_m / -climb,
                false => LINE_M,
            };
            let of = |depth| slab.along(eye_m, climb, length_m, 0.5, depth).path_radiance[0];
            let ratio = of(SunDepth::Printed) / of(SunDepth::Exact);
            signed(100.0 * (f64::from(ratio) - 1.0))
        });
        println!("| {visibility_m} m | {} |", cells.join(" | "));
    }
}

/// The fog component of 1987 compared with multiple scattering.
fn solved() {
    println!(
        "| visibility | optical depth of the fog | towards the sun | 60° aside | away from it |"
    );
    println!("|---|---|---|---|---|");
    for visibility_m in VISIBILITIES_M {
        let slab = slab(visibility_m);
        let fog = fog(visibility_m);
        let cells = [0.0, 60.0, 180.0].map(|azimuth_deg| {
            let direction = axes::direction(azimuth_deg, UP_DEG);
            let cos_sun = direction.dot(sun());
            let of_1987 = slab.along(2.0, direction.y, LINE_M, cos_sun, SunDepth::Exact);
            let all = fog.path(2.0, direction, LINE_M);
            let ratio = of_1987.path_radiance[0] / all.path_radiance[0];
            signed(100.0 * (f64::from(ratio) - 1.0))
        });
        println!(
            "| {visibility_m} m | {:.2} | {} |",
            extinction(visibility_m) * TOP_M,
            cells.join(" | ")
        );
    }
}

/// Light represented by the term A: the fraction of the irradiance on the ground that was scattered in the fog, and the
/// irradiance relative to that without fog.
fn ambient() {
    println!(
        "| visibility | light of sun and sky on the ground over that without fog | of it not straight from the sun |"
    );
    println!("|---|---|---|");
    for visibility_m in VISIBILITIES_M {
        let fog = fog(visibility_m);
        let slab = slab(visibility_m);
        let without = sun().y as f32 + SKY_OVER_SUN;
        let with = fog.ground_irradiance().map_or(f32::NAN, |e| e[0]);
        let straight = slab.irradiance_at(0.0)[0] * sun().y as f32;
        println!(
            "| {visibility_m} m | {:.0} % | {:.0} % |",
            100.0 * with / without,
            100.0 * (1.0 - straight / with)
        );
    }
}

/// Time of a view ray.
fn speed() {
    let (slab, fog) = (slab(150.0), fog(150.0));
    const LINES: u32 = 400_000;
    let time = |line: &dyn Fn(f64) -> f32| {
        let start = Instant::now();
        let sum: f32 = (0..LINES)
            .map(|i| line(f64::from(i) / f64::from(LINES) - 0.5))
            .sum();
        assert!(sum.is_finite());
        start.elapsed().as_secs_f64() / f64::from(LINES)
    };
    let of_1987 = time(&|climb| {
        let optics = slab.along(2.0, climb, LINE_M, 0.3, SunDepth::Exact);
        optics.path_radiance[0]
    });
    let solved = time(&|climb| {
        let level = (1.0 - climb * climb).sqrt();
        let direction = glam::DVec3::new(0.0, climb, -level);
        fog.path(2.0, direction, LINE_M).path_radiance[0]
    });
    println!("| view ray | time |");
    println!("|---|---|");
    println!("| fog of 1987 | 1.0 |");
    println!("| multiple scattering | {:.1} |", solved / of_1987);
}

fn sun() -> glam::DVec3 {
    axes::direction(0.0, SUN_DEG)
}

fn extinction(visibility_m: f64) -> f64 {
    extinction_per_m(visibility_m, Contrast::FivePercent)
}

/// The fog of 1987 in green light, with solar irradiance 1 at its top.
fn slab(visibility_m: f64) -> RgbSlab1987 {
    let air = Constituent {
        kind: ConstituentKind::Molecules,
        density: DensityProfile::Uniform,
        scattering_per_m: SpectralCurve::Constant(1.2e-5),
        absorption_per_m: SpectralCurve::Constant(0.0),
        phase: PhaseFunction::Rayleigh(Depolarization::None),
    };
    let parts = [&layer(visibility_m), &air];
    let (heights, sin_sun) = ([TOP_M, TOP_M], sun().y);
    RgbSlab1987::new(parts, heights, [1.0; 3], sin_sun, &[550.0; 3])
}

/// Fog of drops of 10 micrometres.
fn layer(visibility_m: f64) -> Constituent {
    let (drops, slab) = (Droplets::Radiation.into(), DensityProfile::slab(TOP_M));
    Constituent::fog(extinction(visibility_m), drops, slab, &[]).expect("a fog of grey drops")
}

/// The same fog with multiple scattering and light from the sky.
fn fog(visibility_m: f64) -> RgbFog {
    let layer = RgbLayer::from_constituent(&layer(visibility_m), RgbSpace::Srgb);
    let layers = [layer.expect("a fog of grey drops")];
    let light = FogLighting {
        sun: Some(DirectionalLight {
            direction: sun(),
            irradiance: [1.0; 3],
        }),
        ambient: [SKY_OVER_SUN / PI as f32; 3],
        ground_albedo: [0.2; 3],
    };
    RgbFog::new(&layers, Ground::FLAT, &light, FogScattering::Multiple)
        .expect("a fog of ordinary numbers")
}

/// Formats a signed percentage with about two digits.
fn signed(percent: f64) -> String {
    let digits = match percent.abs() {
        p if p < 0.095 => 2,
        p if p < 9.95 => 1,
        _ => 0,
    };
    format!("{percent:+.digits$} %")
}
