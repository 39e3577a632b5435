//! [`OverlayOutput`]: an overlay as the rows of a file, converted where its picture holds another kind of light: light of a
//! display as linear light, and the reverse.

use super::light_level::PhotometricUnit;
use super::{Overlay, OverlayScene};
use crate::exposure::{ExposureSettings, METERED_WIDTH, MeteredPicture, MeteredPixel};
use crate::{RenderError, display};
use airlight::scene::OutputSpec;
use airlight::spectrum::RgbSpace;
use airlight_image::input::{LightReference, SampleBits};
use airlight_image::output::{
    Carried, Metadata, PictureFormat, PictureOptions, Written, exr, jpeg, png, write_picture,
};
use airlight_image::tone::{Exposure, ToneMapper, luminance};
use airlight_image::{Control, RowSource};
use glam::{Mat3, Vec3};
use std::path::Path;
use std::sync::Arc;

/// An overlay as the rows of a file in a format.
#[derive(Debug)]
pub struct OverlayOutput<'a> {
    overlay: Overlay<'a>,
    format: PictureFormat,
    /// `None` if the picture holds light of the same kind as the file.
    conversion: Option<Conversion>,
    tone: ToneMapper,
    exposure: Option<Exposure>,
    /// Named texts of the metadata.
    texts: Vec<(String, String)>,
    quality: u8,
}

/// From the colours of a picture to those of a file.
#[derive(Clone, Copy, Debug)]
struct Conversion {
    /// Factor on linear light: its unit, cd/m^2.
    scale: f32,
    to_srgb: Option<Mat3>,
    opacity: Opacity,
}

/// What becomes of colours that have opacity.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
enum Opacity {
    None,
    /// They are multiplied by it, as in linear files.
    Multiply,
    /// They are divided by it, as in display files.
    Divide,
}

impl Conversion {
    fn apply(&self, pixel: &mut [f32]) {
        let opacity = pixel.last().copied().unwrap_or(1.0);
        let factor = match self.opacity {
            Opacity::None => 1.0,
            Opacity::Multiply => opacity,
            Opacity::Divide if opacity > 0.0 => 1.0 / opacity,
            Opacity::Divide => 0.0,
        };
        let mut colour = Vec3::new(pixel[0], pixel[1], pixel[2]) * (factor * self.scale);
        if let Some(matrix) = self.to_srgb {
            colour = matrix * colour;
        }
        pixel[..3].copy_from_slice(&colour.to_array());
    }
}

impl<'a> OverlayOutput<'a> {
    /// An overlay for a file in a format. Light of a display becomes linear light relative to white in EXR and HDR; linear light
    /// is exposed and tone mapped in PNG and JPEG, as `scene.output` says.
    ///
    /// # Errors
    /// [`RenderError`] for an exposure or a tone curve out of range.
    pub(super) fn new(
        overlay: Overlay<'a>,
        scene: &OverlayScene,
        format: PictureFormat,
        unit: PhotometricUnit,
    ) -> Result<Self, RenderError> {
        let picture = overlay.picture;
        let is_scene = picture.reference == LightReference::Scene;
        let conversion = (is_scene != format.is_linear()).then(|| Conversion {
            scale: match is_scene {
                true => unit.cd_m2 as f32,
                false => 1.0,
            },
            to_srgb: match is_scene {
                true => picture.to_linear_srgb().map(|matrix| matrix.as_mat3()),
                false => None,
            },
            opacity: match (picture.alpha.is_some(), is_scene) {
                (false, _) => Opacity::None,
                (true, true) => Opacity::Divide,
                (true, false) => Opacity::Multiply,
            },
        });
        let output = &scene.scene.output;
        let rows = Self {
            overlay,
            format,
            conversion,
            tone: ToneMapper::as_displayed(),
            exposure: None,
            texts: Vec::new(),
            quality: output
                .quality
                .unwrap_or(jpeg::JpegOptions::default().quality),
        };
        match is_scene && !format.is_linear() {
            true => rows.exposed(output, unit.horizontal_lx),
            false => Ok(rows),
        }
    }

    /// The same rows with a fixed or metered exposure and a tone curve.
    fn exposed(self, output: &OutputSpec, horizontal_lx: f64) -> Result<Self, RenderError> {
        let settings = ExposureSettings::of(output);
        let exposure = match settings.fixed()? {
            Some(exposure) => exposure,
            None => settings.metered(&self.metered(horizontal_lx))?,
        };
        Ok(Self {
            tone: display::tone_mapper(output, exposure)?,
            exposure: Some(exposure),
            texts: vec![display::description(output, exposure)],
            ..self
        })
    }

