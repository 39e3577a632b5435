//! [`TonePass`].

use crate::error::{SkyRendererError, require};
use crate::gpu_tables::FLAT;
use crate::pass::{
    CORNER, UNIFORM, bind_group, check_target, cover, covering, group_layout, texture, uniform,
};
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
    exposure: f32,
    curve: ToneCurve,
    /// Rows of a map of linear sRGB before the curve.
    colour_map: [[f32; 3]; 3],
    has_dither: bool,
}

impl ToneSettings {
    /// A factor on the light of the frame, in which 0.18 is then middle grey, and a curve. Targets of 8 bits are dithered.
    ///
    /// # Errors
    /// [`SkyRendererError::OutOfRange`] for a factor that is negative or not finite, and numbers of the curve out of their ranges.
    pub fn new(exposure: f32, curve: ToneCurve) -> Result<Self, SkyRendererError> {
        require(
            exposure >= 0.0 && exposure.is_finite(),
            "a finite exposure of the tone pass, 0 or more",
            &exposure,
        )?;
        if let ToneCurve::Camera {
            contrast,
            saturation,
        } = curve
        {
            require(
                (0.5..=3.0).contains(&contrast),
                "a contrast of the tone curve from 0.5 to 3",
                &contrast,
            )?;
            require(
                (0.0..=3.0).contains(&saturation),
                "a saturation of the tone curve from 0 to 3",
                &saturation,
            )?;
        }
        Ok(Self {
            exposure,
            curve,
            ..Self::default()
        })
    }

    /// With the rows of a map of linear sRGB before the curve, such as a white balance.
    ///
    /// # Errors
    /// [`SkyRendererError::OutOfRange`] for numbers that are not finite.
    pub fn with_colour_map(self, colour_map: [[f32; 3]; 3]) -> Result<Self, SkyRendererError> {
        let are_finite = colour_map.as_flattened().iter().all(|v| v.is_finite());
        require(are_finite, "a finite map of colours", &colour_map)?;
        Ok(Self { colour_map, ..self })
    }

    /// Without dither.
    pub fn without_dither(self) -> Self {
        Self {
            has_dither: false,
            ..self
        }
    }
}

impl Default for ToneCurve {
    fn default() -> Self {
        Self::Camera {
            contrast: 1.2,
            saturation: 1.0,
        }
    }
}

impl Default for ToneSettings {
    fn default() -> Self {
        Self {
            exposure: 1.0,
            curve: ToneCurve::default(),
            colour_map: [[1.0, 0.0, 0.0], [0.0, 1.0, 0.0], [0.0, 0.0, 1.0]],
            has_dither: true,
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
    ///
    /// # Errors
    /// [`SkyRendererError::OutOfRange`] for a format that is not of colours, or that the device cannot draw into.
    pub fn new(
        device: &wgpu::Device,
        format: wgpu::TextureFormat,
    ) -> Result<Self, SkyRendererError> {
        check_target(device, format)?;
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
        Ok(Self {
            pipeline: covering(device, &pipeline_layout, &shader, "show", (format, None)),
            device: device.clone(),
            layout,
            format,
        })
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
                if settings.has_dither =>
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

#[cfg(test)]
mod tests {
    use super::*;
    use crate::TerrainPass;
    use crate::headless::Headless;

    #[test]
    fn targets_that_are_no_displays_are_refused() {
        let Headless { device, queue, .. } = Headless::new().unwrap();
        for format in [
            wgpu::TextureFormat::Depth32Float,
            wgpu::TextureFormat::Rgba8Uint,
            wgpu::TextureFormat::Bc1RgbaUnorm,
        ] {
            let terrain = TerrainPass::new(&device, &queue, format);
            for refused in [TonePass::new(&device, format).err(), terrain.err()] {
                let refusal = refused.unwrap().to_string();
                assert!(refusal.contains(&format!("got {format:?}")), "{refusal}");
            }
        }
        for format in [
            wgpu::TextureFormat::Bgra8UnormSrgb,
            wgpu::TextureFormat::Rgba16Float,
        ] {
            assert!(TonePass::new(&device, format).is_ok(), "{format:?}");
        }
    }

    #[test]
    fn tones_out_of_range_are_refused() {
        let camera = |contrast, saturation| ToneCurve::Camera {
            contrast,
            saturation,
        };
        let usual = camera(1.2, 1.0);
        assert_eq!(ToneSettings::new(1.0, usual), Ok(ToneSettings::default()));
        for (exposure, curve, word) in [
            (-1.0, ToneCurve::Agx, "exposure"),
            (f32::NAN, ToneCurve::Clip, "exposure"),
            (f32::INFINITY, usual, "exposure"),
            (1.0, camera(0.4, 1.0), "contrast"),
            (1.0, camera(f32::NAN, 1.0), "contrast"),
            (1.0, camera(1.0, -0.1), "saturation"),
            (1.0, camera(1.0, f32::INFINITY), "saturation"),
        ] {
            let refusal = ToneSettings::new(exposure, curve).unwrap_err();
            assert!(refusal.to_string().contains(word), "{refusal}");
        }
        for wrong in [f32::NAN, f32::NEG_INFINITY] {
            let mut map = [[1.0; 3]; 3];
            map[2][1] = wrong;
            let refused = ToneSettings::default().with_colour_map(map);
            let refusal = refused.unwrap_err().to_string();
            assert!(refusal.starts_with("expected a finite map"), "{refusal}");
        }
    }
}
