//! Fog over an existing picture with a depth map.
//!
//! An [`OverlayScene`] describes a picture: a [`Scene`](airlight::scene::Scene) with its fog, lights, sun and camera, and an
//! [`OverlaySpec`] with the colour picture, the depth map and the level of the light. From it:
//!
//! 1. [`OverlayImage::read`]: picture, depth map and ambient light ([`estimate_ambient`]);
//! 2. [`SkyLight::solve`], if the solved sky lights the fog;
//! 3. [`PreparedOverlay::new`]: camera, lights and fog ([`FogOverlay`]);
//! 4. [`Overlay`]: the rows of the picture in fog, which [`OverlayOutput`] writes; [`MonteCarloFog`] replaces their path radiance by a Monte Carlo estimate.

mod ambient;
mod fog_overlay;
mod light_level;
mod monte_carlo;
mod overlay_image;
mod overlay_output;
mod overlay_scene;
mod patch_table;
mod place_lights;
mod prepared_overlay;
mod primaries;
mod sky_light;
mod spec;

pub use ambient::{Ambient, estimate_ambient};
pub use fog_overlay::{ExistingAerial, FogOverlay, FogSource};
pub use light_level::{LightLevel, LightLevelSource};
pub use monte_carlo::{MonteCarloFog, MonteCarloPass};
pub use overlay_image::OverlayImage;
pub use overlay_output::OverlayOutput;
pub use overlay_scene::{OverlayScene, OverlaySolver};
pub use prepared_overlay::PreparedOverlay;
pub use sky_light::SkyLight;
pub use spec::{DepthFileKind, NegativeDepth, OverlaySpec};

use airlight::fog::EvenFog;
use airlight::scene::{FogLayers, SceneError};
use airlight::transfer::RgbPathOptics;
use airlight_image::input::{DepthKind, DepthMap, LightReference, Picture};
use airlight_image::{ImageError, Intrinsics, Notes, RowSource, Size};
use ambient::horizon_pixels;
use fog_overlay::FogSampler;
use glam::DVec3;
use patch_table::PatchTable;
use primaries::Primaries;

/// Rows of a picture in fog.
#[derive(Debug)]
pub struct Overlay<'a> {
    picture: &'a Picture,
    depth: &'a DepthMap,
    camera: &'a Intrinsics,
    fog: FogSampler<'a>,
    channels: Channels,
    /// Path radiance of the fog in each pixel, if it is computed elsewhere.
    path_radiance: Option<&'a [f32]>,
    patches: Option<PatchTable<'a>>,
}

/// Channels of an [`Overlay`].
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Channels {
    /// Red, green and blue of the picture in fog.
    Picture,
    /// The picture, then red, green and blue of the transmittance and of the path radiance, and the depth along the camera's axis
    /// in metres.
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
    /// EXR names, without opacity.
    fn names(self) -> &'static [&'static str] {
        match self {
            Self::Picture => &NAMES[..3],
            Self::Layers => &NAMES,
        }
    }
}

