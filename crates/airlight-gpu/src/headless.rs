//! Frames without a window, for tests, comparisons and pictures: a device, square frames with geometry at given distances, and their
//! pixels.

use crate::camera::{Camera, Projection};
use crate::error::SkyRendererError;
use crate::pass::{bytes, filled};
use crate::passes::SkyPasses;
use crate::read::{ReadTextureError, read_buffer, read_rgb};
use glam::{Mat4, Vec3};

/// Format of the target of [`Headless::draw`].
pub const FORMAT: wgpu::TextureFormat = wgpu::TextureFormat::Rgba16Float;
/// Distance of the near plane of a [`Frame`], m.
const NEAR_M: f32 = 0.1;

/// Writes the colour of geometry and the depth of a storage buffer.
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

/// Error of [`Headless`].
#[derive(Clone, Debug, PartialEq, Eq, thiserror::Error)]
#[non_exhaustive]
pub enum HeadlessError {
    /// No device could be had.
    #[error(
        "no Vulkan device to draw with ({0}): install a driver; on Debian: apt-get install mesa-vulkan-drivers libvulkan1"
    )]
    NoDevice(String),
    /// The pixels could not be read.
    #[error(transparent)]
    Pixels(#[from] ReadTextureError),
}

/// A device that draws without a window.
#[derive(Debug)]
pub struct Headless {
    /// The device.
    pub device: wgpu::Device,
    /// Its queue.
    pub queue: wgpu::Queue,
    /// Name of the adapter.
    pub name: String,
    /// Name and version of its driver.
    pub driver: String,
    geometry: wgpu::RenderPipeline,
}

/// A square frame of 90 degrees.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Frame {
    /// Pixels on a side.
    pub side: u32,
    /// From the world around the eye to clip space, with reversed infinite depth.
    pub clip_from_world: Mat4,
}

/// What a frame holds before the passes of the air.
#[derive(Clone, Copy)]
pub struct Geometry<'a> {
    /// Linear red, green and blue, times the exposure.
    pub colour: [f64; 3],
    /// Distance of the pixel in a column and a row, m, infinite where there is none.
    pub distance_m: &'a dyn Fn(u32, u32) -> f32,
}

impl std::fmt::Debug for Geometry<'_> {
    fn fmt(&self, f: &mut std::fmt::Formatter<'_>) -> std::fmt::Result {
        f.debug_struct("Geometry")
            .field("colour", &self.colour)
            .finish_non_exhaustive()
    }
}

impl Frame {
    /// A frame around a direction.
    pub fn towards(direction: Vec3, side: u32) -> Self {
        let up = if direction.y.abs() > 0.99 {
            Vec3::X
        } else {
            Vec3::Y
        };
        let view = glam::camera::rh::view::look_to_mat4(Vec3::ZERO, direction, up);
        // Depth 1 at the near plane and 0 at infinity.
        let projection = Mat4::from_cols_array_2d(&[
            [1.0, 0.0, 0.0, 0.0],
            [0.0, 1.0, 0.0, 0.0],
            [0.0, 0.0, 0.0, -1.0],
            [0.0, 0.0, NEAR_M, 0.0],
        ]);
        Self {
            side,
            clip_from_world: projection * view,
        }
    }

    /// The camera of the frame.
    ///
    /// # Errors
    /// As [`Camera::new`].
    pub fn camera(&self, exposure: f32) -> Result<Camera, SkyRendererError> {
        let perspective = Projection::Perspective {
            world_from_clip: self.clip_from_world.inverse(),
            far_depth: 0.0,
        };
        Camera::new(perspective, exposure)
    }

    /// Unit vector through the middle of a pixel.
    pub fn direction(&self, x: u32, y: u32) -> Vec3 {
        let of = |p: u32| 2.0 * (p as f32 + 0.5) / self.side as f32 - 1.0;
        let near = self
            .clip_from_world
            .inverse()
            .project_point3(Vec3::new(of(x), -of(y), 1.0));
        near.normalize()
    }

