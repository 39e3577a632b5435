use super::*;
use crate::atmosphere::droplets;
use crate::atmosphere::{DensityProfile, Interpolation};
use crate::axes;
use crate::fog::{DirectionalLight, RgbLayer};
use crate::math::quadrature::GaussRule;
use crate::optics::{Depolarization, PhaseFunction};

const EARTH: Ground = Ground::EARTH;

/// Fog of these layers.
fn lanes(
    layers: &[RgbLayer],
    ground: Ground,
    lighting: FogLighting<Spectrum<3>>,
    scattering: FogScattering,
) -> Result<FogLanes<3>, FogError> {
    let layers: Vec<LayerLanes<3>> = layers.iter().map(LayerLanes::rgb).collect();
    FogLanes::new(&layers, ground, lighting, scattering, 3, Control::default())
}

fn layer(extinction_per_m: [f32; 3], albedo: f32, phase: PhaseFunction) -> RgbLayer {
    RgbLayer {
        density: DensityProfile::Uniform,
        extinction_per_m,
        single_scattering_albedo: [albedo; 3],
        phase,
    }
}

fn drops(extinction: f32) -> RgbLayer {
    let e = [extinction, 1.1 * extinction, 1.2 * extinction];
    layer(e, 0.95, PhaseFunction::HenyeyGreenstein { g: 0.8 })
}

fn molecules(extinction: f32) -> RgbLayer {
    let e = [0.2 * extinction, 0.5 * extinction, extinction];
    layer(e, 1.0, PhaseFunction::Rayleigh(Depolarization::None))
}

fn light(sun_elevation_deg: f64) -> FogLighting<Spectrum<3>> {
    FogLighting {
        sun: Some(DirectionalLight {
            direction: axes::direction(120.0, sun_elevation_deg),
            irradiance: Spectrum([1.5, 1.8, 1.9]),
        }),
        ambient: Spectrum([0.1, 0.15, 0.3]),
        ground_albedo: Spectrum([0.1, 0.2, 0.3]),
    }
}

/// Reference for one lane: optical depth and path radiance of single scattering by quadrature in f64.
fn by_quadrature(
    layers: &[RgbLayer],
    ground: Ground,
    light: &FogLighting<Spectrum<3>>,
    scattering: FogScattering,
    line: &RaySegment,
    cos_sun: f64,
    lane: usize,
) -> (f64, f64) {
    let sine = light.sun.unwrap().direction.y;
    let depth = |line: &RaySegment| -> f64 {
        let of =
            |l: &RgbLayer| f64::from(l.extinction_per_m[lane]) * l.density.column_along_m(line);
        layers.iter().map(of).sum()
    };
    // Stop where all light is attenuated.
    let mut end = line.length_m.min(1e9);
    while depth(&line.part(0.0, end)) > 60.0 {
        end *= 0.8;
    }
    let rule = GaussRule::new(12);
    let mut breaks: Vec<f64> = (0..24)
        .flat_map(|k| {
            let step = end * 0.3f64.powi(k);
            [step, end - step]
        })
        .collect();
    let lowest = -0.5 * line.sin_elevation / line.curvature_per_m;
    let mut kinks = vec![lowest];
    for layer in layers {
        for edge in layer.density.breakpoints_m() {
            let (a, b) = line.below(edge);
            kinks.extend([a, b]);
        }
    }
    for kink in kinks.into_iter().filter(|k| k.is_finite()) {
        breaks.push(kink);
        for k in 0..24 {
            let step = end * 0.3f64.powi(k);
            breaks.extend([kink - step, kink + step]);
        }
    }
    breaks.sort_by(f64::total_cmp);
    let path = rule.integrate_between(0.0, end, &breaks, |s| {
        let height = line.height_at(s);
        let to_sun = RaySegment::new(height, sine, f64::INFINITY, ground.radius_m);
        let sunlit = if ground.blocks(&to_sun) && scattering != FogScattering::Undimmed {
            0.0
        } else if scattering == FogScattering::Undimmed {
            1.0
        } else {
            let bounded = layers.iter().filter(|l| !l.density.is_uniform());
            let of = |l: &RgbLayer| {
                f64::from(l.extinction_per_m[lane]) * l.density.column_along_m(&to_sun)
            };
            (-bounded.map(of).sum::<f64>()).exp()
        };
        let mut source = 0.0;
        for layer in layers {
            let scattered =
                f64::from(layer.extinction_per_m[lane] * layer.single_scattering_albedo[lane]);
            source += scattered
                * layer.density.at(height)
                * (f64::from(light.ambient[lane])
                    + f64::from(light.sun.unwrap().irradiance[lane])
                        * sunlit
                        * layer.phase.evaluate(cos_sun, 550.0));
        }
        source * (-depth(&line.part(0.0, s))).exp()
    });
    (depth(line), path)
}

