use super::super::{PointLamp, SphereLamp, SpotLamp};
use super::*;
use crate::fog::line::Line;
use crate::fog::matter::Matter;
use crate::optics::PhaseFunction;
use std::f64::consts::PI;

const WAVELENGTHS_NM: [f64; 3] = [610.0, 550.0, 465.0];

fn matter(phase: PhaseFunction) -> Matter<3> {
    Matter {
        extinction_per_m: Spectrum([0.02, 0.021, 0.024]),
        single_scattering_albedo: Spectrum([0.99, 0.98, 0.97]),
        phase,
    }
}

fn murk<'a>(matter: &'a Matter<3>, profile: &'a Profile) -> Murk<'a, 3> {
    Murk {
        matter,
        profile,
        others: &[],
        wavelengths_nm: &WAVELENGTHS_NM,
        ground_radius_m: f64::INFINITY,
    }
}

fn street() -> Lamps<3> {
    let light = Spectrum([120.0, 100.0, 60.0]);
    let lamps = vec![
        Lamp::Point(PointLamp::new(DVec3::new(2.0, 5.0, -15.0), light, 0.05).unwrap()),
        Lamp::Spot(
            SpotLamp::new(
                DVec3::new(-3.0, 6.0, -30.0),
                DVec3::NEG_Y,
                light,
                0.3,
                0.9,
                0.05,
            )
            .unwrap(),
        ),
        Lamp::Sphere(SphereLamp::new(DVec3::new(0.0, 4.0, -40.0), 0.4, light).unwrap()),
    ];
    Lamps::new(lamps, LampSettings::default()).expect("lamps")
}

fn sight(direction: DVec3, length_m: f64) -> Sight {
    Sight {
        eye: DVec3::new(0.0, 1.7, 0.0),
        direction: direction.normalize(),
        length_m,
    }
}

fn phases() -> [PhaseFunction; 2] {
    [
        PhaseFunction::Isotropic,
        PhaseFunction::henyey_greenstein(0.85).unwrap(),
    ]
}

fn profiles() -> [Profile; 4] {
    [
        Profile::Uniform,
        Profile::Exponential {
            reference_height_m: 0.0,
            scale_height_m: 12.0,
        },
        Profile::Clamped {
            base_height_m: 3.0,
            scale_height_m: 4.0,
        },
        Profile::Slab { top_height_m: 4.5 },
    ]
}

const DIRECTIONS: [DVec3; 5] = [
    DVec3::new(0.0, 0.0, -1.0),
    DVec3::new(0.13, 0.2, -1.0),
    DVec3::new(-0.1, 0.1, -1.0),
    DVec3::new(0.0, 1.0, -0.1),
    DVec3::new(0.3, -0.02, 1.0),
];

#[test]
fn near_and_far_compose_to_the_whole() {
    let lamps = street();
    for phase in phases() {
        let matter = matter(phase);
        for profile in profiles() {
            let murk = murk(&matter, &profile);
            for direction in DIRECTIONS {
                let whole = sight(direction, 70.0);
                let all = lamps.path_radiance(&murk, &whole);
                for split in [0.5, 14.0, 15.3, 33.0, 60.0] {
                    let near = lamps.path_radiance(&murk, &sight(direction, split));
                    let far = lamps.path_radiance(
                        &murk,
                        &Sight {
                            eye: whole.eye + split * whole.direction,
                            length_m: 70.0 - split,
                            ..whole
                        },
                    );
                    let line = Line::flat(1.7, whole.direction.y, split);
                    let depth = matter.extinction_per_m * profile.column(&line) as f32;
                    let both = near + depth.exp_neg() * far;
                    for lane in 0..3 {
                        assert!(
                            (both[lane] / all[lane] - 1.0).abs() < 5e-5,
                            "{profile:?} {direction} {split}: {both:?} {all:?}"
                        );
                    }
                }
            }
        }
    }
}

