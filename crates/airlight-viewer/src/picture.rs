//! [`Picture`]: the light of a frame on the graphics device, and what of it is shown.

use crate::compute::Light;
use crate::timers::{PASSES, PassTimes};
use airlight::fog::lights::Light as FogLight;
use airlight::scene::OutputSpec;
use airlight_gpu::{
    Camera, HeightField, PassTimers, SkyPasses, SkyRendererError, SunShadows, TerrainPass,
    TerrainView, ToneCurve, TonePass, ToneSettings,
};
use airlight_image::tone::{self, ToneMapper, WhiteBalance};
use airlight_image::{Frame, Projection};
use airlight_render::display::tone_curve;
use eframe::wgpu;
use glam::{DVec3, Mat4, Vec4};

/// Format of the light.
const LIGHT: wgpu::TextureFormat = wgpu::TextureFormat::Rgba16Float;
/// Formats of the depth without ground, and with it.
const DEPTH: wgpu::TextureFormat = wgpu::TextureFormat::Depth32Float;
const GROUND_DEPTH: wgpu::TextureFormat = wgpu::TextureFormat::R32Float;
/// Whether terrain throws shadows into air and fog: on a desktop. In a page, whose device may be slow, it does not.
pub const HAS_SHADOWS: bool = cfg!(not(target_arch = "wasm32"));
/// Distance of the near plane, m.
const NEAR_M: f32 = 0.1;
/// Albedo of meadows and woods in linear sRGB, and of rock.
const LEVEL_ALBEDO: [f32; 3] = [0.055, 0.075, 0.03];
const STEEP_ALBEDO: [f32; 3] = [0.17, 0.155, 0.13];
/// Format of what is shown.
const SHOWN: wgpu::TextureFormat = wgpu::TextureFormat::Rgba8Unorm;

/// The ground of the heights that were set last.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Ground {
    /// Number of the heights.
    pub number: u64,
    /// Place of the eye to the east and south of their middle, m.
    pub place_m: [f64; 2],
}

/// What a picture shows, apart from the light.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Shot {
    /// Projection and size.
    pub frame: Frame,
    /// Ground in front of the sky.
    pub ground: Option<Ground>,
    /// Factor on light in cd/m^2.
    pub exposure: f32,
    /// Tone curve and white balance.
    pub tone: ToneSettings,
}

impl Shot {
    /// Width and height, pixels.
    pub fn size(&self) -> [u32; 2] {
        let size = self.frame.size();
        [size.width(), size.height()]
    }

    /// The camera that draws it; depth is 0 without geometry. `None` for the face of a cube, which the viewer does not show.
    fn camera(&self) -> Option<Camera> {
        let [width, height] = self.size().map(f64::from);
        let projection = match *self.frame.projection() {
            Projection::Perspective(camera) => {
                let [right, up, forward] = camera.axes();
                let high = (0.5 * camera.vertical_fov_deg.to_radians()).tan();
                let across = high * width / height;
                airlight_gpu::Projection::Perspective {
                    world_from_clip: Mat4::from_cols(
                        (right * across).as_vec3().extend(0.0),
                        (up * high).as_vec3().extend(0.0),
                        Vec4::new(0.0, 0.0, 0.0, 1.0 / NEAR_M),
                        forward.as_vec3().extend(0.0),
                    ),
                    far_depth: 0.0,
                }
            }
            Projection::AngularFisheye(fisheye) => {
                let largest_rad = 0.5 * fisheye.field_of_view_deg.to_radians();
                let side = width.min(height);
                airlight_gpu::Projection::Fisheye {
                    axes: fisheye.axes(),
                    half_angles_rad: [width, height].map(|v| (largest_rad * v / side) as f32),
                    largest_rad: largest_rad as f32,
                }
            }
            Projection::Equirectangular { center_azimuth_deg } => {
                airlight_gpu::Projection::Equirectangular { center_azimuth_deg }
            }
            _ => return None,
        };
        Camera::new(projection, self.exposure).ok()
    }
}

