//! Fog over a picture by random paths.

mod common;

use common::{Exr, Folder, command, run, succeed};
use std::fs;

const SIZE: (usize, usize) = (12, 8);

/// A dark picture whose lower half is 40 m away, and sky above.
fn hedge(folder: &Folder) {
    let (width, height) = SIZE;
    let dark = |_, _| (0.02f32, 0.03f32, 0.01f32);
    exr::prelude::write_rgb_file(folder.file("dark.exr"), width, height, dark).unwrap();
    let mut pfm = format!("Pf\n{width} {height}\n-1.0\n").into_bytes();
    for y in 0..height {
        // From the lowest row up.
        let depth: f32 = if y < height / 2 { 40.0 } else { f32::INFINITY };
        (0..width).for_each(|_| pfm.extend(depth.to_le_bytes()));
    }
    fs::write(folder.file("depth.pfm"), pfm).unwrap();
}

const FOG: &str = "fog dark.exr --depth depth.pfm -q --sky-light --sun-elevation 25 --sun-azimuth 200 --visibility-m 60 \
    --model slab --top-m 60 --eye-height-m 20 --droplets fine --radiance-scale 1e-4 --layers";

/// The path radiance is that of the fast solution, which states 3 % in fog as thick as this (an optical depth of 3).
#[test]
fn two_solvers_lay_one_fog() {
    let folder = Folder::new();
    hedge(&folder);
    for air in ["drawn", "missing"] {
        succeed(&folder, &format!("{FOG} --air {air} -o fast.exr"));
        succeed(
            &folder,
            &format!(
                "{FOG} --air {air} --solver monte-carlo --paths 2048 --noise-map -o paths.exr"
            ),
        );
        let [fast, paths, noise] = ["fast.exr", "paths.exr", "paths.noise.exr"]
            .map(|name| Exr::read(&folder.file(name)).channels);
        let name = "path_radiance.G";
        let values = fast[name].iter().zip(&paths[name]).zip(&noise["G"]);
        let (mut sums, mut squares) = ([0.0; 2], 0.0);
        for ((fast, paths), error) in values {
            assert!(*error > 0.0 && *error < *paths, "{error} of {paths}");
            sums[0] += f64::from(*fast);
            sums[1] += f64::from(*paths);
            squares += f64::from(*error).powi(2);
        }
        let (off, noise) = (sums[0] / sums[1] - 1.0, squares.sqrt() / sums[1]);
        assert!(noise < 0.03, "{noise}");
        assert!(off.abs() < 0.03 + 3.0 * noise, "{air}: {off} +- {noise}");
        // What the fog lets through is no matter of chance.
        assert_eq!(fast["transmittance.G"], paths["transmittance.G"]);
        // The picture is made of its layers.
        let seen = paths["R"][5];
        let made = 0.02 * paths["transmittance.R"][5] + paths["path_radiance.R"][5];
        assert!((seen - made).abs() < 1e-5 * seen);
    }
}

/// A thing under the level ground is as deep in fog as its depth says: paths do not reach it, but it is not left out.
#[test]
fn things_under_the_ground_are_in_fog_too() {
    let folder = Folder::new();
    hedge(&folder);
    let low = FOG.replace("--eye-height-m 20", "--eye-height-m 1.6");
    succeed(&folder, &format!("{low} -o fast.exr"));
    succeed(
        &folder,
        &format!("{low} --solver monte-carlo --paths 1024 -o paths.exr"),
    );
    let [fast, paths] =
        ["fast.exr", "paths.exr"].map(|name| Exr::read(&folder.file(name)).channels);
    // The lowest two rows: 40 m, and the ground 5 to 8 m away.
    let sum = |values: &[f32]| values[6 * SIZE.0..].iter().sum::<f32>();
    let ratio = sum(&paths["path_radiance.G"]) / sum(&fast["path_radiance.G"]);
    assert!((0.7..1.1).contains(&ratio), "{ratio}");
}

#[test]
fn threads_change_nothing_and_seeds_the_noise() {
    let folder = Folder::new();
    hedge(&folder);
    let words = format!("{FOG} --solver monte-carlo --paths 128");
    for (threads, more) in [
        ("1", "-o a.exr"),
        ("2", "-o b.exr"),
        ("2", "--seed 2 -o c.exr"),
    ] {
        let mut command = command(&folder, &format!("{words} {more}"));
        let output = command.env("RAYON_NUM_THREADS", threads).output().unwrap();
        assert!(output.status.success());
    }
    let [a, b, c] = ["a.exr", "b.exr", "c.exr"].map(|name| Exr::read(&folder.file(name)).channels);
    assert!(a == b && a != c);
}

#[test]
fn what_random_paths_cannot_do_is_refused() {
    let folder = Folder::new();
    hedge(&folder);
    let fog = "fog dark.exr --depth depth.pfm --visibility-m 60";
    let lit = "--sky-light --sun-elevation 5";
    for (words, said) in [
        (
            format!("{fog} --solver monte-carlo -o a.exr"),
            "--sky-light",
        ),
        (
            format!("{fog} {lit} --solver monte-carlo -o a.exr"),
            "upper end",
        ),
        (
            format!("{fog} --paths 256 -o a.exr"),
            "--solver monte-carlo",
        ),
        (
            format!("{fog} --noise-map -o a.exr"),
            "--solver monte-carlo",
        ),
        (format!("{fog} --seed 3 -o a.exr"), "--vary"),
        (
            format!("{fog} {lit} --model exp2 --solver monte-carlo -o a.exr"),
            "--sky-light",
        ),
        (
            format!("{fog} {lit} --model slab --solver monte-carlo --jobs 1 -o a.exr"),
            "one picture",
        ),
        (
            format!("{fog} {lit} --model slab --solver monte-carlo --paths 5 -o a.exr"),
            "128",
        ),
    ] {
        let output = run(&folder, &words);
        let text = String::from_utf8_lossy(&output.stderr).into_owned();
        assert_eq!(output.status.code(), Some(2), "{words}: {text}");
        assert!(text.contains(said), "{words}: {text}");
        assert_eq!(folder.names(), ["dark.exr", "depth.pfm"], "{words}");
    }
}
