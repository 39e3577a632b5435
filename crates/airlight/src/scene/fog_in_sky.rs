//! Sky with fog in the channels of a view.

use super::foggy::FoggySky;
use super::lane_channels::LaneChannels;
use super::{Channels, FogLayers, SceneError};
use crate::fog::FogScattering;
use crate::sky::{SkyTable, View};
use crate::spectrum::{Spectrum, WavelengthGrid};
use glam::DVec3;
use std::sync::Arc;

/// Number of wavelengths in a block of a spectrum.
const PIECE: usize = 16;

/// A sky with fog, in the channels of a view.
pub(super) enum FogInSky {
    /// Red, green and blue.
    Rgb(Box<FoggySky<3>>),
    /// All wavelengths, in blocks.
    Spectral(Vec<FoggySky<PIECE>>),
}

impl FogInSky {
    /// Layers of fog under the sky of a view; clear air for no layers.
    ///
    /// # Errors
    /// [`SceneError`] for invalid layers.
    pub fn new(
        fog: Option<&FogLayers>,
        view: &View,
        channels: Channels,
    ) -> Result<Self, SceneError> {
        let ground = FoggySky::<3>::round_ground(view);
        let scattering = fog.map_or(FogScattering::Single, |fog| fog.scattering);
        let layers = |nm: &[f64]| fog.map_or(Ok(Vec::new()), |fog| fog.constituents(nm));
        Ok(match channels {
            Channels::Rgb(space) => {
                let layers = layers(WavelengthGrid::standard().wavelengths_nm())?;
                let channels = LaneChannels::Rgb(space);
                let sky = FoggySky::new(view, channels, &layers, ground, scattering)?;
                Self::Rgb(Box::new(sky))
            }
            Channels::Spectral => {
                let layers = layers(view.sky().grid().wavelengths_nm())?;
                Self::Spectral(FoggySky::spectral(view, &layers, ground, scattering)?)
            }
        })
    }

    /// The sky without the fog.
    pub fn clear(&self) -> &Arc<SkyTable> {
        match self {
            Self::Rgb(sky) => sky.clear(),
            Self::Spectral(pieces) => pieces[0].clear(),
        }
    }

    /// Replaces radiance without fog by radiance through the fog.
    #[inline]
    pub fn cover(&self, direction: DVec3, values: &mut [f32]) {
        match self {
            Self::Rgb(sky) => cover(sky, direction, values),
            Self::Spectral(pieces) => {
                for (sky, values) in pieces.iter().zip(values.chunks_mut(PIECE)) {
                    cover(sky, direction, values);
                }
            }
        }
    }

    /// Transmittance of the fog to the ground or to space. The first channel stands for all, as droplets are much larger than
    /// the wavelengths.
    pub fn transmittance(&self, direction: DVec3) -> f32 {
        match self {
            Self::Rgb(sky) => sky.fog_transmittance(direction)[0],
            Self::Spectral(pieces) => pieces[0].fog_transmittance(direction)[0],
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
        match self {
            Self::Rgb(sky) => path(sky, direction, distance_m, transmittance, path_radiance),
            Self::Spectral(pieces) => {
                let outs = transmittance
                    .chunks_mut(PIECE)
                    .zip(path_radiance.chunks_mut(PIECE));
                for (sky, (transmittance, path_radiance)) in pieces.iter().zip(outs) {
                    path(sky, direction, distance_m, transmittance, path_radiance);
                }
            }
        }
    }

    /// Irradiance of the sun's disc at a height above the ground (m) on a surface that faces it.
    pub fn sunlight(&self, height_m: f64, out: &mut [f32]) {
        match self {
            Self::Rgb(sky) => put(sky.sunlight(height_m), out),
            Self::Spectral(pieces) => {
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
fn cover<const N: usize>(sky: &FoggySky<N>, direction: DVec3, values: &mut [f32]) {
    let last = values.len() - 1;
    let clear = Spectrum::from_fn(|lane| values[lane.min(last)]);
    put(sky.before(direction, clear), values);
}

fn path<const N: usize>(
    sky: &FoggySky<N>,
    direction: DVec3,
    distance_m: f64,
    transmittance: &mut [f32],
    path_radiance: &mut [f32],
) {
    let optics = sky.optics(direction, distance_m);
    put(optics.transmittance, transmittance);
    put(optics.path_radiance, path_radiance);
}
