//! What shines on the fog of `airlight fog`: lamps, the solved sky; its layers; and what is refused of them.

mod common;

use common::{Exr, Folder, command, run, succeed};
use std::path::Path;
use std::process::Output;

const SIZE: (usize, usize) = (32, 24);

/// Writes an EXR picture in which all is black, and a depth of 10 m.
fn black(folder: &Folder) {
    let (width, height) = SIZE;
    let black = |_, _| (0.0f32, 0.0f32, 0.0f32);
    exr::prelude::write_rgb_file(folder.file("black.exr"), width, height, black).unwrap();
    npy(&folder.file("ten.npy"), SIZE, |_, _| 10.0);
}

/// Writes rows of numbers.
fn npy(path: &Path, (width, height): (usize, usize), of: impl Fn(usize, usize) -> f32) {
    let mut head = b"\x93NUMPY\x01\x00".to_vec();
    let mut text =
        format!("{{'descr': '<f4', 'fortran_order': False, 'shape': ({height}, {width}), }}");
    while !(10 + text.len() + 1).is_multiple_of(64) {
        text.push(' ');
    }
    text.push('\n');
    head.extend((text.len() as u16).to_le_bytes());
    head.extend(text.bytes());
    for y in 0..height {
        head.extend((0..width).flat_map(|x| of(x, y).to_le_bytes()));
    }
    std::fs::write(path, head).unwrap();
}

const BLACK: &str = "fog black.exr --depth ten.npy --visibility-m 20 --ambient 0,0,0 -q";

/// Runs with options whose values hold spaces.
fn with(folder: &Folder, words: &str, more: &[&str]) -> Output {
    command(folder, words).args(more).output().unwrap()
}

fn made(folder: &Folder, words: &str, more: &[&str]) -> Exr {
    let output = with(folder, &format!("{words} -o out.exr"), more);
    let error = String::from_utf8_lossy(&output.stderr);
    assert!(output.status.success(), "{words} {more:?}: {error}");
    Exr::read(&folder.file("out.exr"))
}

#[test]
fn a_lamp_has_a_halo_without_fireflies() {
    let folder = Folder::new();
    black(&folder);
    npy(&folder.file("fine.npy"), (160, 120), |_, _| 10.0);
    let black = |_, _| (0.0f32, 0.0f32, 0.0f32);
    exr::prelude::write_rgb_file(folder.file("fine.exr"), 160, 120, black).unwrap();
    let fine = BLACK
        .replace("black.exr", "fine.exr")
        .replace("ten.npy", "fine.npy");
    for kind in [
        "",
        "kind=sphere radius=0.005",
        "kind=spot elevation=-90 inner=60 outer=85",
    ] {
        let lamp = format!("distance=5 intensity=2,1,0.5 {kind}");
        let at = |x, y| format!("pixel={x},{y} {lamp}");
        let seen = made(
            &folder,
            &format!("{BLACK} --fov 20"),
            &["--lamp", &at(12, 6)],
        );
        let row: Vec<f32> = (12..32).map(|x| seen.rgb(x, 7)[0]).collect();
        assert!(
            row.is_sorted_by(|near, far| near > far || *near == 0.0),
            "{kind}: {row:?}"
        );
        let [r, g, b] = seen.rgb(20, 10);
        assert!((r / g - 2.0).abs() < 1e-4 && (g / b - 2.0).abs() < 1e-4);
        if kind.is_empty() {
            // The pixel of the lamp holds about the mean of the glow in it: 25 pixels of a finer picture.
            let many = made(
                &folder,
                &format!("{fine} --fov 20"),
                &["--lamp", &at(62, 32)],
            );
            let parts = (0..25).map(|i| many.rgb(60 + i % 5, 30 + i / 5)[0]);
            let mean = parts.sum::<f32>() / 25.0;
            let ratio = seen.rgb(12, 6)[0] / mean;
            assert!((0.7..1.4).contains(&ratio), "{ratio}");
        }
    }
}

