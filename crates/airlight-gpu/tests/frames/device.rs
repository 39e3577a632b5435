//! A device without a window: frames with a depth and a colour, and their pixels.

use airlight_gpu::{Camera, Projection, SkyRenderer};
use glam::{Mat4, Vec3};
use half::f16;
use wgpu::util::{BufferInitDescriptor, DeviceExt};

/// Format of the target.
pub const FORMAT: wgpu::TextureFormat = wgpu::TextureFormat::Rgba16Float;
/// Distance of the near plane, m.
const NEAR_M: f32 = 0.1;

/// Writes the depth of a storage buffer.
const GEOMETRY: &str = "
@group(0) @binding(0) var<storage, read> depths: array<f32>;
struct Surface { colour: vec3<f32>, width: u32 }
@group(0) @binding(1) var<uniform> surface: Surface;
struct Out { @location(0) colour: vec4<f32>, @builtin(frag_depth) depth: f32 }
@vertex fn corner(@builtin(vertex_index) i: u32) -> @builtin(position) vec4<f32> {
    return vec4<f32>(vec2<f32>(f32(i & 1u), f32(i >> 1u)) * 4.0 - 1.0, 0.0, 1.0);
}
@fragment fn draw(@builtin(position) p: vec4<f32>) -> Out {
    let depth = depths[u32(p.y) * surface.width + u32(p.x)];
    return Out(vec4<f32>(select(vec3<f32>(0.0), surface.colour, depth > 0.0), 1.0), depth);
}";

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

/// A device and its queue.
pub struct Gpu {
    pub device: wgpu::Device,
    pub queue: wgpu::Queue,
    pub name: String,
}

/// A square frame.
#[derive(Clone, Copy)]
pub struct Frame {
    /// Pixels on a side.
    pub side: u32,
    /// From the world around the eye to clip space, with reversed infinite depth.
    pub clip_from_world: Mat4,
}

impl Frame {
    /// A frame of 90 degrees around a direction.
    pub fn towards(direction: Vec3, side: u32) -> Self {
        let up = if direction.y.abs() > 0.99 {
            Vec3::X
        } else {
            Vec3::Y
        };
        let view = glam::camera::rh::view::look_to_mat4(Vec3::ZERO, direction, up);
        Self {
            side,
            clip_from_world: infinite_reversed(std::f32::consts::FRAC_PI_2) * view,
        }
    }

    pub fn camera(&self, exposure: f32) -> Camera {
        Camera {
            projection: Projection::Perspective {
                world_from_clip: self.clip_from_world.inverse(),
                far_depth: 0.0,
            },
            exposure,
        }
    }

    /// Direction through the middle of a pixel.
    pub fn direction(&self, x: u32, y: u32) -> Vec3 {
        let of = |p: u32| 2.0 * (p as f32 + 0.5) / self.side as f32 - 1.0;
        let near = self
            .clip_from_world
            .inverse()
            .project_point3(Vec3::new(of(x), -of(y), 1.0));
        near.normalize()
    }

    /// Depth of a point at a distance in a pixel, 0 at infinity.
    fn depth(&self, x: u32, y: u32, distance_m: f32) -> f32 {
        if distance_m.is_infinite() {
            return 0.0;
        }
        self.clip_from_world
            .project_point3(self.direction(x, y) * distance_m)
            .z
    }
}

/// Projection with depth 1 at the near plane and 0 at infinity.
fn infinite_reversed(field_of_view: f32) -> Mat4 {
    let scale = 1.0 / (0.5 * field_of_view).tan();
    Mat4::from_cols_array_2d(&[
        [scale, 0.0, 0.0, 0.0],
        [0.0, scale, 0.0, 0.0],
        [0.0, 0.0, 0.0, -1.0],
        [0.0, 0.0, NEAR_M, 0.0],
    ])
}

impl Gpu {
    /// The first Vulkan device.
    pub fn new() -> Self {
        let instance = wgpu::Instance::new(wgpu::InstanceDescriptor {
            backends: wgpu::Backends::VULKAN,
            ..wgpu::InstanceDescriptor::new_without_display_handle()
        });
        let adapter =
            pollster::block_on(instance.request_adapter(&wgpu::RequestAdapterOptions::default()))
                .unwrap_or_else(|e| {
                    panic!(
                        "no Vulkan device to draw with ({e}): install a driver; on Debian: \
                         apt-get install mesa-vulkan-drivers libvulkan1"
                    )
                });
        let name = adapter.get_info().name;
        let (device, queue) =
            pollster::block_on(adapter.request_device(&wgpu::DeviceDescriptor::default()))
                .expect("a device of the adapter");
        Self {
            device,
            queue,
            name,
        }
    }

