//! [`OverlayImage`]: picture and depth map of an overlay, in memory.

use super::{LightLevel, Overlay, OverlaySpec};
use crate::RenderError;
use airlight_image::input::{
    DepthMap, DepthOptions, LightReference, Picture, SampleBits, read_depth, read_picture,
};
use airlight_image::output::{
    Carried, Metadata, PictureFormat, PictureOptions, Written, exr, png, write_picture,
};
use airlight_image::tone::ToneMapper;
use airlight_image::{Control, ImageError, Notes};
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
        let depth = depth.turned_like(&picture);
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
    /// [`RenderError`] if one cannot be read, their sizes differ, or the format cannot store the picture's kind of values.
    pub fn read(spec: &OverlaySpec, format: PictureFormat) -> Result<Self, RenderError> {
        let mut picture = read_picture(&spec.colour, spec.colour_layer.as_deref())?;
        if !format.holds_alpha() {
            picture.alpha = None;
        }
        let (values, endings) = match picture.reference {
            LightReference::Scene => ("linear light", ".exr or .hdr"),
            LightReference::Display => ("display values", ".png or .jpg"),
        };
        if format.is_linear() != (picture.reference == LightReference::Scene) {
            return Err(RenderError::setting(format!(
                "expected an output format for {values}, like that of `{}`, got another; try a name that ends in {endings}",
                spec.colour.display(),
            )));
        }
        let options = DepthOptions {
            beside: picture.layer.clone(),
            ..spec.depth_options()?
        };
        let depth = match &spec.depth {
            Some(file) => read_depth(file, &options)?,
            None if picture.reference == LightReference::Display => {
                return Err(spec.without_depth());
            }
            None => read_depth(&spec.colour, &options).map_err(|error| match error {
                ImageError::NoChannel { .. } | ImageError::Read { .. } => {
                    RenderError::setting(format!(
                        "depth: expected a depth map, or an EXR picture with a depth channel, got neither ({error}); try depth \
                         with a file",
                    ))
                }
                error => error.into(),
            })?,
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

    /// Writes an overlay of this picture.
    ///
    /// # Errors
    /// [`RenderError`] if the file cannot be written; an existing `output` is then unchanged.
    pub fn write(
        &self,
        overlay: &Overlay<'_>,
        output: &Path,
        format: PictureFormat,
        control: Control<'_>,
    ) -> Result<Written, RenderError> {
        let options = PictureOptions {
            exr: exr::ExrOptions {
                precision: match (self.picture.bits, overlay.has_layers()) {
                    (SampleBits::Half, false) => exr::SamplePrecision::Half,
                    _ => exr::SamplePrecision::Float,
                },
                ..Default::default()
            },
            metadata: Metadata {
                chromaticities: self.picture.chromaticities,
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
                ..Default::default()
            },
            ..Default::default()
        };
        let size = self.picture.size;
        Ok(match format.holds_channels() {
            true => {
                let (names, metadata) = (overlay.channel_names(), &options.metadata);
                let names: Vec<&str> = names.iter().map(String::as_str).collect();
                exr::write(
                    output,
                    size,
                    &names,
                    overlay,
                    &options.exr,
                    metadata,
                    control,
                )?
            }
            false => {
                let tone = ToneMapper::as_displayed();
                write_picture(output, size, overlay, &tone, &options, control)?
            }
        })
    }
}
