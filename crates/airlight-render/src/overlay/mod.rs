//! Fog laid over a picture that exists: colour and depth in, the fogged picture and its layers out.
//!
//! From the ground up: the light that a picture shows fog to be in ([`estimate_ambient`]); lights ([`RgbLightSet`](airlight::fog::lights::RgbLightSet)); what lies
//! between camera and scene ([`FogOverlay`]); both put together, row by row ([`Overlay`]).

mod ambient;
mod fog_overlay;

pub use ambient::{Ambient, estimate_ambient, horizon_pixels};
pub use fog_overlay::{ExistingAerial, FogOverlay, FogSource};

use airlight::spectrum::Spectrum;
use airlight::transfer::PathOptics;
use airlight_image::input::{DepthKind, DepthMap, LightReference, Picture};
use airlight_image::{ImageError, Intrinsics, RowSource};
use fog_overlay::FogSampler;
use glam::DVec3;

/// A picture, its depth, its camera, and a veil over it.
pub struct Overlay<'a> {
    picture: &'a Picture,
    depth: &'a DepthMap,
    camera: &'a Intrinsics,
    seen: FogSampler<'a>,
    channels: Channels,
    /// Path radiance of the fog in each pixel, where it is known already.
    given: Option<&'a [f32]>,
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
    /// [`ImageError::SizesDiffer`] where picture and depth differ in size, [`ImageError::Setting`] where the camera is
    /// of another.
    pub fn new(
        picture: &'a Picture,
        depth: &'a DepthMap,
        camera: &'a Intrinsics,
        eye_height_m: f64,
        overlay: &'a FogOverlay,
        channels: Channels,
    ) -> Result<Self, ImageError> {
        depth.check_against(picture)?;
        if camera.size() != picture.size {
            return Err(ImageError::Setting {
                what: "the size of the camera's picture",
                got: format!("{} x {}", camera.size().width(), camera.size().height()),
                right: "that of the picture",
            });
        }
        Ok(Self {
            picture,
            depth,
            camera,
            seen: FogSampler::from_height(overlay, eye_height_m),
            channels,
            given: None,
        })
    }

    /// The same with the path radiance of its fog made elsewhere: red, green and blue of each pixel, row after row, in the
    /// picture's unit. LightSet add to it; looks take no notice of it.
    ///
    /// # Errors
    /// [`ImageError::Setting`] where it is not of the picture's size.
    pub fn with_path_radiance(self, given: &'a [f32]) -> Result<Self, ImageError> {
        match given.len() == self.picture.rgb.len() {
            true => Ok(Self {
                given: Some(given),
                ..self
            }),
            false => Err(ImageError::Setting {
                what: "the number of path radiances",
                got: given.len().to_string(),
                right: "three for each pixel of the picture",
            }),
        }
    }

    /// Where the pixels of row `y` look, and how far things are there, m (infinite: the sky).
    pub fn lines(&self, y: u32) -> Vec<(DVec3, f64)> {
        let width = self.picture.size.width() as usize;
        let mut directions = vec![DVec3::ZERO; width];
        let mut lengths = vec![1.0; width];
        self.camera.fill(y, &mut directions, &mut lengths);
        let depths = &self.depth.metres[y as usize * width..][..width];
        let distance = |(depth, length): (&f32, &f64)| {
            let factor = match self.depth.kind {
                DepthKind::Z => *length,
                DepthKind::Ray => 1.0,
            };
            f64::from(*depth) * factor
        };
        let distances = depths.iter().zip(&lengths).map(distance);
        directions.into_iter().zip(distances).collect()
    }

    /// EXR names of the channels: opacity comes last, where the picture has it.
    pub fn channel_names(&self) -> Vec<&'static str> {
        let opacity = self.picture.alpha.as_ref().map(|_| "A");
        let names = self.channels.names().iter().copied();
        names.chain(opacity).collect()
    }

    /// A pixel's colour seen through the fog, and the opacity that its colour is multiplied by: fog scatters before what is
    /// there only.
    fn through(&self, optics: &PathOptics<3>, colour: Spectrum<3>, opacity: f32) -> Spectrum<3> {
        if self.picture.reference == LightReference::Display || opacity == 1.0 {
            self.seen.apply(optics, colour)
        } else if opacity > 0.0 {
            self.seen.apply(optics, colour / opacity) * opacity
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
        let first = y as usize * self.picture.size.width() as usize;
        let lines = self.lines(y);
        let pixels = out.chunks_exact_mut(self.channels()).zip(lines);
        for (i, (out, (direction, distance))) in pixels.enumerate() {
            let pixel = first + i;
            let rgb = &self.picture.rgb[3 * pixel..3 * pixel + 3];
            let colour = Spectrum([rgb[0], rgb[1], rgb[2]]);
            let given = self.given.map(|given| &given[3 * pixel..3 * pixel + 3]);
            let given = given.map(|rgb| Spectrum([rgb[0], rgb[1], rgb[2]]));
            let optics = self.seen.optics(direction, distance, given);
            let opacity = self.picture.alpha.as_ref().map(|alpha| alpha[pixel]);
            let seen = self.through(&optics, colour, opacity.unwrap_or(1.0));
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
