//! [`SkyPasses`].

use crate::camera::{Camera, Projection};
use crate::device_loss::is_device_lost;
use crate::environment::EnvironmentMap;
use crate::error::SkyRendererError;
use crate::fog::{self, MOST_FOG_LAYERS};
use crate::frame_tables::{FrameTables, SourceTables};
use crate::gpu_tables::FLAT;
use crate::lighting::Lighting;
use crate::lights;
use crate::pass::{
    AT_ONCE_FEATURES, CORNER, Pass, UNIFORM, bind_group, draw, group_layout, single, texture,
    uniform,
};
use crate::shadows::{Caster, SunShadows};
use crate::sky;
use airlight::fog::lights::Light;
use airlight::glam::DVec3;
use airlight_shaders::twins::lights::{ExponentialFog, LocalLight};
use airlight_shaders::{Part, source};
use std::sync::OnceLock;

/// Draws air, sky and sun over frames, with tables that a [`SkySolver`](crate::SkySolver) has filled.
#[derive(Debug)]
pub struct SkyPasses {
    device: wgpu::Device,
    queue: wgpu::Queue,
    sky_layout: wgpu::BindGroupLayout,
    fog_layout: wgpu::BindGroupLayout,
    light_layout: wgpu::BindGroupLayout,
    frame_layout: wgpu::BindGroupLayout,
    sky_pass: Pass,
    disc_pass: wgpu::RenderPipeline,
    fog_pass: Pass,
    light_pass: wgpu::RenderPipeline,
    /// Of shadows in air and in fog, once there are any.
    shadow_passes: [OnceLock<[wgpu::RenderPipeline; 2]>; Caster::ALL.len()],
    target_format: wgpu::TextureFormat,
    has_discs: bool,
    lights: Vec<LocalLight>,
    drawn: Option<Drawn>,
}

/// What frames are drawn with.
#[derive(Debug)]
struct Drawn {
    first: DrawnSource,
    second: Option<DrawnSource>,
    fog: Option<DrawnFog>,
    lighting: Lighting,
}

/// Light of a source in air, and in fog if there is any.
#[derive(Debug)]
struct DrawnSource {
    sky: wgpu::BindGroup,
    /// Direction to the disc and its angular radius, rad; none below the horizon.
    disc: Option<(DVec3, f64)>,
    /// What the air scatters once.
    sky_once: Option<wgpu::BindGroup>,
    /// All light of the fog, and what it scatters once.
    fog: Option<[wgpu::BindGroup; 2]>,
}

/// A fog, and the lights in it if there are any.
#[derive(Debug)]
struct DrawnFog {
    eye_height_m: f32,
    around_lights: Option<ExponentialFog>,
    lights: Option<wgpu::BindGroup>,
}

impl SkyPasses {
    /// Features of a device with which a frame takes half as many passes: blending with two colours. To request where the adapter has
    /// them.
    pub const OPTIONAL_FEATURES: wgpu::Features = AT_ONCE_FEATURES;

    /// Makes the pipelines for targets of a format: linear, and blendable, such as `Rgba16Float`.
    ///
    /// # Errors
    /// [`SkyRendererError::Format`] for a target that cannot be blended, and [`SkyRendererError::DeviceLost`].
    pub fn new(
        device: &wgpu::Device,
        queue: &wgpu::Queue,
        target_format: wgpu::TextureFormat,
    ) -> Result<Self, SkyRendererError> {
        if is_device_lost(device) {
            return Err(SkyRendererError::DeviceLost);
        }
        let features = target_format.guaranteed_format_features(device.features());
        let blendable = wgpu::TextureFormatFeatureFlags::BLENDABLE;
        if !features.flags.contains(blendable) {
            return Err(SkyRendererError::Format(target_format));
        }
        let sky_layout = sky::layout(device);
        let fog_layout = fog::layout(device);
        let light_layout = lights::layout(device);
        let frame_layout = frame_layout(device);
        let pass = |first: &wgpu::BindGroupLayout, shader: &str| {
            Pass::new(device, [first, &frame_layout], shader, target_format)
        };
        Ok(Self {
            sky_pass: pass(&sky_layout, &sky_shader()),
            fog_pass: pass(&fog_layout, &fog_shader()),
            disc_pass: single(
                device,
                &[&sky_layout, &frame_layout],
                (&sky_shader(), "disc"),
                target_format,
            ),
            light_pass: single(
                device,
                &[&light_layout, &frame_layout],
                (&light_shader(), "add"),
                target_format,
            ),
            shadow_passes: [const { OnceLock::new() }; Caster::ALL.len()],
            target_format,
            has_discs: true,
            device: device.clone(),
            queue: queue.clone(),
            sky_layout,
            fog_layout,
            light_layout,
            frame_layout,
            lights: Vec::new(),
            drawn: None,
        })
    }

