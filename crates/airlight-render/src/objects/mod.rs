//! Objects in front of the sky: simple shapes with reflecting surfaces.
//!
//! - [`shape`]: shapes and their intersection with rays; [`surface`]: reflection; [`mod@file`]: both from TOML.
//! - [`Objects`]: all objects of a scene, with the first hit of a ray; [`LitObjects`]: objects lit by a view.
//! - [`ObjectRows`], [`write_depth`]: pictures of them, and their depth.
//!
//! Positions are in metres east, up and south of the point of the ground below the eye.

pub mod file;
mod lit;
mod rows;
pub mod shape;
pub mod surface;

pub use lit::{LitObjects, Scratch, ViewRay};
pub use rows::{ObjectRows, write_depth};
pub use shape::Ray;

use glam::DVec3;
use shape::{Met, Shape};
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
    /// Bounding sphere of each object: centre and squared radius.
    bounds: Vec<(DVec3, f64)>,
}

impl Objects {
    /// A list of valid objects.
    pub fn new(objects: Vec<Object>) -> Self {
        let bounds = objects.iter().map(|object| object.shape.bounding_sphere());
        Self {
            bounds: bounds.map(|(middle, r)| (middle, r * r)).collect(),
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
        let (index, met) = self
            .met(ray)
            .min_by(|(_, a), (_, b)| a.distance_m.total_cmp(&b.distance_m))?;
        let facing = met.normal.dot(ray.direction) <= 0.0;
        Some(Hit {
            distance_m: met.distance_m,
            point: ray.at(met.distance_m),
            normal: if facing { met.normal } else { -met.normal },
            index,
            surface: &self.objects[index].surface,
        })
    }

    /// Whether an object blocks light from this direction at a point of a surface.
    pub fn shadowed(&self, hit: &Hit<'_>, to_light: DVec3) -> bool {
        let off_m = OFF * hit.point.abs().max_element().max(10.0);
        let ray = Ray {
            origin: hit.point + off_m * hit.normal,
            direction: to_light,
        };
        self.met(&ray).next().is_some()
    }

    /// Intersections of a ray with all objects, by index.
    fn met<'s>(&'s self, ray: &'s Ray) -> impl Iterator<Item = (usize, Met)> + 's {
        let near = |(middle, squared): &(DVec3, f64)| {
            let to = middle - ray.origin;
            let along = to.dot(ray.direction);
            to.length_squared() - along * along <= *squared
        };
        (0..)
            .zip(self.objects.iter().zip(&self.bounds))
            .filter(move |(_, (_, bound))| near(bound))
            .filter_map(|(index, (object, _))| Some((index, object.shape.meet(ray)?)))
    }
}

#[cfg(test)]
mod tests;
