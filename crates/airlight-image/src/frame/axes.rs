//! Axes of a camera.

use airlight::axes;
use glam::DVec3;

/// Axes of a camera: orthogonal unit vectors.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(super) struct CameraAxes {
    pub(super) right: DVec3,
    pub(super) up: DVec3,
    pub(super) forward: DVec3,
}

impl CameraAxes {
    pub(super) fn new(azimuth_deg: f64, elevation_deg: f64, roll_deg: f64) -> Self {
        let forward = axes::direction(azimuth_deg, elevation_deg);
        let level = axes::direction(azimuth_deg + 90.0, 0.0);
        let upright = level.cross(forward);
        let (sin, cos) = roll_deg.to_radians().sin_cos();
        Self {
            right: level * cos - upright * sin,
            up: upright * cos + level * sin,
            forward,
        }
    }

    /// Right, up and forward.
    pub(super) fn to_array(self) -> [DVec3; 3] {
        [self.right, self.up, self.forward]
    }

    /// Components of a direction to the right, up and forward.
    pub(super) fn split(&self, direction: DVec3) -> (f64, f64, f64) {
        (
            direction.dot(self.right),
            direction.dot(self.up),
            direction.dot(self.forward),
        )
    }
}
