//! `airlight sky` as a user meets it: files, reports, scenes, preview.

use crate::common::{Exr, Folder, command, number_after, run, succeed};

/// Options that solve quickly.
const QUICK: &str = "--wavelengths rgb --scattering single";

#[test]
fn a_picture_is_written_and_reported() {
    let folder = Folder::new();
    let text = succeed(
        &folder,
        "sky --at 48.8584,2.2945 --when 2026-06-21T21:15:00+02:00 --wavelengths rgb --size 32x16 -o a.exr",
    );
    assert!((number_after(&text, "elevation") - 5.171).abs() < 0.002);
    assert!((number_after(&text, "azimuth") - 300.426).abs() < 0.002);
    assert!(number_after(&text, "horizontal; sky") > 1000.0);
    for part in ["to solve", "to draw", "a.exr: 32 x 16", "float EXR"] {
        assert!(text.contains(part), "{text}");
    }
    let picture = Exr::read(&folder.file("a.exr"));
    assert!(picture.texts["command"].starts_with("airlight sky --at 48.8584,2.2945"));
    let words = format!("sky {QUICK} --sun-elevation 30 --size 16x8 -q -o b.png");
    assert_eq!(succeed(&folder, &words), "");
}

#[test]
fn clipped_samples_are_noted() {
    let folder = Folder::new();
    let words = format!("sky {QUICK} --sun-elevation 30 --size 64x32 --precision half");
    let output = run(&folder, &format!("{words} -o a.exr"));
    assert!(output.status.success());
    assert!(String::from_utf8_lossy(&output.stderr).contains("--precision float"));
    let output = run(&folder, &format!("{words} --scale 1e-5 -o b.exr"));
    assert!(output.stderr.is_empty());
}

#[test]
fn the_preview_paints_where_the_terminal_can() {
    let folder = Folder::new();
    let words = format!("sky {QUICK} --sun-elevation 30 --preview --color-space acescg");
    let output = command(&folder, &words)
        .env("COLORTERM", "truecolor")
        .output()
        .unwrap();
    let text = String::from_utf8(output.stdout).unwrap();
    assert!(
        text.contains("\u{2580}") && text.contains("\x1b[38;2;") && text.contains("illuminance")
    );
    let output = run(&folder, &words);
    assert_eq!(output.status.code(), Some(2));
    assert!(String::from_utf8_lossy(&output.stderr).contains("colours"));
}

/// A scene that is saved draws the same picture again, and options override it.
#[test]
fn scenes_are_saved_read_and_overridden() {
    let folder = Folder::new();
    std::fs::write(
        folder.file("sphere.toml"),
        "[[object]]\nshape = \"sphere\"\nat_m = [0, 3, -20]\nradius_m = 2\n",
    )
    .unwrap();
    std::fs::write(
        folder.file("air.toml"),
        "base = \"clear\"\n[aerosol]\naod_550 = 0.1\n",
    )
    .unwrap();
    let words = format!(
        "sky {QUICK} --sun-elevation 30 --atmosphere air.toml --ozone-du 250 --objects sphere.toml --projection perspective \
         --size 32x18 --camera-azimuth 0 --visibility-m 900 --top-m 30 --sun-disc out -q"
    );
    succeed(
        &folder,
        &format!("{words} -o a.exr --save-scene scene.toml"),
    );
    let text = std::fs::read_to_string(folder.file("scene.toml")).unwrap();
    for part in [
        "elevation_deg = 30",
        "ozone_du = 250",
        "visibility_m = 900",
        "radius_m = 2",
    ] {
        assert!(text.contains(part), "{part}: {text}");
    }
    // Complete: without the files that it was made from.
    std::fs::remove_file(folder.file("sphere.toml")).unwrap();
    std::fs::remove_file(folder.file("air.toml")).unwrap();
    succeed(&folder, "sky --scene scene.toml -q -o b.exr");
    let [a, b] = ["a.exr", "b.exr"].map(|name| Exr::read(&folder.file(name)));
    assert!(a.channels == b.channels);
    succeed(
        &folder,
        "sky --scene scene.toml --sun-elevation 10 -q -o c.exr",
    );
    assert!(a.channels != Exr::read(&folder.file("c.exr")).channels);
    // Without a picture.
    succeed(
        &folder,
        &format!(
            "{} --save-scene d.toml",
            words
                .replace("--atmosphere air.toml", "")
                .replace("--objects sphere.toml", "")
        ),
    );
    assert!(folder.names("").contains(&"d.toml".to_owned()));
}

