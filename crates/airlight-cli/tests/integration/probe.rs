//! `airlight probe` as a user meets it.

use crate::common::{Folder, command, run, succeed};
use serde_json::Value;
use std::io::Write;
use std::process::Stdio;

const QUICK: &str = "probe --wavelengths rgb --scattering single --sun-elevation 20";

#[test]
fn json_csv_and_table_say_the_same() {
    let folder = Folder::new();
    std::fs::write(
        folder.file("v.csv"),
        "azimuth_deg,elevation_deg,distance_m\n10,20,\n30,1,5000\n",
    )
    .unwrap();
    let words = format!("{QUICK} --views v.csv");
    let answer: Value =
        serde_json::from_str(&succeed(&folder, &format!("{words} --format json"))).unwrap();
    assert_eq!(answer["format"], "airlight-probe/1");
    assert_eq!(answer["views"][1]["distance_m"], 5000.0);
    let csv = succeed(&folder, &format!("{words} --format csv"));
    assert_eq!(csv.lines().count(), 7);
    let table = succeed(&folder, &words);
    for part in [
        "over 5000 m",
        "to space",
        "luminance",
        "solver        orders",
    ] {
        assert!(table.contains(part), "{part}: {table}");
    }
    let table = succeed(
        &folder,
        "probe --solver single-scattering --variant printed --sun-elevation 45 --view 180,45",
    );
    assert!(table.contains("single-scattering, printed; colours only, no spectra"));
}

#[test]
fn views_come_from_standard_input_and_answers_go_to_files() {
    let folder = Folder::new();
    let words = format!("{QUICK} --views - --format json -o a.json");
    let mut child = command(&folder, &words)
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
    assert_eq!(folder.names(""), ["a.json"]);
}

#[test]
fn a_scene_is_probed_with_its_fog() {
    let folder = Folder::new();
    let scene = "sun.elevation_deg = 20\nsolver.wavelengths = \"rgb\"\nfog = { visibility_m = 200, top_m = 30 }\n";
    std::fs::write(folder.file("scene.toml"), scene).unwrap();
    let luminance = |words: &str| {
        let words = format!("probe --scene scene.toml --format json --view 0,3 {words}");
        let answer: Value = serde_json::from_str(&succeed(&folder, &words)).unwrap();
        answer["views"][0]["luminance_cd_m2"].as_f64().unwrap()
    };
    // The same fog from the options, and a thinner one over it.
    let words = "probe --sun-elevation 20 --wavelengths rgb --visibility-m 200 --top-m 30 --format json --view 0,3";
    let answer: Value = serde_json::from_str(&succeed(&folder, words)).unwrap();
    let dense = luminance("");
    assert_eq!(answer["views"][0]["luminance_cd_m2"].as_f64(), Some(dense));
    assert!((luminance("--visibility-m 5000") / dense - 1.0).abs() > 0.05);
}

#[test]
fn bad_use_is_refused() {
    let folder = Folder::new();
    std::fs::write(
        folder.file("views.csv"),
        "azimuth_deg,elevation_deg\n1,2\n1,b\n",
    )
    .unwrap();
    for (words, code, part) in [
        ("probe --view 0,90", 2, "--sun-elevation"),
        ("probe --sun-elevation 30 --format csv", 2, "--view"),
        ("probe --sun-elevation 30 --view 0,91", 2, "-90 to 90"),
        ("probe --sun-elevation 30 --view 0", 2, "azimuth,elevation"),
        (
            "probe --sun-elevation 30 --view 0,nan",
            2,
            "azimuth,elevation",
        ),
        (
            "probe --sun-elevation 30 --views views.csv",
            2,
            "line 3: elevation_deg",
        ),
        (
            "probe --sun-elevation 30 --view 0,9 --distance-m 0",
            2,
            "above 0",
        ),
        ("probe --sun-elevation 30 --format xml", 2, "json"),
        (
            "probe --sun-elevation 30 --views none.csv",
            1,
            "cannot read",
        ),
        (
            "probe --sun-elevation 30 -o missing/a.json",
            1,
            "there is no folder",
        ),
    ] {
        let output = run(&folder, words);
        let error = String::from_utf8_lossy(&output.stderr);
        assert_eq!(output.status.code(), Some(code), "{words}: {error}");
        assert!(error.contains(part), "{words}: {error}");
        assert_eq!(folder.names(""), ["views.csv"], "{words}");
    }
}
