//! S. Hillaire, "A Scalable and Production Ready Sky and Atmosphere Rendering Technique", Computer Graphics Forum 39(4), 2020, on a
//! graphics device: with the formulas of [`airlight::models::hillaire2020`], and the tables that it omits.
//!
//! The sizes and steps are those of table 2 of the paper: transmittances 256 x 64 of 40 steps, multiple scattering 32 x 32 of 64 rays of 20
//! steps, the sky 200 x 100 of 30 steps, aerial perspective 32 x 32 x 32. As in the author's published shaders, the slices of the latter
//! reach to 128 km, denser near the eye, slice k is marched in 2 (k + 1) steps, and rows of the sky are denser towards the horizon.
//! Aerial perspective holds the mean transmittance of red, green and blue, so that a blending pass applies it.

mod parameters;

pub use parameters::HillairePassesError;

use airlight::atmosphere::Atmosphere;
use airlight::glam::DVec3;
use airlight_gpu::Camera;
use airlight_shaders::counting;
use parameters::Air;
use wgpu::util::{BufferInitDescriptor, DeviceExt};

/// Texels of the tables.
const TRANSMITTANCE: [u32; 3] = [256, 64, 1];
const MULTIPLE: [u32; 3] = [32, 32, 1];
const SKY: [u32; 3] = [200, 100, 1];
const AERIAL: [u32; 3] = [32, 32, 32];
/// Steps along a ray of the sky.
const SKY_STEPS: u64 = 30;
/// Numbers of the shaders' struct `View`.
const VIEW_NUMBERS: u64 = 28;

const AIR: &str = include_str!("air.wgsl");
const SUNLIGHT: &str = include_str!("sunlight.wgsl");
const MARCH: &str = include_str!("march.wgsl");
const SKY_COORDINATES: &str = include_str!("sky_coordinates.wgsl");
const FRAME: &str = include_str!("frame.wgsl");

/// Draws sky and aerial perspective over frames as Hillaire 2020, from inside the air.
#[derive(Debug)]
pub struct HillairePasses {
    device: wgpu::Device,
    queue: wgpu::Queue,
    air: Air,
    air_numbers: wgpu::Buffer,
    view_numbers: wgpu::Buffer,
    clamped: wgpu::Sampler,
    /// Repeats azimuths.
    around: wgpu::Sampler,
    transmittance: Table,
    multiple: Table,
    sky: Table,
    aerial: Table,
    compose: wgpu::RenderPipeline,
    counts: Option<wgpu::Buffer>,
}

/// A table, and the pass that fills it.
#[derive(Debug)]
struct Table {
    view: wgpu::TextureView,
    pipeline: wgpu::ComputePipeline,
    group: wgpu::BindGroup,
    counts: Option<wgpu::BindGroup>,
    workgroups: [u32; 3],
}

/// Where shaders are made, and what they count in.
#[derive(Clone, Copy)]
struct Workshop<'a> {
    device: &'a wgpu::Device,
    counts: Option<&'a wgpu::Buffer>,
}

impl HillairePasses {
    /// Makes the pipelines for targets of a format, linear sRGB and blendable, such as `Rgba16Float`. The light of an atmosphere at 680, 550
    /// and 440 nm is taken as red, green and blue.
    ///
    /// # Errors
    /// [`HillairePassesError::Air`] for an atmosphere with other constituents than the paper's.
    pub fn new(
        device: &wgpu::Device,
        queue: &wgpu::Queue,
        atmosphere: &Atmosphere,
        target_format: wgpu::TextureFormat,
    ) -> Result<Self, HillairePassesError> {
        Self::with_counts(device, queue, atmosphere, target_format, None)
    }

    /// As [`Self::new`], with passes that add what they evaluate to the [`Counts`](airlight_shaders::Counts) of a storage buffer: the function
    /// whose calls they count evaluates the densities of the air. They draw the same, slower.
    ///
    /// # Errors
    /// As [`Self::new`].
    pub fn counting(
        device: &wgpu::Device,
        queue: &wgpu::Queue,
        atmosphere: &Atmosphere,
        target_format: wgpu::TextureFormat,
        counts: &wgpu::Buffer,
    ) -> Result<Self, HillairePassesError> {
        Self::with_counts(device, queue, atmosphere, target_format, Some(counts))
    }

