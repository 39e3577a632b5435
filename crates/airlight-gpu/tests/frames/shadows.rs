//! Shadows of ground in air and fog, against marches of the library's light in small steps, from each of which a ray leads to the sun.

use super::{draw, reference, rgb_of};
use airlight::atmosphere::{Constituent, DensityProfile, Preset};
use airlight::axes;
use airlight::fog::droplets::Droplets;
use airlight::fog::{DirectionalLight, FogLighting, FogScattering, Ground, RgbFog, RgbLayer};
use airlight::scene::RgbFoggySky;
use airlight::sky::{Scattering, Sky, SkySettings, View};
use airlight::spectrum::RgbSpace;
use airlight_gpu::headless::{FORMAT, Frame, Headless};
use airlight_gpu::{Fog, HeightField, SkyRenderer, SkyRendererSettings, TerrainPass, TerrainView};
use glam::{DVec3, Vec3};

const AIR: Preset = Preset::Average;
const SUN_DEG: f64 = 6.0;
/// Place of the eye: east of the middle of the grid, above the ground, south, m.
const EYE_M: DVec3 = DVec3::new(-3000.0, 300.0, 500.0);
const STEPS: usize = 200;

/// Heights with a ridge 7 km to the east of the eye, over which the sun stands.
fn ridge() -> HeightField {
    const SIDE: usize = 128;
    const SPACING_M: f64 = 400.0;
    let at = |k: usize| (k as f64 - 63.5) * SPACING_M;
    let height = |(x, z): (f64, f64)| {
        let crest = 1200.0 + 350.0 * (z / 1500.0).sin();
        (crest * (-((x - 4000.0) / 1000.0).powi(2)).exp()) as f32
    };
    let places = (0..SIDE * SIDE).map(|k| (at(k % SIDE), at(k / SIDE)));
    HeightField::new([SIDE; 2], [SPACING_M; 2], places.map(height).collect()).unwrap()
}

/// Whether a point, m around the eye, is in sunlight.
fn is_lit(field: &HeightField, planet_radius_m: f64, point: DVec3, sun: DVec3) -> bool {
    let highest_m = f64::from(field.highest_m());
    let mut here_m = 0.0;
    loop {
        let at = point + sun * here_m;
        let height_m = EYE_M.y + at.y + (at.x * at.x + at.z * at.z) / (2.0 * planet_radius_m);
        if height_m > highest_m {
            return true;
        }
        if height_m < field.height_m([EYE_M.x + at.x, EYE_M.z + at.z]) {
            return false;
        }
        here_m += 40.0;
    }
}

/// Distances up to which steps along a ray lead: even in the square root.
fn distances_m(length_m: f64) -> impl Iterator<Item = f64> {
    (0..=STEPS).map(move |k| length_m * (k as f64 / STEPS as f64).powi(2))
}

/// Light that a shadow takes away along a ray, from the light that is scattered once up to each of its distances.
fn lost(
    field: &HeightField,
    view: &View,
    direction: DVec3,
    length_m: f64,
    once: &[[f64; 3]],
) -> [f64; 3] {
    let (planet_radius_m, _) = view.bounds_m();
    let distances_m: Vec<f64> = distances_m(length_m).collect();
    let mut lost = [0.0; 3];
    for (step, of) in distances_m.windows(2).zip(once.windows(2)) {
        let middle = direction * (0.5 * (step[0] + step[1]));
        if !is_lit(field, planet_radius_m, middle, view.sun()) {
            for c in 0..3 {
                lost[c] += of[1][c] - of[0][c];
            }
        }
    }
    lost
}

struct Scene {
    gpu: Headless,
    renderer: SkyRenderer,
    terrain: TerrainPass,
    frame: Frame,
}

impl Scene {
    fn new() -> Self {
        let gpu = Headless::new().unwrap();
        let settings = SkyRendererSettings {
            solver: super::settings(SUN_DEG, EYE_M.y),
            shadows: true,
            ..SkyRendererSettings::new(FORMAT)
        };
        let air = AIR.atmosphere();
        let renderer = SkyRenderer::new(&gpu.device, &gpu.queue, &air, &settings).unwrap();
        let mut terrain = TerrainPass::new(&gpu.device, &gpu.queue, FORMAT);
        terrain.set_heights(&ridge());
        Self {
            renderer,
            terrain,
            frame: Frame::towards(axes::direction(60.0, 42.0).as_vec3(), 24),
            gpu,
        }
    }

