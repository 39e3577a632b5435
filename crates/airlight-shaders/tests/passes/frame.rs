//! Frames that a pass draws.

use crate::vulkan;
use airlight_shaders::{Pass, SpirvModule, spirv_modules};
use wgpu::util::{BufferInitDescriptor, DeviceExt};

/// Format of the frames.
pub const FORMAT: wgpu::TextureFormat = wgpu::TextureFormat::Rgba32Float;

/// The SPIR-V of a pass.
pub fn spirv(pass: Pass) -> SpirvModule {
    let modules = spirv_modules(&pass.parts()[..1]).expect("modules");
    let name = airlight::Named::name(pass);
    let mut modules = modules.into_iter();
    modules
        .find(|module| module.name == name)
        .expect("the pass")
}

/// WGSL and SPIR-V of a pass.
pub fn both_forms(pass: Pass) -> [wgpu::ShaderSource<'static>; 2] {
    [
        wgpu::ShaderSource::Wgsl(pass.source().into()),
        wgpu::ShaderSource::SpirV(spirv(pass).words.into()),
    ]
}

/// A pass on a device, for frames of one size.
pub struct Drawn<'a> {
    device: &'a wgpu::Device,
    queue: &'a wgpu::Queue,
    pipeline: wgpu::RenderPipeline,
    group: wgpu::BindGroup,
    target: wgpu::Texture,
}

/// A texture of a square frame.
pub fn texture(device: &wgpu::Device, size: u32, format: wgpu::TextureFormat) -> wgpu::Texture {
    device.create_texture(&wgpu::TextureDescriptor {
        label: None,
        size: wgpu::Extent3d {
            width: size,
            height: size,
            depth_or_array_layers: 1,
        },
        mip_level_count: 1,
        sample_count: 1,
        dimension: wgpu::TextureDimension::D2,
        format,
        usage: wgpu::TextureUsages::RENDER_ATTACHMENT
            | wgpu::TextureUsages::TEXTURE_BINDING
            | wgpu::TextureUsages::COPY_SRC,
        view_formats: &[],
    })
}

/// Attachment that is cleared to a colour.
fn cleared(
    view: &wgpu::TextureView,
    colour: [f64; 4],
) -> Option<wgpu::RenderPassColorAttachment<'_>> {
    let [r, g, b, a] = colour;
    Some(wgpu::RenderPassColorAttachment {
        view,
        depth_slice: None,
        resolve_target: None,
        ops: wgpu::Operations {
            load: wgpu::LoadOp::Clear(wgpu::Color { r, g, b, a }),
            store: wgpu::StoreOp::Store,
        },
    })
}

/// Commands that draw a frame of one colour and one depth.
pub fn even_scene(
    device: &wgpu::Device,
    [colours, depths]: [&wgpu::TextureView; 2],
    colour: [f32; 4],
    depth: f32,
) -> wgpu::CommandEncoder {
    let mut encoder = device.create_command_encoder(&Default::default());
    drop(encoder.begin_render_pass(&wgpu::RenderPassDescriptor {
        color_attachments: &[cleared(colours, colour.map(f64::from))],
        depth_stencil_attachment: Some(wgpu::RenderPassDepthStencilAttachment {
            view: depths,
            depth_ops: Some(wgpu::Operations {
                load: wgpu::LoadOp::Clear(depth),
                store: wgpu::StoreOp::Store,
            }),
            stencil_ops: None,
        }),
        ..Default::default()
    }));
    encoder
}

impl<'a> Drawn<'a> {
    /// A pass with its fragment entry point, its uniform at binding 0 and other resources from binding 1 on.
    pub fn new(
        (device, queue): (&'a wgpu::Device, &'a wgpu::Queue),
        source: wgpu::ShaderSource<'_>,
        fragment: &str,
        size: u32,
        uniform: &[u8],
        resources: &[wgpu::BindingResource<'_>],
    ) -> Self {
        let shader = device.create_shader_module(wgpu::ShaderModuleDescriptor {
            label: None,
            source,
        });
        let pipeline = device.create_render_pipeline(&wgpu::RenderPipelineDescriptor {
            label: None,
            layout: None,
            vertex: wgpu::VertexState {
                module: &shader,
                entry_point: Some("corner"),
                compilation_options: Default::default(),
                buffers: &[],
            },
            fragment: Some(wgpu::FragmentState {
                module: &shader,
                entry_point: Some(fragment),
                compilation_options: Default::default(),
                targets: &[Some(FORMAT.into())],
            }),
            primitive: Default::default(),
            depth_stencil: None,
            multisample: Default::default(),
            multiview_mask: None,
            cache: None,
        });
        let uniform = device.create_buffer_init(&BufferInitDescriptor {
            label: None,
            contents: uniform,
            usage: wgpu::BufferUsages::UNIFORM,
        });
        let mut entries = vec![wgpu::BindGroupEntry {
            binding: 0,
            resource: uniform.as_entire_binding(),
        }];
        for (resource, binding) in resources.iter().cloned().zip(1..) {
            entries.push(wgpu::BindGroupEntry { binding, resource });
        }
        let group = device.create_bind_group(&wgpu::BindGroupDescriptor {
            label: None,
            layout: &pipeline.get_bind_group_layout(0),
            entries: &entries,
        });
        let target = texture(device, size, FORMAT);
        Self {
            device,
            queue,
            pipeline,
            group,
            target,
        }
    }

    /// A frame, four numbers a pixel from the upper left corner, after the commands of an encoder.
    pub fn frame(&self, mut encoder: wgpu::CommandEncoder) -> Vec<f32> {
        let view = self.target.create_view(&Default::default());
        {
            let mut pass = encoder.begin_render_pass(&wgpu::RenderPassDescriptor {
                color_attachments: &[cleared(&view, [0.0; 4])],
                ..Default::default()
            });
            pass.set_pipeline(&self.pipeline);
            pass.set_bind_group(0, &self.group, &[]);
            pass.draw(0..3, 0..1);
        }
        let size = self.target.size();
        let pixels = self.device.create_buffer(&wgpu::BufferDescriptor {
            label: None,
            size: u64::from(size.width * size.height * 16),
            usage: wgpu::BufferUsages::COPY_SRC | wgpu::BufferUsages::COPY_DST,
            mapped_at_creation: false,
        });
        encoder.copy_texture_to_buffer(
            self.target.as_image_copy(),
            wgpu::TexelCopyBufferInfo {
                buffer: &pixels,
                layout: wgpu::TexelCopyBufferLayout {
                    offset: 0,
                    bytes_per_row: Some(size.width * 16),
                    rows_per_image: None,
                },
            },
            size,
        );
        self.queue.submit([encoder.finish()]);
        let bytes = vulkan::read(self.device, self.queue, &pixels);
        let numbers = bytes.as_chunks::<4>().0.iter();
        numbers.map(|bytes| f32::from_ne_bytes(*bytes)).collect()
    }
}
