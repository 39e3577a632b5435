//! Patches in the fog of a solved sky: every answer of a view sees the same optical depth.

use airlight::models::registry;
use airlight::scene::{Channels, FogPatchesSpec, FogSpec, RadianceView, Scene, SolverSpec};
use airlight::sky::SunCoverage;
use airlight::spectrum::RgbSpace;
use airlight::{Control, axes};
use glam::DVec3;
use std::sync::Arc;

const EYE_M: f64 = 2.0;

fn scene(strength: Option<f64>) -> Scene {
    let mut scene = Scene::default();
    scene.sun.elevation_deg = Some(30.0);
    scene.solver = SolverSpec {
        wavelengths: Some("rgb".to_owned()),
        scattering: Some(airlight::sky::Scattering::Single),
        ..SolverSpec::default()
    };
    scene.fog = Some(FogSpec {
        visibility_m: Some(150.0),
        top_m: Some(30.0),
        patches: strength.map(|strength| FogPatchesSpec {
            strength: Some(strength),
            seed: Some(3),
            ..FogPatchesSpec::default()
        }),
        ..FogSpec::default()
    });
    scene
}

fn view(scene: &Scene) -> Arc<dyn RadianceView> {
    let resolved = scene.resolve().unwrap();
    let sun = resolved.sun.at_start().unwrap();
    let suns = SunCoverage::near(sun.elevation_deg, EYE_M);
    let model = registry::prepare(&resolved, suns, Control::default()).unwrap();
    let channels = Channels::Rgb(RgbSpace::Srgb);
    model.view(EYE_M, &sun.state(), channels).unwrap()
}

fn radiance(view: &dyn RadianceView, direction: DVec3) -> [f32; 3] {
    let mut out = [0.0; 3];
    view.radiance(&[direction], &mut out);
    out
}

#[test]
fn a_sky_sees_patches_in_every_answer() {
    let [none, even, flat, patchy] = [
        Scene {
            fog: None,
            ..scene(None)
        },
        scene(None),
        scene(Some(0.0)),
        scene(Some(0.9)),
    ];
    let fog = patchy.resolve().unwrap().fog.unwrap();
    // The ground is round, but flat to a millimetre within 100 m.
    let factors = fog
        .patches_seen_from(EYE_M, 6.36e6, 0.004)
        .unwrap()
        .unwrap();
    let [none, even, flat, patchy] = [&none, &even, &flat, &patchy].map(view);
    let path = |view: &Arc<dyn RadianceView>, direction, distance_m| {
        let (mut transmittance, mut path_radiance) = ([0.0; 3], [0.0; 3]);
        view.path(
            direction,
            distance_m,
            &mut transmittance,
            &mut path_radiance,
        );
        (f64::from(transmittance[1]), f64::from(path_radiance[1]))
    };
    let mut differ = 0;
    for (azimuth, elevation) in [(0.0, 1.0), (75.0, 4.0), (160.0, 25.0), (290.0, 70.0)] {
        let direction = axes::direction(azimuth, elevation);
        for distance_m in [20.0, 100.0] {
            let air = path(&none, direction, distance_m).0;
            let (through, light) = path(&even, direction, distance_m);
            let factor = factors.factor(direction, distance_m);
            let right = air * (through / air).powf(factor);
            let (got, path_light) = path(&patchy, direction, distance_m);
            assert!((got - right).abs() < 2e-4, "{got} {right}");
            // Of the fog's colour.
            let source = light / (1.0 - through);
            assert!((path_light / (1.0 - got) / source - 1.0).abs() < 0.02);
            let (got, _) = path(&flat, direction, distance_m);
            assert!((got - through).abs() < 1e-5, "{got} {through}");
            differ += usize::from((factor - 1.0).abs() > 0.1);
        }
        // The sky lies between the clear sky and the fog.
        let [clear, thick, seen] =
            [&none, &even, &patchy].map(|view| radiance(&**view, direction)[1]);
        let factor = factors.factor(direction, f64::INFINITY);
        let closer = (seen - clear).abs() < (thick - clear).abs();
        if (factor - 1.0).abs() > 0.02 && (thick - clear).abs() > 0.02 * thick {
            assert_eq!(closer, factor < 1.0, "{clear} {thick} {seen} {factor}");
        }
        let [a, b] = [&even, &flat].map(|view| radiance(&**view, direction)[1]);
        assert!((a / b - 1.0).abs() < 1e-4, "{a} {b}");
    }
    assert!(differ >= 4, "{differ}");
    // The sun's disc.
    let sun = patchy.sun();
    let disc = |view: &Arc<dyn RadianceView>| {
        let mut out = [0.0; 3];
        view.sun_irradiance(&mut out);
        f64::from(out[1])
    };
    let (clear, even, seen) = (disc(&none), disc(&even), disc(&patchy));
    let right = clear * (even / clear).powf(factors.factor(sun, f64::INFINITY));
    assert!((seen / right - 1.0).abs() < 1e-3, "{seen} {right}");
}

#[test]
fn models_without_patches_refuse_them() {
    for name in ["monte-carlo", "klassen1987"] {
        let mut scene = scene(Some(0.5));
        scene.solver = SolverSpec {
            name: Some(name.to_owned()),
            ..SolverSpec::default()
        };
        let resolved = scene.resolve().unwrap();
        let refused = registry::prepare(&resolved, SunCoverage::All, Control::default());
        let said = refused.err().unwrap().to_string();
        let expected = "fog.patches: expected a solver that honours patches in the fog, got";
        assert!(said.starts_with(expected), "{said}");
        assert!(said.ends_with("try orders"), "{said}");
    }
}
