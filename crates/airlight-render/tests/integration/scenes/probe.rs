//! The numbers of a probe agree with each other.

use super::{probe, try_probe};
use airlight_render::probe::{ProbeRay, RayAnswer};

/// Single scattering, multiple scattering and ground make the radiance of a view.
fn assert_parts_sum(view: &RayAnswer) {
    let parts = [
        &view.radiance_single_w_m2_sr_nm,
        &view.radiance_multiple_w_m2_sr_nm,
        &view.radiance_ground_w_m2_sr_nm,
    ]
    .map(|part| part.as_ref().unwrap());
    for (lane, all) in view.radiance_w_m2_sr_nm.iter().enumerate() {
        let sum: f32 = parts.iter().map(|part| part[lane]).sum();
        assert!((all / sum - 1.0).abs() < 1e-5);
    }
}

#[test]
fn above_the_air_there_is_no_sky() {
    let scene = "solver.wavelengths = \"rgb\"\nsun.elevation_deg = 30\nobserver.altitude_m = 1e5";
    let answer = probe(scene, &[]);
    assert_eq!(answer.sky.illuminance_horizontal_lx, 0.0);
    assert!(answer.sun.illuminance_normal_lx > 1.2e5);
}

#[test]
fn parts_make_the_whole() {
    let scene = "solver.wavelengths = \"fast\"\nsun.elevation_deg = 20\nsun.azimuth_deg = 90";
    let answer = probe(scene, &[(0.0, 90.0), (90.0, -30.0), (45.0, 3.0)]);
    assert_eq!(answer.format, "airlight-probe/1");
    for view in &answer.views {
        assert_parts_sum(view);
        let transmittance = view.transmittance.as_ref().unwrap();
        assert!(transmittance.iter().all(|t| (0.0..=1.0).contains(t)));
        assert_eq!(view.xyz_cd_m2[1], view.luminance_cd_m2);
    }
    assert!(answer.views[1].meets_ground);
    let ground = answer.views[1].radiance_ground_w_m2_sr_nm.as_ref().unwrap();
    assert!(ground.iter().all(|&l| l > 0.0));
    assert!((answer.views[0].sun_angle_deg - 70.0).abs() < 1e-9);
    let sun = &answer.sun;
    let ratio = sun.illuminance_horizontal_lx / sun.illuminance_normal_lx;
    assert!((ratio - 20f64.to_radians().sin()).abs() < 1e-9);
    let pairs = sun.irradiance_normal_w_m2_nm.iter();
    for (here, outside) in pairs.zip(&sun.irradiance_outside_w_m2_nm) {
        assert!(*here > 0.0 && here < outside);
    }
    assert!(answer.sky.illuminance_horizontal_lx > 3000.0);
}

#[test]
fn place_and_time_give_the_suns_distance() {
    let quick = "solver.wavelengths = \"rgb\"\nsolver.scattering = \"single\"\n";
    let january = format!(
        "{quick}sun = {{ latitude_deg = 0, longitude_deg = 0, time = \"2026-01-03T12:00:00Z\" }}"
    );
    let near = probe(&january, &[]);
    let mean = probe(&format!("{quick}sun.elevation_deg = 67"), &[]);
    let ratio = near.sun.irradiance_outside_w_m2_nm[1] / mean.sun.irradiance_outside_w_m2_nm[1];
    assert!((ratio - 1.0344).abs() < 1e-3);
    assert_eq!(
        near.observer.time_utc.as_deref(),
        Some("2026-01-03T12:00:00Z")
    );
    assert_eq!(near.observer.altitude_m, 2.0);
    assert!(near.sun.angular_radius_deg > mean.sun.angular_radius_deg);
    let lifted = near.sun.elevation_deg - near.sun.geometric_elevation_deg.unwrap();
    assert!(lifted > 0.0 && lifted < 0.02);
    let straight = probe(
        &january.replace("12:00:00Z\"", "12:00:00Z\", refraction = false"),
        &[],
    );
    assert_eq!(
        Some(straight.sun.elevation_deg),
        straight.sun.geometric_elevation_deg
    );
}

