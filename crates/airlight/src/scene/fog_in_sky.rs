//! Sky with fog in the channels of a view.

use super::foggy::FoggySky;
use super::lane_channels::LaneChannels;
use super::light::LitSky;
use super::{Channels, FogLayers, SceneError};
use crate::control::Control;
use crate::fog::{FogScattering, PatchView};
use crate::sky::SkyTable;
use crate::spectrum::{Spectrum, WavelengthGrid};
use glam::DVec3;
use std::sync::Arc;

/// Number of wavelengths in a block of a spectrum.
const PIECE: usize = 16;

/// A sky with fog, in the channels of a view.
pub(super) struct FogInSky {
    channels: InChannels,
    patches: Option<PatchView>,
}

/// A sky with even fog, by channels.
enum InChannels {
    /// Red, green and blue.
    Rgb(Box<FoggySky<3>>),
    /// All wavelengths, in blocks.
    Spectral(Vec<FoggySky<PIECE>>),
}

impl FogInSky {
    /// Layers of fog under a sky; clear air for no layers.
    ///
    /// # Errors
    /// [`SceneError`] for invalid layers.
    pub fn new(
        fog: Option<&FogLayers>,
        sky: LitSky<'_>,
        channels: Channels,
        control: Control<'_>,
    ) -> Result<Self, SceneError> {
        let view = sky.view;
        let ground = FoggySky::<3>::round_ground(view);
        let scattering = fog.map_or(FogScattering::Single, |fog| fog.scattering);
        let layers = |nm: &[f64]| match fog {
            Some(fog) => fog.constituents_with(nm, control),
            None => Ok(Vec::new()),
        };
        let in_channels = match channels {
            Channels::Rgb(space) => {
                let layers = layers(WavelengthGrid::standard().wavelengths_nm())?;
                let channels = LaneChannels::Rgb(space);
                let sky = FoggySky::new(sky, channels, &layers, ground, scattering, control)?;
                InChannels::Rgb(Box::new(sky))
            }
            Channels::Spectral => {
                let layers = layers(view.sky().grid().wavelengths_nm())?;
                InChannels::Spectral(FoggySky::spectral(
                    sky, &layers, ground, scattering, control,
                )?)
            }
        };
        let patches = match fog {
            Some(fog) => fog.patches_in_view(view)?,
            None => None,
        };
        Ok(Self {
            channels: in_channels,
            patches,
        })
    }

    /// The sky without the fog.
    pub fn clear(&self) -> &Arc<SkyTable> {
        match &self.channels {
            InChannels::Rgb(sky) => sky.clear(),
            InChannels::Spectral(pieces) => pieces[0].clear(),
        }
    }

    /// Factor of the patches on the optical depth of the fog up to a distance (m; infinite: to the ground or to space).
    fn factor(&self, direction: DVec3, distance_m: f64) -> Option<f32> {
        let patches = self.patches.as_ref()?;
        let ground_m = match &self.channels {
            InChannels::Rgb(sky) => sky.aerial().ground_distance_m(direction),
            InChannels::Spectral(pieces) => pieces[0].aerial().ground_distance_m(direction),
        };
        let end_m = ground_m.map_or(distance_m, |ground_m| ground_m.min(distance_m));
        Some(patches.factor(direction, end_m) as f32)
    }

    /// Replaces radiance without fog by radiance through the fog.
    #[inline]
    pub fn cover(&self, direction: DVec3, values: &mut [f32]) {
        let factor = self.factor(direction, f64::INFINITY);
        match &self.channels {
            InChannels::Rgb(sky) => cover(sky, direction, factor, values),
            InChannels::Spectral(pieces) => {
                for (sky, values) in pieces.iter().zip(values.chunks_mut(PIECE)) {
                    cover(sky, direction, factor, values);
                }
            }
        }
    }

    /// Transmittance of the fog to the ground or to space. The first channel stands for all, as droplets are much larger than
    /// the wavelengths.
    pub fn transmittance(&self, direction: DVec3) -> f32 {
        let even = match &self.channels {
            InChannels::Rgb(sky) => sky.fog_transmittance(direction)[0],
            InChannels::Spectral(pieces) => pieces[0].fog_transmittance(direction)[0],
        };
        self.in_patches(even, direction, f64::INFINITY)
    }

