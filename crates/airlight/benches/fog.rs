//! Speed of fog: view rays, and solving for multiple scattering.
//!
//! `cargo bench -p airlight --bench fog`

use airlight::atmosphere::{Constituent, DensityProfile, droplets::Droplets};
use airlight::axes::direction;
use airlight::fog::{DirectionalLight, Fog, FogLighting, FogScattering, Ground, RgbFog, RgbLayer};
use airlight::spectrum::{SpectralCurve, WavelengthGrid};
use divan::{Bencher, black_box};
use glam::DVec3;

fn main() {
    divan::main();
}

const THOUSAND: usize = 1000;
const EXTINCTION_PER_M: f64 = 0.02;

fn profile(name: &str) -> DensityProfile {
    match name {
        "uniform" => DensityProfile::Uniform,
        "slab" => DensityProfile::slab(40.0),
        "clamped" => DensityProfile::Clamped {
            base_height_m: 10.0,
            scale_height_m: 20.0,
        },
        _ => DensityProfile::exponential(30.0),
    }
}

fn sun<C>(irradiance: C) -> Option<DirectionalLight<C>> {
    let direction = direction(100.0, 20.0);
    Some(DirectionalLight {
        direction,
        irradiance,
    })
}

fn rgb(names: &[&str], ground: Ground, scattering: FogScattering) -> RgbFog {
    let layers: Vec<RgbLayer> = names
        .iter()
        .map(|name| RgbLayer {
            density: profile(name),
            extinction_per_m: [EXTINCTION_PER_M as f32; 3],
            single_scattering_albedo: [1.0; 3],
            phase: Droplets::Radiation.phase(),
        })
        .collect();
    let lighting = FogLighting {
        sun: sun([1e5; 3]),
        ambient: [5e3; 3],
        ground_albedo: [0.0; 3],
    };
    RgbFog::new(&layers, ground, &lighting, scattering).unwrap()
}

/// At the 16 wavelengths of the standard grid.
fn spectral(scattering: FogScattering) -> Fog {
    let (drops, height_fog) = (Droplets::Radiation.into(), profile("exponential"));
    let layer = Constituent::fog(EXTINCTION_PER_M, drops, height_fog, &[]).unwrap();
    let lighting = FogLighting {
        sun: sun(SpectralCurve::Constant(1e5)),
        ambient: SpectralCurve::Constant(5e3),
        ground_albedo: SpectralCurve::Constant(0.0),
    };
    let grid = WavelengthGrid::standard();
    Fog::new(&[layer], Ground::FLAT, &lighting, scattering, &grid).unwrap()
}

/// View rays of a picture: a thousand directions and distances.
fn rays() -> Vec<(DVec3, f64)> {
    (0..THOUSAND)
        .map(|k| {
            let k = k as f64;
            (direction(60.0 + 0.06 * k, -10.0 + 0.031 * k), 5.0 + 0.7 * k)
        })
        .collect()
}

fn look_rgb(bencher: Bencher, fog: &RgbFog) {
    let rays = rays();
    bencher.counter(THOUSAND).bench(|| {
        let mut sum = [0.0; 3];
        for &(direction, distance_m) in black_box(&rays) {
            let path = fog.path(1.7, direction, distance_m).path_radiance;
            for (sum, path) in sum.iter_mut().zip(path) {
                *sum += path;
            }
        }
        sum
    });
}

fn look_spectral(bencher: Bencher, fog: &Fog) {
    let (directions, distances_m): (Vec<_>, Vec<_>) = rays().into_iter().unzip();
    let values = fog.grid().len() * THOUSAND;
    let (mut transmittance, mut path_radiance) = (vec![0.0; values], vec![0.0; values]);
    bencher.counter(THOUSAND).bench_local(|| {
        fog.paths(
            1.7,
            black_box(&directions),
            &distances_m,
            &mut transmittance,
            &mut path_radiance,
        );
        path_radiance[values - 1]
    });
}

#[divan::bench(args = ["uniform", "exponential", "clamped", "slab"])]
fn one_profile_rgb(bencher: Bencher, name: &str) {
    look_rgb(bencher, &rgb(&[name], Ground::FLAT, FogScattering::Single));
}

#[divan::bench]
fn one_profile_16_wavelengths(bencher: Bencher) {
    look_spectral(bencher, &spectral(FogScattering::Single));
}

#[divan::bench]
fn round_ground_rgb(bencher: Bencher) {
    let fog = rgb(&["exponential"], Ground::EARTH, FogScattering::Single);
    look_rgb(bencher, &fog);
}

#[divan::bench]
fn two_profiles_rgb(bencher: Bencher) {
    let layers = ["exponential", "slab"];
    look_rgb(bencher, &rgb(&layers, Ground::FLAT, FogScattering::Single));
}

#[divan::bench(args = ["exponential", "clamped", "slab"])]
fn multiple_scattering_rgb(bencher: Bencher, name: &str) {
    look_rgb(
        bencher,
        &rgb(&[name], Ground::FLAT, FogScattering::Multiple),
    );
}

#[divan::bench]
fn multiple_scattering_16_wavelengths(bencher: Bencher) {
    look_spectral(bencher, &spectral(FogScattering::Multiple));
}

/// Solves for multiple scattering, once for a fog and its sun.
#[divan::bench]
fn solving_rgb() -> RgbFog {
    rgb(&["exponential"], Ground::FLAT, FogScattering::Multiple)
}

#[divan::bench]
fn solving_16_wavelengths() -> Fog {
    spectral(FogScattering::Multiple)
}
