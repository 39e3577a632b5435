//! [`HeightField`] and [`TerrainPass`].

use crate::camera::Camera;
use crate::error::{SkyRendererError, require};
use crate::gpu_tables::{self, FLAT};
use crate::lighting::{DirectLight, Lighting};
use crate::pass::{
    CORNER, UNIFORM, bind_group, check_target, cover, covering, group_layout, uniform,
};
use crate::shadows::SunShadows;
use airlight::glam::DVec3;
use airlight_shaders::twins::texture::Texture;
use glam::{Vec3, Vec4};

/// Multiple of heights that half floats hold exactly, m.
const WHOLE_M: f32 = 16.0;
/// Tangent of the angular radius of the sun's disc in shadows.
pub(crate) const SUN_TANGENT: f64 = 0.00465;
/// Format of the depth that is drawn.
const DEPTH: wgpu::TextureFormat = wgpu::TextureFormat::R32Float;

/// Heights of ground at the posts of an even grid, interpolated between them. Beyond its edges the ground goes on as in mirrors.
#[derive(Clone, Debug, PartialEq)]
pub struct HeightField {
    size: [usize; 2],
    spacing_m: [f64; 2],
    heights_m: Vec<f32>,
    highest_m: f32,
    /// Tangent of the steepest slope between posts.
    steepest: f32,
}

impl HeightField {
    /// Heights above the ground of the planet, m, from 0 to 32 km: rows from north to south, each from west to east, of `size` columns and
    /// rows, with distances between columns and between rows, m.
    ///
    /// # Errors
    /// [`SkyRendererError::HeightField`] for fewer than 2 posts a side, another number of heights, and numbers out of range.
    pub fn new(
        size: [usize; 2],
        spacing_m: [f64; 2],
        heights_m: Vec<f32>,
    ) -> Result<Self, SkyRendererError> {
        let refuse = |got: String| Err(SkyRendererError::HeightField(got));
        if size.iter().any(|&side| !(2..=8192).contains(&side)) {
            return refuse(format!("{} x {} posts", size[0], size[1]));
        }
        if heights_m.len() != size[0] * size[1] {
            return refuse(format!(
                "{} heights for {} x {} posts",
                heights_m.len(),
                size[0],
                size[1]
            ));
        }
        if let Some(wrong) = spacing_m.iter().find(|m| !(0.01..=1e5).contains(*m)) {
            return refuse(format!("{wrong} m between posts"));
        }
        if let Some(wrong) = heights_m.iter().find(|h| !(0.0..=32_000.0).contains(*h)) {
            return refuse(format!("a height of {wrong} m"));
        }
        let mut field = Self {
            size,
            spacing_m,
            highest_m: heights_m.iter().copied().fold(0.0, f32::max),
            heights_m,
            steepest: 0.0,
        };
        field.steepest = field.steepest_between_posts();
        Ok(field)
    }

    /// Number of columns and of rows.
    pub fn size(&self) -> [usize; 2] {
        self.size
    }

    /// Distances between columns and between rows, m.
    pub fn spacing_m(&self) -> [f64; 2] {
        self.spacing_m
    }

    /// The greatest height, m.
    pub fn highest_m(&self) -> f32 {
        self.highest_m
    }

    /// Tangent of the steepest slope.
    pub(crate) fn steepest(&self) -> f32 {
        self.steepest
    }

    /// Height of the ground, m, at a place to the east and south of the middle of the grid, m.
    pub fn height_m(&self, place_m: [f64; 2]) -> f64 {
        let [height_m] = self.between_posts(place_m, |i, j| [f64::from(self.post(i, j))]);
        height_m
    }

    /// Rise per metre to the east and to the south, at a place as in [`Self::height_m`].
    pub(crate) fn slope_at(&self, place_m: [f64; 2]) -> [f32; 2] {
        let slope = self.between_posts(place_m, |i, j| self.slope(i, j).map(f64::from));
        slope.map(|rise| rise as f32)
    }

