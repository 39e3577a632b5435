//! `airlight fog`, and fog in `airlight sky`, from the outside: what they make, and what they refuse.

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
    npy_of(path, (30, 40), of);
}

/// Writes rows of numbers, as many as `shape` says.
fn npy_of(path: &Path, shape: (usize, usize), of: impl Fn(usize) -> f32) {
    let mut head = b"\x93NUMPY\x01\x00".to_vec();
    let mut text = format!("{{'descr': '<f4', 'fortran_order': False, 'shape': {shape:?}, }}");
    while !(10 + text.len() + 1).is_multiple_of(64) {
        text.push(' ');
    }
    text.push('\n');
    head.extend((text.len() as u16).to_le_bytes());
    head.extend(text.bytes());
    head.extend((0..shape.0 * shape.1).flat_map(|pixel| of(pixel).to_le_bytes()));
    std::fs::write(path, head).unwrap();
}

#[test]
fn layers_make_the_fogged_picture_of_the_clear_one() {
    let folder = Folder::new();
    let (width, height) = (12, 8);
    exr::prelude::write_rgba_file(folder.file("scene.exr"), width, height, |x, y| {
        let opacity = if x < 6 { 1.0f32 } else { 0.25 };
        (
            opacity * 0.1 * x as f32,
            opacity * 0.5,
            opacity * 0.2 * y as f32,
            opacity,
        )
    })
    .unwrap();
    npy_of(&folder.file("depth.npy"), (height, width), |pixel| {
        1.0 + pixel as f32
    });
    let words = "fog scene.exr --depth depth.npy --visibility-m 60 --ambient 0.7,0.8,0.9 --sun-elevation 20 \
                 --model height --layers -q -o layers.exr";
    let output = run(&folder, words);
    assert!(
        output.status.success(),
        "{}",
        String::from_utf8_lossy(&output.stderr)
    );
    let channels = |name: &str| {
        let image = exr::prelude::read_first_flat_layer_from_file(folder.file(name)).unwrap();
        let list = image.layer_data.channel_data.list;
        let one = |c: exr::prelude::AnyChannel<exr::prelude::FlatSamples>| {
            (
                c.name.to_string(),
                c.sample_data.values_as_f32().collect::<Vec<_>>(),
            )
        };
        list.into_iter()
            .map(one)
            .collect::<std::collections::BTreeMap<_, _>>()
    };
    let (clear, fogged) = (channels("scene.exr"), channels("layers.exr"));
    assert_eq!(fogged.len(), 11);
    assert_eq!(fogged["A"], clear["A"]);
    for colour in ["R", "G", "B"] {
        let transmittance = &fogged[&format!("transmittance.{colour}")];
        let path = &fogged[&format!("path_radiance.{colour}")];
        for pixel in 0..width * height {
            let made =
                clear[colour][pixel] * transmittance[pixel] + path[pixel] * clear["A"][pixel];
            assert!(
                (made - fogged[colour][pixel]).abs() < 1e-5,
                "{colour} {pixel}"
            );
            assert!((0.0..=1.0).contains(&transmittance[pixel]) && path[pixel] >= 0.0);
        }
    }
    assert!(fogged["Z"][0] >= 1.0 && fogged["Z"][95] >= 96.0);
}

#[test]
fn formats_without_opacity_take_pictures_that_have_it() {
    let folder = Folder::new();
    let picture = image::RgbaImage::from_pixel(40, 30, image::Rgba([90, 80, 70, 128]));
    picture.save(folder.file("glass.png")).unwrap();
    npy(&folder.file("depth.npy"), |_| 2.0);
    for (name, opacity) in [("out.jpg", 255), ("out.png", 128)] {
        let words = format!("fog glass.png --depth depth.npy --visibility-m 5 -q -o {name}");
        let output = run(&folder, &words);
        assert!(
            output.status.success(),
            "{name}: {}",
            String::from_utf8_lossy(&output.stderr)
        );
        let seen = image::open(folder.file(name)).unwrap().to_rgba8();
        assert_eq!(seen.get_pixel(3, 3).0[3], opacity, "{name}");
    }
}

#[test]
fn a_sky_is_drawn_through_fog_or_refused() {
    let folder = Folder::new();
    let sky = "sky --sun-elevation 20 --wavelengths rgb --size 32x16 -q -o";
    for (name, fog) in [
        ("clear.png", ""),
        (
            "thinning.png",
            "--fog-visibility-m 200 --fog-scale-height-m 60",
        ),
        (
            "slab.png",
            "--fog-visibility-m 200 --fog-top-m 60 --fog-droplets coarse",
        ),
    ] {
        let output = run(&folder, &format!("{sky} {name} {fog}"));
        assert!(
            output.status.success(),
            "{name}: {}",
            String::from_utf8_lossy(&output.stderr)
        );
    }
    let [clear, thinning, slab] =
        ["clear.png", "thinning.png", "slab.png"].map(|name| pixels(&folder.file(name)));
    assert!(clear != thinning && thinning != slab);
    for (fog, sentence) in [
        ("--fog-visibility-m 0", "above 0"),
        ("--fog-visibility-m nan", "above 0"),
        ("--fog-top-m 60", "--fog-visibility-m"),
        (
            "--fog-visibility-m 9 --fog-top-m 60 --fog-base-m 5",
            "cannot be used with",
        ),
        (
            "--fog-visibility-m 9 --fog-droplets soup",
            "possible values",
        ),
    ] {
        let text = refused(&folder, &format!("{sky} refused.png {fog}"), 2);
        assert!(text.contains(sentence), "{fog}: {text}");
    }
}