fn worst_error(
    layers: &[RgbLayer],
    ground: Ground,
    lines: &[RaySegment],
    elevations: &[f64],
) -> f64 {
    let mut worst = 0.0f64;
    for &elevation in elevations {
        for scattering in [FogScattering::Undimmed, FogScattering::Single] {
            let light = light(elevation);
            let fog = lanes(layers, ground, light, scattering).unwrap();
            for (k, line) in lines.iter().enumerate() {
                let got = fog.path_along(line, 0.3);
                let lane = 2 * (k % 2);
                let (depth, path) =
                    by_quadrature(layers, ground, &light, scattering, line, 0.3, lane);
                let t = f64::from(got.transmittance[lane]);
                assert!(
                    (t - (-depth).exp()).abs() < 1e-4 * (-depth).exp() + 1e-37,
                    "T {t} against e^-{depth}: {line:?}"
                );
                // Ignore light below the range of f32.
                let error = (f64::from(got.path_radiance[lane]) - path).abs() / (path + 1e-30);
                if error > worst {
                    worst = error;
                    if std::env::var("FOG_ERRORS").is_ok() {
                        println!(
                            "{error:.2e} {scattering:?} sun {elevation} lane {lane} {line:?} depth {depth}: {} {path}",
                            got.path_radiance[lane]
                        );
                    }
                }
            }
        }
    }
    worst
}

/// Rays that stay above `floor_m`.
fn lines(ground: Ground, floor_m: f64, heights: &[f64], lengths: &[f64]) -> Vec<RaySegment> {
    let mut lines = Vec::new();
    for &height in heights {
        for sin_elevation in [
            0.0, 1e-7, -1e-7, 1e-3, -1e-3, 0.05, -0.05, 0.5, -0.5, 1.0, -1.0,
        ] {
            for &length in lengths {
                let line = RaySegment::new(height, sin_elevation, length, ground.radius_m);
                let lowest = (-0.5 * sin_elevation / line.curvature_per_m).clamp(0.0, length);
                let lowest = if lowest.is_nan() { 0.0 } else { lowest };
                if line.end_height_m().min(line.height_at(lowest)) >= floor_m {
                    lines.push(line);
                }
            }
        }
    }
    lines
}

#[test]
fn one_profile_over_flat_ground_is_exact() {
    for scale in [1e-2, 1.0, 30.0, 1e3, 1e5, 1e7] {
        let exponential = DensityProfile::Exponential {
            reference_height_m: 0.0,
            scale_height_m: scale,
        };
        let clamped = DensityProfile::Clamped {
            base_height_m: 12.0,
            scale_height_m: scale,
        };
        for profile in [
            exponential,
            clamped,
            DensityProfile::slab(40.0),
            DensityProfile::Uniform,
        ] {
            for extinction in [1e-6, 0.01, 1.0] {
                let layers = [
                    RgbLayer {
                        density: profile.clone(),
                        ..drops(extinction)
                    },
                    RgbLayer {
                        density: profile.clone(),
                        ..molecules(0.3 * extinction)
                    },
                ];
                // In very deep fog sunlight underflows in f32.
                if extinction as f64 * profile.column_above_m(0.0) > 10.0
                    && profile != DensityProfile::Uniform
                {
                    continue;
                }
                let heights = [0.0, 1.7, 30.0].map(|h: f64| h.min(20.0 * scale));
                let lengths = [1e-6, 1e-2, 3.0, 200.0, 1e4, 1e7];
                let lines = lines(Ground::FLAT, -scale.min(20.0), &heights, &lengths);
                let worst = worst_error(&layers, Ground::FLAT, &lines, &[0.5, 30.0]);
                assert!(worst < 1e-5, "{profile:?} {extinction}: {worst:.2e}");
            }
        }
    }
}

