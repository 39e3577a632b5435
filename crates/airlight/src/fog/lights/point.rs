//! A lamp that shines equally in all directions.

use super::check;
use crate::fog::layer::FogError;
use crate::spectrum::Spectrum;
use glam::DVec3;

/// A small lamp that shines equally in all directions.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct PointLight<const N: usize> {
    /// Where it is, m; y is the height.
    pub position: DVec3,
    /// Radiant intensity, W sr^-1 nm^-1 (or candela, for colours): the irradiance `r` metres away is `I / r^2`.
    pub intensity: Spectrum<N>,
    /// Its size, m, above 0: a line of sight is taken to pass no closer than this, nor a lit point to lie closer, so that
    /// nothing is infinite. Farther away it makes no difference.
    pub radius_m: f64,
}

impl<const N: usize> PointLight<N> {
    /// A lamp whose numbers are checked.
    ///
    /// # Errors
    /// [`FogError`] unless the position is finite, the radius above 0 and the intensity finite and not below 0.
    pub fn new(position: DVec3, intensity: Spectrum<N>, radius_m: f64) -> Result<Self, FogError> {
        check::position(position)?;
        check::radius(radius_m)?;
        check::light("the intensity of a lamp", intensity)?;
        Ok(Self {
            position,
            intensity,
            radius_m,
        })
    }
}
