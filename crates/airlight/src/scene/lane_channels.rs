//! [`LaneChannels`]: meaning of the N lanes of aerial perspective and of a sky with fog.

use super::error::SceneError;
use crate::atmosphere::Constituent;
use crate::fog::{FogError, LayerLanes, RgbLayer};
use crate::sky::{TableChannels, View, channel_weights};
use crate::spectrum::{RgbSpace, Spectrum, rgb};
use std::ops::Range;

/// Meaning of N lanes.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum LaneChannels {
    /// Linear red, green and blue, N = 3. Radiances are converted from spectra; (1, 1, 1) is 1 cd/m^2 of the space's white
    /// (irradiances: 1 lx). A transmittance is the ratio of a channel of attenuated sunlight to that of unattenuated
    /// sunlight: exact for backgrounds with the sun's spectrum, accurate for greys, wrong by a few percent for distant
    /// saturated colours.
    Rgb(RgbSpace),
    /// Consecutive wavelengths of the sky's grid, from the index `first` on; lanes beyond the last wavelength repeat it.
    /// Radiances are in W m^-2 sr^-1 nm^-1.
    Wavelengths {
        /// Index of the first lane's wavelength in the grid.
        first: usize,
    },
}

/// Conversion from the wavelengths of a view's grid to N lanes.
pub(super) struct Converter<const N: usize> {
    way: Way<N>,
    /// Wavelengths of the grid that are used.
    used: Range<usize>,
    wavelengths_nm: [f64; N],
    /// The RGB space; `None` for wavelengths.
    space: Option<RgbSpace>,
}

/// Kind of conversion.
enum Way<const N: usize> {
    /// Each lane is one wavelength: its index and its solar irradiance.
    Picked([(usize, f64); N]),
    /// Each lane is a sum over all wavelengths.
    Summed {
        /// Contribution of each wavelength to each lane, per unit of its solar irradiance.
        weights: Vec<[f64; N]>,
        /// Weight of the transmittance of each wavelength in that of each lane.
        shares: Vec<[f64; N]>,
    },
}

impl<const N: usize> Converter<N> {
    /// A converter for the wavelengths and the solar spectrum of a view.
    ///
    /// # Errors
    /// [`SceneError`] if N lanes cannot hold these channels.
    pub fn new(view: &View, channels: LaneChannels) -> Result<Self, SceneError> {
        let grid = view.sky().grid();
        let solar = view.solar_irradiance();
        let last = grid.len() - 1;
        match channels {
            LaneChannels::Rgb(_) if N != 3 => Err(SceneError::RgbLanes(N)),
            LaneChannels::Rgb(space) => {
                let rows = channel_weights(grid, &solar, TableChannels::Rgb(space));
                let weight = |nm: usize| std::array::from_fn(|lane| f64::from(rows[lane][nm]));
                let weights: Vec<[f64; N]> = (0..=last).map(weight).collect();
                let total: [f64; N] =
                    std::array::from_fn(|lane| weights.iter().map(|w| w[lane]).sum());
                let shares = weights
                    .iter()
                    .map(|w| std::array::from_fn(|lane| w[lane] / total[lane]))
                    .collect();
                Ok(Self {
                    way: Way::Summed { weights, shares },
                    used: 0..last + 1,
                    wavelengths_nm: std::array::from_fn(|lane| rgb::DOMINANT_NM[lane]),
                    space: Some(space),
                })
            }
            LaneChannels::Wavelengths { first } if first > last => Err(SceneError::Wavelengths {
                first,
                available: grid.len(),
            }),
            LaneChannels::Wavelengths { first } => {
                let place = |lane: usize| (first + lane).min(last);
                Ok(Self {
                    way: Way::Picked(std::array::from_fn(|lane| {
                        (place(lane), f64::from(solar[place(lane)]))
                    })),
                    used: first..(first + N).min(last + 1),
                    wavelengths_nm: std::array::from_fn(|lane| grid.wavelengths_nm()[place(lane)]),
                    space: None,
                })
            }
        }
    }

    /// Range of the grid's wavelengths that are used; values at others are ignored.
    pub fn used(&self) -> Range<usize> {
        self.used.clone()
    }

    /// Wavelength of each lane, nm; for red, green and blue the dominant wavelengths.
    pub fn wavelengths_nm(&self) -> [f64; N] {
        self.wavelengths_nm
    }

    /// Layers of fog in lanes.
    ///
    /// # Errors
    /// [`SceneError`] if the phase function of a layer has no valid mean in a channel.
    pub fn layers(&self, layers: &[Constituent]) -> Result<Vec<LayerLanes<N>>, SceneError> {
        let in_lanes = |layer: &Constituent| match self.space {
            Some(space) => {
                let rgb = RgbLayer::from_constituent(layer, space).map_err(FogError::from)?;
                Ok(LayerLanes::rgb(&rgb))
            }
            None => Ok(LayerLanes::new(layer, &self.wavelengths_nm)),
        };
        layers.iter().map(in_lanes).collect()
    }

    /// Converts radiance per unit of solar irradiance at each wavelength to radiance in lanes.
    pub fn radiance(&self, per_irradiance: &[f32]) -> [f64; N] {
        match &self.way {
            Way::Picked(picked) => picked.map(|(nm, solar)| solar * f64::from(per_irradiance[nm])),
            Way::Summed { weights, .. } => {
                summed(weights, per_irradiance.iter().map(|v| f64::from(*v)))
            }
        }
    }

    /// Converts radiance or irradiance at each wavelength, under the solar irradiance `solar`, to lanes; colours outside the
    /// RGB space are clamped to 0.
    pub fn light(&self, plain: &[f32], solar: &[f32]) -> Spectrum<N> {
        let lanes = match &self.way {
            Way::Picked(picked) => picked.map(|(nm, _)| f64::from(plain[nm])),
            Way::Summed { weights, .. } => {
                let ratio = |(value, e): (&f32, &f32)| match *e > 0.0 {
                    true => f64::from(value / e),
                    false => 0.0,
                };
                summed(weights, plain.iter().zip(solar).map(ratio))
            }
        };
        Spectrum::from_fn(|lane| lanes[lane].max(0.0) as f32)
    }

    /// Converts optical depth at each wavelength to opacity, 1 - transmittance, in lanes.
    pub fn opacity(&self, depths: &[f32]) -> [f64; N] {
        let opacity = |depth: f32| -(-f64::from(depth)).exp_m1();
        match &self.way {
            Way::Picked(picked) => picked.map(|(nm, _)| opacity(depths[nm])),
            Way::Summed { shares, .. } => summed(shares, depths.iter().map(|d| opacity(*d))),
        }
    }
}

fn summed<const N: usize>(weights: &[[f64; N]], values: impl Iterator<Item = f64>) -> [f64; N] {
    let mut lanes = [0.0; N];
    for (weights, value) in weights.iter().zip(values) {
        for (lane, weight) in lanes.iter_mut().zip(weights) {
            *lane += weight * value;
        }
    }
    lanes
}