impl<'a> Overlay<'a> {
    /// A picture and its depth map in fog; `eye_height_m` is the camera's height above the zero of the fog's heights.
    ///
    /// # Errors
    /// [`ImageError::SizesDiffer`] if picture and depth map differ in size, [`ImageError::Setting`] if the camera's does.
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
            fog: FogSampler::new(overlay, eye_height_m, Primaries::of(picture)),
            channels,
            path_radiance: None,
            patches: None,
        })
    }

    /// The same overlay with the patches of fog; `fog` describes the same layers as the overlay.
    ///
    /// # Errors
    /// [`SceneError`] for patches out of range.
    pub fn with_patches(self, fog: &FogLayers) -> Result<Self, SceneError> {
        let far_m = self.depth.range_m().map_or(0.0, |(_, far)| f64::from(far));
        let (width, height) = (self.size().width(), self.size().height());
        let corners = [
            (0, 0),
            (width - 1, 0),
            (0, height - 1),
            (width - 1, height - 1),
        ];
        let longest = corners
            .map(|(x, y)| self.camera.ray_length_per_z(x, y))
            .into_iter()
            .fold(1.0, f64::max);
        let has_sky = self.depth.metres.iter().any(|m| m.is_infinite());
        let (eye_height_m, ground_radius_m) = self.fog.place();
        let patches = PatchTable::new(
            fog,
            self.camera,
            eye_height_m,
            ground_radius_m,
            (far_m * longest, has_sky),
        )?;
        Ok(Self { patches, ..self })
    }

    /// The same overlay with a given path radiance of the fog: red, green and blue of each pixel, row by row, in the picture's
    /// unit. Light of point, spot and sphere lights is added to it; fog of one colour ignores it.
    ///
    /// # Errors
    /// [`ImageError::Setting`] if the number of values does not match the picture.
    pub fn with_path_radiance(self, path_radiance: &'a [f32]) -> Result<Self, ImageError> {
        match path_radiance.len() == self.picture.rgb.len() {
            true => Ok(Self {
                path_radiance: Some(path_radiance),
                ..self
            }),
            false => Err(ImageError::Setting {
                what: "the number of path radiances",
                got: path_radiance.len().to_string(),
                right: "three for each pixel of the picture",
            }),
        }
    }

    /// Size of the picture.
    pub fn size(&self) -> Size {
        self.picture.size
    }

    /// Whether rows contain [`Channels::Layers`].
    pub fn has_layers(&self) -> bool {
        self.channels == Channels::Layers
    }

    /// Direction and distance (m; infinite: the sky) of each pixel of row `y`.
    pub fn rays(&self, y: u32) -> Vec<(DVec3, f64)> {
        let (directions, distances) = self.rays_apart(y);
        directions.into_iter().zip(distances).collect()
    }

    /// [`Self::rays`] as two lists.
    fn rays_apart(&self, y: u32) -> (Vec<DVec3>, Vec<f64>) {
        let width = self.picture.size.width() as usize;
        let mut directions = vec![DVec3::ZERO; width];
        let mut distances = vec![1.0; width];
        self.camera.fill(y, &mut directions, &mut distances);
        self.measure(y, &mut distances);
        (directions, distances)
    }

    /// Distances (m) of the pixels of row `y`, in the place of their ray lengths per depth.
    fn measure(&self, y: u32, lengths: &mut [f64]) {
        let depths = &self.depth.metres[y as usize * lengths.len()..];
        for (length, depth) in lengths.iter_mut().zip(depths) {
            *length = match self.depth.kind {
                DepthKind::Z => f64::from(*depth) * *length,
                DepthKind::Ray => f64::from(*depth),
            };
        }
    }

    /// The fog, if it needs nothing but the distance of a pixel and its colour, and the factor of patches, which is one on the
    /// distance.
    fn even_fog(&self) -> Option<&EvenFog> {
        let is_plain = self.path_radiance.is_none() && !self.has_layers();
        self.fog
            .even()
            .filter(|_| is_plain && self.picture.alpha.is_none())
    }

    /// A note where the fog hides all objects or none, as with a wrong unit of depth; from a sample of the pixels.
    pub fn notes(&self) -> Notes {
        const SAMPLES: u32 = 16;
        let (width, height) = (self.picture.size.width(), self.picture.size.height());
        let (mut least, mut most) = (1.0f32, 0.0f32);
        for row in 0..SAMPLES.min(height) {
            let rays = self.rays(row * height / SAMPLES.min(height)).into_iter();
            let step = width.div_ceil(SAMPLES) as usize;
            let seen = rays
                .step_by(step)
                .filter(|ray| ray.1.is_finite() && ray.1 > 0.0);
            let (directions, distances): (Vec<_>, Vec<_>) = seen.unzip();
            let mut optics = vec![RgbPathOptics::CLEAR; directions.len()];
            self.fog
                .optics(&directions, &distances, None, None, &mut optics);
            for [_, green, _] in optics.iter().map(|optics| optics.transmittance) {
                least = least.min(green);
                most = most.max(green);
            }
        }
        let mut notes = Notes::default();
        if most > 0.0 && least > 0.99 {
            notes.add("the fog hides nothing: is the unit of depth (depth-scale) right?");
        } else if least < 1.0 && most < 0.01 {
            notes.add("the fog hides every object: is the unit of depth (depth-scale) right?");
        }
        notes
    }

    /// EXR names of the channels; opacity is last, if the picture has it. Colours and opacity belong to the layer from which they
    /// were read.
    pub fn channel_names(&self) -> Vec<String> {
        let layer = self.picture.layer.as_ref();
        let prefix = layer.map_or("", |layer| layer.prefix.as_str());
        let opacity = self.picture.alpha.as_ref().map(|_| "A");
        let (colours, layers) = self.channels.names().split_at(3);
        let own = |name: &&str| format!("{prefix}{name}");
        let layers = layers.iter().map(|name| (*name).to_owned());
        let opacity = opacity.iter().map(own);
        colours
            .iter()
            .map(own)
            .chain(layers)
            .chain(opacity)
            .collect()
    }

    /// A pixel's colour through the fog. Colours of linear files are premultiplied by opacity, so the path radiance in front of
    /// them is multiplied by it too.
    fn through(&self, optics: &RgbPathOptics, colour: [f32; 3], opacity: f32) -> [f32; 3] {
        if self.picture.reference == LightReference::Display || opacity == 1.0 {
            self.fog.apply(optics, colour)
        } else if opacity > 0.0 {
            self.fog
                .apply(optics, colour.map(|c| c / opacity))
                .map(|c| c * opacity)
        } else {
            std::array::from_fn(|i| colour[i] * optics.transmittance[i])
        }
    }
}

