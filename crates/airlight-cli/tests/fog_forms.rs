//! Fog as its sources print it, and as it is by default: what pictures it makes, and what is refused.

mod common;

use airlight::fog::lights::{LightForm, LightRayGeometry};
use common::batch::{WORDS, bytes, manifest, pictures};
use common::{Exr, Folder, command, run, succeed};
use glam::DVec3;
use std::f64::consts::PI;
use std::path::Path;

const SIZE: (usize, usize) = (32, 24);

/// A picture in which all is black, and a depth of 10 m.
fn black() -> Folder {
    let folder = Folder::new();
    let (width, height) = SIZE;
    let black = |_, _| (0.0f32, 0.0f32, 0.0f32);
    exr::prelude::write_rgb_file(folder.file("black.exr"), width, height, black).unwrap();
    depth(&folder.file("ten.npy"), 10.0);
    folder
}

/// One depth for all.
fn depth(path: &Path, metres: f32) {
    let mut head = b"\x93NUMPY\x01\x00".to_vec();
    let text = "{'descr': '<f4', 'fortran_order': False, 'shape': (24, 32), }";
    let text = format!("{text:<117}\n");
    head.extend((text.len() as u16).to_le_bytes());
    head.extend(text.bytes());
    head.extend(std::iter::repeat_n(metres.to_le_bytes(), SIZE.0 * SIZE.1).flatten());
    std::fs::write(path, head).unwrap();
}

const BLACK: &str =
    "fog black.exr --depth ten.npy --visibility-m 20 --droplets isotropic -q -o out.exr";

fn made(folder: &Folder, words: &str, more: &[&str]) -> Exr {
    let words = format!("{BLACK} --layers {words}");
    let output = command(folder, &words).args(more).output().unwrap();
    let error = String::from_utf8_lossy(&output.stderr);
    assert!(output.status.success(), "{words} {more:?}: {error}");
    Exr::read(&folder.file("out.exr"))
}

/// Path radiance over opacity in each pixel, green.
fn sources(picture: &Exr) -> Vec<f64> {
    let path = picture.channels["path_radiance.G"].iter();
    let through = picture.channels["transmittance.G"].iter();
    path.zip(through)
        .map(|(s, t)| f64::from(*s) / (1.0 - f64::from(*t)))
        .collect()
}

/// Ishiyama's (21): S = (p L_sun + L_amb) (1 - T), wherever one looks.
#[test]
fn an_undimmed_sun_is_height_fog_as_printed() {
    let folder = black();
    let fog = "--model height --scale-height-m 8 --ambient 0.2,0.4,0.6";
    let sun = "--sun-elevation 15 --sun-strength 3";
    // Irradiance 3 pi of the ambient light, times 1 / (4 pi): 3 / 4 of it.
    let printed = made(&folder, &format!("{fog} {sun} --scattering undimmed"), &[]);
    assert!(
        sources(&printed)
            .iter()
            .all(|j| (j / 0.7 - 1.0).abs() < 1e-4)
    );
    let single = made(&folder, &format!("{fog} {sun} --scattering single"), &[]);
    assert!(sources(&single).iter().all(|j| *j > 0.4 && *j < 0.69));
    let all = made(&folder, &format!("{fog} {sun}"), &[]);
    let apart = sources(&all).into_iter().zip(sources(&single));
    assert!(apart.into_iter().all(|(a, s)| (a / s - 1.0).abs() > 0.01));
    // What is told of the default is the default.
    let told = made(&folder, &format!("{fog} {sun} --scattering all"), &[]);
    assert_eq!(told.channels, all.channels);
}

#[test]
fn without_a_sun_or_in_even_fog_forms_agree() {
    let folder = black();
    let ambient = "--ambient 0.2,0.4,0.6";
    let of = |fog: &str, scattering| {
        let words = format!("{fog} {ambient} --scattering {scattering}");
        made(&folder, &words, &[])
    };
    // Even light is a constant source.
    let height = "--model height --scale-height-m 8";
    let [single, undimmed] = ["single", "undimmed"].map(|which| of(height, which));
    assert_eq!(single.channels, undimmed.channels);
    assert!(
        sources(&single)
            .iter()
            .all(|j| (j / 0.4 - 1.0).abs() < 1e-4)
    );
    // Even fog counts as lit evenly, by the sun as well.
    for even in ["", "--sun-elevation 30"] {
        let [all, single, undimmed] = ["all", "single", "undimmed"].map(|which| of(even, which));
        assert_eq!(all.channels, single.channels);
        assert_eq!(all.channels, undimmed.channels);
    }
}

