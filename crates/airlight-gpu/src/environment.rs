//! [`EnvironmentMap`].

use crate::error::SkyRendererError;
use crate::gpu_tables;
use crate::pass::{CORNER, Pass, cover, covering};
use glam::{Mat4, Vec3, Vec4};

/// Format of the map.
const FORMAT: wgpu::TextureFormat = wgpu::TextureFormat::Rgba16Float;
/// Texels on a side of the smallest level.
const SMALLEST: u32 = 8;
/// Texels on a side of the largest map.
const LARGEST: u32 = 2048;
/// Right, up and forward of the faces of a cube, in the order of its layers.
const FACES: [[Vec3; 3]; 6] = [
    [Vec3::NEG_Z, Vec3::Y, Vec3::X],
    [Vec3::Z, Vec3::Y, Vec3::NEG_X],
    [Vec3::X, Vec3::NEG_Z, Vec3::Y],
    [Vec3::X, Vec3::Z, Vec3::NEG_Y],
    [Vec3::X, Vec3::Y, Vec3::Z],
    [Vec3::NEG_X, Vec3::Y, Vec3::NEG_Z],
];

/// A cube of light from all directions for reflections, which [`SkyRenderer::record_environment`](crate::SkyRenderer::record_environment)
/// fills: the sky, the ground of the planet and the fog, without the sun's disc, whose light is that of
/// [`Lighting::sun_illuminance_lx`](crate::Lighting::sun_illuminance_lx).
///
/// Level 0 is what a mirror reflects; level *k* of *n* is what a surface of microfacets (GGX) with the roughness *k* / (*n* - 1), the
/// square root of its alpha, reflects when seen from above: the first sum of the split-sum approximation.
#[derive(Debug)]
pub struct EnvironmentMap {
    texture: wgpu::Texture,
    view: wgpu::TextureView,
    /// Level 0, and its means over ever larger texels.
    source: wgpu::Texture,
    /// Depth without geometry.
    depth: wgpu::TextureView,
    is_depth_clear: bool,
    /// Passes that fill the smaller levels of the source.
    halve: Filter,
    /// Passes that fill the rough levels from the source.
    reflect_rough: Filter,
    sky_pass: Pass,
    fog_pass: Pass,
}

/// Passes with one pipeline.
#[derive(Debug)]
struct Filter {
    pipeline: wgpu::RenderPipeline,
    /// A target for each pass, and what it draws from.
    faces: Vec<(wgpu::TextureView, wgpu::BindGroup)>,
}

impl Filter {
    fn record(&self, encoder: &mut wgpu::CommandEncoder) {
        for (target, group) in &self.faces {
            cover(
                encoder,
                "airlight environment",
                target,
                &self.pipeline,
                group,
            );
        }
    }
}

impl EnvironmentMap {
    /// A map of faces with `side` texels on a side.
    pub(crate) fn new(
        device: &wgpu::Device,
        side: u32,
        [sky_groups, fog_groups]: [[&wgpu::BindGroupLayout; 2]; 2],
        [sky, fog]: [&str; 2],
    ) -> Result<Self, SkyRendererError> {
        if !side.is_power_of_two() || !(SMALLEST..=LARGEST).contains(&side) {
            return Err(SkyRendererError::EnvironmentSide(side));
        }
        let cube = |levels: u32, usage: wgpu::TextureUsages| {
            device.create_texture(&wgpu::TextureDescriptor {
                label: Some("airlight environment"),
                size: wgpu::Extent3d {
                    width: side,
                    height: side,
                    depth_or_array_layers: 6,
                },
                mip_level_count: levels,
                sample_count: 1,
                dimension: wgpu::TextureDimension::D2,
                format: FORMAT,
                usage: usage
                    | wgpu::TextureUsages::TEXTURE_BINDING
                    | wgpu::TextureUsages::RENDER_ATTACHMENT,
                view_formats: &[],
            })
        };
        let levels = side.ilog2() - SMALLEST.ilog2() + 1;
        let texture = cube(
            levels,
            wgpu::TextureUsages::COPY_DST | wgpu::TextureUsages::COPY_SRC,
        );
        let source = cube(side.ilog2() + 1, wgpu::TextureUsages::COPY_SRC);
        let depth = device.create_texture(&wgpu::TextureDescriptor {
            label: Some("airlight environment depth"),
            size: wgpu::Extent3d {
                width: side,
                height: side,
                depth_or_array_layers: 1,
            },
            mip_level_count: 1,
            sample_count: 1,
            dimension: wgpu::TextureDimension::D2,
            format: wgpu::TextureFormat::Depth32Float,
            usage: wgpu::TextureUsages::TEXTURE_BINDING | wgpu::TextureUsages::RENDER_ATTACHMENT,
            view_formats: &[],
        });
        let layout = gpu_tables::layout(device, &[wgpu::TextureViewDimension::Cube]);
        let pipeline_layout = device.create_pipeline_layout(&wgpu::PipelineLayoutDescriptor {
            label: Some("airlight environment"),
            bind_group_layouts: &[Some(&layout)],
            immediate_size: 0,
        });
        let shader = device.create_shader_module(wgpu::ShaderModuleDescriptor {
            label: Some("airlight environment"),
            source: wgpu::ShaderSource::Wgsl(
                [CORNER, include_str!("environment.wgsl")].concat().into(),
            ),
        });
        let sampler = device.create_sampler(&wgpu::SamplerDescriptor {
            label: Some("airlight environment"),
            mag_filter: wgpu::FilterMode::Linear,
            min_filter: wgpu::FilterMode::Linear,
            mipmap_filter: wgpu::MipmapFilterMode::Linear,
            ..Default::default()
        });
        let face = |(layer, axes): (u32, [Vec3; 3]), from, into, level, roughness: f32| {
            let axes = axes.iter().flat_map(|v| v.extend(0.0).to_array());
            let numbers: Vec<f32> = axes.chain([roughness, side as f32, 0.0, 0.0]).collect();
            let group = gpu_tables::bind(device, &layout, &numbers, &sampler, &[from]);
            (face_view(into, layer, level), group)
        };
        let filter = |entry, faces| Filter {
            pipeline: covering(device, &pipeline_layout, &shader, entry, (FORMAT, None)),
            faces,
        };
        let each =
            |levels| (1..levels).flat_map(|level| (0..6).zip(FACES).map(move |f| (level, f)));
        let halved = each(source.mip_level_count()).map(|(level, of)| {
            let larger = cube_view(&source, level - 1, Some(1));
            face(of, larger, &source, level, 0.0)
        });
        let rough = each(levels).map(|(level, of)| {
            let roughness = level as f32 / (levels - 1) as f32;
            face(of, cube_view(&source, 0, None), &texture, level, roughness)
        });
        let halve = filter("halve", halved.collect());
        let reflect_rough = filter("reflect_rough", rough.collect());
        Ok(Self {
            view: cube_view(&texture, 0, None),
            texture,
            source,
            depth: depth.create_view(&wgpu::TextureViewDescriptor::default()),
            is_depth_clear: false,
            halve,
            reflect_rough,
            sky_pass: Pass::new(device, sky_groups, sky, FORMAT),
            fog_pass: Pass::new(device, fog_groups, fog, FORMAT),
        })
    }