/// The errors documented at [`FogLanes::path_along`].
#[test]
fn errors_of_several_profiles_and_round_ground() {
    let exponential = |scale_height_m| DensityProfile::Exponential {
        reference_height_m: 0.0,
        scale_height_m,
    };
    let valley = DensityProfile::Clamped {
        base_height_m: 30.0,
        scale_height_m: 10.0,
    };
    let slab = DensityProfile::slab(80.0);
    let fogs: [Vec<RgbLayer>; 4] = [
        vec![RgbLayer {
            density: exponential(1200.0),
            ..drops(1e-4)
        }],
        vec![
            RgbLayer {
                density: exponential(50.0),
                ..drops(0.02)
            },
            RgbLayer {
                density: exponential(1200.0),
                ..drops(2e-4)
            },
            RgbLayer {
                density: exponential(8000.0),
                ..molecules(3e-5)
            },
        ],
        vec![
            RgbLayer {
                density: valley,
                ..drops(0.03)
            },
            RgbLayer {
                density: exponential(2000.0),
                ..drops(1e-4)
            },
        ],
        vec![
            RgbLayer {
                density: slab,
                ..drops(0.01)
            },
            RgbLayer {
                density: exponential(15.0),
                ..drops(0.02)
            },
        ],
    ];
    for layers in &fogs {
        for ground in [Ground::FLAT, EARTH] {
            let lines = lines(
                ground,
                -1.0,
                &[0.0, 1.7, 100.0, 2e3],
                &[5.0, 200.0, 1e4, 1e5],
            );
            let worst = worst_error(layers, ground, &lines, &[0.5, 5.0, 40.0]);
            let stated = if ground.is_flat() { 2e-3 } else { 1e-2 };
            assert!(worst < stated, "{layers:?} {ground:?}: {worst:.2e}");
        }
    }
}

/// Elevated layers, tents, tables, sums and the standard atmosphere.
#[test]
fn all_density_profiles_may_be_fog() {
    let elevated = DensityProfile::Layer {
        bottom_m: 30.0,
        top_m: 70.0,
    };
    let tent = DensityProfile::Tent {
        bottom_m: 10.0,
        peak_m: 50.0,
        top_m: 120.0,
    };
    let heights: Vec<f64> = (0..4).map(|k| 100.0 * f64::from(k)).collect();
    let decaying = heights.iter().map(|h| (-h / 40.0).exp()).collect();
    let table = DensityProfile::tabulated(heights, decaying, Interpolation::LogLinear).unwrap();
    let sum = DensityProfile::Sum(vec![(0.5, elevated.clone()), (2.0, tent.clone())]);
    for (density, extinction) in [
        (elevated, 0.02),
        (tent, 0.02),
        (table.clone(), 0.02),
        (sum, 0.01),
        (DensityProfile::StandardAir1976, 3e-5),
    ] {
        let layers = [
            RgbLayer {
                density,
                ..drops(extinction)
            },
            RgbLayer {
                density: DensityProfile::exponential(1500.0),
                ..molecules(1e-4)
            },
        ];
        for (layers, grounds) in [
            (&layers[..1], &[EARTH][..]),
            (&layers[..], &[Ground::FLAT, EARTH]),
        ] {
            for &ground in grounds {
                let stated = if ground.is_flat() { 2e-3 } else { 1e-2 };
                let lines = lines(ground, -1.0, &[1.7, 50.0], &[1e4]);
                let worst = worst_error(layers, ground, &lines, &[5.0]);
                assert!(worst < stated, "{layers:?} {ground:?}: {worst:.2e}");
            }
        }
    }
    // Multiple scattering in a tabulated exponential equals that in the exponential.
    let [by_table, by_formula] = [table, DensityProfile::exponential(40.0)].map(|density| {
        let layers = [RgbLayer {
            density,
            ..drops(0.02)
        }];
        lanes(&layers, Ground::FLAT, light(30.0), FogScattering::Multiple).unwrap()
    });
    for k in 0..200 {
        let view = axes::direction(3.7 * f64::from(k), -8.0 + 0.49 * f64::from(k));
        // Below the ground the table ends.
        let to_ground_m = if view.y < 0.0 {
            -5.0 / view.y
        } else {
            f64::INFINITY
        };
        let distance_m = to_ground_m.min(30.0 * f64::from(k));
        let [a, b] = [&by_table, &by_formula].map(|fog| fog.path(5.0, view, distance_m));
        for lane in 0..3 {
            let (a, b) = (a.path_radiance[lane], b.path_radiance[lane]);
            assert!((a - b).abs() <= 5e-3 * b, "{view}: {a} {b}");
        }
    }
}

