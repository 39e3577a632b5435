//! Published models of the sky, each as it was printed and as it is corrected, behind one interface.
//!
//! The paper or article behind a model is named in its module, with the numbers of its equations, its errata and what
//! it differs by from the solver of [`crate::sky`].

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

/// A published model of the sky, ready to answer for one eye and one sun.
///
/// Colours are CIE 1931 XYZ with `Y` in cd/m^2. Directions are unit vectors that point away from the eye
/// ([`crate::axes`]).
pub trait PublishedModel: Send + Sync {
    /// Unit vector towards the sun's centre.
    fn sun(&self) -> DVec3;

    /// Angle from the sun's centre beyond which there is no light of its disc, rad.
    fn disc_edge_rad(&self) -> f64 {
        crate::sun::SunDisc::default().angular_radius_rad
    }

    /// Whether what it says below the horizon is light of its own ground and the air before it. Models without leave the
    /// ground to whoever draws.
    fn has_ground(&self) -> bool {
        false
    }

    /// Light of the sky along a direction, without the sun's disc.
    fn sky_xyz(&self, direction: DVec3) -> [f64; 3];

    /// Light of the sun's disc along a direction, dimmed by the air in between; black beside the disc.
    fn disc_xyz(&self, direction: DVec3) -> [f64; 3];

    /// Light of the sky along one direction after another, for models that reuse what neighbours had: the same as
    /// [`Self::sky_xyz`] within the tolerance that such a model states.
    fn walk(&self) -> Box<dyn FnMut(DVec3) -> [f64; 3] + '_> {
        Box::new(|direction| self.sky_xyz(direction))
    }

    /// Wavelengths of the model's spectra, with the sun that lights them; none for models that know colours only.
    fn grid(&self) -> Option<&WavelengthGrid> {
        None
    }

    /// The same in nm; empty for models that know colours only.
    fn wavelengths_nm(&self) -> &[f64] {
        self.grid().map_or(&[], WavelengthGrid::wavelengths_nm)
    }

    /// Spectral radiance of the sky (W m^-2 sr^-1 nm^-1) along a direction, at [`Self::wavelengths_nm`]: that whose colour is
    /// [`Self::sky_xyz`].
    fn sky_spectrum(&self, _direction: DVec3) -> Vec<f64> {
        Vec::new()
    }

    /// The same of the sun's disc, [`Self::disc_xyz`].
    fn disc_spectrum(&self, _direction: DVec3) -> Vec<f64> {
        Vec::new()
    }

    /// The light along a direction over at most `limit_m` metres (to the ground or to space if `None`) in its parts, at
    /// [`Self::wavelengths_nm`]; `None` for models that do not say where on the line it is scattered, nor how often.
    fn line(&self, _direction: DVec3, _limit_m: Option<f64>) -> Option<LineOfSight> {
        None
    }
}
