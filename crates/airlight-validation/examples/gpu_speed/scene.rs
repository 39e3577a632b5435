//! The scene: mountains, their air, fog and lights, and the renderers prepared for it.

use crate::stopwatch::Stopwatch;
use airlight::atmosphere::{Atmosphere, Preset};
use airlight::axes;
use airlight::fog::lights::{Light, PointLight};
use airlight::glam::{DVec3, Mat4, Vec3};
use airlight::spectrum::RgbSpace;
use airlight::transfer::medium_evaluations;
use airlight_gpu::headless::FORMAT;
use airlight_gpu::{
    Camera, Fog, FrameTables, HeightField, Lighting, Projection, SkyPasses, SkyRendererError,
    SkySolver, TerrainPass, TerrainView, read_rgb,
};
use airlight_image::tone::{ToneCurve, ToneMapper};
use airlight_image::{Control, PictureOptions, Size, rows::StoredRows, write_picture};
use airlight_validation::frames::hillaire2020::{HillairePasses, HillairePassesError};
use std::cell::Cell;
use std::error::Error;
use std::path::Path;

/// Elevation of the sun, degrees.
const SUN_DEG: f64 = 12.0;
const SUN_AZIMUTH_DEG: f64 = 90.0;
/// Direction of the view, degrees.
const LOOK_DEG: (f64, f64) = (60.0, 2.0);
/// Height of the eye above the ground below it, m.
const ABOVE_GROUND_M: f64 = 60.0;
/// Distance of the near plane, m.
const NEAR_M: f32 = 0.1;

/// Records the passes of a renderer.
type Record<'a> = dyn Fn(&mut wgpu::CommandEncoder) + 'a;

/// The renderers, prepared for the scene.
pub struct Scene {
    device: wgpu::Device,
    queue: wgpu::Queue,
    air: Atmosphere,
    terrain: TerrainPass,
    eye_m: DVec3,
    solver: SkySolver,
    lighting: Lighting,
    /// Ours: air alone, with fog, and with lights in the fog.
    pub clear: SkyPasses,
    pub foggy: SkyPasses,
    pub lit: SkyPasses,
    pub hillaire: HillairePasses,
    /// Suns so far, each of which is another one.
    suns: Cell<u32>,
}

/// A frame: what a program has drawn, and the target over which the renderers draw.
pub struct Frame {
    pub size: [u32; 2],
    pub camera: Camera,
    pub target: wgpu::TextureView,
    pub depth: wgpu::TextureView,
    drawn: wgpu::Texture,
    texture: wgpu::Texture,
}

impl Scene {
    pub fn new(device: &wgpu::Device, queue: &wgpu::Queue) -> Result<Self, Box<dyn Error>> {
        let air = Preset::Hillaire.atmosphere();
        let solver = SkySolver::new(&air, &SkySolver::default_settings(), RgbSpace::Srgb)?;
        let ground = mountains()?;
        let eye_m = DVec3::Y * (ground.height_m([0.0; 2]) + ABOVE_GROUND_M);
        let mut terrain = TerrainPass::new(device, queue, FORMAT)?;
        terrain.set_heights(&ground);
        let passes = |tables: &FrameTables| -> Result<SkyPasses, SkyRendererError> {
            let mut passes = SkyPasses::new(device, queue, FORMAT)?;
            passes.set_tables(tables);
            Ok(passes)
        };
        let fog = Fog::new(1500.0, 200.0);
        let tables = solver.tables(eye_m.y, sun(0), None)?;
        let foggy = solver.tables(eye_m.y, sun(0), Some(&fog))?;
        let mut lit = passes(&foggy)?;
        lit.set_lights(&lights()?)?;
        Ok(Self {
            lighting: tables.lighting,
            clear: passes(&tables)?,
            foggy: passes(&foggy)?,
            lit,
            hillaire: HillairePasses::new(device, queue, &air, FORMAT)?,
            device: device.clone(),
            queue: queue.clone(),
            air,
            terrain,
            eye_m,
            solver,
            suns: Cell::new(0),
        })
    }

    /// Time of our tables for a sun that has moved, and of their upload, ms.
    pub fn time_tables(&self, watch: &Stopwatch) -> Result<f64, Box<dyn Error>> {
        self.suns.set(self.suns.get() + 1);
        let mut passes = SkyPasses::new(&self.device, &self.queue, FORMAT)?;
        let sun = sun(self.suns.get());
        let fill = || {
            let tables = self.solver.tables(self.eye_m.y, sun, None)?;
            passes.set_tables(&tables);
            Ok::<_, SkyRendererError>(())
        };
        watch.time_work(fill)
    }

