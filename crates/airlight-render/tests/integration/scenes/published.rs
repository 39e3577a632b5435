//! Skies by published models.

use super::{Exr, Folder, equirectangular, probe, rays_of, render};
use airlight_image::output::spectral::channel_name;

const SKY: &str = "sun.elevation_deg = 20\ncamera.size = [16, 8]\n";

#[test]
fn every_model_draws_a_sky_of_its_own() {
    let mut pictures = Vec::new();
    for scene in [
        "solver.name = \"single-scattering\"",
        "solver.name = \"single-scattering\"\nsolver.variant = \"printed\"",
        "solver.name = \"single-scattering\"\nsolver.variant = \"multiple\"\nsolver.sunlight = \"measured\"",
        "solver.name = \"preetham\"",
        "solver.name = \"hillaire2020\"\nsolver.wavelengths = \"rgb\"",
        "solver.name = \"klassen1987\"",
    ] {
        let image = render(&format!("{SKY}{scene}"));
        assert!(image.rgb.iter().flatten().all(|v| v.is_finite()));
        pictures.push(image.rgb);
    }
    for (i, picture) in pictures.iter().enumerate() {
        assert!(pictures[..i].iter().all(|other| other != picture), "{i}");
    }
}

#[test]
fn models_refuse_what_they_do_not_honour() {
    let folder = Folder::new();
    for (scene, part) in [
        (
            "solver.name = \"preetham\"\nair.turbidity = 1.3",
            "from 2 to 10",
        ),
        (
            "solver.name = \"preetham\"\nsolver.variant = \"printed\"",
            "solver.variant",
        ),
        (
            "solver.name = \"preetham\"\nair.ozone_du = 500",
            "air.ozone_du",
        ),
        (
            "solver.name = \"preetham\"\nobserver.altitude_m = 3000",
            "high above the ground",
        ),
        (
            "solver.name = \"klassen1987\"\nsun.elevation_deg = -2",
            "horizon",
        ),
        (
            "solver.name = \"preetham\"\nsun.elevation_deg = -10",
            "got an elevation of -10 degrees",
        ),
        (
            "solver.name = \"preetham\"\nsolver.effort = \"fine\"",
            "solver.effort",
        ),
        (
            "solver.name = \"preetham\"\noutput.spectral = true",
            "hillaire2020",
        ),
        (
            "solver.name = \"single-scattering\"\nobserver.altitude_m = 80e3",
            "60 000 m",
        ),
        (
            "solver.name = \"hillaire2020\"\nsolver.zenith_lux = 6.28",
            "single-scattering",
        ),
        (
            "solver.name = \"monte-carlo\"\nobjects.object = [{ shape = \"ground\" }]",
            "objects",
        ),
        ("output.noise_map = true", "monte-carlo"),
        ("solver.name = \"preeteham\"", "preetham"),
    ] {
        match folder.try_write("a.exr", &format!("{SKY}{scene}")) {
            Ok(_) => panic!("{scene} is drawn"),
            Err(error) => {
                let error = error.to_string();
                assert!(error.contains(part), "{scene}: {error}");
            }
        }
    }
    assert!(folder.names("").is_empty());
}

/// A pixel of a picture is what the probe gives for the direction of its centre, above the horizon and below; in spectra to the
/// last digit, in colours within the steps that the model of 1987 remembers them in.
#[test]
fn pixels_are_what_the_probe_gives() {
    let folder = Folder::new();
    let frame = equirectangular(16, 8);
    for (solver, lanes) in [
        ("solver.name = \"klassen1987\"\nair.ground_albedo = 0.3", 33),
        (
            "solver.name = \"klassen1987\"\nsolver.variant = \"printed\"\nair.ground_albedo = 0.3",
            33,
        ),
        (
            "solver.name = \"hillaire2020\"\nsolver.wavelengths = \"fast\"\nair.ground_albedo = 0.3",
            8,
        ),
        ("solver.name = \"preetham\"\nair.ground_albedo = 0.3", 0),
        (
            "solver.name = \"single-scattering\"\nsolver.variant = \"printed\"",
            0,
        ),
    ] {
        let scene = format!("{SKY}output.sun_disc = \"out\"\n{solver}");
        let picture = folder.exr(&scene);
        let spectra = (lanes > 0).then(|| {
            folder.write("a.spectral.exr", &scene);
            Exr::read(&folder.file("a.spectral.exr"))
        });
        let pixels = [(0, 0), (7, 2), (12, 3), (3, 6)];
        let answer = probe(&scene, &rays_of(&frame, &pixels));
        assert_eq!(answer.wavelengths_nm.len(), lanes, "{solver}");
        for (&(x, y), view) in pixels.iter().zip(&answer.views) {
            assert_eq!(view.meets_ground, y >= 4, "{solver}");
            for (stated, drawn) in view.rgb_cd_m2.iter().zip(picture.rgb(x, y)) {
                let error = f64::from(drawn) / stated - 1.0;
                assert!(error.abs() < 1e-3, "{solver} {x},{y}: {drawn} {stated}");
            }
            let Some(spectra) = &spectra else { continue };
            let at = (y * 16 + x) as usize;
            for (nm, stated) in answer.wavelengths_nm.iter().zip(&view.radiance_w_m2_sr_nm) {
                let drawn = spectra.channels[&channel_name(*nm)][at];
                assert!(
                    (drawn / stated - 1.0).abs() < 1e-6,
                    "{solver} {x},{y} {nm} nm: {drawn} {stated}"
                );
            }
        }
    }
}

/// The disc in a file of its own, summed over its pixels, is the sun's irradiance that the probe gives, at each wavelength.
#[test]
fn the_suns_disc_is_in_the_spectra() {
    let folder = Folder::new();
    for (solver, lanes) in [("klassen1987", 33), ("hillaire2020", 16)] {
        let scene = format!(
            "sun.elevation_deg = 20\nsolver.name = \"{solver}\"\noutput.sun_disc = \"separate\"\n\
             camera = {{ projection = \"perspective\", elevation_deg = 20, fov_deg = 2, size = [32, 32] }}"
        );
        folder.write("a.spectral.exr", &scene);
        let disc = Exr::read(&folder.file("a.sun.spectral.exr"));
        let answer = probe(&scene, &[]);
        // Pixels of so narrow a picture are of one size to 0.1 %.
        let solid_angle = (2.0 * 1f64.to_radians().tan() / 32.0).powi(2);
        let stated = &answer.sun.irradiance_normal_w_m2_nm;
        assert_eq!((answer.wavelengths_nm.len(), stated.len()), (lanes, lanes));
        for (nm, stated) in answer.wavelengths_nm.iter().zip(stated) {
            let pixels = &disc.channels[&channel_name(*nm)];
            let drawn: f64 = pixels.iter().map(|&v| f64::from(v) * solid_angle).sum();
            assert!(
                (drawn / f64::from(*stated) - 1.0).abs() < 0.01,
                "{solver} {nm}: {drawn} {stated}"
            );
        }
    }
}