    /// These passes on another device, as after a loss of theirs: with the same target, lights and discs, but without tables.
    ///
    /// # Errors
    /// As [`Self::new`].
    pub fn on_device(
        &self,
        device: &wgpu::Device,
        queue: &wgpu::Queue,
    ) -> Result<Self, SkyRendererError> {
        Ok(Self {
            has_discs: self.has_discs,
            lights: self.lights.clone(),
            ..Self::new(device, queue, self.target_format)?
        })
    }

    /// The device that draws.
    pub(crate) fn device(&self) -> &wgpu::Device {
        &self.device
    }

    /// Uploads tables, with which frames are drawn from now on.
    pub fn set_tables(&mut self, tables: &FrameTables) {
        self.drawn = Some(Drawn {
            first: self.upload(&tables.first),
            second: tables.second.as_ref().map(|second| self.upload(second)),
            fog: tables.first.fog.as_ref().map(|fog| DrawnFog {
                eye_height_m: fog.eye_height_m,
                around_lights: fog.around_lights,
                lights: None,
            }),
            lighting: tables.lighting,
        });
        self.upload_lights();
    }

    fn upload(&self, source: &SourceTables) -> DrawnSource {
        let device = (&self.device, &self.queue);
        let fog = source.fog.as_ref();
        let (sky, sky_once) = sky::upload(device, &self.sky_layout, source);
        DrawnSource {
            sky,
            disc: source.disc_above_horizon(),
            sky_once,
            fog: fog.map(|fog| fog.upload(device, &self.fog_layout)),
        }
    }

    /// Sets whether frames show the discs of sun and moon, as they do at first. Of several planets in one frame only the passes of the farthest one
    /// should: nearer planets then hide and dim the discs as they do the rest of the frame.
    pub fn set_discs(&mut self, has_discs: bool) {
        self.has_discs = has_discs;
    }

    /// Sets the lights that shine in the fog from now on, at most [`MOST_LIGHTS`](crate::MOST_LIGHTS), instead of those before. Their
    /// positions are around the eye, y up; light is in cd and cd/m^2. Nothing is computed on the processor, so that they may move in each
    /// frame. The fog scatters their light once, as Henyey and Greenstein's function of its mean cosine does. They are not drawn
    /// themselves, add nothing to [`SkyPasses::lighting`] and environment maps, and shine only in fog that is exponential
    /// above the ground.
    ///
    /// # Errors
    /// [`SkyRendererError`] for invalid lights, and for more than there may be.
    pub fn set_lights(&mut self, lights: &[Light<[f32; 3]>]) -> Result<(), SkyRendererError> {
        self.lights = lights::local_lights(lights)?;
        self.upload_lights();
        Ok(())
    }

    fn upload_lights(&mut self) {
        let Some(fog) = self.drawn.as_mut().and_then(|drawn| drawn.fog.as_mut()) else {
            return;
        };
        let shining = fog.around_lights.filter(|_| !self.lights.is_empty());
        fog.lights = shining.map(|around| {
            let fog = (&around, fog.eye_height_m);
            lights::upload(&self.device, &self.light_layout, fog, &self.lights)
        });
    }

    /// The light of sun and sky at the eye that frames are drawn for; `None` before the first tables.
    pub fn lighting(&self) -> Option<&Lighting> {
        self.drawn.as_ref().map(|drawn| &drawn.lighting)
    }

    /// Records the air, sky and sun of a frame into `target`, which holds what the program has rendered, with its depth. Before the
    /// first tables it draws nothing.
    pub fn record(
        &self,
        encoder: &mut wgpu::CommandEncoder,
        target: &wgpu::TextureView,
        depth: &wgpu::TextureView,
        camera: &Camera,
    ) {
        self.record_shadowed(encoder, target, depth, camera, None);
    }