    fn with_counts(
        device: &wgpu::Device,
        queue: &wgpu::Queue,
        atmosphere: &Atmosphere,
        target_format: wgpu::TextureFormat,
        counts: Option<&wgpu::Buffer>,
    ) -> Result<Self, HillairePassesError> {
        let workshop = Workshop { device, counts };
        let air = Air::new(atmosphere)?;
        let air_numbers = device.create_buffer_init(&BufferInitDescriptor {
            label: Some("hillaire air"),
            contents: &bytes(&air.numbers),
            usage: wgpu::BufferUsages::UNIFORM,
        });
        let view_numbers = device.create_buffer(&wgpu::BufferDescriptor {
            label: Some("hillaire view"),
            size: VIEW_NUMBERS * 4,
            usage: wgpu::BufferUsages::UNIFORM | wgpu::BufferUsages::COPY_DST,
            mapped_at_creation: false,
        });
        let sampler = |address_mode_u| {
            device.create_sampler(&wgpu::SamplerDescriptor {
                label: Some("hillaire tables"),
                address_mode_u,
                mag_filter: wgpu::FilterMode::Linear,
                min_filter: wgpu::FilterMode::Linear,
                ..Default::default()
            })
        };
        let clamped = sampler(wgpu::AddressMode::ClampToEdge);
        let numbers = [&air_numbers, &view_numbers].map(wgpu::Buffer::as_entire_binding);
        let [air_binding, view_binding] = numbers.clone();
        let sampler_binding = || wgpu::BindingResource::Sampler(&clamped);
        let transmittance = Table::new(
            workshop,
            TRANSMITTANCE,
            (&[AIR, include_str!("transmittance.wgsl")], [32, 8, 1]),
            &[(0, air_binding.clone())],
            1,
        );
        let multiple = Table::new(
            workshop,
            MULTIPLE,
            (
                &[AIR, SUNLIGHT, include_str!("multiple_scattering.wgsl")],
                [32, 32, 1],
            ),
            &[
                (0, air_binding.clone()),
                (2, sampler_binding()),
                (3, wgpu::BindingResource::TextureView(&transmittance.view)),
            ],
            1,
        );
        let light = [
            (0, air_binding),
            (1, view_binding),
            (2, sampler_binding()),
            (3, wgpu::BindingResource::TextureView(&transmittance.view)),
            (4, wgpu::BindingResource::TextureView(&multiple.view)),
        ];
        let sky = [
            AIR,
            SUNLIGHT,
            MARCH,
            SKY_COORDINATES,
            include_str!("sky_view.wgsl"),
        ];
        let sky = Table::new(workshop, SKY, (&sky, [25, 25, 1]), &light, 5);
        let aerial = [AIR, SUNLIGHT, MARCH, FRAME, include_str!("aerial.wgsl")];
        let aerial = Table::new(workshop, AERIAL, (&aerial, [4, 4, 32]), &light, 5);
        Ok(Self {
            compose: compose_pipeline(workshop, target_format),
            counts: counts.cloned(),
            around: sampler(wgpu::AddressMode::Repeat),
            device: device.clone(),
            queue: queue.clone(),
            air,
            air_numbers,
            view_numbers,
            clamped,
            transmittance,
            multiple,
            sky,
            aerial,
        })
    }

    /// Sets the height of the eye above the ground, m, the direction to the sun, and the camera, for passes that are submitted from now on.
    ///
    /// # Errors
    /// [`HillairePassesError`] for an eye outside the air, a direction without length, and a camera without perspective.
    pub fn set_view(
        &self,
        height_m: f64,
        sun: DVec3,
        camera: &Camera,
    ) -> Result<(), HillairePassesError> {
        let numbers = self.air.view_numbers(height_m, sun, camera)?;
        self.queue
            .write_buffer(&self.view_numbers, 0, &bytes(&numbers));
        Ok(())
    }

    /// Fills the table of transmittances, which changes with the air.
    pub fn record_transmittance(&self, encoder: &mut wgpu::CommandEncoder) {
        self.transmittance.fill(encoder);
    }

    /// Fills the table of multiple scattering, which changes with the air.
    pub fn record_multiple_scattering(&self, encoder: &mut wgpu::CommandEncoder) {
        self.multiple.fill(encoder);
    }