/// The tone settings of a scene's output. Values that are out of range count as not set.
pub fn tone_of(output: &OutputSpec) -> ToneSettings {
    let curve = match tone_curve(output) {
        tone::ToneCurve::Agx(_) => ToneCurve::Agx,
        tone::ToneCurve::Clip => ToneCurve::Clip,
        tone::ToneCurve::Camera(camera) => ToneCurve::Camera {
            contrast: camera.contrast as f32,
            saturation: camera.saturation as f32,
        },
        _ => ToneCurve::default(),
    };
    let settings = ToneSettings::new(1.0, curve).unwrap_or_default();
    match output.white_balance_k.map(WhiteBalance::new) {
        Some(Ok(balance)) => settings.with_colour_map(balance.matrix()),
        _ => Ok(settings),
    }
    .unwrap_or(settings)
}

/// The same on the processor, for a factor on light in cd/m^2; `None` for settings out of range.
pub fn tone_mapper(output: &OutputSpec, exposure: f32) -> Option<ToneMapper> {
    let balance = output
        .white_balance_k
        .and_then(|k| WhiteBalance::new(k).ok());
    let mapper = ToneMapper::new(exposure, tone_curve(output)).ok()?;
    Some(mapper.with_white_balance(balance))
}

/// Draws frames.
#[derive(Debug)]
pub struct Picture {
    device: wgpu::Device,
    queue: wgpu::Queue,
    sky: SkyPasses,
    /// Draws ground, once there are heights.
    terrain: Option<TerrainPass>,
    /// Height of the eye above the ground of the planet, and the radius of the planet, m.
    eye_m: [f64; 2],
    tone: TonePass,
    targets: Option<Targets>,
    timers: Option<PassTimers>,
}

/// Textures of one size.
#[derive(Debug)]
struct Targets {
    size: [u32; 2],
    light: wgpu::Texture,
    light_view: wgpu::TextureView,
    depth: wgpu::TextureView,
    /// Whether the depth is that of ground, and has the format of a colour.
    has_ground: bool,
    shown_view: wgpu::TextureView,
}

impl Picture {
    /// Makes the pipelines.
    pub fn new(device: &wgpu::Device, queue: &wgpu::Queue) -> Result<Self, SkyRendererError> {
        Ok(Self {
            device: device.clone(),
            queue: queue.clone(),
            sky: SkyPasses::new(device, queue, LIGHT)?,
            terrain: None,
            eye_m: [0.0; 2],
            tone: TonePass::new(device, SHOWN)?,
            targets: None,
            timers: None,
        })
    }

    /// Draws with this light from now on.
    pub fn set_light(&mut self, light: &Light) {
        self.sky.set_tables(&light.tables);
        let view = &light.tables.first.sky.view;
        self.eye_m = [view.height_m, view.ground_radius_m].map(f64::from);
    }

    /// Draws these lights around the eye in the fog from now on.
    ///
    /// # Errors
    /// [`SkyRendererError`] for invalid lights, and for too many.
    pub fn set_lights(&mut self, lights: &[FogLight<[f32; 3]>]) -> Result<(), SkyRendererError> {
        self.sky.set_lights(lights)
    }

    /// Draws ground of these heights from now on, in pictures that have any.
    ///
    /// # Errors
    /// [`SkyRendererError`] for a device that cannot draw it.
    pub fn set_heights(&mut self, heights: &HeightField) -> Result<(), SkyRendererError> {
        let mut pass = match self.terrain.take() {
            Some(pass) => pass,
            None => TerrainPass::new(&self.device, &self.queue, LIGHT)?,
        };
        pass.set_heights(heights);
        self.terrain = Some(pass);
        Ok(())
    }

    /// Draws a picture. True if the texture of [`Self::shown`] is a new one.
    pub fn draw(&mut self, shot: &Shot) -> bool {
        let fits = |targets: &Targets| {
            targets.size == shot.size() && targets.has_ground == shot.ground.is_some()
        };
        let is_new = !self.targets.as_ref().is_some_and(fits);
        if is_new {
            self.targets = Some(self.new_targets(shot));
        }
        let (targets, mut timers) = (self.targets.take(), self.timers.take());
        let free = timers.as_ref().filter(|timers| !timers.is_reading());
        let is_timed = free.is_some();
        if let Some(targets) = &targets {
            self.draw_into(targets, shot, free);
        }
        if let Some(timers) = timers.as_mut().filter(|_| is_timed) {
            timers.read();
        }
        (self.targets, self.timers) = (targets, timers);
        is_new
    }

