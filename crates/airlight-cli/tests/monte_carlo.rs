//! Random paths from the command line.

mod common;

use common::{Exr, Folder, run, succeed};
use serde_json::Value;
use std::fs;

const SMALL: &str = "sky --quiet --sun-elevation 20 --sun-disc out --size 16x8 --wavelengths rgb";

/// The picture is that of the other solver, as far as its own noise map allows.
#[test]
fn two_solvers_draw_one_sky() {
    let folder = Folder::new();
    succeed(&folder, &format!("{SMALL} -o orders.exr"));
    succeed(
        &folder,
        &format!("{SMALL} --solver monte-carlo --paths 1024 --noise-map -o paths.exr"),
    );
    let mut names = folder.names();
    names.sort();
    assert_eq!(names, ["orders.exr", "paths.exr", "paths.noise.exr"]);
    let [orders, paths, noise] = [0, 1, 2].map(|i: usize| Exr::read(&folder.file(&names[i])));
    let (mut squares, mut count) = (0.0, 0.0);
    for y in 0..8 {
        for x in 0..16 {
            let (want, got, error) = (orders.rgb(x, y)[1], paths.rgb(x, y)[1], noise.rgb(x, y)[1]);
            assert!(
                error > 0.0 && error < 0.2 * got,
                "{x} {y}: {error} of {got}"
            );
            // A percent of the solver, and what a large pixel's middle differs from its mean by.
            let off = f64::from(got - want) / f64::from(error).hypot(0.1 * f64::from(want));
            squares += off * off;
            count += 1.0;
        }
    }
    assert!(
        (squares / count).sqrt() < 1.2,
        "{}",
        (squares / count).sqrt()
    );
}

#[test]
fn threads_change_nothing_and_seeds_the_noise() {
    let folder = Folder::new();
    let words = format!("{SMALL} --solver monte-carlo --paths 128");
    succeed(&folder, &format!("{words} --threads 1 -o a.exr"));
    succeed(&folder, &format!("{words} --threads 2 -o b.exr"));
    succeed(&folder, &format!("{words} --seed 2 -o c.exr"));
    let [a, b, c] = ["a.exr", "b.exr", "c.exr"].map(|name| Exr::read(&folder.file(name)).channels);
    assert!(a == b && a != c);
}

/// Fog is part of the air: a low fog hides the lower sky from within.
#[test]
fn fog_is_followed_too() {
    let folder = Folder::new();
    let fog = "--fog-visibility-m 300 --fog-top-m 100 --camera-elevation 30 --projection perspective --sun-azimuth 0 --camera-azimuth 120";
    succeed(&folder, &format!("{SMALL} {fog} -o orders.exr"));
    succeed(
        &folder,
        &format!("{SMALL} {fog} --solver monte-carlo --paths 512 -o paths.exr"),
    );
    let [orders, paths] = ["orders.exr", "paths.exr"].map(|name| Exr::read(&folder.file(name)));
    let sum = |picture: &Exr| -> f64 {
        let pixels = (0..8).flat_map(|y| (0..16).map(move |x| (x, y)));
        pixels.map(|(x, y)| picture.luminance(x, y)).sum()
    };
    let ratio = sum(&paths) / sum(&orders);
    assert!((ratio - 1.0).abs() < 0.1, "{ratio}");
}

#[test]
fn a_probe_tells_both_and_the_error() {
    let folder = Folder::new();
    let words = "--sun-elevation 30 --view 0,60 --wavelengths 440,550,680 --solver monte-carlo --paths 16384";
    let answer: Value =
        serde_json::from_str(&succeed(&folder, &format!("probe --format json {words}"))).unwrap();
    let view = &answer["views"][0];
    let found = &view["monte_carlo"];
    assert_eq!(found["paths"], 16384);
    for lane in 0..3 {
        let solved = view["radiance_w_m2_sr_nm"][lane].as_f64().unwrap();
        let mean = found["radiance_w_m2_sr_nm"][lane].as_f64().unwrap();
        let error = found["standard_error_w_m2_sr_nm"][lane].as_f64().unwrap();
        assert!(error > 0.0 && error < 0.01 * mean);
        assert!(
            (solved - mean).abs() < 0.01 * mean + 4.0 * error,
            "{solved} {mean} {error}"
        );
        let orders = found["radiance_by_order_w_m2_sr_nm"].as_array().unwrap();
        let sum: f64 = orders
            .iter()
            .map(|order| order[lane].as_f64().unwrap())
            .sum();
        assert!((sum / mean - 1.0).abs() < 1e-9);
    }
    let csv = succeed(&folder, &format!("probe --format csv {words}"));
    let widths: Vec<usize> = csv.lines().map(|line| line.split(',').count()).collect();
    assert!(widths.len() == 4 && widths.iter().all(|width| *width == widths[0]));
    assert!(
        csv.lines()
            .next()
            .unwrap()
            .ends_with("monte_carlo_standard_error_w_m2_sr_nm")
    );
}

