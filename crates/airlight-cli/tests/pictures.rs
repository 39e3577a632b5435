//! Every format is written and read back; the light in it is that of the report and of the probe.

mod common;

use airlight_image::{Camera, CubeFace, Fisheye, Frame, Projection, Size};
use common::{Exr, Folder, number_after, run, succeed, views_of};
use image::GenericImageView;

/// Options that solve quickly.
const QUICK: &str = "--wavelengths rgb --scattering single";

fn equirectangular(width: u32, height: u32) -> Frame {
    Frame::new(
        Projection::Equirectangular {
            center_azimuth_deg: 0.0,
        },
        width,
        height,
    )
    .unwrap()
}

#[test]
fn the_disc_carries_the_suns_irradiance_at_every_size() {
    let folder = Folder::new();
    for (size, elevation, azimuth) in [
        ("2x1", 30.0, 200.0),
        ("16x8", 45.0, 90.0),
        ("33x17", 89.9, 0.0),
        ("256x128", 90.0, 0.0),
        ("256x128", 0.05, 12.3),
        ("1024x512", 7.0, 359.9),
        ("2048x1024", 0.0, 100.0),
    ] {
        let words = format!(
            "sky {QUICK} --sun-elevation {elevation} --sun-azimuth {azimuth} --size {size} --sun-disc separate -o a.exr"
        );
        let said = number_after(&succeed(&folder, &words), "illuminance   sun");
        let picture = Exr::read(&folder.file("a.sun.exr"));
        let frame = equirectangular(picture.width, picture.height);
        let sum = picture.sum(&frame, |_| 1.0);
        assert!(
            (sum / said - 1.0).abs() < 0.01,
            "{size} at {elevation} deg: {sum} against {said} lx"
        );
        assert!(Exr::read(&folder.file("a.exr")).sum(&frame, |_| 1.0) > 0.0);
    }
}

#[test]
fn the_disc_carries_the_suns_irradiance_in_every_projection() {
    let folder = Folder::new();
    let size = Size::new(200, 100).unwrap();
    let camera = Camera {
        roll_deg: 20.0,
        ..Camera::with_horizontal_fov(170.0, 15.0, 75.0, size)
    };
    let zoomed = Camera::with_horizontal_fov(180.0, 20.0, 2.0, size);
    for (options, frame) in [
        (
            "--projection fisheye --size 64x64",
            Frame::new(Projection::AngularFisheye(Fisheye::ALL_SKY), 64, 64),
        ),
        (
            "--projection perspective --size 200x100 --camera-azimuth 170 --camera-elevation 15 --camera-roll 20",
            Frame::new(Projection::Perspective(camera), 200, 100),
        ),
        (
            "--projection perspective --size 200x100 --camera-elevation 20 --fov 2",
            Frame::new(Projection::Perspective(zoomed), 200, 100),
        ),
    ] {
        let words =
            format!("sky {QUICK} --sun-elevation 20 --sun-disc separate -o a.exr {options}");
        let said = number_after(&succeed(&folder, &words), "illuminance   sun");
        let sum = Exr::read(&folder.file("a.sun.exr")).sum(&frame.unwrap(), |_| 1.0);
        assert!(
            (sum / said - 1.0).abs() < 0.01,
            "{options}: {sum} against {said} lx"
        );
    }
}

#[test]
fn the_whole_picture_holds_the_light_that_is_told() {
    let folder = Folder::new();
    let text = succeed(
        &folder,
        "sky --at 48.8584,2.2945 --when 2026-06-21T21:15:00+02:00 --wavelengths fast --size 512x256 -o a.exr",
    );
    assert!(
        (number_after(&text, "elevation") - 5.171).abs() < 0.002,
        "{text}"
    );
    assert!(
        (number_after(&text, "azimuth") - 300.426).abs() < 0.002,
        "{text}"
    );
    let told = number_after(&text, "lx facing it,") + number_after(&text, "horizontal; sky");
    let picture = Exr::read(&folder.file("a.exr"));
    let sum = picture.sum(&equirectangular(512, 256), |direction| direction.y.max(0.0));
    assert!((sum / told - 1.0).abs() < 0.01, "{sum} against {told} lx");
    for part in ["to solve", "to draw", "a.exr: 512 x 256"] {
        assert!(text.contains(part), "{text}");
    }
    // What the file says about itself.
    assert!(picture.texts["units"].contains("cd/m^2"));
    assert!(picture.texts["command"].starts_with("airlight sky --at 48.8584,2.2945"));
    assert!(picture.texts["whitePoint"].contains("0.3127"));
    assert_eq!(picture.texts["time"], "2026-06-21T21:15:00+02:00");
    assert_eq!(picture.attributes.latitude, Some(48.8584));
    assert_eq!(picture.attributes.white_luminance, Some(1.0));
    assert_eq!(picture.attributes.utc_offset, Some(-7200.0));
    assert_eq!(
        picture
            .attributes
            .capture_date
            .as_ref()
            .unwrap()
            .to_string(),
        "2026:06:21 21:15:00"
    );
    assert!(picture.shared.chromaticities.is_some());
}

