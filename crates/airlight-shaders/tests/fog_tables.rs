//! Fog from tables against the library: `FogTables` as half floats, read by the twins.

use airlight::atmosphere::{DensityProfile, droplets};
use airlight::axes;
use airlight::fog::{
    DirectionalLight, FogLighting, FogScattering, Ground, RaySegment, RgbFog, RgbLayer,
};
use airlight::optics::PhaseFunction;
use airlight_shaders::twins::fog_table::tabulated_fog;
use airlight_shaders::twins::texture::{LinearSampler, Texture};
use airlight_shaders::{FogTables, FogTablesError};
use glam::{Vec3, Vec4};

const EYE_M: f64 = 2.0;

/// As a texture of half floats holds it.
fn halved(texture: &Texture) -> Texture {
    let half = |v: f32| half::f16::from_f32(v).to_f32();
    let texels = texture.texels().iter();
    let texels = texels.map(|v| Vec4::from_array(v.to_array().map(half)));
    Texture::new(texture.size(), texels.collect())
}

fn fog(
    density: DensityProfile,
    extinction: f32,
    phase: PhaseFunction,
    sun_deg: f64,
    ground: Ground,
) -> RgbFog {
    let layer = RgbLayer {
        density,
        extinction_per_m: [1.0, 1.05, 1.1].map(|part| part * extinction),
        single_scattering_albedo: [1.0, 0.995, 0.98],
        phase,
    };
    let lighting = FogLighting {
        sun: Some(DirectionalLight {
            direction: axes::direction(150.0, sun_deg),
            irradiance: [100.0, 95.0, 80.0],
        }),
        ambient: [5.0, 6.0, 9.0],
        ground_albedo: [0.1, 0.15, 0.1],
    };
    RgbFog::new(&[layer], ground, &lighting, FogScattering::Multiple).expect("a fog")
}

#[test]
fn tables_reject_other_fog() {
    let phase = PhaseFunction::Isotropic;
    let round = fog(DensityProfile::slab(20.0), 0.01, phase, 30.0, Ground::EARTH);
    assert_eq!(
        FogTables::new(&round, EYE_M).err(),
        Some(FogTablesError::Fog)
    );
}

mod guards {
    use super::*;

    /// Prints the rms and the largest relative difference of the path radiance in each fog.
    #[test]
    fn tables_are_within_their_stated_error_of_the_library() {
        let exponential = DensityProfile::Exponential {
            reference_height_m: 0.0,
            scale_height_m: 40.0,
        };
        let wide = PhaseFunction::henyey_greenstein(0.8).expect("a phase function");
        println!("| fog | sun | rms, % | worst, % |\n|---|---|---|---|");
        let [mut all_rms, mut all_worst] = [0.0f64; 2];
        for (name, density, extinction, phase) in [
            (
                "exponential, g = 0.8",
                exponential.clone(),
                0.02,
                wide.clone(),
            ),
            (
                "exponential, droplets of 20 um",
                exponential.clone(),
                0.02,
                droplets::phase(20.0),
            ),
            (
                "thin, exponential, droplets of 10 um",
                exponential,
                0.001,
                droplets::phase(10.0),
            ),
            (
                "slab of 30 m, g = 0.8",
                DensityProfile::slab(30.0),
                0.03,
                wide,
            ),
        ] {
            for sun_deg in [50.0, 8.0] {
                let fog = fog(
                    density.clone(),
                    extinction,
                    phase.clone(),
                    sun_deg,
                    Ground::FLAT,
                );
                let tables = FogTables::new(&fog, EYE_M).expect("tables");
                let [diffuse, streams, phases] =
                    [&tables.diffuse, &tables.streams, &tables.stream_phase].map(halved);
                let (mut sum, mut count, mut worst) = (0.0, 0.0, 0.0f64);
                let beside_sun = [sun_deg - 2.0, sun_deg, sun_deg + 0.3];
                let elevations = [
                    -87.0, -60.0, -10.0, -1.0, -0.1, 0.1, 0.7, 4.0, 15.0, 30.0, 70.0, 88.0,
                ];
                for elevation in elevations.into_iter().chain(beside_sun) {
                    for turn in [0.0, 0.7, 3.0, 12.0, 45.0, 110.0, 180.0] {
                        let view = axes::direction(150.0 + turn, elevation);
                        let ground_m = EYE_M / (-view.y).max(1e-9);
                        for distance_m in [0.5, 5.0, 40.0, 200.0, 2000.0, f64::INFINITY] {
                            if view.y < 0.0 && distance_m > ground_m {
                                continue;
                            }
                            let ray = RaySegment::new(EYE_M, view.y, distance_m, f64::INFINITY);
                            let got = tabulated_fog(
                                tables.view,
                                &diffuse,
                                &streams,
                                &phases,
                                LinearSampler,
                                view.as_vec3(),
                                Vec3::from(fog.optical_depth(&ray)),
                            );
                            let path = fog.path(EYE_M, view, distance_m);
                            for c in 0..3 {
                                let right = f64::from(path.path_radiance[c]);
                                let error = (f64::from(got.path_radiance[c]) / right - 1.0).abs();
                                if error > worst {
                                    worst = error;
                                }
                                sum += error * error;
                                count += 1.0;
                            }
                        }
                    }
                }
                let rms = (sum / count).sqrt();
                println!(
                    "| {name} | {sun_deg} | {:.2} | {:.1} |",
                    100.0 * rms,
                    100.0 * worst
                );
                all_rms = all_rms.max(rms);
                all_worst = all_worst.max(worst);
            }
        }
        assert!(
            all_rms < 0.0015 && all_worst < 0.005,
            "{all_rms} {all_worst}"
        );
    }
}