    /// As [`SkyPasses::record`], with shadows in air and fog: without the sunlight that these would scatter once where the sun is
    /// hidden. Light that is scattered more often, and that of a second source, have no shadows. Tables of a solver without
    /// [`SkySolver::with_shadows`](crate::SkySolver::with_shadows) have no shadows in air.
    pub fn record_shadowed(
        &self,
        encoder: &mut wgpu::CommandEncoder,
        target: &wgpu::TextureView,
        depth: &wgpu::TextureView,
        camera: &Camera,
        shadows: Option<&SunShadows>,
    ) {
        if let Some(drawn) = &self.drawn {
            let passes = Passes {
                sky: &self.sky_pass,
                disc: Some(&self.disc_pass).filter(|_| self.has_discs),
                fog: &self.fog_pass,
                lights: Some(&self.light_pass),
                shadows: shadows.map(|shadows| (self.shadow_passes(shadows.caster()), shadows)),
            };
            self.draw(
                drawn,
                &passes,
                encoder,
                (target, wgpu::LoadOp::Load),
                depth,
                camera,
            );
        }
    }

    /// The passes of shadows of a caster, in air and in fog.
    fn shadow_passes(&self, caster: Caster) -> &[wgpu::RenderPipeline; 2] {
        self.shadow_passes[caster as usize].get_or_init(|| {
            let shadow_layout = caster.layout(&self.device);
            [
                (&self.sky_layout, caster.in_air(&sky_shader())),
                (&self.fog_layout, caster.in_fog(&fog_shader())),
            ]
            .map(|(first, shader)| {
                let groups = [first, &self.frame_layout, &shadow_layout];
                single(
                    &self.device,
                    &groups,
                    (&shader, "shade"),
                    self.target_format,
                )
            })
        })
    }

    /// A map of light from all directions, with faces of `side` texels on a side: a power of two from 8 to 2048.
    ///
    /// # Errors
    /// [`SkyRendererError::EnvironmentSide`] for another side.
    pub fn environment_map(&self, side: u32) -> Result<EnvironmentMap, SkyRendererError> {
        let groups = [&self.sky_layout, &self.fog_layout].map(|first| [first, &self.frame_layout]);
        let shaders = [sky_shader(), fog_shader()];
        EnvironmentMap::new(&self.device, side, groups, [&shaders[0], &shaders[1]])
    }

    /// Records the light of sky, ground and fog around the eye into a map, in cd/m^2 times an exposure. Before the first tables it records
    /// nothing.
    ///
    /// # Errors
    /// [`SkyRendererError::OutOfRange`] for an exposure that is negative or not finite.
    pub fn record_environment(
        &self,
        encoder: &mut wgpu::CommandEncoder,
        map: &mut EnvironmentMap,
        exposure: f32,
    ) -> Result<(), SkyRendererError> {
        let faces = map.faces().map(|(target, world_from_clip)| {
            let perspective = Projection::Perspective {
                world_from_clip,
                far_depth: 0.0,
            };
            Ok((target, Camera::new(perspective, exposure)?))
        });
        let faces: Vec<_> = faces.collect::<Result<_, SkyRendererError>>()?;
        let Some(drawn) = &self.drawn else {
            return Ok(());
        };
        map.clear_depth(encoder);
        let black = wgpu::LoadOp::Clear(wgpu::Color::BLACK);
        for (target, camera) in faces {
            let [sky, fog] = map.passes();
            let passes = Passes {
                sky,
                disc: None,
                fog,
                lights: None,
                shadows: None,
            };
            self.draw(
                drawn,
                &passes,
                encoder,
                (&target, black),
                map.depth(),
                &camera,
            );
        }
        map.filter(encoder);
        Ok(())
    }

    /// What passes know of the pixels of a frame. A group for each frame, as an encoder may record several.
    fn frame_group(&self, camera: &Camera, depth: &wgpu::TextureView) -> wgpu::BindGroup {
        let numbers = uniform(&self.device, "airlight camera", &camera.numbers());
        let depth = wgpu::BindingResource::TextureView(depth);
        let resources = [numbers.as_entire_binding(), depth];
        bind_group(
            &self.device,
            &self.frame_layout,
            "airlight frame",
            &resources,
        )
    }

