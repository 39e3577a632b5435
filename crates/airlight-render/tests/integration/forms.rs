//! Profiles and scattering of fog, and layers of it.

use super::common::{black, layers, scene};
use airlight::fog::FogScattering;
use airlight::scene::{FogLayerSpec, FogProfile, ObjectsSpec};
use airlight_render::overlay::OverlayScene;

const SIZE: (u32, u32) = (32, 24);
const AMBIENT: [f64; 3] = [0.2, 0.4, 0.6];

/// Height fog of 8 m scale height under a sun.
fn sunny(scattering: Option<FogScattering>) -> OverlayScene {
    let mut scene = scene(AMBIENT);
    scene.fog_mut().profile = Some(FogProfile::Height);
    scene.fog_mut().scale_height_m = Some(8.0);
    scene.fog_mut().scattering = scattering;
    scene.scene.sun.elevation_deg = Some(15.0);
    scene
}

/// Ishiyama's (21): S = (p L_sun + L_amb) (1 - T) in every direction.
#[test]
fn an_undimmed_sun_is_height_fog_as_printed() {
    let of = |scattering| {
        let scene = sunny(scattering);
        layers(&scene, &black(SIZE, &scene.overlay))
    };
    // Irradiance 3 pi of the ambient light, times 1 / (4 pi): 3 / 4 of it.
    let printed = of(Some(FogScattering::Undimmed));
    assert!(printed.sources().all(|j| (j / 0.7 - 1.0).abs() < 1e-4));
    let single = of(Some(FogScattering::Single));
    assert!(single.sources().all(|j| j > 0.4 && j < 0.69));
    let all = of(Some(FogScattering::Multiple));
    let mut pairs = all.sources().zip(single.sources());
    assert!(pairs.all(|(a, s)| (a / s - 1.0).abs() > 0.01));
    assert_eq!(of(None), all);
}

#[test]
fn without_a_sun_or_in_uniform_fog_scattering_makes_no_difference() {
    let of = |mut scene: OverlayScene, scattering| {
        scene.fog_mut().scattering = Some(scattering);
        layers(&scene, &black(SIZE, &scene.overlay))
    };
    let mut height = sunny(None);
    height.scene.sun.elevation_deg = None;
    let single = of(height.clone(), FogScattering::Single);
    assert_eq!(single, of(height, FogScattering::Undimmed));
    assert!(single.sources().all(|j| (j / 0.4 - 1.0).abs() < 1e-4));
    for sun in [None, Some(30.0)] {
        let mut uniform = scene(AMBIENT);
        uniform.scene.sun.elevation_deg = sun;
        let all = of(uniform.clone(), FogScattering::Multiple);
        assert_eq!(all, of(uniform.clone(), FogScattering::Single));
        assert_eq!(all, of(uniform, FogScattering::Undimmed));
    }
}

#[test]
fn unclamped_fog_is_denser_below_the_base_only() {
    let through = |profile, base_m| {
        let mut scene = scene([1.0; 3]);
        let fog = scene.fog_mut();
        fog.profile = Some(profile);
        fog.base_height_m = Some(base_m);
        fog.scale_height_m = Some(4.0);
        layers(&scene, &black(SIZE, &scene.overlay)).pixel(16, 12)[4]
    };
    // The wall stands above a base of -20 m, and below one of 20 m.
    let of = |base_m| {
        [FogProfile::Unclamped, FogProfile::Clamped].map(|profile| through(profile, base_m))
    };
    let [above, clamped_above] = of(-20.0);
    assert!((above / clamped_above - 1.0).abs() < 1e-6);
    let [below, clamped_below] = of(20.0);
    assert!(below < 0.1 * clamped_below, "{below} {clamped_below}");
}

