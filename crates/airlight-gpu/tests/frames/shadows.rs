//! Shadows in air and fog, against marches of the library's light in small steps, from each of which a ray leads to the sun.

use super::{draw, reference, rgb_of};
use airlight::atmosphere::{Constituent, DensityProfile, Preset};
use airlight::axes;
use airlight::fog::droplets::Droplets;
use airlight::fog::{
    DirectionalLight, FogLighting, FogScattering, Ground, RaySegment, RgbFog, RgbLayer,
};
use airlight::scene::RgbFoggySky;
use airlight::sky::{Scattering, Sky, SkySettings, SplitView, View};
use airlight::spectrum::RgbSpace;
use airlight_gpu::headless::{FORMAT, Frame, Headless};
use airlight_gpu::{
    Fog, HeightField, ShadowMap, SkyRenderer, SkyRendererSettings, SunShadows, TerrainPass,
    TerrainView,
};
use glam::{DMat3, DVec3, Mat3, Mat4, Vec3};

const AIR: Preset = Preset::Average;
const SUN_DEG: f64 = 6.0;
/// Place of the eye: east of the middle of the grid, above the ground, south, m.
const EYE_M: DVec3 = DVec3::new(-3000.0, 300.0, 500.0);
const STEPS: usize = 200;
const EXPOSURE: f32 = 1e-4;

pub fn sun() -> DVec3 {
    axes::direction(90.0, SUN_DEG)
}

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