#[test]
fn sequences_report_what_they_made() {
    let folder = Folder::new();
    let words = format!(
        "sky {QUICK} --at 50,10 --when 2026-06-21T18:00:00+02:00 --every 1h --until +2h --size 16x8 -o a.png"
    );
    assert!(succeed(&folder, &words).contains("3 of 3 pictures written"));
    std::fs::remove_file(folder.file("a.0002.png")).unwrap();
    // What a killed run leaves: numbers of processes are below 2^22.
    let left = folder.file(format!(".a.0002.png.{}-0.part", u32::MAX));
    std::fs::write(&left, "").unwrap();
    let text = succeed(&folder, &words);
    assert!(left.exists() != cfg!(target_os = "linux"));
    assert!(
        text.contains("1 of 3 pictures written, 2 existed already"),
        "{text}"
    );
    assert!(succeed(&folder, &format!("{words} --overwrite")).contains("3 of 3 pictures written"));
    let other = run(&folder, &words.replace("16x8", "32x16"));
    let said = String::from_utf8_lossy(&other.stderr);
    assert_eq!(other.status.code(), Some(2), "{said}");
    assert!(
        said.contains("camera.size was [16,8], is [32,16]"),
        "{said}"
    );
    // Shards draw the same pictures; the command in their metadata is their own.
    let pixels = |name: &str| image::open(folder.file(name)).unwrap().into_rgb8();
    let whole = ["a.0001.png", "a.0002.png", "a.0003.png"].map(pixels);
    let parts = words.replace("a.png", "b.png");
    for (shard, said) in [
        ("1/2", "2 of 2 pictures in shard 1/2"),
        ("2/2", "1 of 1 picture in shard 2/2"),
    ] {
        let text = succeed(&folder, &format!("{parts} --shard {shard}"));
        assert!(text.contains(said), "{text}");
    }
    assert!(
        folder
            .names("")
            .contains(&"manifest-1-of-2.jsonl".to_owned())
    );
    assert_eq!(
        ["b.0001.png", "b.0002.png", "b.0003.png"].map(pixels),
        whole
    );
    let one = format!("sky {QUICK} --sun-elevation 20 --manifest m.jsonl -o c.png");
    let refused = run(&folder, &one);
    let said = String::from_utf8_lossy(&refused.stderr);
    assert_eq!(refused.status.code(), Some(2));
    assert!(said.contains("--until with --every"), "{said}");
}

#[test]
fn threads_change_nothing() {
    let folder = Folder::new();
    let words = format!(
        "sky {QUICK} --sun-elevation 20 --size 16x8 --solver monte-carlo --paths 128 --noise-map --polarisation -q"
    );
    let words = words.replace(" --scattering single", "");
    succeed(&folder, &format!("{words} --threads 1 -o a.exr"));
    succeed(&folder, &format!("{words} --threads 2 -o b.exr"));
    for part in ["", ".noise", ".polarisation"] {
        let [a, b] = ["a", "b"].map(|name| Exr::read(&folder.file(format!("{name}{part}.exr"))));
        assert!(a.channels == b.channels, "{part}");
    }
}

#[test]
fn the_schema_is_json() {
    let schema: serde_json::Value =
        serde_json::from_str(&succeed(&Folder::new(), "schema")).unwrap();
    assert!(schema["properties"]["sun"].is_object(), "{schema}");
}