    /// Pixels of a frame with geometry of the colour `before` at the distances, or none.
    pub fn draw(
        &self,
        renderer: &mut SkyRenderer,
        frame: &Frame,
        exposure: f32,
        before: [f64; 3],
        distances_m: Option<&dyn Fn(u32, u32) -> f32>,
    ) -> Vec<[f32; 3]> {
        let camera = frame.camera(exposure);
        self.draw_program(frame, before, distances_m, |encoder, target, depth| {
            renderer.record(encoder, target, depth, &camera);
        })
    }

    /// Pixels of a program's frame, with geometry of one colour before black, over which `record` draws.
    pub fn draw_program(
        &self,
        frame: &Frame,
        before: [f64; 3],
        distances_m: Option<&dyn Fn(u32, u32) -> f32>,
        record: impl FnOnce(&mut wgpu::CommandEncoder, &wgpu::TextureView, &wgpu::TextureView),
    ) -> Vec<[f32; 3]> {
        let side = frame.side;
        let texture = |format, usage| {
            self.device.create_texture(&wgpu::TextureDescriptor {
                label: None,
                size: wgpu::Extent3d {
                    width: side,
                    height: side,
                    depth_or_array_layers: 1,
                },
                mip_level_count: 1,
                sample_count: 1,
                dimension: wgpu::TextureDimension::D2,
                format,
                usage: usage | wgpu::TextureUsages::RENDER_ATTACHMENT,
                view_formats: &[],
            })
        };
        let target = texture(FORMAT, wgpu::TextureUsages::COPY_SRC);
        let depth = texture(
            wgpu::TextureFormat::Depth32Float,
            wgpu::TextureUsages::TEXTURE_BINDING,
        );
        let [target_view, depth_view] =
            [&target, &depth].map(|t| t.create_view(&Default::default()));
        let mut encoder = self.device.create_command_encoder(&Default::default());
        let pixels = (0..side * side).map(|k| (k % side, k / side));
        let depths: Vec<f32> = pixels
            .map(|(x, y)| distances_m.map_or(0.0, |m| frame.depth(x, y, m(x, y))))
            .collect();
        self.clear(
            &mut encoder,
            &target_view,
            &depth_view,
            before,
            &depths,
            side,
        );
        record(&mut encoder, &target_view, &depth_view);
        let bytes_per_row = (side * 8).next_multiple_of(256);
        let buffer = self.device.create_buffer(&wgpu::BufferDescriptor {
            label: None,
            size: u64::from(bytes_per_row * side),
            usage: wgpu::BufferUsages::MAP_READ | wgpu::BufferUsages::COPY_DST,
            mapped_at_creation: false,
        });
        encoder.copy_texture_to_buffer(
            target.as_image_copy(),
            wgpu::TexelCopyBufferInfo {
                buffer: &buffer,
                layout: wgpu::TexelCopyBufferLayout {
                    offset: 0,
                    bytes_per_row: Some(bytes_per_row),
                    rows_per_image: None,
                },
            },
            target.size(),
        );
        self.queue.submit([encoder.finish()]);
        buffer.slice(..).map_async(wgpu::MapMode::Read, |result| {
            result.expect("the pixels of the frame");
        });
        self.device
            .poll(wgpu::PollType::wait_indefinitely())
            .expect("a device that is not lost");
        let bytes = buffer.slice(..).get_mapped_range().expect("mapped pixels");
        let mut pixels = Vec::new();
        for row in bytes.chunks(bytes_per_row as usize) {
            for pixel in row[..side as usize * 8].as_chunks::<8>().0 {
                pixels.push(std::array::from_fn(|c| {
                    f16::from_ne_bytes([pixel[2 * c], pixel[2 * c + 1]]).to_f32()
                }));
            }
        }
        pixels
    }

