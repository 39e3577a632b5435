//! Where lines lie in a table, and what is interpolated there.

use super::SunSide;
use crate::fog::lanes::Lanes;
use crate::fog::multiple::STREAMS;
use crate::math::interpolation::cubic_weights;
use crate::spectrum::Spectrum;
use glam::DVec3;
use std::sync::OnceLock;

/// Elevations of each side of the level line.
pub(super) const ROWS: usize = 64;
/// How far rows lie evenly in the logarithm of the climb, and not in the climb.
const LOGARITHMIC: f32 = 0.6;
/// Distances, to where the fog ends and to the ground, and from there on.
pub(super) const NODES: usize = 41;
/// Parts of the forward peak that count as scattered at which light in it is tabulated.
pub(super) const SHARES: usize = 7;
/// The smallest opacity of a node over the largest: there the source function is that at the eye.
pub(super) const NEAREST: f32 = 1e-5;

/// All lines that go up, or all that go down.
#[derive(Debug)]
pub(super) struct Side<const N: usize> {
    /// -1 or 1.
    pub sign: f64,
    /// Optical depth straight to space or to the ground.
    pub depth: Spectrum<N>,
    pub is_grey: bool,
    /// Climb up to which rows lie evenly; beyond, evenly in a mean of its logarithm and itself.
    pub even_to: f64,
    /// The climb (without its sign) of each row; of the first, next to nothing.
    pub climbs: Vec<f64>,
    pub rows: Vec<OnceLock<Row<N>>>,
    /// One over the logarithm of the steepest climb in units of `even_to`, and 1.
    pub per_logarithm: f32,
}

/// Light for a unit of opacity, along lines of one elevation, at each distance.
#[derive(Debug)]
pub(super) struct Row<const N: usize> {
    /// Scattered often: the mean over azimuth.
    pub even: Vec<Spectrum<N>>,
    /// The further azimuth modes, over the cosine of the elevation to their power; of the first nothing. Lanes outside, so that
    /// modes add up in one vector.
    pub around: Vec<[[f32; STREAMS]; N]>,
    /// The logarithm of sunlight scattered once, by part of the peak.
    pub sunlit: Vec<[Spectrum<N>; SHARES]>,
}

/// Where a line lies in a side's table.
pub(super) struct Place {
    pub row: usize,
    pub node: usize,
    /// Of four rows, at the nearer and the farther node.
    pub weights: [[f32; 2]; 4],
}

impl Place {
    /// A value of the table.
    #[inline]
    pub fn sum_of<const N: usize>(
        &self,
        rows: &[&Row<N>; 4],
        value: impl Fn(&Row<N>, usize) -> Spectrum<N>,
    ) -> Spectrum<N> {
        let mut sum = Spectrum::ZERO;
        for (row, [near, far]) in rows.iter().zip(self.weights) {
            sum = sum
                .scale_acc(value(row, self.node), near)
                .scale_acc(value(row, self.node + 1), far);
        }
        sum
    }

    /// The azimuth modes beyond the first, summed in a direction.
    #[inline]
    pub fn around<const N: usize>(
        &self,
        rows: &[&Row<N>; 4],
        sun: &SunSide<N>,
        direction: DVec3,
    ) -> Spectrum<N> {
        let mut sums = [[0.0f32; STREAMS]; N];
        for (row, [near, far]) in rows.iter().zip(self.weights) {
            let (from, to) = (&row.around[self.node], &row.around[self.node + 1]);
            for lane in 0..N {
                for m in 0..STREAMS {
                    sums[lane][m] += near * from[lane][m] + far * to[lane][m];
                }
            }
        }
        // c^m cos(m azimuth), where c is the cosine of the elevation.
        let across = direction.dot(sun.level) as f32;
        let square = (direction.x * direction.x + direction.z * direction.z) as f32;
        let mut factors = [0.0, across, 0.0, 0.0, 0.0, 0.0, 0.0, 0.0];
        let mut before = 1.0;
        for m in 2..STREAMS {
            let next = 2.0 * across * factors[m - 1] - square * before;
            (before, factors[m]) = (factors[m - 1], next);
        }
        Spectrum(sums.map(|modes| {
            let each = modes.iter().zip(&factors);
            each.map(|(mode, factor)| mode * factor).sum()
        }))
    }
}

