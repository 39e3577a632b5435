//! `airlight fog` over many pictures: pairs, resuming, variation, the manifest, and what is refused.

mod common;

use common::{Folder, command, run, succeed};
use serde_json::{Map, Value};
use std::collections::BTreeMap;
use std::path::Path;

/// A folder with pictures `rgb/NAME.png` and depths `depth/NAME.png`.
fn pictures(names: &[&str]) -> Folder {
    let folder = Folder::new();
    for (number, name) in (1..).zip(names) {
        picture(&folder.file(&format!("rgb/{name}.png")), (40, 30), number);
        depth(&folder.file(&format!("depth/{name}.png")), (40, 30));
    }
    folder
}

fn picture(path: &Path, (width, height): (u32, u32), number: u8) {
    std::fs::create_dir_all(path.parent().unwrap()).unwrap();
    let colour = |x, y| image::Rgb([(x * 5) as u8, (y * 7) as u8, 20 * number]);
    image::RgbImage::from_fn(width, height, colour)
        .save(path)
        .unwrap();
}

fn depth(path: &Path, (width, height): (u32, u32)) {
    std::fs::create_dir_all(path.parent().unwrap()).unwrap();
    let millimetres = |x, y| image::Luma([(2000 + 100 * x + 50 * y) as u16]);
    image::ImageBuffer::from_fn(width, height, millimetres)
        .save(path)
        .unwrap();
}

const WORDS: &str = "fog rgb/*.png --depth depth/*.png --depth-scale 0.001 -o out/*.png";

/// The lines of a manifest, by output.
fn manifest(path: &Path) -> BTreeMap<String, Map<String, Value>> {
    let text = std::fs::read_to_string(path).unwrap();
    assert!(text.ends_with('\n'));
    let lines: Vec<Map<String, Value>> = text
        .lines()
        .map(|line| serde_json::from_str(line).unwrap())
        .collect();
    let count = lines.len();
    let by_output: BTreeMap<_, _> = lines
        .into_iter()
        .map(|line| (line["output"].as_str().unwrap().to_owned(), line))
        .collect();
    assert_eq!(by_output.len(), count, "an output has two lines");
    by_output
}

/// The names in a subfolder, hidden ones too.
fn names(folder: &Folder, below: &str) -> Vec<String> {
    let mut names: Vec<String> = std::fs::read_dir(folder.file(below))
        .unwrap()
        .map(|entry| entry.unwrap().file_name().into_string().unwrap())
        .collect();
    names.sort();
    names
}

fn bytes(folder: &Folder, name: &str) -> Vec<u8> {
    std::fs::read(folder.file(name)).unwrap()
}

/// Runs what must fail, and returns the sentence.
fn fails(folder: &Folder, words: &str, code: i32) -> String {
    let output = run(folder, words);
    let text = String::from_utf8(output.stderr).unwrap();
    assert_eq!(output.status.code(), Some(code), "{words}: {text}");
    text
}

/// Runs what must be refused before anything is written.
fn refused(folder: &Folder, words: &str, code: i32) -> String {
    let before = folder.names();
    let text = fails(folder, words, code);
    assert_eq!(folder.names(), before, "{words} left something behind");
    text
}

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
fn what_does_not_pair_is_refused_with_what_would_be_right() {
    let folder = pictures(&["a", "b", "c"]);
    std::fs::remove_file(folder.file("depth/b.png")).unwrap();
    depth(&folder.file("depth/z.png"), (40, 30));
    for words in [WORDS, "fog rgb --depth depth -o out --depth-scale 0.001"] {
        let text = refused(&folder, &format!("{words} --visibility-m 8"), 1);
        assert!(
            text.contains("1 of 3 pictures have no depth")
                && text.contains("`rgb/b.png`: there is no `depth/b"),
            "{text}"
        );
    }
    let output = run(
        &folder,
        &format!("{WORDS} --visibility-m 8 --skip-unpaired"),
    );
    assert!(output.status.success());
    let text = String::from_utf8(output.stderr).unwrap();
    assert!(text.contains("depth/z.png"), "{text}");
    assert_eq!(names(&folder, "out"), ["a.png", "c.png", "manifest.jsonl"]);
    std::fs::write(folder.file("depth/c.npy"), "").unwrap();
    let text = fails(&folder, "fog rgb --depth depth -o out --visibility-m 8", 1);
    assert!(text.contains("could both be its depth"), "{text}");
}

