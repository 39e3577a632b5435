//! A Vulkan device that computes functions of rows of numbers.

use crate::module;
use crate::textures;
use crate::vulkan;
use airlight::Named;
use airlight_shaders::{Part, source};
use std::fmt::Write;
use wgpu::util::{BufferInitDescriptor, DeviceExt};

/// Binding of the sampler.
const SAMPLER: u32 = 2;
/// Binding of the first texture.
const FIRST_TEXTURE: u32 = 3;

/// The device and the shader that holds an entry point for each function.
pub struct Device {
    device: wgpu::Device,
    queue: wgpu::Queue,
    shader: wgpu::ShaderModule,
    module: naga::Module,
    /// What the device is, in words.
    pub name: String,
}

impl Device {
    /// The first Vulkan device ([`vulkan::open`]).
    pub fn new() -> Self {
        let (name, device, queue) = vulkan::open();
        let module = module::whole();
        let shader = device.create_shader_module(wgpu::ShaderModuleDescriptor {
            label: None,
            source: wgpu::ShaderSource::Wgsl(with_entry_points(&module).into()),
        });
        Self {
            device,
            queue,
            shader,
            module,
            name,
        }
    }

    /// Results of a function for rows of its arguments.
    pub fn run(&self, name: &str, arguments: &[Vec<f32>]) -> Vec<Vec<f32>> {
        let function = module::function(&self.module, name);
        let result = function.result.as_ref().expect("a result");
        let width = module::write(&self.module, result.ty, "").len();
        let numbers: Vec<u8> = arguments
            .iter()
            .flatten()
            .flat_map(|x| x.to_ne_bytes())
            .collect();
        let bytes = (arguments.len() * width * 4) as u64;
        let inputs = self.device.create_buffer_init(&BufferInitDescriptor {
            label: None,
            // A buffer may not be empty.
            contents: if numbers.is_empty() {
                &[0; 4]
            } else {
                &numbers
            },
            usage: wgpu::BufferUsages::STORAGE,
        });
        let buffer = |usage| {
            self.device.create_buffer(&wgpu::BufferDescriptor {
                label: None,
                size: bytes,
                usage,
                mapped_at_creation: false,
            })
        };
        let outputs = buffer(wgpu::BufferUsages::STORAGE | wgpu::BufferUsages::COPY_SRC);
        let readable = buffer(wgpu::BufferUsages::MAP_READ | wgpu::BufferUsages::COPY_DST);
        let pipeline = self
            .device
            .create_compute_pipeline(&wgpu::ComputePipelineDescriptor {
                label: Some(name),
                layout: None,
                module: &self.shader,
                entry_point: Some(&format!("run_{name}")),
                compilation_options: wgpu::PipelineCompilationOptions::default(),
                cache: None,
            });
        let mut entries = vec![wgpu::BindGroupEntry {
            binding: 1,
            resource: outputs.as_entire_binding(),
        }];
        let views: Vec<(u32, wgpu::TextureView)> = module::textures(&self.module, function)
            .map(|(place, name)| (place, self.texture(name)))
            .collect();
        for (place, view) in &views {
            entries.push(wgpu::BindGroupEntry {
                binding: FIRST_TEXTURE + place,
                resource: wgpu::BindingResource::TextureView(view),
            });
        }
        let sampler = self.device.create_sampler(&wgpu::SamplerDescriptor {
            mag_filter: wgpu::FilterMode::Linear,
            min_filter: wgpu::FilterMode::Linear,
            ..Default::default()
        });
        if !views.is_empty() {
            entries.push(wgpu::BindGroupEntry {
                binding: SAMPLER,
                resource: wgpu::BindingResource::Sampler(&sampler),
            });
        }
        if !arguments[0].is_empty() {
            entries.push(wgpu::BindGroupEntry {
                binding: 0,
                resource: inputs.as_entire_binding(),
            });
        }
        let group = self.device.create_bind_group(&wgpu::BindGroupDescriptor {
            label: None,
            layout: &pipeline.get_bind_group_layout(0),
            entries: &entries,
        });
        let mut encoder = self
            .device
            .create_command_encoder(&wgpu::CommandEncoderDescriptor::default());
        {
            let mut pass = encoder.begin_compute_pass(&wgpu::ComputePassDescriptor::default());
            pass.set_pipeline(&pipeline);
            pass.set_bind_group(0, &group, &[]);
            pass.dispatch_workgroups(arguments.len().div_ceil(64) as u32, 1, 1);
        }
        encoder.copy_buffer_to_buffer(&outputs, 0, &readable, 0, bytes);
        self.queue.submit([encoder.finish()]);
        readable.slice(..).map_async(wgpu::MapMode::Read, |result| {
            result.expect("results of the device");
        });
        self.device
            .poll(wgpu::PollType::wait_indefinitely())
            .expect("a device that is not lost");
        let view = readable
            .slice(..)
            .get_mapped_range()
            .expect("mapped results");
        let results: Vec<f32> = view
            .as_chunks::<4>()
            .0
            .iter()
            .map(|bytes| f32::from_ne_bytes(*bytes))
            .collect();
        results.chunks(width).map(<[f32]>::to_vec).collect()
    }
}

