//! Tables on the device: the first group of a pass.

use crate::pass::{UNIFORM, bind_group, group_layout, texture, uniform};
use airlight_shaders::twins::texture::Texture;
use wgpu::TextureViewDimension;
use wgpu::util::{DeviceExt, TextureDataOrder};

/// A texture of two dimensions.
pub const FLAT: TextureViewDimension = TextureViewDimension::D2;
/// A texture of three dimensions.
pub const SOLID: TextureViewDimension = TextureViewDimension::D3;

/// Layout of a group: numbers, a sampler, and textures.
pub fn layout(device: &wgpu::Device, textures: &[TextureViewDimension]) -> wgpu::BindGroupLayout {
    let sampler = wgpu::BindingType::Sampler(wgpu::SamplerBindingType::Filtering);
    let mut types = vec![UNIFORM, sampler];
    types.extend(textures.iter().map(|&view| texture(view, true)));
    group_layout(device, "airlight tables", &types)
}

/// Uploads numbers and textures, which the group keeps alive.
pub fn group(
    (device, queue): (&wgpu::Device, &wgpu::Queue),
    layout: &wgpu::BindGroupLayout,
    numbers: &[f32],
    textures: &[&Texture],
) -> wgpu::BindGroup {
    let sampler = device.create_sampler(&wgpu::SamplerDescriptor {
        label: Some("airlight tables"),
        mag_filter: wgpu::FilterMode::Linear,
        min_filter: wgpu::FilterMode::Linear,
        ..Default::default()
    });
    let views: Vec<_> = textures
        .iter()
        .map(|texture| upload(device, queue, texture))
        .collect();
    bind(device, layout, numbers, &sampler, &views)
}

/// Uploads numbers for a group with a sampler and textures that are on the device.
pub fn bind(
    device: &wgpu::Device,
    layout: &wgpu::BindGroupLayout,
    numbers: &[f32],
    sampler: &wgpu::Sampler,
    views: &[wgpu::TextureView],
) -> wgpu::BindGroup {
    let numbers = uniform(device, "airlight numbers", numbers);
    let mut resources = vec![
        numbers.as_entire_binding(),
        wgpu::BindingResource::Sampler(sampler),
    ];
    resources.extend(views.iter().map(wgpu::BindingResource::TextureView));
    bind_group(device, layout, "airlight tables", &resources)
}

/// A texture of half floats.
pub fn upload(device: &wgpu::Device, queue: &wgpu::Queue, texture: &Texture) -> wgpu::TextureView {
    let [width, height, depth] = texture.size().map(|n| n as u32);
    let bytes = texture.half_float_bytes();
    let descriptor = wgpu::TextureDescriptor {
        label: Some("airlight table"),
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
    device
        .create_texture_with_data(queue, &descriptor, TextureDataOrder::default(), &bytes)
        .create_view(&wgpu::TextureViewDescriptor::default())
}