#[test]
fn a_lamp_is_where_its_words_say() {
    let folder = Folder::new();
    black(&folder);
    // 32 pixels across 60 degrees, looking north: a focal length of 27.7 pixels; 1.6 m above the ground.
    let right = (20.0 + 0.5 - 16.0) / (16.0 / 30f64.to_radians().tan());
    let up = (12.0 - 8.5) / (16.0 / 30f64.to_radians().tan());
    let length = (1.0 + right * right + up * up).sqrt();
    let at = [right, up, -1.0].map(|v| 4.0 * v / length);
    let at = format!("at={},{},{} intensity=1", at[0], at[1] + 1.6, at[2]);
    let by_pixel = made(
        &folder,
        BLACK,
        &["--lamp", "pixel=20,8 distance=4 intensity=1"],
    );
    let by_place = made(&folder, BLACK, &["--lamp", &at]);
    for (a, b) in by_pixel.channels["G"].iter().zip(&by_place.channels["G"]) {
        assert!((a / b - 1.0).abs() < 1e-4, "{a} {b}");
    }
    // Without a distance: on the wall, 10 m along the axis.
    let on_wall = made(&folder, BLACK, &["--lamp", "pixel=20,8 intensity=1"]);
    let far = format!("pixel=20,8 distance={} intensity=1", 10.0 * length);
    let told = made(&folder, BLACK, &["--lamp", &far]);
    for (a, b) in on_wall.channels["G"].iter().zip(&told.channels["G"]) {
        assert!((a / b - 1.0).abs() < 1e-4, "{a} {b}");
    }
    // Two lamps in one place are one of twice the light, and one behind the camera shines, too.
    let lamp = ["--lamp", "at=1,2,6 intensity=1"];
    let one = made(&folder, BLACK, &lamp);
    let two = made(&folder, BLACK, &[lamp, lamp].concat());
    for (a, b) in one.channels["B"].iter().zip(&two.channels["B"]) {
        assert!(*a > 0.0 && (b / a - 2.0).abs() < 1e-5, "{a} {b}");
    }
}

#[test]
fn layers_add_up() {
    let folder = Folder::new();
    black(&folder);
    let lit = [
        "--ambient",
        "0.5,0.6,0.7",
        "--sun-elevation",
        "30",
        "--lamp",
        "at=1,3,-6 intensity=1",
    ];
    let fog = "fog black.exr --depth ten.npy -q --eye-height-m 3";
    for (model, layer) in [
        ("uniform", "visibility=100"),
        ("height --scale-height-m 5", "visibility=100 scale-height=5"),
        (
            "clamped --scale-height-m 5 --base-height-m 2",
            "visibility=100 scale-height=5 base=2",
        ),
        ("slab --top-m 4", "visibility=100 top=4"),
    ] {
        let once = format!("{fog} --visibility-m 50 --model {model}");
        let once = made(&folder, &once, &lit);
        let twice = format!("{fog} --visibility-m 100 --model {model}");
        let twice = made(&folder, &twice, &[&lit[..], &["--layer", layer]].concat());
        for (a, b) in once.channels["R"].iter().zip(&twice.channels["R"]) {
            assert!((a / b - 1.0).abs() < 2e-3, "{model}: {a} {b}");
        }
    }
    // A layer far below is not seen, one around the eye is.
    let thin = format!("{fog} --visibility-m 1e6");
    let clear = made(&folder, &thin, &lit[..2]);
    let low = made(
        &folder,
        &thin,
        &[&lit[..2], &["--layer", "visibility=20 top=0.1"]].concat(),
    );
    let around = made(
        &folder,
        &thin,
        &[&lit[..2], &["--layer", "visibility=20 top=6"]].concat(),
    );
    let brightness = |seen: &Exr| seen.rgb(16, 2)[1];
    assert!((brightness(&low) / brightness(&clear) - 1.0).abs() < 0.01);
    assert!(brightness(&around) > 20.0 * brightness(&clear));
}

/// A sky as `airlight sky` draws it, low over the horizon, its right half hidden by a wall 200 km away of which no light
/// comes.
fn sky_and_wall(folder: &Folder, scale: f64, name: &str) {
    let draw = format!(
        "sky --sun-elevation 15 --sun-azimuth 90 --projection perspective --size 64x32 --fov 6 --camera-azimuth 40 \
         --camera-elevation 1.6 --sun-disc out --scale {scale} -q -o {name}"
    );
    succeed(folder, &draw);
    npy(&folder.file("wall.npy"), (64, 32), |x, _| {
        if x < 32 { f32::INFINITY } else { 200e3 }
    });
    npy(&folder.file("sky.npy"), (64, 32), |_, _| f32::INFINITY);
}

const OUTDOORS: &str = "--fov 6 --camera-azimuth 40 --camera-elevation 1.6 --sun-elevation 15 --sun-azimuth 90 \
                        --eye-height-m 2 --sky-light";