#[test]
fn what_makes_no_sense_is_refused() {
    let folder = pictures(&["a", "b"]);
    picture(&folder.file("twice/a.png"), (40, 30), 1);
    picture(&folder.file("twice/a.jpg"), (40, 30), 1);
    std::fs::create_dir(folder.file("empty")).unwrap();
    let depth = "--depth depth/a.png";
    for (words, code, sentence) in [
        (
            "fog none/*.png -o out/*.png --visibility-m 8",
            1,
            "cannot read the folder",
        ),
        (
            "fog rgb/*.tif -o out/*.png --visibility-m 8",
            1,
            "names no picture",
        ),
        ("fog empty -o out --visibility-m 8", 1, "names no picture"),
        (
            "fog rgb/*.png --depth depth/*_*.png -o out/*.png --visibility-m 8",
            2,
            "open parts",
        ),
        (
            &format!("fog rgb/*.png {depth} -o out/*/*.png --visibility-m 8"),
            2,
            "open parts",
        ),
        (
            &format!("fog rgb/*.png {depth} -o out/***.png --visibility-m 8"),
            2,
            "put text between",
        ),
        (
            &format!("fog rgb/*.png {depth} -o out.png --visibility-m 8"),
            2,
            "many pictures cannot all be",
        ),
        (
            &format!("fog rgb/*.png {depth} -o out/*.tif --visibility-m 8"),
            2,
            "Known endings",
        ),
        (
            &format!("fog rgb/*.png {depth} -o rgb/*.png --visibility-m 8"),
            2,
            "written over",
        ),
        (
            &format!("fog rgb/*.png {depth} -o rgb/*_fog.png --visibility-m 8"),
            2,
            "the next time",
        ),
        (
            &format!("fog twice/a.* {depth} -o out/a_*.png --vary visibility=8,9 --layers"),
            2,
            ".exr",
        ),
        (
            &format!("fog twice/** {depth} -o out/x{{variant}}/** --visibility-m 8"),
            2,
            "Known endings",
        ),
        (
            &format!("fog rgb {depth} -o out --visibility-m 8 --manifest twice/a.png"),
            1,
            "manifest of pictures",
        ),
        (
            &format!("fog twice {depth} -o out --visibility-m 8"),
            2,
            "both called `a`",
        ),
        (&format!("{WORDS} --visibility-m 8 --jobs 0"), 2, "--jobs"),
        (
            &format!("{WORDS} --visibility-m 8 --variants 2"),
            2,
            "--vary",
        ),
        (
            &format!("{WORDS} --vary visibility=500..50"),
            2,
            "smaller to a greater number: 50..500",
        ),
        (&format!("{WORDS} --vary visibility=-5..50"), 2, "above 0"),
        (&format!("{WORDS} --vary visibility=0..50"), 2, "above 0"),
        (&format!("{WORDS} --vary visibility=nan..50"), 2, "above 0"),
        (
            &format!("{WORDS} --vary visibility=cubic:5..50"),
            2,
            "uniform: and log:",
        ),
        (&format!("{WORDS} --vary visibility"), 2, "NAME=LOW..HIGH"),
        (
            &format!("{WORDS} --vary fogginess=1..2"),
            2,
            "visibility, scale-height, base-height",
        ),
        (
            &format!("{WORDS} --vary sun-elevation=-5..20 --visibility-m 5"),
            2,
            "above 0",
        ),
        (
            &format!("{WORDS} --vary sun-azimuth=0..20 --visibility-m 5"),
            2,
            "needs a sun",
        ),
        (
            &format!("{WORDS} --vary base-height=log:0..20 --visibility-m 5"),
            2,
            "logarithms",
        ),
        (
            &format!("{WORDS} --vary model=uniform,thick --visibility-m 5"),
            2,
            "foggy-cityscapes",
        ),
        (
            &format!("{WORDS} --vary visibility=5..9 --vary visibility-m=5..9"),
            2,
            "twice",
        ),
        (
            &format!("{WORDS} --vary visibility=5..9 --visibility-m 5"),
            2,
            "leave one out",
        ),
        (&format!("{WORDS} --vary top=5..9"), 2, "--visibility-m"),
        (WORDS, 2, "--visibility-m"),
    ] {
        let text = refused(&folder, words, code);
        assert!(text.contains(sentence), "{words}: {text}");
    }
    for name in ["x_y/z", "x/y_z"] {
        picture(&folder.file(&format!("deep/{name}.png")), (40, 30), 1);
    }
    let words = format!("fog deep/*/*.png {depth} -o out/*_*.png --visibility-m 8");
    let text = refused(&folder, &words, 2);
    assert!(text.contains("would both become `out/x_y_z.png`"), "{text}");
}

#[cfg(unix)]
#[test]
fn folders_and_names_that_cannot_be_are_told() {
    use std::os::unix::ffi::OsStrExt;
    let folder = pictures(&["a"]);
    std::fs::write(folder.file("file"), "").unwrap();
    let words = format!("{WORDS} --visibility-m 8").replace("out/", "file/out/");
    let text = refused(&folder, &words, 1);
    assert!(text.contains("cannot make the folder `file/out`"), "{text}");
    let words = format!("{WORDS} --visibility-m 8 --manifest rgb");
    let text = fails(&folder, &words, 1);
    assert!(text.contains("manifest `rgb`"), "{text}");
    let odd = std::ffi::OsStr::from_bytes(b"\xff.png");
    std::fs::copy(folder.file("rgb/a.png"), folder.file("rgb").join(odd)).unwrap();
    let text = fails(&folder, &format!("{WORDS} --visibility-m 8"), 1);
    assert!(text.contains("not Unicode"), "{text}");
}

#[test]
fn names_that_need_escaping_are_told_as_they_are() {
    let name = "a \"quoted\" \\ \u{e9}t\u{e9}";
    let folder = pictures(&[name]);
    succeed(&folder, &format!("{WORDS} --visibility-m 8"));
    let lines = manifest(&folder.file("out/manifest.jsonl"));
    assert_eq!(lines[&format!("{name}.png")]["name"], name);
}

#[test]
fn two_runs_do_not_work_on_one_manifest() {
    let folder = pictures(&["a"]);
    std::fs::create_dir(folder.file("out")).unwrap();
    let held = std::fs::File::create(folder.file("out/manifest.jsonl")).unwrap();
    held.lock().unwrap();
    let output = command(&folder, &format!("{WORDS} --visibility-m 8"))
        .output()
        .unwrap();
    let text = String::from_utf8(output.stderr).unwrap();
    assert_eq!(output.status.code(), Some(1), "{text}");
    assert!(text.contains("another run"), "{text}");
}
