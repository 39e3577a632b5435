//! Passes that cover a target; over a frame, one dims it and one adds light.

use crate::error::{SkyRendererError, require};

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

/// Refuses targets that are not of colours, or that a device cannot draw into.
pub fn check_target(
    device: &wgpu::Device,
    format: wgpu::TextureFormat,
) -> Result<(), SkyRendererError> {
    let features = device.features();
    let of_format = format.guaranteed_format_features(features);
    let usages = of_format.allowed_usages;
    let is_colour = !format.has_depth_aspect() && !format.has_stencil_aspect();
    let sample_type = format.sample_type(None, Some(features));
    let is_float = matches!(sample_type, Some(wgpu::TextureSampleType::Float { .. }));
    require(
        is_colour && is_float && usages.contains(wgpu::TextureUsages::RENDER_ATTACHMENT),
        "a target format of colours that are no integers, which the device can draw into",
        &format,
    )
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

/// A group of what a [`group_layout`] holds, by binding.
pub fn bind_group(
    device: &wgpu::Device,
    layout: &wgpu::BindGroupLayout,
    label: &str,
    resources: &[wgpu::BindingResource<'_>],
) -> wgpu::BindGroup {
    let entries: Vec<_> = (0..)
        .zip(resources)
        .map(|(binding, resource)| wgpu::BindGroupEntry {
            binding,
            resource: resource.clone(),
        })
        .collect();
    device.create_bind_group(&wgpu::BindGroupDescriptor {
        label: Some(label),
        layout,
        entries: &entries,
    })
}

/// A buffer with the numbers of a pass, for a [`UNIFORM`].
pub fn uniform(device: &wgpu::Device, label: &str, numbers: &[f32]) -> wgpu::Buffer {
    filled(device, label, &bytes(numbers), wgpu::BufferUsages::UNIFORM)
}

/// A buffer with contents of whole words. On a device that is lost it holds nothing, as nothing will be drawn with it.
pub fn filled(
    device: &wgpu::Device,
    label: &str,
    contents: &[u8],
    usage: wgpu::BufferUsages,
) -> wgpu::Buffer {
    let buffer = device.create_buffer(&wgpu::BufferDescriptor {
        label: Some(label),
        size: contents.len() as u64,
        usage,
        mapped_at_creation: true,
    });
    if let Ok(mut mapped) = buffer.get_mapped_range_mut(..) {
        mapped.copy_from_slice(contents);
        drop(mapped);
        buffer.unmap();
    }
    buffer
}

/// Numbers as a buffer holds them.
pub fn bytes(numbers: &[f32]) -> Vec<u8> {
    numbers.iter().flat_map(|x| x.to_ne_bytes()).collect()
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

/// The passes of a shader's medium.
const MEDIUM: &str = include_str!("medium.wgsl");
/// Features of a device that dims and adds light at once.
pub const AT_ONCE_FEATURES: wgpu::Features = wgpu::Features::DUAL_SOURCE_BLENDING;
/// The pass that does so.
const AT_ONCE: &str = include_str!("medium_at_once.wgsl");

/// The pipelines of a medium.
#[derive(Debug)]
pub struct Pass {
    /// What dims the frame and adds light: one pipeline where the device blends with two colours, otherwise two.
    dim_and_add: Vec<wgpu::RenderPipeline>,
    add: wgpu::RenderPipeline,
}

impl Pass {
    /// The pipelines of a shader with [`CORNER`] and the functions of a medium, for targets of a format.
    pub fn new(
        device: &wgpu::Device,
        groups: [&wgpu::BindGroupLayout; 2],
        shader: &str,
        format: wgpu::TextureFormat,
    ) -> Self {
        let shader = medium_shader(shader);
        let (layout, module) = parts(device, &groups, &shader);
        let add = blending(device, &layout, &module, "add", format);
        let dim_and_add = match device.features().contains(AT_ONCE_FEATURES) {
            true => {
                let (layout, module) = parts(device, &groups, &at_once_shader(&shader));
                vec![blending(device, &layout, &module, "dim_and_add", format)]
            }
            false => vec![
                blending(device, &layout, &module, "dim", format),
                add.clone(),
            ],
        };
        Self { dim_and_add, add }
    }

    /// Draws over the frame with the tables of the medium; the second group is set.
    pub fn draw(&self, pass: &mut wgpu::RenderPass<'_>, tables: &wgpu::BindGroup) {
        for pipeline in &self.dim_and_add {
            draw(pass, pipeline, tables);
        }
    }

    /// Adds the light of a second source, in a medium that has been drawn.
    pub fn add(&self, pass: &mut wgpu::RenderPass<'_>, tables: &wgpu::BindGroup) {
        draw(pass, &self.add, tables);
    }
}

/// A shader with the functions of a medium, and its passes.
pub fn medium_shader(shader: &str) -> String {
    [shader, MEDIUM].concat()
}

/// A [`medium_shader`] that can do both at once.
pub fn at_once_shader(shader: &str) -> String {
    ["enable dual_source_blending;\n", shader, AT_ONCE].concat()
}

/// The pipeline of a shader with [`CORNER`] and one entry point, `add`, `disc` or `shade`, for targets of a format.
pub fn single(
    device: &wgpu::Device,
    groups: &[&wgpu::BindGroupLayout],
    (shader, entry): (&str, &str),
    format: wgpu::TextureFormat,
) -> wgpu::RenderPipeline {
    let (layout, shader) = parts(device, groups, shader);
    blending(device, &layout, &shader, entry, format)
}

/// Draws over the frame with a first group; the second is set.
pub fn draw(
    pass: &mut wgpu::RenderPass<'_>,
    pipeline: &wgpu::RenderPipeline,
    group: &wgpu::BindGroup,
) {
    pass.set_bind_group(0, group, &[]);
    pass.set_pipeline(pipeline);
    pass.draw(0..3, 0..1);
}

/// Layout and module of pipelines.
fn parts(
    device: &wgpu::Device,
    groups: &[&wgpu::BindGroupLayout],
    shader: &str,
) -> (wgpu::PipelineLayout, wgpu::ShaderModule) {
    let groups: Vec<_> = groups.iter().map(|group| Some(*group)).collect();
    let layout = device.create_pipeline_layout(&wgpu::PipelineLayoutDescriptor {
        label: Some("airlight"),
        bind_group_layouts: &groups,
        immediate_size: 0,
    });
    let shader = device.create_shader_module(wgpu::ShaderModuleDescriptor {
        label: Some("airlight"),
        source: wgpu::ShaderSource::Wgsl(shader.into()),
    });
    (layout, shader)
}

/// A pipeline whose entry point `dim` multiplies the colours of the target, whose `add` and `disc` add to them, whose `dim_and_add` does
/// both, and whose `shade` subtracts from them.
fn blending(
    device: &wgpu::Device,
    layout: &wgpu::PipelineLayout,
    shader: &wgpu::ShaderModule,
    entry: &str,
    format: wgpu::TextureFormat,
) -> wgpu::RenderPipeline {
    let component = |src_factor, dst_factor| wgpu::BlendComponent {
        src_factor,
        dst_factor,
        operation: wgpu::BlendOperation::Add,
    };
    let (zero, one) = (wgpu::BlendFactor::Zero, wgpu::BlendFactor::One);
    let color = match entry {
        "dim" => component(zero, wgpu::BlendFactor::Src),
        "dim_and_add" => component(one, wgpu::BlendFactor::Src1),
        "shade" => wgpu::BlendComponent {
            operation: wgpu::BlendOperation::ReverseSubtract,
            ..component(one, one)
        },
        _ => component(one, one),
    };
    let blend = wgpu::BlendState {
        color,
        alpha: component(zero, one),
    };
    covering(device, layout, shader, entry, (format, Some(blend)))
}