#[test]
fn what_is_far_goes_over_into_the_drawn_sky() {
    let folder = Folder::new();
    sky_and_wall(&folder, 1.0, "sky.exr");
    let drawn = Exr::read(&folder.file("sky.exr"));
    let blacked = |x: usize, y: usize| {
        let rgb = drawn.rgb(x as u32, y as u32);
        if x < 32 {
            (rgb[0], rgb[1], rgb[2])
        } else {
            (0.0, 0.0, 0.0)
        }
    };
    exr::prelude::write_rgb_file(folder.file("wall.exr"), 64, 32, blacked).unwrap();
    for fog in [
        "--visibility-m 1e9 --model slab --top-m 3",
        "--visibility-m 20e3 --model height --scale-height-m 300",
    ] {
        let words = format!(
            "fog wall.exr --depth wall.npy --radiance-scale 1 --air missing -q {fog} {OUTDOORS}"
        );
        let seen = made(&folder, &words, &[]);
        // Up to 2 degrees, where 200 km on there is next to no air left.
        for y in 13..29 {
            let [left, right] = [seen.rgb(31, y), seen.rgb(32, y)];
            for lane in 0..3 {
                let off = right[lane] / left[lane] - 1.0;
                assert!(off.abs() < 0.015, "{fog}, row {y}: {left:?} {right:?}");
            }
        }
    }
}

#[test]
fn the_sky_solver_lights_fog_at_the_level_of_the_picture() {
    let folder = Folder::new();
    let fogged = |picture: &str, more: &str, out: &str| {
        let words = format!(
            "fog {picture} --depth sky.npy --visibility-m 500 --model height --scale-height-m 40 {OUTDOORS} {more} -o {out}"
        );
        succeed(&folder, &words)
    };
    let middle = |name: &str| Exr::read(&folder.file(name)).rgb(30, 12);
    sky_and_wall(&folder, 1.0, "full.exr");
    let said = fogged("full.exr", "", "full_fog.exr");
    assert!(said.contains("as the file states it"), "{said}");
    let full = middle("full_fog.exr");
    let clear = middle("full.exr");
    assert!(
        (full[0] / clear[0] - 1.0).abs() > 0.05,
        "the fog is seen: {full:?} {clear:?}"
    );
    // The file states that 1 is 1e4 cd/m^2.
    sky_and_wall(&folder, 1e-4, "part.exr");
    fogged("part.exr", "", "part_fog.exr");
    // Nothing states it: the picture's sky does.
    let part = Exr::read(&folder.file("part.exr"));
    let of = |x: usize, y: usize| {
        let rgb = part.rgb(x as u32, y as u32);
        (rgb[0], rgb[1], rgb[2])
    };
    exr::prelude::write_rgb_file(folder.file("bare.exr"), 64, 32, of).unwrap();
    let said = fogged("bare.exr", "", "bare_fog.exr");
    assert!(said.contains("as bright as the picture's sky"), "{said}");
    fogged("bare.exr", "--radiance-scale 1e-4", "told_fog.exr");
    for (name, limit) in [
        ("part_fog.exr", 1e-5),
        ("told_fog.exr", 1e-5),
        ("bare_fog.exr", 1e-3),
    ] {
        let seen = middle(name);
        for lane in 0..3 {
            let off = seen[lane] / (1e-4 * full[lane]) - 1.0;
            assert!(off.abs() < limit, "{name}: {seen:?} {full:?}");
        }
    }
}

#[test]
fn skies_of_dusk_and_of_places_light_fog_in_photographs() {
    let folder = Folder::new();
    let picture = image::RgbImage::from_fn(40, 30, |_, y| match y {
        0..12 => image::Rgb([170, 190, 220]),
        _ => image::Rgb([60, 70, 40]),
    });
    picture.save(folder.file("photo.png")).unwrap();
    npy(&folder.file("depth.npy"), (40, 30), |_, y| {
        if y < 12 { f32::INFINITY } else { 60.0 }
    });
    let fog = "fog photo.png --depth depth.npy --visibility-m 80 --sky-light --model slab";
    for (sun, how) in [
        ("--sun-elevation 40", "as bright as the picture's sky"),
        (
            "--sun-elevation -4 --atmosphere clear",
            "as bright as the picture's sky",
        ),
        (
            "--at 48.85,2.29 --when 2026-06-21T19:15:00Z --aod-550 0.3",
            "as bright as the picture's sky",
        ),
        (
            "--sun-elevation 40 --ambient 0.4,0.4,0.4",
            "as bright as the ambient light",
        ),
        (
            "--sun-elevation 40 --top-m 30 --ground-altitude-m 900",
            "picture's sky",
        ),
    ] {
        let said = succeed(&folder, &format!("{fog} {sun} -o out.png"));
        assert!(said.contains(how), "{sun}: {said}");
        let seen = image::open(folder.file("out.png")).unwrap().to_rgb8();
        let [before, after] = [picture.get_pixel(20, 25).0, seen.get_pixel(20, 25).0];
        assert!(after[2] > before[2] + 15, "{sun}: {after:?}");
    }
}