    /// Records the passes of a frame.
    fn draw(
        &self,
        drawn: &Drawn,
        passes: &Passes<'_>,
        encoder: &mut wgpu::CommandEncoder,
        (target, load): (&wgpu::TextureView, wgpu::LoadOp<wgpu::Color>),
        depth: &wgpu::TextureView,
        camera: &Camera,
    ) {
        let frame = self.frame_group(camera, depth);
        let mut pass = encoder.begin_render_pass(&wgpu::RenderPassDescriptor {
            label: Some("airlight sky"),
            color_attachments: &[Some(wgpu::RenderPassColorAttachment {
                view: target,
                depth_slice: None,
                resolve_target: None,
                ops: wgpu::Operations {
                    load,
                    store: wgpu::StoreOp::Store,
                },
            })],
            depth_stencil_attachment: None,
            timestamp_writes: None,
            occlusion_query_set: None,
            multiview_mask: None,
        });
        pass.set_bind_group(1, &frame, &[]);
        let (first, second) = (&drawn.first, drawn.second.as_ref());
        let shade =
            |pass: &mut wgpu::RenderPass<'_>, medium: usize, once: Option<&wgpu::BindGroup>| {
                if let (Some((pipelines, shadows)), Some(once)) = (passes.shadows, once) {
                    pass.set_bind_group(2, shadows.group(), &[]);
                    draw(pass, &pipelines[medium], once);
                }
            };
        passes.sky.draw(&mut pass, &first.sky);
        if let Some(second) = second {
            passes.sky.add(&mut pass, &second.sky);
        }
        for source in [Some(first), second].into_iter().flatten() {
            passes.draw_disc(&mut pass, source, camera, target.texture());
        }
        shade(&mut pass, 0, first.sky_once.as_ref());
        if let Some([fog, once]) = &first.fog {
            passes.fog.draw(&mut pass, fog);
            if let Some([fog, _]) = second.and_then(|source| source.fog.as_ref()) {
                passes.fog.add(&mut pass, fog);
            }
            shade(&mut pass, 1, Some(once));
        }
        let lights = drawn.fog.as_ref().and_then(|fog| fog.lights.as_ref());
        if let (Some(pipeline), Some(lights)) = (passes.lights, lights) {
            draw(&mut pass, pipeline, lights);
        }
    }
}

/// Pipelines of a frame.
struct Passes<'a> {
    sky: &'a Pass,
    disc: Option<&'a wgpu::RenderPipeline>,
    fog: &'a Pass,
    lights: Option<&'a wgpu::RenderPipeline>,
    /// Of shadows in air and in fog.
    shadows: Option<(&'a [wgpu::RenderPipeline; 2], &'a SunShadows)>,
}

impl Passes<'_> {
    /// Adds the disc of a source to the pixels that may see it.
    fn draw_disc(
        &self,
        pass: &mut wgpu::RenderPass<'_>,
        source: &DrawnSource,
        camera: &Camera,
        target: &wgpu::Texture,
    ) {
        let (Some(pipeline), Some((towards, radius_rad))) = (self.disc, source.disc) else {
            return;
        };
        // The level of a view is unknown.
        if target.mip_level_count() > 1 {
            draw(pass, pipeline, &source.sky);
            return;
        }
        let (width, height) = (target.width(), target.height());
        if let Some([x, y, across, down]) = camera.rectangle([width, height], towards, radius_rad) {
            pass.set_scissor_rect(x, y, across, down);
            draw(pass, pipeline, &source.sky);
            pass.set_scissor_rect(0, 0, width, height);
        }
    }
}

/// What passes know of their pixels.
const FRAME: &str = concat!(include_str!("camera.wgsl"), include_str!("frame.wgsl"));

/// The passes of the sky.
fn sky_shader() -> String {
    source(&[Part::SkyTables, Part::Disc, Part::Shadows])
        + CORNER
        + FRAME
        + include_str!("sky.wgsl")
}

/// The passes of the fog.
fn fog_shader() -> String {
    source(&[Part::Fog, Part::FogTable, Part::Shadows])
        + CORNER
        + FRAME
        + &format!("const MOST_FOG_LAYERS: u32 = {MOST_FOG_LAYERS}u;\n")
        + include_str!("fog.wgsl")
}

