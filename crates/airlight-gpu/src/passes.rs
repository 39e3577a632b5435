//! [`SkyPasses`].

use crate::camera::{Camera, Projection};
use crate::environment::EnvironmentMap;
use crate::error::SkyRendererError;
use crate::fog;
use crate::frame_tables::FrameTables;
use crate::gpu_tables::FLAT;
use crate::lighting::Lighting;
use crate::lights;
use crate::pass::{
    CORNER, Pass, UNIFORM, adding, bind_group, draw, group_layout, texture, uniform,
};
use crate::sky;
use airlight::fog::lights::Light;
use airlight_shaders::twins::lights::{ExponentialFog, LocalLight};
use airlight_shaders::{Part, source};

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
    fog_pass: Pass,
    light_pass: wgpu::RenderPipeline,
    lights: Vec<LocalLight>,
    drawn: Option<Drawn>,
}

/// What frames are drawn with.
#[derive(Debug)]
struct Drawn {
    sky: wgpu::BindGroup,
    fog: Option<DrawnFog>,
    lighting: Lighting,
}

/// A fog, and the lights in it if there are any.
#[derive(Debug)]
struct DrawnFog {
    tables: wgpu::BindGroup,
    eye_height_m: f32,
    around_lights: Option<ExponentialFog>,
    lights: Option<wgpu::BindGroup>,
}

impl SkyPasses {
    /// Makes the pipelines for targets of a format: linear, and blendable, such as `Rgba16Float`.
    ///
    /// # Errors
    /// [`SkyRendererError::Format`] for a target that cannot be blended.
    pub fn new(
        device: &wgpu::Device,
        queue: &wgpu::Queue,
        target_format: wgpu::TextureFormat,
    ) -> Result<Self, SkyRendererError> {
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
            light_pass: adding(
                device,
                [&light_layout, &frame_layout],
                &light_shader(),
                target_format,
            ),
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

    /// Uploads tables, with which frames are drawn from now on.
    pub fn set_tables(&mut self, tables: &FrameTables) {
        let device = (&self.device, &self.queue);
        self.drawn = Some(Drawn {
            sky: sky::upload(device, &self.sky_layout, tables),
            fog: tables.fog.as_ref().map(|fog| DrawnFog {
                tables: fog.upload(device, &self.fog_layout),
                eye_height_m: fog.eye_height_m,
                around_lights: fog.around_lights,
                lights: None,
            }),
            lighting: tables.lighting,
        });
        self.upload_lights();
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
        if let Some(drawn) = &self.drawn {
            let passes = [&self.sky_pass, &self.fog_pass];
            self.draw(
                drawn,
                (passes, Some(&self.light_pass)),
                encoder,
                (target, wgpu::LoadOp::Load),
                depth,
                &camera.numbers(),
            );
        }
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
    pub fn record_environment(
        &self,
        encoder: &mut wgpu::CommandEncoder,
        map: &mut EnvironmentMap,
        exposure: f32,
    ) {
        let Some(drawn) = &self.drawn else {
            return;
        };
        map.clear_depth(encoder);
        let black = wgpu::LoadOp::Clear(wgpu::Color::BLACK);
        for (target, world_from_clip) in map.faces() {
            let camera = Camera {
                projection: Projection::Perspective {
                    world_from_clip,
                    far_depth: 0.0,
                },
                exposure,
            };
            let numbers = camera.numbers_without_disc();
            self.draw(
                drawn,
                (map.passes(), None),
                encoder,
                (&target, black),
                map.depth(),
                &numbers,
            );
        }
        map.filter(encoder);
    }

    /// Records the passes of a frame.
    fn draw(
        &self,
        drawn: &Drawn,
        ([sky_pass, fog_pass], light_pass): ([&Pass; 2], Option<&wgpu::RenderPipeline>),
        encoder: &mut wgpu::CommandEncoder,
        (target, load): (&wgpu::TextureView, wgpu::LoadOp<wgpu::Color>),
        depth: &wgpu::TextureView,
        camera: &[f32],
    ) {
        // A buffer for each frame, as an encoder may record several.
        let camera = uniform(&self.device, "airlight camera", camera);
        let frame = bind_group(
            &self.device,
            &self.frame_layout,
            "airlight frame",
            &[
                camera.as_entire_binding(),
                wgpu::BindingResource::TextureView(depth),
            ],
        );
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
        sky_pass.draw(&mut pass, &drawn.sky);
        if let Some(fog) = &drawn.fog {
            fog_pass.draw(&mut pass, &fog.tables);
            if let (Some(pipeline), Some(lights)) = (light_pass, &fog.lights) {
                draw(&mut pass, pipeline, lights);
            }
        }
    }
}

/// What passes know of their pixels.
const FRAME: &str = concat!(include_str!("camera.wgsl"), include_str!("frame.wgsl"));

/// The passes of the sky.
fn sky_shader() -> String {
    source(&[Part::SkyTables]) + CORNER + FRAME + include_str!("sky.wgsl")
}

/// The passes of the fog.
fn fog_shader() -> String {
    source(&[Part::Fog, Part::FogTable]) + CORNER + FRAME + include_str!("fog.wgsl")
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
    use airlight_shaders::{Cost, costs};

    /// What a pixel costs at most in the passes `dim` and `add`: as the README states it.
    #[test]
    fn pixels_cost_what_the_readme_states() {
        let readme = include_str!("../README.md");
        for (shader, name) in [(sky_shader(), "sky"), (fog_shader(), "fog")] {
            let all = costs(&shader).unwrap();
            let of = |entry: &str| -> Cost {
                let named = all.iter().find(|(name, _)| name == entry);
                named.expect("an entry point").1
            };
            let row = format!("| {name} | {} | {} |", of("dim"), of("add"));
            assert!(readme.contains(&row), "{row}");
        }
        let all = costs(&light_shader()).unwrap();
        let (_, add) = all.iter().find(|(name, _)| name == "add").unwrap();
        let row = format!("| lights | none | {add} |");
        assert!(readme.contains(&row), "{row}");
    }
}
