//! A hierarchy of bounding spheres, by which beams of rays find the objects that they may hit.
//!
//! Its queries are for whole beams, such as the rays of a pixel, which then share one descent; libraries of hierarchies answer
//! single rays, and the usual single precision would lose small objects that are far away.

use glam::DVec3;

/// A sphere.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct BoundingSphere {
    /// Centre, m.
    pub centre: DVec3,
    /// Radius, m; infinite for an object without bounds.
    pub radius_m: f64,
}

/// Rays that start within a distance of one point and run within an angle of one direction.
#[derive(Clone, Copy, Debug)]
pub struct Beam {
    start: DVec3,
    start_radius_m: f64,
    axis: DVec3,
    /// Sine and cosine of the angle; `None` for beams as wide as a half-space.
    spread: Option<(f64, f64)>,
}

/// Allowance for rounding: relative to the squared distance of a sphere, and of angles, rad.
const ROUNDING: f64 = 1e-13;

impl Beam {
    /// A single ray.
    pub fn ray(start: DVec3, direction: DVec3) -> Self {
        Self::parallel([start], direction).expect("one ray")
    }

    /// Rays from one point; `None` if there are none.
    pub fn diverging(
        start: DVec3,
        directions: impl Iterator<Item = DVec3> + Clone,
    ) -> Option<Self> {
        let axis = directions.clone().sum::<DVec3>().try_normalize();
        let Some(axis) = axis else {
            // Opposite directions.
            return directions.clone().next().map(|axis| Self {
                start,
                start_radius_m: 0.0,
                axis,
                spread: None,
            });
        };
        // Twice the sine of half the angle, accurate for small angles.
        let chord = directions
            .map(|direction| direction.distance_squared(axis))
            .fold(0.0, f64::max)
            .sqrt()
            + ROUNDING;
        let cos = 1.0 - 0.5 * chord * chord;
        Some(Self {
            start,
            start_radius_m: 0.0,
            axis,
            spread: (cos > 0.1).then(|| (chord * (1.0 - 0.25 * chord * chord).sqrt(), cos)),
        })
    }

    /// Rays in one direction; `None` if there are none.
    pub fn parallel(
        starts: impl IntoIterator<Item = DVec3> + Clone,
        direction: DVec3,
    ) -> Option<Self> {
        let (count, sum) = starts
            .clone()
            .into_iter()
            .fold((0, DVec3::ZERO), |(count, sum), start| {
                (count + 1, sum + start)
            });
        let start = sum / f64::from(count);
        let farthest = starts
            .into_iter()
            .map(|other| other.distance_squared(start))
            .fold(0.0, f64::max);
        (count > 0).then(|| Self {
            start,
            start_radius_m: farthest.sqrt(),
            axis: direction,
            spread: Some((0.0, 1.0)),
        })
    }

    /// Whether a ray of the beam may hit a sphere: true for all that one does hit.
    #[inline]
    fn may_hit(&self, sphere: &BoundingSphere) -> bool {
        let Some((sin, cos)) = self.spread else {
            return true;
        };
        let to = sphere.centre - self.start;
        let along_m = to.dot(self.axis);
        let squared = to.length_squared();
        let reach_m = sphere.radius_m + self.start_radius_m;
        // Distance from the edge of the cone: across cos - along sin.
        let across_m = (reach_m + along_m.max(0.0) * sin) / cos;
        along_m >= -reach_m - ROUNDING * squared.sqrt()
            && squared - along_m * along_m <= across_m * across_m + ROUNDING * squared
    }

    /// Lower bound of the distance at which a ray of the beam hits a sphere, m.
    #[inline]
    fn entry_m(&self, sphere: &BoundingSphere) -> f64 {
        let centre_m = sphere.centre.distance(self.start);
        let entry_m = centre_m - sphere.radius_m - self.start_radius_m;
        entry_m - ROUNDING * centre_m
    }
}

/// An object that a beam may hit.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Candidate {
    /// Lower bound of its distance, m.
    pub entry_m: f64,
    /// Its index.
    pub index: usize,
}

/// A hierarchy of the bounding spheres of objects.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct Hierarchy {
    /// Depth first.
    nodes: Vec<Node>,
    /// Objects without bounds.
    unbounded: Vec<usize>,
}

#[derive(Clone, Debug, PartialEq)]
struct Node {
    /// It contains the spheres of all objects below.
    sphere: BoundingSphere,
    /// The node that follows those below.
    next: usize,
    /// The object of a leaf.
    object: Option<usize>,
}

impl Hierarchy {
    /// A hierarchy of bounding spheres, in the order of their objects.
    pub fn new(spheres: &[BoundingSphere]) -> Self {
        let (mut bounded, unbounded): (Vec<usize>, Vec<usize>) =
            (0..spheres.len()).partition(|&index| spheres[index].radius_m.is_finite());
        let mut nodes = Vec::with_capacity(2 * bounded.len());
        if !bounded.is_empty() {
            add(spheres, &mut bounded, &mut nodes);
        }
        Self { nodes, unbounded }
    }

    /// The objects that rays of a beam may hit.
    pub fn candidates<'s>(&'s self, beam: &'s Beam) -> impl Iterator<Item = Candidate> + 's {
        let unbounded = self.unbounded.iter().map(|&index| Candidate {
            entry_m: 0.0,
            index,
        });
        let mut at = 0;
        let bounded = std::iter::from_fn(move || {
            while let Some(node) = self.nodes.get(at) {
                if !beam.may_hit(&node.sphere) {
                    at = node.next;
                    continue;
                }
                at += 1;
                if let Some(index) = node.object {
                    let entry_m = beam.entry_m(&node.sphere);
                    return Some(Candidate { entry_m, index });
                }
            }
            None
        });
        unbounded.chain(bounded)
    }
}

/// Adds the nodes of at least one object: halves along the axis on which the centres extend farthest.
fn add(spheres: &[BoundingSphere], objects: &mut [usize], nodes: &mut Vec<Node>) {
    if let [object] = *objects {
        nodes.push(Node {
            sphere: spheres[object],
            next: nodes.len() + 1,
            object: Some(object),
        });
        return;
    }
    let centres = objects.iter().map(|&object| spheres[object].centre);
    let low = centres.clone().fold(DVec3::INFINITY, DVec3::min);
    let high = centres.fold(DVec3::NEG_INFINITY, DVec3::max);
    let centre = 0.5 * (low + high);
    let radius_m = objects
        .iter()
        .map(|&object| spheres[object].centre.distance(centre) + spheres[object].radius_m)
        .fold(0.0, f64::max);
    let number = nodes.len();
    nodes.push(Node {
        sphere: BoundingSphere { centre, radius_m },
        next: 0,
        object: None,
    });
    let axis = (high - low).max_position();
    let middle = objects.len() / 2;
    objects.select_nth_unstable_by(middle, |&a, &b| {
        spheres[a].centre[axis].total_cmp(&spheres[b].centre[axis])
    });
    let (before, behind) = objects.split_at_mut(middle);
    add(spheres, before, nodes);
    add(spheres, behind, nodes);
    nodes[number].next = nodes.len();
}
