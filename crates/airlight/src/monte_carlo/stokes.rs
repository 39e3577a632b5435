//! Polarisation carried along a path, in addition to its throughput.
//!
//! Light is described by the Stokes vector `(I, Q, U, V)` in a frame perpendicular to its direction. A path from the eye
//! carries the product of the scattering matrices and frame rotations so far. Each matrix is divided by its phase function,
//! which is already part of the throughput. Only the three rows that yield `I`, `Q` and `U` at the eye are carried. Sunlight
//! is unpolarised, so only the first column of the last scattering matrix contributes.

use super::lanes::{Lanes, PerScatterer, Ratios};
use crate::spectrum::Spectrum;
use glam::DVec3;

/// Polarisation state of a path.
pub trait Polarisation<const N: usize> {
    /// False if light is scalar and nothing is carried.
    const CARRIED: bool;

    /// State at the eye, for a view ray along a unit vector.
    fn begin(view: DVec3) -> Self;

    /// Adds `light` from the direction `sun` (second direction) scattered into the path along the first direction.
    fn sunlight(
        &mut self,
        lanes: &Lanes<N>,
        directions: [DVec3; 2],
        shares: [&PerScatterer<N>; 2],
        light: Spectrum<N>,
    );

    /// Adds `light` from the sun reflected by the ground.
    fn sunlight_by_ground(&mut self, light: Spectrum<N>);

    /// Updates the state for scattering from the first of two path directions to the second.
    fn scattered(
        &mut self,
        lanes: &Lanes<N>,
        directions: [DVec3; 2],
        shares: [&PerScatterer<N>; 2],
    );

    /// Updates the state for reflection by the ground, which depolarises.
    fn reflected(&mut self);

    /// Accumulated `I`, `Q` and `U`.
    fn found(&self) -> [Spectrum<N>; 3];
}

/// Scalar light: no state.
pub struct Scalar;

impl<const N: usize> Polarisation<N> for Scalar {
    const CARRIED: bool = false;

    #[inline(always)]
    fn begin(_: DVec3) -> Self {
        Self
    }

    #[inline(always)]
    fn sunlight(&mut self, _: &Lanes<N>, _: [DVec3; 2], _: [&PerScatterer<N>; 2], _: Spectrum<N>) {}

    #[inline(always)]
    fn sunlight_by_ground(&mut self, _: Spectrum<N>) {}

    #[inline(always)]
    fn scattered(&mut self, _: &Lanes<N>, _: [DVec3; 2], _: [&PerScatterer<N>; 2]) {}

    #[inline(always)]
    fn reflected(&mut self) {}

    #[inline(always)]
    fn found(&self) -> [Spectrum<N>; 3] {
        [Spectrum::ZERO; 3]
    }
}

/// State of polarised light.
pub struct Stokes<const N: usize> {
    /// Matrix from `I, Q, U, V` of light in the path's frame to `I, Q, U` at the eye.
    rows: [[Spectrum<N>; 4]; 3],
    /// First axis of the path's frame; the second is `k x axis`, where `k` is the direction of the light, against the path.
    axis: DVec3,
    found: [Spectrum<N>; 3],
}

/// First axis of the eye's frame for a view ray: up, perpendicular to the ray; north-south for a vertical ray.
pub fn eye_axis(view: DVec3) -> DVec3 {
    let up = DVec3::Y - view * view.y;
    match up.length_squared() > 1e-18 {
        true => up.normalize(),
        false => DVec3::Z,
    }
}

/// Scattering plane and the rotation from the path's frame into it.
struct Plane {
    /// Normal of the plane, the second axis of its frames.
    across: DVec3,
    /// Cosine and sine of twice the angle from the plane's frame to the path's.
    rotation: [f32; 2],
}

impl Plane {
    /// Plane of light that arrives against `to` and is scattered against `from`.
    #[inline(always)]
    fn new(from: DVec3, to: DVec3, axis: DVec3) -> Self {
        let across = to.cross(from);
        let across = match across.length_squared() > 1e-24 {
            true => across.normalize(),
            // Forward or backward scattering: any plane contains both directions.
            false => from.any_orthonormal_vector(),
        };
        let (cos, sin) = (-axis.dot(across.cross(from)), axis.dot(across));
        Self {
            across,
            rotation: [(cos * cos - sin * sin) as f32, (2.0 * sin * cos) as f32],
        }
    }
}

impl<const N: usize> Stokes<N> {
    /// `Q` and `U` of a row, rotated into the frame of a scattering plane.
    #[inline(always)]
    fn rotated(row: &[Spectrum<N>; 4], [cos, sin]: [f32; 2]) -> [Spectrum<N>; 2] {
        [row[1] * cos - row[2] * sin, row[1] * sin + row[2] * cos]
    }
}

impl<const N: usize> Polarisation<N> for Stokes<N> {
    const CARRIED: bool = true;

    fn begin(view: DVec3) -> Self {
        let unit = |i: usize| {
            std::array::from_fn(|k| {
                if i == k {
                    Spectrum::ONE
                } else {
                    Spectrum::ZERO
                }
            })
        };
        Self {
            rows: [unit(0), unit(1), unit(2)],
            axis: eye_axis(view),
            found: [Spectrum::ZERO; 3],
        }
    }

    #[inline(always)]
    fn sunlight(
        &mut self,
        lanes: &Lanes<N>,
        [from, sun]: [DVec3; 2],
        [scattering, phases]: [&PerScatterer<N>; 2],
        light: Spectrum<N>,
    ) {
        let ratios = lanes.ratios(scattering, phases, from.dot(sun).clamp(-1.0, 1.0));
        let plane = Plane::new(from, sun, self.axis);
        for (found, row) in self.found.iter_mut().zip(&self.rows) {
            let [q, _] = Self::rotated(row, plane.rotation);
            *found += light * row[0].mul_acc(q, ratios.f12);
        }
    }

    #[inline(always)]
    fn sunlight_by_ground(&mut self, light: Spectrum<N>) {
        for (found, row) in self.found.iter_mut().zip(&self.rows) {
            *found += light * row[0];
        }
    }

    #[inline(always)]
    fn scattered(
        &mut self,
        lanes: &Lanes<N>,
        [from, to]: [DVec3; 2],
        [scattering, phases]: [&PerScatterer<N>; 2],
    ) {
        let Ratios {
            f12,
            f22,
            f33,
            f34,
            f44,
        } = lanes.ratios(scattering, phases, from.dot(to).clamp(-1.0, 1.0));
        let plane = Plane::new(from, to, self.axis);
        for row in &mut self.rows {
            let [q, u] = Self::rotated(row, plane.rotation);
            let (i, v) = (row[0], row[3]);
            *row = [
                i + q * f12,
                i * f12 + q * f22,
                u * f33 - v * f34,
                u * f34 + v * f44,
            ];
        }
        self.axis = -plane.across.cross(to);
    }

    #[inline(always)]
    fn reflected(&mut self) {
        for row in &mut self.rows {
            row[1..].fill(Spectrum::ZERO);
        }
    }

    #[inline(always)]
    fn found(&self) -> [Spectrum<N>; 3] {
        self.found
    }
}