/// The pass of lights in fog.
fn light_shader() -> String {
    source(&[Part::Lights]) + CORNER + FRAME + include_str!("lights.wgsl")
}

/// Layout of the second group: camera and depth.
fn frame_layout(device: &wgpu::Device) -> wgpu::BindGroupLayout {
    group_layout(device, "airlight frame", &[UNIFORM, texture(FLAT, false)])
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::Fog;
    use crate::frame_tables::SkySolver;
    use crate::headless::{FORMAT, Frame, Geometry, Headless};
    use crate::pass::{at_once_shader, medium_shader};
    use airlight::atmosphere::Preset;
    use airlight::axes;
    use airlight::sky::{SkySettings, SunCoverage};
    use airlight::spectrum::RgbSpace;
    use airlight_shaders::{Cost, Counts, costs, counting};

    /// What a pixel costs at most in each pass: as the book states it.
    #[test]
    fn pixels_cost_what_the_book_states() {
        let book = include_str!("../../../docs/src/gpu.md");
        let of = |shader: &str, entry: &str| -> Cost {
            let all = costs(shader).unwrap();
            let named = all.into_iter().find(|(name, _)| name == entry);
            named.expect("an entry point").1
        };
        for (shader, name) in [(sky_shader(), "sky"), (fog_shader(), "fog")] {
            let shader = medium_shader(&shader);
            let at_once = of(&at_once_shader(&shader), "dim_and_add");
            let [dim, add] = ["dim", "add"].map(|entry| of(&shader, entry));
            let row = format!("| {name} | {at_once} | {dim} | {add} |");
            assert!(book.contains(&row), "{row}");
        }
        for (shader, entry, name) in [
            (sky_shader(), "disc", "disc"),
            (light_shader(), "add", "lights"),
            (
                Caster::Ground.in_air(&sky_shader()),
                "shade",
                "shadows in air",
            ),
            (
                Caster::Ground.in_fog(&fog_shader()),
                "shade",
                "shadows in fog",
            ),
        ] {
            let row = format!("| {name} | | | {} |", of(&shader, entry));
            assert!(book.contains(&row), "{row}");
        }
    }

    /// Pixels on a side of a frame, whose lower half are walls.
    const SIDE: u32 = 1024;

    /// What the passes of a frame evaluate, by shaders that count it while they draw.
    struct Counter {
        gpu: Headless,
        passes: SkyPasses,
        camera: Camera,
        frame: Frame,
        layout: wgpu::BindGroupLayout,
        counts: wgpu::Buffer,
    }

    impl Counter {
        fn new(tables: &FrameTables, towards: DVec3) -> Self {
            let gpu = Headless::new().unwrap();
            let mut passes = SkyPasses::new(&gpu.device, &gpu.queue, FORMAT).unwrap();
            passes.set_tables(tables);
            let frame = Frame::towards(towards.as_vec3(), SIDE);
            let storage = wgpu::BindingType::Buffer {
                ty: wgpu::BufferBindingType::Storage { read_only: false },
                has_dynamic_offset: false,
                min_binding_size: None,
            };
            let usages = [
                wgpu::BufferUsages::STORAGE,
                wgpu::BufferUsages::COPY_SRC,
                wgpu::BufferUsages::COPY_DST,
            ];
            Self {
                layout: group_layout(&gpu.device, "counts", &[storage]),
                counts: gpu.device.create_buffer(&wgpu::BufferDescriptor {
                    label: None,
                    size: Counts::BYTES,
                    usage: usages.into_iter().collect(),
                    mapped_at_creation: false,
                }),
                camera: frame.camera(1e-4).unwrap(),
                passes,
                frame,
                gpu,
            }
        }

        fn drawn(&self) -> &Drawn {
            self.passes.drawn.as_ref().unwrap()
        }

        /// Counts of a pass with its tables, over some pixels.
        fn count(
            &self,
            (shader, entry): (&str, &str),
            (layout, tables): (&wgpu::BindGroupLayout, &wgpu::BindGroup),
            rectangle: [u32; 4],
        ) -> Counts {
            let device = &self.gpu.device;
            let shader = counting(shader, (2, 0), "").unwrap();
            let layouts = [layout, &self.passes.frame_layout, &self.layout];
            let pipeline = single(device, &layouts, (&shader, entry), FORMAT);
            let counts = self.counts.as_entire_binding();
            let counts = bind_group(device, &self.layout, "counts", &[counts]);
            let walls = Geometry {
                colour: [1.0; 3],
                distance_m: &|_, y| if y < SIDE / 2 { f32::INFINITY } else { 5e3 },
            };
            let record = |encoder: &mut wgpu::CommandEncoder,
                          target: &wgpu::TextureView,
                          depth: &wgpu::TextureView| {
                encoder.clear_buffer(&self.counts, 0, None);
                let frame = self.passes.frame_group(&self.camera, depth);
                let mut pass = encoder.begin_render_pass(&wgpu::RenderPassDescriptor {
                    color_attachments: &[Some(wgpu::RenderPassColorAttachment {
                        view: target,
                        depth_slice: None,
                        resolve_target: None,
                        ops: wgpu::Operations::default(),
                    })],
                    ..Default::default()
                });
                let [x, y, width, height] = rectangle;
                pass.set_scissor_rect(x, y, width, height);
                pass.set_bind_group(1, &frame, &[]);
                pass.set_bind_group(2, &counts, &[]);
                draw(&mut pass, &pipeline, tables);
            };
            self.gpu.draw(&self.frame, Some(&walls), record).unwrap();
            let bytes = self.gpu.read_buffer(&self.counts).unwrap();
            Counts::from_bytes(bytes.try_into().unwrap())
        }
    }

    /// Counts in a frame of 1920 x 1080 whose lower half are walls, as the book states them.
    #[test]
    fn frames_evaluate_what_the_book_states() {
        const PIXELS: f64 = 1920.0 * 1080.0;
        let book = include_str!("../../../docs/src/gpu.md");
        let sun_deg = 10.0;
        let settings = SkySettings {
            suns: SunCoverage::near(sun_deg, 2.0),
            ..Default::default()
        };
        let air = Preset::Average.atmosphere();
        let solver = SkySolver::new(&air, &settings, RgbSpace::Srgb).unwrap();
        let sun = axes::direction(140.0, sun_deg);
        let fog = Fog::new(2000.0, 20.0);
        let tables = solver.tables(2.0, sun, Some(&fog)).unwrap();
        let counter = Counter::new(&tables, axes::direction(140.0, 0.0));
        let whole = [0, 0, SIDE, SIDE];
        let drawn = &counter.drawn().first;
        let sky = (&counter.passes.sky_layout, &drawn.sky);
        let fog = (&counter.passes.fog_layout, &drawn.fog.as_ref().unwrap()[0]);
        let at_once = counter.gpu.device.features().contains(AT_ONCE_FEATURES);
        for (name, shader, tables) in [
            ("sky and air", sky_shader(), sky),
            ("a layer of fog", fog_shader(), fog),
        ] {
            let shader = medium_shader(&shader);
            let count = |shader: &str, entry| {
                let counts = counter.count((shader, entry), tables, whole);
                assert_eq!(counts.invocations, SIDE * SIDE);
                [counts.exp, counts.reads].map(|n| f64::from(n) / f64::from(SIDE * SIDE))
            };
            let row = |[exp, reads]: [f64; 2], passes: &str| {
                let [exp, reads] = [exp, reads].map(|each| 1e-6 * PIXELS * each);
                let row = format!("| `airlight-gpu`, {name}{passes} | {exp:.1} | {reads:.1} |");
                println!("{row}");
                assert!(book.contains(&row), "{row}");
            };
            let [dim, add] = ["dim", "add"].map(|entry| count(&shader, entry));
            row([dim[0] + add[0], dim[1] + add[1]], ", in two passes");
            if at_once {
                row(count(&at_once_shader(&shader), "dim_and_add"), "");
            }
        }
        let (towards, radius_rad) = drawn.disc.unwrap();
        let rectangle = counter.camera.rectangle([SIDE; 2], towards, radius_rad);
        let disc = counter.count((&sky_shader(), "disc"), sky, rectangle.unwrap());
        println!("disc: {disc:?}");
        // Some thousandths of what the sky takes.
        assert!((10..100_000).contains(&disc.exp) && (100..100_000).contains(&disc.reads));
    }
}
