use super::*;
use crate::atmosphere::DensityProfile;
use crate::axes;
use crate::fog::{DirectionalLight, Medium};
use crate::math::quadrature::GaussRule;
use crate::optics::{Depolarization, PhaseFunction};

const EARTH: Ground = Ground::EARTH;

fn medium(extinction_per_m: [f32; 3], albedo: f32, phase: PhaseFunction) -> Medium<3> {
    Medium {
        extinction_per_m: Spectrum(extinction_per_m),
        single_scattering_albedo: Spectrum::splat(albedo),
        phase,
    }
}

fn droplets(extinction: f32) -> Medium<3> {
    let e = [extinction, 1.1 * extinction, 1.2 * extinction];
    medium(e, 0.95, PhaseFunction::HenyeyGreenstein { g: 0.8 })
}

fn molecules(extinction: f32) -> Medium<3> {
    let e = [0.2 * extinction, 0.5 * extinction, extinction];
    medium(e, 1.0, PhaseFunction::Rayleigh(Depolarization::None))
}

fn light(sun_elevation_deg: f64) -> FogLighting<3> {
    FogLighting {
        sun: Some(DirectionalLight {
            direction: axes::direction(120.0, sun_elevation_deg),
            irradiance: Spectrum([1.5, 1.8, 1.9]),
        }),
        ambient: Spectrum([0.1, 0.15, 0.3]),
        ground_albedo: Spectrum([0.1, 0.2, 0.3]),
    }
}

/// Single scattering along a line by brute force in f64, lane by lane: `(optical depth, path radiance)`.
fn by_quadrature(
    layers: &[Layer<3>],
    ground: Ground,
    light: &FogLighting<3>,
    scattering: FogScattering,
    line: &RaySegment,
    cos_sun: f64,
    lane: usize,
) -> (f64, f64) {
    let sine = light.sun.unwrap().direction.y;
    let depth = |line: &RaySegment| -> f64 {
        let of = |l: &Layer<3>| {
            f64::from(l.medium.extinction_per_m[lane]) * l.profile.column_along_m(line)
        };
        layers.iter().map(of).sum()
    };
    // Stop where nothing is left to see.
    let mut end = line.length_m.min(1e9);
    while depth(&line.part(0.0, end)) > 60.0 {
        end *= 0.8;
    }
    let rule = GaussRule::new(12);
    let mut breaks: Vec<f64> = (0..45)
        .flat_map(|k| {
            let step = end * 0.55f64.powi(k);
            [step, end - step]
        })
        .collect();
    let lowest = -0.5 * line.sin_elevation / line.curvature_per_m;
    let mut kinks = vec![lowest];
    for layer in layers {
        for edge in layer.profile.breakpoints_m() {
            let (a, b) = line.below(edge);
            kinks.extend([a, b]);
        }
    }
    for kink in kinks.into_iter().filter(|k| k.is_finite()) {
        breaks.push(kink);
        for k in 0..45 {
            let step = end * 0.55f64.powi(k);
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
            let solid = layers
                .iter()
                .filter(|l| l.profile != DensityProfile::Uniform);
            let of = |l: &Layer<3>| {
                f64::from(l.medium.extinction_per_m[lane]) * l.profile.column_along_m(&to_sun)
            };
            (-solid.map(of).sum::<f64>()).exp()
        };
        let mut source = 0.0;
        for layer in layers {
            let scattered = f64::from(layer.medium.scattering_per_m()[lane]);
            source += scattered
                * layer.profile.at(height)
                * (f64::from(light.ambient[lane])
                    + f64::from(light.sun.unwrap().irradiance[lane])
                        * sunlit
                        * layer.medium.phase.evaluate(cos_sun, 550.0));
        }
        source * (-depth(&line.part(0.0, s))).exp()
    });
    (depth(line), path)
}

