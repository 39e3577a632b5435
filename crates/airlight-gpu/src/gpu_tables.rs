//! Tables on the device: the first group of a pass.

use crate::pass::{UNIFORM, bind_group, group_layout, texture, uniform};
use airlight_shaders::twins::texture::Texture;
use wgpu::TextureViewDimension;
use wgpu::util::{DeviceExt, TextureDataOrder};

/// Format of the textures.
pub const FORMAT: wgpu::TextureFormat = wgpu::TextureFormat::Rgba16Float;
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

/// Textures on the device, which groups share and keep alive.
pub struct Tables {
    sampler: wgpu::Sampler,
    views: Vec<wgpu::TextureView>,
}

impl Tables {
    /// Uploads textures.
    pub fn new((device, queue): (&wgpu::Device, &wgpu::Queue), textures: &[&Texture]) -> Self {
        let views = textures.iter();
        Self {
            sampler: device.create_sampler(&wgpu::SamplerDescriptor {
                label: Some("airlight tables"),
                mag_filter: wgpu::FilterMode::Linear,
                min_filter: wgpu::FilterMode::Linear,
                ..Default::default()
            }),
            views: views.map(|of| upload(device, queue, of)).collect(),
        }
    }

    /// A group of them, with numbers.
    pub fn group(
        &self,
        device: &wgpu::Device,
        layout: &wgpu::BindGroupLayout,
        numbers: &[f32],
    ) -> wgpu::BindGroup {
        bind(device, layout, numbers, &self.sampler, &self.views)
    }

    /// The same with another texture in the place of one of them.
    pub fn with(self, place: usize, view: wgpu::TextureView) -> Self {
        let mut views = self.views;
        views[place] = view;
        Self { views, ..self }
    }
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
        format: FORMAT,
        usage: wgpu::TextureUsages::TEXTURE_BINDING | wgpu::TextureUsages::COPY_DST,
        view_formats: &[],
    };
    device
        .create_texture_with_data(queue, &descriptor, TextureDataOrder::default(), &bytes)
        .create_view(&wgpu::TextureViewDescriptor::default())
}

/// A texture of two dimensions that a pass fills.
pub fn target(device: &wgpu::Device, [width, height]: [u32; 2]) -> wgpu::TextureView {
    let texture = device.create_texture(&wgpu::TextureDescriptor {
        label: Some("airlight table"),
        size: wgpu::Extent3d {
            width,
            height,
            depth_or_array_layers: 1,
        },
        mip_level_count: 1,
        sample_count: 1,
        dimension: wgpu::TextureDimension::D2,
        format: FORMAT,
        usage: wgpu::TextureUsages::TEXTURE_BINDING | wgpu::TextureUsages::RENDER_ATTACHMENT,
        view_formats: &[],
    });
    texture.create_view(&wgpu::TextureViewDescriptor::default())
}
