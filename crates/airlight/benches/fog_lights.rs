//! How long a line of sight past a lamp in fog takes: `cargo bench -p airlight --bench fog_lamps`. Every bench visits 64 lines
//! and counts them as items: the time of one is the printed time over 64.

use airlight::atmosphere::DensityProfile;
use airlight::fog::layer::Medium;
use airlight::fog::lights::{
    Light, LightRayGeometry, LightSet, LightSettings, Nodes, ParticipatingMedium, PointLight,
    SphereLight, SpotLight, ViewRay, airlight_isotropic, airlight_isotropic_lanes,
    airlight_without_extinction,
};
use airlight::optics::PhaseFunction;
use airlight::spectrum::Spectrum;
use divan::counter::ItemsCount;
use divan::{Bencher, black_box};
use glam::DVec3;

const LINES: usize = 64;
const LAMP: DVec3 = DVec3::new(1.0, 5.0, -20.0);
const EYE: DVec3 = DVec3::new(0.0, 1.7, 0.0);

fn main() {
    divan::main();
}

/// Lines that pass the lamp on all sides.
fn sights() -> Vec<ViewRay> {
    (0..LINES)
        .map(|i| {
            let (x, y) = ((i % 8) as f64, (i / 8) as f64);
            ViewRay {
                eye: EYE,
                direction: DVec3::new(0.1 * x - 0.35, 0.06 * y - 0.1, -1.0).normalize(),
                length_m: 20.0 + 5.0 * x,
            }
        })
        .collect()
}

fn passages() -> Vec<LightRayGeometry> {
    sights()
        .iter()
        .map(|view_ray| {
            LightRayGeometry::new(
                view_ray.eye,
                view_ray.direction,
                view_ray.length_m,
                LAMP,
                0.05,
            )
        })
        .collect()
}

fn over_passages<T>(bencher: Bencher, f: impl Fn(&LightRayGeometry) -> T + Sync) {
    let passages = passages();
    bencher.counter(ItemsCount::new(LINES)).bench(|| {
        for passage in &passages {
            black_box(f(black_box(passage)));
        }
    });
}

#[divan::bench]
fn isotropic_without_extinction(bencher: Bencher) {
    over_passages(bencher, airlight_without_extinction);
}

#[divan::bench]
fn isotropic_exact_f64(bencher: Bencher) {
    over_passages(bencher, |passage| airlight_isotropic(passage, 0.03));
}

#[divan::bench(args = [8, 12, 20])]
fn isotropic_fast_f64(bencher: Bencher, nodes: usize) {
    let nodes = Nodes::new(nodes);
    over_passages(bencher, |passage| {
        airlight_isotropic_lanes(passage, 0.03, &nodes)
    });
}

#[divan::bench(args = [8, 12], consts = [3, 4, 16])]
fn isotropic_fast<const N: usize>(bencher: Bencher, nodes: usize) {
    let nodes = Nodes::new(nodes);
    let extinction = Spectrum::<N>::from_fn(|lane| 0.03 + 0.001 * lane as f32);
    over_passages(bencher, |passage| {
        airlight_isotropic_lanes(passage, extinction, &nodes)
    });
}

fn over_sights<const N: usize>(
    bencher: Bencher,
    light: Light<N>,
    g: f64,
    profile: DensityProfile,
    nodes: usize,
    ground_radius_m: f64,
) {
    let settings = LightSettings {
        nodes,
        ..Default::default()
    };
    let lights = LightSet::new(vec![light], settings).expect("lamps");
    let medium = Medium {
        extinction_per_m: Spectrum::from_fn(|lane| 0.03 + 0.001 * lane as f32),
        single_scattering_albedo: Spectrum::ONE,
        phase: match g {
            0.0 => PhaseFunction::Isotropic,
            _ => PhaseFunction::henyey_greenstein(g).expect("a phase function"),
        },
    };
    let medium = ParticipatingMedium {
        medium: &medium,
        profile: &profile,
        others: &[],
        wavelengths_nm: &[550.0; N],
        ground_radius_m,
    };
    let sights = sights();
    bencher.counter(ItemsCount::new(LINES)).bench_local(|| {
        for view_ray in &sights {
            black_box(lights.path_radiance(&medium, black_box(view_ray)));
        }
    });
}

fn point<const N: usize>() -> Light<N> {
    Light::Point(PointLight::new(LAMP, Spectrum::ONE, 0.05).expect("a lamp"))
}

fn spot<const N: usize>() -> Light<N> {
    let light = SpotLight::new(LAMP, DVec3::NEG_Y, Spectrum::ONE, 0.5, 1.2, 0.05);
    Light::Spot(light.expect("a lamp"))
}

fn bulb<const N: usize>() -> Light<N> {
    Light::Sphere(SphereLight::new(LAMP, 0.2, Spectrum::ONE).expect("a lamp"))
}

const HEIGHT_FOG: DensityProfile = DensityProfile::Exponential {
    reference_height_m: 0.0,
    scale_height_m: 10.0,
};

#[divan::bench(consts = [3, 16])]
fn isotropic_lamps<const N: usize>(bencher: Bencher) {
    over_sights::<N>(
        bencher,
        point(),
        0.0,
        DensityProfile::Uniform,
        12,
        f64::INFINITY,
    );
}

#[divan::bench(args = [8, 12], consts = [3, 16])]
fn forward_085_uniform<const N: usize>(bencher: Bencher, nodes: usize) {
    over_sights::<N>(
        bencher,
        point(),
        0.85,
        DensityProfile::Uniform,
        nodes,
        f64::INFINITY,
    );
}

#[divan::bench(args = [8, 12], consts = [3, 16])]
fn forward_085_height_fog<const N: usize>(bencher: Bencher, nodes: usize) {
    over_sights::<N>(bencher, point(), 0.85, HEIGHT_FOG, nodes, f64::INFINITY);
}

#[divan::bench(consts = [3])]
fn forward_085_height_fog_round_ground<const N: usize>(bencher: Bencher) {
    over_sights::<N>(bencher, point(), 0.85, HEIGHT_FOG, 12, 6.371e6);
}

#[divan::bench(consts = [3, 16])]
fn spot_uniform<const N: usize>(bencher: Bencher) {
    over_sights::<N>(
        bencher,
        spot(),
        0.85,
        DensityProfile::Uniform,
        12,
        f64::INFINITY,
    );
}

#[divan::bench(consts = [3])]
fn spot_height_fog<const N: usize>(bencher: Bencher) {
    over_sights::<N>(bencher, spot(), 0.85, HEIGHT_FOG, 12, f64::INFINITY);
}

#[divan::bench(consts = [3])]
fn bulb_uniform<const N: usize>(bencher: Bencher) {
    over_sights::<N>(
        bencher,
        bulb(),
        0.85,
        DensityProfile::Uniform,
        12,
        f64::INFINITY,
    );
}
