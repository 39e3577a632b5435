//! [`SkyRenderer`].

use crate::camera::Camera;
use crate::environment::EnvironmentMap;
use crate::error::SkyRendererError;
use crate::fog::{self, Fog};
use crate::gpu_tables::bytes;
use crate::lighting::Lighting;
use crate::pass::{CORNER, Pass};
use crate::sky;
use airlight::atmosphere::Atmosphere;
use airlight::glam::DVec3;
use airlight::sky::{Sky, SkySettings, View};
use airlight::spectrum::RgbSpace;
use airlight_shaders::{ColourFit, FogTables, Part, SkyTables, source, wavelength_grid};
use std::panic::resume_unwind;
use std::sync::Arc;
use std::thread::JoinHandle;
use wgpu::util::{BufferInitDescriptor, DeviceExt};

/// Settings of a [`SkyRenderer`].
#[derive(Clone, Debug, PartialEq)]
pub struct SkyRendererSettings {
    /// Format of the target: linear, and blendable, such as `Rgba16Float`.
    pub target_format: wgpu::TextureFormat,
    /// RGB space of the target.
    pub space: RgbSpace,
    /// Settings of the solver. With the default suns it solves once for all suns and heights.
    pub solver: SkySettings,
}

impl SkyRendererSettings {
    /// Linear sRGB in a target of a format.
    pub fn new(target_format: wgpu::TextureFormat) -> Self {
        Self {
            target_format,
            space: RgbSpace::Srgb,
            solver: SkySettings::default(),
        }
    }
}

/// What a [`SkyRenderer`] has computed since it was made.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
#[non_exhaustive]
pub struct Work {
    /// Tables filled and uploaded.
    pub tables: u64,
    /// Frames recorded.
    pub frames: u64,
}

/// Draws air, sky and sun over frames.
#[derive(Debug)]
pub struct SkyRenderer {
    device: wgpu::Device,
    queue: wgpu::Queue,
    sky: Sky,
    fit: Arc<ColourFit>,
    space: RgbSpace,
    sky_layout: wgpu::BindGroupLayout,
    fog_layout: wgpu::BindGroupLayout,
    frame_layout: wgpu::BindGroupLayout,
    sky_pass: Pass,
    fog_pass: Pass,
    fog: Option<Fog>,
    drawn: Option<Drawn>,
    /// Tables that are being filled, and the eye and sun that they are for.
    filling: Option<(JoinHandle<Result<Filled, SkyRendererError>>, Place)>,
    work: Work,
}

/// Height of the eye above sea level, m, and unit vector towards the sun.
type Place = (f64, DVec3);

/// What frames are drawn with.
#[derive(Debug)]
struct Drawn {
    sky: wgpu::BindGroup,
    fog: Option<(wgpu::BindGroup, Fog)>,
    lighting: Lighting,
    place: Place,
}

/// Tables on the CPU.
struct Filled {
    view: View,
    sky: SkyTables,
    fog: Option<(FogTables, Fog)>,
    lighting: Lighting,
}

impl SkyRenderer {
    /// Solves for the light in an atmosphere, which takes a second or more, and makes the pipelines.
    ///
    /// # Errors
    /// [`SkyRendererError`] if the sky cannot be solved, or for a target that cannot be blended.
    pub fn new(
        device: &wgpu::Device,
        queue: &wgpu::Queue,
        atmosphere: &Atmosphere,
        settings: &SkyRendererSettings,
    ) -> Result<Self, SkyRendererError> {
        let format = settings.target_format;
        let features = format.guaranteed_format_features(device.features());
        let blendable = wgpu::TextureFormatFeatureFlags::BLENDABLE;
        if !features.flags.contains(blendable) {
            return Err(SkyRendererError::Format(format));
        }
        let sky = Sky::prepare(atmosphere, &wavelength_grid(), &settings.solver)?;
        let fit = Arc::new(ColourFit::new(atmosphere, settings.solver.suns)?);
        let sky_layout = sky::layout(device);
        let fog_layout = fog::layout(device);
        let frame_layout = frame_layout(device);
        let pass = |first: &wgpu::BindGroupLayout, shader: &str| {
            Pass::new(device, [first, &frame_layout], shader, format)
        };
        let sky_pass = pass(&sky_layout, &sky_shader());
        let fog_pass = pass(&fog_layout, &fog_shader());
        Ok(Self {
            sky_pass,
            fog_pass,
            fog: None,
            device: device.clone(),
            queue: queue.clone(),
            sky,
            fit,
            space: settings.space,
            sky_layout,
            fog_layout,
            frame_layout,
            drawn: None,
            filling: None,
            work: Work::default(),
        })
    }

