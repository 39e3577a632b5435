//! `airlight compare` and `airlight grid`, as a user meets them.

mod common;

use common::{Folder, run, succeed};

const SKY: &str = "--sun-elevation 20 --wavelengths fast --size 32x16";

#[test]
fn a_solver_is_no_different_from_itself_and_scatters_more_than_once() {
    let folder = Folder::new();
    let json = |solvers: &str| {
        let text = succeed(&folder, &format!("compare {solvers} {SKY} --format json"));
        serde_json::from_str::<serde_json::Value>(&text).unwrap()
    };
    let same = json("orders orders");
    assert_eq!(same["luminance_percent"]["worst"].as_f64(), Some(0.0));
    assert_eq!(same["ciede2000"]["worst"].as_f64(), Some(0.0));
    let single = json("orders orders:single");
    let mean = single["luminance_percent"]["mean"].as_f64().unwrap();
    assert!((-60.0..-10.0).contains(&mean), "{mean}");
    let scaled = json("orders orders:single --same-light");
    assert!(scaled["second_scaled_by"].as_f64().unwrap() > 1.1);
}

#[test]
fn random_paths_agree_with_the_fast_solver() {
    let folder = Folder::new();
    let text = succeed(
        &folder,
        "compare monte-carlo orders --sun-elevation 40 --wavelengths rgb --size 16x8 --paths 1024 --format json",
    );
    let found: serde_json::Value = serde_json::from_str(&text).unwrap();
    let mean = found["luminance_percent"]["mean"].as_f64().unwrap();
    assert!(mean.abs() < 2.0, "{mean}");
}

#[test]
fn both_pictures_and_the_maps_are_drawn() {
    let folder = Folder::new();
    succeed(
        &folder,
        &format!("compare orders klassen1987 {SKY} -o a.png"),
    );
    let board = image::open(folder.file("a.png")).unwrap().into_rgb8();
    assert!(board.width() > 64 && board.height() > 64);
    let black = board.pixels().filter(|pixel| pixel.0 == [0; 3]).count();
    assert!(black < board.pixels().len() / 4, "{black}");
}

#[test]
fn boards_are_drawn_from_files() {
    let folder = Folder::new();
    let text = "columns = 2\n[sky]\nwavelengths = \"rgb\"\nsize = \"40x20\"\n\
        [[cell]]\nsun-elevation = 40\n[[cell]]\nsun-elevation = 1\n";
    std::fs::write(folder.file("suns.toml"), text).unwrap();
    succeed(&folder, "grid suns.toml -o suns.png");
    let board = image::open(folder.file("suns.png")).unwrap();
    assert!(board.width() > 80);
}

#[test]
fn what_makes_no_sense_is_refused() {
    let folder = Folder::new();
    std::fs::write(folder.file("bad.toml"), "[[cell]]\nsunny = 1\n").unwrap();
    for (words, sentence) in [
        (format!("compare orders sunny {SKY}"), "knows no solver"),
        (
            format!("compare orders orders {SKY} --solver monte-carlo"),
            "leave out --solver",
        ),
        (
            format!("compare orders orders {SKY} --paths 256"),
            "random paths",
        ),
        (format!("compare orders orders {SKY} -o a.jpg"), ".png"),
        ("grid bad.toml -o a.png".to_owned(), "cell 1"),
        ("grid none.toml -o a.png".to_owned(), "none.toml"),
        ("grid bad.toml -o a.jpg".to_owned(), ".png"),
    ] {
        let output = run(&folder, &words);
        let text = String::from_utf8(output.stderr).unwrap();
        assert_eq!(output.status.code(), Some(2), "{words}: {text}");
        assert!(text.contains(sentence), "{words}: {text}");
    }
}
