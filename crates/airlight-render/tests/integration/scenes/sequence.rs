//! Sequences: names, times, resuming where an earlier run stopped.

use super::{Exr, Folder, parse};
use airlight_image::{Control, ImageError, Progress};
use airlight_render::{RenderError, Renderer};
use std::sync::atomic::{AtomicBool, Ordering};

const SCENE: &str = "solver.wavelengths = \"rgb\"\nsolver.scattering = \"single\"\ncamera.size = [16, 8]\n\
    sun = { latitude_deg = 50, longitude_deg = 10, time = \"2026-06-21T18:00:00+02:00\" }\n\
    sequence = { until = \"+3h\", every = \"1h\" }\n";

/// The names of the pictures, and the manifest.
const NAMES: [&str; 5] = [
    "a.0001.exr",
    "a.0002.exr",
    "a.0003.exr",
    "a.0004.exr",
    "manifest.jsonl",
];

#[test]
fn pictures_there_are_left_as_they_are() {
    let folder = Folder::new();
    assert_eq!(folder.write("a.exr", SCENE).len(), 4);
    assert_eq!(folder.names(""), NAMES);
    // One is missing, one is empty: both are made; the others are not touched.
    std::fs::remove_file(folder.file(NAMES[1])).unwrap();
    std::fs::write(folder.file(NAMES[2]), "").unwrap();
    std::fs::write(folder.file(NAMES[3]), "mine").unwrap();
    let manifest = || std::fs::read_to_string(folder.file("manifest.jsonl")).unwrap();
    let before = manifest();
    assert_eq!(folder.write("a.exr", SCENE).len(), 2);
    assert_eq!(std::fs::read(folder.file(NAMES[3])).unwrap(), b"mine");
    assert!(Exr::read(&folder.file(NAMES[2])).luminance(3, 1) > 0.0);
    assert!(folder.write("a.exr", SCENE).is_empty());
    assert_eq!(manifest(), before);
    let first: serde_json::Value = serde_json::from_str(before.lines().next().unwrap()).unwrap();
    assert_eq!(first["output"], "a.0001.exr");
    assert_eq!(first["scene"]["sun"]["time"], "2026-06-21T18:00:00+02:00");
    assert!(
        (first["sun_elevation_deg"].as_f64().unwrap() - 30.4).abs() < 1.0,
        "{first}"
    );
}

/// A picture that the scene would draw otherwise is not taken for its own.
#[test]
fn pictures_of_another_scene_are_refused_with_the_difference() {
    let folder = Folder::new();
    folder.write("a.exr", SCENE);
    let refused = |name: &str, scene: &str, parts: &[&str]| {
        let error = folder.try_write(name, scene).unwrap_err();
        assert!(error.is_refusal());
        let error = error.to_string();
        for part in parts {
            assert!(error.contains(part), "{part}: {error}");
        }
    };
    let wide = SCENE.replace("[16, 8]", "[32, 16]");
    let parts = [
        "4 that differ",
        "a.0004.exr",
        "camera.size was [16,8], is [32,16]",
        "overwrite",
    ];
    refused("a.exr", &wide, &parts);
    let later = SCENE.replace("18:00", "18:30");
    refused(
        "a.exr",
        &later,
        &["sun.time was \"2026-06-21T18:00:00+02:00\", is \"2026-06-21T18:30"],
    );
    let hazy = format!("{SCENE}air.aod_550 = 0.3\n");
    refused("a.exr", &hazy, &["air.aod_550 was not set, is 0.3"]);
    // A picture that the program has not drawn.
    std::fs::write(folder.file("b.0002.exr"), "mine").unwrap();
    refused("b.exr", SCENE, &["1 that are not", "b.0002.exr"]);
    assert_eq!(folder.names("").len(), NAMES.len() + 1);
    // Longer: pictures of linear light depend on no other picture, exposed ones do.
    let longer = SCENE.replace("+3h", "+4h");
    assert_eq!(folder.write("a.exr", &longer).len(), 1);
    folder.write("c.png", SCENE);
    refused("c.png", &longer, &["metered_at was [", "c.0001.png"]);
    let fixed = |scene: &str| format!("{scene}output.exposure = 12\n");
    folder.write("d.png", &fixed(SCENE));
    assert_eq!(folder.write("d.png", &fixed(&longer)).len(), 1);
}

#[test]
fn pictures_show_the_time_that_they_are_named_after() {
    let folder = Folder::new();
    folder.write(
        "s-{time}.png",
        &format!(
            "{SCENE}output.sun_disc = \"separate\"\nsequence = {{ until = \"2026-06-21T17:30:00Z\", every = \"1h\" }}"
        ),
    );
    assert_eq!(
        folder.names(""),
        [
            "manifest.jsonl",
            "s-20260621T160000Z.png",
            "s-20260621T160000Z.sun.png",
            "s-20260621T170000Z.png",
            "s-20260621T170000Z.sun.png"
        ]
    );
    folder.write("b.exr", SCENE);
    let alone = SCENE.lines().filter(|line| !line.starts_with("sequence"));
    let alone = alone
        .collect::<Vec<_>>()
        .join("\n")
        .replace("18:00", "19:00");
    let (step, alone) = (Exr::read(&folder.file("b.0002.exr")), folder.exr(&alone));
    assert_eq!(step.texts["time"], "2026-06-21T19:00:00+02:00");
    assert_eq!(step.texts["sunPosition"], alone.texts["sunPosition"]);
    // A sky prepared for all heights of the sun is that prepared for one.
    for (x, y) in [(3, 1), (8, 3), (12, 2), (5, 6)] {
        let (a, b) = (step.luminance(x, y), alone.luminance(x, y));
        assert!((a / b - 1.0).abs() < 0.01, "{x} {y}: {a} {b}");
    }
}