    /// Places where the densities of the air are evaluated when the camera turns, when it moves, and when the sun moves: ours, and those
    /// of Hillaire 2020.
    pub fn medium_evaluations(&self) -> Result<Vec<[u64; 2]>, Box<dyn Error>> {
        // On one thread, whose evaluations are counted.
        let pool = rayon::ThreadPoolBuilder::new().num_threads(1).build()?;
        let (solver, height_m) = (&self.solver, self.eye_m.y);
        let count = || {
            let before = medium_evaluations();
            solver.tables(height_m, sun(1), None)?;
            Ok::<_, SkyRendererError>(medium_evaluations() - before)
        };
        let ours = pool.install(count)?;
        let [sky, aerial] = HillairePasses::medium_evaluations();
        Ok(vec![[0, aerial], [0, sky + aerial], [ours, sky + aerial]])
    }

    /// Draws the mountains into a frame of a size.
    pub fn frame(&self, size: [u32; 2]) -> Result<Frame, Box<dyn Error>> {
        let largest = self.device.limits().max_texture_dimension_2d;
        if size.iter().any(|side| *side > largest) {
            let [width, height] = size;
            return Err(format!("expected sides of at most {largest} pixels, as the adapter has, got {width}x{height}").into());
        }
        let usage = wgpu::TextureUsages::RENDER_ATTACHMENT | wgpu::TextureUsages::COPY_SRC;
        let texture = |format, usage| {
            self.device.create_texture(&wgpu::TextureDescriptor {
                label: Some("frame"),
                size: extent(size),
                mip_level_count: 1,
                sample_count: 1,
                dimension: wgpu::TextureDimension::D2,
                format,
                usage,
                view_formats: &[],
            })
        };
        let view =
            |texture: &wgpu::Texture| texture.create_view(&wgpu::TextureViewDescriptor::default());
        let drawn = texture(FORMAT, usage);
        let target = texture(FORMAT, usage | wgpu::TextureUsages::COPY_DST);
        let depth = texture(
            wgpu::TextureFormat::R32Float,
            usage | wgpu::TextureUsages::TEXTURE_BINDING,
        );
        let frame = Frame {
            size,
            camera: self.camera(size)?,
            target: view(&target),
            depth: view(&depth),
            drawn,
            texture: target,
        };
        let albedos = [[0.05, 0.07, 0.03], [0.16, 0.15, 0.13]];
        let radius_m = self.air.planet.radius_m;
        let terrain = TerrainView::new(self.eye_m, radius_m, self.lighting, albedos)?;
        let mut encoder = self
            .device
            .create_command_encoder(&wgpu::CommandEncoderDescriptor::default());
        self.terrain.record(
            &mut encoder,
            &view(&frame.drawn),
            &frame.depth,
            &frame.camera,
            &terrain,
        );
        self.queue.submit([encoder.finish()]);
        Ok(frame)
    }

    fn camera(&self, [width, height]: [u32; 2]) -> Result<Camera, SkyRendererError> {
        let (azimuth, elevation) = LOOK_DEG;
        let look = axes::direction(azimuth, elevation).as_vec3();
        let view = airlight::glam::camera::rh::view::look_to_mat4(Vec3::ZERO, look, Vec3::Y);
        // 90 degrees from left to right; depth 1 at the near plane and 0 at infinity.
        let projection = Mat4::from_cols_array_2d(&[
            [1.0, 0.0, 0.0, 0.0],
            [0.0, width as f32 / height as f32, 0.0, 0.0],
            [0.0, 0.0, 0.0, -1.0],
            [0.0, 0.0, NEAR_M, 0.0],
        ]);
        let perspective = Projection::Perspective {
            world_from_clip: (projection * view).inverse(),
            far_depth: 0.0,
        };
        Camera::new(
            perspective,
            1.0 / self.lighting.sky_illuminance_lx(Vec3::Y).y,
        )
    }

    /// Sets the eye, the sun and the camera of Hillaire 2020.
    pub fn set_hillaire_view(&self, frame: &Frame) -> Result<(), HillairePassesError> {
        self.hillaire.set_view(self.eye_m.y, sun(0), &frame.camera)
    }

