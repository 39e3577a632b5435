use super::super::reference::{isotropic_beyond, passages};
use super::*;

const EVERY_DISTANCE: [f64; 8] = [1e-6, 1e-3, 0.1, 1.0, 8.0, 250.0, 3e4, 1e7];

#[test]
fn without_extinction_it_matches_quadrature_everywhere() {
    for geometry in passages(&EVERY_DISTANCE) {
        let want = isotropic_beyond(&geometry, 0.0);
        let got = airlight_without_extinction(&geometry);
        assert!(
            (got / want - 1.0).abs() < 1e-12,
            "{geometry:?}: {got} against {want}"
        );
    }
}

#[test]
fn with_extinction_it_matches_quadrature_everywhere() {
    for geometry in passages(&EVERY_DISTANCE) {
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
fn a_lamp_passed_on_the_way_has_no_jump_of_pi() {
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
fn leaving_extinction_out_makes_dense_fog_glow_too_much() {
    let geometry = LightRayGeometry {
        nearest_m: 1.0,
        start_m: -5.0,
        length_m: 20.0,
    };
    let ratio =
        |sigma| airlight_without_extinction(&geometry) / airlight_isotropic(&geometry, sigma);
    // Visibility 100 m, 10 m (5 % contrast); and where the glow is 5.8 times too bright.
    for (sigma, want) in [(0.029957, 1.2398), (0.29957, 6.95), (0.27, 5.8)] {
        let got: f64 = ratio(sigma);
        assert!((got / want - 1.0).abs() < 3e-3, "{sigma}: {got}");
    }
}

#[test]
fn thin_fog_ends_in_the_form_without_extinction() {
    for geometry in passages(&EVERY_DISTANCE) {
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
fn near_and_far_compose_to_the_whole() {
    for geometry in passages(&EVERY_DISTANCE) {
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
                // Where a part's start is rounded away from the point closest to the lamp nothing better can be said.
                let rounded = 1e-15 * (split + geometry.start_m.abs()) / geometry.nearest_m;
                assert!(
                    (both / whole - 1.0).abs() < 1e-12 + 2.0 * rounded,
                    "{geometry:?}, extinction {extinction}, split {split}: {both} against {whole}"
                );
            }
        }
    }
}
