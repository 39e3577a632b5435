use super::super::{PointLight, SphereLight, SpotLight};
use super::*;
use crate::atmosphere::{ConstituentKind, DensityProfile};
use crate::optics::PhaseFunction;
use crate::spectrum::SpectralCurve;
use std::f64::consts::PI;

const RGB: [f32; 3] = [120.0, 100.0, 60.0];

fn layer(phase: PhaseFunction, density: DensityProfile) -> RgbLayer {
    RgbLayer {
        density,
        extinction_per_m: [0.02, 0.021, 0.024],
        single_scattering_albedo: [0.99, 0.98, 0.97],
        phase,
    }
}

fn street_lights() -> Vec<Light<[f32; 3]>> {
    let spot = DVec3::new(-3.0, 6.0, -30.0);
    vec![
        Light::Point(PointLight::new(DVec3::new(2.0, 5.0, -15.0), RGB, 0.05).unwrap()),
        Light::Spot(SpotLight::new(spot, DVec3::NEG_Y, RGB, 0.3, 0.9, 0.05).unwrap()),
        Light::Sphere(SphereLight::new(DVec3::new(0.0, 4.0, -40.0), 0.4, RGB).unwrap()),
    ]
}

fn set(lights: Vec<Light<[f32; 3]>>, layer: RgbLayer, ground: Ground) -> RgbLightSet {
    RgbLightSet::new(lights, &[layer], ground, LightSettings::default()).expect("lights")
}

fn street(layer: RgbLayer) -> RgbLightSet {
    set(street_lights(), layer, Ground::FLAT)
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
        DensityProfile::exponential(12.0),
        DensityProfile::Clamped {
            base_height_m: 3.0,
            scale_height_m: 4.0,
        },
        DensityProfile::slab(4.5),
    ]
}

/// All layers of these phase functions and profiles.
fn layers() -> impl Iterator<Item = RgbLayer> {
    phases()
        .into_iter()
        .flat_map(|phase| profiles().map(|density| layer(phase.clone(), density)))
}

const DIRECTIONS: [DVec3; 5] = [
    DVec3::new(0.0, 0.0, -1.0),
    DVec3::new(0.13, 0.2, -1.0),
    DVec3::new(-0.1, 0.1, -1.0),
    DVec3::new(0.0, 1.0, -0.1),
    DVec3::new(0.3, -0.02, 1.0),
];

#[test]
fn near_and_far_parts_compose() {
    for layer in layers() {
        let lights = street(layer.clone());
        for direction in DIRECTIONS {
            let whole = view_ray(direction, 70.0);
            let all = lights.path_radiance(&whole);
            for split in [0.5, 14.0, 15.3, 33.0, 60.0] {
                let near = lights.path_radiance(&view_ray(direction, split));
                let far = lights.path_radiance(&ViewRay {
                    eye: whole.eye + split * whole.direction,
                    length_m: 70.0 - split,
                    ..whole
                });
                let ray = RaySegment::flat(1.7, whole.direction.y, split);
                let column = layer.density.column_along_m(&ray) as f32;
                for lane in 0..3 {
                    let transmittance = (-layer.extinction_per_m[lane] * column).exp();
                    let both = near[lane] + transmittance * far[lane];
                    assert!(
                        (both / all[lane] - 1.0).abs() < 5e-5,
                        "{layer:?} {direction} {split}: {both} {all:?}"
                    );
                }
            }
        }
    }
}

#[test]
fn the_closed_form_matches_quadrature() {
    let lights = street(layer(PhaseFunction::Isotropic, DensityProfile::Uniform));
    let set = &*lights.lanes;
    let fog = &set.scattering_layers[0];
    for direction in DIRECTIONS {
        for length in [1.0, 20.0, f64::INFINITY] {
            let view_ray = view_ray(direction, length);
            let light = &set.lights[0];
            let short = set.path_radiance_of(light, fog, &view_ray);
            let long = LitRay::new(light, fog, &view_ray).path_radiance(&Nodes::new(24));
            for lane in 0..3 {
                assert!((short[lane] / long[lane] - 1.0).abs() < 1e-5);
            }
        }
    }
}