/// Pixel (20, 8) of 32 across 60 degrees from a height of 1.6 m, and a lamp that its line passes.
#[test]
fn lamps_shine_as_their_form_says() {
    let folder = black();
    let focal_px = 16.0 / 30f64.to_radians().tan();
    let along = DVec3::new((20.5 - 16.0) / focal_px, (12.0 - 8.5) / focal_px, -1.0);
    let (eye, lamp) = (DVec3::Y * 1.6, DVec3::new(1.0, 2.0, -4.0));
    let passage = LightRayGeometry::new(eye, along.normalize(), 10.0 * along.length(), lamp, 1e-3);
    let extinction = 20f64.recip() * -0.05f64.ln();
    let words = "at=1,2,-4 intensity=2,1,0.5 radius=0.001";
    for (name, form) in [
        ("exact", LightForm::Exact),
        ("split-sum", LightForm::SplitSum),
        ("no-extinction", LightForm::NoExtinction),
        ("printed", LightForm::Printed),
    ] {
        let more = ["--lamp", words, "--lamp-form", name];
        let picture = made(&folder, "--ambient 0,0,0", &more);
        let right = extinction * form.airlight(&passage, extinction);
        for (lane, intensity) in [2.0, 1.0, 0.5].into_iter().enumerate() {
            let got = f64::from(picture.rgb(20, 8)[lane]);
            assert!(
                (got / (intensity * right) - 1.0).abs() < 1e-4,
                "{name} {lane}: {got} {right}"
            );
        }
        // Where the lamp is passed the printed form takes light away, in the layers as in the picture.
        assert_eq!(right < 0.0, name == "printed");
        let path = picture.channels["path_radiance.G"][8 * 32 + 20];
        assert_eq!(path, picture.rgb(20, 8)[1]);
    }
    // Behind the wall it is not passed, and too bright by its unit alone.
    let behind = "at=1,2,-40 intensity=1 radius=0.001";
    let [printed, right] = ["printed", "no-extinction"].map(|form| {
        let more = ["--lamp", behind, "--lamp-form", form];
        made(&folder, "--ambient 0,0,0", &more).rgb(20, 8)[1]
    });
    assert!((f64::from(printed / right) / (4.0 * PI * PI) - 1.0).abs() < 1e-5);
}

#[test]
fn unclamped_fog_is_thicker_below_the_base_only() {
    let folder = black();
    let of = |model: &str, base_m: f64| {
        let words = format!("--model {model} --base-height-m {base_m} --scale-height-m 4");
        made(&folder, &format!("{words} --ambient 1,1,1"), &[])
    };
    let through = |picture: &Exr| picture.channels["transmittance.G"][12 * 32 + 16];
    // The wall stands above a base of -20 m, and below one of 20 m.
    let [above, clamped_above] = ["unclamped", "clamped"].map(|model| through(&of(model, -20.0)));
    assert!((above / clamped_above - 1.0).abs() < 1e-6);
    let [below, clamped_below] = ["unclamped", "clamped"].map(|model| through(&of(model, 20.0)));
    assert!(below < 0.1 * clamped_below, "{below} {clamped_below}");
}

