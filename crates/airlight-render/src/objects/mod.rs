//! Things before the sky: simple solids, what they are made of, and where rays meet them.
//!
//! - [`shape`]: solids; [`surface`]: how they reflect; [`mod@file`]: reading both from TOML.
//! - [`Objects`]: all objects of a scene, and the first that a ray meets; [`LitObjects`]: the same in the light of a view.
//! - [`ObjectRows`], [`write_depth`]: pictures of them.
//!
//! Positions are in metres east, up and south of the point of the ground under the eye.

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

/// A thing.
#[derive(Clone, Debug, PartialEq)]
pub struct Object {
    /// Its form and place.
    pub shape: Shape,
    /// What it is made of.
    pub surface: Surface,
}

/// Where a ray meets a thing.
#[derive(Clone, Copy, Debug)]
pub struct Hit<'a> {
    /// Distance from the ray's start, m.
    pub distance_m: f64,
    /// Where, m.
    pub point: DVec3,
    /// Unit normal, on the ray's side.
    pub normal: DVec3,
    /// Which thing, counted from 0.
    pub index: usize,
    /// What is met.
    pub surface: &'a Surface,
}

/// How far from a surface light for it is looked for, as part of its distance from the scene's middle (and in metres at the least):
/// so that no point shadows itself.
const OFF: f64 = 1e-7;

/// The things of a scene.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct Objects {
    objects: Vec<Object>,
    /// A ball about each: its middle, and its radius squared.
    balls: Vec<(DVec3, f64)>,
}

impl Objects {
    /// Takes checked things.
    pub fn new(objects: Vec<Object>) -> Self {
        let balls = objects.iter().map(|object| object.shape.ball());
        Self {
            balls: balls.map(|(middle, r)| (middle, r * r)).collect(),
            objects,
        }
    }

    /// All of them.
    pub fn all(&self) -> &[Object] {
        &self.objects
    }

    /// The highest point of things that are not ground, m above the ground; 0 where there are none.
    pub fn top_m(&self) -> f64 {
        let tops = self.objects.iter().map(|object| object.shape.top_m());
        tops.fold(0.0, f64::max)
    }

    /// The first thing that a ray meets.
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

    /// Whether something stands between a surface and a light in this direction.
    pub fn shadowed(&self, hit: &Hit<'_>, to_light: DVec3) -> bool {
        let off_m = OFF * hit.point.abs().max_element().max(10.0);
        let ray = Ray {
            origin: hit.point + off_m * hit.normal,
            direction: to_light,
        };
        self.met(&ray).next().is_some()
    }

    /// All things that a ray meets.
    fn met<'s>(&'s self, ray: &'s Ray) -> impl Iterator<Item = (usize, Met)> + 's {
        let near = |(middle, squared): &(DVec3, f64)| {
            let to = middle - ray.origin;
            let along = to.dot(ray.direction);
            to.length_squared() - along * along <= *squared
        };
        (0..)
            .zip(self.objects.iter().zip(&self.balls))
            .filter(move |(_, (_, ball))| near(ball))
            .filter_map(|(index, (object, _))| Some((index, object.shape.meet(ray)?)))
    }
}

#[cfg(test)]
mod tests;
