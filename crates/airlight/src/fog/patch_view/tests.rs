//! Patchy fog against dense quadrature, and its laws.

use super::*;
use crate::axes;
use crate::fog::{DirectionalLight, FogLighting, FogScattering, Ground, RgbFog, RgbLayer};
use crate::optics::PhaseFunction;
use crate::transfer::RgbPathOptics;

const EXTINCTION: f64 = 0.02;

fn patches(strength: f64, seed: u64) -> FogPatches {
    FogPatches {
        strength,
        seed,
        ..Default::default()
    }
}

fn view(patches: &FogPatches, density: DensityProfile, eye: DVec3, resolution: f64) -> PatchView {
    let field = PatchField::new(patches).unwrap();
    PatchView::new(
        field,
        vec![(EXTINCTION, density)],
        f64::INFINITY,
        eye,
        resolution,
    )
    .unwrap()
}

fn profiles() -> [DensityProfile; 4] {
    [
        DensityProfile::Uniform,
        DensityProfile::slab(12.0),
        DensityProfile::exponential(15.0),
        DensityProfile::Clamped {
            base_height_m: 5.0,
            scale_height_m: 8.0,
        },
    ]
}

/// Directions, and distances to the ground or farther.
fn rays() -> Vec<(DVec3, f64)> {
    let elevations = [-60.0, -9.0, -2.0, 0.0, 1.0, 8.0, 40.0];
    let distances = [4.0, 17.0, 60.0, 240.0];
    let mut rays = Vec::new();
    for (i, elevation) in elevations.into_iter().enumerate() {
        for distance in distances {
            rays.push((axes::direction(51.0 * i as f64, elevation), distance));
        }
    }
    rays
}

/// Factor by 100 times as many steps, with libm's functions only.
fn dense(view: &PatchView, direction: DVec3, distance_m: f64) -> f64 {
    let step_m = view.field.shortest_wavelength_m(OCTAVES - 1, direction) / 400.0;
    let count = (distance_m / step_m).ceil();
    let step_m = distance_m / count;
    let (mut even, mut patchy) = (0.0, 0.0);
    for k in 0..count as usize {
        let point = view.eye + direction * ((k as f64 + 0.5) * step_m);
        let density = view.layers[0].1.at(point.y);
        even += density;
        patchy += density * view.field.density(point);
    }
    patchy / even
}

#[test]
fn factors_match_dense_quadrature() {
    let (mut worst, mut squares, mut count) = (0.0f64, 0.0, 0.0);
    for (seed, density) in profiles().into_iter().enumerate() {
        let seen = view(
            &patches(0.8, seed as u64),
            density,
            DVec3::new(70.0, 2.0, -900.0),
            0.0,
        );
        for (direction, distance_m) in rays() {
            let ray = RaySegment::flat(2.0, direction.y, distance_m);
            if seen.depth(&ray, 0.0, distance_m) > HIDDEN {
                continue;
            }
            let exact = dense(&seen, direction, distance_m);
            let off = (seen.factor(direction, distance_m) / exact - 1.0).abs();
            worst = worst.max(off);
            squares += off * off;
            count += 1.0;
        }
    }
    let rms = f64::sqrt(squares / count);
    assert!(rms < 0.006 && worst < 0.04, "{rms} {worst}");
}

#[test]
fn several_distances_give_the_factors_of_each() {
    let seen = view(
        &patches(1.0, 5),
        DensityProfile::slab(12.0),
        DVec3::Y * 2.0,
        0.004,
    );
    let distances = [0.0, 0.5, 7.0, 90.0, 700.0, 20e3, f64::INFINITY];
    for elevation in [-4.0, 0.0, 3.0, 60.0] {
        let direction = axes::direction(20.0, elevation);
        let mut all = [0.0; 7];
        seen.factors(direction, &distances, &mut all);
        for (distance, factor) in distances.into_iter().zip(all) {
            let alone = seen.factor(direction, distance);
            assert!((factor - alone).abs() < 1e-5, "{distance} {factor} {alone}");
        }
    }
    let at_the_eye = seen.field.density(DVec3::Y * 2.0);
    let near = seen.factor(DVec3::X, 1e-3);
    assert!((near / at_the_eye - 1.0).abs() < 0.1, "{near} {at_the_eye}");
}

#[test]
fn splitting_a_ray_multiplies_transmittances() {
    for (seed, density) in profiles().into_iter().enumerate() {
        let patches = patches(0.8, 40 + seed as u64);
        let eye = DVec3::Y * 3.0;
        let near = view(&patches, density.clone(), eye, 0.0);
        for (direction, distance_m) in rays() {
            let split_m = 0.37 * distance_m;
            let middle = eye + direction * split_m;
            let far = view(&patches, density.clone(), middle, 0.0);
            let depth = |view: &PatchView, length_m: f64| {
                let ray = RaySegment::flat(view.eye.y, direction.y, length_m);
                view.factor(direction, length_m) * view.depth(&ray, 0.0, length_m)
            };
            let whole = depth(&near, distance_m);
            let parts = depth(&near, split_m) + depth(&far, distance_m - split_m);
            let (whole, parts) = ((-whole).exp(), (-parts).exp());
            assert!((0.0..=1.0).contains(&whole), "{whole}");
            assert!((whole - parts).abs() < 0.01, "{whole} {parts}");
        }
    }
}

