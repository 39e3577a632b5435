//! `airlight fog` from the outside: what it makes, and what it refuses.

mod common;

use common::{Folder, run};
use std::path::Path;
use std::process::Output;

fn motorcycle() -> String {
    let scene = Path::new(env!("CARGO_MANIFEST_DIR")).join("../../scenes/motorcycle");
    format!(
        "fog {0}/left.png --depth {0}/depth_mm.png --depth-scale 0.001 --focal-px 994.978 --principal-point 311.193,254.877",
        scene.display()
    )
}

fn pixels(path: &Path) -> image::RgbImage {
    image::open(path).unwrap().to_rgb8()
}

/// Runs what must be refused, and returns the sentence; nothing may be left behind.
fn refused(folder: &Folder, words: &str, code: i32) -> String {
    let before = folder.names();
    let Output { status, stderr, .. } = run(folder, words);
    let text = String::from_utf8(stderr).unwrap();
    assert_eq!(status.code(), Some(code), "{words}: {text}");
    assert_eq!(folder.names(), before, "{words} left something behind");
    text
}

#[test]
fn fog_that_is_not_there_leaves_the_picture_as_it_was() {
    let folder = Folder::new();
    let words = format!("{} --visibility-m 1e9 -o out.png", motorcycle());
    assert!(run(&folder, &words).status.success());
    let scene = Path::new(env!("CARGO_MANIFEST_DIR")).join("../../scenes/motorcycle/left.png");
    assert_eq!(pixels(&folder.file("out.png")), pixels(&scene));
}

#[test]
fn each_model_veils_what_is_far() {
    let folder = Folder::new();
    for model in [
        "uniform",
        "height",
        "clamped",
        "slab",
        "exp2",
        "linear",
        "foggy-cityscapes",
    ] {
        let words = format!(
            "{} --visibility-m 6 --model {model} --sun-elevation 30 --ambient 0.6,0.7,0.8 -q -o {model}.png",
            motorcycle()
        );
        let output = run(&folder, &words);
        assert!(
            output.status.success(),
            "{model}: {}",
            String::from_utf8_lossy(&output.stderr)
        );
        let seen = pixels(&folder.file(&format!("{model}.png")));
        // A dark place at the back of the garage has become light.
        assert!(
            seen.get_pixel(15, 60).0[0] > 110,
            "{model}: {:?}",
            seen.get_pixel(15, 60)
        );
    }
}

#[test]
fn what_makes_no_sense_is_refused_and_leaves_nothing() {
    let folder = Folder::new();
    let scene = motorcycle();
    for (more, sentence) in [
        ("--visibility-m 0 -o a.png", "above 0"),
        ("--visibility-m -5 -o a.png", "above 0"),
        ("--visibility-m 5 -o a.exr", ".png or .jpg"),
        ("--visibility-m 5 -o a.tiff", "Known endings"),
        ("--visibility-m 5 --layers -o a.png", ".exr"),
        (
            "--visibility-m 5 --sun-elevation -3 -o a.png",
            "above the horizon",
        ),
        ("--visibility-m 5 --ambient 1,2 -o a.png", "three numbers"),
        ("--visibility-m 5 --ambient=-1,2,3 -o a.png", "0 or above"),
    ] {
        let text = refused(&folder, &format!("{scene} {more}"), 2);
        assert!(text.contains(sentence), "{more}: {text}");
    }
    let text = refused(
        &folder,
        &format!("{scene} --visibility-m 5 -o none/a.png"),
        1,
    );
    assert!(text.contains("there is no folder"), "{text}");
}

#[test]
fn files_that_are_not_what_they_should_be_are_refused() {
    let folder = Folder::new();
    let small = image::RgbImage::from_pixel(40, 30, image::Rgb([90, 80, 70]));
    small.save(folder.file("small.png")).unwrap();
    let depth = |name: &str, width, height| {
        let depth = image::ImageBuffer::from_pixel(width, height, image::Luma([2000u16]));
        depth.save(folder.file(name)).unwrap();
    };
    depth("depth.png", 40, 30);
    depth("wide.png", 41, 30);
    std::fs::write(folder.file("empty.png"), []).unwrap();
    let whole = std::fs::read(folder.file("depth.png")).unwrap();
    std::fs::write(folder.file("cut.png"), &whole[..whole.len() / 2]).unwrap();
    npy(&folder.file("negative.npy"), |pixel| {
        if pixel == 41 { -1.0 } else { 2.0 }
    });
    let try_depth = |name: &str| {
        refused(
            &folder,
            &format!("fog small.png --depth {name} --visibility-m 5 -o out.png"),
            1,
        )
    };
    for (name, sentence) in [
        ("missing.png", "missing.png"),
        ("empty.png", "empty.png"),
        ("cut.png", "cut.png"),
        ("wide.png", "41 x 30"),
        ("small.png", "small.png"),
        ("negative.npy", "-1"),
    ] {
        let text = try_depth(name);
        assert!(text.contains(sentence), "{name}: {text}");
    }
    // Not-a-number is a hole, to be filled.
    npy(&folder.file("hole.npy"), |pixel| {
        if pixel == 41 { f32::NAN } else { 2.0 }
    });
    let words = "fog small.png --depth hole.npy --visibility-m 5 -o out.png";
    assert!(run(&folder, words).status.success());
}

/// Writes 30 rows of 40 numbers.
fn npy(path: &Path, of: impl Fn(usize) -> f32) {
    let mut head = b"\x93NUMPY\x01\x00".to_vec();
    let mut text = "{'descr': '<f4', 'fortran_order': False, 'shape': (30, 40), }".to_owned();
    while !(10 + text.len() + 1).is_multiple_of(64) {
        text.push(' ');
    }
    text.push('\n');
    head.extend((text.len() as u16).to_le_bytes());
    head.extend(text.bytes());
    head.extend((0..1200).flat_map(|pixel| of(pixel).to_le_bytes()));
    std::fs::write(path, head).unwrap();
}