#[test]
fn spectral_values_equal_rgb_values() {
    // 21 wavelengths: a block of 16 and one of 8. The layers and lights have the RGB values at three of them.
    let nm: Vec<f64> = (0..21).map(|i| 400.0 + 15.0 * f64::from(i)).collect();
    let picked = [20, 10, 2];
    let curve = |rgb: [f32; 3]| {
        let knots = vec![nm[picked[2]], nm[picked[1]], nm[picked[0]]];
        let values = vec![rgb[2], rgb[1], rgb[0]];
        SpectralCurve::table(knots, values.into_iter().map(f64::from).collect()).unwrap()
    };
    let grid = WavelengthGrid::from_wavelengths_nm(nm.clone()).unwrap();
    for layer in layers() {
        let extinction = layer.extinction_per_m;
        let scattering: [f32; 3] =
            std::array::from_fn(|i| extinction[i] * layer.single_scattering_albedo[i]);
        let constituent = Constituent {
            kind: ConstituentKind::Fog,
            density: layer.density.clone(),
            scattering_per_m: curve(scattering),
            absorption_per_m: curve(std::array::from_fn(|i| extinction[i] - scattering[i])),
            phase: layer.phase.clone(),
        };
        let spectral = street_lights()
            .iter()
            .map(|light| light.map(|&rgb| curve(rgb)))
            .collect();
        let settings = LightSettings::default();
        let set = LightSet::new(spectral, &[constituent], Ground::FLAT, settings, &grid).unwrap();
        let rgb = street(layer);
        let rays = DIRECTIONS.map(|direction| view_ray(direction, 60.0));
        let mut all = vec![0.0; grid.len() * rays.len()];
        set.path_radiances(&rays, &mut all);
        let mut lit = vec![0.0; grid.len()];
        for (ray, values) in rays.iter().zip(all.chunks(grid.len())) {
            let want = rgb.path_radiance(ray);
            for (lane, place) in picked.into_iter().enumerate() {
                assert!(
                    (values[place] / want[lane] - 1.0).abs() < 1e-4,
                    "{ray:?}: {} {}",
                    values[place],
                    want[lane]
                );
            }
        }
        for light in 0..3 {
            let point = DVec3::new(-2.8, 1.0, -29.0);
            set.irradiance(light, point, &mut lit);
            let want = rgb.irradiance(light, point);
            for (lane, place) in picked.into_iter().enumerate() {
                assert!((lit[place] - want[lane]).abs() <= 1e-5 * want[lane]);
            }
        }
    }
}

#[test]
fn values_are_always_finite() {
    let at = DVec3::new(0.0, 3.0, 0.0);
    let lights = vec![
        Light::Point(PointLight::new(at, [1.0; 3], 0.1).unwrap()),
        Light::Spot(SpotLight::new(at, DVec3::NEG_Y, [1.0; 3], 0.1, 0.4, 0.1).unwrap()),
    ];
    for layer in layers() {
        for ground in [Ground::FLAT, Ground::EARTH] {
            let lights = set(lights.clone(), layer.clone(), ground);
            for eye in [at, DVec3::new(0.0, 1e5, 0.0), DVec3::new(30.0, 0.0, 4.0)] {
                for direction in [DVec3::X, DVec3::Y, DVec3::NEG_Y, DVec3::new(0.8, -0.6, 0.0)] {
                    for length_m in [0.0, 1e-6, 10.0, 1e7, f64::INFINITY] {
                        let view_ray = ViewRay {
                            eye,
                            direction,
                            length_m,
                        };
                        let got = lights.path_radiance(&view_ray);
                        assert!(
                            got.iter().all(|v| v.is_finite() && *v >= 0.0),
                            "{layer:?} {view_ray:?}: {got:?}"
                        );
                    }
                }
            }
        }
    }
}

/// Fog with negligible extinction.
fn thin(extinction_per_m: f32) -> RgbLayer {
    RgbLayer {
        extinction_per_m: [extinction_per_m; 3],
        single_scattering_albedo: [1.0; 3],
        ..layer(PhaseFunction::Isotropic, DensityProfile::Uniform)
    }
}

#[test]
fn the_distance_of_an_eye_at_the_light_is_its_radius() {
    let at = DVec3::new(0.0, 3.0, 0.0);
    let light = PointLight::new(at, [1.0; 3], 0.1).unwrap();
    let lights = set(vec![Light::Point(light)], thin(1e-9), Ground::FLAT);
    let got = lights.path_radiance(&ViewRay {
        eye: at,
        direction: DVec3::Y,
        length_m: f64::INFINITY,
    });
    // theta / (4 pi h) with theta = pi / 2.
    assert!(
        (f64::from(got[0]) / (1e-9 / 0.8) - 1.0).abs() < 1e-5,
        "{got:?}"
    );
}

