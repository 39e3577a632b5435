//! [`OverlayImage`]: picture and depth map of an overlay, in memory.

use super::output_rows::OutputRows;
use super::{LightLevel, Overlay, OverlaySpec};
use crate::RenderError;
use airlight::spectrum::RgbSpace;
use airlight_image::input::{
    DepthMap, DepthOptions, LightReference, Picture, SampleBits, read_depth, read_picture,
    read_picture_with_depth,
};
use airlight_image::output::{
    Carried, Metadata, PictureFormat, PictureOptions, Written, exr, jpeg, png, write_picture,
};
use airlight_image::tone::{ToneCurve, ToneMapper};
use airlight_image::{Control, ImageError, Notes, RowSource};
use std::path::Path;
use std::sync::Arc;

/// A colour picture, its depth map and its ambient light.
#[derive(Clone, Debug)]
pub struct OverlayImage {
    /// The colour picture.
    pub picture: Picture,
    /// Its depth map, of the same size.
    pub depth: DepthMap,
    /// The ambient light, given or estimated, without the description's factor.
    pub ambient: LightLevel,
}

impl OverlayImage {
    /// A picture and its depth map, with the ambient light of a description or estimated from the picture.
    ///
    /// # Errors
    /// [`RenderError`] if their sizes differ.
    pub fn new(spec: &OverlaySpec, picture: Picture, depth: DepthMap) -> Result<Self, RenderError> {
        let depth = depth.turned_like(&picture).resized_like(&picture);
        depth.check_against(&picture)?;
        let ambient = LightLevel::ambient(spec, &picture, &depth);
        Ok(Self {
            picture,
            depth,
            ambient,
        })
    }

    /// What was converted, repaired or passed over in the files.
    pub fn notes(&self) -> Notes {
        let mut notes = self.picture.notes.clone();
        notes.merge(&self.depth.notes);
        notes
    }

    /// Reads the colour picture and depth map of a description, for output in a format.
    ///
    /// # Errors
    /// [`RenderError`] if one cannot be read, their sizes differ, or a setting does not apply to the picture.
    pub fn read(spec: &OverlaySpec, format: PictureFormat) -> Result<Self, RenderError> {
        let depth_options = spec.depth_options()?;
        let beside = |picture: &Picture| DepthOptions {
            beside: picture.layer.clone(),
            grey_is_depth: spec.depth.is_some(),
            ..depth_options.clone()
        };
        let layer = spec.colour_layer.as_deref();
        let (mut picture, depth) = match &spec.depth {
            None => read_picture_with_depth(&spec.colour, layer, beside)?,
            Some(file) => {
                let picture = read_picture(&spec.colour, layer)?;
                let depth = read_depth(file, &beside(&picture));
                (picture, depth)
            }
        };
        if !format.holds_alpha() && picture.alpha.take().is_some() {
            picture
                .notes
                .add("opacity left out, which the output cannot hold");
        }
        if let (false, Some(carried)) = (format.holds_channels(), &picture.carried) {
            let count = carried.channel_names().count() as u64;
            let text = "other channels left out, which the output cannot hold";
            picture.notes.count(count, text);
        }
        match (picture.reference, format.is_linear(), spec.brighten) {
            (LightReference::Scene, false, _) => {
                let white = (-spec.brighten.unwrap_or(0.0)).exp2() as f32;
                let pixels = picture.rgb.as_chunks::<3>().0.iter();
                let bright = pixels.filter(|rgb| rgb.iter().any(|v| *v > white));
                let text = "pixels brighter than white are clipped in the output (brighten darkens by negative stops)";
                picture.notes.count(bright.count() as u64, text);
            }
            (LightReference::Display, _, Some(stops)) => {
                return Err(RenderError::value(
                    "overlay.brighten",
                    format!(
                        "a picture of linear light, unlike `{}`",
                        spec.colour.display()
                    ),
                    stops.to_string(),
                    "leaving it out",
                ));
            }
            _ => {}
        }
        let depth = match (depth, &spec.depth) {
            (depth, Some(_)) => depth?,
            (_, None) if picture.reference == LightReference::Display => {
                return Err(spec.without_depth());
            }
            (Err(error @ (ImageError::NoChannel { .. } | ImageError::Read { .. })), None) => {
                return Err(RenderError::setting(format!(
                    "depth: expected a depth map, or an EXR picture with a depth channel, got neither ({error}); try depth \
                     with a file",
                )));
            }
            (depth, None) => depth?,
        };
        Self::new(spec, picture, depth)
    }

    /// What is carried from an EXR file, except channels that an overlay writes itself.
    fn carried(&self, overlay: &Overlay<'_>) -> Option<Arc<Carried>> {
        let carried = self.picture.carried.as_ref()?;
        let names = overlay.channel_names();
        if !carried.channel_names().any(|name| names.contains(&name)) {
            return Some(carried.clone());
        }
        let names: Vec<&str> = names.iter().map(String::as_str).collect();
        Some(Arc::new(carried.without_channels(&names)))
    }

    /// Writes an overlay of this picture. Light of a display becomes linear light relative to white in EXR and HDR; linear light is
    /// clipped at 1, after brightening, in PNG and JPEG.
    ///
    /// # Errors
    /// [`RenderError`] if the file cannot be written; an existing `output` is then unchanged.
    pub fn write(
        &self,
        overlay: &Overlay<'_>,
        spec: &OverlaySpec,
        output: &Path,
        format: PictureFormat,
        control: Control<'_>,
    ) -> Result<Written, RenderError> {
        let converted = OutputRows::new(overlay, &self.picture, format);
        let rows: &dyn RowSource = match &converted {
            Some(converted) => converted,
            None => overlay,
        };
        let is_display = self.picture.reference == LightReference::Display;
        let options = PictureOptions {
            exr: exr::ExrOptions {
                precision: match (self.picture.bits, overlay.has_layers()) {
                    (SampleBits::Half | SampleBits::U8, false) => exr::SamplePrecision::Half,
                    _ => exr::SamplePrecision::Float,
                },
                ..Default::default()
            },
            metadata: Metadata {
                chromaticities: match is_display {
                    true => Some(RgbSpace::Srgb.into()),
                    false => self.picture.chromaticities,
                },
                white_luminance_cd_m2: self.picture.white_luminance_cd_m2,
                pixel_aspect: Some(self.picture.pixel_aspect),
                carried: self.carried(overlay),
                ..Metadata::default()
            },
            png: png::PngOptions {
                depth: match self.picture.bits {
                    SampleBits::U8 => png::PngDepth::Eight,
                    _ => png::PngDepth::Sixteen,
                },
                compression_level: match self.picture.bits {
                    // Pictures with the noise of a camera hardly have repetitions that a search would find.
                    SampleBits::U8 => 1,
                    _ => png::PngOptions::default().compression_level,
                },
            },
            jpeg: jpeg::JpegOptions {
                quality: spec.quality.unwrap_or(jpeg::JpegOptions::default().quality),
            },
        };
        let size = self.picture.size;
        Ok(match format.holds_channels() {
            true => {
                let (names, metadata) = (overlay.channel_names(), &options.metadata);
                let names: Vec<&str> = names.iter().map(String::as_str).collect();
                exr::write(output, size, &names, rows, &options.exr, metadata, control)?
            }
            false => {
                let tone = match is_display {
                    true => ToneMapper::as_displayed(),
                    false => {
                        let exposure = spec.brighten.unwrap_or(0.0).exp2() as f32;
                        ToneMapper::new(exposure, ToneCurve::Clip)?
                    }
                };
                write_picture(output, size, rows, &tone, &options, control)?
            }
        })
    }
}
