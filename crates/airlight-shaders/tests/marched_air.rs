//! Skies that `marched_air` marches, against the solver's single scattering in the same air.

use airlight::atmosphere::{Atmosphere, Constituent, ConstituentKind, DensityProfile, Planet};
use airlight::axes;
use airlight::glam::DVec3;
use airlight::optics::PhaseFunction;
use airlight::sky::{Scattering, Sky, SkySettings, SunCoverage, View};
use airlight::spectrum::{SpectralCurve, WavelengthGrid};
use airlight::sun::SunDisc;
use airlight_shaders::twins::air::{AirLight, AirMedium, air_length_m, air_march, air_march_step};
use airlight_shaders::twins::columns::{INFINITE_M, ray_segment};
use airlight_shaders::twins::path_optics::PathOptics;
use airlight_shaders::twins::phase::{henyey_greenstein, one_minus_cos_between, rayleigh_phase};
use glam::Vec3;

const WAVELENGTHS_NM: [f64; 3] = [450.0, 550.0, 650.0];
const RADIUS_M: f64 = 6.371e6;
const TOP_M: f64 = 1e5;
const MOLECULES_SCALE_M: f64 = 8e3;
const HAZE_SCALE_M: f64 = 1.2e3;
const OZONE_M: [f64; 2] = [1.5e4, 3.5e4];
const OZONE_PER_M: f64 = 1e-6;
const DEPOLARIZATION: f64 = 0.028;
const MEAN_COSINE: f64 = 0.7;

fn molecules() -> SpectralCurve {
    SpectralCurve::PowerLaw {
        value_at_550_nm: 1.2e-5,
        exponent: 4.0,
    }
}

/// Haze of an optical depth at 550 nm.
fn haze(optical_depth: f64) -> SpectralCurve {
    SpectralCurve::PowerLaw {
        value_at_550_nm: optical_depth / HAZE_SCALE_M,
        exponent: 1.0,
    }
}

fn atmosphere(haze_depth: f64) -> Atmosphere {
    let exponential = |scale_height_m| DensityProfile::Exponential {
        reference_height_m: 0.0,
        scale_height_m,
    };
    let none = SpectralCurve::Constant(0.0);
    Atmosphere {
        name: "exponential air".to_owned(),
        planet: Planet {
            radius_m: RADIUS_M,
            top_altitude_m: TOP_M,
            ground_altitude_m: 0.0,
            ground_albedo: none.clone(),
        },
        constituents: vec![
            Constituent {
                kind: ConstituentKind::Molecules,
                density: exponential(MOLECULES_SCALE_M),
                scattering_per_m: molecules(),
                absorption_per_m: none.clone(),
                phase: PhaseFunction::rayleigh(DEPOLARIZATION).unwrap(),
            },
            Constituent {
                kind: ConstituentKind::Aerosol,
                density: exponential(HAZE_SCALE_M),
                scattering_per_m: haze(0.9 * haze_depth),
                absorption_per_m: haze(0.1 * haze_depth),
                phase: PhaseFunction::henyey_greenstein(MEAN_COSINE).unwrap(),
            },
            Constituent {
                kind: ConstituentKind::Ozone,
                density: DensityProfile::Layer {
                    bottom_m: OZONE_M[0],
                    top_m: OZONE_M[1],
                },
                scattering_per_m: none,
                absorption_per_m: SpectralCurve::Constant(OZONE_PER_M),
                phase: PhaseFunction::Isotropic,
            },
        ],
        solar_irradiance: SpectralCurve::Constant(1.0),
        sun: SunDisc::default(),
    }
}

/// The same air for shaders.
fn medium(haze_depth: f64) -> AirMedium {
    let at = |curve: SpectralCurve| Vec3::from(WAVELENGTHS_NM.map(|nm| curve.at(nm) as f32));
    AirMedium {
        molecules_per_m: at(molecules()),
        molecules_scale_m: MOLECULES_SCALE_M as f32,
        haze_extinction_per_m: at(haze(haze_depth)),
        haze_scale_m: HAZE_SCALE_M as f32,
        haze_scattering_per_m: at(haze(0.9 * haze_depth)),
        top_m: TOP_M as f32,
        ozone_per_m: Vec3::splat(OZONE_PER_M as f32),
        ozone_bottom_m: OZONE_M[0] as f32,
        ozone_top_m: OZONE_M[1] as f32,
        inverse_radius_per_m: (1.0 / RADIUS_M) as f32,
    }
}

fn view(haze_depth: f64, sun_deg: f64, height_m: f64) -> View {
    let settings = SkySettings {
        suns: SunCoverage::near(sun_deg, height_m),
        scattering: Scattering::Single,
        ..SkySettings::default()
    };
    let grid = WavelengthGrid::from_wavelengths_nm(WAVELENGTHS_NM.to_vec()).unwrap();
    let sky = Sky::prepare(&atmosphere(haze_depth), &grid, &settings).unwrap();
    sky.view(height_m, axes::direction(200.0, sun_deg))
}

