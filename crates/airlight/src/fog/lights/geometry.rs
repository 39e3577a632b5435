//! A line of sight as a lamp sees it, and the variable in which the lamp's light along it is smooth.

use glam::DVec3;

/// A stretch of a straight line that passes a lamp.
///
/// With `u` the distance along the line from the point closest to the lamp, the lamp is `r = sqrt(h^2 + u^2)` away.
/// Everything is expressed by the **excess** `e = t + r - r_0`: how much longer the way eye, point, lamp is for the point
/// `t` metres on than for the start. With `a = r_0 + u_0` and `w = (e + a) / h = (r + u) / h = tan(Theta / 2)`, where
/// `Theta` is the scattering angle (0: the light goes straight on),
///
/// `dt / r^2 = 2 de / (h^2 + (e + a)^2)`, `cos(Theta) = -u / r = (1 - w^2) / (1 + w^2)`.
///
/// That is the equi-angular substitution `u = h tan(theta)`, `Theta = theta + pi/2`, without its tangents, and the way
/// that light has been dimmed on in uniform fog is `r_0 + e`.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct LightRayGeometry {
    /// Distance of the lamp from the (endless) line, m, above 0.
    pub nearest_m: f64,
    /// Where the stretch starts: metres beyond the point closest to the lamp; below 0 while the lamp lies ahead.
    pub start_m: f64,
    /// Length of the stretch, m, not below 0; may be infinite.
    pub length_m: f64,
}

impl LightRayGeometry {
    /// The stretch of `length_m` from `eye` in the unit vector `direction` that passes `light`, whose distance from the line
    /// is not taken below `at_least_m` (above 0): the line is moved out to it, and nothing else changes.
    #[inline]
    pub fn new(eye: DVec3, direction: DVec3, length_m: f64, light: DVec3, at_least_m: f64) -> Self {
        let to_light = light - eye;
        Self {
            nearest_m: to_light.cross(direction).length().max(at_least_m),
            start_m: -to_light.dot(direction),
            length_m,
        }
    }

    /// The part from `from_m` to `to_m`, counted from the start.
    #[inline]
    pub fn part(&self, from_m: f64, to_m: f64) -> Self {
        Self {
            start_m: self.start_m + from_m,
            length_m: to_m - from_m,
            ..*self
        }
    }

    /// The same stretch, which must have an end, walked from there.
    #[inline]
    pub fn reversed(&self) -> Self {
        Self {
            start_m: -(self.start_m + self.length_m),
            ..*self
        }
    }

    /// Distance from the lamp `t_m` on, m.
    #[inline]
    pub fn distance_m(&self, t_m: f64) -> f64 {
        self.distance_at(self.start_m + t_m)
    }

    /// `r` where the point closest to the lamp is `u` back.
    #[inline]
    fn distance_at(&self, u: f64) -> f64 {
        (self.nearest_m * self.nearest_m + u * u).sqrt()
    }

    /// `r + u` at a place: without cancellation on either side of the lamp.
    #[inline]
    fn ahead(&self, u: f64) -> f64 {
        let r = self.distance_at(u);
        if u < 0.0 {
            self.nearest_m * (self.nearest_m / (r - u))
        } else {
            r + u
        }
    }

    /// `a = r_0 + u_0`, m: twice the distance to the lamp times the squared sine of half the scattering angle.
    #[inline]
    pub(super) fn ahead_at_start(&self) -> f64 {
        self.ahead(self.start_m)
    }

    /// The excess at the end, m: `L (a_0 + a_1) / (r_0 + r_1)`; infinite for an endless line.
    #[inline]
    pub(super) fn excess_m(&self) -> f64 {
        if self.length_m.is_infinite() {
            return f64::INFINITY;
        }
        let end = self.start_m + self.length_m;
        self.length_m * (self.ahead(self.start_m) + self.ahead(end))
            / (self.distance_m(0.0) + self.distance_at(end))
    }

    /// How far along the line an excess is reached, m: `e (e + 2 r_0) / (2 (e + a))`.
    #[inline]
    pub(super) fn place_m(&self, excess_m: f64) -> f64 {
        0.5 * excess_m * (excess_m + 2.0 * self.distance_m(0.0))
            / (excess_m + self.ahead_at_start())
    }

    /// The angle under which the lamp sees the stretch, radians, 0 to pi: `atan2(h L, h^2 + u_0 u_1)`.
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
    fn the_excess_leads_back_to_the_place() {
        for h in [1e-6, 1.0, 1e7] {
            for start in [-1e7, -3.0, -1e-6, 0.0, 2.0, 1e7] {
                for length in [1e-6, 1.0, 1e7] {
                    let geometry = LightRayGeometry {
                        nearest_m: h,
                        start_m: start,
                        length_m: length,
                    };
                    let back = geometry.place_m(geometry.excess_m());
                    // Where the lamp is almost on the line the excess says little of the place before it.
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
    fn the_angle_is_right_before_at_and_behind_the_lamp() {
        let seen = |start_m, length_m| {
            LightRayGeometry {
                nearest_m: 1.0,
                start_m,
                length_m,
            }
            .angle()
        };
        assert!((seen(-5.0, 20.0) - (15f64.atan() + 5f64.atan())).abs() < 1e-15);
        assert!((seen(-1.0, f64::INFINITY) - 0.75 * std::f64::consts::PI).abs() < 1e-15);
        assert!((seen(1e9, f64::INFINITY) * 1e9 - 1.0).abs() < 1e-12);
        assert_eq!(seen(3.0, 0.0), 0.0);
    }
}