    /// Sets the height of the eye above sea level, m, and the direction to the sun. Fills the tables if either has changed,
    /// or the fog.
    ///
    /// # Errors
    /// [`SkyRendererError`] for numbers that are no place or direction, and for a place that the sky is not prepared for and cannot be
    /// solved for.
    pub fn update(&mut self, height_m: f64, sun: DVec3) -> Result<(), SkyRendererError> {
        let place = checked(height_m, sun)?;
        if !self.is_drawn(place) {
            let filled = self.fill(place)()?;
            self.upload(filled, place);
        }
        Ok(())
    }

    /// Sets or removes a fog in front of everything, from the next update on.
    ///
    /// # Errors
    /// [`SkyRendererError::Fog`] and [`SkyRendererError::FogProfile`] for an invalid fog.
    pub fn set_fog(&mut self, fog: Option<Fog>) -> Result<(), SkyRendererError> {
        fog.as_ref().map_or(Ok(()), Fog::validate)?;
        self.fog = fog;
        Ok(())
    }

    /// As [`SkyRenderer::update`], but fills the tables on a thread of their own. Until they are filled, frames are drawn with the last
    /// ones, so that a program that calls this before each frame keeps its pace while the sun moves. True if the tables are those
    /// of this eye and sun. Where threads cannot be started, as in a browser, it fills the tables at once.
    ///
    /// # Errors
    /// As [`SkyRenderer::update`], in this or in a later call.
    ///
    /// # Panics
    /// Where the thread has panicked.
    pub fn update_in_background(
        &mut self,
        height_m: f64,
        sun: DVec3,
    ) -> Result<bool, SkyRendererError> {
        let place = checked(height_m, sun)?;
        if let Some((thread, filled_for)) = self.filling.take_if(|(t, _)| t.is_finished()) {
            let filled = thread.join().unwrap_or_else(|panic| resume_unwind(panic))?;
            self.upload(filled, filled_for);
        }
        if !self.is_drawn(place) && self.filling.is_none() {
            match std::thread::Builder::new().spawn(self.fill(place)) {
                Ok(thread) => self.filling = Some((thread, place)),
                Err(_) => self.update(height_m, sun)?,
            }
        }
        Ok(self.is_drawn(place))
    }

    fn is_drawn(&self, place: Place) -> bool {
        self.drawn.as_ref().is_some_and(|drawn| {
            drawn.place == place && drawn.fog.as_ref().map(|(_, fog)| fog) == self.fog.as_ref()
        })
    }

    /// The work that fills tables for an eye and a sun.
    fn fill(
        &self,
        (height_m, sun): Place,
    ) -> impl FnOnce() -> Result<Filled, SkyRendererError> + Send + use<> {
        let (sky, fit, space) = (self.sky.clone(), self.fit.clone(), self.space);
        let fog = self.fog.clone();
        move || {
            let view = sky.try_view(height_m, sun)?;
            let sky = SkyTables::new(&view, &fit, space)?;
            let direct = fit.sun_illuminance_lx(&view, space)?;
            let lighting = Lighting::new(&view, &sky, direct);
            let (fog, lighting) = match fog {
                Some(fog) => {
                    let lit = fog.lit(&lighting)?;
                    let tables = fog.tables(height_m, &lit)?;
                    let in_fog = lighting.in_fog(&lit, height_m, |d| sky.rgb_radiance(d));
                    (Some((tables, fog)), in_fog)
                }
                None => (None, lighting),
            };
            Ok(Filled {
                view,
                sky,
                fog,
                lighting,
            })
        }
    }

    /// Draws with tables from now on.
    fn upload(&mut self, filled: Filled, place: Place) {
        let device = (&self.device, &self.queue);
        let sky = sky::upload(device, &self.sky_layout, &filled.sky, &filled.view);
        let fog = filled.fog.map(|(tables, fog)| {
            let uploaded = fog.upload(device, &self.fog_layout, &tables, place.0);
            (uploaded, fog)
        });
        self.drawn = Some(Drawn {
            sky,
            fog,
            lighting: filled.lighting,
            place,
        });
        self.work.tables += 1;
    }