#[test]
fn csv_and_json_say_the_same() {
    let rays = vec![
        ProbeRay {
            azimuth_deg: 10.0,
            elevation_deg: 20.0,
            distance_m: None,
        },
        ProbeRay {
            azimuth_deg: 30.0,
            elevation_deg: 1.0,
            distance_m: Some(5000.0),
        },
    ];
    let scene =
        "solver.wavelengths = \"rgb\"\nsolver.scattering = \"single\"\nsun.elevation_deg = 20";
    let answer = try_probe(scene, rays).unwrap();
    let json: serde_json::Value = serde_json::from_str(&answer.to_json().unwrap()).unwrap();
    let csv = answer.to_csv();
    let mut lines = csv.lines().map(|line| line.split(',').collect::<Vec<_>>());
    let header = lines.next().unwrap();
    let column = |name: &str| {
        header
            .iter()
            .position(|h| *h == name)
            .unwrap_or_else(|| panic!("no column {name}"))
    };
    let lines: Vec<Vec<&str>> = lines.collect();
    assert_eq!(lines.len(), 6);
    for (index, line) in lines.iter().enumerate() {
        assert_eq!(line.len(), header.len());
        let view = &json["views"][index / 3];
        for key in [
            "radiance_w_m2_sr_nm",
            "radiance_single_w_m2_sr_nm",
            "transmittance",
        ] {
            let value: f64 = line[column(key)].parse().unwrap();
            let other = view[key][index % 3].as_f64().unwrap();
            assert!((value - other).abs() <= 1e-6 * value.abs());
        }
        let distance = if index < 3 { "" } else { "5000" };
        assert_eq!(line[column("distance_m")], distance);
        assert_eq!(line[column("solver")], "orders");
    }
}

#[test]
fn extremes_are_answered_with_numbers() {
    let quick =
        "solver.wavelengths = \"rgb\"\nsolver.scattering = \"single\"\nsun.elevation_deg = 10\n";
    for (scene, rays) in [
        (
            "sun.elevation_deg = 90",
            vec![(0.0, 90.0), (0.0, -90.0), (0.0, 0.0)],
        ),
        ("sun.elevation_deg = -90", vec![(0.0, 90.0), (0.0, -90.0)]),
        (
            "sun.elevation_deg = 0\nsolver.scattering = \"all\"",
            vec![(180.0, 0.0), (0.0, 0.0), (180.0, 0.1)],
        ),
        (
            "observer.altitude_m = 400e3",
            vec![(180.0, -20.0), (0.0, 90.0), (180.0, -89.0)],
        ),
        (
            "observer.altitude_m = 1e9",
            vec![(180.0, -90.0), (0.0, 0.0)],
        ),
        (
            "observer.altitude_m = -400",
            vec![(180.0, 1.0), (0.0, -5.0)],
        ),
        (
            "air = { aod_550 = 0, ozone_du = 0, ground_albedo = 0 }",
            vec![(180.0, 1.0), (180.0, 10.0)],
        ),
        ("air.aod_550 = 50", vec![(180.0, 1.0), (180.0, 10.0)]),
        ("solver.wavelengths = \"300,900\"", vec![(180.0, 1e-9)]),
        ("air.ground_albedo = 0.5", vec![(1e300, 5.0), (-720.5, 5.0)]),
    ] {
        let answer = probe(&format!("{quick}{scene}"), &rays);
        for view in &answer.views {
            let lists = [
                &view.radiance_w_m2_sr_nm,
                view.transmittance.as_ref().unwrap(),
            ];
            let values = lists.iter().flat_map(|list| list.iter());
            for value in values.map(|&v| f64::from(v)).chain(view.xyz_cd_m2) {
                assert!(value.is_finite() && value >= -1e-9, "{scene}: {view:?}");
            }
        }
        assert!(answer.sky.illuminance_horizontal_lx.is_finite(), "{scene}");
    }
}

