//! Monte Carlo pictures and probes beside the deterministic solver.

use super::{Exr, Folder, probe, try_probe};
use airlight_render::probe::{MonteCarloAnswer, ProbeAnswer, ProbeRay};

const SMALL: &str = "sun.elevation_deg = 20\noutput.sun_disc = \"out\"\ncamera.size = [16, 8]\nsolver.wavelengths = \"rgb\"\n";

/// The picture is that of the other solver, as far as its own noise map allows.
#[test]
fn two_solvers_draw_one_sky() {
    let folder = Folder::new();
    folder.write("orders.exr", SMALL);
    folder.write(
        "paths.exr",
        &format!(
            "{SMALL}solver.name = \"monte-carlo\"\nsolver.paths = 1024\noutput.noise_map = true"
        ),
    );
    let names = folder.names("");
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
    let rms = f64::sqrt(squares / count);
    assert!(rms < 1.2, "{rms}");
}

#[test]
fn the_seed_decides_the_noise() {
    let folder = Folder::new();
    let at = |seed: u64| {
        let scene = format!(
            "{SMALL}solver.name = \"monte-carlo\"\nsolver.paths = 128\nsolver.seed = {seed}"
        );
        folder.exr(&scene).channels
    };
    let [a, b, c] = [at(1), at(1), at(2)];
    assert!(a == b && a != c);
}

/// The sun's distance dims the paths as it dims the other solver.
#[test]
fn the_suns_distance_counts() {
    let folder = Folder::new();
    let sum = |scene: &str| -> f64 {
        let picture = folder.exr(&format!("{SMALL}{scene}"));
        picture.channels["G"].iter().map(|&v| f64::from(v)).sum()
    };
    let paths = "solver.name = \"monte-carlo\"\nsolver.paths = 128\n";
    let far = "sun.distance_ratio = 1.1\n";
    let ratio = sum(&format!("{paths}{far}")) / sum(paths);
    assert!((ratio * 1.21 - 1.0).abs() < 1e-3, "{ratio}");
    let ratio = sum(far) / sum("");
    assert!((ratio * 1.21 - 1.0).abs() < 1e-3, "{ratio}");
}

/// Fog is part of the air: a low fog hides the lower sky from within.
#[test]
fn fog_is_followed_too() {
    let folder = Folder::new();
    let fog = "fog = { visibility_m = 300, top_m = 100 }\nsun.azimuth_deg = 0\n\
        camera = { elevation_deg = 30, projection = \"perspective\", azimuth_deg = 120, size = [16, 8] }\n";
    let scene = SMALL.replace("camera.size = [16, 8]\n", "");
    let sum = |more: &str| -> f64 {
        let picture = folder.exr(&format!("{scene}{fog}{more}"));
        let pixels = (0..8).flat_map(|y| (0..16).map(move |x| (x, y)));
        pixels.map(|(x, y)| picture.luminance(x, y)).sum()
    };
    let ratio = sum("solver.name = \"monte-carlo\"\nsolver.paths = 256") / sum("");
    assert!((ratio - 1.0).abs() < 0.1, "{ratio}");
}

