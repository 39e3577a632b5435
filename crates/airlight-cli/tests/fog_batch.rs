//! `airlight fog` over many pictures: pairs, resuming, variation, the manifest.

mod common;

use common::batch::*;
use common::succeed;
use std::collections::BTreeMap;

#[test]
fn a_batch_makes_what_single_runs_make() {
    let folder = pictures(&["a", "b", "c"]);
    let text = succeed(&folder, &format!("{WORDS} --visibility-m 8"));
    assert!(text.contains("3 of 3 pictures made"), "{text}");
    assert_eq!(
        names(&folder, "out"),
        ["a.png", "b.png", "c.png", "manifest.jsonl"]
    );
    for name in ["a", "b", "c"] {
        succeed(
            &folder,
            &format!(
                "fog rgb/{name}.png --depth depth/{name}.png --depth-scale 0.001 --visibility-m 8 -o one.png"
            ),
        );
        assert_eq!(
            bytes(&folder, "one.png"),
            bytes(&folder, &format!("out/{name}.png"))
        );
    }
    let lines = manifest(&folder.file("out/manifest.jsonl"));
    let line = &lines["b.png"];
    assert_eq!(line["colour"], "rgb/b.png");
    assert_eq!(line["depth"], "depth/b.png");
    assert_eq!(line["visibility_m"], 8.0);
    assert_eq!(line["model"], "uniform");
    assert_eq!((&line["width"], &line["height"]), (&40.into(), &30.into()));
    let extinction = line["extinction_per_m"].as_f64().unwrap();
    assert!((extinction - 20f64.ln() / 8.0).abs() < 1e-12);
    assert_eq!(line["ambient_rgb"].as_array().unwrap().len(), 3);
}

#[test]
fn folders_pair_by_name_and_patterns_by_their_parts() {
    let folder = pictures(&["a", "b"]);
    for (words, made) in [
        ("fog rgb --depth depth/ -o by_name", "by_name/a.png"),
        ("fog rgb/*.png --depth depth -o jpg/x-*.jpg", "jpg/x-b.jpg"),
        (
            "fog r*b/*.png --depth depth/a.png -o parts/*/*.png",
            "parts/g/b.png",
        ),
        (
            "fog **/a.png --depth depth/b.png -o deep/**.png",
            "deep/rgb.png",
        ),
        ("fog rgb/a.png --depth depth -o one --jobs 1", "one/a.png"),
    ] {
        succeed(
            &folder,
            &format!("{words} --visibility-m 8 --depth-scale 0.001"),
        );
        assert!(folder.file(made).is_file(), "{words}");
    }
}

#[test]
fn what_is_there_is_left_and_what_is_missing_made() {
    let folder = pictures(&["a", "b", "c"]);
    let words = format!("{WORDS} --vary visibility=5..50 --seed 7");
    succeed(&folder, &words);
    let whole: Vec<_> = ["a", "b", "c"]
        .map(|n| bytes(&folder, &format!("out/{n}.png")))
        .into();
    let told = bytes(&folder, "out/manifest.jsonl");
    std::fs::remove_file(folder.file("out/b.png")).unwrap();
    std::fs::write(folder.file("out/c.png"), "").unwrap();
    // As a kill leaves it: the last line breaks off.
    std::fs::write(folder.file("out/manifest.jsonl"), &told[..told.len() - 100]).unwrap();
    let text = succeed(&folder, &words);
    assert!(
        text.contains("2 of 3 pictures made, 1 were there already"),
        "{text}"
    );
    for (name, whole) in ["a", "b", "c"].iter().zip(&whole) {
        assert_eq!(&bytes(&folder, &format!("out/{name}.png")), whole);
    }
    assert_eq!(bytes(&folder, "out/manifest.jsonl"), told);
    assert!(succeed(&folder, &words).contains("0 of 3 pictures made"));
    assert!(succeed(&folder, &format!("{words} --overwrite")).contains("3 of 3 pictures made"));
    assert_eq!(bytes(&folder, "out/manifest.jsonl"), told);
}

#[test]
fn pictures_made_otherwise_are_not_mixed_with_new_ones() {
    let folder = pictures(&["a", "b"]);
    succeed(&folder, &format!("{WORDS} --visibility-m 8"));
    std::fs::remove_file(folder.file("out/b.png")).unwrap();
    let told = bytes(&folder, "out/manifest.jsonl");
    let text = fails(&folder, &format!("{WORDS} --visibility-m 9"), 2);
    assert!(
        text.contains("visibility_m was 8.0, is 9.0") && text.contains("--overwrite"),
        "{text}"
    );
    assert_eq!(names(&folder, "out"), ["a.png", "manifest.jsonl"]);
    assert_eq!(bytes(&folder, "out/manifest.jsonl"), told);
    let other = WORDS.replace("depth/*.png", "depth/b.png");
    let text = fails(&folder, &format!("{other} --visibility-m 8"), 2);
    assert!(
        text.contains("depth was \"depth/a.png\", is \"depth/b.png\""),
        "{text}"
    );
    // More variants are no other options.
    let vary = format!("{WORDS} --vary visibility=5..9").replace("out/", "v/");
    succeed(&folder, &format!("{vary} --variants 1"));
    let text = succeed(&folder, &format!("{vary} --variants 3"));
    assert!(text.contains("4 of 6 pictures made"), "{text}");
    // Pictures of others are not taken for done, and not written over.
    std::fs::create_dir(folder.file("mine")).unwrap();
    std::fs::write(folder.file("mine/a.png"), "mine").unwrap();
    let mine = WORDS.replace("out/", "mine/");
    let text = fails(&folder, &format!("{mine} --visibility-m 9"), 2);
    assert!(text.contains("does not know them"), "{text}");
    assert_eq!(names(&folder, "mine"), ["a.png"]);
    assert_eq!(bytes(&folder, "mine/a.png"), b"mine");
}