#[test]
fn the_profile_follows_from_the_heights() {
    let of = |set: fn(&mut OverlayScene)| {
        let mut scene = OverlayScene::default();
        set(&mut scene);
        scene.fog_profile()
    };
    assert_eq!(of(|_| {}), FogProfile::Uniform);
    let thinning = of(|s| s.fog_mut().scale_height_m = Some(9.0));
    assert_eq!(thinning, FogProfile::Clamped);
    let based = of(|s| s.fog_mut().base_height_m = Some(9.0));
    assert_eq!(based, FogProfile::Clamped);
    assert_eq!(of(|s| s.fog_mut().top_m = Some(9.0)), FogProfile::Slab);
    let given = of(|s| {
        s.fog_mut().top_m = Some(9.0);
        s.fog_mut().profile = Some(FogProfile::Linear);
    });
    assert_eq!(given, FogProfile::Linear);
}

#[test]
fn layers_add_up() {
    let lit = |visibility_m| {
        let mut scene = scene([0.5, 0.6, 0.7]);
        scene.scene.observer.eye_height_m = Some(3.0);
        scene.scene.sun.elevation_deg = Some(30.0);
        scene.scene.lights = vec![super::lights::point([1.0, 3.0, -6.0], 1.0)];
        scene.fog_mut().visibility_m = Some(visibility_m);
        scene.fog_mut().droplets = None;
        scene
    };
    let image = black(SIZE, &lit(50.0).overlay);
    let heights = |layer: &mut FogLayerSpec, profile| match profile {
        FogProfile::Slab => layer.top_m = Some(4.0),
        FogProfile::Clamped => {
            layer.scale_height_m = Some(5.0);
            layer.base_height_m = Some(2.0);
        }
        FogProfile::Height => layer.scale_height_m = Some(5.0),
        _ => {}
    };
    for profile in [
        FogProfile::Uniform,
        FogProfile::Height,
        FogProfile::Clamped,
        FogProfile::Slab,
    ] {
        let mut layer = FogLayerSpec {
            visibility_m: Some(100.0),
            profile: Some(profile),
            ..FogLayerSpec::default()
        };
        heights(&mut layer, profile);
        let of = |visibility_m, more: &[FogLayerSpec]| {
            let mut scene = lit(visibility_m);
            let fog = scene.fog_mut();
            fog.profile = layer.profile;
            fog.scale_height_m = layer.scale_height_m;
            fog.base_height_m = layer.base_height_m;
            fog.top_m = layer.top_m;
            fog.layers = more.to_vec();
            layers(&scene, &image)
        };
        let (once, twice) = (of(50.0, &[]), of(100.0, std::slice::from_ref(&layer)));
        for (a, b) in once.channel(0).zip(twice.channel(0)) {
            assert!((a / b - 1.0).abs() < 2e-3, "{profile:?}: {a} {b}");
        }
    }
    // A layer far below is invisible, one around the eye is not.
    let with_slab = |top_m: Option<f64>| {
        let mut scene = scene([0.5, 0.6, 0.7]);
        scene.scene.observer.eye_height_m = Some(3.0);
        scene.fog_mut().visibility_m = Some(1e6);
        scene.fog_mut().layers = top_m
            .map(|top_m| FogLayerSpec {
                visibility_m: Some(20.0),
                top_m: Some(top_m),
                ..FogLayerSpec::default()
            })
            .into_iter()
            .collect();
        layers(&scene, &image).pixel(16, 2)[1]
    };
    let [clear, low, around] = [None, Some(0.1), Some(6.0)].map(with_slab);
    assert!((low / clear - 1.0).abs() < 0.01);
    assert!(around > 20.0 * clear);
}