    /// Times the passes of pictures from now on, or no longer. False if the device has no timers.
    pub fn set_timed(&mut self, is_timed: bool) -> bool {
        let timers = || PassTimers::new(&self.device, &self.queue, PASSES);
        self.timers = is_timed.then(timers).flatten();
        self.timers.is_some() == is_timed
    }

    /// Times of the passes of the last picture that was timed, once they are there.
    pub fn take_times(&mut self) -> Option<PassTimes> {
        PassTimes::take(self.timers.as_mut()?, &self.device)
    }

    /// Whether times are on their way from the device.
    pub fn awaits_times(&self) -> bool {
        self.timers.as_ref().is_some_and(PassTimers::is_reading)
    }

    fn draw_into(&mut self, targets: &Targets, shot: &Shot, timers: Option<&PassTimers>) {
        let mut encoder = self
            .device
            .create_command_encoder(&wgpu::CommandEncoderDescriptor {
                label: Some("airlight viewer"),
            });
        let stamp = |encoder: &mut wgpu::CommandEncoder, passes| {
            if let Some(timers) = timers {
                timers.stamp(encoder, passes);
            }
        };
        stamp(&mut encoder, 0);
        clear(&mut encoder, targets);
        let camera = shot.camera();
        let shadows = camera
            .as_ref()
            .and_then(|camera| self.draw_ground(&mut encoder, targets, shot, camera));
        stamp(&mut encoder, 1);
        if let Some(camera) = &camera {
            let (light, depth) = (&targets.light_view, &targets.depth);
            let shadows = shadows.as_ref();
            self.sky
                .record_shadowed(&mut encoder, light, depth, camera, shadows);
        }
        stamp(&mut encoder, 2);
        self.tone.record(
            &mut encoder,
            &targets.light_view,
            &targets.shown_view,
            &shot.tone,
        );
        stamp(&mut encoder, 3);
        self.queue.submit([encoder.finish()]);
    }

    /// Draws the ground. The shadows that it throws into air and fog, if there are any.
    fn draw_ground(
        &mut self,
        encoder: &mut wgpu::CommandEncoder,
        targets: &Targets,
        shot: &Shot,
        camera: &Camera,
    ) -> Option<SunShadows> {
        let view = self.terrain_view(shot.ground.as_ref()?)?;
        let pass = self.terrain.as_mut()?;
        let (light, depth) = (&targets.light_view, &targets.depth);
        pass.record(encoder, light, depth, camera, &view);
        pass.shadows(encoder, &view).filter(|_| HAS_SHADOWS)
    }

    /// Height of the eye above the ground of the planet, and the radius of the planet, m.
    pub fn eye_m(&self) -> [f64; 2] {
        self.eye_m
    }

    /// The ground as it is drawn; `None` before the first light.
    pub fn terrain_view(&self, ground: &Ground) -> Option<TerrainView> {
        let [height_m, planet_radius_m] = self.eye_m;
        let [east_m, south_m] = ground.place_m;
        let eye_m = DVec3::new(east_m, height_m, south_m);
        let albedos = [LEVEL_ALBEDO, STEEP_ALBEDO];
        TerrainView::new(eye_m, planet_radius_m, *self.sky.lighting()?, albedos).ok()
    }

    /// What is shown: signals of sRGB.
    pub fn shown(&self) -> Option<&wgpu::TextureView> {
        self.targets.as_ref().map(|targets| &targets.shown_view)
    }

    /// Red, green and blue of the last picture, exposed.
    ///
    /// # Errors
    /// A sentence where the device does not return them.
    #[cfg(not(target_arch = "wasm32"))]
    pub fn light(&self) -> Result<Vec<[f32; 3]>, String> {
        match &self.targets {
            Some(targets) => self.light_in(targets),
            None => Ok(Vec::new()),
        }
    }

    /// Red, green and blue of a picture of any size, exposed, which is not shown.
    ///
    /// # Errors
    /// A sentence where the device cannot draw it or does not return it.
    #[cfg(not(target_arch = "wasm32"))]
    pub fn light_of(&mut self, shot: &Shot) -> Result<Vec<[f32; 3]>, String> {
        let targets = self.drawn_targets(shot)?;
        self.light_in(&targets)
    }

