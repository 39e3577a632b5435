//! Shapes and their intersections with rays.

use glam::DVec3;

/// A half-line.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Ray {
    /// Start, m.
    pub origin: DVec3,
    /// Unit vector.
    pub direction: DVec3,
}

impl Ray {
    /// The point at a distance from the start, m.
    pub fn at(&self, distance_m: f64) -> DVec3 {
        self.origin + distance_m * self.direction
    }
}

/// The shape of an object.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum Shape {
    /// An infinite horizontal plane.
    Ground {
        /// Height of the plane, m.
        height_m: f64,
    },
    /// A sphere.
    Sphere {
        /// Centre, m.
        centre: DVec3,
        /// Radius, m.
        radius_m: f64,
    },
    /// A block with horizontal top and bottom, rotated about the vertical axis.
    Block {
        /// Centre of the base, m.
        base: DVec3,
        /// Half the extent to the east, the height, and half the extent to the south, before rotation, m.
        half_m: DVec3,
        /// Sine and cosine of the rotation, clockwise seen from above.
        turn: (f64, f64),
    },
    /// A vertical cylinder, cone or truncated cone.
    Frustum {
        /// Centre of the base, m.
        base: DVec3,
        /// Radius of the base, m.
        radius_m: f64,
        /// Radius of the top, m.
        top_radius_m: f64,
        /// Height, m.
        height_m: f64,
    },
}

/// Intersection of a ray with a shape.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Met {
    /// Distance from the ray's start, m, above 0.
    pub distance_m: f64,
    /// Outward unit normal.
    pub normal: DVec3,
}

impl Shape {
    /// Height of the highest point, m; 0 for ground.
    pub fn top_m(&self) -> f64 {
        match self {
            Self::Ground { .. } => 0.0,
            Self::Sphere { centre, radius_m } => centre.y + radius_m,
            Self::Block { base, half_m, .. } => base.y + half_m.y,
            Self::Frustum { base, height_m, .. } => base.y + height_m,
        }
    }

    /// Centre and radius of a bounding sphere, m; infinite for ground.
    pub fn bounding_sphere(&self) -> (DVec3, f64) {
        match *self {
            Self::Ground { .. } => (DVec3::ZERO, f64::INFINITY),
            Self::Sphere { centre, radius_m } => (centre, radius_m),
            Self::Block { base, half_m, .. } => {
                let half_height_m = 0.5 * half_m.y;
                let radius_m = half_m.with_y(half_height_m).length();
                (base + half_height_m * DVec3::Y, radius_m)
            }
            Self::Frustum {
                base,
                radius_m,
                top_radius_m,
                height_m,
            } => {
                let middle = base + 0.5 * height_m * DVec3::Y;
                (middle, (0.5 * height_m).hypot(radius_m.max(top_radius_m)))
            }
        }
    }

    /// The first intersection with a ray.
    pub fn meet(&self, ray: &Ray) -> Option<Met> {
        match *self {
            Self::Ground { height_m } => level(ray, height_m),
            Self::Sphere { centre, radius_m } => sphere(ray, centre, radius_m),
            Self::Block { base, half_m, turn } => block(ray, base, half_m, turn),
            Self::Frustum {
                base,
                radius_m,
                top_radius_m,
                height_m,
            } => frustum(ray, base, (radius_m, top_radius_m), height_m),
        }
    }
}

fn level(ray: &Ray, height_m: f64) -> Option<Met> {
    let distance_m = (height_m - ray.origin.y) / ray.direction.y;
    (distance_m > 0.0 && distance_m.is_finite()).then_some(Met {
        distance_m,
        normal: DVec3::Y,
    })
}

/// Roots of `a t^2 + 2 b t + c` in increasing order, without cancellation; for `a` = 0 one is infinite.
fn roots(a: f64, b: f64, c: f64) -> Option<[f64; 2]> {
    let discriminant = b * b - a * c;
    if discriminant < 0.0 {
        return None;
    }
    let q = -(b + discriminant.sqrt().copysign(b));
    if q == 0.0 {
        return (a != 0.0).then_some([0.0; 2]);
    }
    let (x, y) = (q / a, c / q);
    Some([x.min(y), x.max(y)])
}

