//! Quantities by wavelength or by channel.

use crate::spectrum::{SpectralCurve, Spectrum};

mod sealed {
    /// The operations behind [`super::ChannelValues`].
    pub trait Values {
        /// The first value that is negative or not finite.
        fn first_invalid(&self) -> Option<f64>;
        /// The largest value.
        fn largest(&self) -> f64;
    }
}
pub(super) use sealed::Values;

/// A quantity by wavelength or by channel: a [`SpectralCurve`], or red, green and blue.
pub trait ChannelValues: Values + Clone + std::fmt::Debug + PartialEq {}

impl ChannelValues for SpectralCurve {}
impl ChannelValues for [f32; 3] {}
impl<const N: usize> ChannelValues for Spectrum<N> {}

/// Values of a curve every 10 nm from 300 to 900 nm.
fn samples(curve: &SpectralCurve) -> impl Iterator<Item = f64> + '_ {
    (30..=90).map(|i| curve.at(10.0 * f64::from(i)))
}

impl Values for SpectralCurve {
    fn first_invalid(&self) -> Option<f64> {
        samples(self).find(|v| !(v.is_finite() && *v >= 0.0))
    }

    fn largest(&self) -> f64 {
        samples(self).fold(f64::NEG_INFINITY, f64::max)
    }
}

impl Values for [f32] {
    fn first_invalid(&self) -> Option<f64> {
        let value = self.iter().find(|v| !(v.is_finite() && **v >= 0.0));
        value.map(|&v| f64::from(v))
    }

    fn largest(&self) -> f64 {
        let largest = self.iter().copied().fold(f32::NEG_INFINITY, f32::max);
        f64::from(largest)
    }
}

impl Values for [f32; 3] {
    fn first_invalid(&self) -> Option<f64> {
        self[..].first_invalid()
    }

    fn largest(&self) -> f64 {
        self[..].largest()
    }
}

impl<const N: usize> Values for Spectrum<N> {
    fn first_invalid(&self) -> Option<f64> {
        self.0[..].first_invalid()
    }

    fn largest(&self) -> f64 {
        self.0[..].largest()
    }
}
