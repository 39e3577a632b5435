use super::super::{PointLight, SphereLight, SpotLight};
use super::*;
use crate::atmosphere::DensityProfile;
use crate::atmosphere::RaySegment;
use crate::fog::layer::Medium;
use crate::optics::PhaseFunction;
use std::f64::consts::PI;

const WAVELENGTHS_NM: [f64; 3] = [610.0, 550.0, 465.0];

fn particles(phase: PhaseFunction) -> Medium<3> {
    Medium {
        extinction_per_m: Spectrum([0.02, 0.021, 0.024]),
        single_scattering_albedo: Spectrum([0.99, 0.98, 0.97]),
        phase,
    }
}

fn medium<'a>(particles: &'a Medium<3>, profile: &'a DensityProfile) -> ParticipatingMedium<'a, 3> {
    ParticipatingMedium {
        medium: particles,
        profile,
        others: &[],
        wavelengths_nm: &WAVELENGTHS_NM,
        ground_radius_m: f64::INFINITY,
    }
}

fn street() -> LightSet<3> {
    let light = Spectrum([120.0, 100.0, 60.0]);
    let lights = vec![
        Light::Point(PointLight::new(DVec3::new(2.0, 5.0, -15.0), light, 0.05).unwrap()),
        Light::Spot(
            SpotLight::new(
                DVec3::new(-3.0, 6.0, -30.0),
                DVec3::NEG_Y,
                light,
                0.3,
                0.9,
                0.05,
            )
            .unwrap(),
        ),
        Light::Sphere(SphereLight::new(DVec3::new(0.0, 4.0, -40.0), 0.4, light).unwrap()),
    ];
    LightSet::new(lights, LightSettings::default()).expect("lights")
}

