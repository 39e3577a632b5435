//! Fog laid over a picture that exists: colour and depth in, the fogged picture and its layers out.

mod ambient;

pub use ambient::{Ambient, estimate_ambient};

use crate::input::{DepthKind, DepthMap, LightReference, Picture};
use crate::{Intrinsics, RenderError, RowSource};
use airlight::fog::{Fog, legacy};
use airlight::path::PathOptics;
use airlight::spectrum::Spectrum;
use airlight::spectrum::rgb::{srgb_decode, srgb_encode};
use glam::DVec3;

/// What lies between camera and scene.
#[derive(Clone, Debug)]
pub enum Veil {
    /// A fog.
    Fog(Box<Fog<3>>),
    /// Exponential-squared fog, a look: density (1/m) and colour.
    ExponentialSquared(f64, Spectrum<3>),
    /// Linear fog, a look: where it starts and ends (m), and colour.
    Linear(f64, f64, Spectrum<3>),
    /// Foggy Cityscapes (Sakaridis et al. 2018): uniform fog of an extinction (1/m) and one colour, blended in encoded
    /// (sRGB) values instead of light.
    Encoded(f64, Spectrum<3>),
}

impl Veil {
    /// What it does up to a distance (m; infinite: the sky) in a direction from an eye at a height (m).
    pub fn optics(&self, eye_height_m: f64, direction: DVec3, distance_m: f64) -> PathOptics<3> {
        match self {
            Self::Fog(fog) => fog.along(eye_height_m, direction, distance_m),
            Self::ExponentialSquared(density, colour) => {
                legacy::exponential_squared(*density, distance_m, *colour)
            }
            Self::Linear(start, end, colour) => legacy::linear(*start, *end, distance_m, *colour),
            Self::Encoded(extinction, colour) => {
                let transmittance = (-extinction * distance_m).exp() as f32;
                PathOptics {
                    transmittance: Spectrum::splat(transmittance),
                    path_radiance: *colour * (1.0 - transmittance),
                }
            }
        }
    }

    /// A colour seen through it.
    fn apply(&self, optics: &PathOptics<3>, colour: Spectrum<3>) -> Spectrum<3> {
        let Self::Encoded(_, fog) = self else {
            return optics.apply(colour);
        };
        let part = f64::from(optics.transmittance[0]);
        if part == 1.0 {
            return colour;
        }
        Spectrum::from_fn(|i| {
            let of = |value: f32| srgb_encode(f64::from(value));
            srgb_decode(of(colour[i]) * part + of(fog[i]) * (1.0 - part)) as f32
        })
    }
}

/// A picture, its depth, its camera, and a veil over it.
#[derive(Clone, Copy, Debug)]
pub struct Overlay<'a> {
    picture: &'a Picture,
    depth: &'a DepthMap,
    camera: &'a Intrinsics,
    eye_height_m: f64,
    veil: &'a Veil,
    channels: Channels,
}

/// What a row of an [`Overlay`] holds for each pixel.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Channels {
    /// Red, green, blue of the fogged picture.
    Picture,
    /// The same; red, green, blue of the transmittance and of the path radiance; distance in metres.
    Layers,
}

/// EXR names of [`Channels::Layers`], of which the first three are those of [`Channels::Picture`].
const NAMES: [&str; 10] = [
    "R",
    "G",
    "B",
    "transmittance.R",
    "transmittance.G",
    "transmittance.B",
    "path_radiance.R",
    "path_radiance.G",
    "path_radiance.B",
    "Z",
];

impl Channels {
    /// Without opacity.
    fn names(self) -> &'static [&'static str] {
        match self {
            Self::Picture => &NAMES[..3],
            Self::Layers => &NAMES,
        }
    }
}

impl<'a> Overlay<'a> {
    /// Puts them together; `eye_height_m` is the camera's height above the zero of the fog's heights.
    ///
    /// # Errors
    /// [`RenderError::SizesDiffer`] where picture and depth differ in size, [`RenderError::Setting`] where the camera is
    /// of another.
    pub fn new(
        picture: &'a Picture,
        depth: &'a DepthMap,
        camera: &'a Intrinsics,
        eye_height_m: f64,
        veil: &'a Veil,
        channels: Channels,
    ) -> Result<Self, RenderError> {
        depth.check_against(picture)?;
        if camera.size() != picture.size {
            return Err(RenderError::Setting {
                what: "the size of the camera's picture",
                got: format!("{} x {}", camera.size().width(), camera.size().height()),
                right: "that of the picture",
            });
        }
        Ok(Self {
            picture,
            depth,
            camera,
            eye_height_m,
            veil,
            channels,
        })
    }

    /// EXR names of the channels: opacity comes last, where the picture has it.
    pub fn channel_names(&self) -> Vec<&'static str> {
        let opacity = self.picture.alpha.as_ref().map(|_| "A");
        let names = self.channels.names().iter().copied();
        names.chain(opacity).collect()
    }

    /// A pixel's colour seen through the fog, and the opacity that its colour is multiplied by: fog scatters before what is
    /// there only.
    fn seen(&self, optics: &PathOptics<3>, colour: Spectrum<3>, opacity: f32) -> Spectrum<3> {
        if self.picture.reference == LightReference::Display || opacity == 1.0 {
            self.veil.apply(optics, colour)
        } else if opacity > 0.0 {
            self.veil.apply(optics, colour / opacity) * opacity
        } else {
            colour * optics.transmittance
        }
    }
}

impl RowSource for Overlay<'_> {
    fn channels(&self) -> usize {
        self.channels.names().len() + usize::from(self.picture.alpha.is_some())
    }

    fn fill_row(&self, y: u32, out: &mut [f32]) {
        let width = self.picture.size.width() as usize;
        let mut directions = vec![DVec3::ZERO; width];
        let mut lengths = vec![1.0; width];
        self.camera.fill(y, &mut directions, &mut lengths);
        let first = y as usize * width;
        for (i, out) in out.chunks_exact_mut(self.channels()).enumerate() {
            let pixel = first + i;
            let rgb = &self.picture.rgb[3 * pixel..3 * pixel + 3];
            let colour = Spectrum([rgb[0], rgb[1], rgb[2]]);
            let distance = f64::from(self.depth.metres[pixel])
                * match self.depth.kind {
                    DepthKind::Z => lengths[i],
                    DepthKind::Ray => 1.0,
                };
            let optics = self.veil.optics(self.eye_height_m, directions[i], distance);
            let opacity = self.picture.alpha.as_ref().map(|alpha| alpha[pixel]);
            let seen = self.seen(&optics, colour, opacity.unwrap_or(1.0));
            out[..3].copy_from_slice(&seen.0);
            if self.channels == Channels::Layers {
                out[3..6].copy_from_slice(&optics.transmittance.0);
                out[6..9].copy_from_slice(&optics.path_radiance.0);
                out[9] = distance as f32;
            }
            if let (Some(opacity), Some(last)) = (opacity, out.last_mut()) {
                *last = opacity;
            }
        }
    }
}

#[cfg(test)]
mod tests;