    /// Red, green and blue of a cube in directions, at a level.
    pub fn sample_cube(
        &self,
        cube: &wgpu::TextureView,
        directions: &[Vec3],
        level: f32,
    ) -> Vec<Vec3> {
        let device = &self.device;
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
        self.queue.submit([encoder.finish()]);
        buffer.slice(..).map_async(wgpu::MapMode::Read, |result| {
            result.expect("the values of the cube");
        });
        device
            .poll(wgpu::PollType::wait_indefinitely())
            .expect("a device that is not lost");
        let bytes = buffer.slice(..).get_mapped_range().expect("mapped values");
        let texels = bytes.as_chunks::<16>().0.iter();
        let number = |texel: &[u8; 16], c: usize| {
            f32::from_ne_bytes(std::array::from_fn(|k| texel[4 * c + k]))
        };
        texels
            .map(|texel| Vec3::from_array(std::array::from_fn(|c| number(texel, c))))
            .collect()
    }

    /// Fills target and depth, as a program's own pass does.
    fn clear(
        &self,
        encoder: &mut wgpu::CommandEncoder,
        target: &wgpu::TextureView,
        depth: &wgpu::TextureView,
        colour: [f64; 3],
        depths: &[f32],
        side: u32,
    ) {
        let shader = self
            .device
            .create_shader_module(wgpu::ShaderModuleDescriptor {
                label: None,
                source: wgpu::ShaderSource::Wgsl(GEOMETRY.into()),
            });
        let pipeline = self
            .device
            .create_render_pipeline(&wgpu::RenderPipelineDescriptor {
                label: None,
                layout: None,
                vertex: wgpu::VertexState {
                    module: &shader,
                    entry_point: None,
                    compilation_options: Default::default(),
                    buffers: &[],
                },
                primitive: Default::default(),
                depth_stencil: Some(wgpu::DepthStencilState {
                    format: wgpu::TextureFormat::Depth32Float,
                    depth_write_enabled: Some(true),
                    depth_compare: Some(wgpu::CompareFunction::Always),
                    stencil: Default::default(),
                    bias: Default::default(),
                }),
                multisample: Default::default(),
                fragment: Some(wgpu::FragmentState {
                    module: &shader,
                    entry_point: None,
                    compilation_options: Default::default(),
                    targets: &[Some(wgpu::ColorTargetState {
                        format: FORMAT,
                        blend: None,
                        write_mask: wgpu::ColorWrites::ALL,
                    })],
                }),
                multiview_mask: None,
                cache: None,
            });
        let buffer = |contents: &[u8], usage| {
            let descriptor = BufferInitDescriptor {
                label: None,
                contents,
                usage,
            };
            self.device.create_buffer_init(&descriptor)
        };
        let bytes: Vec<u8> = depths.iter().flat_map(|d| d.to_ne_bytes()).collect();
        let depths = buffer(&bytes, wgpu::BufferUsages::STORAGE);
        let colour = colour.iter().flat_map(|c| (*c as f32).to_ne_bytes());
        let surface: Vec<u8> = colour.chain(side.to_ne_bytes()).collect();
        let surface = buffer(&surface, wgpu::BufferUsages::UNIFORM);
        let group = self.device.create_bind_group(&wgpu::BindGroupDescriptor {
            label: None,
            layout: &pipeline.get_bind_group_layout(0),
            entries: &[
                wgpu::BindGroupEntry {
                    binding: 0,
                    resource: depths.as_entire_binding(),
                },
                wgpu::BindGroupEntry {
                    binding: 1,
                    resource: surface.as_entire_binding(),
                },
            ],
        });
        let mut pass = encoder.begin_render_pass(&wgpu::RenderPassDescriptor {
            label: None,
            color_attachments: &[Some(wgpu::RenderPassColorAttachment {
                view: target,
                depth_slice: None,
                resolve_target: None,
                ops: wgpu::Operations {
                    load: wgpu::LoadOp::Clear(wgpu::Color::BLACK),
                    store: wgpu::StoreOp::Store,
                },
            })],
            depth_stencil_attachment: Some(wgpu::RenderPassDepthStencilAttachment {
                view: depth,
                depth_ops: Some(wgpu::Operations {
                    load: wgpu::LoadOp::Clear(0.0),
                    store: wgpu::StoreOp::Store,
                }),
                stencil_ops: None,
            }),
            timestamp_writes: None,
            occlusion_query_set: None,
            multiview_mask: None,
        });
        pass.set_pipeline(&pipeline);
        pass.set_bind_group(0, &group, &[]);
        pass.draw(0..3, 0..1);
    }
}
