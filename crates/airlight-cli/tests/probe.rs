//! The numbers of a probe: that they parse, and agree with each other.

mod common;

use common::{Folder, command, run, succeed};
use serde_json::Value;
use std::io::Write;
use std::process::Stdio;

fn json(folder: &Folder, words: &str) -> Value {
    serde_json::from_str(&succeed(folder, &format!("probe --format json {words}"))).unwrap()
}

fn list(value: &Value, key: &str) -> Vec<f64> {
    value[key]
        .as_array()
        .unwrap_or_else(|| panic!("no list {key}"))
        .iter()
        .map(|v| v.as_f64().unwrap())
        .collect()
}

fn number(value: &Value, key: &str) -> f64 {
    value[key]
        .as_f64()
        .unwrap_or_else(|| panic!("no number {key}"))
}

#[test]
fn parts_make_the_whole() {
    let folder = Folder::new();
    let words = "--wavelengths fast --sun-elevation 20 --sun-azimuth 90 --view 0,90 --view 90,-30 --view 45,3";
    let answer = json(&folder, words);
    assert_eq!(answer["format"], "airlight-probe/1");
    let views = answer["views"].as_array().unwrap();
    assert_eq!(views.len(), 3);
    for view in views {
        let parts = ["single", "multiple", "ground"]
            .map(|part| list(view, &format!("radiance_{part}_w_m2_sr_nm")));
        for (lane, all) in list(view, "radiance_w_m2_sr_nm").into_iter().enumerate() {
            let sum: f64 = parts.iter().map(|part| part[lane]).sum();
            assert!((all / sum - 1.0).abs() < 1e-5);
        }
        assert!(
            list(view, "transmittance")
                .iter()
                .all(|t| (0.0..=1.0).contains(t))
        );
        assert_eq!(list(view, "xyz_cd_m2")[1], number(view, "luminance_cd_m2"));
    }
    assert_eq!(views[1]["meets_ground"], true);
    assert!(
        list(&views[1], "radiance_ground_w_m2_sr_nm")
            .iter()
            .all(|&l| l > 0.0)
    );
    assert!((number(&views[0], "sun_angle_deg") - 70.0).abs() < 1e-9);
    let sun = &answer["sun"];
    let (normal, flat) = (
        number(sun, "illuminance_normal_lx"),
        number(sun, "illuminance_horizontal_lx"),
    );
    assert!((flat / normal - 20f64.to_radians().sin()).abs() < 1e-9);
    let outside = list(sun, "irradiance_outside_w_m2_nm");
    for (here, outside) in list(sun, "irradiance_normal_w_m2_nm").iter().zip(outside) {
        assert!(*here > 0.0 && *here < outside);
    }
    assert!(number(&answer["sky"], "illuminance_horizontal_lx") > 3000.0);
}

#[test]
fn place_and_time_tell_the_suns_distance() {
    let folder = Folder::new();
    let words = "--wavelengths rgb --scattering single --at 0,0 --when 2026-01-03T12:00:00Z";
    let (near, mean) = (
        json(&folder, words),
        json(
            &folder,
            "--wavelengths rgb --scattering single --sun-elevation 67",
        ),
    );
    let outside = |answer: &Value| list(&answer["sun"], "irradiance_outside_w_m2_nm")[1];
    assert!((outside(&near) / outside(&mean) - 1.0344).abs() < 1e-3);
    assert_eq!(near["observer"]["time_utc"], "2026-01-03T12:00:00Z");
    assert_eq!(near["observer"]["altitude_m"], 2.0);
    assert!(
        number(&near["sun"], "angular_radius_deg") > number(&mean["sun"], "angular_radius_deg")
    );
    let lifted =
        number(&near["sun"], "elevation_deg") - number(&near["sun"], "geometric_elevation_deg");
    assert!(lifted > 0.0 && lifted < 0.02);
    let straight = json(&folder, &format!("{words} --refraction false"));
    assert_eq!(
        straight["sun"]["elevation_deg"],
        straight["sun"]["geometric_elevation_deg"]
    );
}

