//! How bright the light of a fog is in the unit of the picture.

use super::{Ambient, OverlaySpec, estimate_ambient, horizon_pixels};
use crate::RenderError;
use airlight::fog::FogLighting;
use airlight::scene::RgbFoggySky;
use airlight_image::frame::Intrinsics;
use airlight_image::input::{DepthMap, Picture};
use airlight_image::tone::luminance;
use serde::Serialize;
use std::f32::consts::PI;
use std::fmt;

/// Where a [`LightLevel`] comes from.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Serialize)]
#[serde(rename_all = "kebab-case")]
#[non_exhaustive]
pub enum LightLevelSource {
    /// An ambient light that was given.
    Given,
    /// The picture's sky.
    PictureSky,
    /// The picture's dark channel.
    DarkChannel,
    /// A solved sky at a given radiance scale.
    RadianceScale,
    /// A solved sky at the white luminance that the file states.
    FileWhite,
    /// A solved sky as bright as the picture's sky near the horizon.
    MatchedSky,
    /// A solved sky in which a white horizontal surface is as bright as the ambient light.
    MatchedAmbient,
}

impl fmt::Display for LightLevelSource {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.write_str(match self {
            Self::Given => "as given",
            Self::PictureSky => "from the picture's sky",
            Self::DarkChannel => "from the picture's dark channel",
            Self::RadianceScale => "solved sky, radiance scale as given",
            Self::FileWhite => "solved sky, unit as the file states it",
            Self::MatchedSky => "solved sky, as bright as the picture's sky",
            Self::MatchedAmbient => "solved sky, a white surface as bright as the ambient light",
        })
    }
}

/// How bright the light of a fog is.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct LightLevel {
    /// Radiance of the ambient light, in the picture's unit; in a solved sky, of a white horizontal surface.
    pub colour: [f32; 3],
    /// Where it comes from.
    pub source: LightLevelSource,
}

impl LightLevel {
    /// The ambient light of a description, or else as estimated from the picture.
    pub(super) fn ambient(spec: &OverlaySpec, picture: &Picture, depth: &DepthMap) -> Self {
        if let Some(given) = spec.ambient {
            return Self {
                colour: given.map(|v| v as f32),
                source: LightLevelSource::Given,
            };
        }
        let (colour, how) = estimate_ambient(picture, depth);
        let source = match how {
            Ambient::Sky => LightLevelSource::PictureSky,
            Ambient::DarkChannel => LightLevelSource::DarkChannel,
        };
        Self { colour, source }
    }
}

/// A picture, its depth and camera, and its ambient light.
#[derive(Clone, Copy)]
pub(super) struct View<'p> {
    pub picture: &'p Picture,
    pub depth: &'p DepthMap,
    pub camera: &'p Intrinsics,
    pub ambient: LightLevel,
}

/// Units of the picture in one cd/m^2 of a solved sky, and the level that follows: by the description's radiance scale; else as
/// the file states its white; else so that the clear sky is as bright as the picture's where that shows it near the horizon;
/// else so that a white horizontal surface under the clear sky is as bright as the ambient light.
///
/// # Errors
/// [`RenderError::Setting`] if the picture and its ambient light are black.
pub(super) fn radiance_scale(
    spec: &OverlaySpec,
    sky: &RgbFoggySky,
    view: &View<'_>,
) -> Result<(f32, LightLevel), RenderError> {
    let white = white_surface(&sky.fog_lighting());
    let stated = view.picture.white_luminance_cd_m2.map(|white| 1.0 / white);
    let (scale, source) = match (spec.radiance_scale, stated) {
        (Some(scale), _) => (scale as f32, LightLevelSource::RadianceScale),
        (None, Some(scale)) if spec.ambient.is_none() => (scale, LightLevelSource::FileWhite),
        _ => match picture_over_solved(spec, sky, view) {
            Some(scale) => (scale, LightLevelSource::MatchedSky),
            None => (
                luminance(view.ambient.colour) / luminance(white),
                LightLevelSource::MatchedAmbient,
            ),
        },
    };
    if !(scale.is_finite() && scale > 0.0) {
        return Err(RenderError::setting(
            "expected a picture or an ambient light that shows how bright the sky is, got black; try radiance-scale, the \
             picture's units in one cd/m^2",
        ));
    }
    let colour = white.map(|c| c * scale);
    Ok((scale, LightLevel { colour, source }))
}

/// Radiance of a white horizontal surface in the light at a fog's top.
fn white_surface(light: &FogLighting<[f32; 3]>) -> [f32; 3] {
    let sun = light.sun.map_or([0.0; 3], |sun| {
        let factor = sun.direction.y.max(0.0) as f32 / PI;
        sun.irradiance.map(|c| c * factor)
    });
    std::array::from_fn(|i| light.ambient[i] + sun[i])
}

/// Ratio of the picture's sky near the horizon to the solved one.
fn picture_over_solved(spec: &OverlaySpec, sky: &RgbFoggySky, view: &View<'_>) -> Option<f32> {
    if spec.ambient.is_some() {
        return None;
    }
    let picture = view.picture;
    let width = picture.size.width();
    let (mut shown, mut solved) = (0.0, 0.0);
    for pixel in horizon_pixels(picture, view.depth)? {
        let direction = view
            .camera
            .pixel_direction(pixel as u32 % width, pixel as u32 / width);
        if direction.y <= 0.0 {
            continue;
        }
        let rgb = &picture.rgb[3 * pixel..];
        shown += f64::from(luminance([rgb[0], rgb[1], rgb[2]]));
        solved += f64::from(luminance(sky.clear_radiance(direction)));
    }
    let scale = (shown / solved) as f32;
    (scale.is_finite() && scale > 0.0).then_some(scale)
}