    /// A small picture of some of the pixels, in which all that has a depth is ground.
    fn metered(&self, horizontal_lx: f64) -> MeteredPicture {
        let whole = self.overlay.size();
        let size = whole.shrunk_to(METERED_WIDTH);
        let middle = |n: u32, of: u32, among: u32| {
            let place = (u64::from(n) * 2 + 1) * u64::from(among) / (2 * u64::from(of));
            place as u32
        };
        let (width, channels) = (whole.width() as usize, self.channels());
        let mut row = vec![0.0; width * channels];
        let mut pixels = Vec::new();
        for j in 0..size.height() {
            let y = middle(j, size.height(), whole.height());
            self.fill_row(y, &mut row);
            for i in 0..size.width() {
                let x = middle(i, size.width(), whole.width());
                let rgb = &row[x as usize * channels..];
                let depth = self.overlay.depth.metres[y as usize * width + x as usize];
                let ray_length = self.overlay.camera.ray_length_per_z(x, y);
                pixels.push(MeteredPixel {
                    luminance: f64::from(luminance([rgb[0], rgb[1], rgb[2]])),
                    solid_angle: ray_length.powi(-3),
                    is_ground: !depth.is_infinite(),
                });
            }
        }
        MeteredPicture {
            size,
            pixels,
            horizontal_lx,
        }
    }

    /// The overlay.
    pub fn overlay(&self) -> &Overlay<'a> {
        &self.overlay
    }

    /// The tone mapper with which PNG and JPEG files show the rows.
    pub fn tone(&self) -> &ToneMapper {
        &self.tone
    }

    /// The format of the file.
    pub fn format(&self) -> PictureFormat {
        self.format
    }

    /// The exposure of linear light in a PNG or JPEG file; `None` for other files.
    pub fn exposure(&self) -> Option<Exposure> {
        self.exposure
    }

    /// Writes the file.
    ///
    /// # Errors
    /// [`RenderError`] if it cannot be written; an existing file is then unchanged.
    pub fn write(&self, path: &Path, control: Control<'_>) -> Result<Written, RenderError> {
        let (picture, size) = (self.overlay.picture, self.overlay.size());
        let options = PictureOptions {
            exr: exr::ExrOptions {
                precision: match (picture.bits, self.overlay.has_layers()) {
                    (SampleBits::Half | SampleBits::U8, false) => exr::SamplePrecision::Half,
                    _ => exr::SamplePrecision::Float,
                },
                ..Default::default()
            },
            metadata: Metadata {
                chromaticities: match (picture.reference, self.format.is_linear()) {
                    (LightReference::Scene, true) => picture.chromaticities,
                    _ => Some(RgbSpace::Srgb.into()),
                },
                white_luminance_cd_m2: picture.white_luminance_cd_m2,
                pixel_aspect: Some(picture.pixel_aspect),
                carried: self.carried(),
                texts: self.texts.clone(),
                ..Metadata::default()
            },
            png: png::PngOptions {
                depth: match picture.bits {
                    SampleBits::U8 => png::PngDepth::Eight,
                    _ => png::PngDepth::Sixteen,
                },
                compression_level: match picture.bits {
                    // Pictures with the noise of a camera hardly have repetitions that a search would find.
                    SampleBits::U8 => 1,
                    _ => png::PngOptions::default().compression_level,
                },
            },
            jpeg: jpeg::JpegOptions {
                quality: self.quality,
            },
        };
        Ok(match self.format.holds_channels() {
            true => {
                let (names, metadata) = (self.overlay.channel_names(), &options.metadata);
                let names: Vec<&str> = names.iter().map(String::as_str).collect();
                exr::write(path, size, &names, self, &options.exr, metadata, control)?
            }
            false => write_picture(path, size, self, &self.tone, &options, control)?,
        })
    }

    /// What is carried from an EXR file, except channels that the overlay writes itself.
    fn carried(&self) -> Option<Arc<Carried>> {
        let carried = self.overlay.picture.carried.as_ref()?;
        let names = self.overlay.channel_names();
        if !carried.channel_names().any(|name| names.contains(&name)) {
            return Some(carried.clone());
        }
        let names: Vec<&str> = names.iter().map(String::as_str).collect();
        Some(Arc::new(carried.without_channels(&names)))
    }
}

impl RowSource for OverlayOutput<'_> {
    fn channels(&self) -> usize {
        self.overlay.channels()
    }

    fn fill_row(&self, y: u32, out: &mut [f32]) {
        self.overlay.fill_row(y, out);
        if let Some(conversion) = &self.conversion {
            for pixel in out.chunks_exact_mut(self.overlay.channels()) {
                conversion.apply(pixel);
            }
        }
    }
}