    /// The same without waiting for the device; `wake` is called when it is there.
    ///
    /// # Errors
    /// A sentence where the device cannot draw it.
    #[cfg(target_arch = "wasm32")]
    pub fn pending_light_of(
        &mut self,
        shot: &Shot,
        wake: impl FnOnce() + Send + 'static,
    ) -> Result<airlight_gpu::PendingPixels, String> {
        let targets = self.drawn_targets(shot)?;
        let light = &targets.light;
        Ok(airlight_gpu::PendingPixels::of(
            &self.device,
            &self.queue,
            light,
            wake,
        ))
    }

    /// Targets of their own with a shot.
    fn drawn_targets(&mut self, shot: &Shot) -> Result<Targets, String> {
        let largest = self.device.limits().max_texture_dimension_2d;
        let [width, height] = shot.size();
        if width.max(height) > largest {
            return Err(format!(
                "expected at most {largest} pixels on a side on this graphics device, got {width} x {height}"
            ));
        }
        let targets = self.new_targets(shot);
        self.draw_into(&targets, shot, None);
        Ok(targets)
    }

    #[cfg(not(target_arch = "wasm32"))]
    fn light_in(&self, targets: &Targets) -> Result<Vec<[f32; 3]>, String> {
        airlight_gpu::read_rgb(&self.device, &self.queue, &targets.light)
            .map_err(|error| error.to_string())
    }

    fn new_targets(&self, shot: &Shot) -> Targets {
        let [width, height] = shot.size();
        let has_ground = shot.ground.is_some();
        let texture = |format, usage| {
            self.device.create_texture(&wgpu::TextureDescriptor {
                label: Some("airlight viewer"),
                size: wgpu::Extent3d {
                    width,
                    height,
                    depth_or_array_layers: 1,
                },
                mip_level_count: 1,
                sample_count: 1,
                dimension: wgpu::TextureDimension::D2,
                format,
                usage: usage
                    | wgpu::TextureUsages::RENDER_ATTACHMENT
                    | wgpu::TextureUsages::TEXTURE_BINDING,
                view_formats: &[],
            })
        };
        let view =
            |texture: &wgpu::Texture| texture.create_view(&wgpu::TextureViewDescriptor::default());
        let copied = wgpu::TextureUsages::COPY_SRC;
        let depth = if has_ground { GROUND_DEPTH } else { DEPTH };
        let light = texture(LIGHT, copied);
        Targets {
            size: [width, height],
            light_view: view(&light),
            light,
            depth: view(&texture(depth, wgpu::TextureUsages::empty())),
            has_ground,
            shown_view: view(&texture(SHOWN, copied)),
        }
    }
}

/// Starts a frame: black, without geometry.
fn clear(encoder: &mut wgpu::CommandEncoder, targets: &Targets) {
    let cleared = |view| {
        Some(wgpu::RenderPassColorAttachment {
            view,
            depth_slice: None,
            resolve_target: None,
            ops: wgpu::Operations {
                load: wgpu::LoadOp::Clear(wgpu::Color::TRANSPARENT),
                store: wgpu::StoreOp::Store,
            },
        })
    };
    let colours = [cleared(&targets.light_view), cleared(&targets.depth)];
    let depth = wgpu::RenderPassDepthStencilAttachment {
        view: &targets.depth,
        depth_ops: Some(wgpu::Operations {
            load: wgpu::LoadOp::Clear(0.0),
            store: wgpu::StoreOp::Store,
        }),
        stencil_ops: None,
    };
    let (colours, depth) = match targets.has_ground {
        true => (&colours[..], None),
        false => (&colours[..1], Some(depth)),
    };
    encoder.begin_render_pass(&wgpu::RenderPassDescriptor {
        label: Some("airlight viewer"),
        color_attachments: colours,
        depth_stencil_attachment: depth,
        timestamp_writes: None,
        occlusion_query_set: None,
        multiview_mask: None,
    });
}

#[cfg(test)]
mod tests {
    use super::*;
    use airlight::Named;
    use airlight::scene::ToneKind;
    use half::f16;

    const SIDE: u32 = 64;

    /// Light from black to far beyond white, of all hues, some outside the gamut.
    fn light() -> Vec<[f32; 3]> {
        let channel = |k: u32, c: u32| {
            let tint = ((0.37 * k as f32) + 2.1 * c as f32).sin();
            let brightness = 10f32.powf(8.0 * k as f32 / (SIDE * SIDE) as f32 - 5.0);
            f16::from_f32(brightness * (0.8 + tint)).to_f32()
        };
        let pixel = |k| std::array::from_fn(|c| channel(k, c as u32));
        (0..SIDE * SIDE).map(pixel).collect()
    }