fn view_ray(direction: DVec3, length_m: f64) -> ViewRay {
    ViewRay {
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

fn profiles() -> [DensityProfile; 4] {
    [
        DensityProfile::Uniform,
        DensityProfile::Exponential {
            reference_height_m: 0.0,
            scale_height_m: 12.0,
        },
        DensityProfile::Clamped {
            base_height_m: 3.0,
            scale_height_m: 4.0,
        },
        DensityProfile::slab(4.5),
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
    let lights = street();
    for phase in phases() {
        let particles = particles(phase);
        for profile in profiles() {
            let medium = medium(&particles, &profile);
            for direction in DIRECTIONS {
                let whole = view_ray(direction, 70.0);
                let all = lights.path_radiance(&medium, &whole);
                for split in [0.5, 14.0, 15.3, 33.0, 60.0] {
                    let near = lights.path_radiance(&medium, &view_ray(direction, split));
                    let far = lights.path_radiance(
                        &medium,
                        &ViewRay {
                            eye: whole.eye + split * whole.direction,
                            length_m: 70.0 - split,
                            ..whole
                        },
                    );
                    let line = RaySegment::flat(1.7, whole.direction.y, split);
                    let depth = particles.extinction_per_m * profile.column_along_m(&line) as f32;
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
    let particles = particles(PhaseFunction::Isotropic);
    let medium = medium(&particles, &DensityProfile::Uniform);
    let lights = street();
    let haze = Haze::new(&medium).unwrap();
    for direction in DIRECTIONS {
        for length in [1.0, 20.0, f64::INFINITY] {
            let view_ray = view_ray(direction, length);
            let light = &lights.lights()[0];
            let short = lights.of_one(light, &haze, &view_ray);
            let long = Ray::new(light, &haze, &view_ray).path_radiance(&Nodes::new(24));
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
    let lights = LightSet::new(
        vec![
            Light::Point(PointLight::new(at, light, 0.1).unwrap()),
            Light::Spot(SpotLight::new(at, DVec3::NEG_Y, light, 0.1, 0.4, 0.1).unwrap()),
        ],
        LightSettings::default(),
    )
    .unwrap();
    for phase in phases() {
        let particles = particles(phase);
        for profile in profiles() {
            for ground_radius_m in [f64::INFINITY, 6.371e6] {
                let medium = ParticipatingMedium {
                    ground_radius_m,
                    ..medium(&particles, &profile)
                };
                for eye in [at, DVec3::new(0.0, 1e5, 0.0), DVec3::new(30.0, 0.0, 4.0)] {
                    for direction in [DVec3::X, DVec3::Y, DVec3::NEG_Y, DVec3::new(0.8, -0.6, 0.0)]
                    {
                        for length_m in [0.0, 1e-6, 10.0, 1e7, f64::INFINITY] {
                            let view_ray = ViewRay {
                                eye,
                                direction,
                                length_m,
                            };
                            let got = lights.path_radiance(&medium, &view_ray);
                            assert!(
                                got.is_finite() && got.min_element() >= 0.0,
                                "{medium:?} {view_ray:?}: {got:?}"
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
    let thin = Medium {
        extinction_per_m: Spectrum([1e-9f32; 3]),
        single_scattering_albedo: Spectrum::ONE,
        phase: PhaseFunction::Isotropic,
    };
    let medium = medium(&thin, &DensityProfile::Uniform);
    let at = DVec3::new(0.0, 3.0, 0.0);
    let light = PointLight::new(at, Spectrum::ONE, 0.1).unwrap();
    let lights = LightSet::new(vec![Light::Point(light)], LightSettings::default()).unwrap();
    let got = lights.path_radiance(
        &medium,
        &ViewRay {
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
    let lights = street();
    let particles = particles(PhaseFunction::Isotropic);
    let medium = medium(&particles, &DensityProfile::Uniform);
    let bulb = DVec3::new(0.0, 4.0, -40.0);
    let eye = DVec3::new(0.0, 1.7, 0.0);
    let (distance, radiance) = lights.hit(eye, (bulb - eye).normalize()).expect("a bulb");
    assert!((distance - ((bulb - eye).length() - 0.4)).abs() < 1e-9);
    assert_eq!(radiance, Spectrum([120.0, 100.0, 60.0]));
    let ended = lights.path_radiance(&medium, &view_ray(bulb - eye, distance));
    let endless = lights.path_radiance(&medium, &view_ray(bulb - eye, f64::INFINITY));
    assert_eq!(ended, endless);
    assert!(lights.hit(eye, DVec3::Y).is_none());
}

#[test]
fn the_bound_is_one_and_leaves_out_only_what_is_below_it() {
    for phase in phases() {
        let particles = particles(phase);
        for profile in profiles() {
            let medium = medium(&particles, &profile);
            let haze = Haze::new(&medium).unwrap();
            let lights = street();
            for direction in DIRECTIONS {
                let view_ray = view_ray(direction, 55.0);
                for light in lights.lights() {
                    let got = lights.of_one(light, &haze, &view_ray).max_element();
                    let most = bound(&Ray::new(light, &haze, &view_ray), &haze);
                    assert!(got <= most, "{light:?} {view_ray:?}: {got} above {most}");
                }
                let all = lights.path_radiance(&medium, &view_ray);
                let settings = LightSettings {
                    threshold: 1e-3,
                    ..Default::default()
                };
                let fewer = LightSet::new(lights.lights().to_vec(), settings).unwrap();
                let some = fewer.path_radiance(&medium, &view_ray);
                assert!((all - some).max_element() <= 3e-3);
            }
        }
    }
}

#[test]
fn light_from_all_sides_adds_up() {
    let sigma = 1e-6f32;
    let thin = Medium {
        extinction_per_m: Spectrum([sigma; 3]),
        single_scattering_albedo: Spectrum::ONE,
        phase: PhaseFunction::Isotropic,
    };
    let medium = medium(&thin, &DensityProfile::Uniform);
    let light = PointLight::new(DVec3::ZERO, Spectrum::ONE, 1e-9).unwrap();
    let lights = LightSet::new(vec![Light::Point(light)], LightSettings::default()).unwrap();
    // Scalar irradiance, at distance D, of all light scattered once: sigma I int dV / (4 pi r^2 s^2), r from the light,
    // s from the eye: pi^3 / D times sigma I / (4 pi).
    let eye = DVec3::new(0.0, 0.0, 7.0);
    let rule = crate::math::quadrature::GaussRule::new(64);
    let sum = rule.integrate_between(0.0, PI, &[0.01, 0.1], |angle| {
        let direction = DVec3::new(angle.sin(), 0.0, -angle.cos());
        let line = ViewRay {
            eye,
            direction,
            length_m: f64::INFINITY,
        };
        2.0 * PI * angle.sin() * f64::from(lights.path_radiance(&medium, &line)[0])
    });
    let want = PI.powi(3) / 7.0 * f64::from(sigma) / (4.0 * PI);
    assert!((sum / want - 1.0).abs() < 3e-4, "{sum} against {want}");
}

#[test]
fn surfaces_are_lit_through_the_fog() {
    let particles = particles(PhaseFunction::Isotropic);
    let lights = street();
    let point = DVec3::new(2.0, 0.0, -15.0);
    let lit = lights.lights()[0].illumination(&medium(&particles, &DensityProfile::Uniform), point);
    let want = 120.0 / 25.0 * (-0.02f64 * 5.0).exp();
    assert!((f64::from(lit[0]) / want - 1.0).abs() < 1e-6);
    // Only the metre and a half between 3 and 4.5 m of the slab is crossed from above; all else is clear.
    let slab = DensityProfile::slab(4.5);
    let lit =
        lights.lights()[0].illumination(&medium(&particles, &slab), DVec3::new(2.0, 3.0, -15.0));
    let want = 120.0 / 4.0 * (-0.02f64 * 1.5).exp();
    assert!((f64::from(lit[0]) / want - 1.0).abs() < 1e-6);
    // Beside the cone it is dark; at a ball's surface the irradiance is pi times the radiance.
    let medium = medium(&particles, &DensityProfile::Uniform);
    let beside = lights.lights()[1].illumination(&medium, DVec3::new(-3.0, 6.5, -30.0));
    assert_eq!(beside, Spectrum::ZERO);
    let close = lights.lights()[2].illumination(&medium, DVec3::new(0.0, 3.6, -40.0));
    assert!((f64::from(close[0]) / (120.0 * PI) - 1.0).abs() < 1e-6);
}

#[test]
fn settings_are_checked() {
    let make = |nodes, threshold| LightSet::<3>::new(vec![], LightSettings { nodes, threshold });
    assert!(make(12, 0.0).is_ok());
    assert!(make(3, 0.0).is_err());
    assert!(make(1000, 0.0).is_err());
    assert!(make(12, -1.0).is_err());
    assert!(make(12, f32::NAN).is_err());
}