/// Whether a point, m around the eye, is in sunlight over the ground of a planet.
fn is_above_shadow(field: &HeightField, planet_radius_m: f64, point: DVec3) -> bool {
    let highest_m = f64::from(field.highest_m());
    let mut here_m = 0.0;
    loop {
        let at = point + sun() * here_m;
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

/// A disc that faces the sun, 250 m from the eye and 150 m in radius, and what a shadow map shows of it.
pub struct Disc {
    middle: DVec3,
    radius_m: f64,
}

impl Disc {
    /// Half the width of the map, and half its depth, m.
    const HALF_M: [f64; 2] = [450.0, 1000.0];
    pub const SIDE: u32 = 1024;

    pub fn new() -> Self {
        Self {
            middle: axes::direction(60.0, 25.0) * 250.0,
            radius_m: 150.0,
        }
    }

    /// Right, up and towards the sun.
    fn axes() -> DMat3 {
        let across = sun().cross(DVec3::Y).normalize();
        DMat3::from_cols(across, across.cross(sun()), sun())
    }

    fn is_lit(&self, point: DVec3) -> bool {
        let behind = Self::axes().transpose() * (point - self.middle);
        behind.z > 0.0 || behind.truncate().length() > self.radius_m
    }

    pub fn clip_from_world(&self) -> Mat4 {
        let [half_m, depth_m] = Self::HALF_M;
        let turn = Mat4::from_mat3(Mat3::from_cols_array(
            &Self::axes().transpose().to_cols_array().map(|v| v as f32),
        ));
        let scale = Vec3::new(
            1.0 / half_m as f32,
            1.0 / half_m as f32,
            -0.5 / depth_m as f32,
        );
        Mat4::from_translation(Vec3::new(0.0, 0.0, 0.5)) * Mat4::from_scale(scale) * turn
    }

    /// Depths that increase away from the sun.
    pub fn map(&self, gpu: &Headless) -> wgpu::TextureView {
        let texel_m = 2.0 * Self::HALF_M[0] / f64::from(Self::SIDE);
        let middle = Self::axes().transpose() * self.middle;
        let depth = |k: u32| {
            let at = |n: u32| (f64::from(n) + 0.5) * texel_m - Self::HALF_M[0];
            let (x, y) = (at(k % Self::SIDE), -at(k / Self::SIDE));
            match (x - middle.x).hypot(y - middle.y) < self.radius_m {
                true => (0.5 - 0.5 * middle.z / Self::HALF_M[1]) as f32,
                false => 1.0,
            }
        };
        let depths = (0..Self::SIDE * Self::SIDE).map(depth);
        let bytes: Vec<u8> = depths.flat_map(f32::to_ne_bytes).collect();
        let size = wgpu::Extent3d {
            width: Self::SIDE,
            height: Self::SIDE,
            depth_or_array_layers: 1,
        };
        let texture = gpu.device.create_texture(&wgpu::TextureDescriptor {
            label: None,
            size,
            mip_level_count: 1,
            sample_count: 1,
            dimension: wgpu::TextureDimension::D2,
            format: wgpu::TextureFormat::R32Float,
            usage: wgpu::TextureUsages::TEXTURE_BINDING | wgpu::TextureUsages::COPY_DST,
            view_formats: &[],
        });
        let layout = wgpu::TexelCopyBufferLayout {
            offset: 0,
            bytes_per_row: Some(4 * Self::SIDE),
            rows_per_image: None,
        };
        gpu.queue
            .write_texture(texture.as_image_copy(), &bytes, layout, size);
        texture.create_view(&Default::default())
    }
}

/// Distances up to which steps along a ray lead: even in the square root.
fn distances_m(length_m: f64) -> Vec<f64> {
    let place = |k: usize| (k as f64 / STEPS as f64).powi(2);
    (0..=STEPS)
        .map(|k| (length_m * place(k)).max(1e-3))
        .collect()
}

/// The library's light, at sixteen wavelengths.
struct Truth {
    view: View,
    split: SplitView,
    single: SplitView,
    foggy: RgbFoggySky,
    fog: RgbFog,
    layers: Vec<RgbLayer>,
}

impl Truth {
    /// The light in fog of layers with an extinction at density 1, 1/m.
    fn new(layers: &[(DensityProfile, f64)]) -> Self {
        let view = reference(AIR, SUN_DEG, EYE_M.y, sun());
        let settings = SkySettings {
            scattering: Scattering::Single,
            ..super::settings(SUN_DEG, EYE_M.y)
        };
        let single = Sky::prepare(&AIR.atmosphere(), view.sky().grid(), &settings).unwrap();
        let layer = |(density, extinction_per_m): &(DensityProfile, f64)| {
            let droplets = Droplets::default().into();
            Constituent::fog(*extinction_per_m, droplets, density.clone(), &[]).unwrap()
        };
        let layers: Vec<Constituent> = layers.iter().map(layer).collect();
        let (all, space) = (FogScattering::Multiple, RgbSpace::Srgb);
        let foggy = RgbFoggySky::new(&view, &layers, all, space).unwrap();
        let layers = layers.iter();
        let layers = layers.map(|layer| RgbLayer::from_constituent(layer, space).unwrap());
        let layers: Vec<RgbLayer> = layers.collect();
        let lighting = FogLighting {
            sun: Some(DirectionalLight {
                direction: sun(),
                // At the top of the fog.
                irradiance: foggy.sun_irradiance(700.0),
            }),
            ambient: [0.0; 3],
            ground_albedo: [0.1; 3],
        };
        Self {
            split: view.split(),
            single: single.view(EYE_M.y, sun()).split(),
            fog: RgbFog::new(&layers, Ground::FLAT, &lighting, all).unwrap(),
            foggy,
            layers,
            view,
        }
    }

    /// Light that air scatters once up to distances along a ray; what haze scatters by small angles on the way still counts as sunlight.
    fn once_in_air(&self, direction: DVec3, stops_m: &[f64]) -> Vec<[f64; 3]> {
        let phase = self.split.phase(direction.dot(sun()));
        let views = [&self.split, &self.single];
        let [all, once] = views.map(|split| split.paths(&[direction], stops_m));
        let light = all[0].iter().zip(&once[0]).map(|(all, once)| {
            let haze = all
                .peaked
                .iter()
                .zip(&phase)
                .map(|(light, phase)| light * phase);
            let light: Vec<f32> = once.smooth.iter().zip(haze).map(|(a, b)| a + b).collect();
            rgb_of(self.view.sky().grid(), &light)
        });
        light.collect()
    }

    /// Light that fog scatters once up to distances along a ray, each step behind the air before it.
    fn once_in_fog(&self, direction: DVec3, stops_m: &[f64]) -> Vec<[f64; 3]> {
        let table = self.fog.seen_from(EYE_M.y);
        let streams = table.sun_streams(0, direction.dot(sun()));
        let mut alone = vec![[0.0f64; 3]; stops_m.len()];
        for (k, (density, extinction_per_m)) in self.fog.profiles().enumerate() {
            let parts = table.parts(k, direction.y, stops_m).unwrap();
            for ((sum, parts), &m) in alone.iter_mut().zip(parts).zip(stops_m) {
                let column_m = density.column_along_m(&RaySegment::flat(EYE_M.y, direction.y, m));
                for c in 0..3 {
                    let each = parts.streams[0].iter().zip(&streams);
                    let source: f32 = each.map(|(light, phase)| light[c] * phase[c]).sum();
                    let opacity = -(-f64::from(extinction_per_m[c]) * column_m).exp_m1();
                    sum[c] += f64::from(source) * opacity;
                }
            }
        }
        let mut sums = vec![[0.0f64; 3]];
        for (steps, stops_m) in alone.windows(2).zip(stops_m.windows(2)) {
            let middle_m = 0.5 * (stops_m[0] + stops_m[1]);
            let air = self.foggy.clear_path(direction, middle_m).transmittance;
            let before = sums[sums.len() - 1];
            let step = |c: usize| f64::from(air[c]) * (steps[1][c] - steps[0][c]);
            sums.push(std::array::from_fn(|c| before[c] + step(c)));
        }
        sums
    }

    /// Light that shadows take away along a ray, without and with the fog.
    fn lost(
        &self,
        direction: DVec3,
        length_m: f64,
        is_lit: &dyn Fn(DVec3) -> bool,
    ) -> [[f64; 3]; 2] {
        let stops_m = distances_m(length_m);
        let once = [
            self.once_in_air(direction, &stops_m),
            self.once_in_fog(direction, &stops_m),
        ];
        let mut lost = [[0.0; 3]; 2];
        for (k, step_m) in stops_m.windows(2).enumerate() {
            if !is_lit(direction * (0.5 * (step_m[0] + step_m[1]))) {
                for (lost, once) in lost.iter_mut().zip(&once) {
                    for c in 0..3 {
                        lost[c] += once[k + 1][c] - once[k][c];
                    }
                }
            }
        }
        let [air, fog] = lost;
        let through = self
            .fog
            .path(EYE_M.y, direction, f64::INFINITY)
            .transmittance;
        let both = std::array::from_fn(|c| fog[c] + f64::from(through[c]) * air[c]);
        [air, both]
    }
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
        let mut terrain = TerrainPass::new(&gpu.device, &gpu.queue, FORMAT).unwrap();
        terrain.set_heights(&ridge());
        Self {
            renderer,
            terrain,
            frame: Frame::towards(axes::direction(60.0, 42.0).as_vec3(), 24),
            gpu,
        }
    }

    fn set_fog(&mut self, layers: Option<&[RgbLayer]>) {
        let fog = layers.map(|layers| Fog {
            layers: layers.to_vec(),
            ground_height_m: 0.0,
            ground_albedo: [0.1; 3],
        });
        self.renderer.set_fog(fog).unwrap();
    }

    /// What shadows take from each pixel without geometry, and its light without shadows: those of the ground, or of a disc.
    fn lost(&mut self, sun: DVec3, disc: Option<&Disc>) -> Vec<[Vec3; 2]> {
        self.renderer.update(EYE_M.y, sun).unwrap();
        let radius_m = AIR.atmosphere().planet.radius_m;
        let lighting = *self.renderer.lighting().unwrap();
        let view = TerrainView::new(EYE_M, radius_m, lighting, [[0.1; 3]; 2]).unwrap();
        let lit = draw(&self.gpu, &mut self.renderer, &self.frame, EXPOSURE, None);
        let camera = self.frame.camera(EXPOSURE).unwrap();
        let of_disc = disc.map(|disc| {
            let map = ShadowMap {
                depth: &disc.map(&self.gpu),
                size: [Disc::SIDE; 2],
                clip_from_world: disc.clip_from_world(),
                is_reversed: false,
                reach_m: 800.0,
            };
            SunShadows::from_map(&self.gpu.device, &map).unwrap()
        });
        let (renderer, terrain) = (&mut self.renderer, &mut self.terrain);
        let shaded = self.gpu.draw(&self.frame, None, |encoder, target, depth| {
            let of_ground = || terrain.shadows(encoder, &view);
            let shadows = of_disc.or_else(of_ground);
            renderer.record_shadowed(encoder, target, depth, &camera, shadows.as_ref());
        });
        let pairs = lit.into_iter().zip(shaded.unwrap());
        let pairs = pairs.map(|(lit, shaded)| [lit, shaded].map(|rgb| Vec3::from(rgb) / EXPOSURE));
        pairs.map(|[lit, shaded]| [lit - shaded, lit]).collect()
    }

    fn direction(&self, k: usize) -> DVec3 {
        let (x, y) = (k as u32 % self.frame.side, k as u32 / self.frame.side);
        self.frame.direction(x, y).as_dvec3().normalize()
    }

    /// Compares what shadows take away without and with fog, relative to the luminance without shadows: for each the largest, and
    /// the root mean square and the largest of the error.
    fn compared(
        &mut self,
        truth: &Truth,
        length_m: f64,
        disc: Option<&Disc>,
        is_lit: &dyn Fn(DVec3) -> bool,
    ) -> [[f64; 3]; 2] {
        self.set_fog(None);
        let in_air = self.lost(sun(), disc);
        self.set_fog(Some(&truth.layers));
        let in_fog = self.lost(sun(), disc);
        let luminance = |rgb: [f64; 3]| RgbSpace::Srgb.luminance(rgb);
        let of = |rgb: Vec3| luminance(rgb.to_array().map(f64::from));
        let mut all = [[0.0f64; 3]; 2];
        let count = in_air.len() as f64;
        for k in 0..in_air.len() {
            let right = truth.lost(self.direction(k), length_m, is_lit);
            for (([got, lit], right), sums) in
                [in_air[k], in_fog[k]].into_iter().zip(right).zip(&mut all)
            {
                let right = luminance(right) / of(lit);
                let error = (of(got) / of(lit) - right).abs();
                sums[0] = sums[0].max(right);
                sums[1] += error * error / count;
                sums[2] = sums[2].max(error);
            }
        }
        all.map(|[most, squares, worst]| [most, squares.sqrt(), worst])
    }
}

#[test]
fn ground_throws_shadows_into_air_and_fog() {
    let field = ridge();
    let truth = Truth::new(&[(DensityProfile::exponential(150.0), 0.002)]);
    let (planet_radius_m, _) = truth.view.bounds_m();
    let is_lit = |point| is_above_shadow(&field, planet_radius_m, point);
    let [air, fog] = Scene::new().compared(&truth, 1e5, None, &is_lit);
    println!("shadows, error, worst: air {air:.4?}, fog {fog:.4?}");
    assert!(air[0] > 0.5 && air[1] < 0.005 && air[2] < 0.025);
    assert!(fog[0] > 0.5 && fog[1] < 0.01 && fog[2] < 0.04);
}

/// A disc between fog and sun, whose shadow is a beam of darkness, in a single layer and in two.
#[test]
fn what_a_shadow_map_shows_throws_shadows() {
    let raised = DensityProfile::Layer {
        bottom_m: 200.0,
        top_m: 400.0,
    };
    let [low, raised] =
        [DensityProfile::exponential(150.0), raised].map(|profile| (profile, 0.002));
    let disc = Disc::new();
    let is_lit = |point| disc.is_lit(point);
    let mut scene = Scene::new();
    for (layers, [least, most_rms, most]) in [
        (&[low.clone()][..], [0.1, 0.003, 0.01]),
        (&[low, raised], [0.3, 0.006, 0.02]),
    ] {
        let truth = Truth::new(layers);
        let [air, fog] = scene.compared(&truth, 800.0, Some(&disc), &is_lit);
        println!(
            "{} layers: shadows, error, worst: air {air:.4?}, fog {fog:.4?}",
            layers.len()
        );
        assert!(air[0] > 0.02 && air[1] < 0.001 && air[2] < 0.003);
        assert!(fog[0] > least && fog[1] < most_rms && fog[2] < most);
    }
}

/// Shadows need no tables of their own where none are drawn; there are none of a sun that is down, nor before the first heights.
#[test]
fn without_shadows_frames_are_the_same() {
    let gpu = Headless::new().unwrap();
    let frame = Frame::towards(Vec3::X, 16);
    let drawn = |shadows: bool| {
        let settings = SkyRendererSettings {
            solver: super::settings(SUN_DEG, 2.0),
            shadows,
            ..SkyRendererSettings::new(FORMAT)
        };
        let air = AIR.atmosphere();
        let mut renderer = SkyRenderer::new(&gpu.device, &gpu.queue, &air, &settings).unwrap();
        renderer.update(2.0, sun()).unwrap();
        draw(&gpu, &mut renderer, &frame, EXPOSURE, None)
    };
    assert!(drawn(true) == drawn(false));
    let mut scene = Scene::new();
    let is_none = |lost: Vec<[Vec3; 2]>| lost.iter().all(|[lost, _]| *lost == Vec3::ZERO);
    assert!(is_none(scene.lost(axes::direction(90.0, -2.0), None)));
    scene.terrain = TerrainPass::new(&scene.gpu.device, &scene.gpu.queue, FORMAT).unwrap();
    assert!(is_none(scene.lost(sun(), None)));
}
