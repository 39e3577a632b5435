//! Geometry of view rays past lights.

use glam::DVec3;

/// A view ray.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct ViewRay {
    /// Start, m; y is the height.
    pub eye: DVec3,
    /// Unit vector away from the eye.
    pub direction: DVec3,
    /// Length, m, not negative; may be infinite.
    pub length_m: f64,
}

/// A segment of a straight ray past a light.
///
/// With `u` the distance along the ray from the point closest to the light, the distance to the light is `r = sqrt(h^2 + u^2)`.
/// Integrals use the **excess** `e = t + r - r_0`: the length of the path from the eye to the point at `t` and on to the light,
/// minus that for `t = 0`. With `a = r_0 + u_0` and `w = (e + a) / h = (r + u) / h = tan(Theta / 2)`, where `Theta` is the
/// scattering angle (0: forward),
///
/// `dt / r^2 = 2 de / (h^2 + (e + a)^2)`, `cos(Theta) = -u / r = (1 - w^2) / (1 + w^2)`.
///
/// This is the equi-angular substitution `u = h tan(theta)`, `Theta = theta + pi/2`, without tangents. The length of the path
/// through the fog is `r_0 + e`.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct LightRayGeometry {
    /// Distance of the light from the infinite line of the ray, m, above 0.
    pub nearest_m: f64,
    /// Distance of the start from the point closest to the light, along the ray, m; negative if the light lies ahead.
    pub start_m: f64,
    /// Length of the segment, m, not negative; may be infinite.
    pub length_m: f64,
}

impl LightRayGeometry {
    /// A segment from `eye` along the unit vector `direction` past a light at `light`. The distance of the light from the ray is at
    /// least `at_least_m` (above 0).
    #[inline]
    pub fn new(eye: DVec3, direction: DVec3, length_m: f64, light: DVec3, at_least_m: f64) -> Self {
        let to_light = light - eye;
        Self {
            nearest_m: to_light.cross(direction).length().max(at_least_m),
            start_m: -to_light.dot(direction),
            length_m,
        }
    }

    /// The part from `from_m` to `to_m`, in metres from the start.
    #[inline]
    pub fn part(&self, from_m: f64, to_m: f64) -> Self {
        Self {
            start_m: self.start_m + from_m,
            length_m: to_m - from_m,
            ..*self
        }
    }

    /// The segment in the opposite direction. It must be finite.
    #[inline]
    pub(crate) fn reversed(&self) -> Self {
        Self {
            start_m: -(self.start_m + self.length_m),
            ..*self
        }
    }

    /// Distance to the light at `t_m` from the start, m.
    #[inline]
    pub fn distance_m(&self, t_m: f64) -> f64 {
        self.distance_at(self.start_m + t_m)
    }

    /// `r` at `u` from the point closest to the light.
    #[inline]
    fn distance_at(&self, u: f64) -> f64 {
        (self.nearest_m * self.nearest_m + u * u).sqrt()
    }

    /// `r + u`, without cancellation.
    #[inline]
    fn ahead(&self, u: f64) -> f64 {
        let r = self.distance_at(u);
        if u < 0.0 {
            self.nearest_m * (self.nearest_m / (r - u))
        } else {
            r + u
        }
    }

    /// `a = r_0 + u_0`, m: twice the distance to the light times the squared sine of half the scattering angle.
    #[inline]
    pub(super) fn ahead_at_start(&self) -> f64 {
        self.ahead(self.start_m)
    }

    /// The excess at the end, m: `L (a_0 + a_1) / (r_0 + r_1)`; infinite for an infinite ray.
    #[inline]
    pub(super) fn excess_m(&self) -> f64 {
        if self.length_m.is_infinite() {
            return f64::INFINITY;
        }
        let end = self.start_m + self.length_m;
        self.length_m * (self.ahead(self.start_m) + self.ahead(end))
            / (self.distance_m(0.0) + self.distance_at(end))
    }

    /// Distance along the ray at which an excess is reached, m: `e (e + 2 r_0) / (2 (e + a))`.
    #[inline]
    pub(super) fn place_m(&self, excess_m: f64) -> f64 {
        0.5 * excess_m * (excess_m + 2.0 * self.distance_m(0.0))
            / (excess_m + self.ahead_at_start())
    }

    /// Angle that the segment subtends at the light, radians, 0 to pi: `atan2(h L, h^2 + u_0 u_1)`.
    #[inline]
    pub fn angle(&self) -> f64 {
        let (h, u) = (self.nearest_m, self.start_m);
        if self.length_m.is_infinite() {
            return h.atan2(u);
        }
        (h * self.length_m).atan2(h * h + u * (u + self.length_m))
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn distances_are_recovered_from_the_excess() {
        for h in [1e-6, 1.0, 1e7] {
            for start in [-1e7, -3.0, -1e-6, 0.0, 2.0, 1e7] {
                for length in [1e-6, 1.0, 1e7] {
                    let geometry = LightRayGeometry {
                        nearest_m: h,
                        start_m: start,
                        length_m: length,
                    };
                    let back = geometry.place_m(geometry.excess_m());
                    // Ill-conditioned before a light that is almost on the ray.
                    let loose = 1e-14 + 1e-16 * (geometry.distance_m(length) / h).powi(2).min(1e18);
                    assert!(
                        (back / length - 1.0).abs() < loose,
                        "h {h}, start {start}, length {length}: {back}"
                    );
                }
            }
        }
    }

    #[test]
    fn angles_are_exact_before_at_and_behind_the_light() {
        let angle = |start_m, length_m| {
            LightRayGeometry {
                nearest_m: 1.0,
                start_m,
                length_m,
            }
            .angle()
        };
        assert!((angle(-5.0, 20.0) - (15f64.atan() + 5f64.atan())).abs() < 1e-15);
        assert!((angle(-1.0, f64::INFINITY) - 0.75 * std::f64::consts::PI).abs() < 1e-15);
        assert!((angle(1e9, f64::INFINITY) * 1e9 - 1.0).abs() < 1e-12);
        assert_eq!(angle(3.0, 0.0), 0.0);
    }
}
