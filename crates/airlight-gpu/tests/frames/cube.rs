//! Samples of cube maps.

use airlight_gpu::headless::Headless;
use glam::Vec3;
use wgpu::util::{BufferInitDescriptor, DeviceExt};

/// Samples a cube in directions.
const SAMPLE_CUBE: &str = "
@group(0) @binding(0) var cube: texture_cube<f32>;
@group(0) @binding(1) var cube_sampler: sampler;
@group(0) @binding(2) var<storage, read_write> values: array<vec4<f32>>;
@compute @workgroup_size(64) fn sample(@builtin(global_invocation_id) id: vec3<u32>) {
    if id.x < arrayLength(&values) {
        let direction = values[id.x];
        values[id.x] = textureSampleLevel(cube, cube_sampler, direction.xyz, direction.w);
    }
}";

/// Red, green and blue of a cube in directions, at a level.
pub fn sample_cube(
    gpu: &Headless,
    cube: &wgpu::TextureView,
    directions: &[Vec3],
    level: f32,
) -> Vec<Vec3> {
    let device = &gpu.device;
    let module = device.create_shader_module(wgpu::ShaderModuleDescriptor {
        label: None,
        source: wgpu::ShaderSource::Wgsl(SAMPLE_CUBE.into()),
    });
    let pipeline = device.create_compute_pipeline(&wgpu::ComputePipelineDescriptor {
        label: None,
        layout: None,
        module: &module,
        entry_point: None,
        compilation_options: Default::default(),
        cache: None,
    });
    let numbers = directions.iter().flat_map(|d| d.extend(level).to_array());
    let contents: Vec<u8> = numbers.flat_map(f32::to_ne_bytes).collect();
    let values = device.create_buffer_init(&BufferInitDescriptor {
        label: None,
        contents: &contents,
        usage: wgpu::BufferUsages::STORAGE | wgpu::BufferUsages::COPY_SRC,
    });
    let sampler = device.create_sampler(&wgpu::SamplerDescriptor {
        mag_filter: wgpu::FilterMode::Linear,
        min_filter: wgpu::FilterMode::Linear,
        ..Default::default()
    });
    let group = device.create_bind_group(&wgpu::BindGroupDescriptor {
        label: None,
        layout: &pipeline.get_bind_group_layout(0),
        entries: &[
            wgpu::BindGroupEntry {
                binding: 0,
                resource: wgpu::BindingResource::TextureView(cube),
            },
            wgpu::BindGroupEntry {
                binding: 1,
                resource: wgpu::BindingResource::Sampler(&sampler),
            },
            wgpu::BindGroupEntry {
                binding: 2,
                resource: values.as_entire_binding(),
            },
        ],
    });
    let buffer = device.create_buffer(&wgpu::BufferDescriptor {
        label: None,
        size: contents.len() as u64,
        usage: wgpu::BufferUsages::MAP_READ | wgpu::BufferUsages::COPY_DST,
        mapped_at_creation: false,
    });
    let mut encoder = device.create_command_encoder(&Default::default());
    let mut pass = encoder.begin_compute_pass(&Default::default());
    pass.set_pipeline(&pipeline);
    pass.set_bind_group(0, &group, &[]);
    pass.dispatch_workgroups((directions.len() as u32).div_ceil(64), 1, 1);
    drop(pass);
    encoder.copy_buffer_to_buffer(&values, 0, &buffer, 0, contents.len() as u64);
    gpu.queue.submit([encoder.finish()]);
    buffer.slice(..).map_async(wgpu::MapMode::Read, |result| {
        result.expect("the values of the cube");
    });
    device
        .poll(wgpu::PollType::wait_indefinitely())
        .expect("a device that is not lost");
    let bytes = buffer.slice(..).get_mapped_range().expect("mapped values");
    let texels = bytes.as_chunks::<16>().0.iter();
    let number =
        |texel: &[u8; 16], c: usize| f32::from_ne_bytes(std::array::from_fn(|k| texel[4 * c + k]));
    texels
        .map(|texel| Vec3::from_array(std::array::from_fn(|c| number(texel, c))))
        .collect()
}
