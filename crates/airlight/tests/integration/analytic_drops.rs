//! The analytic phase function of fog (Jendersie & d'Eon 2023) beside Lorenz-Mie theory.
//!
//! Theory: water at 550 nm, radii in Hansen's gamma distribution of effective variance 0.1 whose effective diameter is the
//! function's diameter. (Which spread of sizes the function was fitted to it does not say.)

use airlight::fog::droplets;
use airlight::optics::PhaseFunction;
use airlight::optics::mie::{Particles, SizeDistribution};
use std::f64::consts::{PI, TAU};

const NM: f64 = 550.0;

/// The share of the light that the function sends to where theory sends less: half the integral of the difference; its share
/// beyond 20 degrees; the difference of the mean cosines; function over theory straight on, at 10, 90, 142 (the bow) and
/// 180 degrees.
fn compare(diameter_um: f64) -> ([f64; 2], f64, [f64; 5]) {
    let sizes = SizeDistribution::gamma(0.5 * diameter_um, 0.1);
    let (table, bulk) = Particles::water(sizes).unwrap().table(&[NM]).unwrap();
    let theory = PhaseFunction::Tabulated(table);
    let function = droplets::phase(diameter_um);
    let at = |phase: &PhaseFunction, degrees: f64| phase.evaluate(degrees.to_radians().cos(), NM);
    let (mut misplaced, mut wide, mut whole) = (0.0, 0.0, 0.0);
    // Steps that crowd towards 0 like the square of their number.
    const STEPS: u32 = 20_000;
    for i in 0..STEPS {
        let part = (f64::from(i) + 0.5) / f64::from(STEPS);
        let (angle, step) = (PI * part * part, TAU * part / f64::from(STEPS));
        let ring = TAU * angle.sin() * step;
        let (p, q) = (
            theory.evaluate(angle.cos(), NM),
            function.evaluate(angle.cos(), NM),
        );
        whole += ring * p;
        misplaced += 0.5 * ring * (p - q).abs();
        if angle.to_degrees() > 20.0 {
            wide += 0.5 * ring * (p - q).abs();
        }
    }
    assert!((whole - 1.0).abs() < 1e-5, "{whole}");
    let cosines = function.asymmetry(NM) - bulk[0].asymmetry;
    let ratios = [0.0, 10.0, 90.0, 142.0, 180.0].map(|a| at(&function, a) / at(&theory, a));
    ([misplaced, wide], cosines, ratios)
}

/// The table of the book's chapter on spheres: diameter (micrometres), misplaced light, of it beyond 20 degrees, mean cosine,
/// function over theory straight on, at 10, 90, 142 and 180 degrees.
const STATED: [(f64, [f64; 2], f64, [f64; 5]); 5] = [
    (5.0, [0.088, 0.018], 0.0207, [2.56, 1.04, 0.54, 0.63, 0.28]),
    (10.0, [0.117, 0.014], 0.0159, [3.87, 0.96, 0.52, 0.45, 0.25]),
    (20.0, [0.137, 0.015], 0.0163, [4.63, 1.04, 0.54, 0.30, 0.21]),
    (30.0, [0.148, 0.017], 0.0167, [4.90, 1.09, 0.55, 0.26, 0.19]),
    (50.0, [0.160, 0.019], 0.0170, [5.13, 1.16, 0.54, 0.32, 0.16]),
];

mod guards {
    use super::*;

    #[test]
    fn the_analytic_function_differs_from_theory_as_stated() {
        println!(
            "\n| diameter, µm | light sent elsewhere | of it beyond 20° | mean cosine | at 0° | 10° | 90° | bow, 142° | 180° |"
        );
        println!("|---|---|---|---|---|---|---|---|---|");
        for (diameter_um, stated, stated_cosines, stated_ratios) in STATED {
            let (misplaced, cosines, ratios) = compare(diameter_um);
            let [all, wide] = misplaced.map(|share| 100.0 * share);
            let [forward, aside @ ..] = ratios;
            println!(
                "| {diameter_um} | {all:.1} % | {wide:.1} % | {cosines:+.3} | {forward:.1} | {} |",
                aside.map(|ratio| format!("{ratio:.2}")).join(" | ")
            );
            for (got, stated) in misplaced.into_iter().zip(stated) {
                assert!((got - stated).abs() < 2e-3, "{diameter_um}: {got}");
            }
            assert!((cosines - stated_cosines).abs() < 5e-4, "{cosines}");
            for (got, stated) in ratios.into_iter().zip(stated_ratios) {
                assert!((got / stated - 1.0).abs() < 0.05, "{diameter_um}: {got}");
            }
        }
    }
}