/// The loop of the shader.
fn marched(air: AirMedium, height_m: f32, direction: Vec3, sun: Vec3, steps: u32) -> PathOptics {
    let one_minus_cos = one_minus_cos_between(direction, sun);
    let light = AirLight {
        sunlight: Vec3::ONE,
        sin_sun: sun.y,
        cos_to_sun: direction.dot(sun),
        molecules_phase: rayleigh_phase(one_minus_cos, DEPOLARIZATION as f32),
        haze_phase: henyey_greenstein(one_minus_cos, MEAN_COSINE as f32),
    };
    let ray = ray_segment(height_m, direction.y, INFINITE_M, air.inverse_radius_per_m);
    let length_m = air_length_m(air, ray);
    let start = air_march(air, ray, light);
    let end = (1..=steps).fold(start, |march, i| {
        let part = i as f32 / steps as f32;
        air_march_step(march, air, ray, length_m * part * part, light, 1.0)
    });
    end.path
}

/// Directions of the upper hemisphere, and below it for an eye in the air.
fn directions(height_m: f64) -> impl Iterator<Item = DVec3> {
    let lowest: &[f64] = if height_m > 1e3 {
        &[-60.0, -10.0, -4.0]
    } else {
        &[]
    };
    let elevations = [90.0, 60.0, 30.0, 15.0, 7.0, 3.0, 1.0].iter().chain(lowest);
    let elevations: Vec<f64> = elevations.copied().collect();
    let azimuths = [0.0, 60.0, 120.0, 200.0, 260.0, 320.0];
    elevations
        .into_iter()
        .flat_map(move |elevation| azimuths.map(|azimuth| axes::direction(azimuth, elevation)))
}

/// Root of the mean square and largest difference of path radiances from the solver's, relative to them or to a hundredth of the largest.
fn differences(haze_depth: f64, sun_deg: f64, height_m: f64, steps: u32) -> [f64; 2] {
    let view = view(haze_depth, sun_deg, height_m);
    let pairs: Vec<(f32, f32)> = directions(height_m)
        .flat_map(|direction| {
            let right = view.along(direction, None).path_radiance();
            let [direction, sun] = [direction, view.sun()].map(DVec3::as_vec3);
            let got = marched(medium(haze_depth), height_m as f32, direction, sun, steps);
            got.path_radiance.to_array().into_iter().zip(right)
        })
        .collect();
    let brightest = pairs.iter().fold(0.0, |most, pair| pair.1.max(most));
    let relative =
        |&(got, right): &(f32, f32)| f64::from((got - right) / right.max(0.01 * brightest));
    let squares: f64 = pairs.iter().map(|pair| relative(pair).powi(2)).sum();
    let worst = pairs
        .iter()
        .map(|pair| relative(pair).abs())
        .fold(0.0, f64::max);
    [(squares / pairs.len() as f64).sqrt(), worst]
}

mod guards {
    use super::*;

    /// Prints the table of the book: the largest of clear and hazy air on the ground, and of clear air at 10 km, in %.
    #[test]
    fn marched_skies_are_those_of_the_solver() {
        println!("| sun | 8 steps | 16 steps | 32 steps |\n|---|---|---|---|");
        let mut wrong = Vec::new();
        for (sun_deg, stated) in [
            (60.0, [[1.2, 4.3], [0.4, 1.3], [0.1, 0.4]]),
            (10.0, [[1.3, 3.5], [0.4, 1.0], [0.1, 0.3]]),
            (2.0, [[3.7, 10.0], [1.0, 2.7], [0.3, 0.8]]),
            (-4.0, [[12.0, 37.0], [6.0, 15.0], [1.7, 4.5]]),
        ] {
            let mut line = format!("| {sun_deg} |");
            for (steps, stated) in [8, 16, 32].into_iter().zip(stated) {
                let mut most = [0.0; 2];
                for (haze_depth, height_m) in [(0.05, 2.0), (0.3, 2.0), (0.05, 1e4)] {
                    let got = differences(haze_depth, sun_deg, height_m, steps);
                    most = [0, 1].map(|k| f64::max(most[k], 100.0 * got[k]));
                }
                line += &format!(" {:.1}, {:.1} |", most[0], most[1]);
                if most[0] > stated[0] || most[1] > stated[1] {
                    wrong.push(format!("{sun_deg} {steps}: {most:?}, stated {stated:?}"));
                }
            }
            println!("{line}");
        }
        assert!(wrong.is_empty(), "\n{}", wrong.join("\n"));
    }
}
