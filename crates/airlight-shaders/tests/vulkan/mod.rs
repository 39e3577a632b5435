//! The Vulkan device of the tests.

use airlight_shaders::twins::texture::Texture;
use wgpu::util::{DeviceExt, TextureDataOrder};

/// The first Vulkan device, with its name and driver.
///
/// # Panics
/// If there is none, with the way to get one.
pub fn open() -> (String, wgpu::Device, wgpu::Queue) {
    let instance = wgpu::Instance::new(wgpu::InstanceDescriptor {
        backends: wgpu::Backends::VULKAN,
        ..wgpu::InstanceDescriptor::new_without_display_handle()
    });
    let adapter =
        pollster::block_on(instance.request_adapter(&wgpu::RequestAdapterOptions::default()))
            .unwrap_or_else(|e| {
                panic!(
                    "no Vulkan device to run shaders on ({e}): install a driver; on Debian: \
                     apt-get install mesa-vulkan-drivers libvulkan1"
                )
            });
    let (device, queue) =
        pollster::block_on(adapter.request_device(&wgpu::DeviceDescriptor::default()))
            .expect("a device of the adapter");
    let info = adapter.get_info();
    let name = format!("{}, {}", info.name, info.driver_info);
    (name, device, queue)
}

/// A table on the device.
pub fn uploaded(device: &wgpu::Device, queue: &wgpu::Queue, table: &Texture) -> wgpu::TextureView {
    let [width, height, depth] = table.size().map(|n| n as u32);
    let descriptor = wgpu::TextureDescriptor {
        label: None,
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
    let bytes = table.half_float_bytes();
    let order = TextureDataOrder::default();
    let texture = device.create_texture_with_data(queue, &descriptor, order, &bytes);
    texture.create_view(&Default::default())
}

/// Bytes of a buffer that may be copied from.
pub fn read(device: &wgpu::Device, queue: &wgpu::Queue, buffer: &wgpu::Buffer) -> Vec<u8> {
    let readable = device.create_buffer(&wgpu::BufferDescriptor {
        label: None,
        size: buffer.size(),
        usage: wgpu::BufferUsages::MAP_READ | wgpu::BufferUsages::COPY_DST,
        mapped_at_creation: false,
    });
    let mut encoder = device.create_command_encoder(&wgpu::CommandEncoderDescriptor::default());
    encoder.copy_buffer_to_buffer(buffer, 0, &readable, 0, buffer.size());
    queue.submit([encoder.finish()]);
    readable.slice(..).map_async(wgpu::MapMode::Read, |result| {
        result.expect("bytes of the device");
    });
    device
        .poll(wgpu::PollType::wait_indefinitely())
        .expect("a device that is not lost");
    let view = readable.slice(..).get_mapped_range();
    view.expect("mapped bytes").to_vec()
}