/// Over many fields, the optical depth is that of even fog, and more light passes (Jensen's inequality).
#[test]
fn patches_keep_the_mean_optical_depth_and_let_more_light_pass() {
    const SEEDS: u64 = 1500;
    for (density, elevation) in [
        (DensityProfile::Uniform, 0.0),
        (DensityProfile::exponential(15.0), 2.0),
    ] {
        let direction = axes::direction(130.0, elevation);
        let distance_m = 80.0;
        for resolution in [0.0, 0.05] {
            let mut depths = Vec::new();
            let mut even = 0.0;
            for seed in 0..SEEDS {
                let seen = view(
                    &patches(0.7, seed),
                    density.clone(),
                    DVec3::Y * 2.0,
                    resolution,
                );
                let ray = RaySegment::flat(2.0, direction.y, distance_m);
                even = seen.depth(&ray, 0.0, distance_m);
                depths.push(even * seen.factor(direction, distance_m));
            }
            let mean = |values: &[f64]| values.iter().sum::<f64>() / values.len() as f64;
            let depth = mean(&depths);
            let spread: Vec<f64> = depths.iter().map(|d| (d - depth).powi(2)).collect();
            let error = (mean(&spread) / SEEDS as f64).sqrt();
            assert!((depth - even).abs() < 4.0 * error, "{depth} {even} {error}");
            let passing: Vec<f64> = depths.iter().map(|d| (-d).exp()).collect();
            assert!(mean(&passing) > 1.005 * (-even).exp(), "{}", mean(&passing));
        }
    }
}

#[test]
fn fog_without_strength_is_even_and_distant_fog_is_smooth() {
    for density in profiles() {
        let seen = view(&patches(0.0, 1), density, DVec3::Y * 2.0, 0.0);
        for (direction, distance_m) in rays() {
            let factor = seen.factor(direction, distance_m);
            assert!((factor - 1.0).abs() < 1e-12, "{factor}");
        }
    }
    // Ten kilometres away, patches are narrower than the resolution.
    let seen = view(
        &patches(1.0, 1),
        DensityProfile::Uniform,
        DVec3::Y * 2.0,
        0.004,
    );
    assert_eq!(seen.octaves_at(10e3), 0);
    assert_eq!(seen.octaves_at(10.0), OCTAVES);
    assert_eq!(
        seen.factor(DVec3::X, f64::INFINITY),
        seen.factor(DVec3::X, 1e12)
    );
}

/// Path radiance of `at_density` against fog of many even segments, each at its own density in the light of the even fog.
#[test]
fn path_radiance_matches_fog_of_thin_segments() {
    let lighting = FogLighting {
        sun: Some(DirectionalLight {
            direction: axes::direction(110.0, 20.0),
            irradiance: [3.0, 2.4, 1.8],
        }),
        ambient: [0.2, 0.25, 0.35],
        ground_albedo: [0.2; 3],
    };
    let (mut worst, mut squares, mut count) = (0.0f64, 0.0, 0.0);
    for (seed, density) in profiles().into_iter().enumerate() {
        let layer = RgbLayer {
            density: density.clone(),
            extinction_per_m: [EXTINCTION as f32; 3],
            single_scattering_albedo: [1.0; 3],
            phase: PhaseFunction::HenyeyGreenstein { g: 0.8 },
        };
        let fog = RgbFog::new(&[layer], Ground::FLAT, &lighting, FogScattering::Multiple).unwrap();
        let seen = view(&patches(0.8, seed as u64), density, DVec3::Y * 2.0, 0.0);
        for (direction, distance_m) in rays() {
            if 2.0 + direction.y * distance_m < 0.0 {
                continue;
            }
            const SEGMENTS: usize = 400;
            let mut whole = RgbPathOptics::CLEAR;
            for k in 0..SEGMENTS {
                let at = |k: f64| direction * (distance_m * k / SEGMENTS as f64) + DVec3::Y * 2.0;
                let segment = fog.path(at(k as f64).y, direction, distance_m / SEGMENTS as f64);
                let factor = seen.field.density(at(k as f64 + 0.5)) as f32;
                whole = whole.then(segment.at_density(factor));
            }
            let factor = seen.factor(direction, distance_m) as f32;
            let got = fog.path(2.0, direction, distance_m).at_density(factor);
            let off = f64::from(got.path_radiance[1] / whole.path_radiance[1] - 1.0).abs();
            worst = worst.max(off);
            squares += off * off;
            count += 1.0;
        }
    }
    let rms = f64::sqrt(squares / count);
    assert!(rms < 0.01 && worst < 0.05, "{rms} {worst}");
}

mod guards {
    use super::*;

    #[test]
    fn fields_do_not_change_between_versions() {
        let seen = view(
            &patches(0.8, 7),
            DensityProfile::Uniform,
            DVec3::Y * 2.0,
            0.004,
        );
        let factor = seen.factor(axes::direction(30.0, 0.0), 100.0);
        let density = seen.field.density(DVec3::new(10.0, 2.0, -5.0));
        assert_eq!((factor, density), (1.3103113999590263, 1.3457305055821225));
    }
}
