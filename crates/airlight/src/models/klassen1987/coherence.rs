//! Colours that are not computed again: section 8.
//!
//! A colour of the model depends on two angles, the elevation of the line of sight and its angle to the sun. The paper
//! computes no new colour until the viewing angle has changed by more than a threshold, chosen by the bits of a channel.
//! Here each angle is cut into cells over which no colour changes by more than `c` steps of the picture, and a colour is
//! that of the middle of its cell: half a cell away in both angles, it is wrong by `c` steps at most. `c` is below 1, so
//! that codes differ by 1 at most. The middle of the cell rather than its first pixel, so that it makes no difference which
//! way a picture is walked.
//!
//! How much a colour changes in steps of a picture: the sRGB curve is steepest, per relative change, at white, where
//! `d code = (2^bits - 1) * (1.055 / 2.4) * d ln x`. A channel so dark that it falls on the curve's straight part changes by
//! `(2^bits - 1) * 12.92 dx`, which is the same for a change `dx` of 0.034 times `d ln x` of white. So the relative change of a
//! channel, or its change over 0.034 times the brightest channel's, whichever is less, is enough to know while the brightest
//! channel is not brighter than white. Red sunsets are exposed for their luminance, not for their red: what they leave of
//! blue is held to the same for channels up to [`OVEREXPOSED`] times white.

use super::Klassen1987;
use super::simpson::Simpson;
use crate::math::interpolation::Place;
use crate::spectrum::RgbSpace;
use std::collections::HashMap;
use std::f64::consts::{FRAC_PI_2, PI};

/// Steps of a picture that a cell may span: what is left to 1 is for changes between the nodes and the integrals that are
/// returned again.
const STEPS: f64 = 0.8;
/// How many times brighter than white a channel may be.
const OVEREXPOSED: f64 = 8.0;
/// Slope of the sRGB curve at white against that of its straight part, for a channel so bright.
const DARK: f64 = 1.055 / 2.4 / 12.92 / OVEREXPOSED;
/// Nodes that changes are measured between.
const ELEVATIONS: usize = 32;
const ANGLES: usize = 64;
/// Colours remembered at most.
const MOST: usize = 1 << 18;

/// The cells of both angles.
pub(super) struct Cells {
    elevation: Axis,
    angle: Axis,
}

/// One angle from 0 to `span`, by the square root of its part of the span: the cells passed up to each of even steps.
struct Axis {
    span: f64,
    passed: Vec<f64>,
}

impl Axis {
    /// From the change between neighbouring nodes, in cells.
    fn new(span: f64, changes: &[f64]) -> Self {
        let mut passed = vec![0.0];
        let mut sum = 0.0;
        for change in changes {
            // A change that is none would leave cells without a middle.
            sum += change.max(1e-6);
            passed.push(sum);
        }
        Self { span, passed }
    }

    fn node(span: f64, nodes: usize, i: usize) -> f64 {
        span * (i as f64 / nodes as f64).powi(2)
    }

    fn cell(&self, angle: f64) -> u32 {
        let part = (angle / self.span).clamp(0.0, 1.0);
        Place::evenly(part.sqrt(), self.passed.len()).value_in(&self.passed) as u32
    }

    fn middle(&self, cell: u32) -> f64 {
        let last = self.passed.len() - 1;
        let passed = (f64::from(cell) + 0.5).min(self.passed[last]);
        let Place { below, fraction } = Place::among(&self.passed, passed);
        self.span * ((below as f64 + fraction) / last as f64).powi(2)
    }
}

impl Cells {
    /// The cells of a model for pictures of so many bits a channel.
    pub fn new(model: &Klassen1987, bits: u32) -> Self {
        let codes = 2f64.powi(bits as i32) - 1.0;
        let widest = STEPS / (codes * 1.055 / 2.4);
        let from_xyz = RgbSpace::Srgb.from_xyz_matrix();
        let mut simpson = Simpson::new(0.0);
        let colours: Vec<Vec<[f64; 3]>> = (0..=ELEVATIONS)
            .map(|i| {
                let sin_elevation = Axis::node(FRAC_PI_2, ELEVATIONS, i).sin();
                (0..=ANGLES)
                    .map(|k| {
                        let cos_sun = Axis::node(PI, ANGLES, k).cos();
                        let xyz = model.xyz_along(sin_elevation, cos_sun, &mut simpson);
                        crate::spectrum::rgb::apply(&from_xyz, xyz)
                    })
                    .collect()
            })
            .collect();
        let most = |changes: &mut dyn Iterator<Item = f64>| changes.fold(0.0, f64::max) / widest;
        let by_elevation: Vec<f64> = (0..ELEVATIONS)
            .map(|i| most(&mut (0..=ANGLES).map(|k| change(colours[i][k], colours[i + 1][k]))))
            .collect();
        let by_angle: Vec<f64> = (0..ANGLES)
            .map(|k| most(&mut (0..=ELEVATIONS).map(|i| change(colours[i][k], colours[i][k + 1]))))
            .collect();
        Self {
            elevation: Axis::new(FRAC_PI_2, &by_elevation),
            angle: Axis::new(PI, &by_angle),
        }
    }
}

/// The change of the channel that changes most: of its logarithm, or against the brightest where it is dark.
fn change(a: [f64; 3], b: [f64; 3]) -> f64 {
    let brightest = a.into_iter().chain(b).fold(0.0, f64::max);
    let floor = DARK * brightest;
    let of = |(a, b): (f64, f64)| (a.max(floor) / b.max(floor)).ln().abs();
    match brightest > 0.0 {
        true => a.into_iter().zip(b).map(of).fold(0.0, f64::max),
        false => 0.0,
    }
}

/// Walks over pixels, computing only colours of cells that were not seen before.
pub(super) struct Walker<'a> {
    model: &'a Klassen1987,
    cells: &'a Cells,
    simpson: Simpson,
    known: HashMap<(u32, u32), [f64; 3]>,
    last: Option<((u32, u32), [f64; 3])>,
}

impl<'a> Walker<'a> {
    pub fn new(model: &'a Klassen1987, cells: &'a Cells, alike: f32) -> Self {
        Self {
            model,
            cells,
            simpson: Simpson::new(alike),
            known: HashMap::new(),
            last: None,
        }
    }

    /// The colour of the cell of a direction.
    pub fn xyz(&mut self, sin_elevation: f64, cos_sun: f64) -> [f64; 3] {
        let Cells { elevation, angle } = self.cells;
        let cell = (
            elevation.cell(sin_elevation.clamp(0.0, 1.0).asin()),
            angle.cell(cos_sun.clamp(-1.0, 1.0).acos()),
        );
        if let Some((last, xyz)) = self.last
            && last == cell
        {
            return xyz;
        }
        if self.known.len() >= MOST {
            self.known.clear();
        }
        let (model, simpson) = (self.model, &mut self.simpson);
        let xyz = *self.known.entry(cell).or_insert_with(|| {
            let sin_elevation = elevation.middle(cell.0).sin();
            let cos_sun = angle.middle(cell.1).cos();
            model.xyz_along(sin_elevation, cos_sun, simpson)
        });
        self.last = Some((cell, xyz));
        xyz
    }
}
