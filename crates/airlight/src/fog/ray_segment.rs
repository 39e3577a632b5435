//! A stretch of a straight line, as fog sees it: only its height counts.

/// A straight line from a point, over flat or round ground.
///
/// Over round ground the height after `s` metres is `height + sin_elevation s + (1 - sin_elevation^2) s^2 / (2 R)`: the sphere to second
/// order, wrong by less than `s^3 sin_elevation / (2 R^2)` (8 m after 100 km at an elevation of 1 degree).
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct RaySegment {
    /// Height of its start, m.
    pub height_m: f64,
    /// Sine of its elevation at the start: metres of height gained in a metre at first.
    pub sin_elevation: f64,
    /// Half the curvature under the line, 1/m: `(1 - sin_elevation^2) / (2 R)`, 0 over flat ground.
    pub curvature_per_m: f64,
    /// Its length, m; may be infinite.
    pub length_m: f64,
}

impl RaySegment {
    /// A line over ground of radius `ground_radius_m` (infinite: flat).
    #[inline]
    pub fn new(height_m: f64, sin_elevation: f64, length_m: f64, ground_radius_m: f64) -> Self {
        Self {
            height_m,
            sin_elevation,
            curvature_per_m: 0.5 * (1.0 - sin_elevation * sin_elevation).max(0.0) / ground_radius_m,
            length_m,
        }
    }

    /// A line over flat ground.
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

    /// The sine of the elevation after `s` metres (for lines short against the ground's radius).
    #[inline]
    pub fn sin_elevation_at(&self, s: f64) -> f64 {
        self.sin_elevation + 2.0 * s * self.curvature_per_m
    }

    /// Height of the far end; infinite or minus infinity for a line without end.
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

    /// The part from `from_m` to `to_m`, as a line of its own.
    #[inline]
    pub fn part(&self, from_m: f64, to_m: f64) -> Self {
        Self {
            height_m: self.height_at(from_m),
            sin_elevation: self.sin_elevation_at(from_m),
            curvature_per_m: self.curvature_per_m,
            length_m: to_m - from_m,
        }
    }

    /// The distance of its lowest point, where that lies between its ends.
    #[inline]
    pub fn dip_m(&self) -> Option<f64> {
        let dip = -0.5 * self.sin_elevation / self.curvature_per_m;
        (dip > 0.0 && dip < self.length_m).then_some(dip)
    }

    /// The lowest height it reaches, m; minus infinity where it goes down without end.
    #[inline]
    pub fn lowest_height_m(&self) -> f64 {
        match self.dip_m() {
            Some(dip) => self.height_at(dip),
            None => self.height_m.min(self.end_height_m()),
        }
    }

    /// Where the line is below `height_m`: the distances of entry and exit, which are equal where it never is. (It is
    /// one stretch, as height along a line is convex.)
    #[inline]
    pub fn below(&self, height_m: f64) -> (f64, f64) {
        let nowhere = (0.0, 0.0);
        let above = self.height_m - height_m;
        let (first, last) = if self.curvature_per_m > 0.0 {
            // Roots of bend s^2 + climb s + above, without cancellation.
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
    fn a_line_over_round_ground_dips_and_rises() {
        let radius = 6.371e6;
        let line = RaySegment::new(10.0, -1e-3, 50e3, radius);
        let (first, last) = line.below(9.0);
        assert!(first > 0.0 && last > first && last < 50e3);
        for s in [first, last] {
            assert!(
                (line.height_at(s) - 9.0).abs() < 1e-9,
                "{}",
                line.height_at(s)
            );
        }
        assert_eq!(line.below(5.0), (0.0, 0.0));
        assert_eq!(line.below(100.0).0, 0.0);
        // Against the sphere itself.
        let exact = |s: f64| {
            let up = radius + 10.0;
            (up * up + 2.0 * up * -1e-3 * s + s * s).sqrt() - radius
        };
        for s in [100.0, 1e4, 5e4] {
            assert!(
                (line.height_at(s) - exact(s)).abs() < 1e-3 + s.powi(3) * 1e-3 / radius / radius
            );
        }
    }

    #[test]
    fn flat_lines_cross_a_height_once_or_never() {
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
    fn a_part_of_a_line_and_its_lowest_point_lie_on_it() {
        let line = RaySegment::new(10.0, -1e-3, 50e3, 6.371e6);
        assert!((line.dip_m().unwrap() / 6371.0 - 1.0).abs() < 1e-5);
        assert!((line.lowest_height_m() - line.height_at(6371.0)).abs() < 1e-6);
        assert_eq!(RaySegment::flat(5.0, -0.1, 20.0).lowest_height_m(), 3.0);
        let part = line.part(1e3, 2e4);
        assert!((part.height_at(500.0) - line.height_at(1.5e3)).abs() < 1e-9);
    }
}
