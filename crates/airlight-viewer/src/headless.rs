//! [`screenshot`]: the viewer without a window.

use crate::app::{Viewer, ViewerError};
use crate::graphics;
use crate::options::Options;
use airlight::spectrum::rgb::srgb_decode;
use airlight_image::rows::StoredRows;
use airlight_image::tone::ToneMapper;
use airlight_image::{Control, PictureOptions, Size, write_picture};
use eframe::egui::{self, Pos2, RawInput, Rect, vec2};
use eframe::egui_wgpu::{RenderState, RendererOptions, ScreenDescriptor};
use eframe::wgpu;
use std::path::Path;

/// Frames after which nothing moves any more: sizes of widgets are known from the second.
const FRAMES: usize = 3;

/// Draws what a window would show, without one, into a picture file. One point is one pixel.
///
/// # Errors
/// [`ViewerError`] without a graphics device, for a size that it cannot draw, or where the file cannot be written.
pub fn screenshot(options: Options, file: &Path) -> Result<(), ViewerError> {
    let size = options.size.map(|v| v.round().max(1.0) as u32);
    let configuration = graphics::configuration();
    let instance = pollster::block_on(configuration.wgpu_setup.new_instance());
    let settings = RendererOptions {
        dithering: false,
        ..Default::default()
    };
    let render = RenderState::create(&configuration, &instance, None, settings);
    let render = pollster::block_on(render).map_err(|_| ViewerError::NoDevice)?;
    let largest = render.device.limits().max_texture_dimension_2d;
    if size.iter().any(|&side| side > largest) {
        return Err(ViewerError::TooLarge { size, largest });
    }
    let context = egui::Context::default();
    let mut viewer = Viewer::new(&context, render.clone(), options)?;
    let input = || RawInput {
        screen_rect: Some(Rect::from_min_size(
            Pos2::ZERO,
            vec2(size[0] as f32, size[1] as f32),
        )),
        ..Default::default()
    };
    let mut frames = 0;
    let output = loop {
        let mut output = context.run_ui(input(), |ui| viewer.show(ui));
        take_textures(&render, &mut output.textures_delta);
        frames = if viewer.is_current() { frames + 1 } else { 0 };
        if frames > FRAMES {
            break output;
        }
        viewer.wait();
    };
    let pixels = drawn(&render, &context, output, size)?;
    let linear: Vec<f32> = pixels
        .as_chunks::<4>()
        .0
        .iter()
        .flat_map(|p| [p[0], p[1], p[2]])
        .map(|level| srgb_decode(f64::from(level) / 255.0) as f32)
        .collect();
    let rows = StoredRows::new(size[0], 3, linear)?;
    write_picture(
        file,
        Size::new(size[0], size[1])?,
        &rows,
        &ToneMapper::as_displayed(),
        &PictureOptions::default(),
        Control::default(),
    )?;
    Ok(())
}

/// Uploads the fonts.
fn take_textures(render: &RenderState, delta: &mut egui::TexturesDelta) {
    let mut renderer = render.renderer.write();
    for (id, images) in delta.set.drain() {
        for image in images {
            renderer.update_texture(&render.device, &render.queue, id, &image);
        }
    }
    for id in delta.free.drain() {
        renderer.free_texture(&id);
    }
}

/// Red, green, blue and alpha of a frame.
fn drawn(
    render: &RenderState,
    context: &egui::Context,
    output: egui::FullOutput,
    [width, height]: [u32; 2],
) -> Result<Vec<u8>, ViewerError> {
    let (device, queue) = (&render.device, &render.queue);
    let shapes = context.tessellate(output.shapes, output.pixels_per_point);
    let screen = ScreenDescriptor {
        size_in_pixels: [width, height],
        pixels_per_point: output.pixels_per_point,
    };
    let texture = device.create_texture(&wgpu::TextureDescriptor {
        label: Some("airlight screenshot"),
        size: wgpu::Extent3d {
            width,
            height,
            depth_or_array_layers: 1,
        },
        mip_level_count: 1,
        sample_count: 1,
        dimension: wgpu::TextureDimension::D2,
        format: render.target_format,
        usage: wgpu::TextureUsages::RENDER_ATTACHMENT | wgpu::TextureUsages::COPY_SRC,
        view_formats: &[],
    });
    let view = texture.create_view(&wgpu::TextureViewDescriptor::default());
    let mut encoder = device.create_command_encoder(&wgpu::CommandEncoderDescriptor::default());
    let mut renderer = render.renderer.write();
    let more = renderer.update_buffers(device, queue, &mut encoder, &shapes, &screen);
    let pass = encoder.begin_render_pass(&wgpu::RenderPassDescriptor {
        label: Some("airlight screenshot"),
        color_attachments: &[Some(wgpu::RenderPassColorAttachment {
            view: &view,
            depth_slice: None,
            resolve_target: None,
            ops: wgpu::Operations {
                load: wgpu::LoadOp::Clear(wgpu::Color::BLACK),
                store: wgpu::StoreOp::Store,
            },
        })],
        ..Default::default()
    });
    renderer.render(&mut pass.forget_lifetime(), &shapes, &screen);
    queue.submit(more.into_iter().chain([encoder.finish()]));
    airlight_gpu::read_texture(device, queue, &texture)
        .map_err(|error| ViewerError::Pixels(error.to_string()))
}