#[test]
fn pixel_table_and_probe_agree() {
    let folder = Folder::new();
    let sun = "--wavelengths fast --sun-elevation 25 --sun-azimuth 140";
    succeed(
        &folder,
        &format!("sky {sun} --size 64x32 --sun-disc out -o a.exr"),
    );
    succeed(
        &folder,
        &format!("sky {sun} --size 64x32 --sun-disc out -o a.spectral.exr"),
    );
    let (picture, spectral) = (
        Exr::read(&folder.file("a.exr")),
        Exr::read(&folder.file("a.spectral.exr")),
    );
    let frame = equirectangular(64, 32);
    let pixels = [(10, 3), (40, 14), (57, 13), (5, 20), (31, 8)];
    let views = views_of(&frame, &pixels);
    let json = succeed(&folder, &format!("probe {sun} --format json {views}"));
    let answer: serde_json::Value = serde_json::from_str(&json).unwrap();
    for (view, &(x, y)) in answer["views"].as_array().unwrap().iter().zip(&pixels) {
        let close = |got: f32, want: &serde_json::Value, what: &str| {
            let want = want.as_f64().unwrap();
            assert!(
                (f64::from(got) / want - 1.0).abs() < 0.01,
                "{what} at {x}, {y}: {got} against {want}"
            );
        };
        for (c, value) in picture.rgb(x, y).into_iter().enumerate() {
            close(value, &view["rgb_cd_m2"][c], "RGB");
        }
        for (lane, nm) in answer["wavelengths_nm"]
            .as_array()
            .unwrap()
            .iter()
            .enumerate()
        {
            let name = airlight_image::output::spectral::channel_name(nm.as_f64().unwrap());
            let value = spectral.channels[&name][(y * 64 + x) as usize];
            close(value, &view["radiance_w_m2_sr_nm"][lane], &name);
        }
        for (a, b) in spectral.rgb(x, y).iter().zip(picture.rgb(x, y)) {
            assert!((a / b - 1.0).abs() < 1e-3, "{a} {b}");
        }
    }
}

#[test]
fn display_pictures_are_neither_black_nor_white() {
    let folder = Folder::new();
    for elevation in [50.0, 2.0, -8.0] {
        for name in ["a.png", "a.jpg", "a.hdr"] {
            let bits = if elevation == 2.0 { "--bits 16" } else { "" };
            let words =
                format!("sky {QUICK} --sun-elevation {elevation} --size 64x32 {bits} -o {name} -q");
            assert_eq!(succeed(&folder, &words), "");
            let picture = image::open(folder.file(name)).unwrap();
            assert_eq!(picture.dimensions(), (64, 32));
            if name == "a.hdr" {
                continue;
            }
            let grey: Vec<f64> = picture
                .to_rgb8()
                .pixels()
                .map(|p| p.0.map(f64::from).iter().sum::<f64>() / 3.0)
                .collect();
            let sky = grey[..grey.len() / 2].iter().sum::<f64>() / (grey.len() / 2) as f64;
            assert!((40.0..220.0).contains(&sky), "{elevation} {name}: {sky}");
        }
    }
    // A camera's exposure: three stops more are darker.
    let mean = |ev: f64| {
        succeed(
            &folder,
            &format!("sky {QUICK} --sun-elevation 50 --size 32x16 --exposure {ev} -o e.png"),
        );
        let picture = image::open(folder.file("e.png")).unwrap().to_rgb8();
        picture.pixels().map(|p| f64::from(p.0[2])).sum::<f64>()
    };
    assert!(mean(13.0) > 1.3 * mean(16.0));
}

