//! A lamp of any kind, and its direct light.

use super::murk::Murk;
use super::{PointLamp, SphereLamp, SpotLamp};
use crate::fog::lanes::Lanes;
use crate::fog::line::Line;
use crate::spectrum::Spectrum;
use glam::DVec3;

/// A lamp.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum Lamp<const N: usize> {
    /// Small, shining equally in all directions.
    Point(PointLamp<N>),
    /// Small, shining into a cone.
    Spot(SpotLamp<N>),
    /// A glowing ball.
    Sphere(SphereLamp<N>),
}

impl<const N: usize> Lamp<N> {
    /// Where it is (its centre), m.
    pub fn position(&self) -> DVec3 {
        match self {
            Self::Point(lamp) => lamp.position,
            Self::Spot(lamp) => lamp.position,
            Self::Sphere(lamp) => lamp.position,
        }
    }

    /// Its size, m.
    pub fn radius_m(&self) -> f64 {
        match self {
            Self::Point(lamp) => lamp.radius_m,
            Self::Spot(lamp) => lamp.radius_m,
            Self::Sphere(lamp) => lamp.radius_m,
        }
    }

    /// Radiant intensity from afar (on the axis of a spot lamp), W sr^-1 nm^-1.
    pub fn intensity(&self) -> Spectrum<N> {
        match self {
            Self::Point(lamp) => lamp.intensity,
            Self::Spot(lamp) => lamp.intensity,
            Self::Sphere(lamp) => lamp.intensity(),
        }
    }

    /// Irradiance of a small surface at `point` that faces the lamp, W m^-2 nm^-1: `I / r^2`, dimmed by the fog between.
    /// For any other surface it is to be multiplied by the cosine between its normal and the direction to
    /// [`Lamp::position`]. Nothing but fog stands between. It is exact for all three kinds (a ball that fills the sky of
    /// the surface to the horizon included), but that points within the radius count as at it, and that a ball is dimmed
    /// over the way to its nearest point.
    pub fn illumination(&self, murk: &Murk<N>, point: DVec3) -> Spectrum<N> {
        let to_lamp = self.position() - point;
        let distance = to_lamp.length().max(self.radius_m());
        let towards = to_lamp / distance;
        let (part, leg) = match self {
            Self::Point(_) => (1.0, distance),
            Self::Spot(lamp) => (lamp.falloff(-towards), distance),
            Self::Sphere(lamp) => (1.0, distance - lamp.radius_m),
        };
        let line = Line::new(point.y, towards.y, leg, murk.ground_radius_m);
        let own = murk.matter.extinction_per_m * murk.profile.column(&line) as f32;
        let depth = murk.others.iter().fold(own, |sum, other| {
            sum.scale_acc(
                other.matter.extinction_per_m,
                other.profile.column(&line) as f32,
            )
        });
        self.intensity() * depth.exp_neg() * (part / (distance * distance)) as f32
    }
}