#[test]
fn csv_and_json_tell_the_same() {
    let folder = Folder::new();
    std::fs::write(
        folder.file("v.csv"),
        "azimuth_deg,elevation_deg,distance_m\n10,20,\n30,1,5000\n",
    )
    .unwrap();
    let words = "--wavelengths rgb --scattering single --sun-elevation 20 --views v.csv";
    let answer = json(&folder, words);
    let csv = succeed(&folder, &format!("probe --format csv {words}"));
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
        let view = &answer["views"][index / 3];
        for key in [
            "radiance_w_m2_sr_nm",
            "radiance_single_w_m2_sr_nm",
            "transmittance",
        ] {
            let value: f64 = line[column(key)].parse().unwrap();
            assert!((value - list(view, key)[index % 3]).abs() <= 1e-6 * value.abs());
        }
        assert_eq!(
            line[column("distance_m")],
            if index < 3 { "" } else { "5000" }
        );
    }
    let table = succeed(&folder, &format!("probe {words}"));
    assert!(
        table.contains("over 5000 m") && table.contains("to space") && table.contains("luminance")
    );
}

#[test]
fn views_come_from_standard_input_and_answers_go_to_files() {
    let folder = Folder::new();
    let words = "probe --wavelengths rgb --scattering single --sun-elevation 20 --views - --format json -o a.json";
    let mut child = command(&folder, words)
        .stdin(Stdio::piped())
        .spawn()
        .unwrap();
    child
        .stdin
        .take()
        .unwrap()
        .write_all(b"elevation_deg,azimuth_deg\n45,180\n")
        .unwrap();
    assert!(child.wait().unwrap().success());
    let answer: Value =
        serde_json::from_slice(&std::fs::read(folder.file("a.json")).unwrap()).unwrap();
    assert_eq!(answer["views"][0]["azimuth_deg"], 180.0);
    assert_eq!(folder.names(), ["a.json"]);
}

#[test]
fn extremes_are_answered_with_numbers() {
    let folder = Folder::new();
    for words in [
        "--wavelengths rgb --scattering single --sun-elevation 90 --view 0,90 --view 0,-90 --view 0,0",
        "--wavelengths rgb --scattering single --sun-elevation -90 --view 0,90 --view 0,-90",
        "--wavelengths rgb --sun-elevation 0 --view 180,0 --view 0,0 --view 180,0.1",
        "--wavelengths rgb --scattering single --sun-elevation 10 --altitude-m 400e3 --view 180,-20 --view 0,90 --view 180,-89",
        "--wavelengths rgb --scattering single --sun-elevation 10 --altitude-m 1e9 --view 180,-90 --view 0,0",
        "--wavelengths rgb --sun-elevation 10 --altitude-m -400 --view 180,1 --view 0,-5",
        "--wavelengths rgb --scattering single --sun-elevation 10 --ground-altitude-m 4000 --view 180,1 --distance-m 1e9",
        "--wavelengths rgb --scattering single --sun-elevation 10 --aod-550 0 --ozone-du 0 --ground-albedo 0 --view 180,1 --view 180,10",
        "--wavelengths rgb --sun-elevation 10 --aod-550 50 --view 180,1 --view 180,10",
        "--scattering single --sun-elevation 10 --wavelengths 300,900 --view 180,1e-9",
        "--wavelengths rgb --scattering single --sun-elevation 10 --view 1e300,5 --view -720.5,5 --distance-m 1e-9",
    ] {
        let output = run(&folder, &format!("probe --format json {words}"));
        let error = String::from_utf8_lossy(&output.stderr);
        assert!(output.status.success(), "{words}: {error}");
        let text = String::from_utf8(output.stdout).unwrap();
        let answer: Value = serde_json::from_str(&text).unwrap();
        for view in answer["views"].as_array().unwrap() {
            for key in ["radiance_w_m2_sr_nm", "transmittance", "xyz_cd_m2"] {
                // Not-a-number would be null.
                assert!(
                    list(view, key).iter().all(|v| v.is_finite() && *v >= -1e-9),
                    "{words}: {key} {view}"
                );
            }
        }
        assert!(
            number(&answer["sky"], "illuminance_horizontal_lx").is_finite(),
            "{words}"
        );
    }
}