impl<const N: usize> Side<N> {
    pub fn new(sign: f64, depth: Spectrum<N>, is_grey: bool) -> Self {
        let even_to = f64::from(0.1 * mean(depth)).clamp(1e-6, 0.05);
        let mut side = Self {
            sign,
            depth,
            is_grey,
            even_to,
            per_logarithm: (1.0 / (1.0 / even_to).ln_1p()) as f32,
            climbs: Vec::new(),
            rows: std::iter::repeat_with(OnceLock::new).take(ROWS).collect(),
        };
        side.climbs = (0..ROWS).map(|row| side.sin_elevation_at(row)).collect();
        side
    }

    /// Where a climb (without its sign) lies among the rows.
    #[inline]
    pub fn row_of(&self, sin_elevation: f64) -> f32 {
        let logarithm = (1.0 + sin_elevation / self.even_to) as f32;
        let logarithm = logarithm.ln() * self.per_logarithm;
        (ROWS - 1) as f32 * (LOGARITHMIC * logarithm + (1.0 - LOGARITHMIC) * sin_elevation as f32)
    }

    /// The inverse: by halving.
    pub fn sin_elevation_at(&self, row: usize) -> f64 {
        let row = if row == 0 { 1e-3 } else { row as f32 };
        let (mut low, mut high) = (0.0, 1.0);
        for _ in 0..60 {
            let middle = 0.5 * (low + high);
            if self.row_of(middle) < row {
                low = middle;
            } else {
                high = middle;
            }
        }
        high
    }

    /// Opacity to space or to the ground.
    #[inline]
    pub fn end(&self, sin_elevation: f64) -> f32 {
        let per_climb = 1.0 / sin_elevation.max(1e-20) as f32;
        mean(opacity(self.depth * per_climb, self.is_grey))
    }

    #[inline]
    pub fn place(&self, sin_elevation: f64, seen: f32) -> Place {
        let end = self.end(sin_elevation);
        let even = |part: f32| 1.0 - (1.0 - part).max(0.0).sqrt().sqrt();
        let steps = (NODES - 1) as f32;
        let along = if seen < end || self.sign > 0.0 {
            steps * even(seen / end)
        } else {
            let (nearest, farthest) = (end.max(NEAREST), 1.0 - end);
            // Even in 1 / x.
            let inverse = |more: f32| more / (more + nearest);
            steps * (1.0 + inverse(seen - end) / inverse(farthest.max(f32::MIN_POSITIVE)))
        };
        let last = if self.sign > 0.0 { 1.0 } else { 2.0 } * steps - 1.0;
        let node = along.min(last).floor();
        let far = (along - node).clamp(0.0, 1.0);
        let row = self.row_of(sin_elevation);
        let first = (row as usize).clamp(1, ROWS - 3) - 1;
        let weights = cubic_weights(row - first as f32);
        Place {
            row: first,
            node: node as usize,
            weights: weights.map(|w| [w * (1.0 - far), w * far]),
        }
    }
}

/// `1 - e^-depth`, exact where it is small.
#[inline]
pub(super) fn opacity<const N: usize>(depth: Spectrum<N>, is_grey: bool) -> Spectrum<N> {
    let of = |depth: f32| depth * Spectrum([depth]).mean_transmittance()[0];
    match is_grey {
        true => Spectrum::splat(of(depth[0])),
        false => depth * depth.mean_transmittance(),
    }
}

#[inline]
pub(super) fn mean<const N: usize>(lanes: Spectrum<N>) -> f32 {
    lanes.0.iter().sum::<f32>() / N as f32
}