/// From sunlight to dusk: one exposure makes the last picture darker than one metered for itself. A picture that is drawn
/// again has the exposure of the others.
#[test]
fn pictures_share_an_exposure_unless_each_is_metered() {
    let folder = Folder::new();
    let mean = |name: &str| {
        let image = image::open(folder.file(name)).unwrap().into_rgb8();
        let sum: u64 = image.as_raw().iter().map(|&v| u64::from(v)).sum();
        sum as f64 / image.as_raw().len() as f64
    };
    folder.write("a.png", SCENE);
    folder.write(
        "b.png",
        &SCENE.replace("every =", "meter_each = true, every ="),
    );
    let (together, each) = (mean("a.0004.png"), mean("b.0004.png"));
    assert!(together < 0.5 * each, "{together} {each}");
    assert!(mean("a.0001.png") > 0.5 * mean("b.0001.png"));
    let before = std::fs::read(folder.file("a.0003.png")).unwrap();
    std::fs::remove_file(folder.file("a.0003.png")).unwrap();
    assert_eq!(folder.write("a.png", SCENE).len(), 1);
    assert!(before == std::fs::read(folder.file("a.0003.png")).unwrap());
}

/// The wind moves patches of fog with the time of the pictures.
#[test]
fn patches_drift_from_picture_to_picture() {
    let folder = Folder::new();
    let of = |name: &str, start: &str, until: &str, patches: &str| {
        let scene = SCENE.replace("18:00:00", start).replace(
            "until = \"+3h\", every = \"1h\"",
            &format!("until = \"{until}\", every = \"20s\""),
        );
        folder.write(
            name,
            &format!("{scene}fog = {{ visibility_m = 300, top_m = 40, patches = {{ seed = 3, {patches} }} }}\n"),
        );
    };
    of("a.exr", "18:00:00", "+20s", "wind_m_s = [2, 1]");
    // The same time of day and of the patches, in a sequence that begins earlier.
    of(
        "b.exr",
        "17:59:20",
        "+60s",
        "wind_m_s = [2, 1], time_s = -40",
    );
    of("still.exr", "18:00:00", "+20s", "strength = 0.5");
    let picture = |name: &str| Exr::read(&folder.file(name)).channels;
    assert!(picture("a.0001.exr") == picture("b.0003.exr"));
    assert!(picture("a.0002.exr") == picture("b.0004.exr"));
    assert!(picture("a.0001.exr") == picture("still.0001.exr"));
    let [moved, still] = ["a.0002.exr", "still.0002.exr"].map(|name| Exr::read(&folder.file(name)));
    let off = |x, y| (moved.luminance(x, y) / still.luminance(x, y) - 1.0).abs();
    let most = (0..16).map(|x| off(x, 3)).fold(0.0, f64::max);
    assert!(most > 0.01, "{most}");
}

#[test]
fn a_stopped_sequence_keeps_its_whole_pictures() {
    /// Stops as the second picture begins.
    #[derive(Default)]
    struct Stop {
        stages: std::sync::atomic::AtomicU32,
        stop: AtomicBool,
    }
    impl Progress for Stop {
        fn stage(&self, _what: &str, rows: u64) {
            if rows > 0 && self.stages.fetch_add(1, Ordering::Relaxed) == 1 {
                self.stop.store(true, Ordering::Relaxed);
            }
        }

        fn advanced(&self, _done: u64, _total: u64) {}
    }
    let folder = Folder::new();
    let mut scene = parse(SCENE);
    scene.output.file = Some(folder.file("a.png").to_str().unwrap().to_owned());
    let renderer = Renderer::new(&scene).unwrap();
    let progress = Stop::default();
    let control = Control::cancelled_by(&progress.stop).reporting_to(&progress);
    match renderer.write(control) {
        Err(RenderError::Image(ImageError::Cancelled)) => {}
        other => panic!("{other:?}"),
    }
    assert_eq!(folder.names(""), ["a.0001.png", "manifest.jsonl"]);
    assert_eq!(renderer.write(Control::default()).unwrap().len(), 3);
}

#[test]
fn sequences_that_make_no_sense_are_refused() {
    let folder = Folder::new();
    let sequence = |until: &str, every: &str| {
        format!("{SCENE}sequence = {{ until = \"{until}\", every = \"{every}\" }}")
    };
    let fixed = "solver.wavelengths = \"rgb\"\nsun.elevation_deg = 5\nsequence = { until = \"+1h\", every = \"1h\" }";
    for (scene, part) in [
        (fixed.to_owned(), "expected a sun of place and time"),
        (sequence("+1h", "5x"), "1h30m"),
        (sequence("2025-01-01T00:00:00Z", "5m"), "later"),
        (sequence("+9000d", "1s"), "1000000"),
        (
            sequence("+9000000d", "9000d"),
            "expected year from -2000 to 6000",
        ),
    ] {
        let error = folder.try_write("a.png", &scene).unwrap_err().to_string();
        assert!(error.contains(part), "{scene}: {error}");
    }
    assert!(folder.names("").is_empty());
}