fn worst_error(
    layers: &[Layer<3>],
    ground: Ground,
    lines: &[RaySegment],
    elevations: &[f64],
) -> f64 {
    let mut worst = 0.0f64;
    for &elevation in elevations {
        for scattering in [FogScattering::Undimmed, FogScattering::Single] {
            let light = light(elevation);
            let fog = Fog::new(layers, ground, light, scattering).unwrap();
            for line in lines {
                let got = fog.along_line(line, 0.3);
                for lane in [0, 2] {
                    let (depth, path) =
                        by_quadrature(layers, ground, &light, scattering, line, 0.3, lane);
                    let t = f64::from(got.transmittance[lane]);
                    assert!(
                        (t - (-depth).exp()).abs() < 1e-4 * (-depth).exp() + 1e-37,
                        "T {t} against e^-{depth}: {line:?}"
                    );
                    // What f32 cannot hold counts as dark.
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
    }
    worst
}

/// Lines that stay above `floor_m`.
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
                    Layer {
                        profile: profile.clone(),
                        medium: droplets(extinction),
                    },
                    Layer {
                        profile: profile.clone(),
                        medium: molecules(0.3 * extinction),
                    },
                ];
                // A fog so deep that the sun cannot be seen at all leaves f32's range.
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

/// What the doc comment of [`Fog::along_line`] states.
#[test]
fn several_profiles_and_round_ground_err_as_stated() {
    let exponential = |scale_height_m| DensityProfile::Exponential {
        reference_height_m: 0.0,
        scale_height_m,
    };
    let valley = DensityProfile::Clamped {
        base_height_m: 30.0,
        scale_height_m: 10.0,
    };
    let slab = DensityProfile::slab(80.0);
    let fogs: [Vec<Layer<3>>; 4] = [
        vec![Layer {
            profile: exponential(1200.0),
            medium: droplets(1e-4),
        }],
        vec![
            Layer {
                profile: exponential(50.0),
                medium: droplets(0.02),
            },
            Layer {
                profile: exponential(1200.0),
                medium: droplets(2e-4),
            },
            Layer {
                profile: exponential(8000.0),
                medium: molecules(3e-5),
            },
        ],
        vec![
            Layer {
                profile: valley,
                medium: droplets(0.03),
            },
            Layer {
                profile: exponential(2000.0),
                medium: droplets(1e-4),
            },
        ],
        vec![
            Layer {
                profile: slab,
                medium: droplets(0.01),
            },
            Layer {
                profile: exponential(15.0),
                medium: droplets(0.02),
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

#[test]
fn a_line_may_be_cut_anywhere() {
    let exponential = |scale_height_m| DensityProfile::Exponential {
        reference_height_m: 0.0,
        scale_height_m,
    };
    let one = vec![Layer {
        profile: exponential(40.0),
        medium: droplets(0.02),
    }];
    let two = vec![
        Layer {
            profile: DensityProfile::slab(25.0),
            medium: droplets(0.02),
        },
        Layer {
            profile: exponential(900.0),
            medium: molecules(3e-4),
        },
    ];
    let alone = |profile| {
        vec![Layer {
            profile,
            medium: droplets(0.02),
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
            let fog = Fog::new(layers, ground, light(20.0), scattering).unwrap();
            for sin_elevation in [0.0, 1e-3, -1e-3, 0.3, -0.3] {
                let line = RaySegment::new(60.0, sin_elevation, 180.0, ground.radius_m);
                let whole = fog.along_line(&line, 0.4);
                for cut in [1e-3, 1.0, 45.0, 179.9] {
                    let near = fog.along_line(&line.part(0.0, cut), 0.4);
                    let far = fog.along_line(&line.part(cut, 180.0), 0.4);
                    let joined = near.then(far);
                    for lane in 0..3 {
                        let pair = |of: fn(&PathOptics<3>) -> Spectrum<3>| {
                            (of(&joined)[lane], of(&whole)[lane])
                        };
                        for (a, b) in [pair(|p| p.transmittance), pair(|p| p.path_radiance)] {
                            // Of a line above the fog both are 0.
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
fn fog_that_loses_nothing_is_invisible_in_light_that_is_the_same_everywhere() {
    let mut clear = droplets(0.01);
    clear.single_scattering_albedo = Spectrum::ONE;
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
        let layers = [Layer {
            profile: profile.clone(),
            medium: clear.clone(),
        }];
        for ground in [Ground::FLAT, EARTH] {
            for scattering in [FogScattering::Single, FogScattering::Multiple] {
                let fog = Fog::new(&layers, ground, everywhere, scattering).unwrap();
                for line in lines(
                    ground,
                    -1.0,
                    &[0.0, 5.0, 50.0],
                    &[1e-3, 1.0, 100.0, 1e5, f64::INFINITY],
                ) {
                    let seen = fog.along_line(&line, 0.0).apply(everywhere.ambient);
                    for lane in 0..3 {
                        let ratio = seen[lane] / everywhere.ambient[lane];
                        // The moments of the diffuse light are kept in f32.
                        assert!((ratio - 1.0).abs() < 2e-5, "{profile:?} {line:?}: {ratio}");
                    }
                }
            }
        }
    }
}

#[test]
fn transmittance_keeps_between_nothing_and_all_and_falls_with_distance() {
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
        let fog = Fog::new(
            &[Layer {
                profile: profile.clone(),
                medium: droplets(0.05),
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
                let optics = fog.along_line(&line, 0.9);
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

/// The closed form in f64, for one wavelength: the sun's own way through exponential fog included (ERRATA's extension).
#[test]
fn sunlight_in_exponential_fog_is_exact_in_f64() {
    use crate::fog::scatter;
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
            // An extinction that leaves this vertical optical depth above the eye.
            let extinction = depth / scale_height_m;
            let line = RaySegment::flat(0.0, sin_elevation, length_m);
            let along = extinction * profile.column_along_m(&line);
            let near = depth / sine;
            if along > 40.0 || near > 100.0 || sin_elevation * length_m < -3.0 * scale_height_m {
                continue;
            }
            tested += 1;
            let got = scatter::once(near, along * (1.0 - sin_elevation / sine), along);
            // Steps that crowd to both ends.
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
fn bad_numbers_are_refused_at_the_door() {
    let layer = |m: Medium<3>| {
        [Layer {
            profile: DensityProfile::Uniform,
            medium: m,
        }]
    };
    let refused = |layers: &[Layer<3>], ground, light| {
        Fog::new(layers, ground, light, FogScattering::Single)
            .unwrap_err()
            .to_string()
    };
    let phase = || PhaseFunction::Isotropic;
    let good = medium([0.1; 3], 1.0, phase());
    let error = refused(
        &layer(medium([0.1, f32::NAN, 0.1], 1.0, phase())),
        Ground::FLAT,
        light(5.0),
    );
    assert!(
        error.contains("extinction") && error.contains("lane 1"),
        "{error}"
    );
    let error = refused(
        &layer(medium([0.1; 3], 1.5, phase())),
        Ground::FLAT,
        light(5.0),
    );
    assert!(error.contains("albedo"), "{error}");
    let flat = Ground {
        radius_m: 0.0,
        ..Ground::FLAT
    };
    assert!(refused(&layer(good.clone()), flat, light(5.0)).contains("radius"));
    let mut dark = light(5.0);
    dark.ambient = Spectrum([-1.0, 0.0, 0.0]);
    assert!(refused(&layer(good.clone()), Ground::FLAT, dark).contains("ambient"));
    let mut long = light(5.0);
    long.sun.as_mut().unwrap().direction *= 2.0;
    assert!(refused(&layer(good), Ground::FLAT, long).contains("direction"));
}

#[test]
fn in_thin_fog_many_scatterings_are_one() {
    let layers = [Layer {
        profile: DensityProfile::Exponential {
            reference_height_m: 0.0,
            scale_height_m: 30.0,
        },
        medium: droplets(1e-6),
    }];
    let mut black = light(25.0);
    black.ground_albedo = Spectrum::ZERO;
    black.ambient = Spectrum::ZERO;
    let [one, many] = [FogScattering::Single, FogScattering::Multiple]
        .map(|scattering| Fog::new(&layers, Ground::FLAT, black, scattering).unwrap());
    for (azimuth, elevation) in [(120.0, 25.0), (120.0, 40.0), (300.0, 3.0), (10.0, 90.0)] {
        let view = axes::direction(azimuth, elevation);
        let [a, b] = [&one, &many].map(|fog| fog.along(1.7, view, 2e3).path_radiance[1]);
        assert!((b / a - 1.0).abs() < 2e-3, "{azimuth} {elevation}: {a} {b}");
    }
}

#[test]
fn thick_fog_is_not_dark() {
    // A white cloud 30 optical depths thick sends a good part of the sunlight on; single scattering sends next to none.
    let mut white = droplets(0.3);
    white.single_scattering_albedo = Spectrum::ONE;
    let layers = [Layer {
        profile: DensityProfile::slab(100.0),
        medium: white,
    }];
    let [one, many] = [FogScattering::Single, FogScattering::Multiple]
        .map(|scattering| Fog::new(&layers, Ground::FLAT, light(40.0), scattering).unwrap());
    let level = |fog: &Fog<3>| {
        fog.along(1.7, axes::direction(200.0, 5.0), 500.0)
            .path_radiance[1]
    };
    assert!(
        level(&many) > 0.05 && level(&one) < 0.2,
        "{} {}",
        level(&many),
        level(&one)
    );
    let ground = many.ground_irradiance().unwrap()[1] / (1.8 * axes::direction(0.0, 40.0).y as f32);
    assert!((0.15..0.7).contains(&ground), "{ground}");
    // Nothing below 0 anywhere, near the sun and away from it, in thick and in thin fog.
    for extinction in [1e-4, 0.01, 1.0] {
        let layers = [Layer {
            profile: DensityProfile::Exponential {
                reference_height_m: 0.0,
                scale_height_m: 20.0,
            },
            medium: Medium {
                phase: crate::fog::droplets::phase(12.0),
                ..droplets(extinction)
            },
        }];
        let fog = Fog::new(&layers, Ground::FLAT, light(8.0), FogScattering::Multiple).unwrap();
        for k in 0..400 {
            let k = f64::from(k);
            let view = axes::direction(0.9 * k, -20.0 + 0.27 * k);
            let path = fog.along(3.0, view, 1.0 + k * k).path_radiance;
            assert!(
                path.min_element() >= 0.0 && path.is_finite(),
                "{extinction} {view}: {path:?}"
            );
        }
    }
}
