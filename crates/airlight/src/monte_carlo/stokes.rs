//! What a path carries of polarisation, beside its worth.
//!
//! Light is described by the Stokes vector `(I, Q, U, V)` in a frame across its way. A path from the eye carries the product
//! of the scattering matrices and turns of frames behind it, each over its phase function, whose share is in the path's
//! worth already: the three rows that make `I`, `Q` and `U` at the eye. Sunlight is natural, so that of what is scattered
//! last the first column does.

use super::lanes::{Lanes, PerScatterer, Ratios};
use crate::spectrum::Spectrum;
use glam::DVec3;

/// What follows a path beside its worth.
pub trait Polarisation<const N: usize> {
    /// Whether anything does.
    const CARRIED: bool;

    /// At the eye, looking along a unit vector.
    fn begin(view: DVec3) -> Self;

    /// `light` comes from the direction `sun` by being scattered into a path that goes back along `direction`.
    fn sunlight(
        &mut self,
        lanes: &Lanes<N>,
        ways: [DVec3; 2],
        shares: [&PerScatterer<N>; 2],
        light: Spectrum<N>,
    );

    /// `light` comes from the sun by way of the ground.
    fn sunlight_by_ground(&mut self, light: Spectrum<N>);

    /// The path goes on from the first of two directions along the second.
    fn scattered(&mut self, lanes: &Lanes<N>, ways: [DVec3; 2], shares: [&PerScatterer<N>; 2]);

    /// The path goes on from the ground, whose light has no polarisation.
    fn reflected(&mut self);

    /// `I`, `Q` and `U` found so far.
    fn found(&self) -> [Spectrum<N>; 3];
}

/// Nothing: light is scalar.
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

/// Stokes vectors.
pub struct Stokes<const N: usize> {
    /// From `I, Q, U, V` of light in the path's frame to `I, Q, U` at the eye.
    rows: [[Spectrum<N>; 4]; 3],
    /// First axis of the path's frame; the second is `k x axis`, where `k` is where the light goes: against the path.
    axis: DVec3,
    found: [Spectrum<N>; 3],
}

/// The first axis of the eye's frame along a line of sight: up, across the line; north and south where that is vertical.
pub fn eye_axis(view: DVec3) -> DVec3 {
    let up = DVec3::Y - view * view.y;
    match up.length_squared() > 1e-18 {
        true => up.normalize(),
        false => DVec3::Z,
    }
}

/// A plane of scattering, from the frame of a path to its own.
struct Plane {
    /// Unit vector across it, the second axis of its frames.
    across: DVec3,
    /// Cosine and sine of twice the angle from its frame to the path's.
    turn: [f32; 2],
}

impl Plane {
    /// Light that comes against `to` is scattered against `from`.
    #[inline(always)]
    fn new(from: DVec3, to: DVec3, axis: DVec3) -> Self {
        let across = to.cross(from);
        let across = match across.length_squared() > 1e-24 {
            true => across.normalize(),
            // Straight on or back: any plane does.
            false => from.any_orthonormal_vector(),
        };
        let (cos, sin) = (-axis.dot(across.cross(from)), axis.dot(across));
        Self {
            across,
            turn: [(cos * cos - sin * sin) as f32, (2.0 * sin * cos) as f32],
        }
    }
}

impl<const N: usize> Stokes<N> {
    /// `Q` and `U` of a row, in the frame of a plane of scattering.
    #[inline(always)]
    fn turned(row: &[Spectrum<N>; 4], [cos, sin]: [f32; 2]) -> [Spectrum<N>; 2] {
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
            let [q, _] = Self::turned(row, plane.turn);
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
            let [q, u] = Self::turned(row, plane.turn);
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
