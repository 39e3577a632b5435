use super::*;
use crate::axes;
use crate::fog::{
    DensityProfile, DirectionalLight, FogLighting, FogScattering, Ground, Layer, Medium, droplets,
};
use crate::optics::PhaseFunction;

/// Fog of a height, or up to one, with an extinction at the ground (1/m).
fn layer(profile: DensityProfile, extinction_per_m: f32, phase: PhaseFunction) -> Layer<3> {
    Layer {
        profile,
        medium: Medium {
            extinction_per_m: Spectrum([1.0, 1.1, 1.3].map(|part| part * extinction_per_m)),
            single_scattering_albedo: Spectrum([1.0, 0.99, 0.95]),
            phase,
        },
    }
}

fn fog(layers: &[Layer<3>], sun_elevation_deg: Option<f64>) -> Fog<3> {
    let light = FogLighting {
        sun: sun_elevation_deg.map(|elevation| DirectionalLight {
            direction: axes::direction(150.0, elevation),
            irradiance: Spectrum([3.0, 2.5, 2.0]),
        }),
        ambient: Spectrum([0.2, 0.25, 0.4]),
        ground_albedo: Spectrum([0.1, 0.2, 0.3]),
    };
    Fog::new(layers, Ground::FLAT, light, FogScattering::Multiple).unwrap()
}

/// Relative errors of the path radiance along lines from a height in all directions and to all distances.
fn errors(fog: &Fog<3>, eye_height_m: f64) -> Vec<(f32, String)> {
    let table = FogTable::new(fog, eye_height_m);
    assert!(table.table.is_some());
    let mut errors = Vec::new();
    let mut elevations = vec![0.0, 1e-4, -1e-4];
    for k in 0..26 {
        let up = (0.03 * 1.37f64.powi(k)).min(90.0);
        elevations.extend([up, -up]);
    }
    for elevation in elevations {
        for azimuth in [150.0, 151.0, 155.0, 170.0, 205.0, 260.0, 330.0] {
            let view = axes::direction(azimuth, elevation);
            let ground_m = eye_height_m / (-view.y).max(1e-9);
            let lengths = (-9..30).map(|k| 0.01 * 1.9f64.powi(k));
            for length_m in lengths.chain([ground_m, f64::INFINITY]) {
                // Farther down than 2 m under the ground nothing is looked at.
                if -view.y * length_m > eye_height_m + 2.0 {
                    continue;
                }
                let exact = fog.along(eye_height_m, view, length_m);
                let got = table.along(view, length_m);
                assert_eq!(got.transmittance, exact.transmittance);
                let worst = (0..3)
                    .map(|lane| (got.path_radiance[lane], exact.path_radiance[lane]))
                    .map(|(a, b)| match b > 1e-20 {
                        true => (a / b - 1.0).abs(),
                        false => a.abs(),
                    })
                    .fold(0.0, |a: f32, b| if b > a || b.is_nan() { b } else { a });
                errors.push((worst, format!("{azimuth} {elevation} {length_m} m")));
            }
        }
    }
    errors.sort_by(|a, b| a.0.total_cmp(&b.0));
    errors
}

const EXPONENTIAL: fn(f64) -> DensityProfile = |scale_height_m| DensityProfile::Exponential {
    reference_height_m: 0.0,
    scale_height_m,
};
const CLAMPED: DensityProfile = DensityProfile::Clamped {
    base_height_m: 12.0,
    scale_height_m: 8.0,
};
const SLAB: DensityProfile = DensityProfile::slab(20.0);

#[test]
fn a_table_is_the_fog_itself() {
    let drops = droplets::phase(10.0);
    let large = droplets::phase(50.0);
    let peaked = PhaseFunction::HenyeyGreenstein { g: 0.8 };
    for (profile, phase) in [
        (EXPONENTIAL(30.0), &drops),
        (EXPONENTIAL(400.0), &peaked),
        (CLAMPED, &large),
        (SLAB, &drops),
    ] {
        for extinction in [1e-4, 0.004, 0.04, 0.3] {
            let mut layers = [layer(profile.clone(), extinction, phase.clone())];
            if extinction == 0.04 {
                layers[0].medium.extinction_per_m = Spectrum::splat(extinction);
            }
            for sun in [None, Some(30.0), Some(4.0)] {
                for eye in [1.6, 15.0, 60.0] {
                    let errors = errors(&fog(&layers, sun), eye);
                    let (worst, place) = &errors[errors.len() - 1];
                    let usual = errors[errors.len() * 9 / 10].0;
                    let what = format!("{profile:?} {extinction} sun {sun:?} eye {eye}");
                    if std::env::var("FOG_ERRORS").is_ok() {
                        println!("{worst:.5} {usual:.5} {what}: {place}");
                    }
                    assert!(*worst < 3e-3, "{what}, {place}: {worst}");
                    assert!(usual < 1e-3, "{what}: {usual}");
                }
            }
        }
    }
}

#[test]
fn what_is_not_tabulated_is_the_fog_itself() {
    let drops = droplets::phase(10.0);
    let (slab, haze) = (
        layer(SLAB, 0.03, drops.clone()),
        layer(EXPONENTIAL(300.0), 0.001, drops),
    );
    let several = fog(&[slab.clone(), haze], Some(20.0));
    let mut round = fog(&[slab], Some(20.0));
    round.ground = Ground::EARTH;
    for fog in [several, round] {
        let table = FogTable::new(&fog, 3.0);
        let view = axes::direction(150.0, 10.0);
        assert_eq!(table.along(view, 80.0), fog.along(3.0, view, 80.0));
    }
}

#[test]
fn white_light_stays_white_in_a_table() {
    let mut clear = layer(EXPONENTIAL(60.0), 0.01, droplets::phase(10.0));
    clear.medium.single_scattering_albedo = Spectrum::ONE;
    let everywhere = FogLighting {
        sun: None,
        ambient: Spectrum([0.3, 0.4, 0.5]),
        ground_albedo: Spectrum::ONE,
    };
    let fog = Fog::new(&[clear], Ground::FLAT, everywhere, FogScattering::Multiple).unwrap();
    let table = FogTable::new(&fog, 5.0);
    for k in 0..400 {
        let k = f64::from(k);
        let view = axes::direction(31.0 * k, 90.0 * (0.77 * k).sin());
        let length_m = (5.0 / (-view.y).max(0.0)).min(1e-3 * 1.1f64.powf(k));
        let seen = table.along(view, length_m).apply(everywhere.ambient);
        for lane in 0..3 {
            let ratio = seen[lane] / everywhere.ambient[lane];
            assert!((ratio - 1.0).abs() < 2e-5, "{view} {length_m}: {ratio}");
        }
    }
}