#[test]
fn rays_may_be_split_anywhere() {
    let exponential = |scale_height_m| DensityProfile::Exponential {
        reference_height_m: 0.0,
        scale_height_m,
    };
    let one = vec![RgbLayer {
        density: exponential(40.0),
        ..drops(0.02)
    }];
    let two = vec![
        RgbLayer {
            density: DensityProfile::slab(25.0),
            ..drops(0.02)
        },
        RgbLayer {
            density: exponential(900.0),
            ..molecules(3e-4)
        },
    ];
    let alone = |profile| {
        vec![RgbLayer {
            density: profile,
            ..drops(0.02)
        }]
    };
    let (uniform, slab) = (
        alone(DensityProfile::Uniform),
        alone(DensityProfile::slab(50.0)),
    );
    let clamped = alone(DensityProfile::Clamped {
        base_height_m: 45.0,
        scale_height_m: 9.0,
    });
    for (layers, ground, tolerance) in [
        (&one, Ground::FLAT, 1e-5),
        (&uniform, Ground::FLAT, 1e-5),
        (&slab, Ground::FLAT, 1e-5),
        (&clamped, Ground::FLAT, 1e-5),
        (&two, Ground::FLAT, 1e-3),
        (&one, EARTH, 1e-3),
    ] {
        for scattering in [
            FogScattering::Undimmed,
            FogScattering::Single,
            FogScattering::Multiple,
        ] {
            let fog = lanes(layers, ground, light(20.0), scattering).unwrap();
            for sin_elevation in [0.0, 1e-3, -1e-3, 0.3, -0.3] {
                let line = RaySegment::new(60.0, sin_elevation, 180.0, ground.radius_m);
                let whole = fog.path_along(&line, 0.4);
                for cut in [1e-3, 1.0, 45.0, 179.9] {
                    let near = fog.path_along(&line.part(0.0, cut), 0.4);
                    let far = fog.path_along(&line.part(cut, 180.0), 0.4);
                    let joined = near.then(far);
                    for lane in 0..3 {
                        let pair = |of: fn(&PathOptics<3>) -> Spectrum<3>| {
                            (of(&joined)[lane], of(&whole)[lane])
                        };
                        for (a, b) in [pair(|p| p.transmittance), pair(|p| p.path_radiance)] {
                            // Both are 0 for rays above the fog.
                            assert!(
                                (a - b).abs() <= tolerance * b,
                                "{sin_elevation} {cut}: {a} {b}"
                            );
                        }
                    }
                }
            }
        }
    }
}

#[test]
fn fog_without_absorption_is_invisible_in_uniform_light() {
    let mut clear = drops(0.01);
    clear.single_scattering_albedo = [1.0; 3];
    let everywhere = FogLighting {
        sun: None,
        ambient: Spectrum([0.3, 0.4, 0.5]),
        ground_albedo: Spectrum::ONE,
    };
    for profile in [
        DensityProfile::Uniform,
        DensityProfile::slab(30.0),
        DensityProfile::Clamped {
            base_height_m: 20.0,
            scale_height_m: 5.0,
        },
        DensityProfile::Exponential {
            reference_height_m: 0.0,
            scale_height_m: 60.0,
        },
    ] {
        let layers = [RgbLayer {
            density: profile.clone(),
            ..clear.clone()
        }];
        for ground in [Ground::FLAT, EARTH] {
            for scattering in [FogScattering::Single, FogScattering::Multiple] {
                let fog = lanes(&layers, ground, everywhere, scattering).unwrap();
                for line in lines(
                    ground,
                    -1.0,
                    &[0.0, 5.0, 50.0],
                    &[1e-3, 1.0, 100.0, 1e5, f64::INFINITY],
                ) {
                    let seen = fog.path_along(&line, 0.0).apply(everywhere.ambient);
                    for lane in 0..3 {
                        let ratio = seen[lane] / everywhere.ambient[lane];
                        // Moments of the diffuse light are stored in f32.
                        assert!((ratio - 1.0).abs() < 2e-5, "{profile:?} {line:?}: {ratio}");
                    }
                }
            }
        }
    }
}