    /// Values at posts, interpolated at a place.
    fn between_posts<const N: usize>(
        &self,
        [east_m, south_m]: [f64; 2],
        post: impl Fn(i64, i64) -> [f64; N],
    ) -> [f64; N] {
        let place = |metres: f64, axis: usize| {
            let at = metres / self.spacing_m[axis] + 0.5 * self.size[axis] as f64 - 0.5;
            (at.floor() as i64, at - at.floor())
        };
        let ((i, x), (j, y)) = (place(east_m, 0), place(south_m, 1));
        let mixed = |from: [f64; N], to: [f64; N], part: f64| {
            std::array::from_fn(|k| from[k] * (1.0 - part) + to[k] * part)
        };
        let along = |j| mixed(post(i, j), post(i + 1, j), x);
        mixed(along(j), along(j + 1), y)
    }

    /// Height at a post, which may lie beyond the edges.
    fn post(&self, column: i64, row: i64) -> f32 {
        let mirrored = |k: i64, side: usize| {
            let period = k.rem_euclid(2 * side as i64) as usize;
            period.min(2 * side - 1 - period)
        };
        self.heights_m[mirrored(row, self.size[1]) * self.size[0] + mirrored(column, self.size[0])]
    }

    /// Rise per metre to the east and to the south at a post.
    fn slope(&self, i: i64, j: i64) -> [f32; 2] {
        let per_m = self.spacing_m.map(|spacing_m| (0.5 / spacing_m) as f32);
        [
            (self.post(i + 1, j) - self.post(i - 1, j)) * per_m[0],
            (self.post(i, j + 1) - self.post(i, j - 1)) * per_m[1],
        ]
    }

    /// Tangent of the steepest slope between posts.
    fn steepest_between_posts(&self) -> f32 {
        let [across_m, down_m] = self.spacing_m.map(|spacing_m| spacing_m as f32);
        let mut steepest = 0.0f32;
        for j in 0..self.size[1] as i64 {
            for i in 0..self.size[0] as i64 {
                // Between four posts, slopes are greatest along the edges.
                let [here, east] = [self.post(i, j), self.post(i + 1, j)];
                let [south, far] = [self.post(i, j + 1), self.post(i + 1, j + 1)];
                let along = (east - here).abs().max((far - south).abs()) / across_m;
                let down = (south - here).abs().max((far - east).abs()) / down_m;
                steepest = steepest.max(along.hypot(down));
            }
        }
        steepest
    }

    /// The texture of the shader.
    fn texture(&self) -> Texture {
        let [columns, rows] = self.size;
        let texels = (0..columns * rows).map(|k| {
            let height_m = self.heights_m[k];
            let whole_m = (height_m / WHOLE_M).floor() * WHOLE_M;
            let [east, south] = self.slope((k % columns) as i64, (k / columns) as i64);
            Vec4::new(whole_m, height_m - whole_m, east, south)
        });
        Texture::new([columns, rows, 1], texels.collect())
    }
}

/// What a [`TerrainPass`] draws.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct TerrainView {
    pub(crate) eye_m: DVec3,
    pub(crate) planet_radius_m: f64,
    pub(crate) lighting: Lighting,
    pub(crate) level_albedo: [f32; 3],
    pub(crate) steep_albedo: [f32; 3],
}

