//! [`RaySegment`]: a straight ray over flat or round ground.

/// A segment of a straight ray over flat or round ground, described by its height.
///
/// Over round ground the height after `s` metres is `height + sin_elevation s + (1 - sin_elevation^2) s^2 / (2 R)`: the
/// sphere to second order, with an error below `s^3 sin_elevation / (2 R^2)` (8 m after 100 km at an elevation of 1 degree).
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct RaySegment {
    /// Height of the start, m.
    pub height_m: f64,
    /// Sine of the elevation at the start: the slope of the height there.
    pub sin_elevation: f64,
    /// Half the second derivative of the height, 1/m: `(1 - sin_elevation^2) / (2 R)`, 0 over flat ground.
    pub curvature_per_m: f64,
    /// Length, m; may be infinite.
    pub length_m: f64,
}

impl RaySegment {
    /// A segment over ground of radius `ground_radius_m` (infinite: flat).
    #[inline]
    pub fn new(height_m: f64, sin_elevation: f64, length_m: f64, ground_radius_m: f64) -> Self {
        Self {
            height_m,
            sin_elevation,
            curvature_per_m: 0.5 * (1.0 - sin_elevation * sin_elevation).max(0.0) / ground_radius_m,
            length_m,
        }
    }

    /// A segment over flat ground.
    #[inline]
    pub fn flat(height_m: f64, sin_elevation: f64, length_m: f64) -> Self {
        Self {
            height_m,
            sin_elevation,
            curvature_per_m: 0.0,
            length_m,
        }
    }

    /// Height above the ground after `s` metres.
    #[inline]
    pub fn height_at(&self, s: f64) -> f64 {
        self.height_m + s * (self.sin_elevation + s * self.curvature_per_m)
    }

    /// Sine of the elevation after `s` metres, for segments much shorter than the ground's radius.
    #[inline]
    pub(crate) fn sin_elevation_at(&self, s: f64) -> f64 {
        self.sin_elevation + 2.0 * s * self.curvature_per_m
    }

    /// Height of the far end, m; plus or minus infinity for an infinite segment that is not level.
    #[inline]
    pub fn end_height_m(&self) -> f64 {
        if self.length_m.is_finite() {
            self.height_at(self.length_m)
        } else if self.curvature_per_m > 0.0 {
            f64::INFINITY
        } else if self.sin_elevation == 0.0 {
            self.height_m
        } else {
            f64::INFINITY.copysign(self.sin_elevation)
        }
    }

    /// The part from `from_m` to `to_m`, as a segment that starts there.
    #[inline]
    pub fn part(&self, from_m: f64, to_m: f64) -> Self {
        Self {
            height_m: self.height_at(from_m),
            sin_elevation: self.sin_elevation_at(from_m),
            curvature_per_m: self.curvature_per_m,
            length_m: to_m - from_m,
        }
    }

    /// Distance to the lowest point, m, if it lies between the ends.
    #[inline]
    pub(crate) fn dip_m(&self) -> Option<f64> {
        let dip = -0.5 * self.sin_elevation / self.curvature_per_m;
        (dip > 0.0 && dip < self.length_m).then_some(dip)
    }

    /// Lowest height, m; minus infinity for an infinite segment that descends over flat ground.
    #[inline]
    pub(crate) fn lowest_height_m(&self) -> f64 {
        match self.dip_m() {
            Some(dip) => self.height_at(dip),
            None => self.height_m.min(self.end_height_m()),
        }
    }

    /// Interval of distances in which the segment is below `height_m`; empty (equal ends) if it never is. There is only one interval,
    /// as the height along a ray is convex.
    #[inline]
    pub fn below(&self, height_m: f64) -> (f64, f64) {
        let nowhere = (0.0, 0.0);
        let above = self.height_m - height_m;
        let (first, last) = if self.curvature_per_m > 0.0 {
            // Roots of curvature s^2 + sin_elevation s + above, without cancellation.
            let discriminant =
                self.sin_elevation * self.sin_elevation - 4.0 * self.curvature_per_m * above;
            if discriminant <= 0.0 {
                return nowhere;
            }
            let q = -0.5 * (self.sin_elevation + discriminant.sqrt().copysign(self.sin_elevation));
            let (a, b) = (q / self.curvature_per_m, above / q);
            (a.min(b), a.max(b))
        } else if self.sin_elevation == 0.0 {
            if above >= 0.0 {
                return nowhere;
            }
            (0.0, f64::INFINITY)
        } else if self.sin_elevation > 0.0 {
            (f64::NEG_INFINITY, -above / self.sin_elevation)
        } else {
            (-above / self.sin_elevation, f64::INFINITY)
        };
        let (first, last) = (first.max(0.0), last.min(self.length_m));
        if last > first { (first, last) } else { nowhere }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn rays_over_round_ground_dip_and_rise() {
        let radius = 6.371e6;
        let ray = RaySegment::new(10.0, -1e-3, 50e3, radius);
        let (first, last) = ray.below(9.0);
        assert!(first > 0.0 && last > first && last < 50e3);
        for s in [first, last] {
            assert!(
                (ray.height_at(s) - 9.0).abs() < 1e-9,
                "{}",
                ray.height_at(s)
            );
        }
        assert_eq!(ray.below(5.0), (0.0, 0.0));
        assert_eq!(ray.below(100.0).0, 0.0);
        // Against the sphere itself.
        let exact = |s: f64| {
            let up = radius + 10.0;
            (up * up + 2.0 * up * -1e-3 * s + s * s).sqrt() - radius
        };
        for s in [100.0, 1e4, 5e4] {
            assert!(
                (ray.height_at(s) - exact(s)).abs() < 1e-3 + s.powi(3) * 1e-3 / radius / radius
            );
        }
    }

    #[test]
    fn rays_over_flat_ground_cross_a_height_once_or_never() {
        assert_eq!(RaySegment::flat(5.0, 0.5, 100.0).below(10.0), (0.0, 10.0));
        assert_eq!(
            RaySegment::flat(15.0, -0.5, 100.0).below(10.0),
            (10.0, 100.0)
        );
        assert_eq!(RaySegment::flat(15.0, 0.0, 100.0).below(10.0), (0.0, 0.0));
        assert_eq!(RaySegment::flat(5.0, 0.0, 100.0).below(10.0), (0.0, 100.0));
        assert_eq!(RaySegment::flat(15.0, 0.5, 100.0).below(10.0), (0.0, 0.0));
    }

    #[test]
    fn parts_and_lowest_points_lie_on_the_segment() {
        let ray = RaySegment::new(10.0, -1e-3, 50e3, 6.371e6);
        assert!((ray.dip_m().unwrap() / 6371.0 - 1.0).abs() < 1e-5);
        assert!((ray.lowest_height_m() - ray.height_at(6371.0)).abs() < 1e-6);
        assert_eq!(RaySegment::flat(5.0, -0.1, 20.0).lowest_height_m(), 3.0);
        let part = ray.part(1e3, 2e4);
        assert!((part.height_at(500.0) - ray.height_at(1.5e3)).abs() < 1e-9);
    }
}
