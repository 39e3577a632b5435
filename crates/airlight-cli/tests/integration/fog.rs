//! `airlight fog` from the outside: flags, files, refusals and exit codes.

use crate::common::{Exr, Folder, command, number_after, run, succeed};
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
    let before = folder.names("");
    let Output { status, stderr, .. } = run(folder, words);
    let text = String::from_utf8(stderr).unwrap();
    assert_eq!(status.code(), Some(code), "{words}: {text}");
    assert_eq!(folder.names(""), before, "{words} left something behind");
    text
}

/// Writes rows of numbers, as many as `shape` says.
fn npy(path: &Path, shape: (usize, usize), of: impl Fn(usize) -> f32) {
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

/// A small picture with opacity, and a depth that grows with each pixel.
fn small() -> Folder {
    let folder = Folder::new();
    exr::prelude::write_rgba_file(folder.file("scene.exr"), 12, 8, |x, y| {
        let opacity = if x < 6 { 1.0f32 } else { 0.25 };
        (
            opacity * 0.1 * x as f32,
            opacity * 0.5,
            opacity * 0.2 * y as f32,
            opacity,
        )
    })
    .unwrap();
    npy(&folder.file("depth.npy"), (8, 12), |pixel| {
        1.0 + pixel as f32
    });
    folder
}

#[test]
fn fog_of_great_visibility_leaves_the_picture_unchanged() {
    let folder = Folder::new();
    let words = format!("{} --visibility-m 1e9 -o out.png", motorcycle());
    assert!(run(&folder, &words).status.success());
    let scene = Path::new(env!("CARGO_MANIFEST_DIR")).join("../../scenes/motorcycle/left.png");
    assert_eq!(pixels(&folder.file("out.png")), pixels(&scene));
}

#[test]
fn every_profile_hides_what_is_far() {
    let folder = Folder::new();
    for profile in [
        "uniform",
        "height",
        "clamped",
        "unclamped",
        "slab",
        "exp2",
        "linear",
        "foggy-cityscapes",
    ] {
        let words = format!(
            "{} --visibility-m 6 --fog-profile {profile} --sun-elevation 30 --ambient 0.6,0.7,0.8 -q -o {profile}.png",
            motorcycle()
        );
        assert_eq!(succeed(&folder, &words), "");
        let seen = pixels(&folder.file(format!("{profile}.png")));
        // A dark place at the back of the garage has become bright.
        assert!(seen.get_pixel(15, 60).0[0] > 110, "{profile}");
    }
}

#[test]
fn layers_composite_to_the_picture_in_fog() {
    let folder = small();
    let words = "fog scene.exr --depth depth.npy --visibility-m 60 --ambient 0.7,0.8,0.9 --sun-elevation 20 \
                 --fog-profile height --layers -q -o layers.exr";
    succeed(&folder, words);
    let [clear, fogged] =
        ["scene.exr", "layers.exr"].map(|name| Exr::read(&folder.file(name)).channels);
    assert_eq!(fogged.len(), 11);
    assert_eq!(fogged["A"], clear["A"]);
    for colour in ["R", "G", "B"] {
        let transmittance = &fogged[&format!("transmittance.{colour}")];
        let path = &fogged[&format!("path_radiance.{colour}")];
        for pixel in 0..12 * 8 {
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
    npy(&folder.file("depth.npy"), (30, 40), |_| 2.0);
    for (name, opacity) in [("out.jpg", 255), ("out.png", 128)] {
        let words = format!("fog glass.png --depth depth.npy --visibility-m 5 -q -o {name}");
        succeed(&folder, &words);
        let seen = image::open(folder.file(name)).unwrap().to_rgba8();
        assert_eq!(seen.get_pixel(3, 3).0[3], opacity, "{name}");
    }
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
    let with_one = |value| move |pixel| if pixel == 41 { value } else { 2.0 };
    npy(&folder.file("negative.npy"), (30, 40), with_one(-1.0));
    for (name, sentence) in [
        ("missing.png", "missing.png"),
        ("empty.png", "empty.png"),
        ("cut.png", "cut.png"),
        (
            "wide.png",
            "--depth: expected the size or the aspect ratio of the picture, got 41 x 30",
        ),
        ("small.png", "small.png"),
        ("negative.npy", "-1"),
    ] {
        let words = format!("fog small.png --depth {name} --visibility-m 5 -o out.png");
        let text = refused(&folder, &words, 1);
        assert!(text.contains(sentence), "{name}: {text}");
    }
    // A grey picture is not the depth of itself, alone or in a folder.
    std::fs::create_dir(folder.file("grey")).unwrap();
    std::fs::copy(folder.file("depth.png"), folder.file("grey/a.png")).unwrap();
    for words in ["fog depth.png -o out.png", "fog grey -o out"] {
        let text = refused(&folder, &format!("{words} --visibility-m 5"), 2);
        assert!(
            text.contains("--depth: expected a depth map, since only EXR"),
            "{text}"
        );
    }
    // Not-a-number is a hole, which is filled.
    npy(&folder.file("hole.npy"), (30, 40), with_one(f32::NAN));
    let words = "fog small.png --depth hole.npy --visibility-m 5 -o out.png";
    assert!(succeed(&folder, words).contains("1 pixels unknown"));
}

#[test]
fn options_that_contradict_are_refused() {
    let folder = small();
    let scene = "fog scene.exr --depth depth.npy";
    let lit = "--sky-light --sun-elevation 5 --fog-profile slab";
    for (more, sentence) in [
        ("-o a.exr", "a visibility in the fog"),
        ("--visibility-m 0 -o a.exr", "above 0"),
        (
            "--visibility-m 5 --quality 50 -o a.exr",
            "--quality: expected a file whose name ends in .jpg",
        ),
        (
            "--visibility-m 5 --brighten 1 -o a.exr",
            "--brighten: expected a file whose name ends in .png or .jpg",
        ),
        ("--visibility-m 5 --depth-scale -1 -o a.exr", "depth-offset"),
        ("--visibility-m 5 -o a.tiff", "Known endings"),
        ("--visibility-m 5 --layers -o a.hdr", ".exr"),
        ("--visibility-m 5 -o scene.exr", "not an input"),
        (
            "--visibility-m 5 --sun-elevation -3 -o a.exr",
            "above the horizon",
        ),
        ("--visibility-m 5 --ambient 1,2 -o a.exr", "three numbers"),
        ("--visibility-m 5 --ambient=-1,2,3 -o a.exr", "0 or above"),
        ("--visibility-m 5 --contrast 0.03 -o a.exr", "0.05 or 0.02"),
        (
            "--visibility-m 5 --fog-profile thick -o a.exr",
            "foggy-cityscapes",
        ),
        ("--visibility-m 5 --layer top=4 -o a.exr", "visibility="),
        (
            "--visibility-m 5 --light intensity=1 -o a.exr",
            "position_m",
        ),
        (
            "--visibility-m 5 --light-form printed -o a.exr",
            "expected a light",
        ),
        ("--visibility-m 5 --sky-light -o a.exr", "upper end"),
        (
            "--visibility-m 5 --sky-light --fog-profile slab -o a.exr",
            "--sun-elevation: expected a position of the sun",
        ),
        (
            "--visibility-m 5 --sky-light --sun-elevation 5 --at 1,2 --when now -o a.exr",
            "cannot be used",
        ),
        ("--visibility-m 5 --seed 3 -o a.exr", "--vary"),
        ("--visibility-m 5 --paths 256 -o a.exr", "monte-carlo"),
        ("--visibility-m 5 --noise-map -o a.exr", "monte-carlo"),
        (
            "--visibility-m 5 --solver monte-carlo -o a.exr",
            "sky-light",
        ),
        (
            "--visibility-m 5 --moon-elevation 30 -o a.exr",
            "--sky-quality: expected a solved sky, got ambient light; try --sky-light",
        ),
        (
            &format!("--visibility-m 5 {lit} --stars on -o a.exr"),
            "--stars: expected lights that fill the fog",
        ),
        (
            &format!("--visibility-m 5 {lit} --solver monte-carlo --paths 5 -o a.exr"),
            "128",
        ),
        (
            &format!("--visibility-m 5 {lit} --solver monte-carlo --jobs 1 -o a.exr"),
            "one picture",
        ),
        ("--visibility-m 5 --variants 2 -o a.exr", "--vary"),
        // The library's names of settings are given as options.
        (
            "-o a.exr",
            "try --visibility-m 100, or --vary visibility=50..500",
        ),
        (
            "--visibility-m 5 --depth-kind disparity -o a.exr",
            "--depth-kind disparity: expected",
        ),
        (
            "--visibility-m 5 --layers -o a.png",
            "--layers: expected an OpenEXR output",
        ),
        (
            "--visibility-m 5 -o foggy_v1.0",
            "--output: unknown picture format",
        ),
        ("--visibility-m 5 --jobs 0 -o a.exr", "--jobs"),
        ("--vary fogginess=1..2 -o a.exr", "visibility, scale-height"),
        ("--vary visibilty=5..9 -o a.exr", "try \"visibility\""),
        ("--each visibility=5..9 -o a.exr", "try visibility=5,9"),
        ("--visibility-m 5,9 -o a.exr", "--each visibility=5,9"),
        ("--visibility-m 5 --shard 4/3 -o a.exr", "try 1/4"),
        ("--visibility-m 5 --patch-strength 3 -o a.exr", "0 to 2"),
        (
            "--visibility-m 5 --patch-time-s 3 -o a.exr",
            "--patch-time-s: expected",
        ),
        (
            "--visibility-m 5 --patch-seed 3 --fog-profile exp2 -o a.exr",
            "patches: expected fog that scatters light",
        ),
        (
            &format!("--visibility-m 5 --patch-seed 3 {lit} --solver monte-carlo -o a.exr"),
            "--patch-strength: expected solver orders",
        ),
    ] {
        let text = refused(&folder, &format!("{scene} {more}"), 2);
        assert!(text.contains(sentence), "{more}: {text}");
    }
    let words = format!("{scene} --visibility-m 5 -o none/a.exr");
    let text = refused(&folder, &words, 1);
    assert!(text.contains("there is no folder"), "{text}");
}

#[test]
fn monte_carlo_reports_its_noise() {
    let folder = small();
    let words = "fog scene.exr --depth depth.npy --sky-light --sun-elevation 25 --visibility-m 60 --top-m 60 \
                 --radiance-scale 1e-4 --solver monte-carlo --paths 128 --noise-map -o out.exr";
    let text = succeed(&folder, words);
    assert!(text.contains("128 paths per pixel"), "{text}");
    let [picture, noise] = ["out.exr", "out.noise.exr"].map(|name| Exr::read(&folder.file(name)));
    assert_eq!((noise.width, noise.height), (picture.width, picture.height));
    assert!(noise.channels["G"].iter().all(|error| *error > 0.0));
}

/// A picture is the same by options and by the scene file that they are saved as, and options override the file.
#[test]
fn scenes_are_saved_and_read() {
    let folder = small();
    let options = "fog scene.exr --depth depth.npy --visibility-m 60 --top-m 4 --eye-height-m 2 --camera-roll 3 \
                   --ambient 0.7,0.8,0.9 --sun-elevation 20 --droplets fine --fog-scattering single";
    let words = format!("{options} -o a.exr --save-scene a.toml");
    let lit = ["--light", "at=0,1,-5 intensity=2"];
    let layer = ["--layer", "visibility=300 scale-height=5"];
    let output = command(&folder, &words).args(lit).args(layer).output();
    assert!(output.unwrap().status.success());
    let text = std::fs::read_to_string(folder.file("a.toml")).unwrap();
    for line in [
        "visibility_m = 60.0",
        "top_m = 4.0",
        "[overlay]",
        "depth.npy",
    ] {
        assert!(text.contains(line), "{line}: {text}");
    }
    succeed(&folder, "fog --scene a.toml -o b.exr");
    let [a, b] = ["a.exr", "b.exr"].map(|name| Exr::read(&folder.file(name)).channels);
    assert_eq!(a, b);
    succeed(&folder, "fog --scene a.toml --visibility-m 30 -o c.exr");
    assert_ne!(Exr::read(&folder.file("c.exr")).channels, a);
    let patches =
        "--patch-strength 0.7 --patch-size-m 2 --patch-seed 5 --patch-wind -1,0 --patch-time-s 4";
    succeed(
        &folder,
        &format!("{options} {patches} -o p.exr --save-scene p.toml"),
    );
    succeed(&folder, "fog --scene p.toml -o q.exr");
    succeed(&folder, "fog --scene p.toml --patch-seed 6 -o r.exr");
    let [p, q, r] = ["p.exr", "q.exr", "r.exr"].map(|name| Exr::read(&folder.file(name)).channels);
    assert_eq!(p, q);
    assert_ne!(p, r);
    std::fs::write(folder.file("wrong.toml"), "[fog]\nvisibilty_m = 3\n").unwrap();
    let text = refused(&folder, "fog --scene wrong.toml -o d.exr", 2);
    assert!(
        text.contains("line 2") && text.contains("visibility_m"),
        "{text}"
    );
    let text = refused(&folder, "fog --scene none.toml -o d.exr", 1);
    assert!(text.contains("none.toml"), "{text}");
}

#[test]
fn a_batch_is_made_reported_and_resumed() {
    let folder = Folder::new();
    std::fs::create_dir(folder.file("rgb")).unwrap();
    for name in ["a", "b"] {
        let picture = image::RgbImage::from_pixel(40, 30, image::Rgb([90, 80, 70]));
        picture
            .save(folder.file(format!("rgb/{name}.png")))
            .unwrap();
    }
    npy(&folder.file("depth.npy"), (30, 40), |_| 2.0);
    let words = "fog rgb/*.png --depth depth.npy -o out/*.png --vary visibility=5..50 --seed 7";
    let text = succeed(&folder, words);
    assert!(text.contains("2 of 2 pictures written"), "{text}");
    let manifest = std::fs::read_to_string(folder.file("out/manifest.jsonl")).unwrap();
    assert_eq!(manifest.lines().count(), 2);
    std::fs::remove_file(folder.file("out/b.png")).unwrap();
    let text = succeed(&folder, words);
    assert!(
        text.contains("1 of 2 pictures written, 1 existed already"),
        "{text}"
    );
    let text = refused(&folder, &words.replace("--seed 7", "--seed 8"), 2);
    assert!(
        text.contains("fog.visibility_m was ") && text.contains("overwrite"),
        "{text}"
    );
    // One picture fails, the other is made, and the exit code says so.
    std::fs::write(folder.file("rgb/a.png"), "").unwrap();
    let output = run(&folder, &format!("{words} --overwrite"));
    let text = String::from_utf8(output.stderr).unwrap();
    assert_eq!(output.status.code(), Some(1), "{text}");
    assert!(
        text.contains("1 picture failed:") && text.contains("rgb/a.png"),
        "{text}"
    );
}

/// Runs it and expects success; standard error.
fn remarks(folder: &Folder, words: &str) -> String {
    let output = run(folder, words);
    let text = String::from_utf8(output.stderr).unwrap();
    assert!(output.status.success(), "{words}: {text}");
    text
}

#[test]
fn display_pictures_become_linear_and_return() {
    let folder = Folder::new();
    let glass = |x: u32, y: u32| image::Rgba([(6 * x) as u8, 200, (8 * y) as u8, (128 + x) as u8]);
    let picture = image::RgbaImage::from_fn(40, 30, glass);
    picture.save(folder.file("glass.png")).unwrap();
    npy(&folder.file("depth.npy"), (30, 40), |_| 2.0);
    let words = "fog glass.png --depth depth.npy --visibility-m 5 --ambient 1,1,1 --layers -q -o layers.exr";
    succeed(&folder, words);
    let made = Exr::read(&folder.file("layers.exr")).channels;
    // By the colours of the picture and its opacity.
    let clear = airlight::spectrum::rgb::srgb_decode(f64::from(6 * 7u8) / 255.0) as f32;
    let at = 3 * 40 + 7;
    let opacity = 135.0 / 255.0;
    let expected = (clear * made["transmittance.R"][at] + made["path_radiance.R"][at]) * opacity;
    assert!((made["R"][at] - expected).abs() < 1e-5);
    assert!((made["A"][at] - opacity).abs() < 1e-6);
    // Without fog, there and back.
    let there = "fog glass.png --depth depth.npy --visibility-m 1e9 -o there.exr";
    assert!(remarks(&folder, there).contains("the fog hides nothing"));
    succeed(
        &folder,
        "fog there.exr --depth depth.npy --visibility-m 1e9 --exposure 15 --tone clip -o back.png",
    );
    let back = image::open(folder.file("back.png")).unwrap().to_rgba8();
    for (a, b) in picture.pixels().zip(back.pixels()) {
        let near = a.0.iter().zip(b.0).all(|(a, b)| a.abs_diff(b) <= 1);
        assert!(near, "{a:?} {b:?}");
    }
}

/// The curve is in the metadata, the exposure in the report, too; pictures of a display have neither.
#[test]
fn linear_pictures_are_exposed_and_tone_mapped_for_a_display() {
    let folder = small();
    let words = "fog scene.exr --depth depth.npy --visibility-m 50";
    let text = succeed(&folder, &format!("{words} --exposure spot -o a.png"));
    let ev100 = number_after(&text, "exposure      EV");
    let text = succeed(
        &folder,
        &format!("{words} --exposure {ev100} --tone agx-base -o b.png"),
    );
    assert_eq!(number_after(&text, "exposure      EV"), ev100);
    let bytes = std::fs::read(folder.file("b.png")).unwrap();
    let stated = format!("EV {ev100} at ISO 100, tone curve agx-base");
    assert!(
        bytes
            .windows(stated.len())
            .any(|part| part == stated.as_bytes())
    );
    assert_ne!(pixels(&folder.file("a.png")), pixels(&folder.file("b.png")));
    for option in [
        "--exposure auto",
        "--tone camera",
        "--brighten 1",
        "--white-balance 5000",
        "--scotopic",
    ] {
        let name = option.split(' ').next().unwrap();
        let words = format!("fog a.png --depth depth.npy --visibility-m 50 {option} -o c.png");
        let text = refused(&folder, &words, 2);
        let expected =
            format!("{name}: expected a picture of linear light (EXR, HDR, TIFF of floats)");
        assert!(text.contains(&expected), "{text}");
    }
    let words = format!("{words} --each exposure=12,13 -o out/x.png");
    succeed(&folder, &words);
    let manifest = std::fs::read_to_string(folder.file("out/manifest.jsonl")).unwrap();
    for ev100 in ["12.0", "13.0"] {
        assert!(
            manifest.contains(&format!("\"exposure_ev100\":{ev100}")),
            "{manifest}"
        );
    }
}

#[test]
fn qualities_outputs_in_folders_and_negative_depths() {
    let folder = Folder::new();
    let noise =
        |x: u32, y: u32| image::Rgb([(x * 37 + y * 91) as u8, (x * y) as u8, (y * 53) as u8]);
    let picture = image::RgbImage::from_fn(40, 30, noise);
    picture.save(folder.file("a.png")).unwrap();
    let one = |pixel| if pixel == 7 { -1.0 } else { 2.0 };
    npy(&folder.file("depth.npy"), (30, 40), one);
    let words = "fog a.png --depth depth.npy --visibility-m 5";
    let text = refused(&folder, &format!("{words} -o b.png"), 1);
    assert!(text.contains("negative unknown"), "{text}");
    let words = format!("{words} --negative unknown");
    let size = |quality: u8| {
        succeed(
            &folder,
            &format!("{words} --quality {quality} -o {quality}.jpg"),
        );
        std::fs::metadata(folder.file(format!("{quality}.jpg")))
            .unwrap()
            .len()
    };
    assert!(size(20) < size(95));
    std::fs::create_dir(folder.file("out")).unwrap();
    let text = succeed(&folder, &format!("{words} -o out/"));
    assert!(
        text.contains("2.000 to 2.000 m, 1 pixels unknown"),
        "{text}"
    );
    assert!(folder.file("out/a.png").is_file());
    // Millimetres taken for metres.
    let text = remarks(&folder, &format!("{words} --depth-scale 1000 -o c.png"));
    assert!(text.contains("hides every object"), "{text}");
}

#[cfg(unix)]
#[test]
fn pipes_are_read() {
    let folder = Folder::new();
    image::RgbImage::from_pixel(40, 30, image::Rgb([90, 80, 70]))
        .save(folder.file("a.png"))
        .unwrap();
    npy(&folder.file("depth.npy"), (30, 40), |_| 2.0);
    let through_pipe = |file: &str, words: &str| {
        let mut cat = std::process::Command::new("cat")
            .arg(folder.file(file))
            .stdout(std::process::Stdio::piped())
            .spawn()
            .unwrap();
        let mut command = command(&folder, words);
        let output = command.stdin(cat.stdout.take().unwrap()).output();
        let output = output.unwrap();
        let error = String::from_utf8_lossy(&output.stderr);
        assert!(output.status.success(), "{error}");
        cat.wait().unwrap();
    };
    let fog = "--visibility-m 5 -o";
    through_pipe(
        "a.png",
        &format!("fog /dev/stdin --depth depth.npy {fog} b.png"),
    );
    succeed(&folder, &format!("fog a.png --depth depth.npy {fog} c.png"));
    assert_eq!(pixels(&folder.file("b.png")), pixels(&folder.file("c.png")));
    // Colours and depth from one file.
    succeed(
        &folder,
        &format!("fog a.png --depth depth.npy --layers {fog} layers.exr"),
    );
    through_pipe("layers.exr", &format!("fog /dev/stdin {fog} b.exr"));
    succeed(&folder, &format!("fog layers.exr {fog} c.exr"));
    let [b, c] = ["b.exr", "c.exr"].map(|name| Exr::read(&folder.file(name)).channels);
    assert_eq!(b, c);
}