#[test]
fn the_short_way_for_even_uniform_fog_is_the_long_way() {
    let matter = matter(PhaseFunction::Isotropic);
    let murk = murk(&matter, &Profile::Uniform);
    let lamps = street();
    let haze = Haze::new(&murk).unwrap();
    for direction in DIRECTIONS {
        for length in [1.0, 20.0, f64::INFINITY] {
            let sight = sight(direction, length);
            let lamp = &lamps.lamps()[0];
            let short = lamps.of_one(lamp, &haze, &sight);
            let long = Ray::new(lamp, &haze, &sight).path_radiance(&Nodes::new(24));
            for lane in 0..3 {
                assert!((short[lane] / long[lane] - 1.0).abs() < 1e-5);
            }
        }
    }
}

#[test]
fn nothing_is_infinite_anywhere() {
    let light = Spectrum([1.0f32; 3]);
    let at = DVec3::new(0.0, 3.0, 0.0);
    let lamps = Lamps::new(
        vec![
            Lamp::Point(PointLamp::new(at, light, 0.1).unwrap()),
            Lamp::Spot(SpotLamp::new(at, DVec3::NEG_Y, light, 0.1, 0.4, 0.1).unwrap()),
        ],
        LampSettings::default(),
    )
    .unwrap();
    for phase in phases() {
        let matter = matter(phase);
        for profile in profiles() {
            for ground_radius_m in [f64::INFINITY, 6.371e6] {
                let murk = Murk {
                    ground_radius_m,
                    ..murk(&matter, &profile)
                };
                for eye in [at, DVec3::new(0.0, 1e5, 0.0), DVec3::new(30.0, 0.0, 4.0)] {
                    for direction in [DVec3::X, DVec3::Y, DVec3::NEG_Y, DVec3::new(0.8, -0.6, 0.0)]
                    {
                        for length_m in [0.0, 1e-6, 10.0, 1e7, f64::INFINITY] {
                            let sight = Sight {
                                eye,
                                direction,
                                length_m,
                            };
                            let got = lamps.path_radiance(&murk, &sight);
                            assert!(
                                got.is_finite() && got.min_element() >= 0.0,
                                "{murk:?} {sight:?}: {got:?}"
                            );
                        }
                    }
                }
            }
        }
    }
}

#[test]
fn an_eye_at_the_lamp_sees_half_a_turn_over_its_radius() {
    let thin = Matter {
        extinction_per_m: Spectrum([1e-9f32; 3]),
        single_scattering_albedo: Spectrum::ONE,
        phase: PhaseFunction::Isotropic,
    };
    let murk = murk(&thin, &Profile::Uniform);
    let at = DVec3::new(0.0, 3.0, 0.0);
    let lamp = PointLamp::new(at, Spectrum::ONE, 0.1).unwrap();
    let lamps = Lamps::new(vec![Lamp::Point(lamp)], LampSettings::default()).unwrap();
    let got = lamps.path_radiance(
        &murk,
        &Sight {
            eye: at,
            direction: DVec3::Y,
            length_m: f64::INFINITY,
        },
    );
    // theta / (4 pi h) with theta = pi / 2.
    assert!(
        (f64::from(got[0]) / (1e-9 / 0.8) - 1.0).abs() < 1e-5,
        "{got:?}"
    );
}

#[test]
fn a_line_ends_at_the_bulb() {
    let lamps = street();
    let matter = matter(PhaseFunction::Isotropic);
    let murk = murk(&matter, &Profile::Uniform);
    let bulb = DVec3::new(0.0, 4.0, -40.0);
    let eye = DVec3::new(0.0, 1.7, 0.0);
    let (distance, radiance) = lamps.hit(eye, (bulb - eye).normalize()).expect("a bulb");
    assert!((distance - ((bulb - eye).length() - 0.4)).abs() < 1e-9);
    assert_eq!(radiance, Spectrum([120.0, 100.0, 60.0]));
    let ended = lamps.path_radiance(&murk, &sight(bulb - eye, distance));
    let endless = lamps.path_radiance(&murk, &sight(bulb - eye, f64::INFINITY));
    assert_eq!(ended, endless);
    assert!(lamps.hit(eye, DVec3::Y).is_none());
}