    /// What the shadows take from each pixel without geometry.
    fn lost(&mut self, sun: DVec3) -> (Vec<Vec3>, Vec<Vec3>) {
        const EXPOSURE: f32 = 1e-4;
        self.renderer.update(EYE_M.y, sun).unwrap();
        let view = TerrainView {
            eye_m: EYE_M,
            planet_radius_m: AIR.atmosphere().planet.radius_m,
            lighting: *self.renderer.lighting().unwrap(),
            level_albedo: [0.1; 3],
            steep_albedo: [0.1; 3],
        };
        let lit = draw(&self.gpu, &mut self.renderer, &self.frame, EXPOSURE, None);
        let camera = self.frame.camera(EXPOSURE);
        let (renderer, terrain) = (&mut self.renderer, &mut self.terrain);
        let shaded = self.gpu.draw(&self.frame, None, |encoder, target, depth| {
            let shadows = terrain.shadows(encoder, &view);
            renderer.record_shadowed(encoder, target, depth, &camera, shadows.as_ref());
        });
        let lit: Vec<Vec3> = lit
            .into_iter()
            .map(|rgb| Vec3::from(rgb) / EXPOSURE)
            .collect();
        let shaded = shaded
            .unwrap()
            .into_iter()
            .map(|rgb| Vec3::from(rgb) / EXPOSURE);
        (
            lit.iter()
                .zip(shaded)
                .map(|(lit, shaded)| lit - shaded)
                .collect(),
            lit,
        )
    }

    fn direction(&self, k: usize) -> DVec3 {
        let (x, y) = (k as u32 % self.frame.side, k as u32 / self.frame.side);
        self.frame.direction(x, y).as_dvec3().normalize()
    }
}

/// Luminance that shadows take away, relative to the luminance with no shadow: the largest, and the root mean square and the largest of its error.
fn compared(pixels: impl Iterator<Item = (Vec3, [f64; 3], Vec3)>) -> [f64; 3] {
    let luminance = |rgb: [f64; 3]| RgbSpace::Srgb.luminance(rgb);
    let of = |rgb: Vec3| luminance(rgb.to_array().map(f64::from));
    let [mut most, mut squares, mut worst, mut count] = [0.0f64; 4];
    for (got, right, lit) in pixels {
        let right = luminance(right) / of(lit);
        let error = (of(got) / of(lit) - right).abs();
        most = most.max(right);
        squares += error * error;
        worst = worst.max(error);
        count += 1.0;
    }
    [most, (squares / count).sqrt(), worst]
}

