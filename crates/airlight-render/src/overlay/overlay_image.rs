//! [`OverlayImage`]: picture and depth map of an overlay, in memory.

use super::{LightLevel, OverlayScene, OverlaySpec};
use crate::RenderError;
use crate::ignored::refuse_display_options;
use airlight_image::input::{
    DepthMap, DepthOptions, LightReference, Picture, read_depth_with, read_picture_with,
    read_picture_with_depth,
};
use airlight_image::output::PictureFormat;
use airlight_image::{Control, ImageError, Notes};

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
    pub fn read(scene: &OverlayScene, format: PictureFormat) -> Result<Self, RenderError> {
        Self::read_with(scene, format, Control::default())
    }

    /// As [`OverlayImage::read`], with cancellation.
    ///
    /// # Errors
    /// As [`OverlayImage::read`], and if the caller cancelled.
    pub fn read_with(
        scene: &OverlayScene,
        format: PictureFormat,
        control: Control<'_>,
    ) -> Result<Self, RenderError> {
        let spec = &scene.overlay;
        let depth_options = spec.depth_options()?;
        let beside = |picture: &Picture| DepthOptions {
            beside: picture.layer.clone(),
            grey_is_depth: spec.depth.is_some(),
            ..depth_options.clone()
        };
        let layer = spec.colour_layer.as_deref();
        let (mut picture, depth) = match &spec.depth {
            None => read_picture_with_depth(&spec.colour, layer, beside, control)?,
            Some(file) => {
                let picture = read_picture_with(&spec.colour, layer, control)?;
                let depth = read_depth_with(file, &beside(&picture), control);
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
        if picture.reference == LightReference::Display {
            refuse_display_options(&scene.scene.output, &spec.colour)?;
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
}
