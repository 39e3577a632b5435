use super::*;
use crate::atmosphere::{DensityProfile, droplets};
use crate::axes;
use crate::control::Control;
use crate::fog::layer::LayerLanes;
use crate::fog::{DirectionalLight, FogLighting, FogScattering, Ground, RgbLayer};
use crate::optics::PhaseFunction;

/// A layer with an extinction coefficient at density 1, 1/m.
fn layer(profile: DensityProfile, extinction_per_m: f32, phase: PhaseFunction) -> RgbLayer {
    RgbLayer {
        density: profile,
        extinction_per_m: [1.0, 1.1, 1.3].map(|part| part * extinction_per_m),
        single_scattering_albedo: [1.0, 0.99, 0.95],
        phase,
    }
}

fn solved(
    layers: &[RgbLayer],
    ground: Ground,
    lighting: FogLighting<Spectrum<3>>,
) -> Arc<FogLanes<3>> {
    let layers: Vec<LayerLanes<3>> = layers.iter().map(LayerLanes::rgb).collect();
    let (scattering, control) = (FogScattering::Multiple, Control::default());
    let fog = FogLanes::new(&layers, ground, lighting, scattering, 3, control);
    Arc::new(fog.unwrap())
}

fn lighting(sun_elevation_deg: Option<f64>) -> FogLighting<Spectrum<3>> {
    FogLighting {
        sun: sun_elevation_deg.map(|elevation| DirectionalLight {
            direction: axes::direction(150.0, elevation),
            irradiance: Spectrum([3.0, 2.5, 2.0]),
        }),
        ambient: Spectrum([0.2, 0.25, 0.4]),
        ground_albedo: Spectrum([0.1, 0.2, 0.3]),
    }
}

fn fog(layers: &[RgbLayer], sun_elevation_deg: Option<f64>) -> Arc<FogLanes<3>> {
    solved(layers, Ground::FLAT, lighting(sun_elevation_deg))
}

