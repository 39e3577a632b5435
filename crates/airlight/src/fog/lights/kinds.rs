//! A lamp of any kind, and its direct light.

use super::medium::ParticipatingMedium;
use super::{PointLight, SphereLight, SpotLight};
use crate::atmosphere::RaySegment;
use crate::fog::lanes::Lanes;
use crate::spectrum::Spectrum;
use glam::DVec3;

/// A lamp.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum Light<const N: usize> {
    /// Small, shining equally in all directions.
    Point(PointLight<N>),
    /// Small, shining into a cone.
    Spot(SpotLight<N>),
    /// A glowing ball.
    Sphere(SphereLight<N>),
}

impl<const N: usize> Light<N> {
    /// Where it is (its centre), m.
    pub fn position(&self) -> DVec3 {
        match self {
            Self::Point(light) => light.position,
            Self::Spot(light) => light.position,
            Self::Sphere(light) => light.position,
        }
    }

    /// Its size, m.
    pub fn radius_m(&self) -> f64 {
        match self {
            Self::Point(light) => light.radius_m,
            Self::Spot(light) => light.radius_m,
            Self::Sphere(light) => light.radius_m,
        }
    }

    /// Radiant intensity from afar (on the axis of a spot lamp), W sr^-1 nm^-1.
    pub fn intensity(&self) -> Spectrum<N> {
        match self {
            Self::Point(light) => light.intensity,
            Self::Spot(light) => light.intensity,
            Self::Sphere(light) => light.intensity(),
        }
    }

    /// Irradiance of a small surface at `point` that faces the lamp, W m^-2 nm^-1: `I / r^2`, dimmed by the fog between.
    /// For any other surface it is to be multiplied by the cosine between its normal and the direction to
    /// [`Light::position`]. Nothing but fog stands between. It is exact for all three kinds (a ball that fills the sky of
    /// the surface to the horizon included), but that points within the radius count as at it, and that a ball is dimmed
    /// over the way to its nearest point.
    pub fn illumination(&self, medium: &ParticipatingMedium<N>, point: DVec3) -> Spectrum<N> {
        let to_light = self.position() - point;
        let distance = to_light.length().max(self.radius_m());
        let towards = to_light / distance;
        let (part, leg) = match self {
            Self::Point(_) => (1.0, distance),
            Self::Spot(light) => (light.falloff(-towards), distance),
            Self::Sphere(light) => (1.0, distance - light.radius_m),
        };
        let line = RaySegment::new(point.y, towards.y, leg, medium.ground_radius_m);
        let own = medium.medium.extinction_per_m * medium.profile.column_along_m(&line) as f32;
        let depth = medium.others.iter().fold(own, |sum, other| {
            sum.scale_acc(
                other.medium.extinction_per_m,
                other.profile.column_along_m(&line) as f32,
            )
        });
        self.intensity() * depth.exp_neg() * (part / (distance * distance)) as f32
    }
}