impl TerrainView {
    /// Ground on a planet of a radius, m, in the light of sun and sky at the eye. The place of the eye counts, in metres, to the east from
    /// the middle of the grid, above the ground of the planet, and to the south. The albedos, in linear RGB, are those of level ground and
    /// of slopes steeper than 45 degrees.
    ///
    /// # Errors
    /// [`SkyRendererError::OutOfRange`] for a place or light that is not finite, a radius that is not above 0, and albedos that are not from
    /// 0 to 1.
    pub fn new(
        eye_m: DVec3,
        planet_radius_m: f64,
        lighting: Lighting,
        [level_albedo, steep_albedo]: [[f32; 3]; 2],
    ) -> Result<Self, SkyRendererError> {
        require(eye_m.is_finite(), "a finite place of the eye", &eye_m)?;
        require(
            planet_radius_m > 0.0 && planet_radius_m.is_finite(),
            "a finite radius of the planet above 0 m",
            &planet_radius_m,
        )?;
        for source in [Some(lighting.first()), lighting.second]
            .into_iter()
            .flatten()
        {
            require(
                source.direction.try_normalize().is_some(),
                "a direction to what lights the ground",
                &source.direction,
            )?;
            require(
                source.illuminance_lx.is_finite(),
                "a finite illuminance of the ground",
                &source.illuminance_lx,
            )?;
        }
        let sky = lighting.sky_coefficients_lx;
        require(
            sky.iter().all(|of| of.is_finite()),
            "finite coefficients of the light of the sky on the ground",
            &sky,
        )?;
        for albedo in [level_albedo, steep_albedo] {
            require(
                albedo.iter().all(|share| (0.0..=1.0).contains(share)),
                "an albedo of the ground from 0 to 1",
                &albedo,
            )?;
        }
        Ok(Self {
            eye_m,
            planet_radius_m,
            lighting,
            level_albedo,
            steep_albedo,
        })
    }
}

/// Draws the ground of a [`HeightField`] into a frame, before [`SkyPasses`](crate::SkyPasses) adds the air: by a march along each ray, in
/// any projection, with the sun's shadow, and finds that in air and fog ([`TerrainPass::shadows`]). Light is that at the eye.
#[derive(Debug)]
pub struct TerrainPass {
    device: wgpu::Device,
    queue: wgpu::Queue,
    layout: wgpu::BindGroupLayout,
    camera_layout: wgpu::BindGroupLayout,
    pipeline: wgpu::RenderPipeline,
    sampler: wgpu::Sampler,
    heights: Option<Heights>,
    /// Finds the surface of shadows, once there are any.
    shadow_pipeline: Option<wgpu::RenderPipeline>,
    /// The surface of shadows, and the sun that throws them.
    shadow_surface: Option<(Vec3, wgpu::TextureView)>,
}

/// A height field on the device.
#[derive(Debug)]
struct Heights {
    view: wgpu::TextureView,
    size: [u32; 2],
    extent_m: [f32; 2],
    /// The smaller distance between posts.
    spacing_m: f32,
    highest_m: f32,
    steepest: f32,
}

impl TerrainPass {
    /// Makes the pipeline for targets of a format. The depth goes into an `R32Float` texture.
    ///
    /// # Errors
    /// [`SkyRendererError::OutOfRange`] for a format that is not of colours, or that the device cannot draw into.
    pub fn new(
        device: &wgpu::Device,
        queue: &wgpu::Queue,
        target_format: wgpu::TextureFormat,
    ) -> Result<Self, SkyRendererError> {
        check_target(device, target_format)?;
        let layout = gpu_tables::layout(device, &[FLAT]);
        let camera_layout = group_layout(device, "airlight camera", &[UNIFORM]);
        let pipeline_layout = device.create_pipeline_layout(&wgpu::PipelineLayoutDescriptor {
            label: Some("airlight terrain"),
            bind_group_layouts: &[Some(&layout), Some(&camera_layout)],
            immediate_size: 0,
        });
        let shader = device.create_shader_module(wgpu::ShaderModuleDescriptor {
            label: Some("airlight terrain"),
            source: wgpu::ShaderSource::Wgsl(shader().into()),
        });
        let target = |format| {
            Some(wgpu::ColorTargetState {
                format,
                blend: None,
                write_mask: wgpu::ColorWrites::ALL,
            })
        };
        let pipeline = device.create_render_pipeline(&wgpu::RenderPipelineDescriptor {
            label: Some("airlight terrain"),
            layout: Some(&pipeline_layout),
            vertex: wgpu::VertexState {
                module: &shader,
                entry_point: Some("corner"),
                compilation_options: wgpu::PipelineCompilationOptions::default(),
                buffers: &[],
            },
            primitive: wgpu::PrimitiveState::default(),
            depth_stencil: None,
            multisample: wgpu::MultisampleState::default(),
            fragment: Some(wgpu::FragmentState {
                module: &shader,
                entry_point: Some("draw"),
                compilation_options: wgpu::PipelineCompilationOptions::default(),
                targets: &[target(target_format), target(DEPTH)],
            }),
            multiview_mask: None,
            cache: None,
        });
        let sampler = device.create_sampler(&wgpu::SamplerDescriptor {
            label: Some("airlight terrain"),
            address_mode_u: wgpu::AddressMode::MirrorRepeat,
            address_mode_v: wgpu::AddressMode::MirrorRepeat,
            mag_filter: wgpu::FilterMode::Linear,
            min_filter: wgpu::FilterMode::Linear,
            ..Default::default()
        });
        Ok(Self {
            device: device.clone(),
            queue: queue.clone(),
            layout,
            camera_layout,
            pipeline,
            sampler,
            heights: None,
            shadow_pipeline: None,
            shadow_surface: None,
        })
    }

