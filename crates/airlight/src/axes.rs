//! Conversion between unit vectors in world axes and compass angles.

use glam::DVec3;

/// Unit vector in world axes (x east, y up, z south) of the direction at `azimuth_deg`, clockwise from north, and
/// `elevation_deg`, above the horizon.
pub fn direction(azimuth_deg: f64, elevation_deg: f64) -> DVec3 {
    from_sines(
        azimuth_deg.to_radians().sin_cos(),
        elevation_deg.to_radians().sin_cos(),
    )
}

/// The unit vector of [`direction`] from sine and cosine of the azimuth and of the elevation.
pub fn from_sines(
    (sin_azimuth, cos_azimuth): (f64, f64),
    (sin_elevation, cos_elevation): (f64, f64),
) -> DVec3 {
    DVec3::new(
        cos_elevation * sin_azimuth,
        sin_elevation,
        -cos_elevation * cos_azimuth,
    )
}

/// Azimuth in degrees, in `[0, 360)`, clockwise from north; 0 for a vertical direction.
pub fn azimuth_deg(direction: DVec3) -> f64 {
    direction
        .x
        .atan2(-direction.z)
        .to_degrees()
        .rem_euclid(360.0)
}

/// Elevation above the horizon in degrees, in `[-90, 90]`.
pub fn elevation_deg(direction: DVec3) -> f64 {
    elevation_rad(direction).to_degrees()
}

/// Elevation above the horizon in radians, accurate also next to the vertical.
pub fn elevation_rad(direction: DVec3) -> f64 {
    direction.y.atan2(direction.x.hypot(direction.z))
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn compass_points_map_to_world_axes() {
        assert!(direction(0.0, 0.0).distance(-DVec3::Z) < 1e-15);
        assert!(direction(90.0, 0.0).distance(DVec3::X) < 1e-15);
        assert!(direction(0.0, 90.0).distance(DVec3::Y) < 1e-15);
    }

    #[test]
    fn angles_round_trip() {
        for azimuth in [0.0, 33.0, 179.0, 180.0, 271.5, 359.0] {
            for elevation in [-89.0, -10.0, 0.0, 0.01, 45.0, 89.0] {
                let v = direction(azimuth, elevation);
                assert!((azimuth_deg(v) - azimuth).abs() < 1e-9);
                assert!((elevation_deg(v) - elevation).abs() < 1e-9);
            }
        }
    }
}