    /// Fills the table of the sky, which changes with the sun and the height of the eye.
    pub fn record_sky_view(&self, encoder: &mut wgpu::CommandEncoder) {
        self.sky.fill(encoder);
    }

    /// Fills the volume of aerial perspective, which changes with the sun, the height of the eye, and whenever the camera turns.
    pub fn record_aerial_perspective(&self, encoder: &mut wgpu::CommandEncoder) {
        self.aerial.fill(encoder);
    }

    /// Fills all tables.
    pub fn record_tables(&self, encoder: &mut wgpu::CommandEncoder) {
        for table in [&self.transmittance, &self.multiple, &self.sky, &self.aerial] {
            table.fill(encoder);
        }
    }

    /// Draws over a frame, which holds what a program has rendered, with its depth.
    pub fn record(
        &self,
        encoder: &mut wgpu::CommandEncoder,
        target: &wgpu::TextureView,
        depth: &wgpu::TextureView,
    ) {
        let view = wgpu::BindingResource::TextureView;
        let group = group(
            &self.device,
            &self.compose.get_bind_group_layout(0),
            &[
                (0, self.air_numbers.as_entire_binding()),
                (1, self.view_numbers.as_entire_binding()),
                (2, wgpu::BindingResource::Sampler(&self.clamped)),
                (3, view(&self.transmittance.view)),
                (5, view(depth)),
                (6, view(&self.sky.view)),
                (7, view(&self.aerial.view)),
                (8, wgpu::BindingResource::Sampler(&self.around)),
            ],
        );
        let mut pass = encoder.begin_render_pass(&wgpu::RenderPassDescriptor {
            label: Some("hillaire compose"),
            color_attachments: &[Some(wgpu::RenderPassColorAttachment {
                view: target,
                depth_slice: None,
                resolve_target: None,
                ops: wgpu::Operations {
                    load: wgpu::LoadOp::Load,
                    store: wgpu::StoreOp::Store,
                },
            })],
            depth_stencil_attachment: None,
            timestamp_writes: None,
            occlusion_query_set: None,
            multiview_mask: None,
        });
        pass.set_pipeline(&self.compose);
        pass.set_bind_group(0, &group, &[]);
        let workshop = Workshop {
            device: &self.device,
            counts: self.counts.as_ref(),
        };
        if let Some(counts) = workshop.counts_group(|| self.compose.get_bind_group_layout(1)) {
            pass.set_bind_group(1, &counts, &[]);
        }
        pass.draw(0..3, 0..1);
    }

    /// Places where the densities of the air are evaluated to fill the sky, and aerial perspective.
    pub fn medium_evaluations() -> [u64; 2] {
        let [columns, rows, _] = SKY.map(u64::from);
        let [across, up, slices] = AERIAL.map(u64::from);
        let steps_of_slices = slices * (slices + 1);
        [columns * rows * SKY_STEPS, across * up * steps_of_slices]
    }
}

