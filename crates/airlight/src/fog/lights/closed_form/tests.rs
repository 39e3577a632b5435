use super::super::reference::{geometries, isotropic_beyond};
use super::*;

const NEAREST: [f64; 8] = [1e-6, 1e-3, 0.1, 1.0, 8.0, 250.0, 3e4, 1e7];

#[test]
fn the_form_without_extinction_matches_quadrature() {
    for geometry in geometries(&NEAREST) {
        let want = isotropic_beyond(&geometry, 0.0);
        let got = airlight_without_extinction(&geometry);
        assert!(
            (got / want - 1.0).abs() < 1e-12,
            "{geometry:?}: {got} against {want}"
        );
    }
}

#[test]
fn the_exact_form_matches_quadrature() {
    for geometry in geometries(&NEAREST) {
        for extinction in [1e-9, 1e-6, 1e-4, 1e-2, 0.3, 3.0, 1e2] {
            let depth = extinction * geometry.distance_m(0.0);
            if depth > 600.0 {
                continue;
            }
            let want = (-depth).exp() * isotropic_beyond(&geometry, extinction);
            let got = airlight_isotropic(&geometry, extinction);
            assert!(
                (got / want - 1.0).abs() < 1e-13,
                "{geometry:?}, extinction {extinction}: {got} against {want}"
            );
        }
    }
}

#[test]
fn rays_past_a_light_have_no_jump_of_pi() {
    // The note's b = -5, c = 26, d = 20, whose arctangent gives -0.2640.
    let geometry = LightRayGeometry {
        nearest_m: 1.0,
        start_m: -5.0,
        length_m: 20.0,
    };
    let integral = 4.0 * PI * airlight_without_extinction(&geometry);
    assert!((integral - 2.8776).abs() < 5e-5, "{integral}");
    let printed = ((15.0 - -5.0) / (1.0 + 15.0 * -5.0f64)).atan();
    assert!((printed + 0.2640).abs() < 5e-5);
    assert!((integral - printed - PI).abs() < 1e-12);
}

#[test]
fn ratios_without_extinction_in_dense_fog() {
    let geometry = LightRayGeometry {
        nearest_m: 1.0,
        start_m: -5.0,
        length_m: 20.0,
    };
    let ratio =
        |sigma| airlight_without_extinction(&geometry) / airlight_isotropic(&geometry, sigma);
    // Visibility 100 m and 10 m (5 % contrast), and the case of the book.
    for (sigma, want) in [(0.029957, 1.2398), (0.29957, 6.95), (0.27, 5.8)] {
        let got: f64 = ratio(sigma);
        assert!((got / want - 1.0).abs() < 3e-3, "{sigma}: {got}");
    }
}

#[test]
fn the_limit_of_thin_fog_is_the_form_without_extinction() {
    for geometry in geometries(&NEAREST) {
        let without = airlight_without_extinction(&geometry);
        let mut before = f64::INFINITY;
        for extinction in [1e-14, 1e-16, 1e-20, 1e-30, 0.0] {
            let apart = (airlight_isotropic(&geometry, extinction) / without - 1.0).abs();
            assert!(
                apart < before.max(2e-13),
                "{geometry:?} {extinction}: {apart}"
            );
            before = apart;
        }
        assert!(before == 0.0);
    }
}

#[test]
fn near_and_far_parts_compose() {
    for geometry in geometries(&NEAREST) {
        for extinction in [0.0, 1e-6, 0.05, 4.0] {
            let whole = airlight_isotropic(&geometry, extinction);
            if whole < 1e-200 {
                continue;
            }
            for share in [1e-3, 0.3, 0.9] {
                let split = share * geometry.length_m.min(1e5);
                let near = airlight_isotropic(&geometry.part(0.0, split), extinction);
                let far = airlight_isotropic(&geometry.part(split, geometry.length_m), extinction);
                let both = near + (-extinction * split).exp() * far;
                // Limited by the rounding of start_m of a part far from the point closest to the light.
                let rounded = 1e-15 * (split + geometry.start_m.abs()) / geometry.nearest_m;
                assert!(
                    (both / whole - 1.0).abs() < 1e-12 + 2.0 * rounded,
                    "{geometry:?}, extinction {extinction}, split {split}: {both} against {whole}"
                );
            }
        }
    }
}

mod guards {
    use super::*;

    const FAST_NEAREST: [f64; 9] = [1e-6, 1e-3, 0.1, 1.0, 8.0, 250.0, 3e4, 1e6, 1e7];

    /// Largest error of the fast form at an optical depth to the light, in f64 and in f32.
    fn worst(count: usize, depth: f64) -> (f64, f64) {
        let nodes = Nodes::new(count);
        let (mut worst64, mut worst32) = (0.0f64, 0.0f64);
        for geometry in geometries(&FAST_NEAREST) {
            // Rounded to f32, so that both forms use the same value.
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

    /// Prints a table of the book with `--nocapture`.
    #[test]
    fn errors_of_the_fast_form() {
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
                1e-6, 1e-4, 1e-3, 0.01, 0.03, 0.1, 0.3, 1.0, 2.0, 4.0, 8.0, 16.0, 32.0, 80.0,
                300.0, 600.0,
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
}

include!("exponential_integral_values.rs");

#[test]
fn the_exponential_integral_matches_mpmath() {
    for (re, im, want_re, want_im) in VALUES {
        let got = scaled_exponential_integral(re, im);
        assert!(
            (got.0 / want_re - 1.0).abs() < 1e-13,
            "({re}, {im}): {got:?}"
        );
        assert!(
            (got.1 - want_im).abs() <= 1e-13 * f64::abs(want_im),
            "({re}, {im}): {got:?}"
        );
    }
}

#[test]
fn series_and_continued_fraction_agree() {
    for step in 0..=40 {
        let (sin, cos) = (f64::from(step) / 40.0 * std::f64::consts::FRAC_PI_2).sin_cos();
        let (a, b) = (
            series(2.0 * cos, -2.0 * sin),
            fraction(2.0 * cos, -2.0 * sin),
        );
        assert!((a.0 / b.0 - 1.0).abs() < 5e-14, "{step}: {a:?} {b:?}");
        assert!((a.1 - b.1).abs() <= 5e-14 * b.1, "{step}: {a:?} {b:?}");
    }
}
