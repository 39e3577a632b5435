//! Speed of a view ray past a light in fog: `cargo bench -p airlight --bench fog_lights`. Each bench traces 64 rays and counts
//! them as items: the time of one ray is the printed time divided by 64.

use airlight::atmosphere::{Constituent, ConstituentKind, DensityProfile};
use airlight::fog::lights::{
    Light, LightRayGeometry, LightSet, LightSettings, Nodes, PointLight, RgbLightSet, SphereLight,
    SpotLight, ViewRay, airlight_isotropic, airlight_isotropic_fast, airlight_without_extinction,
};
use airlight::fog::{ChannelValues, Ground, RgbLayer};
use airlight::optics::PhaseFunction;
use airlight::spectrum::{SpectralCurve, WavelengthGrid};
use divan::counter::ItemsCount;
use divan::{Bencher, black_box};
use glam::DVec3;

const RAYS: usize = 64;
const LIGHT: DVec3 = DVec3::new(1.0, 5.0, -20.0);
const EYE: DVec3 = DVec3::new(0.0, 1.7, 0.0);

fn main() {
    divan::main();
}

/// Rays that pass the light on all sides.
fn view_rays() -> Vec<ViewRay> {
    (0..RAYS)
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

fn over_geometries<T>(bencher: Bencher, f: impl Fn(&LightRayGeometry) -> T + Sync) {
    let geometries: Vec<LightRayGeometry> = view_rays()
        .iter()
        .map(|ray| LightRayGeometry::new(ray.eye, ray.direction, ray.length_m, LIGHT, 0.05))
        .collect();
    bencher.counter(ItemsCount::new(RAYS)).bench(|| {
        for geometry in &geometries {
            black_box(f(black_box(geometry)));
        }
    });
}

#[divan::bench]
fn isotropic_without_extinction(bencher: Bencher) {
    over_geometries(bencher, airlight_without_extinction);
}

#[divan::bench]
fn isotropic_exact_f64(bencher: Bencher) {
    over_geometries(bencher, |geometry| airlight_isotropic(geometry, 0.03));
}

#[divan::bench(args = [8, 12, 20])]
fn isotropic_fast_f64(bencher: Bencher, nodes: usize) {
    let nodes = Nodes::new(nodes);
    over_geometries(bencher, |geometry| {
        airlight_isotropic_fast(geometry, 0.03, &nodes)
    });
}

fn phase(g: f64) -> PhaseFunction {
    match g {
        0.0 => PhaseFunction::Isotropic,
        _ => PhaseFunction::henyey_greenstein(g).expect("a phase function"),
    }
}

fn settings(nodes: usize) -> LightSettings {
    LightSettings {
        nodes,
        ..Default::default()
    }
}

fn over_rays_rgb(
    bencher: Bencher,
    light: Light<[f32; 3]>,
    g: f64,
    density: DensityProfile,
    nodes: usize,
    ground: Ground,
) {
    let layer = RgbLayer {
        density,
        extinction_per_m: [0.03, 0.031, 0.032],
        single_scattering_albedo: [1.0; 3],
        phase: phase(g),
    };
    let lights = RgbLightSet::new(vec![light], &[layer], ground, settings(nodes)).expect("lights");
    let rays = view_rays();
    bencher.counter(ItemsCount::new(RAYS)).bench_local(|| {
        for ray in &rays {
            black_box(lights.path_radiance(black_box(ray)));
        }
    });
}

/// At the 16 wavelengths of the standard grid.
fn over_rays_spectral(
    bencher: Bencher,
    light: Light,
    g: f64,
    density: DensityProfile,
    nodes: usize,
) {
    let grid = WavelengthGrid::standard();
    let nm = grid.wavelengths_nm().to_vec();
    let extinction = (0..nm.len()).map(|i| 0.03 + 0.001 * i as f64).collect();
    let layer = Constituent {
        kind: ConstituentKind::Fog,
        density,
        scattering_per_m: SpectralCurve::table(nm, extinction).expect("a curve"),
        absorption_per_m: SpectralCurve::Constant(0.0),
        phase: phase(g),
    };
    let (layers, settings) = ([layer], settings(nodes));
    let lights =
        LightSet::new(vec![light], &layers, Ground::FLAT, settings, &grid).expect("lights");
    let rays = view_rays();
    let mut out = vec![0.0; grid.len()];
    bencher.counter(ItemsCount::new(RAYS)).bench_local(|| {
        for ray in &rays {
            lights.path_radiance(black_box(ray), &mut out);
            black_box(&out);
        }
    });
}

fn point<C: ChannelValues>(intensity: C) -> Light<C> {
    Light::Point(PointLight::new(LIGHT, intensity, 0.05).expect("a light"))
}

fn spot<C: ChannelValues>(intensity: C) -> Light<C> {
    let light = SpotLight::new(LIGHT, DVec3::NEG_Y, intensity, 0.5, 1.2, 0.05);
    Light::Spot(light.expect("a light"))
}

fn sphere<C: ChannelValues>(radiance: C) -> Light<C> {
    Light::Sphere(SphereLight::new(LIGHT, 0.2, radiance).expect("a light"))
}

const RGB: [f32; 3] = [1.0; 3];
const CURVE: SpectralCurve = SpectralCurve::Constant(1.0);
const UNIFORM: DensityProfile = DensityProfile::Uniform;
const HEIGHT_FOG: DensityProfile = DensityProfile::exponential(10.0);

#[divan::bench]
fn isotropic_uniform_rgb(bencher: Bencher) {
    over_rays_rgb(bencher, point(RGB), 0.0, UNIFORM, 12, Ground::FLAT);
}

#[divan::bench]
fn isotropic_uniform_16(bencher: Bencher) {
    over_rays_spectral(bencher, point(CURVE), 0.0, UNIFORM, 12);
}

#[divan::bench(args = [8, 12])]
fn forward_085_uniform_rgb(bencher: Bencher, nodes: usize) {
    over_rays_rgb(bencher, point(RGB), 0.85, UNIFORM, nodes, Ground::FLAT);
}

#[divan::bench(args = [8, 12])]
fn forward_085_uniform_16(bencher: Bencher, nodes: usize) {
    over_rays_spectral(bencher, point(CURVE), 0.85, UNIFORM, nodes);
}

#[divan::bench(args = [8, 12])]
fn forward_085_height_fog_rgb(bencher: Bencher, nodes: usize) {
    over_rays_rgb(bencher, point(RGB), 0.85, HEIGHT_FOG, nodes, Ground::FLAT);
}

#[divan::bench(args = [8, 12])]
fn forward_085_height_fog_16(bencher: Bencher, nodes: usize) {
    over_rays_spectral(bencher, point(CURVE), 0.85, HEIGHT_FOG, nodes);
}

#[divan::bench]
fn forward_085_height_fog_round_ground_rgb(bencher: Bencher) {
    over_rays_rgb(bencher, point(RGB), 0.85, HEIGHT_FOG, 12, Ground::EARTH);
}

#[divan::bench]
fn spot_uniform_rgb(bencher: Bencher) {
    over_rays_rgb(bencher, spot(RGB), 0.85, UNIFORM, 12, Ground::FLAT);
}

#[divan::bench]
fn spot_uniform_16(bencher: Bencher) {
    over_rays_spectral(bencher, spot(CURVE), 0.85, UNIFORM, 12);
}

#[divan::bench]
fn spot_height_fog_rgb(bencher: Bencher) {
    over_rays_rgb(bencher, spot(RGB), 0.85, HEIGHT_FOG, 12, Ground::FLAT);
}

#[divan::bench]
fn sphere_uniform_rgb(bencher: Bencher) {
    over_rays_rgb(bencher, sphere(RGB), 0.85, UNIFORM, 12, Ground::FLAT);
}