    /// Uploads heights, which are drawn from now on.
    pub fn set_heights(&mut self, field: &HeightField) {
        let size = field.size().map(|n| n as u32);
        let [columns, rows] = size.map(|n| n as f32);
        let [across_m, down_m] = field.spacing_m().map(|spacing_m| spacing_m as f32);
        self.shadow_surface = None;
        self.heights = Some(Heights {
            view: gpu_tables::upload(&self.device, &self.queue, &field.texture()),
            size,
            extent_m: [columns * across_m, rows * down_m],
            spacing_m: across_m.min(down_m),
            highest_m: field.highest_m(),
            steepest: field.steepest(),
        });
    }

    /// The shadows that the ground throws into air and fog under the sun of a view, whose surface is found when the sun has moved; `None` before the
    /// first heights, and for a sun that is not above the horizontal plane. Ground up to 300 km away throws shadows. They are those of a
    /// sun without extent, at the elevation that it has at the eye.
    pub fn shadows(
        &mut self,
        encoder: &mut wgpu::CommandEncoder,
        view: &TerrainView,
    ) -> Option<SunShadows> {
        let sun = view.lighting.sun;
        let heights = self.heights.as_ref().filter(|_| sun.y > 0.0)?;
        let known = self.shadow_surface.take();
        let (_, surface) = match known.filter(|(of, _)| *of == sun) {
            Some(known) => self.shadow_surface.insert(known),
            None => {
                let target = gpu_tables::target(&self.device, heights.size);
                let pipeline = self
                    .shadow_pipeline
                    .get_or_insert_with(|| shadow_pipeline(&self.device, &self.layout));
                let tables = bound((&self.device, &self.layout), (heights, &self.sampler), view);
                cover(encoder, "airlight shadows", &target, pipeline, &tables);
                self.shadow_surface.insert((sun, target))
            }
        };
        let mut numbers = view.eye_m.as_vec3().to_array().to_vec();
        numbers.push(view.planet_radius_m as f32);
        numbers.extend(heights.extent_m);
        numbers.extend([heights.highest_m, 0.0]);
        Some(SunShadows::of_ground(
            &self.device,
            &self.sampler,
            surface,
            &numbers,
        ))
    }

    /// Records the ground into `target` and its depth into `depth`, an `R32Float` texture of the same size that holds the depth without
    /// geometry where there is none. Before the first heights it draws nothing.
    pub fn record(
        &self,
        encoder: &mut wgpu::CommandEncoder,
        target: &wgpu::TextureView,
        depth: &wgpu::TextureView,
        camera: &Camera,
        view: &TerrainView,
    ) {
        let Some(heights) = &self.heights else {
            return;
        };
        let tables = bound((&self.device, &self.layout), (heights, &self.sampler), view);
        let label = "airlight camera";
        let camera = uniform(&self.device, label, &camera.numbers());
        let camera = [camera.as_entire_binding()];
        let camera = bind_group(&self.device, &self.camera_layout, label, &camera);
        let attachment = |view| {
            Some(wgpu::RenderPassColorAttachment {
                view,
                depth_slice: None,
                resolve_target: None,
                ops: wgpu::Operations {
                    load: wgpu::LoadOp::Load,
                    store: wgpu::StoreOp::Store,
                },
            })
        };
        let mut pass = encoder.begin_render_pass(&wgpu::RenderPassDescriptor {
            label: Some("airlight terrain"),
            color_attachments: &[attachment(target), attachment(depth)],
            depth_stencil_attachment: None,
            timestamp_writes: None,
            occlusion_query_set: None,
            multiview_mask: None,
        });
        pass.set_pipeline(&self.pipeline);
        pass.set_bind_group(0, &tables, &[]);
        pass.set_bind_group(1, &camera, &[]);
        pass.draw(0..3, 0..1);
    }
}

