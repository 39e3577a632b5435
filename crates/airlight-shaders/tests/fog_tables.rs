//! Fog from tables against the library: `FogTables` as half floats, read by the twins.

use airlight::atmosphere::{DensityProfile, droplets};
use airlight::axes;
use airlight::fog::{
    DirectionalLight, FogLighting, FogScattering, Ground, RaySegment, RgbFog, RgbLayer,
};
use airlight::glam::DVec3;
use airlight::optics::PhaseFunction;
use airlight_shaders::twins::texture::Texture;
use airlight_shaders::{FogTables, FogTablesError};
use glam::{Vec3, Vec4};

/// As a texture of half floats holds it.
fn halved(texture: &Texture) -> Texture {
    let half = |v: f32| half::f16::from_f32(v).to_f32();
    let texels = texture.texels().iter();
    let texels = texels.map(|v| Vec4::from_array(v.to_array().map(half)));
    Texture::new(texture.size(), texels.collect())
}

fn layer(density: DensityProfile, extinction: f32, phase: PhaseFunction) -> RgbLayer {
    RgbLayer {
        density,
        extinction_per_m: [1.0, 1.05, 1.1].map(|part| part * extinction),
        single_scattering_albedo: [1.0, 0.995, 0.98],
        phase,
    }
}

fn fog(layers: &[RgbLayer], sun_deg: f64, ground: Ground, scattering: FogScattering) -> RgbFog {
    let lighting = FogLighting {
        sun: Some(DirectionalLight {
            direction: axes::direction(150.0, sun_deg),
            irradiance: [100.0, 95.0, 80.0],
        }),
        ambient: [5.0, 6.0, 9.0],
        ground_albedo: [0.1, 0.15, 0.1],
    };
    RgbFog::new(layers, ground, &lighting, scattering).expect("a fog")
}

#[test]
fn tables_reject_other_fog() {
    let layers = |density| [layer(density, 0.01, PhaseFunction::Isotropic)];
    let slab = layers(DensityProfile::slab(20.0));
    let (all, single) = (FogScattering::Multiple, FogScattering::Single);
    for fog in [
        fog(&slab, 30.0, Ground::EARTH, all),
        fog(&slab, 30.0, Ground::FLAT, single),
        fog(&layers(DensityProfile::Uniform), 30.0, Ground::FLAT, all),
        fog(&[], 30.0, Ground::FLAT, all),
    ] {
        let tables = FogTables::new(&fog, 2.0);
        assert_eq!(tables.err(), Some(FogTablesError::Fog));
    }
}

mod guards {
    use super::*;

    /// Relative errors of the path radiance of tables for an eye at a height.
    #[derive(Default)]
    struct Errors {
        squares: f64,
        count: f64,
        worst: f64,
    }

    impl Errors {
        fn rms(&self) -> f64 {
            (self.squares / self.count).sqrt()
        }

        /// Both in percent, as columns of a table.
        fn columns(&self) -> String {
            format!("{:.2} | {:.1}", 100.0 * self.rms(), 100.0 * self.worst)
        }

        /// Along rays in all directions and to all distances, where the fog removes more than a ten-thousandth of the light.
        fn of(fog: &RgbFog, eye_m: f64, sun_deg: f64) -> Self {
            let tables = FogTables::new(fog, eye_m).expect("tables");
            let tables = FogTables {
                diffuse: halved(&tables.diffuse),
                streams: halved(&tables.streams),
                stream_phase: halved(&tables.stream_phase),
                ..tables
            };
            let mut all = Self::default();
            let beside_sun = [sun_deg - 2.0, sun_deg, sun_deg + 0.3];
            let elevations = [
                -87.0, -60.0, -10.0, -1.0, -0.1, 0.1, 0.7, 4.0, 15.0, 30.0, 70.0, 88.0,
            ];
            for elevation in elevations.into_iter().chain(beside_sun) {
                for turn in [0.0, 0.7, 3.0, 12.0, 45.0, 110.0, 180.0] {
                    let view = axes::direction(150.0 + turn, elevation);
                    let ground_m = eye_m / (-view.y).max(1e-9);
                    for distance_m in [0.5, 5.0, 15.0, 40.0, 100.0, 200.0, 2000.0, f64::INFINITY] {
                        if view.y < 0.0 && distance_m > ground_m {
                            continue;
                        }
                        all.add(fog, &tables, eye_m, view, distance_m);
                    }
                }
            }
            all
        }