#[test]
fn contradictions_are_refused_before_any_file_is_read() {
    let refused = |set: &dyn Fn(&mut OverlayScene)| {
        let mut scene = scene(AMBIENT);
        set(&mut scene);
        scene.check().unwrap_err().to_string()
    };
    let light = || super::lights::point([0.0, 1.0, -5.0], 1.0);
    type Change<'a> = &'a dyn Fn(&mut OverlayScene);
    let cases: [(Change<'_>, &str); 24] = [
        (&|s| s.scene.air.aod_550 = Some(0.2), "a solved sky"),
        (
            &|s| s.scene.sun.latitude_deg = Some(50.0),
            "latitude and longitude",
        ),
        (
            &|s| s.scene.air.ground_altitude_m = Some(9.0),
            "a solved sky",
        ),
        (&|s| s.overlay.radiance_scale = Some(1.0), "a solved sky"),
        (&|s| s.overlay.sun_strength = Some(1.0), "no sun"),
        (
            &|s| s.overlay.principal_point_px = Some([1.0, 2.0]),
            "focal-px",
        ),
        (
            &|s| {
                s.overlay.focal_px = Some(100.0);
                s.scene.camera.fov_deg = Some(50.0);
            },
            "got both",
        ),
        (
            &|s| s.scene.observer.altitude_m = Some(9.0),
            "observer.altitude_m",
        ),
        (&|s| s.scene.output.scale = Some(2.0), "output: expected"),
        (
            &|s| {
                s.scene.objects = Some(ObjectsSpec {
                    file: Some("a.toml".into()),
                    ..Default::default()
                })
            },
            "objects",
        ),
        (&|s| s.fog_mut().visibility_m = None, "a visibility"),
        (&|s| s.fog_mut().visibility_m = Some(0.0), "above 0"),
        (
            &|s| s.scene.sun.elevation_deg = Some(-3.0),
            "above the horizon",
        ),
        (
            &|s| s.overlay.depth_kind = airlight_render::overlay::DepthFileKind::Disparity,
            "focal-px",
        ),
        (
            &|s| s.overlay.depth_kind = airlight_render::overlay::DepthFileKind::Buffer,
            "near_plane_m",
        ),
        (
            &|s| s.overlay.far_plane_m = Some(100.0),
            "a depth buffer, unlike depth-kind z",
        ),
        (
            &|s| {
                s.overlay.light_form = airlight::fog::lights::LightForm::Printed;
            },
            "expected a light",
        ),
        (
            &|s| {
                s.fog_mut().profile = Some(FogProfile::Exp2);
                s.scene.lights = vec![light()];
            },
            "one colour",
        ),
        (
            &|s| {
                s.fog_mut().profile = Some(FogProfile::Linear);
                s.overlay.sky_light = true;
            },
            "one colour",
        ),
        (
            &|s| {
                s.fog_mut().profile = Some(FogProfile::FoggyCityscapes);
                s.fog_mut().scattering = Some(FogScattering::Single);
            },
            "one colour",
        ),
        (&|s| s.overlay.sky_light = true, "upper end"),
        (&|s| s.scene.solver.paths = Some(256), "solver monte-carlo"),
        (
            &|s| s.scene.solver.name = Some("monte-carlo".to_owned()),
            "sky-light",
        ),
        (
            &|s| s.scene.solver.name = Some("preetham".to_owned()),
            "(orders, monte-carlo)",
        ),
    ];
    for (set, part) in cases {
        let sentence = refused(set);
        assert!(sentence.contains(part), "{part}: {sentence}");
    }
}

#[cfg(feature = "schema")]
#[test]
fn the_schema_has_the_scene_and_the_overlay() {
    let schema: serde_json::Value = serde_json::from_str(&OverlayScene::json_schema()).unwrap();
    let keys = schema["properties"].as_object().unwrap();
    for key in ["version", "fog", "lights", "camera", "overlay"] {
        assert!(keys.contains_key(key), "{key}: {schema:#}");
    }
    let overlay = &schema["$defs"]["OverlaySpec"]["properties"];
    assert!(overlay["depth_kind"].is_object(), "{schema:#}");
}

#[test]
fn descriptions_are_read_as_they_are_written() {
    let mut scene = sunny(Some(FogScattering::Single));
    scene.scene.lights = vec![super::lights::point([0.0, 1.0, -5.0], 1.0)];
    scene.overlay.colour = "a.png".into();
    scene.overlay.depth = Some("b.npy".into());
    scene.overlay.principal_point_px = Some([1.5, 2.0]);
    let text = scene.to_toml().unwrap();
    assert_eq!(OverlayScene::from_toml(&text).unwrap(), scene, "{text}");
    let wrong = OverlayScene::from_toml("[overlay]\ncolor = \"a.png\"\n").unwrap_err();
    assert!(wrong.to_string().contains("colour"), "{wrong}");
}