fn sphere(ray: &Ray, centre: DVec3, radius_m: f64) -> Option<Met> {
    let from = ray.origin - centre;
    let c = (from.length() - radius_m) * (from.length() + radius_m);
    let distance_m = roots(1.0, from.dot(ray.direction), c)?
        .into_iter()
        .find(|t| *t > 0.0)?;
    Some(Met {
        distance_m,
        normal: (ray.at(distance_m) - centre) / radius_m,
    })
}

/// Intersection of three slabs: the ray is inside from the last entry to the first exit.
fn block(ray: &Ray, base: DVec3, half_m: DVec3, (sin, cos): (f64, f64)) -> Option<Met> {
    let turned = |v: DVec3| DVec3::new(cos * v.x + sin * v.z, v.y, cos * v.z - sin * v.x);
    let back = |v: DVec3| DVec3::new(cos * v.x - sin * v.z, v.y, cos * v.z + sin * v.x);
    let (origin, direction) = (turned(ray.origin - base), turned(ray.direction));
    let low = DVec3::new(-half_m.x, 0.0, -half_m.z);
    let (mut enters, mut leaves) = (f64::NEG_INFINITY, f64::INFINITY);
    let (mut entry, mut exit) = (DVec3::ZERO, DVec3::ZERO);
    for axis in 0..3 {
        if direction[axis] == 0.0 {
            if !(low[axis]..=half_m[axis]).contains(&origin[axis]) {
                return None;
            }
            continue;
        }
        let (a, b) = (
            (low[axis] - origin[axis]) / direction[axis],
            (half_m[axis] - origin[axis]) / direction[axis],
        );
        let towards = DVec3::AXES[axis] * direction[axis].signum();
        if a.min(b) > enters {
            (enters, entry) = (a.min(b), -towards);
        }
        if a.max(b) < leaves {
            (leaves, exit) = (a.max(b), towards);
        }
    }
    let (distance_m, normal) = match enters > 0.0 {
        true => (enters, entry),
        false => (leaves, exit),
    };
    (enters <= leaves && distance_m > 0.0).then(|| Met {
        distance_m,
        normal: back(normal),
    })
}

/// The lateral surface `x^2 + z^2 = r(y)^2`, with `r` linear in the height, and two discs.
fn frustum(ray: &Ray, base: DVec3, (bottom_m, top_m): (f64, f64), height_m: f64) -> Option<Met> {
    let (o, d) = (ray.origin - base, ray.direction);
    let slope = (top_m - bottom_m) / height_m;
    let radius = bottom_m + slope * o.y;
    let a = d.x * d.x + d.z * d.z - (slope * d.y).powi(2);
    let b = o.x * d.x + o.z * d.z - slope * d.y * radius;
    let c = o.x * o.x + o.z * o.z - radius * radius;
    let mantle = roots(a, b, c)
        .into_iter()
        .flatten()
        .filter(|t| *t > 0.0 && (0.0..=height_m).contains(&(o.y + t * d.y)))
        .map(|t| {
            let p = o + t * d;
            let outwards = DVec3::new(p.x, -slope * (bottom_m + slope * p.y), p.z);
            (t, outwards.normalize_or(DVec3::Y))
        });
    let discs = [(0.0, bottom_m, -DVec3::Y), (height_m, top_m, DVec3::Y)]
        .into_iter()
        .filter_map(|(height, radius_m, normal)| {
            let t = (height - o.y) / d.y;
            let p = o + t * d;
            (t > 0.0 && p.x * p.x + p.z * p.z <= radius_m * radius_m).then_some((t, normal))
        });
    let (distance_m, normal) = mantle.chain(discs).min_by(|a, b| a.0.total_cmp(&b.0))?;
    Some(Met { distance_m, normal })
}