    fn texture(
        device: &wgpu::Device,
        format: wgpu::TextureFormat,
        usage: wgpu::TextureUsages,
    ) -> wgpu::Texture {
        device.create_texture(&wgpu::TextureDescriptor {
            label: None,
            size: wgpu::Extent3d {
                width: SIDE,
                height: SIDE,
                depth_or_array_layers: 1,
            },
            mip_level_count: 1,
            sample_count: 1,
            dimension: wgpu::TextureDimension::D2,
            format,
            usage,
            view_formats: &[],
        })
    }

    /// The pass on the device against the tone mapper of picture files, for the same settings of a scene, dither included.
    #[test]
    fn pictures_are_shown_as_files_are_written() {
        let instance = wgpu::Instance::new(wgpu::InstanceDescriptor {
            backends: wgpu::Backends::VULKAN,
            ..wgpu::InstanceDescriptor::new_without_display_handle()
        });
        let adapter = instance.request_adapter(&wgpu::RequestAdapterOptions::default());
        let adapter = pollster::block_on(adapter).expect("a Vulkan device");
        let device = adapter.request_device(&wgpu::DeviceDescriptor::default());
        let (device, queue) = pollster::block_on(device).unwrap();
        let light = light();
        let source = texture(
            &device,
            LIGHT,
            wgpu::TextureUsages::COPY_DST | wgpu::TextureUsages::TEXTURE_BINDING,
        );
        let halves = light.iter().flat_map(|[r, g, b]| [*r, *g, *b, 1.0]);
        let bytes: Vec<u8> = halves
            .flat_map(|value| f16::from_f32(value).to_ne_bytes())
            .collect();
        let layout = wgpu::TexelCopyBufferLayout {
            offset: 0,
            bytes_per_row: Some(8 * SIDE),
            rows_per_image: None,
        };
        queue.write_texture(source.as_image_copy(), &bytes, layout, source.size());
        let target = texture(
            &device,
            SHOWN,
            wgpu::TextureUsages::RENDER_ATTACHMENT | wgpu::TextureUsages::COPY_SRC,
        );
        let pass = TonePass::new(&device, SHOWN).unwrap();
        let camera = |contrast, saturation, kelvin| OutputSpec {
            tone: Some(ToneKind::Camera),
            tone_contrast: contrast,
            saturation,
            white_balance_k: kelvin,
            ..Default::default()
        };
        let mut outputs = vec![
            OutputSpec::default(),
            camera(Some(2.0), Some(1.6), Some(4000.0)),
            camera(Some(0.7), Some(0.0), Some(12_000.0)),
        ];
        outputs.extend(ToneKind::ALL.iter().map(|kind| OutputSpec {
            tone: Some(*kind),
            ..Default::default()
        }));
        for output in outputs {
            let mut encoder = device.create_command_encoder(&Default::default());
            let [source, target_view] =
                [&source, &target].map(|texture| texture.create_view(&Default::default()));
            pass.record(&mut encoder, &source, &target_view, &tone_of(&output));
            queue.submit([encoder.finish()]);
            let shown = airlight_gpu::read_texture(&device, &queue, &target).unwrap();
            let mapper = tone_mapper(&output, 1.0).unwrap();
            let row = 3 * SIDE as usize;
            let mut right = vec![0; row * SIDE as usize];
            let rows = light.as_flattened().chunks(row);
            for (y, (linear, out)) in rows.zip(right.chunks_mut(row)).enumerate() {
                mapper.row_to_u8(y as u32, linear, out);
            }
            let grey = right.iter().filter(|level| (20..236).contains(*level));
            assert!(grey.count() > 1000, "{output:?}");
            let shown = shown
                .as_chunks::<4>()
                .0
                .iter()
                .flat_map(|p| [p[0], p[1], p[2]]);
            let apart: Vec<u8> = shown.zip(&right).map(|(a, b)| a.abs_diff(*b)).collect();
            let largest = apart.iter().max().unwrap();
            let differ = apart.iter().filter(|d| **d > 0).count();
            println!(
                "{:?}: largest {largest}, {differ} of {}",
                output.tone,
                apart.len()
            );
            assert!(
                *largest <= 1 && 20 * differ < apart.len(),
                "{output:?}: {largest} {differ}"
            );
        }
    }
}
