//! The tables of a sky on the device.

use airlight::sky::View;
use airlight_shaders::twins::colour::RgbWeights;
use airlight_shaders::twins::texture::Texture;
use airlight_shaders::{SkyTables, WAVELENGTHS_NM};
use glam::Vec4;
use wgpu::util::{BufferInitDescriptor, DeviceExt, TextureDataOrder};

/// Texels of the table of the sun's disc.
const DISC_TEXELS: usize = 64;

/// The bind group of the passes' first group, with the buffers and textures that it keeps alive.
#[derive(Debug)]
pub struct GpuTables {
    pub group: wgpu::BindGroup,
}

/// Layout of the first group: the numbers of the sky, a sampler, and the textures.
pub fn layout(device: &wgpu::Device) -> wgpu::BindGroupLayout {
    let entry = |binding, ty| wgpu::BindGroupLayoutEntry {
        binding,
        visibility: wgpu::ShaderStages::FRAGMENT,
        ty,
        count: None,
    };
    let texture = |view_dimension| wgpu::BindingType::Texture {
        sample_type: wgpu::TextureSampleType::Float { filterable: true },
        view_dimension,
        multisampled: false,
    };
    let (flat, solid) = (
        texture(wgpu::TextureViewDimension::D2),
        texture(wgpu::TextureViewDimension::D3),
    );
    let uniform = wgpu::BindingType::Buffer {
        ty: wgpu::BufferBindingType::Uniform,
        has_dynamic_offset: false,
        min_binding_size: None,
    };
    let sampler = wgpu::BindingType::Sampler(wgpu::SamplerBindingType::Filtering);
    device.create_bind_group_layout(&wgpu::BindGroupLayoutDescriptor {
        label: Some("airlight sky"),
        entries: &[
            entry(0, uniform),
            entry(1, sampler),
            entry(2, flat),
            entry(3, flat),
            entry(4, solid),
            entry(5, solid),
            entry(6, flat),
            entry(7, flat),
            entry(8, flat),
        ],
    })
}

impl GpuTables {
    /// Uploads the tables of a view.
    pub fn new(
        device: &wgpu::Device,
        queue: &wgpu::Queue,
        layout: &wgpu::BindGroupLayout,
        tables: &SkyTables,
        view: &View,
    ) -> Self {
        let disc = disc(view);
        let textures = [
            &tables.sky_smooth,
            &tables.sky_haze,
            &tables.aerial_smooth,
            &tables.aerial_haze,
            &tables.extinction,
            &tables.phase,
            &disc,
        ];
        let views = textures.map(|texture| upload(device, queue, texture));
        let numbers = device.create_buffer_init(&BufferInitDescriptor {
            label: Some("airlight sky"),
            contents: &bytes(&numbers(tables, view)),
            usage: wgpu::BufferUsages::UNIFORM,
        });
        let sampler = device.create_sampler(&wgpu::SamplerDescriptor {
            label: Some("airlight sky"),
            mag_filter: wgpu::FilterMode::Linear,
            min_filter: wgpu::FilterMode::Linear,
            ..Default::default()
        });
        let mut entries = vec![
            wgpu::BindGroupEntry {
                binding: 0,
                resource: numbers.as_entire_binding(),
            },
            wgpu::BindGroupEntry {
                binding: 1,
                resource: wgpu::BindingResource::Sampler(&sampler),
            },
        ];
        for (place, view) in views.iter().enumerate() {
            entries.push(wgpu::BindGroupEntry {
                binding: 2 + place as u32,
                resource: wgpu::BindingResource::TextureView(view),
            });
        }
        let group = device.create_bind_group(&wgpu::BindGroupDescriptor {
            label: Some("airlight sky"),
            layout,
            entries: &entries,
        });
        Self { group }
    }
}

/// The numbers of the shader's struct `Sky`.
fn numbers(tables: &SkyTables, view: &View) -> Vec<f32> {
    let mut all = tables.view.sun.to_array().to_vec();
    all.extend([
        tables.view.height_m,
        tables.view.ground_radius_m,
        tables.view.air_height_m,
        tables.view.horizon_rad,
        tables.view.highest_rad,
    ]);
    all.extend(tables.scales.smooth_light.to_array());
    all.extend(tables.scales.haze.to_array());
    let mut add = |weights: &RgbWeights| {
        for channel in [weights.red, weights.green, weights.blue] {
            all.extend(channel.to_array());
        }
    };
    add(&tables.radiance_weights);
    add(&tables.transmittance_weights);
    let half_sine = (0.5 * view.disc().angular_radius_rad).sin();
    all.extend([(2.0 * half_sine * half_sine) as f32, 0.0, 0.0, 0.0]);
    all
}

/// Radiance of the sun's disc outside the air, W m^-2 sr^-1 nm^-1, by the cosine at the sun's surface, 0 at the limb.
fn disc(view: &View) -> Texture {
    let solar = view.solar_irradiance();
    let disc = view.disc();
    let texels = (0..DISC_TEXELS).map(|k| {
        let mu = k as f64 / (DISC_TEXELS - 1) as f64;
        // The edge itself is outside the disc.
        let angle = disc.angular_radius_rad * (1.0 - mu * mu).sqrt().min(1.0 - 1e-9);
        Vec4::from_array(std::array::from_fn(|lane| {
            let relative = disc.radiance_per_irradiance(angle, WAVELENGTHS_NM[lane]);
            solar[lane] * relative as f32
        }))
    });
    Texture::new([DISC_TEXELS, 1, 1], texels.collect())
}

/// A texture of half floats.
fn upload(device: &wgpu::Device, queue: &wgpu::Queue, texture: &Texture) -> wgpu::TextureView {
    let [width, height, depth] = texture.size().map(|n| n as u32);
    let bytes = texture.half_float_bytes();
    let descriptor = wgpu::TextureDescriptor {
        label: Some("airlight sky"),
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

pub fn bytes(numbers: &[f32]) -> Vec<u8> {
    numbers.iter().flat_map(|x| x.to_ne_bytes()).collect()
}