impl Table {
    /// A table of some size that a shader's entry point `fill` stores through a binding.
    fn new(
        workshop: Workshop<'_>,
        size: [u32; 3],
        (shader, workgroups): (&[&str], [u32; 3]),
        inputs: &[(u32, wgpu::BindingResource<'_>)],
        output: u32,
    ) -> Self {
        let device = workshop.device;
        let [width, height, depth] = size;
        let texture = device.create_texture(&wgpu::TextureDescriptor {
            label: Some("hillaire table"),
            size: wgpu::Extent3d {
                width,
                height,
                depth_or_array_layers: depth,
            },
            mip_level_count: 1,
            sample_count: 1,
            dimension: match depth {
                1 => wgpu::TextureDimension::D2,
                _ => wgpu::TextureDimension::D3,
            },
            format: wgpu::TextureFormat::Rgba16Float,
            usage: wgpu::TextureUsages::TEXTURE_BINDING | wgpu::TextureUsages::STORAGE_BINDING,
            view_formats: &[],
        });
        let view = texture.create_view(&wgpu::TextureViewDescriptor::default());
        let pipeline = device.create_compute_pipeline(&wgpu::ComputePipelineDescriptor {
            label: Some("hillaire table"),
            layout: None,
            module: &workshop.module(shader),
            entry_point: Some("fill"),
            compilation_options: wgpu::PipelineCompilationOptions::default(),
            cache: None,
        });
        let mut resources = inputs.to_vec();
        resources.push((output, wgpu::BindingResource::TextureView(&view)));
        let group = group(device, &pipeline.get_bind_group_layout(0), &resources);
        Self {
            view,
            counts: workshop.counts_group(|| pipeline.get_bind_group_layout(1)),
            pipeline,
            group,
            workgroups,
        }
    }

    fn fill(&self, encoder: &mut wgpu::CommandEncoder) {
        let mut pass = encoder.begin_compute_pass(&wgpu::ComputePassDescriptor {
            label: Some("hillaire table"),
            timestamp_writes: None,
        });
        pass.set_pipeline(&self.pipeline);
        pass.set_bind_group(0, &self.group, &[]);
        if let Some(counts) = &self.counts {
            pass.set_bind_group(1, counts, &[]);
        }
        let [x, y, z] = self.workgroups;
        pass.dispatch_workgroups(x, y, z);
    }
}

/// The pass that adds light, and multiplies by alpha what the frame holds.
fn compose_pipeline(workshop: Workshop<'_>, format: wgpu::TextureFormat) -> wgpu::RenderPipeline {
    let compose = include_str!("compose.wgsl");
    let shader = [AIR, SUNLIGHT, MARCH, SKY_COORDINATES, FRAME, compose];
    let shader = workshop.module(&shader);
    let component = |src_factor, dst_factor| wgpu::BlendComponent {
        src_factor,
        dst_factor,
        operation: wgpu::BlendOperation::Add,
    };
    let (zero, one) = (wgpu::BlendFactor::Zero, wgpu::BlendFactor::One);
    workshop
        .device
        .create_render_pipeline(&wgpu::RenderPipelineDescriptor {
            label: Some("hillaire compose"),
            layout: None,
            vertex: wgpu::VertexState {
                module: &shader,
                entry_point: Some("corner"),
                compilation_options: wgpu::PipelineCompilationOptions::default(),
                buffers: &[],
            },
            primitive: wgpu::PrimitiveState::default(),
            depth_stencil: None,
            multisample: wgpu::MultisampleState::default(),
            fragment: Some(wgpu::FragmentState {
                module: &shader,
                entry_point: Some("compose"),
                compilation_options: wgpu::PipelineCompilationOptions::default(),
                targets: &[Some(wgpu::ColorTargetState {
                    format,
                    blend: Some(wgpu::BlendState {
                        color: component(one, wgpu::BlendFactor::SrcAlpha),
                        alpha: component(zero, one),
                    }),
                    write_mask: wgpu::ColorWrites::ALL,
                })],
            }),
            multiview_mask: None,
            cache: None,
        })
}

impl Workshop<'_> {
    fn module(self, parts: &[&str]) -> wgpu::ShaderModule {
        let text = parts.concat();
        let text = match self.counts {
            Some(_) => counting(&text, (1, 0), "medium_at").expect("shaders that are valid"),
            None => text,
        };
        self.device
            .create_shader_module(wgpu::ShaderModuleDescriptor {
                label: Some("hillaire"),
                source: wgpu::ShaderSource::Wgsl(text.into()),
            })
    }

    /// The group of what is counted.
    fn counts_group(self, layout: impl Fn() -> wgpu::BindGroupLayout) -> Option<wgpu::BindGroup> {
        let counts = self.counts?.as_entire_binding();
        Some(group(self.device, &layout(), &[(0, counts)]))
    }
}

fn group(
    device: &wgpu::Device,
    layout: &wgpu::BindGroupLayout,
    resources: &[(u32, wgpu::BindingResource<'_>)],
) -> wgpu::BindGroup {
    let entries = resources.iter().cloned();
    let entries: Vec<_> = entries
        .map(|(binding, resource)| wgpu::BindGroupEntry { binding, resource })
        .collect();
    device.create_bind_group(&wgpu::BindGroupDescriptor {
        label: Some("hillaire"),
        layout,
        entries: &entries,
    })
}

fn bytes(numbers: &[f32]) -> Vec<u8> {
    numbers.iter().flat_map(|x| x.to_ne_bytes()).collect()
}
