//! Where a line of sight, or of light, meets the ground.

use glam::DVec3;

/// Radius of the Earth, m.
const PLANET_RADIUS: f64 = 6.36e6;

/// Something with a height above sea level everywhere, over a map whose ground falls away from the eye as the planet's
/// does: by the square of the distance over twice the radius.
pub trait Relief {
    /// The bare terrain, metres above sea level, at metres east and south of the eye.
    fn bare(&self, x: f64, z: f64) -> f64;
    /// Height of the surface above the bare terrain, metres; `footprint` metres are looked at together. Costs more.
    fn cover(&self, x: f64, z: f64, footprint: f64) -> f64;
    /// What the cover exceeds nowhere, metres.
    fn tallest(&self) -> f64;
    /// Nothing stands higher, metres above sea level.
    fn highest(&self) -> f64;
}

/// A ray, whose origin is measured from sea level below the eye.
#[derive(Clone, Copy, Debug)]
pub struct Ray {
    pub origin: DVec3,
    /// Unit vector.
    pub direction: DVec3,
    /// Metres of ground in a pixel: at the origin, and more for each metre on.
    pub footprint: [f64; 2],
}

impl Ray {
    /// A point of the ray.
    pub fn at(&self, t: f64) -> DVec3 {
        self.origin + self.direction * t
    }

    /// Metres seen as one, `t` metres on.
    pub fn footprint_at(&self, t: f64) -> f64 {
        self.footprint[0] + self.footprint[1] * t
    }
}

/// Height above sea level of a point, metres.
pub fn altitude(point: DVec3) -> f64 {
    point.y + (point.x * point.x + point.z * point.z) / (2.0 * PLANET_RADIUS)
}

/// The distance along the ray, from `start` to `limit` metres, at which it first meets the ground.
pub fn first_hit(relief: &impl Relief, ray: &Ray, start: f64, limit: f64) -> Option<f64> {
    /// No terrain is steeper, metres a metre.
    const STEEPEST: f64 = 1.0;
    let (mut before, mut t) = (start, start);
    while t < limit {
        let point = ray.at(t);
        let height = altitude(point);
        let rise = ray.direction.y
            + (point.x * ray.direction.x + point.z * ray.direction.z) / PLANET_RADIUS;
        if height > relief.highest() && rise >= 0.0 {
            return None;
        }
        let least = (0.35 * ray.footprint_at(t)).max(0.1);
        let above = height - relief.bare(point.x, point.z);
        let clear = above - relief.tallest();
        let free = if clear > 0.0 {
            clear / (STEEPEST - rise).max(0.05)
        } else {
            let gap = above - relief.cover(point.x, point.z, ray.footprint_at(t));
            if gap <= 0.0 {
                return Some(refine(relief, ray, [before, t], gap));
            }
            0.3 * gap
        };
        before = t;
        t += free.max(least);
    }
    None
}

/// Where a ray meets the surface between a point above it and one below, with the gap at the latter, to a thousandth of the
/// footprint, by false position (Illinois algorithm).
fn refine(
    relief: &impl Relief,
    ray: &Ray,
    [mut above, mut below]: [f64; 2],
    mut gap_below: f64,
) -> f64 {
    let gap = |t: f64| {
        let point = ray.at(t);
        let bare = relief.bare(point.x, point.z);
        altitude(point) - bare - relief.cover(point.x, point.z, ray.footprint_at(t))
    };
    let precise = 1e-3 * ray.footprint_at(below) + 1e-4;
    let mut gap_above = gap(above);
    if gap_above <= 0.0 {
        return above;
    }
    let mut last = 0;
    while below - above > precise {
        let t = (above * gap_below - below * gap_above) / (gap_below - gap_above);
        let here = gap(t);
        if here.abs() < 0.1 * precise || t <= above || t >= below {
            return t;
        }
        if here > 0.0 {
            (above, gap_above) = (t, here);
            if last == 1 {
                gap_below *= 0.5;
            }
            last = 1;
        } else {
            (below, gap_below) = (t, here);
            if last == -1 {
                gap_above *= 0.5;
            }
            last = -1;
        }
    }
    0.5 * (above + below)
}

#[cfg(test)]
mod tests {
    use super::*;

    /// A plane that rises eastward, with ripples.
    struct Slope {
        rise: f64,
        ripple: f64,
    }

    impl Relief for Slope {
        fn bare(&self, x: f64, _: f64) -> f64 {
            100.0 + self.rise * x
        }
        fn cover(&self, x: f64, _: f64, _: f64) -> f64 {
            self.ripple * (1.0 + (x / 20.0).sin())
        }
        fn tallest(&self) -> f64 {
            2.0 * self.ripple
        }
        fn highest(&self) -> f64 {
            1e6
        }
    }

    fn ray(direction: DVec3) -> Ray {
        Ray {
            origin: DVec3::new(0.0, 400.0, 0.0),
            direction: direction.normalize(),
            footprint: [0.0, 1e-3],
        }
    }

    #[test]
    fn a_plane_is_met_where_geometry_says() {
        for (rise, down) in [(0.0, -0.02), (0.0, -0.5), (0.3, -0.01), (-0.2, -0.3)] {
            let ray = ray(DVec3::new(1.0, down, 0.0));
            let plane = Slope { rise, ripple: 0.0 };
            // Height over the plane: 300 + (down - rise) x + x^2 / 2R, at the nearer root.
            let (a, b, c) = (0.5 / PLANET_RADIUS, down - rise, 300.0);
            let x = 2.0 * c / (-b + (b * b - 4.0 * a * c).sqrt());
            let t = first_hit(&plane, &ray, 0.0, 1e5).unwrap();
            assert!((t * ray.direction.x - x).abs() < 1e-3, "{rise} {down}");
        }
    }

    #[test]
    fn every_hit_lies_on_the_surface_and_nothing_before_it() {
        let rippled = Slope {
            rise: 0.1,
            ripple: 5.0,
        };
        for k in 0..40 {
            let ray = ray(DVec3::new(1.0, -0.3 + 0.009 * f64::from(k), 0.2));
            let Some(t) = first_hit(&rippled, &ray, 0.0, 5e4) else {
                panic!("ray {k} missed");
            };
            let gap = |t: f64| {
                let point = ray.at(t);
                altitude(point) - rippled.bare(point.x, 0.0) - rippled.cover(point.x, 0.0, 0.0)
            };
            assert!(gap(t).abs() < 1e-3);
            assert!((0..999).all(|i| gap(t * f64::from(i) / 1000.0) > -0.05));
        }
    }

    #[test]
    fn the_planet_curves_away() {
        let sea = Slope {
            rise: 0.0,
            ripple: 0.0,
        };
        let dip = (2.0 * 300.0 / PLANET_RADIUS).sqrt();
        assert!(first_hit(&sea, &ray(DVec3::new(1.0, -0.99 * dip, 0.0)), 0.0, 2e5).is_none());
        assert!(first_hit(&sea, &ray(DVec3::new(1.0, -1.01 * dip, 0.0)), 0.0, 2e5).is_some());
    }
}
