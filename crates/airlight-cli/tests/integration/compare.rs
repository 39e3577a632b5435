//! `airlight compare` and `airlight grid`, as a user meets them.

use crate::common::{Folder, run, succeed};
use image::RgbImage;
use std::path::Path;

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
fn monte_carlo_agrees_with_the_fast_solver() {
    let folder = Folder::new();
    let text = succeed(
        &folder,
        "compare monte-carlo orders --sun-elevation 40 --wavelengths rgb --size 16x8 --paths 1024 --format json",
    );
    let found: serde_json::Value = serde_json::from_str(&text).unwrap();
    let mean = found["luminance_percent"]["mean"].as_f64().unwrap();
    assert!(mean.abs() < 2.0, "{mean}");
}

/// Left edge and top of each place at which a sheet shows a picture.
fn places(sheet: &RgbImage, picture: &RgbImage) -> Vec<(u32, u32)> {
    let (width, height) = picture.dimensions();
    let shows = |&(left, top): &(u32, u32)| {
        let mut pixels = picture.enumerate_pixels();
        pixels.all(|(x, y, pixel)| sheet.get_pixel(left + x, top + y) == pixel)
    };
    let corners = (0..=sheet.height() - height)
        .flat_map(|top| (0..=sheet.width() - width).map(move |left| (left, top)));
    corners.filter(shows).collect()
}

fn picture(folder: &Folder, name: &str) -> RgbImage {
    image::open(folder.file(name)).unwrap().into_rgb8()
}

/// Between panels of a contact sheet, pixels.
const GAP: u32 = 16;

#[test]
fn both_pictures_and_the_maps_are_drawn() {
    let folder = Folder::new();
    succeed(&folder, &format!("sky {SKY} --sun-disc out -q -o sky.png"));
    succeed(&folder, &format!("compare orders orders {SKY} -o same.png"));
    succeed(
        &folder,
        &format!("compare orders klassen1987 {SKY} -o a.png"),
    );
    let sky = picture(&folder, "sky.png");
    let (width, height) = sky.dimensions();
    // The same sky twice, and maps of no difference: white (diverging) and dark (sequential).
    let same = picture(&folder, "same.png");
    let [first, second] = places(&same, &sky)[..] else {
        panic!("the sky is not there twice")
    };
    assert_eq!(second, (first.0 + width + GAP, first.1));
    let map_top = (first.1 + height..same.height() - height).find(|&top| {
        let even = RgbImage::from_pixel(width, height, *same.get_pixel(second.0, top));
        let dark = same.get_pixel(second.0, top).0.iter().all(|&c| c < 100);
        dark && places(&same, &even).contains(&(second.0, top))
    });
    let map_top = map_top.expect("a map of the colours' difference");
    let luminance = *same.get_pixel(first.0, map_top);
    assert!(luminance.0.iter().all(|&c| c > 225), "{luminance:?}");
    let even = RgbImage::from_pixel(width, height, luminance);
    assert!(places(&same, &even).contains(&(first.0, map_top)));
    // Another model: the sky beside another picture, over maps that are not even.
    let other = picture(&folder, "a.png");
    assert_eq!(places(&other, &sky), [first]);
    for left in [first.0, second.0] {
        let colours: std::collections::HashSet<_> = (0..width)
            .flat_map(|x| (0..height).map(move |y| (x, y)))
            .map(|(x, y)| *other.get_pixel(left + x, map_top + y))
            .collect();
        assert!(colours.len() > 20, "{}", colours.len());
    }
}

#[test]
fn contact_sheets_are_drawn_from_files() {
    let folder = Folder::new();
    let text = "columns = 2\n[scene]\nsolver.wavelengths = \"rgb\"\ncamera.size = [40, 20]\n\
        [[cell]]\nsun.elevation_deg = 40\n[[cell]]\nsun.elevation_deg = 1\n";
    std::fs::write(folder.file("suns.toml"), text).unwrap();
    succeed(&folder, "grid suns.toml -o suns.png");
    let sheet = picture(&folder, "suns.png");
    let [high, low] = [40, 1].map(|sun| {
        let words = format!("sky --sun-elevation {sun} --wavelengths rgb --size 40x20 -q -o a.png");
        succeed(&folder, &words);
        let places = places(&sheet, &picture(&folder, "a.png"));
        assert_eq!(places.len(), 1, "sun at {sun} degrees: {places:?}");
        places[0]
    });
    assert_eq!(low, (high.0 + 40 + GAP, high.1));
}

/// The files that the book's figures are drawn from.
#[test]
fn the_files_of_the_repository_are_read() {
    let scenes = Path::new(env!("CARGO_MANIFEST_DIR")).join("../../scenes");
    let mut count = 0;
    for folder in ["height-fog", "klassen1987", "models"] {
        for entry in std::fs::read_dir(scenes.join(folder)).unwrap() {
            let path = entry.unwrap().path();
            let text = std::fs::read_to_string(&path).unwrap_or_default();
            if text.contains("[[cell]]") {
                let spec = airlight_render::contact_sheet::ContactSheetSpec::load(&path).unwrap();
                for (label, scene) in &spec.cells {
                    airlight_render::Renderer::new(scene)
                        .unwrap_or_else(|error| panic!("{}, {label}: {error}", path.display()));
                }
                count += 1;
            }
        }
    }
    assert!(count >= 10, "{count}");
}

#[test]
fn what_makes_no_sense_is_refused() {
    let folder = Folder::new();
    std::fs::write(folder.file("bad.toml"), "[[cell]]\nsunny = 1\n").unwrap();
    let ignored =
        "[[cell]]\nsun.elevation_deg = 20\nsolver.name = \"preetham\"\nair.ozone_du = 300\n";
    std::fs::write(folder.file("ignored.toml"), ignored).unwrap();
    for (words, code, sentence) in [
        (format!("compare orders sunny {SKY}"), 2, "sunny"),
        (
            format!("compare orders orders {SKY} --solver monte-carlo"),
            2,
            "expected two solvers",
        ),
        (
            format!("compare orders orders {SKY} --paths 256"),
            2,
            "try monte-carlo",
        ),
        (format!("compare orders orders {SKY} -o a.jpg"), 2, ".png"),
        ("grid bad.toml -o a.png".to_owned(), 2, "line 2"),
        ("grid ignored.toml -o a.png".to_owned(), 2, "cell 1"),
        ("grid none.toml -o a.png".to_owned(), 1, "none.toml"),
        ("grid bad.toml -o a.jpg".to_owned(), 2, ".png"),
    ] {
        let output = run(&folder, &words);
        let text = String::from_utf8(output.stderr).unwrap();
        assert_eq!(output.status.code(), Some(code), "{words}: {text}");
        assert!(text.contains(sentence), "{words}: {text}");
    }
}