#[test]
fn a_probe_gives_both_and_the_error() {
    let scene = "sun.elevation_deg = 30\nsolver = { name = \"monte-carlo\", wavelengths = \"440,550,680\", paths = 16384 }";
    let answer = probe(scene, &[(0.0, 60.0)]);
    let view = &answer.views[0];
    let found = view.monte_carlo.as_ref().unwrap();
    assert_eq!(found.paths, 16384);
    for lane in 0..3 {
        let solved = f64::from(view.radiance_w_m2_sr_nm[lane]);
        let mean = found.radiance_w_m2_sr_nm[lane];
        let error = found.standard_error_w_m2_sr_nm[lane];
        assert!(error > 0.0 && error < 0.01 * mean);
        assert!(
            (solved - mean).abs() < 0.01 * mean + 4.0 * error,
            "{solved} {mean} {error}"
        );
        // Orders are those of scalar light.
        let effect = sum_of_orders(found, lane) / mean - 1.0;
        assert!(effect.abs() > 1e-4 && effect.abs() < 0.05, "{effect}");
    }
    let scalar = scene.replace(
        "solver = { ",
        "solver = { polarisation_correction = false, ",
    );
    let scalar = probe(&scalar, &[(0.0, 60.0)]);
    let found = scalar.views[0].monte_carlo.as_ref().unwrap();
    for lane in 0..3 {
        let mean = found.radiance_w_m2_sr_nm[lane];
        assert!((sum_of_orders(found, lane) / mean - 1.0).abs() < 1e-9);
        let solved = f64::from(scalar.views[0].radiance_w_m2_sr_nm[lane]);
        let error = found.standard_error_w_m2_sr_nm[lane];
        assert!((solved - mean).abs() < 0.01 * mean + 4.0 * error);
    }
    let csv = rectangular_csv(&answer, 4);
    assert!(csv.contains("monte_carlo_standard_error_w_m2_sr_nm"));
}

/// The answer as CSV, whose lines all have the same number of fields.
fn rectangular_csv(answer: &ProbeAnswer, lines: usize) -> String {
    let csv = answer.to_csv();
    let widths: Vec<usize> = csv.lines().map(|line| line.split(',').count()).collect();
    assert!(widths.len() == lines && widths.iter().all(|width| *width == widths[0]));
    csv
}

fn sum_of_orders(found: &MonteCarloAnswer, lane: usize) -> f64 {
    let orders = found.radiance_by_order_w_m2_sr_nm.iter();
    orders.map(|order| order[lane]).sum()
}

/// What the air adds before an object, and before the ground where the ray ends there.
#[test]
fn a_probe_may_end_at_a_distance() {
    let scene = "sun.elevation_deg = 30\nsolver = { name = \"monte-carlo\", wavelengths = \"440,550,680\", paths = 16384 }\n";
    let high = "observer.altitude_m = 2000\nair.ground_altitude_m = 0\n";
    for (elevation_deg, distance_m, more, ground) in [
        (1.0, 20e3, "", false),
        (-10.0, 2e3, high, false),
        (-10.0, 2e3, "", true),
    ] {
        let ray = ProbeRay {
            azimuth_deg: 90.0,
            elevation_deg,
            distance_m: Some(distance_m),
        };
        let answer = try_probe(&format!("{scene}{more}"), vec![ray]).unwrap();
        let view = &answer.views[0];
        let found = view.monte_carlo.as_ref().unwrap();
        assert_eq!(view.meets_ground, ground);
        for lane in 0..3 {
            let solved = f64::from(view.radiance_w_m2_sr_nm[lane]);
            let mean = found.radiance_w_m2_sr_nm[lane];
            let error = found.standard_error_w_m2_sr_nm[lane];
            assert!(error > 0.0 && error < 0.01 * mean);
            assert!(
                (solved - mean).abs() < 0.01 * mean + 4.0 * error,
                "{ray:?} {lane}: {solved} {mean} {error}"
            );
        }
    }
}

/// At a right angle from the sun in its vertical plane light is polarised across that plane: level.
#[test]
fn polarisation_is_followed() {
    let folder = Folder::new();
    let scene = "sun.elevation_deg = 20\nsun.azimuth_deg = 180\noutput.polarisation = true\n\
        solver.name = \"monte-carlo\"\nsolver.wavelengths = \"440,650\"\nsolver.paths = 8192\n";
    let answer = probe(scene, &[(0.0, 70.0)]);
    let found = answer.views[0].monte_carlo.as_ref().unwrap();
    let polarised = found.polarisation.as_ref().unwrap();
    for lane in 0..2 {
        let (degree, angle) = (polarised.degree[lane], polarised.angle_deg[lane]);
        assert!((0.3..0.9).contains(&degree));
        assert!((angle - 90.0).abs() < 4.0 * polarised.angle_standard_error_deg[lane]);
        let (i, q) = (
            polarised.stokes_i_w_m2_sr_nm[lane],
            polarised.stokes_q_w_m2_sr_nm[lane],
        );
        assert!(q < 0.0 && (-q / i / degree - 1.0).abs() < 0.01);
        assert!((i / found.radiance_w_m2_sr_nm[lane] - 1.0).abs() < 1e-9);
    }
    rectangular_csv(&answer, 3);
    let scene = format!("{scene}solver.wavelengths = \"rgb\"\nsolver.paths = 256\n");
    let mean = polarisation_map(&folder, &scene);
    assert!((0.4..0.9).contains(&mean("degree")), "{}", mean("degree"));
    assert!((mean("angle_deg") - 90.0).abs() < 10.0 && mean("Q_over_I") < -0.4);
}

