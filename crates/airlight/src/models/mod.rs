//! Published models of the sky, as printed and as corrected, behind one interface.
//!
//! The module of each model names its paper, with equation numbers, errata and its difference to the solver of
//! [`crate::sky`].

pub mod four_orders;
pub mod hillaire2020;
#[cfg(feature = "hosek-wilkie")]
pub mod hosek_wilkie;
pub mod klassen1987;
mod lut;
pub mod preetham;
pub mod single_scattering;

pub use lut::MultipleScatteringSettings;

use crate::sky::LineOfSight;
use crate::spectrum::WavelengthGrid;
use glam::DVec3;

/// A published model of the sky for one eye and one sun.
///
/// Colours are CIE 1931 XYZ with `Y` in cd/m^2. Directions are unit vectors that point away from the eye
/// ([`crate::axes`]).
pub trait PublishedModel: Send + Sync {
    /// Unit vector towards the sun's centre.
    fn sun(&self) -> DVec3;

    /// Angle from the sun's centre beyond which its disc has no light, rad.
    fn disc_edge_rad(&self) -> f64 {
        crate::sun::SunDisc::default().angular_radius_rad
    }

    /// True if the radiance below the horizon includes the model's own ground and the air in front of it. For other models the
    /// renderer draws the ground.
    fn has_ground(&self) -> bool {
        false
    }

    /// Colour of the sky along a direction, without the sun's disc.
    fn sky_xyz(&self, direction: DVec3) -> [f64; 3];

    /// Colour of the sun's disc along a direction, attenuated by the air; black outside the disc.
    fn disc_xyz(&self, direction: DVec3) -> [f64; 3];

    /// Evaluates the sky along one direction after another, for models that reuse results of neighbouring directions: equal to
    /// [`Self::sky_xyz`] within the tolerance that such a model states.
    fn walk(&self) -> Box<dyn FnMut(DVec3) -> [f64; 3] + '_> {
        Box::new(|direction| self.sky_xyz(direction))
    }

    /// Wavelengths of the model's spectra, with their solar spectrum; `None` for models of colours only.
    fn grid(&self) -> Option<&WavelengthGrid> {
        None
    }

    /// Wavelengths of the model's spectra, nm; empty for models of colours only.
    fn wavelengths_nm(&self) -> &[f64] {
        self.grid().map_or(&[], WavelengthGrid::wavelengths_nm)
    }

    /// Spectral radiance of the sky (W m^-2 sr^-1 nm^-1) along a direction, at [`Self::wavelengths_nm`]; its colour is
    /// [`Self::sky_xyz`].
    fn sky_spectrum(&self, _direction: DVec3) -> Vec<f64> {
        Vec::new()
    }

    /// Spectral radiance of the sun's disc along a direction; its colour is [`Self::disc_xyz`].
    fn disc_spectrum(&self, _direction: DVec3) -> Vec<f64> {
        Vec::new()
    }

    /// Light along a direction over at most `limit_m` metres (`None`: to the ground or to space), by parts, at
    /// [`Self::wavelengths_nm`]; `None` for models that do not separate path radiance, ground and orders of scattering.
    fn line(&self, _direction: DVec3, _limit_m: Option<f64>) -> Option<LineOfSight> {
        None
    }
}