/// Heights and numbers of a view for the shader.
fn bound(
    (device, layout): (&wgpu::Device, &wgpu::BindGroupLayout),
    (heights, sampler): (&Heights, &wgpu::Sampler),
    view: &TerrainView,
) -> wgpu::BindGroup {
    let views = std::slice::from_ref(&heights.view);
    gpu_tables::bind(device, layout, &numbers(heights, view), sampler, views)
}

/// The pipeline that finds the surface of shadows.
fn shadow_pipeline(device: &wgpu::Device, layout: &wgpu::BindGroupLayout) -> wgpu::RenderPipeline {
    let layout = device.create_pipeline_layout(&wgpu::PipelineLayoutDescriptor {
        label: Some("airlight shadows"),
        bind_group_layouts: &[Some(layout)],
        immediate_size: 0,
    });
    let source = shader() + include_str!("shadow_heights.wgsl");
    let shader = device.create_shader_module(wgpu::ShaderModuleDescriptor {
        label: Some("airlight shadows"),
        source: wgpu::ShaderSource::Wgsl(source.into()),
    });
    covering(
        device,
        &layout,
        &shader,
        "shadow_height",
        (gpu_tables::FORMAT, None),
    )
}

fn shader() -> String {
    [
        CORNER,
        include_str!("camera.wgsl"),
        include_str!("terrain.wgsl"),
    ]
    .concat()
}