impl RowSource for Overlay<'_> {
    fn channels(&self) -> usize {
        self.channels.names().len() + usize::from(self.picture.alpha.is_some())
    }

    fn fill_row(&self, y: u32, out: &mut [f32]) {
        let width = self.picture.size.width() as usize;
        let first = y as usize * width;
        let patches = self.patches.as_ref().map(|patches| patches.row(y));
        if let Some(fog) = self.even_fog() {
            let mut distances = vec![1.0; width];
            self.camera.fill_lengths(y, &mut distances);
            self.measure(y, &mut distances);
            if let Some(row) = patches {
                for (x, distance) in (0..).zip(&mut distances) {
                    *distance *= f64::from(row.factor(x, *distance));
                }
            }
            fog.apply(&distances, &self.picture.rgb[3 * first..][..3 * width], out);
            return;
        }
        let (directions, distances) = self.rays_apart(y);
        let factors = patches.map(|row| -> Vec<f32> {
            let rays = (0..).zip(&distances);
            rays.map(|(x, distance)| row.factor(x, *distance)).collect()
        });
        let pixels = first..first + width;
        let path_radiance = self
            .path_radiance
            .map(|all| &all.as_chunks::<3>().0[pixels.clone()]);
        let mut optics = vec![RgbPathOptics::CLEAR; width];
        self.fog.optics(
            &directions,
            &distances,
            factors.as_deref(),
            path_radiance,
            &mut optics,
        );
        let colours = &self.picture.rgb.as_chunks::<3>().0[pixels.clone()];
        let opacities = self
            .picture
            .alpha
            .as_ref()
            .map(|alpha| &alpha[pixels.clone()]);
        if !self.has_layers() && opacities.is_none() {
            self.fog
                .apply_all(&optics, colours, out.as_chunks_mut::<3>().0);
            return;
        }
        for (i, out) in out.chunks_exact_mut(self.channels()).enumerate() {
            let optics = &optics[i];
            let opacity = opacities.map(|opacities| opacities[i]);
            let seen = self.through(optics, colours[i], opacity.unwrap_or(1.0));
            out[..3].copy_from_slice(&seen);
            if self.has_layers() {
                out[3..6].copy_from_slice(&optics.transmittance);
                out[6..9].copy_from_slice(&optics.path_radiance);
                out[9] = match self.depth.kind {
                    DepthKind::Z => self.depth.metres[first + i],
                    DepthKind::Ray => {
                        (distances[i] / self.camera.ray_length_per_z(i as u32, y)) as f32
                    }
                };
            }
            if let (Some(opacity), Some(last)) = (opacity, out.last_mut()) {
                *last = opacity;
            }
        }
    }
}

#[cfg(test)]
mod tests;