    /// Transmittance of the fog to a point at a distance, m, of the first channel.
    pub fn transmittance_to(&self, direction: DVec3, distance_m: f64) -> f32 {
        let even = match &self.channels {
            InChannels::Rgb(sky) => sky.fog_transmittance_to(direction, distance_m)[0],
            InChannels::Spectral(pieces) => {
                pieces[0].fog_transmittance_to(direction, distance_m)[0]
            }
        };
        self.in_patches(even, direction, distance_m)
    }

    /// A transmittance with the patches on its ray.
    fn in_patches(&self, even: f32, direction: DVec3, distance_m: f64) -> f32 {
        match self.factor(direction, distance_m) {
            Some(factor) => (Spectrum([even]).ln() * factor).exp()[0],
            None => even,
        }
    }

    /// Transmittance and path radiance of air and fog between the eye and a point at a distance, m.
    pub fn path(
        &self,
        direction: DVec3,
        distance_m: f64,
        transmittance: &mut [f32],
        path_radiance: &mut [f32],
    ) {
        let factor = self.factor(direction, distance_m);
        let optics = Ray {
            direction,
            distance_m,
            factor,
        };
        match &self.channels {
            InChannels::Rgb(sky) => optics.path(sky, transmittance, path_radiance),
            InChannels::Spectral(pieces) => {
                let outs = transmittance
                    .chunks_mut(PIECE)
                    .zip(path_radiance.chunks_mut(PIECE));
                for (sky, (transmittance, path_radiance)) in pieces.iter().zip(outs) {
                    optics.path(sky, transmittance, path_radiance);
                }
            }
        }
    }

    /// Transmittance of the air without the fog between the eye and a point at a distance, m.
    pub fn air_transmittance(&self, direction: DVec3, distance_m: f64, out: &mut [f32]) {
        match &self.channels {
            InChannels::Rgb(sky) => {
                put(
                    sky.aerial().optics(direction, distance_m).transmittance,
                    out,
                );
            }
            InChannels::Spectral(pieces) => {
                for (sky, out) in pieces.iter().zip(out.chunks_mut(PIECE)) {
                    put(
                        sky.aerial().optics(direction, distance_m).transmittance,
                        out,
                    );
                }
            }
        }
    }

    /// Irradiance of the sun's disc at a height above the ground (m) on a surface that faces it, in even fog.
    pub fn sunlight(&self, height_m: f64, out: &mut [f32]) {
        match &self.channels {
            InChannels::Rgb(sky) => put(sky.sunlight(height_m), out),
            InChannels::Spectral(pieces) => {
                for (sky, out) in pieces.iter().zip(out.chunks_mut(PIECE)) {
                    put(sky.sunlight(height_m), out);
                }
            }
        }
    }
}

/// Writes lanes; those beyond the last value repeat it.
fn put<const N: usize>(lanes: Spectrum<N>, out: &mut [f32]) {
    out.copy_from_slice(&lanes.0[..out.len()]);
}

#[inline]
fn cover<const N: usize>(
    sky: &FoggySky<N>,
    direction: DVec3,
    factor: Option<f32>,
    values: &mut [f32],
) {
    let last = values.len() - 1;
    let clear = Spectrum::from_fn(|lane| values[lane.min(last)]);
    put(sky.before(direction, clear, factor), values);
}

/// A ray to a point, and the factor on the optical depth of the fog along it.
struct Ray {
    direction: DVec3,
    distance_m: f64,
    factor: Option<f32>,
}

impl Ray {
    fn path<const N: usize>(
        &self,
        sky: &FoggySky<N>,
        transmittance: &mut [f32],
        path_radiance: &mut [f32],
    ) {
        let optics = sky.optics(self.direction, self.distance_m, self.factor);
        put(optics.transmittance, transmittance);
        put(optics.path_radiance, path_radiance);
    }
}