#[test]
fn the_sky_article_is_told_as_it_was_printed() {
    let folder = Folder::new();
    // Its constants, its eye height of 1 m; colours are all that it knows.
    let words = "--solver single-scattering --variant printed --sun-elevation 45 --eye-height-m 1 --view 180,45";
    let answer = json(&folder, words);
    assert_eq!(answer["solver"], "single-scattering");
    assert_eq!(answer["variant"], "printed");
    assert_eq!(answer["scattering"], "single");
    assert!(answer["atmosphere"].is_null());
    let view = &answer["views"][0];
    for (told, printed) in list(view, "rgb_cd_m2").iter().zip([3652.0, 4655.0, 7169.0]) {
        assert!((told - printed).abs() < 1.0, "{told} {printed}");
    }
    assert_eq!(list(&answer, "wavelengths_nm"), [0.0; 0]);
    assert_eq!(list(view, "radiance_w_m2_sr_nm"), [0.0; 0]);
    assert!(view["transmittance"].is_null() && view["radiance_single_w_m2_sr_nm"].is_null());
    assert!(number(&answer["sun"], "illuminance_normal_lx") > 1e5);
    let converged = json(&folder, &words.replace("printed", "corrected"));
    for (told, right) in list(&converged["views"][0], "rgb_cd_m2")
        .iter()
        .zip([10878.0, 11659.0, 13903.0])
    {
        assert!((told / right - 1.0).abs() < 1e-3, "{told} {right}");
    }
    let table = succeed(&folder, &format!("probe {words}"));
    assert!(table.contains("single-scattering, printed; it knows colours, and no spectra"));
    let csv = succeed(&folder, &format!("probe --format csv {words}"));
    let lines: Vec<Vec<&str>> = csv.lines().map(|line| line.split(',').collect()).collect();
    assert_eq!(lines.len(), 2);
    assert_eq!(lines[0].len(), lines[1].len());
    assert!(lines[0].ends_with(&["solver", "variant"]));
    assert!(lines[1].ends_with(&["single-scattering", "printed"]));
}

#[test]
fn spectra_of_1987_make_its_colours_and_its_light() {
    let folder = Folder::new();
    let words = "--solver klassen1987 --sun-elevation 30 --view 180,10 --view 0,60 --view 90,-20";
    let answer = json(&folder, words);
    let nm = list(&answer, "wavelengths_nm");
    assert_eq!((nm.len(), nm[0], nm[32]), (33, 380.0, 700.0));
    let grid = airlight::models::klassen1987::wavelength_grid();
    let colour = |spectrum: Vec<f64>| {
        let lanes: Vec<f32> = spectrum.iter().map(|&v| v as f32).collect();
        grid.to_xyz(&lanes)
    };
    for view in answer["views"].as_array().unwrap() {
        let told = list(view, "xyz_cd_m2");
        for (a, b) in colour(list(view, "radiance_w_m2_sr_nm")).iter().zip(told) {
            assert!((a / b - 1.0).abs() < 1e-6, "{a} {b}");
        }
    }
    assert_eq!(answer["views"][2]["meets_ground"], true);
    let (sun, sky) = (&answer["sun"], &answer["sky"]);
    for (value, irradiance, illuminance) in [
        (sun, "irradiance_normal_w_m2_nm", "illuminance_normal_lx"),
        (
            sun,
            "irradiance_horizontal_w_m2_nm",
            "illuminance_horizontal_lx",
        ),
        (
            sky,
            "irradiance_horizontal_w_m2_nm",
            "illuminance_horizontal_lx",
        ),
    ] {
        let lx = colour(list(value, irradiance))[1];
        assert!((lx / number(value, illuminance) - 1.0).abs() < 1e-6);
    }
    let outside = list(sun, "irradiance_outside_w_m2_nm");
    let here = list(sun, "irradiance_normal_w_m2_nm");
    assert!(here.iter().zip(outside).all(|(e, o)| *e > 0.0 && *e < o));
}