#[test]
fn the_sky_article_is_as_it_was_printed() {
    // Its constants, its eye height of 1 m; it knows colours only.
    let scene = "solver = { name = \"single-scattering\", variant = \"printed\" }\nsun.elevation_deg = 45\nobserver.eye_height_m = 1";
    let answer = probe(scene, &[(180.0, 45.0)]);
    assert_eq!(answer.solver, "single-scattering");
    assert_eq!(answer.variant.as_deref(), Some("printed"));
    assert!(answer.atmosphere.is_none());
    let view = &answer.views[0];
    for (stated, printed) in view.rgb_cd_m2.iter().zip([3652.0, 4655.0, 7169.0]) {
        assert!((stated - printed).abs() < 1.0, "{stated} {printed}");
    }
    assert!(answer.wavelengths_nm.is_empty() && view.radiance_w_m2_sr_nm.is_empty());
    assert!(view.transmittance.is_none() && view.radiance_single_w_m2_sr_nm.is_none());
    assert!(answer.sun.illuminance_normal_lx > 1e5);
    let converged = probe(&scene.replace("printed", "corrected"), &[(180.0, 45.0)]);
    let colors = converged.views[0].rgb_cd_m2.iter();
    for (stated, right) in colors.zip([10878.0, 11659.0, 13903.0]) {
        assert!((stated / right - 1.0).abs() < 1e-3, "{stated} {right}");
    }
    let csv = answer.to_csv();
    let lines: Vec<Vec<&str>> = csv.lines().map(|line| line.split(',').collect()).collect();
    assert_eq!(lines.len(), 2);
    assert_eq!(lines[0].len(), lines[1].len());
    assert!(lines[1].ends_with(&["single-scattering", "printed"]));
}

#[test]
fn spectra_of_1987_make_its_colours_and_its_light() {
    let scene = "solver.name = \"klassen1987\"\nsun.elevation_deg = 30";
    let answer = probe(scene, &[(180.0, 10.0), (0.0, 60.0), (90.0, -20.0)]);
    let nm = &answer.wavelengths_nm;
    assert_eq!((nm.len(), nm[0], nm[32]), (33, 380.0, 700.0));
    let grid = airlight::models::klassen1987::wavelength_grid();
    for view in &answer.views {
        let color = grid.to_xyz(&view.radiance_w_m2_sr_nm);
        for (a, b) in color.iter().zip(view.xyz_cd_m2) {
            assert!((a / b - 1.0).abs() < 1e-6, "{a} {b}");
        }
    }
    assert!(answer.views[2].meets_ground);
    let (sun, sky) = (&answer.sun, &answer.sky);
    for (irradiance, illuminance_lx) in [
        (&sun.irradiance_normal_w_m2_nm, sun.illuminance_normal_lx),
        (
            &sun.irradiance_horizontal_w_m2_nm,
            sun.illuminance_horizontal_lx,
        ),
        (
            &sky.irradiance_horizontal_w_m2_nm,
            sky.illuminance_horizontal_lx,
        ),
    ] {
        let lx = grid.to_xyz(irradiance)[1];
        assert!((lx / illuminance_lx - 1.0).abs() < 1e-6);
    }
    let pairs = sun.irradiance_normal_w_m2_nm.iter();
    assert!(
        pairs
            .zip(&sun.irradiance_outside_w_m2_nm)
            .all(|(e, o)| *e > 0.0 && e < o)
    );
}

#[test]
fn models_with_rays_know_their_parts() {
    let scene =
        "solver = { name = \"hillaire2020\", wavelengths = \"rgb\" }\nsun.elevation_deg = 30";
    let whole = probe(scene, &[(180.0, 2.0), (0.0, -30.0), (90.0, 1.0)]);
    for view in &whole.views {
        assert_parts_sum(view);
    }
    assert!(whole.views[1].meets_ground);
    // The air before an object: less than all of it, and more transparent.
    let near = ProbeRay {
        azimuth_deg: 90.0,
        elevation_deg: 1.0,
        distance_m: Some(20e3),
    };
    let near = &try_probe(scene, vec![near]).unwrap().views[0];
    let far = &whole.views[2];
    let pairs = near
        .radiance_w_m2_sr_nm
        .iter()
        .zip(&far.radiance_w_m2_sr_nm);
    assert!(pairs.into_iter().all(|(n, f)| *n > 0.0 && n < f));
    let through = |view: &RayAnswer| view.transmittance.clone().unwrap();
    assert!(
        through(near)
            .iter()
            .zip(through(far))
            .all(|(n, f)| *n > f && *n < 1.0)
    );
    // Once scattered alone.
    let once = probe(
        &format!("{scene}\nsolver.scattering = \"single\"").replace(
            "solver = { name = \"hillaire2020\", wavelengths = \"rgb\" }",
            "solver.name = \"hillaire2020\"\nsolver.wavelengths = \"rgb\"",
        ),
        &[(0.0, 9.0)],
    );
    assert_eq!(once.scattering, Some("single"));
    let multiple = once.views[0].radiance_multiple_w_m2_sr_nm.as_ref().unwrap();
    assert_eq!(multiple[..], [0.0; 3]);
}

