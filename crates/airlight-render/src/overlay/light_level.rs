//! [`LightLevel`]: radiance of the light of a fog, in the unit of the picture.

use super::primaries::Primaries;
use super::{Ambient, FogOverlay, FogSource, OverlaySpec, estimate_ambient, horizon_pixels};
use crate::RenderError;
use airlight::scene::RgbFoggySky;
use airlight_image::frame::Intrinsics;
use airlight_image::input::{DepthMap, Picture};
use airlight_image::tone::luminance;
use std::f32::consts::PI;

/// Source of a [`LightLevel`].
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash)]
#[non_exhaustive]
pub enum LightLevelSource {
    /// A given ambient light.
    Given,
    /// The picture's sky.
    PictureSky,
    /// The picture's dark channel.
    DarkChannel,
    /// A solved sky at a given radiance scale.
    RadianceScale,
    /// A solved sky, with the white luminance stated in the file.
    FileWhite,
    /// A solved sky as bright as the picture's sky near the horizon.
    MatchedSky,
    /// A solved sky in which a white horizontal surface is as bright as the ambient light.
    MatchedAmbient,
}

airlight::named! { LightLevelSource, "a source of a light level", [
    ("given", (Given), "as given"),
    ("picture-sky", (PictureSky), "from the picture's sky"),
    ("dark-channel", (DarkChannel), "from the picture's dark channel"),
    ("radiance-scale", (RadianceScale), "solved sky, radiance scale as given"),
    ("file-white", (FileWhite), "solved sky, unit as stated in the file"),
    ("matched-sky", (MatchedSky), "solved sky, as bright as the picture's sky"),
    ("matched-ambient", (MatchedAmbient), "solved sky, a white surface as bright as the ambient light"),
] }

/// Radiance of the light of a fog, and its source.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct LightLevel {
    /// Radiance of the ambient light in the picture's unit; for a solved sky, that of a white horizontal surface.
    pub colour: [f32; 3],
    /// Source of the radiance.
    pub source: LightLevelSource,
}

impl LightLevel {
    /// The ambient light of a description; otherwise estimated from the picture.
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

/// Luminance of 1 in a linear picture that states no unit, cd/m^2: white in an exposure of EV 15, that of a sunny day.
const SUNNY_WHITE_CD_M2: f64 = 1.2 * (1 << 15) as f64;

/// The light of a picture in photometric units, for its exposure.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(super) struct PhotometricUnit {
    /// Luminance of the picture's unit, cd/m^2.
    pub cd_m2: f64,
    /// Illuminance of a horizontal surface at the fog's top, lx.
    pub horizontal_lx: f64,
}

impl PhotometricUnit {
    /// That of a picture in fog: of the solved sky, or as the file states, or of a sunny day.
    pub fn new(fog: &FogOverlay, picture: &Picture) -> Self {
        let stated = picture.white_luminance_cd_m2.map(f64::from);
        let stated = stated.unwrap_or(SUNNY_WHITE_CD_M2);
        let (cd_m2, white) = match fog {
            FogOverlay::Fog(
                FogSource::Sky {
                    sky,
                    radiance_scale,
                    ..
                },
                _,
            ) => {
                let white = sky.white_radiance().map(|c| c * radiance_scale);
                (1.0 / f64::from(*radiance_scale), white)
            }
            FogOverlay::Fog(FogSource::Alone(fog), _) => (stated, fog.lighting().white_radiance()),
            FogOverlay::ExponentialSquared(_, colour)
            | FogOverlay::Linear(_, _, colour)
            | FogOverlay::Encoded(_, colour) => (stated, *colour),
        };
        Self {
            cd_m2,
            horizontal_lx: cd_m2 * f64::from(PI * luminance(white)),
        }
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

/// Units of the picture in one cd/m^2 of a solved sky, and the resulting level. In this order: the description's radiance scale;
/// the white luminance stated in the file; the scale that makes the clear sky near the horizon as bright as that of the
/// picture, if it shows one; the scale that makes a white horizontal surface as bright as the ambient light.
///
/// # Errors
/// [`RenderError::Setting`] if the picture and its ambient light are black.
pub(super) fn radiance_scale(
    spec: &OverlaySpec,
    sky: &RgbFoggySky,
    view: &View<'_>,
) -> Result<(f32, LightLevel), RenderError> {
    let white = sky.white_radiance();
    let primaries = Primaries::of(view.picture);
    let stated = view.picture.white_luminance_cd_m2.map(|white| 1.0 / white);
    let (scale, source) = match (spec.radiance_scale, stated) {
        (Some(scale), _) => (scale as f32, LightLevelSource::RadianceScale),
        (None, Some(scale)) if spec.ambient.is_none() => (scale, LightLevelSource::FileWhite),
        _ => match picture_over_solved(spec, sky, view) {
            Some(scale) => (scale, LightLevelSource::MatchedSky),
            None => (
                luminance(primaries.to_srgb(view.ambient.colour)) / luminance(white),
                LightLevelSource::MatchedAmbient,
            ),
        },
    };
    if !(scale.is_finite() && scale > 0.0) {
        return Err(RenderError::setting(
            "expected a picture or an ambient light that is not black, from which to scale the sky, got black; try radiance-scale, the \
             picture's units in one cd/m^2",
        ));
    }
    let colour = primaries.in_picture(white.map(|c| c * scale));
    Ok((scale, LightLevel { colour, source }))
}

/// Ratio of the picture's sky near the horizon to the solved one.
fn picture_over_solved(spec: &OverlaySpec, sky: &RgbFoggySky, view: &View<'_>) -> Option<f32> {
    if spec.ambient.is_some() {
        return None;
    }
    let picture = view.picture;
    let primaries = Primaries::of(picture);
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
        shown += f64::from(luminance(primaries.to_srgb([rgb[0], rgb[1], rgb[2]])));
        solved += f64::from(luminance(sky.clear_radiance(direction)));
    }
    let scale = (shown / solved) as f32;
    (scale.is_finite() && scale > 0.0).then_some(scale)
}