#[test]
fn models_with_lines_tell_their_parts() {
    let folder = Folder::new();
    for solver in ["hillaire2020", "bruneton2008"] {
        let words = format!(
            "--solver {solver} --wavelengths rgb --sun-elevation 30 --view 180,2 --view 0,-30 --view 90,1"
        );
        let whole = json(&folder, &words);
        for view in whole["views"].as_array().unwrap() {
            let parts = ["single", "multiple", "ground"]
                .map(|part| list(view, &format!("radiance_{part}_w_m2_sr_nm")));
            for (lane, all) in list(view, "radiance_w_m2_sr_nm").into_iter().enumerate() {
                let sum: f64 = parts.iter().map(|part| part[lane]).sum();
                assert!((all / sum - 1.0).abs() < 1e-5);
            }
        }
        assert_eq!(whole["views"][1]["meets_ground"], true);
        // The air before a thing: less than all of it, and it lets through more.
        let near = json(&folder, &format!("{words} --distance-m 20e3"));
        let (near, far) = (&near["views"][2], &whole["views"][2]);
        let lists = |key| list(near, key).into_iter().zip(list(far, key));
        assert!(lists("radiance_w_m2_sr_nm").all(|(n, f)| n > 0.0 && n < f));
        assert!(lists("transmittance").all(|(n, f)| n > f && n < 1.0));
    }
    // As often as asked: once.
    let words =
        "--solver hillaire2020 --scattering single --wavelengths rgb --sun-elevation 30 --view 0,9";
    let once = json(&folder, words);
    assert_eq!(once["scattering"], "single");
    assert_eq!(
        list(&once["views"][0], "radiance_multiple_w_m2_sr_nm"),
        [0.0; 3]
    );
}

#[test]
fn the_suns_distance_dims_models_with_spectra() {
    let folder = Folder::new();
    let january = "--at 0,0 --when 2026-01-03T12:00:00Z --wavelengths rgb --view 0,60";
    let ours = json(&folder, january);
    for solver in ["klassen1987", "hillaire2020", "bruneton2008"] {
        let answer = json(&folder, &format!("{january} --solver {solver}"));
        let sun = &answer["sun"];
        let outside = list(sun, "irradiance_outside_w_m2_nm");
        let at = usize::from(solver == "klassen1987") * 6;
        let right = list(&ours["sun"], "irradiance_outside_w_m2_nm")[0];
        // 440 nm, of means over more or less of the spectrum.
        assert!((outside[at] / right - 1.0).abs() < 0.05, "{solver}");
        assert!(
            (number(sun, "angular_radius_deg") / number(&ours["sun"], "angular_radius_deg") - 1.0)
                .abs()
                < 1e-9
        );
    }
}

#[test]
fn models_refuse_what_they_cannot_tell() {
    let folder = Folder::new();
    std::fs::write(
        folder.file("v.csv"),
        "azimuth_deg,elevation_deg,distance_m\n10,20,\n30,1,5000\n",
    )
    .unwrap();
    for (words, part) in [
        ("klassen1987 --view 0,9 --distance-m 50", "hillaire2020"),
        ("preetham --views v.csv", "distance_m in --views"),
        ("preetham --variant printed --view 0,9", "one form only"),
        ("orders --variant printed --view 0,9", "published models"),
        ("preetham --polarisation --view 0,9", "monte-carlo"),
        ("preetham --turbidity 1.2 --view 0,9", "from 2 to 10"),
        (
            "klassen1987 --altitude-m 5000 --view 0,9",
            "from the ground",
        ),
    ] {
        let output = run(
            &folder,
            &format!("probe --sun-elevation 20 --solver {words}"),
        );
        let error = String::from_utf8_lossy(&output.stderr);
        assert_eq!(output.status.code(), Some(2), "{words}: {error}");
        assert!(error.contains(part), "{words}: {error}");
    }
}