    /// Writes the frames of all renderers.
    pub fn write_pictures(&self, frame: &Frame, folder: &Path) -> Result<(), Box<dyn Error>> {
        self.set_hillaire_view(frame)?;
        let ours = |passes: &SkyPasses, encoder: &mut wgpu::CommandEncoder| {
            passes.record(encoder, &frame.target, &frame.depth, &frame.camera);
        };
        let renderers: [(&str, &Record<'_>); 4] = [
            ("airlight-gpu", &|encoder| ours(&self.clear, encoder)),
            ("airlight-gpu-fog", &|encoder| ours(&self.foggy, encoder)),
            ("airlight-gpu-lights", &|encoder| ours(&self.lit, encoder)),
            ("hillaire2020", &|encoder| {
                self.hillaire.record_tables(encoder);
                self.hillaire.record(encoder, &frame.target, &frame.depth);
            }),
        ];
        std::fs::create_dir_all(folder)?;
        for (name, record) in renderers {
            frame.restore(&self.device, &self.queue);
            let mut encoder = self
                .device
                .create_command_encoder(&wgpu::CommandEncoderDescriptor::default());
            record(&mut encoder);
            self.queue.submit([encoder.finish()]);
            let pixels = read_rgb(&self.device, &self.queue, &frame.texture)?;
            let [width, height] = frame.size;
            write_picture(
                &folder.join(name).with_extension("png"),
                Size::new(width, height)?,
                &StoredRows::new(width, 3, pixels.as_flattened().to_vec())?,
                &ToneMapper::new(1.0, ToneCurve::default())?,
                &PictureOptions::default(),
                Control::default(),
            )?;
        }
        Ok(())
    }
}

impl Frame {
    /// What the program has drawn, again in the target.
    pub fn restore(&self, device: &wgpu::Device, queue: &wgpu::Queue) {
        let mut encoder = device.create_command_encoder(&wgpu::CommandEncoderDescriptor::default());
        let (drawn, target) = (self.drawn.as_image_copy(), self.texture.as_image_copy());
        encoder.copy_texture_to_texture(drawn, target, extent(self.size));
        queue.submit([encoder.finish()]);
    }
}

fn extent([width, height]: [u32; 2]) -> wgpu::Extent3d {
    wgpu::Extent3d {
        width,
        height,
        depth_or_array_layers: 1,
    }
}

/// The sun after some movements.
fn sun(movements: u32) -> DVec3 {
    axes::direction(SUN_AZIMUTH_DEG, SUN_DEG + 1e-3 * f64::from(movements))
}

/// Ridges around a valley.
fn mountains() -> Result<HeightField, SkyRendererError> {
    const SIDE: usize = 512;
    const SPACING_M: f64 = 60.0;
    let height = |k: usize| {
        let [x, z] = [k % SIDE, k / SIDE].map(|n| (n as f64 - 255.5) * SPACING_M * 1e-3);
        let ridges = (0..6).map(|octave| {
            let scale = 0.3 * 1.9f64.powi(octave);
            let (u, v) = (scale * (0.8 * x + 0.6 * z), scale * (0.8 * z - 0.6 * x));
            let fold = (u + 0.7 * (1.3 * v).sin()).sin() * (v + 0.6 * u.sin()).cos();
            (1.0 - fold.abs()).powi(2) / 1.9f64.powi(octave)
        });
        let valley = 1.0 - 0.75 * (-(x * x + 0.3 * z * z) / 9.0).exp();
        (900.0 * valley * ridges.sum::<f64>()) as f32
    };
    HeightField::new(
        [SIDE; 2],
        [SPACING_M; 2],
        (0..SIDE * SIDE).map(height).collect(),
    )
}

/// Lights in two rows ahead of the eye.
fn lights() -> Result<Vec<Light<[f32; 3]>>, Box<dyn Error>> {
    let ahead = axes::direction(LOOK_DEG.0, 0.0);
    let aside = axes::direction(LOOK_DEG.0 + 90.0, 0.0);
    let rows = (1..=4).flat_map(|k| [-40.0, 40.0].map(|side| (60.0 * f64::from(k), side)));
    let light = |(far_m, side_m)| {
        let position = ahead * far_m + aside * side_m - DVec3::Y * 30.0;
        Ok(Light::Point(PointLight::new(
            position,
            [9e5, 5e5, 2e5],
            0.1,
        )?))
    };
    rows.map(light).collect()
}