#[test]
fn transmittance_is_between_0_and_1_and_decreases_with_distance() {
    for profile in [
        DensityProfile::Uniform,
        DensityProfile::Clamped {
            base_height_m: 5.0,
            scale_height_m: 20.0,
        },
        DensityProfile::Exponential {
            reference_height_m: 0.0,
            scale_height_m: 0.5,
        },
    ] {
        let fog = lanes(
            &[RgbLayer {
                density: profile.clone(),
                ..drops(0.05)
            }],
            EARTH,
            light(10.0),
            FogScattering::Single,
        )
        .unwrap();
        for sin_elevation in [0.0, 0.2, -1e-2, 1.0] {
            let mut before = Spectrum::ONE;
            for k in -20..48 {
                let line = RaySegment::new(40.0, sin_elevation, 1.4f64.powi(k), EARTH.radius_m);
                let optics = fog.path_along(&line, 0.9);
                for lane in 0..3 {
                    let t = optics.transmittance[lane];
                    assert!(
                        (0.0..=before[lane]).contains(&t),
                        "{profile:?} {line:?}: {t}"
                    );
                    assert!(optics.path_radiance[lane] >= 0.0 && optics.path_radiance.is_finite());
                }
                before = optics.transmittance;
            }
        }
    }
}

/// The closed form of attenuated sunlight in f64.
#[test]
fn sunlight_in_exponential_fog_is_exact_in_f64() {
    use crate::fog::closed_forms::mean_attenuated_source;
    for scale_height_m in [1e-2, 1.0, 50.0, 1e4, 1e7] {
        let profile = DensityProfile::Exponential {
            reference_height_m: 0.0,
            scale_height_m,
        };
        let mut tested = 0;
        for (sin_elevation, sine, length_m, depth) in [0.0, 1e-9, -1e-9, 0.02, 0.5, -0.5, 1.0, -1.0]
            .into_iter()
            .flat_map(|sin_elevation| [0.01, 0.5, 1.0].map(|sine| (sin_elevation, sine)))
            .flat_map(|(sin_elevation, sine)| {
                [1e-6, 1.0, 1e3, 1e7].map(|l| (sin_elevation, sine, l))
            })
            .flat_map(|(c, s, l)| [1e-6, 0.3, 8.0].map(|depth| (c, s, l, depth)))
        {
            // Extinction for this vertical optical depth above the eye.
            let extinction = depth / scale_height_m;
            let line = RaySegment::flat(0.0, sin_elevation, length_m);
            let along = extinction * profile.column_along_m(&line);
            let near = depth / sine;
            if along > 40.0 || near > 100.0 || sin_elevation * length_m < -3.0 * scale_height_m {
                continue;
            }
            tested += 1;
            let far = near + along * (1.0 - sin_elevation / sine);
            let got = along * mean_attenuated_source(near, far.max(0.0));
            // Intervals that shrink towards both ends.
            let mut breaks: Vec<f64> = (0..60)
                .map(|k| length_m * 0.6f64.powi(k))
                .flat_map(|step| [step, length_m - step])
                .collect();
            breaks.sort_by(f64::total_cmp);
            let exact = GaussRule::new(16).integrate_between(0.0, length_m, &breaks, |s| {
                let height = line.height_at(s);
                let seen = extinction * profile.column_along_m(&line.part(0.0, s));
                let lit = extinction * profile.column_above_m(height) / sine;
                extinction * profile.at(height) * (-seen - lit).exp()
            });
            assert!(
                (got - exact).abs() < 1e-6 * exact + 1e-280,
                "{scale_height_m} {sin_elevation} {sine} {length_m} {depth}: {got:e} {exact:e}"
            );
        }
        assert!(tested > 60, "{tested}");
    }
}

