//! What it takes to light things, and to show them through the air.

use super::foggy::FoggySky;
use crate::spectrum::Spectrum;
use crate::transfer::PathOptics;
use glam::DVec3;

/// One lighting of things near the eye: their light and what lies before them, in N lanes.
///
/// Heights are in metres above the ground, directions are unit vectors ([`crate::axes`]), irradiances are in the unit of radiance
/// times sr. Sky, air, fog and things that take it all from one such source fit together.
pub trait SceneLighting<const N: usize>: Sync {
    /// Unit vector towards the sun.
    fn sun(&self) -> DVec3;

    /// Irradiance of the sun's disc at a height, on a surface that faces it.
    fn sunlight(&self, height_m: f64) -> Spectrum<N>;

    /// What lies between the eye and a point `distance_m` away.
    fn before(&self, direction: DVec3, distance_m: f64) -> PathOptics<N>;

    /// Radiance that arrives at the eye from sky, air and fog, and from the ground where no thing is; without the sun's disc.
    fn around(&self, direction: DVec3) -> Spectrum<N>;
}

impl<const N: usize> SceneLighting<N> for FoggySky<N> {
    fn sun(&self) -> DVec3 {
        self.sun_direction()
    }

    fn sunlight(&self, height_m: f64) -> Spectrum<N> {
        FoggySky::sunlight(self, height_m)
    }

    fn before(&self, direction: DVec3, distance_m: f64) -> PathOptics<N> {
        self.optics(direction, distance_m)
    }

    fn around(&self, direction: DVec3) -> Spectrum<N> {
        self.sky(direction)
    }
}