    /// Column and row of the pixel that a direction passes through; `None` outside the frame.
    pub fn pixel(&self, direction: Vec3) -> Option<(u32, u32)> {
        let clip = self.clip_from_world * direction.extend(0.0);
        if clip.w <= 0.0 {
            return None;
        }
        let of = |x: f32| {
            let place = 0.5 * (x / clip.w + 1.0) * self.side as f32;
            (0.0..self.side as f32)
                .contains(&place)
                .then_some(place as u32)
        };
        Some((of(clip.x)?, of(-clip.y)?))
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

impl Headless {
    /// The first Vulkan device, with the [`SkyPasses::OPTIONAL_FEATURES`] if it has them.
    ///
    /// # Errors
    /// [`HeadlessError::NoDevice`] where there is none.
    pub fn new() -> Result<Self, HeadlessError> {
        Self::with_features(SkyPasses::OPTIONAL_FEATURES)
    }

    /// The first Vulkan device, with those of some features that it has.
    ///
    /// # Errors
    /// As [`Self::new`].
    pub fn with_features(features: wgpu::Features) -> Result<Self, HeadlessError> {
        let instance = wgpu::Instance::new(wgpu::InstanceDescriptor {
            backends: wgpu::Backends::VULKAN,
            ..wgpu::InstanceDescriptor::new_without_display_handle()
        });
        let adapter =
            pollster::block_on(instance.request_adapter(&wgpu::RequestAdapterOptions::default()))
                .map_err(|error| HeadlessError::NoDevice(error.to_string()))?;
        let info = adapter.get_info();
        let (device, queue) = pollster::block_on(adapter.request_device(&wgpu::DeviceDescriptor {
            required_features: features & adapter.features(),
            ..Default::default()
        }))
        .map_err(|error| HeadlessError::NoDevice(error.to_string()))?;
        Ok(Self {
            geometry: geometry_pipeline(&device),
            device,
            queue,
            driver: format!("{} {}", info.driver, info.driver_info),
            name: info.name,
        })
    }

    /// Linear red, green and blue of the pixels of a frame, row by row: black, or geometry, over which `record` draws into a target
    /// of [`FORMAT`] with its depth.
    ///
    /// # Errors
    /// [`HeadlessError::Pixels`] if the device is lost.
    pub fn draw(
        &self,
        frame: &Frame,
        geometry: Option<&Geometry<'_>>,
        record: impl FnOnce(&mut wgpu::CommandEncoder, &wgpu::TextureView, &wgpu::TextureView),
    ) -> Result<Vec<[f32; 3]>, HeadlessError> {
        let target = self.texture(frame.side, FORMAT, wgpu::TextureUsages::COPY_SRC);
        let depth = self.texture(
            frame.side,
            wgpu::TextureFormat::Depth32Float,
            wgpu::TextureUsages::TEXTURE_BINDING,
        );
        let [target_view, depth_view] =
            [&target, &depth].map(|t| t.create_view(&wgpu::TextureViewDescriptor::default()));
        let mut encoder = self
            .device
            .create_command_encoder(&wgpu::CommandEncoderDescriptor::default());
        self.draw_geometry(&mut encoder, [&target_view, &depth_view], frame, geometry);
        record(&mut encoder, &target_view, &depth_view);
        self.pixels(encoder, &target)
    }

    /// The bytes of a buffer that may be copied from, after what has been submitted.
    ///
    /// # Errors
    /// [`HeadlessError::Pixels`] if the device is lost.
    pub fn read_buffer(&self, buffer: &wgpu::Buffer) -> Result<Vec<u8>, HeadlessError> {
        Ok(read_buffer(&self.device, &self.queue, buffer)?)
    }

    fn texture(
        &self,
        side: u32,
        format: wgpu::TextureFormat,
        usage: wgpu::TextureUsages,
    ) -> wgpu::Texture {
        self.device.create_texture(&wgpu::TextureDescriptor {
            label: Some("airlight frame"),
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
    }

    /// Fills target and depth, as a program's own pass does.
    fn draw_geometry(
        &self,
        encoder: &mut wgpu::CommandEncoder,
        [target, depth]: [&wgpu::TextureView; 2],
        frame: &Frame,
        geometry: Option<&Geometry<'_>>,
    ) {
        let side = frame.side;
        let pixels = (0..side * side).map(|k| (k % side, k / side));
        let of_pixel = |(x, y)| geometry.map_or(0.0, |g| frame.depth(x, y, (g.distance_m)(x, y)));
        let depths: Vec<f32> = pixels.map(of_pixel).collect();
        let colour = geometry.map_or([0.0; 3], |g| g.colour);
        let buffer =
            |contents: &[u8], usage| filled(&self.device, "airlight geometry", contents, usage);
        let depths = buffer(&bytes(&depths), wgpu::BufferUsages::STORAGE);
        let mut surface = bytes(&colour.map(|c| c as f32));
        surface.extend(side.to_ne_bytes());
        let surface = buffer(&surface, wgpu::BufferUsages::UNIFORM);
        let group = self.device.create_bind_group(&wgpu::BindGroupDescriptor {
            label: Some("airlight geometry"),
            layout: &self.geometry.get_bind_group_layout(0),
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
            label: Some("airlight geometry"),
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
        pass.set_pipeline(&self.geometry);
        pass.set_bind_group(0, &group, &[]);
        pass.draw(0..3, 0..1);
    }

    /// Submits the commands and reads the pixels of a target.
    fn pixels(
        &self,
        encoder: wgpu::CommandEncoder,
        target: &wgpu::Texture,
    ) -> Result<Vec<[f32; 3]>, HeadlessError> {
        self.queue.submit([encoder.finish()]);
        Ok(read_rgb(&self.device, &self.queue, target)?)
    }
}

fn geometry_pipeline(device: &wgpu::Device) -> wgpu::RenderPipeline {
    let shader = device.create_shader_module(wgpu::ShaderModuleDescriptor {
        label: Some("airlight geometry"),
        source: wgpu::ShaderSource::Wgsl(GEOMETRY.into()),
    });
    device.create_render_pipeline(&wgpu::RenderPipelineDescriptor {
        label: Some("airlight geometry"),
        layout: None,
        vertex: wgpu::VertexState {
            module: &shader,
            entry_point: None,
            compilation_options: wgpu::PipelineCompilationOptions::default(),
            buffers: &[],
        },
        primitive: wgpu::PrimitiveState::default(),
        depth_stencil: Some(wgpu::DepthStencilState {
            format: wgpu::TextureFormat::Depth32Float,
            depth_write_enabled: Some(true),
            depth_compare: Some(wgpu::CompareFunction::Always),
            stencil: wgpu::StencilState::default(),
            bias: wgpu::DepthBiasState::default(),
        }),
        multisample: wgpu::MultisampleState::default(),
        fragment: Some(wgpu::FragmentState {
            module: &shader,
            entry_point: None,
            compilation_options: wgpu::PipelineCompilationOptions::default(),
            targets: &[Some(wgpu::ColorTargetState {
                format: FORMAT,
                blend: None,
                write_mask: wgpu::ColorWrites::ALL,
            })],
        }),
        multiview_mask: None,
        cache: None,
    })
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn pixels_are_where_their_directions_pass() {
        for towards in [Vec3::X, Vec3::Y, Vec3::new(0.6, -0.64, 0.48)] {
            let frame = Frame::towards(towards, 16);
            assert_eq!(frame.pixel(-towards), None);
            for (x, y) in [(0, 0), (3, 9), (15, 15)] {
                assert_eq!(frame.pixel(frame.direction(x, y)), Some((x, y)));
                let point = 250.0 * frame.direction(x, y);
                let clip = frame.clip_from_world.project_point3(point);
                assert!((frame.depth(x, y, 250.0) / clip.z - 1.0).abs() < 1e-5);
            }
        }
    }
}
