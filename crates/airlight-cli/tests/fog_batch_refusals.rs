//! What `airlight fog` refuses to make many pictures of.

mod common;

use common::batch::*;
use common::run;

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
        (
            &format!("{WORDS} --vary scale-height=5..9 --visibility-m 5"),
            2,
            "belongs to --model height or clamped",
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
fn two_runs_do_not_work_on_one_manifest() {
    let folder = pictures(&["a"]);
    std::fs::create_dir(folder.file("out")).unwrap();
    let held = std::fs::File::create(folder.file("out/manifest.jsonl")).unwrap();
    held.lock().unwrap();
    let text = fails(&folder, &format!("{WORDS} --visibility-m 8"), 1);
    assert!(text.contains("another run"), "{text}");
}
