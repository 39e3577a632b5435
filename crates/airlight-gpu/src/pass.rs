//! Passes that cover a target; over a frame, one dims it and one adds light.

/// The vertex stage of [`covering`] pipelines.
pub const CORNER: &str = include_str!("corner.wgsl");

/// A pipeline that draws a fragment stage of a shader with [`CORNER`] over a target.
pub fn covering(
    device: &wgpu::Device,
    layout: &wgpu::PipelineLayout,
    shader: &wgpu::ShaderModule,
    entry: &str,
    (format, blend): (wgpu::TextureFormat, Option<wgpu::BlendState>),
) -> wgpu::RenderPipeline {
    device.create_render_pipeline(&wgpu::RenderPipelineDescriptor {
        label: Some(entry),
        layout: Some(layout),
        vertex: wgpu::VertexState {
            module: shader,
            entry_point: Some("corner"),
            compilation_options: wgpu::PipelineCompilationOptions::default(),
            buffers: &[],
        },
        primitive: wgpu::PrimitiveState::default(),
        depth_stencil: None,
        multisample: wgpu::MultisampleState::default(),
        fragment: Some(wgpu::FragmentState {
            module: shader,
            entry_point: Some(entry),
            compilation_options: wgpu::PipelineCompilationOptions::default(),
            targets: &[Some(wgpu::ColorTargetState {
                format,
                blend,
                write_mask: wgpu::ColorWrites::ALL,
            })],
        }),
        multiview_mask: None,
        cache: None,
    })
}

/// Layout of a group of the fragment stage, by binding.
pub fn group_layout(
    device: &wgpu::Device,
    label: &str,
    types: &[wgpu::BindingType],
) -> wgpu::BindGroupLayout {
    let entry = |(binding, &ty)| wgpu::BindGroupLayoutEntry {
        binding,
        visibility: wgpu::ShaderStages::FRAGMENT,
        ty,
        count: None,
    };
    let entries: Vec<_> = (0..).zip(types).map(entry).collect();
    device.create_bind_group_layout(&wgpu::BindGroupLayoutDescriptor {
        label: Some(label),
        entries: &entries,
    })
}

/// Numbers of a pass.
pub const UNIFORM: wgpu::BindingType = wgpu::BindingType::Buffer {
    ty: wgpu::BufferBindingType::Uniform,
    has_dynamic_offset: false,
    min_binding_size: None,
};

/// A texture of floats, with a sampler or without one.
pub const fn texture(
    view_dimension: wgpu::TextureViewDimension,
    filterable: bool,
) -> wgpu::BindingType {
    wgpu::BindingType::Texture {
        sample_type: wgpu::TextureSampleType::Float { filterable },
        view_dimension,
        multisampled: false,
    }
}

/// Draws over all of a target with a [`covering`] pipeline.
pub fn cover(
    encoder: &mut wgpu::CommandEncoder,
    label: &str,
    target: &wgpu::TextureView,
    pipeline: &wgpu::RenderPipeline,
    group: &wgpu::BindGroup,
) {
    let mut pass = encoder.begin_render_pass(&wgpu::RenderPassDescriptor {
        label: Some(label),
        color_attachments: &[Some(wgpu::RenderPassColorAttachment {
            view: target,
            depth_slice: None,
            resolve_target: None,
            ops: wgpu::Operations {
                load: wgpu::LoadOp::Clear(wgpu::Color::BLACK),
                store: wgpu::StoreOp::Store,
            },
        })],
        depth_stencil_attachment: None,
        timestamp_writes: None,
        occlusion_query_set: None,
        multiview_mask: None,
    });
    pass.set_pipeline(pipeline);
    pass.set_bind_group(0, group, &[]);
    pass.draw(0..3, 0..1);
}

/// The two pipelines of a medium.
#[derive(Debug)]
pub struct Pass {
    dim: wgpu::RenderPipeline,
    add: wgpu::RenderPipeline,
}

impl Pass {
    /// The pipelines of a shader with [`CORNER`] and the entry points `dim` and `add`, for targets of a format.
    pub fn new(
        device: &wgpu::Device,
        groups: [&wgpu::BindGroupLayout; 2],
        shader: &str,
        format: wgpu::TextureFormat,
    ) -> Self {
        let layout = device.create_pipeline_layout(&wgpu::PipelineLayoutDescriptor {
            label: Some("airlight"),
            bind_group_layouts: &groups.map(Some),
            immediate_size: 0,
        });
        let shader = device.create_shader_module(wgpu::ShaderModuleDescriptor {
            label: Some("airlight"),
            source: wgpu::ShaderSource::Wgsl(shader.into()),
        });
        let pipeline = |entry: &str, source: wgpu::BlendFactor, target: wgpu::BlendFactor| {
            let component = |src_factor, dst_factor| wgpu::BlendComponent {
                src_factor,
                dst_factor,
                operation: wgpu::BlendOperation::Add,
            };
            let keep = component(wgpu::BlendFactor::Zero, wgpu::BlendFactor::One);
            let blend = wgpu::BlendState {
                color: component(source, target),
                alpha: keep,
            };
            covering(device, &layout, &shader, entry, (format, Some(blend)))
        };
        let (zero, one) = (wgpu::BlendFactor::Zero, wgpu::BlendFactor::One);
        Self {
            dim: pipeline("dim", zero, wgpu::BlendFactor::Src),
            add: pipeline("add", one, one),
        }
    }

    /// Draws over the frame with the tables of the medium; the second group is set.
    pub fn draw(&self, pass: &mut wgpu::RenderPass<'_>, tables: &wgpu::BindGroup) {
        pass.set_bind_group(0, tables, &[]);
        for pipeline in [&self.dim, &self.add] {
            pass.set_pipeline(pipeline);
            pass.draw(0..3, 0..1);
        }
    }
}