/// The numbers of the shader's struct `Terrain`.
fn numbers(heights: &Heights, view: &TerrainView) -> Vec<f32> {
    let light = &view.lighting;
    let mut all = view.eye_m.as_vec3().to_array().to_vec();
    all.push(view.planet_radius_m as f32);
    all.extend(light.sun.to_array());
    all.push(SUN_TANGENT as f32);
    all.extend(light.sun_illuminance_lx.to_array());
    all.push(heights.highest_m);
    let second = light.second.unwrap_or(DirectLight {
        direction: Vec3::Y,
        illuminance_lx: Vec3::ZERO,
    });
    for vector in [second.direction, second.illuminance_lx] {
        all.extend(vector.extend(0.0).to_array());
    }
    all.extend(heights.extent_m);
    all.extend([heights.steepest, heights.spacing_m]);
    for albedo in [view.level_albedo, view.steep_albedo] {
        all.extend(albedo);
        all.push(0.0);
    }
    for coefficient in light.sky_coefficients_lx {
        all.extend(coefficient.extend(0.0).to_array());
    }
    all
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::camera::Projection;
    use crate::headless::Headless;
    use crate::read::read_texture;
    use crate::terrain_point::TerrainPoint;
    use airlight::axes;
    use std::f32::consts::{FRAC_PI_2, PI};

    /// A ridge from north to south.
    fn ridge() -> HeightField {
        let heights_m = (0..64)
            .flat_map(|_| (0..64).map(|i| (200.0 - 10.0 * (i as f32 - 31.5).abs()).max(0.0)));
        HeightField::new([64, 64], [50.0, 20.0], heights_m.collect()).unwrap()
    }

    #[test]
    fn heights_are_interpolated_and_mirrored() {
        let field = ridge();
        assert_eq!(field.highest_m(), 195.0);
        assert!((field.steepest() - 0.2).abs() < 1e-6);
        let middle = field.height_m([0.0, 30.0]);
        assert!((middle - 195.0).abs() < 1e-9, "{middle}");
        assert!((field.height_m([75.0, 0.0]) - 185.0).abs() < 1e-9);
        // The next ridge to the east.
        assert!((field.height_m([3200.0 + 75.0, 0.0]) - 185.0).abs() < 1e-9);
        let [east, south] = field.slope(10, 5);
        assert_eq!(south, 0.0);
        assert!(east == 0.0 || (east - 0.2).abs() < 1e-6, "{east}");
    }

    /// Uneven hills.
    fn hills() -> HeightField {
        let height = |i: usize, j: usize| {
            let (x, y) = (i as f32 * 0.31, j as f32 * 0.23);
            60.0 + 30.0 * (x.sin() * (1.3 * y).cos() + (0.4 * x + y).sin())
        };
        let heights_m = (0..80).flat_map(|j| (0..64).map(move |i| height(i, j)));
        HeightField::new([64, 80], [50.0, 40.0], heights_m.collect()).unwrap()
    }

    const RADIUS_M: f64 = 6.36e6;
    const SIDE: u32 = 48;

    fn view(eye_m: DVec3, sun_deg: f64) -> TerrainView {
        let mut sky_coefficients_lx = [Vec3::ZERO; 9];
        sky_coefficients_lx[0] = Vec3::splat(1e4);
        let lighting = Lighting {
            sun: axes::direction(90.0, sun_deg).as_vec3(),
            sun_illuminance_lx: Vec3::splat(8e4),
            second: None,
            sky_coefficients_lx,
        };
        TerrainView::new(eye_m, RADIUS_M, lighting, [[0.2; 3]; 2]).unwrap()
    }

    /// Luminances and distances of the pixels of a fisheye of 180 degrees, 0 where no ground is drawn.
    fn drawn(field: &HeightField, view: &TerrainView, axes: [DVec3; 3]) -> Vec<[f32; 2]> {
        let Headless { device, queue, .. } = Headless::new().unwrap();
        let target = |format| {
            device.create_texture(&wgpu::TextureDescriptor {
                label: None,
                size: wgpu::Extent3d {
                    width: SIDE,
                    height: SIDE,
                    depth_or_array_layers: 1,
                },
                mip_level_count: 1,
                sample_count: 1,
                dimension: wgpu::TextureDimension::D2,
                format,
                usage: wgpu::TextureUsages::RENDER_ATTACHMENT | wgpu::TextureUsages::COPY_SRC,
                view_formats: &[],
            })
        };
        let textures = [wgpu::TextureFormat::Rgba32Float, DEPTH].map(target);
        let [light, depth] = textures
            .each_ref()
            .map(|t| t.create_view(&Default::default()));
        let mut pass = TerrainPass::new(&device, &queue, wgpu::TextureFormat::Rgba32Float).unwrap();
        pass.set_heights(field);
        let fisheye = Projection::Fisheye {
            axes,
            half_angles_rad: [FRAC_PI_2; 2],
            largest_rad: FRAC_PI_2,
        };
        let camera = Camera::new(fisheye, 1.0).unwrap();
        let mut encoder = device.create_command_encoder(&Default::default());
        pass.record(&mut encoder, &light, &depth, &camera, view);
        queue.submit([encoder.finish()]);
        let read = |texture: &wgpu::Texture| -> Vec<f32> {
            let texel = texture.format().block_copy_size(None).unwrap() as usize;
            let first = |of: &[u8]| f32::from_ne_bytes([of[0], of[1], of[2], of[3]]);
            let pixels = read_texture(&device, &queue, texture).unwrap();
            pixels.chunks(texel).map(first).collect()
        };
        let [light, depth] = textures.each_ref().map(read);
        light.into_iter().zip(depth).map(|(l, d)| [l, d]).collect()
    }

    /// Direction of a pixel of [`drawn`].
    fn direction(k: usize, [right, up, forward]: [DVec3; 3]) -> Option<DVec3> {
        let place = |n: usize| 2.0 * (n as f64 + 0.5) / f64::from(SIDE) - 1.0;
        let (x, y) = (place(k % SIDE as usize), -place(k / SIDE as usize));
        let radius = x.hypot(y);
        let (sin, cos) = (radius * std::f64::consts::FRAC_PI_2).sin_cos();
        (radius < 0.98).then(|| forward * cos + (right * x + up * y) * (sin / radius.max(1e-9)))
    }

    /// Height above the ground at a distance along a ray.
    fn clearance_m(field: &HeightField, eye_m: DVec3, ray: DVec3, distance_m: f64) -> f64 {
        let point = eye_m + distance_m * ray;
        let away = distance_m * ray.x.hypot(ray.z);
        point.y + away * away / (2.0 * RADIUS_M) - field.height_m([point.x, point.z])
    }

    /// Against steps of a metre on the processor.
    #[test]
    fn the_ground_is_where_small_steps_find_it() {
        let field = hills();
        let eye_m = DVec3::new(120.0, field.height_m([120.0, -300.0]) + 12.0, -300.0);
        let axes = [DVec3::X, DVec3::Y, DVec3::NEG_Z];
        let pixels = drawn(&field, &view(eye_m, 30.0), axes);
        let (mut met, mut missed) = (0, 0);
        for (k, [_, distance_m]) in pixels.into_iter().enumerate() {
            let Some(ray) = direction(k, axes) else {
                continue;
            };
            let steps = (1..6000).map(f64::from);
            let right = { steps }.find(|d| clearance_m(&field, eye_m, ray, *d) < 0.0);
            match right {
                Some(right) => {
                    // A ray that grazes a hill may pass it.
                    let grazes = (1..6)
                        .any(|m| clearance_m(&field, eye_m, ray, right + f64::from(m)) > -0.3);
                    let error = (f64::from(distance_m) - right).abs();
                    assert!(
                        grazes || error < 1.0 + 2e-3 * right,
                        "{k}: {distance_m} {right}"
                    );
                    met += 1;
                }
                None => {
                    assert!(
                        distance_m == 0.0 || distance_m > 6000.0,
                        "{k}: {distance_m}"
                    );
                    missed += 1;
                }
            }
        }
        assert!(met > 500 && missed > 500, "{met} {missed}");
    }

    /// Level ground reflects what a Lambertian surface does, and lies in the shadow of a ridge up to where the sun shows above it.
    #[test]
    fn ground_is_lit_by_sun_and_sky_and_in_shadow() {
        let field = ridge();
        let eye_m = DVec3::new(-900.0, 400.0, 0.0);
        // From above, with the sun in the east.
        let axes = [DVec3::X, DVec3::NEG_Z, DVec3::NEG_Y];
        let view = view(eye_m, 9.0);
        let sky = 0.2 * 1e4 / PI;
        let sunlit = sky + 0.2 * 8e4 * view.lighting.sun.y / PI;
        let (mut lit, mut dark) = (0, 0);
        for (k, [luminance, distance_m]) in drawn(&field, &view, axes).into_iter().enumerate() {
            let Some(ray) = direction(k, axes).filter(|ray| ray.y < -0.3) else {
                continue;
            };
            let point = eye_m + f64::from(distance_m) * ray;
            let [east, _] = field.slope_at([point.x, point.z]);
            if east != 0.0 || point.x > -1050.0 {
                continue;
            }
            // The crest is at 0, 195 m high; the edge of the shadow is as wide as the sun's disc makes it.
            let edge_m = -195.0 / f64::from(view.lighting.sun.y / view.lighting.sun.x);
            let off_m = point.x - edge_m;
            if off_m.abs() < 60.0 || point.x < -1590.0 {
                continue;
            }
            let is_lit = off_m < 0.0;
            let right = if is_lit { sunlit } else { sky };
            assert!(
                (luminance / right - 1.0).abs() < 1e-3,
                "{k} {point}: {luminance} {right}"
            );
            if is_lit { lit += 1 } else { dark += 1 }
        }
        assert!(lit > 20 && dark > 20, "{lit} {dark}");
    }

    /// [`TerrainPoint`] on the processor against what is drawn, but for rays that graze the ground.
    #[test]
    fn points_are_those_that_are_drawn() {
        let field = hills();
        let eye_m = DVec3::new(120.0, field.height_m([120.0, -300.0]) + 25.0, -300.0);
        let axes = [DVec3::X, DVec3::Y, DVec3::NEG_Z];
        let view = TerrainView {
            steep_albedo: [0.5, 0.4, 0.3],
            ..view(eye_m, 12.0)
        };
        let (mut met, mut missed, mut others) = (0, 0, 0);
        for (k, [luminance, distance_m]) in drawn(&field, &view, axes).into_iter().enumerate() {
            let Some(ray) = direction(k, axes) else {
                continue;
            };
            let Some(point) = TerrainPoint::along(&field, &view, ray) else {
                if distance_m > 0.0 {
                    others += 1
                } else {
                    missed += 1
                }
                continue;
            };
            let apart = (f64::from(distance_m) / point.distance_m - 1.0).abs();
            let brighter = (luminance / point.rgb.x - 1.0).abs();
            if apart < 2e-3 && brighter < 0.02 {
                met += 1
            } else {
                others += 1
            }
        }
        println!("{met} met, {missed} missed, {others} others");
        assert!(
            met > 500 && missed > 500 && others < 20,
            "{met} {missed} {others}"
        );
    }

    #[test]
    fn views_of_no_ground_are_refused() {
        let right = view(DVec3::Y, 30.0);
        let refusal = |spoil: &dyn Fn(&mut TerrainView)| {
            let mut wrong = right;
            spoil(&mut wrong);
            let albedos = [wrong.level_albedo, wrong.steep_albedo];
            let view =
                TerrainView::new(wrong.eye_m, wrong.planet_radius_m, wrong.lighting, albedos);
            view.unwrap_err().to_string()
        };
        for wrong in [f64::NAN, f64::INFINITY] {
            assert!(refusal(&|view| view.eye_m.x = wrong).contains("place of the eye"));
        }
        for wrong in [f64::NAN, f64::INFINITY, 0.0, -1.0] {
            let refusal = refusal(&|view| view.planet_radius_m = wrong);
            assert!(refusal.contains("radius of the planet"), "{refusal}");
        }
        for wrong in [f32::NAN, f32::INFINITY] {
            let refusals = [
                refusal(&|view| view.lighting.sun_illuminance_lx.y = wrong),
                refusal(&|view| {
                    view.lighting.second = Some(DirectLight {
                        direction: Vec3::Y,
                        illuminance_lx: Vec3::splat(wrong),
                    });
                }),
            ];
            assert!(
                refusals
                    .iter()
                    .all(|refusal| refusal.contains("illuminance"))
            );
        }
        for wrong in [f32::NAN, -0.1, 1.1] {
            let refusal = refusal(&|view| view.steep_albedo[1] = wrong);
            assert!(refusal.contains("albedo"), "{refusal}");
        }
        assert!(refusal(&|view| view.lighting.sun = Vec3::ZERO).contains("direction"));
        let spoil = |view: &mut TerrainView| view.lighting.sky_coefficients_lx[4].z = f32::NAN;
        assert!(refusal(&spoil).contains("coefficients"));
    }

    #[test]
    fn wrong_fields_are_refused() {
        let refusal = |size, spacing_m, heights_m: Vec<f32>| {
            let error = HeightField::new(size, [spacing_m, 30.0], heights_m).unwrap_err();
            error.to_string()
        };
        assert!(refusal([1, 2], 30.0, vec![0.0; 2]).contains("1 x 2"));
        assert!(refusal([2, 2], 30.0, vec![0.0; 3]).contains("3 heights"));
        assert!(refusal([2, 2], 0.0, vec![0.0; 4]).contains("0 m between"));
        assert!(refusal([2, 2], 30.0, vec![0.0, 1.0, -3.0, 1.0]).contains("-3 m"));
        assert!(refusal([2, 2], 30.0, vec![f32::NAN; 4]).contains("NaN"));
    }
}
