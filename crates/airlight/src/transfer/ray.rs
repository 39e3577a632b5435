//! Rays in a spherically symmetric atmosphere: intersections with spheres and the planet's shadow.

use glam::DVec3;

/// Segment of a ray inside the atmosphere.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct AirSegment {
    /// Distance of its start from the origin, m.
    pub start_m: f64,
    /// Distance of its end from the origin, m.
    pub end_m: f64,
    /// True if it ends on the ground.
    pub meets_ground: bool,
}

/// A ray, reduced to the four numbers that determine radiative transfer along it in a spherically symmetric atmosphere lit by
/// a distant sun.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Ray {
    /// Distance of the origin from the planet's centre, m.
    pub radius_m: f64,
    /// Cosine of the angle between the ray and the local zenith.
    pub mu: f64,
    /// Cosine of the angle between the sun and the local zenith.
    pub mu_sun: f64,
    /// Cosine of the angle between the ray and the sun.
    pub nu: f64,
}

impl Ray {
    /// Ray from `position` (m, relative to the planet's centre) along the unit vector `direction`, with the sun in the direction
    /// of the unit vector `sun`.
    pub fn new(position: DVec3, direction: DVec3, sun: DVec3) -> Self {
        let radius_m = position.length();
        let zenith = position / radius_m;
        Self {
            radius_m,
            mu: zenith.dot(direction).clamp(-1.0, 1.0),
            mu_sun: zenith.dot(sun).clamp(-1.0, 1.0),
            nu: direction.dot(sun).clamp(-1.0, 1.0),
        }
    }

    /// Distance from the planet's centre at the distance `t`, m.
    #[inline(always)]
    pub fn radius_at(&self, t: f64) -> f64 {
        (self.radius_m * self.radius_m + t * (2.0 * self.radius_m * self.mu + t)).sqrt()
    }

    /// Change of altitude over the distance `t`, m: `radius_at(t) - radius_m` without cancellation.
    #[inline(always)]
    pub fn climb_at(&self, t: f64) -> f64 {
        t * (2.0 * self.radius_m * self.mu + t) / (self.radius_at(t) + self.radius_m)
    }

    /// This ray with its origin moved forward by `t` metres.
    #[inline(always)]
    pub fn advanced(&self, t: f64) -> Self {
        let radius_m = self.radius_at(t);
        Self {
            radius_m,
            mu: ((self.radius_m * self.mu + t) / radius_m).clamp(-1.0, 1.0),
            mu_sun: ((self.radius_m * self.mu_sun + t * self.nu) / radius_m).clamp(-1.0, 1.0),
            nu: self.nu,
        }
    }

    /// Distance to the point closest to the planet's centre, m (negative if behind the origin).
    #[inline(always)]
    pub fn closest_approach_m(&self) -> f64 {
        -self.radius_m * self.mu
    }

    /// Smallest distance of the line from the planet's centre, m.
    #[inline(always)]
    pub fn tangent_radius_m(&self) -> f64 {
        self.radius_m * ((1.0 - self.mu) * (1.0 + self.mu)).max(0.0).sqrt()
    }

    /// Distances, possibly negative, at which the line crosses the sphere of radius `radius_m` around the planet's centre; `None`
    /// if it misses the sphere.
    pub fn crossings(&self, radius_m: f64) -> Option<(f64, f64)> {
        let closest = self.closest_approach_m();
        let tangent = self.tangent_radius_m();
        if tangent > radius_m {
            return None;
        }
        let half_chord = ((radius_m - tangent) * (radius_m + tangent)).sqrt();
        // The product of the roots is r^2 - R^2: computing the smaller root from it avoids cancellation.
        let product = (self.radius_m - radius_m) * (self.radius_m + radius_m);
        let (near, far) = if closest >= 0.0 {
            let far = closest + half_chord;
            (if far > 0.0 { product / far } else { 0.0 }, far)
        } else {
            let near = closest - half_chord;
            (near, product / near)
        };
        Some((near, far))
    }

    /// Distance to the ground sphere; `None` if the ray misses it or starts below it.
    pub fn distance_to_ground(&self, ground_radius_m: f64) -> Option<f64> {
        if self.mu >= 0.0 {
            return None;
        }
        let (near, _) = self.crossings(ground_radius_m)?;
        Some(near.max(0.0))
    }

    /// Segment of the ray inside an atmosphere between the radii of the ground and of the top: from the origin or its entry, to
    /// `limit_m`, the ground or its exit. `None` if it misses the atmosphere.
    pub fn segment_in_air(
        &self,
        ground_radius_m: f64,
        top_radius_m: f64,
        limit_m: f64,
    ) -> Option<AirSegment> {
        let (enter, leave) = self.crossings(top_radius_m)?;
        let start_m = if self.radius_m > top_radius_m {
            enter
        } else {
            0.0
        };
        if start_m < 0.0 || leave <= start_m || limit_m <= start_m {
            return None;
        }
        Some(match self.distance_to_ground(ground_radius_m) {
            Some(ground) if ground <= limit_m => AirSegment {
                start_m,
                end_m: ground,
                meets_ground: true,
            },
            _ => AirSegment {
                start_m,
                end_m: leave.min(limit_m),
                meets_ground: false,
            },
        })
    }