#[test]
fn rays_end_at_spheres() {
    let lights = street(layer(PhaseFunction::Isotropic, DensityProfile::Uniform));
    let sphere = DVec3::new(0.0, 4.0, -40.0);
    let eye = DVec3::new(0.0, 1.7, 0.0);
    let (distance, radiance) = lights
        .hit(eye, (sphere - eye).normalize())
        .expect("a sphere");
    assert!((distance - ((sphere - eye).length() - 0.4)).abs() < 1e-9);
    assert_eq!(radiance, RGB);
    let ended = lights.path_radiance(&view_ray(sphere - eye, distance));
    let endless = lights.path_radiance(&view_ray(sphere - eye, f64::INFINITY));
    assert_eq!(ended, endless);
    assert!(lights.hit(eye, DVec3::Y).is_none());
}

#[test]
fn lights_below_the_threshold_are_skipped() {
    for layer in layers() {
        let lights = street(layer.clone());
        let settings = LightSettings {
            threshold: 1e-3,
            ..Default::default()
        };
        let fewer = RgbLightSet::new(street_lights(), &[layer], Ground::FLAT, settings).unwrap();
        for direction in DIRECTIONS {
            let view_ray = view_ray(direction, 55.0);
            let set = &*lights.lanes;
            let fog = &set.scattering_layers[0];
            for light in &set.lights {
                let got = set.path_radiance_of(light, fog, &view_ray).max_element();
                let most = LitRay::new(light, fog, &view_ray).bound();
                assert!(got <= most, "{light:?} {view_ray:?}: {got} above {most}");
            }
            let (all, some) = (
                lights.path_radiance(&view_ray),
                fewer.path_radiance(&view_ray),
            );
            assert!((0..3).all(|lane| all[lane] - some[lane] <= 3e-3));
        }
    }
}

#[test]
fn the_scalar_irradiance_of_scattered_light_is_exact() {
    let sigma = 1e-6f32;
    let light = PointLight::new(DVec3::ZERO, [1.0; 3], 1e-9).unwrap();
    let lights = set(vec![Light::Point(light)], thin(sigma), Ground::FLAT);
    // Scalar irradiance, at distance D, of all light scattered once: sigma I int dV / (4 pi r^2 s^2), r from the light,
    // s from the eye: pi^3 / D times sigma I / (4 pi).
    let eye = DVec3::new(0.0, 0.0, 7.0);
    let rule = crate::math::quadrature::GaussRule::new(64);
    let sum = rule.integrate_between(0.0, PI, &[0.01, 0.1], |angle| {
        let ray = ViewRay {
            eye,
            direction: DVec3::new(angle.sin(), 0.0, -angle.cos()),
            length_m: f64::INFINITY,
        };
        2.0 * PI * angle.sin() * f64::from(lights.path_radiance(&ray)[0])
    });
    let want = PI.powi(3) / 7.0 * f64::from(sigma) / (4.0 * PI);
    assert!((sum / want - 1.0).abs() < 3e-4, "{sum} against {want}");
}

#[test]
fn irradiance_on_surfaces_is_exact() {
    let uniform = street(layer(PhaseFunction::Isotropic, DensityProfile::Uniform));
    let lit = uniform.irradiance(0, DVec3::new(2.0, 0.0, -15.0));
    let want = 120.0 / 25.0 * (-0.02f64 * 5.0).exp();
    assert!((f64::from(lit[0]) / want - 1.0).abs() < 1e-6);
    // Only 1.5 m of the path, from 3 to 4.5 m, lies in the slab.
    let slab = street(layer(PhaseFunction::Isotropic, DensityProfile::slab(4.5)));
    let lit = slab.irradiance(0, DVec3::new(2.0, 3.0, -15.0));
    let want = 120.0 / 4.0 * (-0.02f64 * 1.5).exp();
    assert!((f64::from(lit[0]) / want - 1.0).abs() < 1e-6);
    // 0 outside the cone; pi times the radiance at the surface of a sphere.
    assert_eq!(
        uniform.irradiance(1, DVec3::new(-3.0, 6.5, -30.0)),
        [0.0; 3]
    );
    let close = uniform.irradiance(2, DVec3::new(0.0, 3.6, -40.0));
    assert!((f64::from(close[0]) / (120.0 * PI) - 1.0).abs() < 1e-6);
}

#[test]
fn invalid_settings_are_rejected() {
    let make = |nodes, threshold| {
        let settings = LightSettings {
            nodes,
            threshold,
            form: LightForm::Exact,
        };
        RgbLightSet::new(vec![], &[], Ground::FLAT, settings)
    };
    assert!(make(12, 0.0).is_ok());
    assert!(make(3, 0.0).is_err());
    assert!(make(1000, 0.0).is_err());
    assert!(make(12, -1.0).is_err());
    assert!(make(12, f32::NAN).is_err());
}