#[test]
fn forms_refuse_what_they_do_not_hold_for() {
    let folder = black();
    let lamp = "pixel=3,3 distance=4 intensity=1";
    let spot = "pixel=3,3 distance=4 intensity=1 kind=spot";
    let printed = "--lamp-form printed";
    for (words, more, part) in [
        (printed, vec![], "give --lamp"),
        (
            "--lamp-form split-sum --model height",
            vec![lamp],
            "--model uniform",
        ),
        (
            "--lamp-form printed --droplets fine",
            vec![lamp],
            "--droplets isotropic",
        ),
        ("--lamp-form no-extinction", vec![spot], "kind=point"),
        ("--scattering single --model exp2", vec![], "looks"),
        (
            "--scattering single --solver monte-carlo --sky-light --sun-elevation 20",
            vec![],
            "leave out --scattering",
        ),
        (
            "--lamp-form printed --vary model=uniform,slab",
            vec![lamp],
            "--model uniform",
        ),
        (
            "--lamp-form printed --vary droplets=fine,isotropic",
            vec![lamp],
            "--droplets isotropic",
        ),
    ] {
        let words = match words.contains("--droplets fine") {
            true => format!("{} {words}", BLACK.replace("--droplets isotropic", "")),
            false => format!("{BLACK} {words}"),
        };
        let lamps = more.iter().flat_map(|lamp| ["--lamp", lamp]);
        let output = command(&folder, &words).args(lamps).output().unwrap();
        let error = String::from_utf8_lossy(&output.stderr);
        assert_eq!(output.status.code(), Some(2), "{words}: {error}");
        assert!(error.contains(part), "{words}: {error}");
    }
    let layer = ["--lamp", lamp, "--layer", "visibility=50"];
    let words = format!("{BLACK} {printed}");
    let output = command(&folder, &words).args(layer).output().unwrap();
    assert!(String::from_utf8_lossy(&output.stderr).contains("leave out --layer"));
    assert_eq!(folder.names(), ["black.exr", "ten.npy"]);
    let sky = "sky --sun-elevation 20 --fog-visibility-m 300 --fog-scattering single --size 16x8 -o a.exr";
    let output = run(&folder, &format!("{sky} --solver monte-carlo"));
    assert!(String::from_utf8_lossy(&output.stderr).contains("leave out --fog-scattering"));
}

/// Manifests tell the forms, and pictures made otherwise are not taken for done; those of older versions were made by default.
#[test]
fn manifests_tell_the_forms() {
    let folder = pictures(&["a"]);
    let words = format!("{WORDS} --visibility-m 20 --model height --sun-elevation 20");
    succeed(&folder, &words);
    let path = folder.file("out/manifest.jsonl");
    let line = &manifest(&path)["a.png"];
    assert_eq!(
        (&line["scattering"], &line["lamp_form"]),
        (&"all".into(), &"exact".into())
    );
    let first = bytes(&folder, "out/a.png");
    // As an older version would have written it.
    let text = std::fs::read_to_string(&path).unwrap();
    let old = text
        .replace("\"scattering\":\"all\",", "")
        .replace("\"lamp_form\":\"exact\",", "");
    assert!(!old.contains("\"scattering\"") && !old.contains("lamp_form"));
    std::fs::write(&path, old).unwrap();
    assert!(succeed(&folder, &words).contains("already"));
    let output = run(&folder, &format!("{words} --scattering single"));
    let error = String::from_utf8_lossy(&output.stderr);
    assert_eq!(output.status.code(), Some(2), "{error}");
    assert!(
        error.contains("scattering was \"all\", is \"single\""),
        "{error}"
    );
    succeed(&folder, &format!("{words} --scattering single --overwrite"));
    assert_eq!(manifest(&path)["a.png"]["scattering"], "single");
    assert_ne!(bytes(&folder, "out/a.png"), first);
}

/// The fog of a sky scatters as it is told to, in colours and in spectra, and the file says so.
#[test]
fn skies_have_fog_of_each_kind() {
    let folder = Folder::new();
    let sky = "sky --sun-elevation 12 --fog-visibility-m 300 --size 32x16 --sun-disc out --wavelengths fast -q";
    let of = |which: &str| {
        succeed(&folder, &format!("{sky} --fog-scattering {which} -o a.exr"));
        Exr::read(&folder.file("a.exr"))
    };
    let (all, single, undimmed) = (of("all"), of("single"), of("undimmed"));
    succeed(&folder, &format!("{sky} -o b.exr"));
    assert_eq!(Exr::read(&folder.file("b.exr")).channels, all.channels);
    // Level, and away from the sun.
    let luminance = |picture: &Exr| picture.luminance(0, 7);
    assert!(luminance(&undimmed) > 1.2 * luminance(&single));
    assert!((luminance(&all) / luminance(&single) - 1.0).abs() > 0.05);
    assert!(single.texts["fog"].ends_with("light scattered once"));
    assert!(!all.texts["fog"].contains("once"));
    succeed(
        &folder,
        &format!("{sky} --fog-scattering single -o a.spectral.exr"),
    );
    let spectral = Exr::read(&folder.file("a.spectral.exr")).luminance(0, 7);
    assert!((spectral / luminance(&single) - 1.0).abs() < 0.02);
}
