use super::super::airlight_integral::airlight_isotropic;
use super::super::reference::passages;
use super::*;

const EVERY_DISTANCE: [f64; 9] = [1e-6, 1e-3, 0.1, 1.0, 8.0, 250.0, 3e4, 1e6, 1e7];

/// The worst error of the fast form where the optical depth to the lamp is `depth`; lanes and f64.
fn worst(count: usize, depth: f64) -> (f64, f64) {
    let nodes = Nodes::new(count);
    let (mut worst64, mut worst32) = (0.0f64, 0.0f64);
    for geometry in passages(&EVERY_DISTANCE) {
        // The lane's own number, so that the two forms are asked the same.
        let lane = (depth / geometry.distance_m(0.0)) as f32;
        let extinction = f64::from(lane);
        let exact = airlight_isotropic(&geometry, extinction);
        let got = airlight_isotropic_lanes(&geometry, extinction, &nodes);
        worst64 = worst64.max((got / exact - 1.0).abs());
        let lanes = airlight_isotropic_lanes(&geometry, Spectrum([0.0, lane, 0.0]), &nodes);
        if exact > 1e-34 {
            worst32 = worst32.max((f64::from(lanes[1]) / exact - 1.0).abs());
        }
    }
    (worst64, worst32)
}

/// Prints the book's table with `--nocapture`.
#[test]
fn the_fast_form_is_as_good_as_it_says() {
    println!("\n| nodes | f64 | f32 |\n|---|---|---|");
    for (count, limit) in [
        (8, 1.25e-4),
        (10, 2e-5),
        (12, 5e-6),
        (16, 1.1e-6),
        (20, 3.5e-7),
    ] {
        let mut all = (0.0f64, 0.0f64);
        for depth in [
            1e-6, 1e-4, 1e-3, 0.01, 0.03, 0.1, 0.3, 1.0, 2.0, 4.0, 8.0, 16.0, 32.0, 80.0, 300.0,
            600.0,
        ] {
            let (in64, in32) = worst(count, depth);
            all = (all.0.max(in64), all.1.max(in32));
        }
        let bold = if count == 12 { "**" } else { "" };
        println!("| {bold}{count}{bold} | {:.1e} | {:.1e} |", all.0, all.1);
        assert!(all.0 < limit, "{count}: {all:?}");
        assert!(all.1 < limit + 2e-6 + 1e-7 * 80.0, "{count}: {all:?}");
    }
}