#[test]
fn draws_follow_from_names_not_from_threads() {
    let all: Vec<String> = (0..8).map(|n| format!("p{n}")).collect();
    let all: Vec<&str> = all.iter().map(String::as_str).collect();
    let folder = pictures(&all);
    let vary = "--vary visibility=5..50 --vary model=uniform,height --vary sun-elevation=5..60 --vary droplets=fine,coarse \
                --vary eye-height-m=uniform:1..2 --variants 2 --seed 3";
    succeed(&folder, &format!("{WORDS} {vary} --jobs 1"));
    let other = WORDS.replace("out/*.png", "two/*_{variant}.png");
    succeed(&folder, &format!("{other} {vary} --jobs 3"));
    let (one, two) = (
        manifest(&folder.file("out/manifest.jsonl")),
        manifest(&folder.file("two/manifest.jsonl")),
    );
    assert_eq!((one.len(), two.len()), (16, 16));
    let mut seen = BTreeMap::new();
    for (first, second) in one.values().zip(two.values()) {
        for option in [
            "name",
            "variant",
            "visibility_m",
            "model",
            "sun_elevation_deg",
            "eye_height_m",
            "ambient_rgb",
        ] {
            assert_eq!(first[option], second[option], "{option}");
        }
        let [first_made, second_made] = [("out", first), ("two", second)].map(|(place, line)| {
            bytes(
                &folder,
                &format!("{place}/{}", line["output"].as_str().unwrap()),
            )
        });
        assert_eq!(first_made, second_made);
        let visibility_m = first["visibility_m"].as_f64().unwrap();
        assert!((5.0..=50.0).contains(&visibility_m));
        assert_eq!(first["seed"], 3);
        *seen.entry(first["model"].to_string()).or_insert(0) += 1;
        seen.insert(visibility_m.to_string(), 1);
    }
    // Both models occur, and no visibility twice.
    assert_eq!(seen.len(), 2 + 16, "{seen:?}");
    // One picture alone draws what it draws among others.
    succeed(
        &folder,
        &format!("fog rgb/p5.png --depth depth --depth-scale 0.001 {vary} -o alone/"),
    );
    let alone = manifest(&folder.file("alone/manifest.jsonl"));
    assert_eq!(
        alone["p5_v0002.png"]["visibility_m"],
        one["p5_v0002.png"]["visibility_m"]
    );
}

#[test]
fn a_picture_that_fails_does_not_stop_the_others() {
    let folder = pictures(&["a", "b", "c", "d"]);
    let whole = bytes(&folder, "rgb/b.png");
    std::fs::write(folder.file("rgb/b.png"), &whole[..whole.len() / 2]).unwrap();
    depth(&folder.file("depth/c.png"), (41, 30));
    let words = format!("{WORDS} --visibility-m 8 -q");
    let text = fails(&folder, &words, 1);
    assert!(text.contains("2 pictures failed"), "{text}");
    assert!(
        text.contains("rgb/b.png") && text.contains("41 x 30"),
        "{text}"
    );
    assert_eq!(names(&folder, "out"), ["a.png", "d.png", "manifest.jsonl"]);
    let lines = manifest(&folder.file("out/manifest.jsonl"));
    assert_eq!(lines.len(), 4);
    let error = lines["c.png"]["error"].as_str().unwrap();
    assert!(error.contains("41 x 30") && !lines["a.png"].contains_key("error"));
    // Mended, they are made, and their lines say so.
    std::fs::write(folder.file("rgb/b.png"), whole).unwrap();
    depth(&folder.file("depth/c.png"), (40, 30));
    let text = succeed(&folder, &format!("{WORDS} --visibility-m 8"));
    assert!(text.contains("2 of 4 pictures made"), "{text}");
    let lines = manifest(&folder.file("out/manifest.jsonl"));
    assert!(lines.values().all(|line| !line.contains_key("error")));
    // Asked to, it stops at the first.
    std::fs::write(folder.file("rgb/b.png"), "").unwrap();
    let words = format!("{words} --overwrite --fail-fast --jobs 1");
    let text = fails(&folder, &words, 1);
    assert!(
        text.contains("first failure") && text.contains("0 bytes"),
        "{text}"
    );
    assert_eq!(
        manifest(&folder.file("out/manifest.jsonl"))["b.png"].get("model"),
        None
    );
}

#[test]
fn names_that_need_escaping_are_told_as_they_are() {
    let name = "a \"quoted\" \\ \u{e9}t\u{e9}";
    let folder = pictures(&[name]);
    succeed(&folder, &format!("{WORDS} --visibility-m 8"));
    let lines = manifest(&folder.file("out/manifest.jsonl"));
    assert_eq!(lines[&format!("{name}.png")]["name"], name);
}