impl Device {
    /// A texture of [`textures`] on the device.
    fn texture(&self, name: &str) -> wgpu::TextureView {
        let texture = textures::named(name);
        let [width, height, depth] = texture.size().map(|n| n as u32);
        let bytes = texture.half_float_bytes();
        let descriptor = wgpu::TextureDescriptor {
            label: Some(name),
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
            usage: wgpu::TextureUsages::TEXTURE_BINDING | wgpu::TextureUsages::COPY_DST,
            view_formats: &[],
        };
        let order = wgpu::util::TextureDataOrder::default();
        self.device
            .create_texture_with_data(&self.queue, &descriptor, order, &bytes)
            .create_view(&wgpu::TextureViewDescriptor::default())
    }
}

/// The library with a compute shader for each function, which reads rows of arguments and writes rows of results.
fn with_entry_points(module: &naga::Module) -> String {
    let mut text = source(Part::ALL);
    text.push_str(
        "
        @group(0) @binding(0) var<storage, read> arguments: array<f32>;
        @group(0) @binding(1) var<storage, read_write> results: array<f32>;
        ",
    );
    writeln!(
        text,
        "@group(0) @binding({SAMPLER}) var linear_sampler_of_all: sampler;"
    )
    .expect("a text");
    for (place, name) in textures::NAMES.iter().enumerate() {
        let dimension = textures::dimension(name);
        writeln!(
            text,
            "@group(0) @binding({}) var {name}: texture_{dimension}d<f32>;",
            FIRST_TEXTURE + place as u32
        )
        .expect("a text");
    }
    for (_, function) in module.functions.iter() {
        let name = function.name.as_deref().expect("the name of a function");
        let mut width = 0;
        let values: Vec<String> = function
            .arguments
            .iter()
            .map(|argument| module::argument(module, argument, "arguments[first + ", &mut width))
            .collect();
        let result = function.result.as_ref().expect("a result");
        let numbers = module::write(module, result.ty, "result");
        write!(
            text,
            "@compute @workgroup_size(64)
            fn run_{name}(@builtin(global_invocation_id) id: vec3<u32>) {{
                if id.x * {count}u >= arrayLength(&results) {{ return; }}
                let first = id.x * {width}u;
                let result = {name}({values});
                let into = id.x * {count}u;
                ",
            count = numbers.len(),
            values = values.join(", "),
        )
        .expect("a text");
        for (k, number) in numbers.iter().enumerate() {
            writeln!(text, "results[into + {k}u] = {number};").expect("a text");
        }
        text.push_str("}\n");
    }
    text
}