/// Means of the channels of the map of polarisation written with a small picture across the sun's plane.
fn polarisation_map(folder: &Folder, scene: &str) -> impl Fn(&str) -> f32 {
    let scene = format!(
        "{scene}output.sun_disc = \"out\"\n\
         camera = {{ projection = \"perspective\", fov_deg = 2, azimuth_deg = 0, elevation_deg = 70, size = [8, 6] }}"
    );
    folder.write("sky.exr", &scene);
    assert_eq!(folder.names(""), ["sky.exr", "sky.polarisation.exr"]);
    let map = Exr::read(&folder.file("sky.polarisation.exr")).channels;
    move |name| map[name].iter().sum::<f32>() / 48.0
}

/// The solver without noise gives the same polarisation, as numbers and as a map; it does not know that of fog.
#[test]
fn polarisation_is_solved_for() {
    let folder = Folder::new();
    let scene = "sun.elevation_deg = 20\nsun.azimuth_deg = 180\noutput.polarisation = true\n\
        solver.wavelengths = \"440,650\"\n";
    let traced = format!("{scene}solver.name = \"monte-carlo\"\nsolver.paths = 16384\n");
    for ray in [(0.0, 70.0), (120.0, 30.0), (240.0, 30.0)] {
        let [solved, traced] = [scene, &traced].map(|scene| probe(scene, &[ray]));
        let view = &solved.views[0];
        assert!(view.monte_carlo.is_none());
        let (solved_light, traced) = (view.polarisation().unwrap(), &traced.views[0]);
        let traced = traced.polarisation().unwrap();
        for lane in 0..2 {
            let i = traced.stokes_i_w_m2_sr_nm[lane];
            for (solved, traced, error) in [
                (
                    &solved_light.stokes_q_w_m2_sr_nm,
                    &traced.stokes_q_w_m2_sr_nm,
                    &traced.standard_error_q_w_m2_sr_nm,
                ),
                (
                    &solved_light.stokes_u_w_m2_sr_nm,
                    &traced.stokes_u_w_m2_sr_nm,
                    &traced.standard_error_u_w_m2_sr_nm,
                ),
            ] {
                let off = (solved[lane] - traced[lane]).abs();
                assert!(off < 0.01 * i + 4.0 * error[lane], "{ray:?} {lane}: {off}");
            }
        }
        rectangular_csv(&solved, 3);
    }
    let mean = polarisation_map(&folder, scene);
    assert!((0.4..0.9).contains(&mean("degree")), "{}", mean("degree"));
    assert!((mean("angle_deg") - 90.0).abs() < 1.0 && mean("Q_over_I") < -0.4);
    let foggy = format!("{scene}\nfog.visibility_m = 500");
    let error = folder
        .try_write("foggy.exr", &foggy)
        .unwrap_err()
        .to_string();
    assert!(error.contains("monte-carlo"), "{error}");
}

#[test]
fn a_picture_larger_than_memory_is_refused() {
    let folder = Folder::new();
    let scene = format!("{SMALL}solver.name = \"monte-carlo\"\ncamera.size = [20000, 20000]");
    let error = folder.try_write("a.png", &scene).unwrap_err().to_string();
    assert!(error.contains("smaller size"), "{error}");
    assert!(folder.names("").is_empty());
}