    /// The light of sun and sky at the eye that frames are drawn for; `None` before the first tables.
    pub fn lighting(&self) -> Option<&Lighting> {
        self.drawn.as_ref().map(|drawn| &drawn.lighting)
    }

    /// Records the air, sky and sun of a frame into `target`, which holds what the program has rendered, with its depth. Before the
    /// first tables it draws nothing.
    pub fn record(
        &mut self,
        encoder: &mut wgpu::CommandEncoder,
        target: &wgpu::TextureView,
        depth: &wgpu::TextureView,
        camera: &Camera,
    ) {
        if let Some(drawn) = &self.drawn {
            let passes = [&self.sky_pass, &self.fog_pass];
            self.draw(
                drawn,
                passes,
                encoder,
                (target, wgpu::LoadOp::Load),
                depth,
                &camera.numbers(),
            );
            self.work.frames += 1;
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
                world_from_clip,
                exposure,
                far_depth: 0.0,
            };
            let numbers = camera.numbers_without_disc();
            self.draw(
                drawn,
                map.passes(),
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
        [sky_pass, fog_pass]: [&Pass; 2],
        encoder: &mut wgpu::CommandEncoder,
        (target, load): (&wgpu::TextureView, wgpu::LoadOp<wgpu::Color>),
        depth: &wgpu::TextureView,
        camera: &[f32],
    ) {
        // A buffer for each frame, as an encoder may record several.
        let camera = self.device.create_buffer_init(&BufferInitDescriptor {
            label: Some("airlight camera"),
            contents: &bytes(camera),
            usage: wgpu::BufferUsages::UNIFORM,
        });
        let frame = self.device.create_bind_group(&wgpu::BindGroupDescriptor {
            label: Some("airlight frame"),
            layout: &self.frame_layout,
            entries: &[
                wgpu::BindGroupEntry {
                    binding: 0,
                    resource: camera.as_entire_binding(),
                },
                wgpu::BindGroupEntry {
                    binding: 1,
                    resource: wgpu::BindingResource::TextureView(depth),
                },
            ],
        });
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
        if let Some((fog, _)) = &drawn.fog {
            fog_pass.draw(&mut pass, fog);
        }
    }

    /// What has been computed so far.
    pub fn work(&self) -> Work {
        self.work
    }

    /// The solved sky.
    pub fn sky(&self) -> &Sky {
        &self.sky
    }
}

/// The passes of the sky.
fn sky_shader() -> String {
    source(&[Part::SkyTables]) + CORNER + include_str!("frame.wgsl") + include_str!("sky.wgsl")
}

/// The passes of the fog.
fn fog_shader() -> String {
    source(&[Part::Fog, Part::FogTable])
        + CORNER
        + include_str!("frame.wgsl")
        + include_str!("fog.wgsl")
}

/// A height that is a number, and a unit vector towards the sun.
fn checked(height_m: f64, sun: DVec3) -> Result<Place, SkyRendererError> {
    if !height_m.is_finite() {
        return Err(SkyRendererError::Height(height_m));
    }
    let sun = sun.try_normalize().ok_or(SkyRendererError::Sun(sun))?;
    Ok((height_m, sun))
}

/// Layout of the second group: camera and depth.
fn frame_layout(device: &wgpu::Device) -> wgpu::BindGroupLayout {
    let entry = |binding, ty| wgpu::BindGroupLayoutEntry {
        binding,
        visibility: wgpu::ShaderStages::FRAGMENT,
        ty,
        count: None,
    };
    device.create_bind_group_layout(&wgpu::BindGroupLayoutDescriptor {
        label: Some("airlight frame"),
        entries: &[
            entry(
                0,
                wgpu::BindingType::Buffer {
                    ty: wgpu::BufferBindingType::Uniform,
                    has_dynamic_offset: false,
                    min_binding_size: None,
                },
            ),
            entry(
                1,
                wgpu::BindingType::Texture {
                    sample_type: wgpu::TextureSampleType::Depth,
                    view_dimension: wgpu::TextureViewDimension::D2,
                    multisampled: false,
                },
            ),
        ],
    })
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
    }
}