    /// Distances at which the line enters and leaves the cylindrical shadow, on the side away from the sun, of a sphere of this radius
    /// around the planet's centre, if it does; in no particular order.
    pub fn shadow_edges(&self, sphere_radius_m: f64) -> [Option<f64>; 2] {
        // |x|^2 - (x.s)^2 = R^2 along x(t): a t^2 + 2 b t + c = 0.
        let a = (1.0 - self.nu) * (1.0 + self.nu);
        let b = self.radius_m * (self.mu - self.mu_sun * self.nu);
        let sin2 = (1.0 - self.mu_sun) * (1.0 + self.mu_sun);
        let c = self.radius_m * self.radius_m * sin2 - sphere_radius_m * sphere_radius_m;
        let discriminant = b * b - a * c;
        if discriminant < 0.0 || a < 1e-14 {
            return [None, None];
        }
        let q = -(b + discriminant.sqrt().copysign(b));
        let behind_planet = |t: f64| {
            (t.is_finite() && self.radius_m * self.mu_sun + t * self.nu < 0.0).then_some(t)
        };
        [behind_planet(q / a), behind_planet(c / q)]
    }

    /// `sin(theta) cos(phi)` of the ray's direction in the local frame with the zenith up and the sun at azimuth 0; 0 if the sun
    /// is at the zenith.
    #[inline(always)]
    pub fn toward_sun(&self) -> f64 {
        let sin2 = (1.0 - self.mu) * (1.0 + self.mu);
        let sin2_sun = (1.0 - self.mu_sun) * (1.0 + self.mu_sun);
        if sin2_sun < 1e-12 {
            return 0.0;
        }
        let limit = sin2.max(0.0).sqrt();
        ((self.nu - self.mu * self.mu_sun) / sin2_sun.sqrt()).clamp(-limit, limit)
    }
}

/// True if the planet hides the sun from a point at `radius_m` with the sun cosine `mu_sun`.
#[inline(always)]
pub fn in_shadow(radius_m: f64, mu_sun: f64, ground_radius_m: f64) -> bool {
    mu_sun < 0.0
        && radius_m * radius_m * (1.0 - mu_sun * mu_sun) < ground_radius_m * ground_radius_m
}

#[cfg(test)]
mod tests {
    use super::*;

    const GROUND: f64 = 6_360_000.0;

    fn ray(radius_m: f64, mu: f64) -> Ray {
        Ray {
            radius_m,
            mu,
            mu_sun: 0.3,
            nu: 0.1,
        }
    }

    #[test]
    fn crossings_do_not_cancel_close_to_the_sphere() {
        let eye = ray(GROUND + 0.001, -1.0);
        assert!((eye.distance_to_ground(GROUND).unwrap() - 0.001).abs() < 1e-8);
        let up = ray(GROUND, 0.0);
        let (near, far) = up.crossings(GROUND).unwrap();
        assert!(near.abs() < 1e-6 && far.abs() < 1e-6);
        assert_eq!(up.distance_to_ground(GROUND), None);
    }

    #[test]
    fn crossings_lie_on_the_sphere() {
        for mu in [-1.0, -0.5, -0.14, 0.0, 0.2, 1.0] {
            let ray = ray(GROUND + 30_000.0, mu);
            let (near, far) = ray.crossings(GROUND + 60_000.0).unwrap();
            assert!(near < 0.0 && far > 0.0);
            for t in [near, far] {
                assert!((ray.radius_at(t) - GROUND - 60_000.0).abs() < 1e-6);
            }
        }
    }

    #[test]
    fn shadow_edges_lie_on_the_cylinder_behind_the_planet() {
        let sun = DVec3::new(0.995, -0.0998, 0.0).normalize();
        let position = DVec3::Y * (GROUND + 1.0);
        for direction in [
            DVec3::new(-0.9, 0.3, 0.2),
            DVec3::new(0.9, 0.3, -0.2),
            DVec3::Y,
        ] {
            let ray = Ray::new(position, direction.normalize(), sun);
            let edges = ray.shadow_edges(GROUND);
            assert!(edges.iter().any(Option::is_some));
            for t in edges.into_iter().flatten() {
                let x = position + t * direction.normalize();
                let along = x.dot(sun);
                assert!(along < 0.0);
                assert!(((x.length_squared() - along * along).sqrt() - GROUND).abs() < 1e-3);
            }
        }
    }

    #[test]
    fn altitude_change_is_exact_for_short_steps() {
        let ray = ray(GROUND, 1e-9);
        assert!((ray.climb_at(1.0) - (1e-9 + 0.5 / GROUND)).abs() < 1e-15);
    }
}
