//! Fog against outside truth: Henyey-Greenstein slabs and exponential fog under a sun of unit irradiance, by Mitsuba (path
//! tracing, with standard errors) and PythonicDISORT. `data/README.md` says where the tables come from.

use airlight::axes::direction;
use airlight::fog::{Fog, Ground, Layer, Light, Matter, Profile, Scattering, Sun};
use airlight::optics::PhaseFunction;
use airlight::path::PathOptics;
use airlight::spectrum::Spectrum;

/// The lines of a table without its head, split at the commas.
fn rows(table: &'static str) -> impl Iterator<Item = Vec<&'static str>> {
    table.lines().skip(1).map(|line| line.split(',').collect())
}

/// One row: the fog, and the line of sight from the ground through all of it.
fn whole_line(row: &[&str], scattering: Scattering) -> PathOptics<1> {
    let number = |column: usize| row[column].parse::<f64>().unwrap();
    let (g, omega, mut depth) = (number(1), number(2), number(3));
    if row[0] == "expfog" {
        // The path tracer's fog ends ten scale heights up; only its optical depth counts.
        depth *= 1.0 - f64::exp(-10.0);
    }
    let (sun_zenith, view_zenith, azimuth) = (number(4), number(5), number(6));
    // A slab 100 m high, or an exponential fog of 100 m scale height.
    let profile = match row[0] {
        "slab" => Profile::Slab {
            top_height_m: 100.0,
        },
        "expfog" => Profile::Exponential {
            reference_height_m: 0.0,
            scale_height_m: 100.0,
        },
        other => panic!("unknown case {other}"),
    };
    let matter = Matter {
        extinction_per_m: Spectrum([(depth / 100.0) as f32]),
        single_scattering_albedo: Spectrum([omega as f32]),
        phase: PhaseFunction::HenyeyGreenstein { g },
    };
    let light = Light {
        sun: Some(Sun {
            direction: direction(0.0, 90.0 - sun_zenith),
            irradiance: Spectrum::ONE,
        }),
        ambient: Spectrum::ZERO,
    };
    let fog = Fog::new(
        &[Layer { profile, matter }],
        Ground::FLAT,
        light,
        scattering,
    )
    .unwrap();
    fog.along(0.0, direction(azimuth, 90.0 - view_zenith), f64::INFINITY)
}

#[test]
fn single_scattering_matches_the_closed_form_and_mitsuba() {
    for row in rows(include_str!("data/mitsuba_fog_checks.csv")) {
        let got = f64::from(whole_line(&row, Scattering::Single).path_radiance[0]);
        let number = |column: usize| row[column].parse::<f64>().unwrap();
        let (closed, mitsuba, error) = (number(7), number(8), number(9));
        assert!((got / closed - 1.0).abs() < 1e-6, "{row:?}: {got}");
        assert!((got - mitsuba).abs() < 3.0 * error, "{row:?}: {got}");
    }
}