        fn add(
            &mut self,
            fog: &RgbFog,
            tables: &FogTables,
            eye_m: f64,
            view: DVec3,
            distance_m: f64,
        ) {
            let ray = RaySegment::flat(eye_m, view.y, distance_m);
            let depths = fog.profiles().map(|(density, extinction)| {
                let column_m = density.column_along_m(&ray).min(1e25);
                Vec3::from(extinction) * column_m as f32
            });
            let got = tables.path(view.as_vec3(), depths).path_radiance;
            let right = fog.path(eye_m, view, distance_m);
            if right.transmittance[1] > 0.9999 {
                return;
            }
            let right = right.path_radiance;
            for c in 0..3 {
                let (got, right) = (f64::from(got[c]), f64::from(right[c]));
                let error = (got / right - 1.0).abs();
                if error > self.worst {
                    self.worst = error;
                }
                self.squares += error * error;
                self.count += 1.0;
            }
        }
    }

    /// Prints the rms and the largest relative difference of the path radiance in each fog.
    #[test]
    fn tables_are_within_their_stated_error_of_the_library() {
        let exponential = DensityProfile::exponential(40.0);
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
                let layers = [layer(density.clone(), extinction, phase.clone())];
                let fog = fog(&layers, sun_deg, Ground::FLAT, FogScattering::Multiple);
                let errors = Errors::of(&fog, 2.0, sun_deg);
                println!("| {name} | {sun_deg} | {} |", errors.columns());
                all_rms = all_rms.max(errors.rms());
                all_worst = all_worst.max(errors.worst);
            }
        }
        assert!(
            all_rms < 0.0015 && all_worst < 0.005,
            "{all_rms} {all_worst}"
        );
    }

    /// As above, in fog of several layers, in which the eye is below, between, in and above them. Errors are largest where a thin layer
    /// around the eye has a dense one behind its nearest part.
    #[test]
    fn tables_of_layers_are_within_their_stated_error_of_the_library() {
        let slab = |bottom_m, top_m| DensityProfile::Layer { bottom_m, top_m };
        let wide = PhaseFunction::henyey_greenstein(0.7).expect("a phase function");
        let (small, large) = (droplets::phase(10.0), droplets::phase(20.0));
        let mist = layer(DensityProfile::exponential(5.0), 0.03, large.clone());
        let thin_mist = layer(DensityProfile::exponential(5.0), 0.002, small.clone());
        let raised = layer(slab(40.0, 70.0), 0.03, small);
        let alike = layer(slab(40.0, 70.0), 0.03, large.clone());
        let haze = layer(DensityProfile::exponential(300.0), 0.001, wide.clone());
        let clamped = DensityProfile::Clamped {
            base_height_m: 12.0,
            scale_height_m: 8.0,
        };
        let clamped = layer(clamped, 0.03, large);
        let high = layer(slab(90.0, 100.0), 0.05, wide);
        println!("| fog | eye, m | sun | rms, % | worst, % |\n|---|---|---|---|---|");
        for (name, layers, eyes_m, most_rms, most) in [
            (
                "mist under a raised layer of other droplets",
                vec![mist.clone(), raised.clone()],
                &[2.0, 25.0, 55.0, 120.0][..],
                0.003,
                0.02,
            ),
            (
                "mist under a raised layer of the same droplets",
                vec![mist.clone(), alike],
                &[2.0, 25.0],
                0.0015,
                0.005,
            ),
            (
                "thin mist under a raised layer",
                vec![thin_mist, raised.clone()],
                &[2.0, 25.0],
                0.0015,
                0.005,
            ),
            (
                "mist in haze",
                vec![mist, haze.clone()],
                &[2.0, 25.0],
                0.006,
                0.04,
            ),
            (
                "a layer in haze",
                vec![raised.clone(), haze.clone()],
                &[2.0, 55.0, 120.0],
                0.006,
                0.03,
            ),
            (
                "clamped fog, a layer and a thin dense one in haze",
                vec![clamped, haze, raised, high],
                &[2.0, 80.0],
                0.025,
                0.15,
            ),
        ] {
            for &eye_m in eyes_m {
                for sun_deg in [50.0, 8.0] {
                    let fog = fog(&layers, sun_deg, Ground::FLAT, FogScattering::Multiple);
                    let errors = Errors::of(&fog, eye_m, sun_deg);
                    println!("| {name} | {eye_m} | {sun_deg} | {} |", errors.columns());
                    assert!(
                        errors.rms() < most_rms && errors.worst < most,
                        "{name} {eye_m} {sun_deg}"
                    );
                }
            }
        }
    }
}
