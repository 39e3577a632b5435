//! Speed of fog: one line of sight.
//!
//! `cargo bench -p airlight --bench fog`

use airlight::axes::direction;
use airlight::fog::{
    DensityProfile, DirectionalLight, Fog, FogLighting, FogScattering, Ground, Layer,
    droplets::Droplets,
};
use airlight::spectrum::Spectrum;
use divan::{Bencher, black_box};
use glam::DVec3;

fn main() {
    divan::main();
}

const THOUSAND: usize = 1000;

fn profile(name: &str) -> DensityProfile {
    match name {
        "uniform" => DensityProfile::Uniform,
        "slab" => DensityProfile::slab(40.0),
        "clamped" => DensityProfile::Clamped {
            base_height_m: 10.0,
            scale_height_m: 20.0,
        },
        _ => DensityProfile::Exponential {
            reference_height_m: 0.0,
            scale_height_m: 30.0,
        },
    }
}

fn fog<const N: usize>(names: &[&str], ground: Ground, scattering: FogScattering) -> Fog<N> {
    let layers: Vec<Layer<N>> = names
        .iter()
        .map(|name| Layer {
            profile: profile(name),
            medium: Droplets::Radiation.medium(0.02),
        })
        .collect();
    let light = FogLighting {
        sun: Some(DirectionalLight {
            direction: direction(100.0, 20.0),
            irradiance: Spectrum::splat(1e5),
        }),
        ambient: Spectrum::splat(5e3),
        ground_albedo: Spectrum::ZERO,
    };
    Fog::new(&layers, ground, light, scattering).unwrap()
}

/// Lines of a picture: a thousand directions and distances.
fn lines() -> Vec<(DVec3, f64)> {
    (0..THOUSAND)
        .map(|k| {
            let k = k as f64;
            (direction(60.0 + 0.06 * k, -10.0 + 0.031 * k), 5.0 + 0.7 * k)
        })
        .collect()
}

fn walk<const N: usize>(bencher: Bencher, fog: &Fog<N>) {
    let lines = lines();
    bencher.counter(THOUSAND).bench(|| {
        let mut sum = Spectrum::ZERO;
        for &(direction, length) in black_box(&lines) {
            sum += fog.along(1.7, direction, length).path_radiance;
        }
        sum
    });
}

#[divan::bench(args = ["uniform", "exponential", "clamped", "slab"])]
fn one_profile_rgb(bencher: Bencher, name: &str) {
    walk::<3>(bencher, &fog(&[name], Ground::FLAT, FogScattering::Single));
}

#[divan::bench]
fn one_profile_16_wavelengths(bencher: Bencher) {
    walk::<16>(
        bencher,
        &fog(&["exponential"], Ground::FLAT, FogScattering::Single),
    );
}

#[divan::bench]
fn round_ground_rgb(bencher: Bencher) {
    walk::<3>(
        bencher,
        &fog(&["exponential"], Ground::EARTH, FogScattering::Single),
    );
}

#[divan::bench]
fn two_profiles_rgb(bencher: Bencher) {
    walk::<3>(
        bencher,
        &fog(
            &["exponential", "slab"],
            Ground::FLAT,
            FogScattering::Single,
        ),
    );
}

#[divan::bench(args = ["exponential", "clamped", "slab"])]
fn many_scatterings_rgb(bencher: Bencher, name: &str) {
    walk::<3>(
        bencher,
        &fog(&[name], Ground::FLAT, FogScattering::Multiple),
    );
}

#[divan::bench]
fn many_scatterings_16_wavelengths(bencher: Bencher) {
    walk::<16>(
        bencher,
        &fog(&["exponential"], Ground::FLAT, FogScattering::Multiple),
    );
}

/// Solving for the light inside: once for a fog and its sun.
#[divan::bench]
fn solving_rgb() -> Fog<3> {
    fog(&["exponential"], Ground::FLAT, FogScattering::Multiple)
}

#[divan::bench]
fn solving_16_wavelengths() -> Fog<16> {
    fog(&["exponential"], Ground::FLAT, FogScattering::Multiple)
}
