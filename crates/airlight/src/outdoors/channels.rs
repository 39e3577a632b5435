//! What the N lanes are.

use super::error::OutdoorsError;
use crate::sky::{TableChannels, View, channel_weights};
use crate::spectrum::{RgbSpace, Spectrum};

/// What the N lanes are.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Channels {
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

impl Channels {
    /// All wavelengths of a grid of N.
    pub const SPECTRAL: Self = Self::Wavelengths { first: 0 };
}

/// From the wavelengths of a view's grid to N lanes.
pub(super) struct Converter<const N: usize> {
    /// For each wavelength what a unit of its solar irradiance adds to each lane.
    weights: Vec<[f64; N]>,
    /// For each wavelength the share of its transmittance in each lane's.
    shares: Vec<[f64; N]>,
    wavelengths_nm: [f64; N],
}

impl<const N: usize> Converter<N> {
    /// For the light of a view.
    ///
    /// # Errors
    /// [`OutdoorsError`] where N lanes cannot be these channels.
    pub fn new(view: &View<'_>, channels: Channels) -> Result<Self, OutdoorsError> {
        let grid = view.sky().grid();
        let solar = view.solar_irradiance();
        let last = grid.len() - 1;
        // For each lane the weight of each wavelength's radiance per unit solar irradiance.
        let rows: Vec<Vec<f32>> = match channels {
            Channels::Rgb(_) if N != 3 => return Err(OutdoorsError::RgbLanes(N)),
            Channels::Rgb(space) => channel_weights(grid, &solar, TableChannels::Rgb(space)),
            Channels::Wavelengths { first } if first > last => {
                return Err(OutdoorsError::Wavelengths {
                    first,
                    available: grid.len(),
                });
            }
            Channels::Wavelengths { first } => {
                let all = channel_weights(grid, &solar, TableChannels::Spectral);
                (0..N)
                    .map(|lane| all[(first + lane).min(last)].clone())
                    .collect()
            }
        };
        let weight = |nm: usize| std::array::from_fn(|lane| f64::from(rows[lane][nm]));
        let weights: Vec<[f64; N]> = (0..=last).map(weight).collect();
        let share = |nm: usize, lane: usize| match channels {
            Channels::Rgb(_) => {
                let total: f64 = weights.iter().map(|w| w[lane]).sum();
                weights[nm][lane] / total
            }
            Channels::Wavelengths { first } => f64::from(nm == (first + lane).min(last)),
        };
        let shares = (0..=last)
            .map(|nm| std::array::from_fn(|lane| share(nm, lane)))
            .collect();
        let wavelengths_nm = std::array::from_fn(|lane| match channels {
            Channels::Rgb(_) => [612.0, 549.0, 465.0][lane % 3],
            Channels::Wavelengths { first } => grid.wavelengths_nm()[(first + lane).min(last)],
        });
        Ok(Self {
            weights,
            shares,
            wavelengths_nm,
        })
    }

    /// The wavelength of each lane, nm; for red, green and blue, dominant ones.
    pub fn wavelengths_nm(&self) -> [f64; N] {
        self.wavelengths_nm
    }

    /// Radiance in lanes, of radiance per unit solar irradiance at each wavelength.
    pub fn radiance(&self, per_irradiance: &[f32]) -> [f64; N] {
        let mut lanes = [0.0; N];
        for (weights, value) in self.weights.iter().zip(per_irradiance) {
            for (lane, weight) in lanes.iter_mut().zip(weights) {
                *lane += weight * f64::from(*value);
            }
        }
        lanes
    }

    /// Light in lanes, of plain radiance or irradiance at each wavelength under the solar irradiance `solar`; what lies
    /// outside the colour space is held at 0.
    pub fn light(&self, plain: &[f32], solar: &[f32]) -> Spectrum<N> {
        let ratio: Vec<f32> = plain
            .iter()
            .zip(solar)
            .map(|(value, e)| if *e > 0.0 { value / e } else { 0.0 })
            .collect();
        let lanes = self.radiance(&ratio);
        Spectrum::from_fn(|lane| lanes[lane].max(0.0) as f32)
    }

    /// Opacity in lanes, 1 - transmittance, of the optical depth at each wavelength.
    pub fn opacity(&self, depths: &[f32]) -> [f64; N] {
        let mut lanes = [0.0; N];
        for (shares, depth) in self.shares.iter().zip(depths) {
            let opacity = -(-f64::from(*depth)).exp_m1();
            for (lane, share) in lanes.iter_mut().zip(shares) {
                *lane += share * opacity;
            }
        }
        lanes
    }
}