#[test]
fn the_bound_is_one_and_leaves_out_only_what_is_below_it() {
    for phase in phases() {
        let matter = matter(phase);
        for profile in profiles() {
            let murk = murk(&matter, &profile);
            let haze = Haze::new(&murk).unwrap();
            let lamps = street();
            for direction in DIRECTIONS {
                let sight = sight(direction, 55.0);
                for lamp in lamps.lamps() {
                    let got = lamps.of_one(lamp, &haze, &sight).max_element();
                    let most = bound(&Ray::new(lamp, &haze, &sight), &haze);
                    assert!(got <= most, "{lamp:?} {sight:?}: {got} above {most}");
                }
                let all = lamps.path_radiance(&murk, &sight);
                let settings = LampSettings {
                    threshold: 1e-3,
                    ..Default::default()
                };
                let fewer = Lamps::new(lamps.lamps().to_vec(), settings).unwrap();
                let some = fewer.path_radiance(&murk, &sight);
                assert!((all - some).max_element() <= 3e-3);
            }
        }
    }
}

#[test]
fn light_from_all_sides_adds_up() {
    let sigma = 1e-6f32;
    let thin = Matter {
        extinction_per_m: Spectrum([sigma; 3]),
        single_scattering_albedo: Spectrum::ONE,
        phase: PhaseFunction::Isotropic,
    };
    let murk = murk(&thin, &Profile::Uniform);
    let lamp = PointLamp::new(DVec3::ZERO, Spectrum::ONE, 1e-9).unwrap();
    let lamps = Lamps::new(vec![Lamp::Point(lamp)], LampSettings::default()).unwrap();
    // Scalar irradiance, at distance D, of all light scattered once: sigma I int dV / (4 pi r^2 s^2), r from the lamp,
    // s from the eye: pi^3 / D times sigma I / (4 pi).
    let eye = DVec3::new(0.0, 0.0, 7.0);
    let rule = crate::quadrature::gauss_legendre(64);
    let sum = crate::quadrature::integrate_by(&rule, 0.0, PI, &[0.01, 0.1], |angle| {
        let direction = DVec3::new(angle.sin(), 0.0, -angle.cos());
        let line = Sight {
            eye,
            direction,
            length_m: f64::INFINITY,
        };
        2.0 * PI * angle.sin() * f64::from(lamps.path_radiance(&murk, &line)[0])
    });
    let want = PI.powi(3) / 7.0 * f64::from(sigma) / (4.0 * PI);
    assert!((sum / want - 1.0).abs() < 3e-4, "{sum} against {want}");
}

#[test]
fn surfaces_are_lit_through_the_fog() {
    let matter = matter(PhaseFunction::Isotropic);
    let lamps = street();
    let point = DVec3::new(2.0, 0.0, -15.0);
    let lit = lamps.lamps()[0].illumination(&murk(&matter, &Profile::Uniform), point);
    let want = 120.0 / 25.0 * (-0.02f64 * 5.0).exp();
    assert!((f64::from(lit[0]) / want - 1.0).abs() < 1e-6);
    // Only the metre and a half between 3 and 4.5 m of the slab is crossed from above; all else is clear.
    let slab = Profile::Slab { top_height_m: 4.5 };
    let lit = lamps.lamps()[0].illumination(&murk(&matter, &slab), DVec3::new(2.0, 3.0, -15.0));
    let want = 120.0 / 4.0 * (-0.02f64 * 1.5).exp();
    assert!((f64::from(lit[0]) / want - 1.0).abs() < 1e-6);
    // Beside the cone it is dark; at a ball's surface the irradiance is pi times the radiance.
    let murk = murk(&matter, &Profile::Uniform);
    let beside = lamps.lamps()[1].illumination(&murk, DVec3::new(-3.0, 6.5, -30.0));
    assert_eq!(beside, Spectrum::ZERO);
    let close = lamps.lamps()[2].illumination(&murk, DVec3::new(0.0, 3.6, -40.0));
    assert!((f64::from(close[0]) / (120.0 * PI) - 1.0).abs() < 1e-6);
}

#[test]
fn settings_are_checked() {
    let make = |nodes, threshold| Lamps::<3>::new(vec![], LampSettings { nodes, threshold });
    assert!(make(12, 0.0).is_ok());
    assert!(make(3, 0.0).is_err());
    assert!(make(1000, 0.0).is_err());
    assert!(make(12, -1.0).is_err());
    assert!(make(12, f32::NAN).is_err());
}
