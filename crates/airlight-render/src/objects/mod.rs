//! Objects in front of the sky: simple shapes with reflecting surfaces.
//!
//! - [`shape`]: shapes and their intersection with rays; [`surface`]: reflection; [`mod@file`]: both from TOML.
//! - [`Objects`]: all objects of a scene, with the first hit of a ray; [`LitObjects`]: objects lit by a view.
//! - [`ObjectRows`], [`write_depth`]: pictures of them, and their depth.
//!
//! Positions are in metres east, up and south of the point of the ground below the eye.

pub mod file;
mod hierarchy;
mod lit;
mod rows;
pub mod shape;
pub mod surface;

pub use hierarchy::Candidate;
pub use lit::{LitObjects, Scratch, ViewRay};
pub use rows::{ObjectRows, write_depth};
pub use shape::Ray;

use glam::DVec3;
use hierarchy::{Beam, BoundingSphere, Hierarchy};
use shape::{Met, Shape};
use std::cmp::Ordering;
use surface::Surface;

/// A shape with a surface.
#[derive(Clone, Debug, PartialEq)]
pub struct Object {
    /// Shape and position.
    pub shape: Shape,
    /// Reflection properties.
    pub surface: Surface,
}

/// Intersection of a ray with an object.
#[derive(Clone, Copy, Debug)]
pub struct Hit<'a> {
    /// Distance from the ray's start, m.
    pub distance_m: f64,
    /// Point of intersection, m.
    pub point: DVec3,
    /// Unit normal, on the ray's side.
    pub normal: DVec3,
    /// Index of the object.
    pub index: usize,
    /// Surface of the object.
    pub surface: &'a Surface,
}

/// Offset of shadow rays from a surface, relative to the largest coordinate of the point (at least 10 m), so that points do not
/// shadow themselves.
const OFF: f64 = 1e-7;

/// The objects of a scene.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct Objects {
    objects: Vec<Object>,
    /// Bounding sphere of each object.
    bounds: Vec<BoundingSphere>,
    hierarchy: Hierarchy,
}

impl Objects {
    /// A list of valid objects.
    pub fn new(objects: Vec<Object>) -> Self {
        let bounds = objects.iter().map(|object| object.shape.bounding_sphere());
        let bounds: Vec<BoundingSphere> = bounds
            .map(|(centre, radius_m)| BoundingSphere { centre, radius_m })
            .collect();
        Self {
            hierarchy: Hierarchy::new(&bounds),
            bounds,
            objects,
        }
    }

    /// The list of objects.
    pub fn all(&self) -> &[Object] {
        &self.objects
    }

    /// Height of the highest point of all objects except ground, m; 0 if there are none.
    pub fn top_m(&self) -> f64 {
        let tops = self.objects.iter().map(|object| object.shape.top_m());
        tops.fold(0.0, f64::max)
    }

    /// The first intersection of a ray.
    pub fn hit(&self, ray: &Ray) -> Option<Hit<'_>> {
        let beam = Beam::ray(ray.origin, ray.direction);
        let met = self
            .hierarchy
            .candidates(&beam)
            .filter_map(|candidate| self.met(candidate.index, ray));
        met.min_by(nearer).map(|first| self.hit_of(ray, first))
    }

    /// The objects that rays from one point in these directions may hit, from near to far.
    pub fn candidates(&self, origin: DVec3, directions: &[DVec3], out: &mut Vec<Candidate>) {
        out.clear();
        if let Some(beam) = Beam::diverging(origin, directions.iter().copied()) {
            out.extend(self.hierarchy.candidates(&beam));
            out.sort_unstable_by(|a, b| a.entry_m.total_cmp(&b.entry_m));
        }
    }

    /// [`Self::hit`] of a ray among the [`Self::candidates`] of a beam that contains it.
    pub fn hit_among(&self, candidates: &[Candidate], ray: &Ray) -> Option<Hit<'_>> {
        let mut first: Option<(usize, Met)> = None;
        for candidate in candidates {
            if first.is_some_and(|(_, met)| met.distance_m < candidate.entry_m) {
                break;
            }
            if let Some(met) = self.met(candidate.index, ray)
                && first.is_none_or(|first| nearer(&met, &first).is_lt())
            {
                first = Some(met);
            }
        }
        first.map(|first| self.hit_of(ray, first))
    }

    /// Whether an object blocks light from this direction at a point of a surface.
    pub fn shadowed(&self, hit: &Hit<'_>, to_light: DVec3) -> bool {
        let start = shadow_start(hit);
        let beam = Beam::ray(start, to_light);
        let mut candidates = self.hierarchy.candidates(&beam);
        candidates.any(|candidate| self.blocks(candidate, start, to_light))
    }

    /// The objects that may block light from this direction at any of these points.
    pub fn shadow_candidates<'h>(
        &self,
        hits: impl Iterator<Item = &'h Hit<'h>> + Clone,
        to_light: DVec3,
        out: &mut Vec<Candidate>,
    ) {
        out.clear();
        if let Some(beam) = Beam::parallel(hits.map(shadow_start), to_light) {
            out.extend(self.hierarchy.candidates(&beam));
        }
    }

    /// [`Self::shadowed`] at one of the points of [`Self::shadow_candidates`].
    pub fn shadowed_by(&self, candidates: &[Candidate], hit: &Hit<'_>, to_light: DVec3) -> bool {
        let start = shadow_start(hit);
        let mut candidates = candidates.iter();
        candidates.any(|&candidate| self.blocks(candidate, start, to_light))
    }

    fn blocks(&self, candidate: Candidate, origin: DVec3, direction: DVec3) -> bool {
        let ray = Ray { origin, direction };
        self.met(candidate.index, &ray).is_some()
    }

    /// Intersection of a ray with an object, with its index.
    fn met(&self, index: usize, ray: &Ray) -> Option<(usize, Met)> {
        let BoundingSphere { centre, radius_m } = self.bounds[index];
        let to = centre - ray.origin;
        let along = to.dot(ray.direction);
        if to.length_squared() - along * along > radius_m * radius_m {
            return None;
        }
        Some((index, self.objects[index].shape.meet(ray)?))
    }

    fn hit_of(&self, ray: &Ray, (index, met): (usize, Met)) -> Hit<'_> {
        let facing = met.normal.dot(ray.direction) <= 0.0;
        Hit {
            distance_m: met.distance_m,
            point: ray.at(met.distance_m),
            normal: if facing { met.normal } else { -met.normal },
            index,
            surface: &self.objects[index].surface,
        }
    }
}

/// Order of intersections by distance; of equal ones, the object that is listed first precedes.
fn nearer(a: &(usize, Met), b: &(usize, Met)) -> Ordering {
    let distances = a.1.distance_m.total_cmp(&b.1.distance_m);
    distances.then(a.0.cmp(&b.0))
}

/// Start of the shadow rays of a point of a surface.
fn shadow_start(hit: &Hit<'_>) -> DVec3 {
    hit.point + OFF * hit.point.abs().max_element().max(10.0) * hit.normal
}

#[cfg(test)]
mod tests;
