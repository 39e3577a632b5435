//! [`TonePass`].

use crate::gpu_tables::FLAT;
use crate::pass::{CORNER, UNIFORM, bind_group, cover, covering, group_layout, texture, uniform};
use airlight_shaders::{Part, source};

/// Curve from exposed light to the light of a display.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum ToneCurve {
    /// In the manner of a camera: contrast around middle grey, highlights that roll off to white, hue kept.
    Camera {
        /// Slope at middle grey on logarithmic axes, 0.5 to 3.
        contrast: f32,
        /// Factor on the distance from grey, 0 to 3.
        saturation: f32,
    },
    /// The base look of AgX.
    Agx,
    /// None: components are clipped at black and white.
    Clip,
}

/// Settings of a [`TonePass`].
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct ToneSettings {
    /// Factor on the light of the frame, in which 0.18 is then middle grey.
    pub exposure: f32,
    /// Tone curve.
    pub curve: ToneCurve,
    /// Rows of a map of linear sRGB before the curve, such as a white balance.
    pub colour_map: [[f32; 3]; 3],
    /// Whether targets of 8 bits are dithered.
    pub dither: bool,
}

impl Default for ToneSettings {
    fn default() -> Self {
        Self {
            exposure: 1.0,
            curve: ToneCurve::Camera {
                contrast: 1.2,
                saturation: 1.0,
            },
            colour_map: [[1.0, 0.0, 0.0], [0.0, 1.0, 0.0], [0.0, 0.0, 1.0]],
            dither: true,
        }
    }
}

/// Draws a frame in linear sRGB into a target of a display: exposure, tone curve, sRGB signal, dither.
#[derive(Debug)]
pub struct TonePass {
    device: wgpu::Device,
    layout: wgpu::BindGroupLayout,
    pipeline: wgpu::RenderPipeline,
    format: wgpu::TextureFormat,
}

impl TonePass {
    /// Makes the pipeline for targets of a format.
    pub fn new(device: &wgpu::Device, format: wgpu::TextureFormat) -> Self {
        let layout = group_layout(device, "airlight tone", &[UNIFORM, texture(FLAT, false)]);
        let pipeline_layout = device.create_pipeline_layout(&wgpu::PipelineLayoutDescriptor {
            label: Some("airlight tone"),
            bind_group_layouts: &[Some(&layout)],
            immediate_size: 0,
        });
        let text = source(&[Part::Tone, Part::Dither]) + CORNER + include_str!("tone.wgsl");
        let shader = device.create_shader_module(wgpu::ShaderModuleDescriptor {
            label: Some("airlight tone"),
            source: wgpu::ShaderSource::Wgsl(text.into()),
        });
        Self {
            pipeline: covering(device, &pipeline_layout, &shader, "show", (format, None)),
            device: device.clone(),
            layout,
            format,
        }
    }

    /// Records the pass from `frame`, linear sRGB, to a target of the same size.
    pub fn record(
        &self,
        encoder: &mut wgpu::CommandEncoder,
        frame: &wgpu::TextureView,
        target: &wgpu::TextureView,
        settings: &ToneSettings,
    ) {
        let label = "airlight tone";
        let numbers = uniform(&self.device, label, &self.numbers(settings));
        let resources = [
            numbers.as_entire_binding(),
            wgpu::BindingResource::TextureView(frame),
        ];
        let group = bind_group(&self.device, &self.layout, label, &resources);
        cover(encoder, label, target, &self.pipeline, &group);
    }

    /// The numbers of the shader's struct `Tone`.
    fn numbers(&self, settings: &ToneSettings) -> Vec<f32> {
        let rows = settings.colour_map.into_iter();
        let mut all: Vec<f32> = rows.flat_map(|[r, g, b]| [r, g, b, 0.0]).collect();
        let (curve, contrast, saturation) = match settings.curve {
            ToneCurve::Camera {
                contrast,
                saturation,
            } => (0, contrast, saturation),
            ToneCurve::Agx => (1, 1.0, 1.0),
            ToneCurve::Clip => (2, 1.0, 1.0),
        };
        let encodes = !self.format.is_srgb();
        let levels = match self.format {
            wgpu::TextureFormat::Rgba8Unorm | wgpu::TextureFormat::Bgra8Unorm
                if settings.dither =>
            {
                255.0
            }
            _ => 0.0,
        };
        all.extend([
            settings.exposure,
            f32::from_bits(curve),
            contrast,
            saturation,
        ]);
        all.extend([levels, f32::from(u8::from(encodes)), 0.0, 0.0]);
        all
    }
}