#[test]
fn invalid_inputs_are_rejected() {
    let refused = |layers: &[RgbLayer], ground, light| {
        lanes(layers, ground, light, FogScattering::Single)
            .unwrap_err()
            .to_string()
    };
    let phase = || PhaseFunction::Isotropic;
    let good = layer([0.1; 3], 1.0, phase());
    let error = refused(
        &[layer([0.1, f32::NAN, 0.1], 1.0, phase())],
        Ground::FLAT,
        light(5.0),
    );
    assert!(
        error.contains("extinction") && error.contains("channel 1"),
        "{error}"
    );
    let error = refused(&[layer([0.1; 3], 1.5, phase())], Ground::FLAT, light(5.0));
    assert!(error.contains("albedo"), "{error}");
    let flat = Ground {
        radius_m: 0.0,
        ..Ground::FLAT
    };
    assert!(refused(std::slice::from_ref(&good), flat, light(5.0)).contains("radius"));
    let mut dark = light(5.0);
    dark.ambient = Spectrum([-1.0, 0.0, 0.0]);
    assert!(refused(std::slice::from_ref(&good), Ground::FLAT, dark).contains("ambient"));
    let mut long = light(5.0);
    long.sun.as_mut().unwrap().direction *= 2.0;
    assert!(refused(&[good], Ground::FLAT, long).contains("direction"));
}

#[test]
fn multiple_scattering_equals_single_scattering_in_thin_fog() {
    let layers = [RgbLayer {
        density: DensityProfile::Exponential {
            reference_height_m: 0.0,
            scale_height_m: 30.0,
        },
        ..drops(1e-6)
    }];
    let mut black = light(25.0);
    black.ground_albedo = Spectrum::ZERO;
    black.ambient = Spectrum::ZERO;
    let [one, many] = [FogScattering::Single, FogScattering::Multiple]
        .map(|scattering| lanes(&layers, Ground::FLAT, black, scattering).unwrap());
    for (azimuth, elevation) in [(120.0, 25.0), (120.0, 40.0), (300.0, 3.0), (10.0, 90.0)] {
        let view = axes::direction(azimuth, elevation);
        let [a, b] = [&one, &many].map(|fog| fog.path(1.7, view, 2e3).path_radiance[1]);
        assert!((b / a - 1.0).abs() < 2e-3, "{azimuth} {elevation}: {a} {b}");
    }
}

#[test]
fn multiple_scattering_brightens_thick_fog() {
    // A cloud without absorption and with optical depth 30 transmits a large part of the sunlight; single scattering nearly none.
    let mut white = drops(0.3);
    white.single_scattering_albedo = [1.0; 3];
    let layers = [RgbLayer {
        density: DensityProfile::slab(100.0),
        ..white
    }];
    let [one, many] = [FogScattering::Single, FogScattering::Multiple]
        .map(|scattering| lanes(&layers, Ground::FLAT, light(40.0), scattering).unwrap());
    let near_horizon = |fog: &FogLanes<3>| {
        fog.path(1.7, axes::direction(200.0, 5.0), 500.0)
            .path_radiance[1]
    };
    assert!(
        near_horizon(&many) > 0.05 && near_horizon(&one) < 0.2,
        "{} {}",
        near_horizon(&many),
        near_horizon(&one)
    );
    let ground = many.ground_irradiance().unwrap()[1] / (1.8 * axes::direction(0.0, 40.0).y as f32);
    assert!((0.15..0.7).contains(&ground), "{ground}");
    // Path radiance is not negative, near the sun and away from it, in thick and in thin fog.
    for extinction in [1e-4, 0.01, 1.0] {
        let layers = [RgbLayer {
            density: DensityProfile::Exponential {
                reference_height_m: 0.0,
                scale_height_m: 20.0,
            },
            phase: droplets::phase(12.0),
            ..drops(extinction)
        }];
        let fog = lanes(&layers, Ground::FLAT, light(8.0), FogScattering::Multiple).unwrap();
        for k in 0..400 {
            let k = f64::from(k);
            let view = axes::direction(0.9 * k, -20.0 + 0.27 * k);
            let path = fog.path(3.0, view, 1.0 + k * k).path_radiance;
            assert!(
                path.min_element() >= 0.0 && path.is_finite(),
                "{extinction} {view}: {path:?}"
            );
        }
    }
}
