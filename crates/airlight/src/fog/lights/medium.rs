//! What surrounds lamps and eye, and where one looks.

use crate::atmosphere::DensityProfile;
use crate::fog::layer::{Layer, Medium};
use glam::DVec3;

/// The fog around lamps: it borrows what the caller has.
#[derive(Clone, Copy, Debug)]
pub struct ParticipatingMedium<'a, const N: usize> {
    /// What hangs in the air; checked by [`Medium::validate`].
    pub medium: &'a Medium<N>,
    /// How it thins with height; checked by [`DensityProfile::validate`].
    pub profile: &'a DensityProfile,
    /// Other layers in the same air: they dim the light, too. What they scatter is that of murks of their own, with this
    /// fog among the others: [`super::LightSet::path_radiance`] of all of them adds up.
    pub others: &'a [Layer<N>],
    /// Wavelength of each lane, nm; only phase functions that depend on it look at it.
    pub wavelengths_nm: &'a [f64; N],
    /// Radius of the ground, m; infinite over flat ground. The ground touches height 0 under the eye (or under the point
    /// that is lit) and falls away as `d^2 / (2 R)`: what is `d` away from there stands so much higher above it.
    pub ground_radius_m: f64,
}

/// A line of sight.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct ViewRay {
    /// Where it starts, m; y is the height.
    pub eye: DVec3,
    /// Unit vector away from the eye.
    pub direction: DVec3,
    /// Its length, m, not below 0; may be infinite.
    pub length_m: f64,
}
