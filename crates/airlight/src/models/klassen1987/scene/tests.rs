use super::super::geometry::Spheres;
use super::super::{Klassen1987Settings, SunRay};
use super::*;
use crate::atmosphere::droplets::Droplets;

const TOP_M: f64 = 40.0;

fn scene(sun_deg: f64, eye_m: f64, fog: bool, depth: SunDepth) -> Klassen1987Scene {
    let settings = Klassen1987Settings::default().printed();
    let model = Klassen1987::new(&settings, axes::direction(180.0, sun_deg)).unwrap();
    let fog = fog.then(|| Fog1987 {
        top_m: TOP_M,
        droplets: Constituent::fog(
            0.02,
            Droplets::Radiation.into(),
            DensityProfile::slab(TOP_M),
            &[],
        )
        .unwrap(),
    });
    Klassen1987Scene::new(Arc::new(model), eye_m, fog, depth).unwrap()
}

fn luminance(light: Lanes, scene: &Klassen1987Scene) -> f64 {
    to_xyz(&scene.model.grid, &light)[1]
}

#[test]
fn error_of_flat_ground_is_below_a_percent() {
    let spheres = |top_m: f64, air_m: f64| Spheres {
        earth_m: 6.371e6,
        haze_m: 6.371e6 + top_m,
        air_m: 6.371e6 + air_m,
    };
    // The paper's figure, for the path through the air above (eqs. 20 and 37).
    let air = |deg: f64| {
        let sin = deg.to_radians().sin();
        let round = spheres(50.0, 8400.0)
            .sun_lengths(sin, SunRay::Printed)
            .air_m;
        (8350.0 / sin) / round - 1.0
    };
    assert!(
        air(15.0) < 0.01 && air(13.0) > 0.01,
        "{} {}",
        air(15.0),
        air(13.0)
    );
    // Only the fog is flat here (eqs. 21 and 38).
    let fog = |deg: f64| {
        let sin = deg.to_radians().sin();
        let round = spheres(50.0, 8400.0)
            .sun_lengths(sin, SunRay::Printed)
            .haze_m;
        (50.0 / sin) / round - 1.0
    };
    assert!(
        fog(1.2) < 0.01 && fog(0.9) > 0.01,
        "{} {}",
        fog(1.2),
        fog(0.9)
    );
}

#[test]
fn rays_may_be_split_anywhere() {
    for (fog, sun_deg) in [(true, 30.0), (true, 0.5), (false, 30.0)] {
        let from = scene(sun_deg, 30.0, fog, SunDepth::Exact);
        for elevation_deg in [-40.0, -3.0, 0.0, 2.0, 30.0] {
            let direction = axes::direction(170.0, elevation_deg);
            let whole = from.before(direction, 40.0);
            let far = from.at_height_m(30.0 + 15.0 * direction.y);
            let parts = from
                .before(direction, 15.0)
                .then(far.before(direction, 25.0));
            for (a, b) in [
                (parts.path_radiance, whole.path_radiance),
                (parts.transmittance, whole.transmittance),
            ] {
                let off = (a - b).map(f32::abs).max_element();
                assert!(
                    off < 1e-5 * b.max_element(),
                    "{fog} {sun_deg} {elevation_deg}: {off}"
                );
            }
        }
    }
}

#[test]
fn radiance_is_finite_and_fog_hides_the_horizon() {
    for (sun_deg, eye_m, fog) in [
        (40.0, 1.6, true),
        (40.0, 90.0, true),
        (0.0, 1.6, true),
        (0.0, 1.6, false),
    ] {
        let scene = scene(sun_deg, eye_m, fog, SunDepth::Exact);
        for i in 0..400 {
            let up = f64::from(i) / 199.5 - 1.0;
            let level = (1.0 - up * up).max(0.0).sqrt();
            let direction = DVec3::new(0.0, up, level).normalize();
            let light = scene.around(direction);
            assert!(
                light.is_finite() && light.min_element() >= 0.0,
                "{sun_deg} {up}: {light:?}"
            );
        }
        let exactly_level = scene.around(DVec3::Z);
        assert!(exactly_level.is_finite(), "{exactly_level:?}");
    }
    // On both sides of the horizon only the fog is visible.
    let scene = scene(40.0, 1.6, true, SunDepth::Exact);
    let at = |deg| luminance(scene.around(axes::direction(90.0, deg)), &scene);
    assert!(
        (at(0.05) / at(-0.05) - 1.0).abs() < 0.01,
        "{} {}",
        at(0.05),
        at(-0.05)
    );
}

#[test]
fn fog_is_bright_towards_the_sun_and_dark_away_from_it() {
    // Figures 16 and 18.
    let scene = scene(25.0, 1.6, true, SunDepth::Printed);
    let towards = luminance(
        scene
            .before(axes::direction(180.0, 0.0), 60.0)
            .path_radiance,
        &scene,
    );
    let away = luminance(
        scene.before(axes::direction(0.0, 0.0), 60.0).path_radiance,
        &scene,
    );
    assert!(towards > 10.0 * away && away > 0.0, "{towards} {away}");
}

#[test]
fn at_sunset_the_fog_has_one_colour() {
    let scene = scene(0.3, 1.6, true, SunDepth::Exact);
    let at = |azimuth| scene.around(axes::direction(azimuth, 0.0));
    let (a, b) = (at(180.0), at(20.0));
    assert!((a - b).map(f32::abs).max_element() < 1e-6 * a.max_element());
    assert_eq!(scene.sunlight(1.0), Lanes::ZERO);
}

#[test]
fn objects_without_fog_are_lit_by_the_sun_of_the_model() {
    let scene = scene(30.0, 1.6, false, SunDepth::Printed);
    let sun: Vec<f64> = scene.model.sun_irradiance();
    assert_eq!(super::super::f64s(&scene.sunlight(3.0)), sun);
    // Ten metres of haze are nearly transparent.
    let near = scene.before(axes::direction(0.0, 0.0), 10.0);
    assert!(near.transmittance.min_element() > 0.998);
}
