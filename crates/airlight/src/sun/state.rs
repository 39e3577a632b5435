//! Direction and distance of the sun.

use super::disc::SunDisc;
use glam::DVec3;

/// Where the sun is, and how far away.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct SunState {
    /// Unit vector towards it (world axes: [`crate::axes`]).
    pub direction: DVec3,
    /// Distance relative to the planet's mean distance from the sun.
    pub distance_ratio: f64,
}

impl SunState {
    /// The sun in the direction of a vector, at the planet's mean distance.
    pub(crate) fn at_mean_distance(direction: DVec3) -> Self {
        Self {
            direction: direction.normalize(),
            distance_ratio: 1.0,
        }
    }

    /// The same sun at another distance, relative to the planet's mean distance.
    pub fn at_distance_ratio(self, distance_ratio: f64) -> Self {
        Self {
            distance_ratio,
            ..self
        }
    }

    /// Solar irradiance relative to that at the mean distance: it falls with the square of the distance.
    pub fn irradiance_factor(&self) -> f64 {
        1.0 / (self.distance_ratio * self.distance_ratio)
    }

    /// The disc at this distance of a sun whose disc at the mean distance is given: `sin(radius)` falls with the distance.
    pub fn disc(&self, at_mean_distance: &SunDisc) -> SunDisc {
        at_mean_distance.at_distance_ratio(self.distance_ratio)
    }
}

impl From<DVec3> for SunState {
    /// A sun in this direction at the mean distance.
    fn from(direction: DVec3) -> Self {
        Self::at_mean_distance(direction)
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_farther_sun_is_fainter_by_the_solid_angle_of_its_disc() {
        let mean = SunDisc::default();
        let near = SunState::at_mean_distance(DVec3::new(0.0, 2.0, 0.0));
        assert_eq!(near.direction, DVec3::Y);
        assert_eq!(near.irradiance_factor(), 1.0);
        assert!(
            (near.disc(&mean).angular_radius_rad / mean.angular_radius_rad - 1.0).abs() < 1e-15
        );
        assert_eq!(SunState::from(DVec3::Y), near);
        let far = near.at_distance_ratio(1.5);
        let disc = far.disc(&mean);
        assert_eq!(disc.limb_darkening, mean.limb_darkening);
        let dimmer = disc.solid_angle_sr() / mean.solid_angle_sr();
        assert!((far.irradiance_factor() / dimmer - 1.0).abs() < 1e-5);
        let mars = SunDisc::at_distance_au(1.5).unwrap();
        assert!((mars.angular_radius_rad / disc.angular_radius_rad - 1.0).abs() < 1e-12);
    }
}
