//! A lamp that is a glowing ball.

use super::check;
use crate::fog::layer::FogError;
use crate::spectrum::Spectrum;
use glam::DVec3;
use std::f64::consts::PI;

/// A ball that is equally bright from everywhere.
///
/// From `r` metres away it fills the solid angle `2 pi (1 - sqrt(1 - R^2 / r^2))`, so what fog receives of it (its scalar
/// irradiance) is that times its radiance: `I / r^2` with `I = pi R^2 L`, times `2 / (1 + sqrt(1 - R^2 / r^2))`, which is 2
/// at its surface. Its light is taken to come from its centre, over the way to the nearest point of its surface: right to
/// `(R / r)^2`, and rough within a radius of it.
///
/// A line of sight that meets the ball ends there. A ball throws no shadow of its own light, for from every point of the
/// fog outside it some of its surface is seen; that it stands in the way of *other* lamps' light is left out.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct SphereLight<const N: usize> {
    /// Where its centre is, m; y is the height.
    pub position: DVec3,
    /// Its radius, m.
    pub radius_m: f64,
    /// Its radiance, W m^-2 sr^-1 nm^-1 (or candela per square metre).
    pub radiance: Spectrum<N>,
}

impl<const N: usize> SphereLight<N> {
    /// A lamp whose numbers are checked.
    ///
    /// # Errors
    /// [`FogError`] unless the position is finite, the radius above 0 and the radiance finite and not below 0.
    pub fn new(position: DVec3, radius_m: f64, radiance: Spectrum<N>) -> Result<Self, FogError> {
        check::position(position)?;
        check::radius(radius_m)?;
        check::light("the radiance of a lamp", radiance)?;
        Ok(Self {
            position,
            radius_m,
            radiance,
        })
    }

    /// Radiant intensity from afar, W sr^-1 nm^-1: `pi R^2 L`.
    pub fn intensity(&self) -> Spectrum<N> {
        self.radiance * (PI * self.radius_m * self.radius_m) as f32
    }

    /// How far along the line from `eye` in the unit vector `direction` the ball is met, m; 0 from inside it.
    pub fn hit(&self, eye: DVec3, direction: DVec3) -> Option<f64> {
        let to_light = self.position - eye;
        let distance = to_light.length();
        if distance <= self.radius_m {
            return Some(0.0);
        }
        let ahead = to_light.dot(direction);
        let inside = self.radius_m.powi(2) - to_light.cross(direction).length_squared();
        (ahead > 0.0 && inside > 0.0).then(|| {
            (distance - self.radius_m) * (distance + self.radius_m) / (ahead + inside.sqrt())
        })
    }
}

/// Scalar irradiance of a ball relative to that of a point of the same intensity: `2 / (1 + sqrt(1 - R^2 / r^2))`.
#[inline]
pub(super) fn closeness(radius_m: f64, distance_m: f64) -> f64 {
    let sine = radius_m / distance_m;
    2.0 / (1.0 + (1.0 - sine * sine).max(0.0).sqrt())
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_ball_is_met_where_it_is() {
        let light = SphereLight::new(DVec3::new(0.0, 2.0, -10.0), 0.5, Spectrum([1.0; 3])).unwrap();
        let eye = DVec3::new(0.0, 2.0, 0.0);
        assert_eq!(light.hit(eye, DVec3::NEG_Z), Some(9.5));
        assert_eq!(light.hit(eye, DVec3::Z), None);
        assert_eq!(light.hit(eye, DVec3::Y), None);
        assert_eq!(light.hit(light.position, DVec3::Y), Some(0.0));
        // From far away its surface is still found to rounding of the distance.
        let far = DVec3::new(0.0, 2.0, 1e7);
        let hit = light.hit(far, DVec3::NEG_Z).unwrap();
        assert!((hit - (1e7 + 9.5)).abs() < 1e-8);
        let grazing = DVec3::new(0.05, 0.0, -1.0).normalize();
        assert!(light.hit(eye, grazing).is_some());
        let missing = DVec3::new(0.051, 0.0, -1.0).normalize();
        assert!(light.hit(eye, missing).is_none());
    }

    #[test]
    fn its_solid_angle_is_the_one_of_a_ball() {
        for (radius, distance) in [(0.5f64, 0.5f64), (0.5, 0.7), (0.5, 40.0)] {
            let solid = 2.0 * PI * (1.0 - (1.0 - (radius / distance).powi(2)).sqrt());
            let got = PI * radius * radius / (distance * distance) * closeness(radius, distance);
            assert!((got / solid - 1.0).abs() < 1e-12, "{got} against {solid}");
        }
        assert_eq!(closeness(1.0, 1e9), 1.0);
    }

    #[test]
    fn bad_numbers_are_refused() {
        let dark = Spectrum([1.0f32; 3]);
        assert!(SphereLight::new(DVec3::ZERO, 0.0, dark).is_err());
        assert!(SphereLight::new(DVec3::new(0.0, f64::NAN, 0.0), 1.0, dark).is_err());
        assert!(SphereLight::new(DVec3::ZERO, 1.0, Spectrum([1.0, -1.0, 1.0])).is_err());
    }
}