#[test]
fn the_suns_distance_dims_models_with_spectra() {
    let january =
        "sun = { latitude_deg = 0, longitude_deg = 0, time = \"2026-01-03T12:00:00Z\" }\n";
    let ours = probe(&format!("{january}solver.wavelengths = \"rgb\""), &[]);
    for (solver, lane) in [("klassen1987", 6), ("hillaire2020", 0)] {
        let wavelengths = match lane {
            0 => "solver.wavelengths = \"rgb\"\n",
            _ => "",
        };
        let answer = probe(
            &format!("{january}{wavelengths}solver.name = \"{solver}\""),
            &[],
        );
        // 440 nm, of means over more or less of the spectrum.
        let ratio =
            answer.sun.irradiance_outside_w_m2_nm[lane] / ours.sun.irradiance_outside_w_m2_nm[0];
        assert!((ratio - 1.0).abs() < 0.05, "{solver}: {ratio}");
        let ratio = answer.sun.angular_radius_deg / ours.sun.angular_radius_deg;
        assert!((ratio - 1.0).abs() < 1e-9, "{solver}: {ratio}");
    }
}

#[test]
fn models_refuse_what_they_do_not_know() {
    let ray = |distance_m| {
        vec![ProbeRay {
            azimuth_deg: 0.0,
            elevation_deg: 9.0,
            distance_m,
        }]
    };
    for (scene, distance_m, part) in [
        ("solver.name = \"klassen1987\"", Some(50.0), "hillaire2020"),
        ("solver.name = \"preetham\"", Some(50.0), "distance_m"),
        ("solver.variant = \"printed\"", None, "klassen1987"),
        (
            "solver.name = \"preetham\"\noutput.polarisation = true",
            None,
            "monte-carlo",
        ),
    ] {
        let scene = format!("sun.elevation_deg = 20\n{scene}");
        let error = try_probe(&scene, ray(distance_m)).unwrap_err().to_string();
        assert!(error.contains(part), "{scene}: {error}");
    }
}

/// By night the answer includes the moon, and views are not separated into parts.
#[test]
fn the_moon_is_part_of_the_answer() {
    let scene = "solver = { wavelengths = \"rgb\", scattering = \"single\" }\nsun.elevation_deg = -25\n\
                 night = { moon_elevation_deg = 30, moon_azimuth_deg = 120, moon_phase_deg = 90 }";
    let answer = probe(scene, &[(0.0, 90.0), (0.0, -5.0)]);
    let moon = answer.moon.as_ref().unwrap();
    assert!((moon.elevation_deg - 30.0).abs() < 1e-9 && (moon.azimuth_deg - 120.0).abs() < 1e-9);
    assert!((moon.lit_fraction - 0.5).abs() < 1e-9);
    let sine = moon.illuminance_horizontal_lx / moon.illuminance_normal_lx;
    assert!((sine - 0.5).abs() < 1e-6 && (0.01..0.03).contains(&moon.illuminance_normal_lx));
    assert_eq!(answer.sun.illuminance_normal_lx, 0.0);
    for view in &answer.views {
        assert!(view.radiance_single_w_m2_sr_nm.is_none());
        let transmittance = view.transmittance.as_ref().unwrap();
        assert!(transmittance.iter().all(|t| (0.0..=1.0).contains(t)));
        assert!(view.luminance_cd_m2 > 1e-5);
    }
    let day = probe(
        "solver = { wavelengths = \"rgb\" }\nsun.elevation_deg = 25",
        &[(0.0, 90.0)],
    );
    assert!(day.moon.is_none());
}