/// What the air adds before a thing, and before the ground where the line ends there.
#[test]
fn a_probe_may_end_at_a_distance() {
    let folder = Folder::new();
    let words = "--sun-elevation 30 --wavelengths 440,550,680 --solver monte-carlo --paths 32768";
    for (line, ground) in [
        ("--view 90,1 --distance-m 20e3", false),
        (
            "--view 90,-10 --distance-m 2e3 --altitude-m 2000 --ground-altitude-m 0",
            false,
        ),
        ("--view 90,-10 --distance-m 2e3", true),
    ] {
        let words = format!("probe --format json {words} {line}");
        let answer: Value = serde_json::from_str(&succeed(&folder, &words)).unwrap();
        let view = &answer["views"][0];
        assert_eq!(view["meets_ground"], ground);
        for lane in 0..3 {
            let solved = view["radiance_w_m2_sr_nm"][lane].as_f64().unwrap();
            let found = |name: &str| view["monte_carlo"][name][lane].as_f64().unwrap();
            let (mean, error) = (
                found("radiance_w_m2_sr_nm"),
                found("standard_error_w_m2_sr_nm"),
            );
            assert!(error > 0.0 && error < 0.01 * mean);
            assert!(
                (solved - mean).abs() < 0.01 * mean + 4.0 * error,
                "{line} {lane}: {solved} {mean} {error}"
            );
        }
    }
}

/// At a right angle from the sun in its vertical plane light is polarised across that plane: level.
#[test]
fn polarisation_is_told() {
    let folder = Folder::new();
    let words = "--sun-elevation 20 --sun-azimuth 180 --view 0,70 --wavelengths 440,650 --solver monte-carlo --paths 8192 \
                 --polarisation";
    let answer: Value =
        serde_json::from_str(&succeed(&folder, &format!("probe --format json {words}"))).unwrap();
    let found = &answer["views"][0]["monte_carlo"];
    for lane in 0..2 {
        let of = |name: &str| found["polarisation"][name][lane].as_f64().unwrap();
        assert!((0.3..0.9).contains(&of("degree")));
        assert!((of("angle_deg") - 90.0).abs() < 4.0 * of("angle_standard_error_deg"));
        let q = of("stokes_q_w_m2_sr_nm");
        assert!(q < 0.0 && (-q / of("stokes_i_w_m2_sr_nm") / of("degree") - 1.0).abs() < 0.01);
        // Scalar light is off by percents at most.
        let scalar = found["radiance_w_m2_sr_nm"][lane].as_f64().unwrap();
        assert!((of("stokes_i_w_m2_sr_nm") / scalar - 1.0).abs() < 0.08);
    }
    let csv = succeed(&folder, &format!("probe --format csv {words}"));
    let widths: Vec<usize> = csv.lines().map(|line| line.split(',').count()).collect();
    assert!(widths.len() == 3 && widths.iter().all(|width| *width == widths[0]));
    let table = succeed(&folder, &format!("probe {words}"));
    assert!(table.contains("degree") && table.contains("angle, deg"));
    let sky = "sky -q --sun-elevation 20 --sun-azimuth 180 --sun-disc out --wavelengths rgb --solver monte-carlo \
               --polarisation --projection perspective --fov 2 --camera-azimuth 0 --camera-elevation 70 --size 8x6";
    succeed(&folder, &format!("{sky} --paths 256 -o sky.exr"));
    let names = folder.names();
    assert_eq!(names, ["sky.exr", "sky.polarisation.exr"]);
    let told = Exr::read(&folder.file("sky.polarisation.exr")).channels;
    let mean = |name: &str| told[name].iter().sum::<f32>() / 48.0;
    assert!((0.4..0.9).contains(&mean("degree")), "{}", mean("degree"));
    assert!((mean("angle_deg") - 90.0).abs() < 10.0 && mean("Q_over_I") < -0.4);
}

#[test]
fn what_does_not_go_together_is_refused() {
    let folder = Folder::new();
    for (words, said) in [
        (
            "sky --sun-elevation 5 --paths 256 -o a.exr",
            "--solver monte-carlo",
        ),
        (
            "sky --sun-elevation 5 --polarisation -o a.exr",
            "--solver monte-carlo",
        ),
        (
            "sky --sun-elevation 5 --solver monte-carlo --scattering single --polarisation -o a.exr",
            "--scattering single",
        ),
        (
            "probe --sun-elevation 5 --view 0,5 --polarisation",
            "--solver monte-carlo",
        ),
        (
            "sky --sun-elevation 5 --noise-map -o a.exr",
            "--solver monte-carlo",
        ),
        (
            "sky --sun-elevation 5 --solver monte-carlo --paths 5 -o a.exr",
            "128",
        ),
        (
            "sky --sun-elevation 5 --wavelengths rgb --solver monte-carlo --size 20000x20000 -o a.png",
            "--size",
        ),
    ] {
        let output = run(&folder, words);
        let text = String::from_utf8_lossy(&output.stderr).into_owned();
        assert_eq!(output.status.code(), Some(2), "{words}: {text}");
        assert!(text.contains(said), "{words}: {text}");
        assert!(fs::read_dir(&folder.0).unwrap().next().is_none(), "{words}");
    }
}
