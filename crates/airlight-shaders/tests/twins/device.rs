//! A Vulkan device that computes functions of rows of numbers.

use crate::textures;
use crate::vulkan;
use airlight::Named;
use airlight_shaders::{ComputeEntryPoint, ComputeShader, Part, spirv_modules};
use wgpu::util::{BufferInitDescriptor, DeviceExt};

/// What the shaders are handed to the device as.
#[derive(Clone, Copy, PartialEq)]
pub enum Form {
    Wgsl,
    Spirv,
}

/// The device and the compute shaders of all parts.
pub struct Device {
    device: wgpu::Device,
    queue: wgpu::Queue,
    form: Form,
    shaders: Vec<(ComputeShader, wgpu::ShaderModule)>,
    /// What the device is, in words.
    pub name: String,
}

impl Device {
    /// The first Vulkan device ([`vulkan::open`]).
    pub fn new(form: Form) -> Self {
        let (name, device, queue) = vulkan::open();
        let shaders = Part::ALL.iter().map(|&part| {
            let shader = ComputeShader::new(part);
            let source = match form {
                Form::Wgsl => wgpu::ShaderSource::Wgsl(shader.wgsl.as_str().into()),
                Form::Spirv => {
                    let modules = spirv_modules(&[part]).expect("modules");
                    wgpu::ShaderSource::SpirV(modules[0].words.clone().into())
                }
            };
            let module = device.create_shader_module(wgpu::ShaderModuleDescriptor {
                label: None,
                source,
            });
            (shader, module)
        });
        let shaders = shaders.collect();
        Self {
            device,
            queue,
            form,
            shaders,
            name,
        }
    }

    /// The entry point of a function, with its shader.
    fn entry_point(&self, name: &str) -> (&ComputeShader, &ComputeEntryPoint, &wgpu::ShaderModule) {
        let mut all = self.shaders.iter().flat_map(|(shader, module)| {
            let entries = shader.entry_points.iter();
            entries.map(move |entry| (shader, entry, module))
        });
        let named = |(_, entry, _): &(_, &ComputeEntryPoint, _)| entry.function == name;
        all.find(named).expect("a function of the library")
    }

    /// Results of a function for rows of its arguments.
    pub fn run(&self, name: &str, arguments: &[Vec<f32>]) -> Vec<Vec<f32>> {
        let (shader, entry, module) = self.entry_point(name);
        let width = entry.results;
        assert!(arguments.iter().all(|row| row.len() == entry.arguments));
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
        let outputs = self.device.create_buffer(&wgpu::BufferDescriptor {
            label: None,
            size: bytes,
            usage: wgpu::BufferUsages::STORAGE | wgpu::BufferUsages::COPY_SRC,
            mapped_at_creation: false,
        });
        let pipeline = self
            .device
            .create_compute_pipeline(&wgpu::ComputePipelineDescriptor {
                label: Some(name),
                layout: None,
                module,
                entry_point: Some(&match self.form {
                    Form::Wgsl => entry.name(),
                    Form::Spirv => name.to_owned(),
                }),
                compilation_options: wgpu::PipelineCompilationOptions::default(),
                cache: None,
            });
        let mut entries = vec![wgpu::BindGroupEntry {
            binding: 1,
            resource: outputs.as_entire_binding(),
        }];
        let places = entry.textures.iter();
        let views: Vec<(u32, wgpu::TextureView)> = places
            .map(|&place| {
                let table = textures::named(&shader.textures[place].name());
                let view = vulkan::uploaded(&self.device, &self.queue, table);
                (place as u32, view)
            })
            .collect();
        for (place, view) in &views {
            entries.push(wgpu::BindGroupEntry {
                binding: ComputeShader::FIRST_TEXTURE + place,
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
                binding: ComputeShader::SAMPLER,
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
            let groups = (arguments.len() as u32).div_ceil(ComputeShader::WORKGROUP_SIZE);
            pass.dispatch_workgroups(groups, 1, 1);
        }
        self.queue.submit([encoder.finish()]);
        let results = vulkan::read(&self.device, &self.queue, &outputs);
        let results: Vec<f32> = results
            .as_chunks::<4>()
            .0
            .iter()
            .map(|bytes| f32::from_ne_bytes(*bytes))
            .collect();
        results.chunks(width).map(<[f32]>::to_vec).collect()
    }
}