#[test]
fn ground_throws_shadows_into_air_and_fog() {
    let sun = axes::direction(90.0, SUN_DEG);
    let field = ridge();
    let mut scene = Scene::new();
    let view = reference(AIR, SUN_DEG, EYE_M.y, sun);
    let grid = view.sky().grid();
    let settings = SkySettings {
        scattering: Scattering::Single,
        ..super::settings(SUN_DEG, EYE_M.y)
    };
    let single = Sky::prepare(&AIR.atmosphere(), grid, &settings).unwrap();
    let (split, single) = (view.split(), single.view(EYE_M.y, sun).split());
    const LENGTH_M: f64 = 1e5;
    let (in_air, lit) = scene.lost(sun);
    let air_right: Vec<[f64; 3]> = (0..in_air.len())
        .map(|k| {
            let direction = scene.direction(k);
            // What haze scatters by small angles on the way still counts as sunlight.
            let stops_m: Vec<f64> = distances_m(LENGTH_M).map(|m| m.max(1e-3)).collect();
            let phase = split.phase(direction.dot(sun));
            let [all, once] = [&split, &single].map(|split| split.paths(&[direction], &stops_m));
            let once = all[0].iter().zip(&once[0]).map(|(all, once)| {
                let haze = all
                    .peaked
                    .iter()
                    .zip(&phase)
                    .map(|(light, phase)| light * phase);
                let light: Vec<f32> = once.smooth.iter().zip(haze).map(|(a, b)| a + b).collect();
                rgb_of(grid, &light)
            });
            let once: Vec<[f64; 3]> = once.collect();
            lost(&field, &view, direction, LENGTH_M, &once)
        })
        .collect();
    let pixels = in_air.iter().zip(&air_right).zip(&lit);
    let [most, rms, worst] = compared(pixels.map(|((got, right), lit)| (*got, *right, *lit)));
    println!("air: shadows up to {most:.3} of the light, error {rms:.4}, worst {worst:.4}");
    assert!(
        most > 0.5 && rms < 0.005 && worst < 0.025,
        "{most} {rms} {worst}"
    );

    let density = DensityProfile::exponential(150.0);
    let layer = Constituent::fog(0.002, Droplets::default().into(), density, &[]).unwrap();
    let layers = [layer];
    let foggy = RgbFoggySky::new(&view, &layers, FogScattering::Multiple, RgbSpace::Srgb).unwrap();
    let layer = RgbLayer::from_constituent(&layers[0], RgbSpace::Srgb).unwrap();
    scene
        .renderer
        .set_fog(Some(Fog {
            layer: layer.clone(),
            ground_height_m: 0.0,
            ground_albedo: [0.1; 3],
        }))
        .unwrap();
    // The sunlight at the top of the fog.
    let lighting = FogLighting {
        sun: Some(DirectionalLight {
            direction: sun,
            irradiance: foggy.sun_irradiance(700.0),
        }),
        ambient: [0.0; 3],
        ground_albedo: [0.1; 3],
    };
    let fog = RgbFog::new(&[layer], Ground::FLAT, &lighting, FogScattering::Multiple).unwrap();
    let table = fog.seen_from(EYE_M.y);
    let (in_fog, lit) = scene.lost(sun);
    let fog_right = (0..in_fog.len()).map(|k| {
        let direction = scene.direction(k);
        let stops_m: Vec<f64> = distances_m(LENGTH_M).map(|m| m.max(1e-3)).collect();
        let streams = table.sun_streams(direction.dot(sun));
        let parts = table.parts(direction.y, &stops_m).unwrap();
        let once = parts.iter().zip(&stops_m).map(|(parts, &m)| {
            let transmittance = fog.path(EYE_M.y, direction, m).transmittance;
            std::array::from_fn(|c| {
                let source: f32 = (0..streams.len())
                    .map(|stream| parts.streams[stream][c] * streams[stream][c])
                    .sum();
                f64::from(source * (1.0 - transmittance[c]))
            })
        });
        let once: Vec<[f64; 3]> = once.collect();
        // Each step behind the air before it.
        let mut through_air = vec![[0.0; 3]];
        for (steps, stops_m) in once.windows(2).zip(stops_m.windows(2)) {
            let middle_m = 0.5 * (stops_m[0] + stops_m[1]);
            let air = foggy.clear_path(direction, middle_m).transmittance;
            let before = through_air[through_air.len() - 1];
            through_air.push(std::array::from_fn(|c| {
                before[c] + f64::from(air[c]) * (steps[1][c] - steps[0][c])
            }));
        }
        let of_fog = lost(&field, &view, direction, LENGTH_M, &through_air);
        let through = fog.path(EYE_M.y, direction, f64::INFINITY).transmittance;
        std::array::from_fn(|c| of_fog[c] + f64::from(through[c]) * air_right[k][c])
    });
    let pixels = in_fog.iter().zip(fog_right).zip(&lit);
    let [most, rms, worst] = compared(pixels.map(|((got, right), lit)| (*got, right, *lit)));
    println!("fog: shadows up to {most:.3} of the light, error {rms:.4}, worst {worst:.4}");
    assert!(
        most > 0.2 && rms < 0.01 && worst < 0.04,
        "{most} {rms} {worst}"
    );
}

/// Shadows need no tables of their own where none are drawn, and are found once for each sun.
#[test]
fn without_shadows_frames_are_the_same() {
    let gpu = Headless::new().unwrap();
    let sun = axes::direction(90.0, SUN_DEG);
    let frame = Frame::towards(Vec3::X, 16);
    let drawn = |shadows: bool| {
        let settings = SkyRendererSettings {
            solver: super::settings(SUN_DEG, 2.0),
            shadows,
            ..SkyRendererSettings::new(FORMAT)
        };
        let air = AIR.atmosphere();
        let mut renderer = SkyRenderer::new(&gpu.device, &gpu.queue, &air, &settings).unwrap();
        renderer.update(2.0, sun).unwrap();
        draw(&gpu, &mut renderer, &frame, 1e-4, None)
    };
    assert!(drawn(true) == drawn(false));
    // No shadows of a sun that is down, nor before the first heights.
    let mut scene = Scene::new();
    let (lost, _) = scene.lost(axes::direction(90.0, -2.0));
    assert!(lost.iter().all(|lost| *lost == Vec3::ZERO));
    scene.terrain = TerrainPass::new(&scene.gpu.device, &scene.gpu.queue, FORMAT);
    let (lost, _) = scene.lost(sun);
    assert!(lost.iter().all(|lost| *lost == Vec3::ZERO));
}