/// Relative errors of the path radiance along rays from a height in all directions and to all distances.
fn errors(fog: &Arc<FogLanes<3>>, eye_height_m: f64) -> Vec<(f32, String)> {
    let table = TableLanes::new(fog.clone(), eye_height_m);
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
                // At most 2 m below the ground.
                if -view.y * length_m > eye_height_m + 2.0 {
                    continue;
                }
                let exact = fog.path(eye_height_m, view, length_m);
                let got = table.path(view, length_m);
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

const CLAMPED: DensityProfile = DensityProfile::Clamped {
    base_height_m: 12.0,
    scale_height_m: 8.0,
};
const SLAB: DensityProfile = DensityProfile::slab(20.0);

/// Rays in all directions and to all distances; more of them and fewer than a block.
fn many_rays() -> (Vec<DVec3>, Vec<f64>) {
    let mut elevations = vec![0.0, -0.0];
    for k in 0..14 {
        let up = (0.03 * 1.9f64.powi(k)).min(90.0);
        elevations.extend([up, -up]);
    }
    let lengths_m = (-9..30).map(|k| 0.01 * 1.9f64.powi(k));
    let lengths_m: Vec<f64> = lengths_m.chain([0.0, f64::INFINITY]).collect();
    let rays = elevations.into_iter().flat_map(|elevation| {
        let azimuths = [150.0, 151.0, 170.0, 260.0].into_iter();
        azimuths.flat_map({
            let lengths_m = &lengths_m;
            move |azimuth| {
                let direction = axes::direction(azimuth, elevation);
                lengths_m.iter().map(move |&length_m| (direction, length_m))
            }
        })
    });
    rays.unzip()
}

/// Rays of blocks are single rays to rounding: of fog with closed forms, and of tables.
#[test]
fn many_rays_are_the_same_as_single_ones() {
    let (directions, lengths_m) = many_rays();
    assert!(directions.len() % RAYS != 0);
    let peaked = droplets::phase(10.0);
    let measured = PhaseFunction::Rayleigh(crate::optics::Depolarization::Air);
    for profile in [
        DensityProfile::Uniform,
        DensityProfile::exponential(30.0),
        CLAMPED,
        SLAB,
    ] {
        for (extinction, sun, phase) in [
            (0.004, None, &peaked),
            (0.004, Some(30.0), &peaked),
            (0.3, Some(-2.0), &peaked),
            (0.04, Some(4.0), &measured),
        ] {
            for scattering in [
                FogScattering::Undimmed,
                FogScattering::Single,
                FogScattering::Multiple,
            ] {
                let mut layers = [layer(profile.clone(), extinction, phase.clone())];
                if extinction == 0.3 {
                    layers[0].extinction_per_m = [extinction; 3];
                }
                let layers = layers.each_ref().map(LayerLanes::rgb);
                let fog = FogLanes::new(
                    &layers,
                    Ground::FLAT,
                    lighting(sun),
                    scattering,
                    3,
                    Control::default(),
                );
                let table = TableLanes::new(Arc::new(fog.unwrap()), 15.0);
                let mut many = vec![PathOptics::<3>::CLEAR; directions.len()];
                table.paths(&directions, &lengths_m, &mut many);
                for ((many, &direction), &length_m) in many.iter().zip(&directions).zip(&lengths_m)
                {
                    let one = table.path(direction, length_m);
                    let what = format!("{profile:?} {extinction} {sun:?} {scattering:?}");
                    for lane in 0..3 {
                        let (got, exact) = (many.transmittance[lane], one.transmittance[lane]);
                        assert!((got - exact).abs() < 1e-6, "{what}: {got} {exact}");
                        let (got, exact) = (many.path_radiance[lane], one.path_radiance[lane]);
                        assert!(
                            (got - exact).abs() < 1e-7 + 3e-5 * exact.abs(),
                            "{what} {direction} {length_m} m: {got} {exact}"
                        );
                    }
                }
            }
        }
    }
}

mod guards {
    use super::*;

    #[test]
    fn tables_match_direct_evaluation() {
        let small = droplets::phase(10.0);
        let large = droplets::phase(50.0);
        let peaked = PhaseFunction::HenyeyGreenstein { g: 0.8 };
        for (row, (profile, phase)) in [
            (DensityProfile::exponential(30.0), &small),
            (DensityProfile::exponential(400.0), &peaked),
            (CLAMPED, &large),
            (SLAB, &small),
        ]
        .into_iter()
        .enumerate()
        {
            for (column, extinction) in [1e-4, 0.004, 0.04, 0.3].into_iter().enumerate() {
                let mut layers = [layer(profile.clone(), extinction, phase.clone())];
                if extinction == 0.04 {
                    layers[0].extinction_per_m = [extinction; 3];
                }
                // A Latin square: each sun and each eye with every profile and every extinction.
                for (k, sun) in [None, Some(30.0), Some(4.0)].into_iter().enumerate() {
                    let eye = [1.6, 15.0, 60.0][(row + column + k) % 3];
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
fn other_fog_is_evaluated_directly() {
    let drops = droplets::phase(10.0);
    let (slab, haze) = (
        layer(SLAB, 0.03, drops.clone()),
        layer(DensityProfile::exponential(300.0), 0.001, drops),
    );
    let several = fog(&[slab.clone(), haze], Some(20.0));
    let round = solved(&[slab], Ground::EARTH, lighting(Some(20.0)));
    for fog in [several, round] {
        let table = TableLanes::new(fog.clone(), 3.0);
        let view = axes::direction(150.0, 10.0);
        assert_eq!(table.path(view, 80.0), fog.path(3.0, view, 80.0));
    }
}

#[test]
fn tabulated_fog_without_absorption_is_invisible_in_uniform_light() {
    let mut clear = layer(
        DensityProfile::exponential(60.0),
        0.01,
        droplets::phase(10.0),
    );
    clear.single_scattering_albedo = [1.0; 3];
    let uniform = FogLighting {
        sun: None,
        ambient: Spectrum([0.3, 0.4, 0.5]),
        ground_albedo: Spectrum::ONE,
    };
    let fog = solved(&[clear], Ground::FLAT, uniform);
    let table = TableLanes::new(fog, 5.0);
    for k in 0..400 {
        let k = f64::from(k);
        let view = axes::direction(31.0 * k, 90.0 * (0.77 * k).sin());
        let length_m = (5.0 / (-view.y).max(0.0)).min(1e-3 * 1.1f64.powf(k));
        let seen = table.path(view, length_m).apply(uniform.ambient);
        for lane in 0..3 {
            let ratio = seen[lane] / uniform.ambient[lane];
            assert!((ratio - 1.0).abs() < 2e-5, "{view} {length_m}: {ratio}");
        }
    }
}

/// Fogs of one, two and three profiles, of which the eye is in some, between or above them.
fn fogs_and_eyes() -> Vec<(Vec<RgbLayer>, f64)> {
    let exponential = |scale_height_m: f64, extinction: f32, radius_um: f64| {
        let profile = DensityProfile::exponential(scale_height_m);
        layer(profile, extinction, droplets::phase(radius_um))
    };
    let slab = |bottom_m: f64, top_m: f64, extinction: f32, phase: PhaseFunction| {
        layer(DensityProfile::Layer { bottom_m, top_m }, extinction, phase)
    };
    let wide = PhaseFunction::henyey_greenstein(0.7).unwrap();
    let mist = exponential(3.0, 0.03, 20.0);
    let above = slab(30.0, 60.0, 0.02, droplets::phase(10.0));
    let haze = slab(0.0, 400.0, 0.001, wide);
    let clamped = layer(CLAMPED, 0.05, droplets::phase(20.0));
    vec![
        (vec![exponential(40.0, 0.02, 20.0)], 12.0),
        (vec![mist.clone(), above.clone()], 2.0),
        (vec![mist.clone(), above.clone()], 22.0),
        (vec![mist.clone(), above], 80.0),
        (vec![mist, clamped, haze], 12.0),
    ]
}

#[test]
fn parts_sum_to_the_path_radiance() {
    for ((layers, eye_m), sun) in fogs_and_eyes()
        .into_iter()
        .flat_map(|case| [Some(25.0), None].map(|sun| (case.clone(), sun)))
    {
        let fog = fog(&layers, sun);
        let table = TableLanes::new(fog.clone(), eye_m);
        let mut worst = 0.0f32;
        for elevation in [-30.0, -2.0, 0.01, 3.0, 80.0] {
            let sine = f64::to_radians(elevation).sin();
            let far_m = if sine < 0.0 { eye_m / -sine } else { 5000.0 };
            let distances_m = [0.001, 0.2, 1.0].map(|part| part * far_m);
            let parts: Vec<Vec<_>> = (0..layers.len())
                .map(|layer| table.parts(layer, sine, &distances_m).unwrap())
                .collect();
            for azimuth in [150.0, 152.0, 220.0, 330.0] {
                let view = axes::direction(azimuth, elevation);
                let cos_sun = fog.cos_sun(view);
                let azimuth_rad = f64::to_radians(azimuth - 150.0);
                for (k, distance_m) in distances_m.into_iter().enumerate() {
                    let mut got = Spectrum::<3>::ZERO;
                    for (parts, layer) in parts.iter().zip(&fog.layers) {
                        let mut sum = Spectrum::ZERO;
                        for (m, mode) in parts[k].modes.iter().enumerate() {
                            let factor = (1.0 - sine * sine).sqrt().powi(m as i32)
                                * (m as f64 * azimuth_rad).cos();
                            sum = sum.scale_acc(*mode, factor as f32);
                        }
                        for (phase, once) in parts[k].streams.iter().enumerate() {
                            let streams = table.sun_streams(phase, cos_sun);
                            for (part, stream) in once.iter().zip(streams) {
                                sum = sum.mul_acc(*part, stream);
                            }
                        }
                        let ray = RaySegment::flat(eye_m, sine, distance_m);
                        let column_m = layer.density.column_along_m(&ray) as f32;
                        let depth = layer.extinction_per_m * column_m;
                        got += depth * depth.mean_transmittance() * sum;
                    }
                    let right = fog.path(eye_m, view, distance_m).path_radiance;
                    for lane in 0..3 {
                        let error = (got[lane] / right[lane] - 1.0).abs();
                        worst = worst.max(error);
                        assert!(
                            error < 1e-3,
                            "{layers:?} {sun:?} {elevation} {azimuth} {distance_m}: {got:?} {right:?}"
                        );
                    }
                }
            }
        }
        println!(
            "{} layers, eye {eye_m} m, sun {sun:?}: {worst}",
            layers.len()
        );
    }
}

#[test]
fn fog_without_an_upper_end_has_no_parts() {
    for uniform in [DensityProfile::Uniform, DensityProfile::slab(10.0)] {
        let layers = [uniform.clone(), DensityProfile::slab(30.0)];
        let layers = layers.map(|density| layer(density, 0.01, PhaseFunction::Isotropic));
        let table = TableLanes::new(solved(&layers, Ground::FLAT, lighting(Some(30.0))), 2.0);
        for (layer, is_none) in [
            (0, uniform.is_uniform()),
            (1, uniform.is_uniform()),
            (2, true),
        ] {
            assert_eq!(table.parts(layer, 0.1, &[1.0]).is_none(), is_none);
        }
    }
}
