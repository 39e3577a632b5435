//! Skies by published models from the command line.

mod common;

use airlight_image::output::spectral::channel_name;
use airlight_image::{Frame, Projection};
use common::{Exr, Folder, run, succeed, views_of};
use serde_json::Value;

const SKY: &str = "sky --sun-elevation 20 --size 16x8 --wavelengths rgb";

#[test]
fn every_model_draws_a_sky() {
    let folder = Folder::new();
    let mut pictures = Vec::new();
    for (n, options) in [
        "single-scattering",
        "single-scattering --variant printed",
        "single-scattering --variant multiple --sunlight measured",
        "preetham",
        "hillaire2020",
        "bruneton2008",
    ]
    .iter()
    .enumerate()
    {
        let said = succeed(&folder, &format!("{SKY} --solver {options} -o {n}.png"));
        assert!(said.contains("16 x 8"), "{options}: {said}");
        pictures.push(std::fs::read(folder.file(&format!("{n}.png"))).unwrap());
    }
    for (i, picture) in pictures.iter().enumerate() {
        assert!(pictures[..i].iter().all(|other| other != picture), "{i}");
    }
}

#[test]
fn models_refuse_what_they_do_not_know() {
    let folder = Folder::new();
    for (options, part) in [
        ("preetham --turbidity 1.3", "from 2 to 10"),
        ("preetham --variant printed", "one form only"),
        ("preetham --altitude-m 3000", "looks from the ground"),
        ("bruneton2008 --scattering single", "orders of its own"),
        ("single-scattering --altitude-m 80e3", "60 000 m"),
        ("hillaire2020 --zenith-lux 6.28", "single-scattering"),
        ("preetham --spectral", "hillaire2020"),
        (
            "single-scattering --spectral",
            "knows colours and no spectra",
        ),
    ] {
        let output = run(&folder, &format!("{SKY} --solver {options} -o a.exr"));
        let error = String::from_utf8_lossy(&output.stderr);
        assert_eq!(output.status.code(), Some(2), "{options}: {error}");
        assert!(error.contains(part), "{options}: {error}");
    }
    assert!(folder.names().is_empty());
}

#[test]
fn colours_have_no_spectral_picture_by_either_name() {
    let folder = Folder::new();
    let output = run(
        &folder,
        &format!("{SKY} --solver preetham -o a.spectral.exr"),
    );
    assert_eq!(output.status.code(), Some(2));
    assert!(folder.names().is_empty());
}

fn probe(folder: &Folder, words: &str) -> Value {
    serde_json::from_str(&succeed(folder, &format!("probe --format json {words}"))).unwrap()
}

fn list(value: &Value) -> Vec<f64> {
    let list = value.as_array().unwrap().iter();
    list.map(|v| v.as_f64().unwrap()).collect()
}

/// A pixel of a picture is what the probe tells of the direction in its middle, above the horizon and below; in spectra to the
/// last digit, in colours within the steps that the model of 1987 remembers them in.
#[test]
fn pixels_are_what_the_probe_tells() {
    let folder = Folder::new();
    let projection = Projection::Equirectangular {
        center_azimuth_deg: 0.0,
    };
    let frame = Frame::new(projection, 16, 8).unwrap();
    for (solver, lanes) in [
        ("klassen1987", 33),
        ("klassen1987 --variant printed", 33),
        ("hillaire2020 --wavelengths fast", 8),
        ("bruneton2008 --wavelengths fast", 8),
        ("preetham", 0),
        ("single-scattering --variant printed", 0),
    ] {
        let sun = format!("--sun-elevation 20 --ground-albedo 0.3 --solver {solver}");
        let sky = format!("sky {sun} --size 16x8 --sun-disc out");
        succeed(&folder, &format!("{sky} -o a.exr"));
        let picture = Exr::read(&folder.file("a.exr"));
        let spectra = (lanes > 0).then(|| {
            succeed(&folder, &format!("{sky} -o a.spectral.exr"));
            Exr::read(&folder.file("a.spectral.exr"))
        });
        let pixels = [(0, 0), (7, 2), (12, 3), (3, 6)];
        let views = views_of(&frame, &pixels);
        let answer = probe(&folder, &format!("{sun}{views}"));
        let nm = list(&answer["wavelengths_nm"]);
        assert_eq!(nm.len(), lanes, "{solver}");
        for (&(x, y), view) in pixels.iter().zip(answer["views"].as_array().unwrap()) {
            assert_eq!(view["meets_ground"], y >= 4, "{solver}");
            let colours = list(&view["rgb_cd_m2"]);
            for (told, drawn) in colours.iter().zip(picture.rgb(x, y)) {
                let error = f64::from(drawn) / told - 1.0;
                assert!(error.abs() < 1e-3, "{solver} {x},{y}: {drawn} {told}");
            }
            let Some(spectra) = &spectra else { continue };
            let at = (y * 16 + x) as usize;
            for (nm, told) in nm.iter().zip(list(&view["radiance_w_m2_sr_nm"])) {
                let drawn = f64::from(spectra.channels[&channel_name(*nm)][at]);
                assert!(
                    (drawn / told - 1.0).abs() < 1e-6,
                    "{solver} {x},{y} {nm} nm: {drawn} {told}"
                );
            }
        }
    }
}

/// The disc in a file of its own, summed over its pixels, is the sun's irradiance that the probe tells, at each wavelength.
#[test]
fn the_suns_disc_is_in_the_spectra() {
    let folder = Folder::new();
    for (solver, lanes) in [
        ("klassen1987", 33),
        ("hillaire2020", 16),
        ("bruneton2008", 16),
    ] {
        let sun = format!("--sun-elevation 20 --solver {solver}");
        let camera = "--projection perspective --camera-elevation 20 --fov 2 --size 32x32";
        succeed(
            &folder,
            &format!("sky {sun} {camera} --sun-disc separate -o a.spectral.exr"),
        );
        let disc = Exr::read(&folder.file("a.sun.spectral.exr"));
        let answer = probe(&folder, &sun);
        // Pixels of so narrow a picture are of one size to 0.1 %.
        let solid_angle = (2.0 * 1f64.to_radians().tan() / 32.0).powi(2);
        let (nm, told) = (
            list(&answer["wavelengths_nm"]),
            list(&answer["sun"]["irradiance_normal_w_m2_nm"]),
        );
        assert_eq!((nm.len(), told.len()), (lanes, lanes));
        for (nm, told) in nm.iter().zip(told) {
            let pixels = &disc.channels[&channel_name(*nm)];
            let drawn: f64 = pixels.iter().map(|&v| f64::from(v) * solid_angle).sum();
            assert!(
                (drawn / told - 1.0).abs() < 0.01,
                "{solver} {nm}: {drawn} {told}"
            );
        }
    }
}