#[test]
fn what_makes_no_sense_is_refused_and_leaves_nothing() {
    let folder = Folder::new();
    black(&folder);
    let before = folder.names();
    let lamp = |words: &'static str| vec!["--lamp", words];
    for (more, sentence) in [
        (lamp("at=0,1,-5"), "intensity="),
        (lamp("at=0,1,-5 intensity=0"), "above 0"),
        (lamp("at=0,1,-5 intensity=-2,1,1"), "0 or above"),
        (lamp("at=0,1,-5 intensity=NaN"), "0 or above"),
        (lamp("at=0,1,-5 intensity=1e300"), "intensity"),
        (lamp("at=0,inf,-5 intensity=1"), "three numbers"),
        (lamp("intensity=1"), "pixel=X,Y"),
        (lamp("pixel=40,2 distance=3 intensity=1"), "32 x 24"),
        (lamp("pixel=4.5,2 distance=3 intensity=1"), "whole numbers"),
        (lamp("pixel=4,2 distance=0 intensity=1"), "above 0"),
        (
            lamp("at=0,1,-5 intensity=1 kind=spot inner=50 outer=20"),
            "inner angle",
        ),
        (
            lamp("at=0,1,-5 intensity=1 kind=spot outer=0"),
            "outer angle",
        ),
        (lamp("at=0,1,-5 intensity=1 wattage=60"), "wattage"),
        (lamp("at=0,1,-5 intensity=1 radius=-1"), "above 0"),
        (vec!["--layer", "top=4"], "visibility="),
        (vec!["--layer", "visibility=-4"], "above 0"),
        (vec!["--layer", "visibility=4 top=3 base=1"], "leave out"),
        (vec!["--sky-light"], "--sun-elevation"),
        (
            vec!["--sky-light", "--sun-elevation", "30"],
            "--radiance-scale",
        ),
        (
            vec![
                "--sky-light",
                "--sun-elevation",
                "30",
                "--radiance-scale",
                "0",
            ],
            "above 0",
        ),
        (
            vec![
                "--sky-light",
                "--sun-elevation",
                "30",
                "--radiance-scale",
                "nan",
            ],
            "above 0",
        ),
        (
            vec![
                "--sky-light",
                "--sun-elevation",
                "30",
                "--atmosphere",
                "venusian",
            ],
            "venusian",
        ),
        (
            vec!["--sky-light", "--sun-elevation", "30", "--at", "1,2"],
            "cannot be used",
        ),
        (
            vec!["--sky-light", "--at", "1,2", "--when", "yesterday"],
            "--when",
        ),
        (vec!["--air", "missing"], "--sky-light"),
        (vec!["--sun-elevation", "-3"], "--sky-light"),
    ] {
        let output = with(
            &folder,
            &format!("{BLACK} --model height -o out.exr"),
            &more,
        );
        let text = String::from_utf8(output.stderr).unwrap();
        assert_eq!(output.status.code(), Some(2), "{more:?}: {text}");
        assert!(text.contains(sentence), "{more:?}: {text}");
        assert_eq!(folder.names(), before, "{more:?} left something behind");
    }
    for look in ["exp2", "linear", "foggy-cityscapes"] {
        for more in [
            lamp("at=0,1,-5 intensity=1"),
            vec!["--layer", "visibility=4"],
            vec!["--sky-light", "--sun-elevation", "30"],
        ] {
            let output = with(
                &folder,
                &format!("{BLACK} --model {look} -o out.exr"),
                &more,
            );
            let text = String::from_utf8(output.stderr).unwrap();
            assert_eq!(output.status.code(), Some(2), "{look} {more:?}: {text}");
            assert!(
                text.contains(more[0]) && text.contains("one colour"),
                "{text}"
            );
            assert_eq!(folder.names(), before);
        }
    }
    // No sky shines on fog without an upper end.
    let sky = ["--sky-light", "--sun-elevation", "30"];
    for more in [&[][..], &["--model", "slab", "--layer", "visibility=4"]] {
        let output = with(
            &folder,
            &format!("{BLACK} -o out.exr"),
            &[&sky, more].concat(),
        );
        let text = String::from_utf8(output.stderr).unwrap();
        assert!(text.contains("upper end"), "{text}");
    }
    // The sky at a pixel is at no distance.
    npy(&folder.file("far.npy"), SIZE, |_, _| f32::INFINITY);
    let words = "fog black.exr --depth far.npy --visibility-m 20 --ambient 0,0,0 -q -o out.exr";
    let output = with(&folder, words, &["--lamp", "pixel=3,3 intensity=1"]);
    assert!(String::from_utf8_lossy(&output.stderr).contains("distance=METRES"));
    assert!(run(&folder, words).status.success());
}