#[test]
fn half_precision_tells_of_the_sun_it_cuts_off() {
    let folder = Folder::new();
    let words = format!("sky {QUICK} --sun-elevation 30 --size 64x32 --precision half");
    let output = run(&folder, &format!("{words} -o a.exr"));
    assert!(output.status.success());
    assert!(String::from_utf8_lossy(&output.stderr).contains("--precision float"));
    let picture = Exr::read(&folder.file("a.exr"));
    assert!(picture.is_half);
    assert_eq!(
        picture.channels["R"].iter().copied().fold(0.0, f32::max),
        65504.0
    );
    let output = run(
        &folder,
        &format!("{words} --scale 1e-5 --compression piz -o b.exr"),
    );
    assert!(output.stderr.is_empty());
    let scaled = Exr::read(&folder.file("b.exr"));
    assert!((scaled.attributes.white_luminance.unwrap() / 1e5 - 1.0).abs() < 1e-6);
    assert!((scaled.rgb(9, 4)[1] / picture.rgb(9, 4)[1] * 1e5 - 1.0).abs() < 0.01);
}

#[test]
fn cubes_have_six_faces_that_fit_together() {
    let folder = Folder::new();
    let words = format!(
        "sky {QUICK} --sun-elevation 30 --projection cube --size 16x16 --sun-disc separate -o a.exr"
    );
    let said = number_after(&succeed(&folder, &words), "illuminance   sun");
    assert_eq!(folder.names().len(), 12);
    let (mut sun, mut sky) = (0.0, 0.0);
    for face in CubeFace::ALL {
        let frame = Frame::new(Projection::CubeFace(face), 16, 16).unwrap();
        sun += Exr::read(&folder.file(&format!("a.sun.{}.exr", face.name()))).sum(&frame, |_| 1.0);
        sky += Exr::read(&folder.file(&format!("a.{}.exr", face.name())))
            .sum(&frame, |d| d.y.max(0.0));
    }
    assert!((sun / said - 1.0).abs() < 0.01, "{sun} {said}");
    let told = number_after(&succeed(&folder, &words), "horizontal; sky");
    assert!((sky / told - 1.0).abs() < 0.02, "{sky} {told}");
}

#[test]
fn colour_spaces_hold_the_same_light() {
    let folder = Folder::new();
    let mut luminances = Vec::new();
    for (space, weights) in [
        ("srgb", [0.212_639, 0.715_169, 0.072_192]),
        ("rec2020", [0.262_700, 0.677_998, 0.059_302]),
        ("acescg", [0.272_229, 0.674_082, 0.053_690]),
    ] {
        succeed(
            &folder,
            &format!("sky {QUICK} --sun-elevation 30 --size 16x8 --color-space {space} -o a.exr"),
        );
        let rgb = Exr::read(&folder.file("a.exr")).rgb(3, 2).map(f64::from);
        luminances.push(rgb.iter().zip(weights).map(|(c, w)| c * w).sum::<f64>());
    }
    assert!(
        luminances
            .iter()
            .all(|l| (l / luminances[0] - 1.0).abs() < 1e-4),
        "{luminances:?}"
    );
}

#[test]
fn the_preview_paints_where_the_terminal_can() {
    let folder = Folder::new();
    let words = format!("sky {QUICK} --sun-elevation 30 --preview --color-space acescg");
    let output = common::command(&folder, &words)
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

#[test]
fn odd_sizes_and_places_are_drawn() {
    let folder = Folder::new();
    for words in [
        "--size 1x1 --sun-elevation 10",
        "--size 1x65 --sun-elevation 10",
        "--size 65536x1 --sun-elevation 10",
        "--size 9x9 --projection fisheye --fov 360 --sun-elevation -30",
        "--size 9x9 --projection perspective --fov 0.001 --camera-elevation 10 --sun-elevation 10",
        "--size 9x9 --projection perspective --fov 179.9 --sun-elevation 10",
        "--size 32x16 --sun-elevation -90",
        "--size 32x16 --sun-elevation 10 --altitude-m 400e3",
        "--size 32x16 --sun-elevation 10 --altitude-m 1e9",
        "--size 32x16 --sun-elevation 10 --altitude-m -12000",
        "--size 32x16 --sun-elevation 10 --atmosphere reference-rayleigh",
    ] {
        for name in ["a.exr", "a.png"] {
            let output = run(&folder, &format!("sky {QUICK} {words} -o {name}"));
            let error = String::from_utf8_lossy(&output.stderr);
            assert!(
                output.status.success() && !error.contains("not a number"),
                "{words}: {error}"
            );
        }
    }
}