    /// The cube, as `Rgba16Float`, with all levels.
    pub fn view(&self) -> &wgpu::TextureView {
        &self.view
    }

    /// The texture of the cube.
    pub fn texture(&self) -> &wgpu::Texture {
        &self.texture
    }

    /// Number of levels.
    pub fn levels(&self) -> u32 {
        self.texture.mip_level_count()
    }

    /// The passes that draw into faces.
    pub(crate) fn passes(&self) -> [&Pass; 2] {
        [&self.sky_pass, &self.fog_pass]
    }

    /// The depth of faces without geometry.
    pub(crate) fn depth(&self) -> &wgpu::TextureView {
        &self.depth
    }

    /// Clears the depth the first time.
    pub(crate) fn clear_depth(&mut self, encoder: &mut wgpu::CommandEncoder) {
        if !std::mem::replace(&mut self.is_depth_clear, true) {
            encoder.begin_render_pass(&wgpu::RenderPassDescriptor {
                label: Some("airlight environment depth"),
                color_attachments: &[],
                depth_stencil_attachment: Some(wgpu::RenderPassDepthStencilAttachment {
                    view: &self.depth,
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
        }
    }

    /// Faces to draw the light into, with the matrices from clip space to the world, for a depth that is 0 without geometry.
    pub(crate) fn faces(&self) -> impl Iterator<Item = (wgpu::TextureView, Mat4)> {
        (0..6).map(|layer| {
            let [right, up, forward] = FACES[layer as usize];
            let world_from_clip = Mat4::from_cols(
                right.extend(0.0),
                up.extend(0.0),
                Vec4::W,
                forward.extend(0.0),
            );
            (face_view(&self.source, layer, 0), world_from_clip)
        })
    }

    /// Fills the map from the faces.
    pub(crate) fn filter(&self, encoder: &mut wgpu::CommandEncoder) {
        self.halve.record(encoder);
        encoder.copy_texture_to_texture(
            self.source.as_image_copy(),
            self.texture.as_image_copy(),
            self.texture.size(),
        );
        self.reflect_rough.record(encoder);
    }
}

fn cube_view(texture: &wgpu::Texture, level: u32, levels: Option<u32>) -> wgpu::TextureView {
    texture.create_view(&wgpu::TextureViewDescriptor {
        dimension: Some(wgpu::TextureViewDimension::Cube),
        base_mip_level: level,
        mip_level_count: levels,
        ..Default::default()
    })
}

fn face_view(texture: &wgpu::Texture, layer: u32, level: u32) -> wgpu::TextureView {
    texture.create_view(&wgpu::TextureViewDescriptor {
        dimension: Some(wgpu::TextureViewDimension::D2),
        base_mip_level: level,
        mip_level_count: Some(1),
        base_array_layer: layer,
        array_layer_count: Some(1),
        ..Default::default()
    })
}
