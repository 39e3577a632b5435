//! What the N lanes are.

use super::error::SceneError;
use crate::atmosphere::Constituent;
use crate::fog::{FogError, LayerLanes, RgbLayer};
use crate::sky::{TableChannels, View, channel_weights};
use crate::spectrum::{RgbSpace, Spectrum, rgb};
use std::ops::Range;

/// What the N lanes are.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum LaneChannels {
    /// Linear red, green and blue, N = 3: radiances are converted from spectra, (1, 1, 1) being 1 cd/m^2 of the space's
    /// white (irradiances: 1 lx). A transmittance is the channel of sunlight that has come through the air over the same
    /// channel of sunlight outside it: exact for a background as white as the sun, good for greys, wrong by a few percent
    /// for saturated colours far away.
    Rgb(RgbSpace),
    /// Wavelengths of the sky's grid, from the one at place `first` on; lanes beyond the last repeat it. Radiances in
    /// W m^-2 sr^-1 nm^-1.
    Wavelengths {
        /// Place of the first lane's wavelength in the grid.
        first: usize,
    },
}

/// From the wavelengths of a view's grid to N lanes.
pub(super) struct Converter<const N: usize> {
    way: Way<N>,
    /// Which of the grid's wavelengths count.
    used: Range<usize>,
    wavelengths_nm: [f64; N],
    /// The space of red, green and blue.
    space: Option<RgbSpace>,
}

/// How.
enum Way<const N: usize> {
    /// Each lane is one wavelength: its place and its solar irradiance.
    Picked([(usize, f64); N]),
    /// Each lane is a sum over all.
    Summed {
        /// For each wavelength what a unit of its solar irradiance adds to each lane.
        weights: Vec<[f64; N]>,
        /// For each wavelength the share of its transmittance in each lane's.
        shares: Vec<[f64; N]>,
    },
}

impl<const N: usize> Converter<N> {
    /// For the light of a view.
    ///
    /// # Errors
    /// [`SceneError`] where N lanes cannot be these channels.
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

    /// Which of the grid's wavelengths count; what is said of the others is not looked at.
    pub fn used(&self) -> Range<usize> {
        self.used.clone()
    }

    /// The wavelength of each lane, nm; for red, green and blue, dominant ones.
    pub fn wavelengths_nm(&self) -> [f64; N] {
        self.wavelengths_nm
    }

    /// Layers of fog in lanes.
    ///
    /// # Errors
    /// [`SceneError`] where the phase function of a layer has no mean in a channel.
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

    /// Radiance in lanes, of radiance per unit solar irradiance at each wavelength.
    pub fn radiance(&self, per_irradiance: &[f32]) -> [f64; N] {
        match &self.way {
            Way::Picked(picked) => picked.map(|(nm, solar)| solar * f64::from(per_irradiance[nm])),
            Way::Summed { weights, .. } => {
                summed(weights, per_irradiance.iter().map(|v| f64::from(*v)))
            }
        }
    }

    /// Light in lanes, of plain radiance or irradiance at each wavelength under the solar irradiance `solar`; what lies
    /// outside the colour space is held at 0.
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

    /// Opacity in lanes, 1 - transmittance, of the optical depth at each wavelength.
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
