//! Reuse of colours of neighbouring pixels: section 8.
//!
//! A colour of the model depends on two angles, the elevation of the view ray and its angle to the sun. The paper computes a
//! new colour only when the viewing angle has changed by more than a threshold, chosen by the bits of a channel. Here each
//! angle is divided into cells over which no colour changes by more than `c` steps of the picture, and a colour is that of the
//! centre of its cell: half a cell away in both angles, with an error of at most `c` steps. `c` is below 1, so codes differ by
//! at most 1. Using the centre of the cell rather than its first pixel makes the result independent of the order of pixels.
//!
//! Change of a colour in steps of a picture: the sRGB curve is steepest, per relative change, at white, where
//! `d code = (2^bits - 1) * (1.055 / 2.4) * d ln x`. A dark channel on the linear part of the curve changes by
//! `(2^bits - 1) * 12.92 dx`, the same as 0.034 times `d ln x` of white. So the smaller of a channel's relative change and its
//! change divided by 0.034 times the brightest channel is sufficient as long as the brightest channel does not exceed white.
//! Red sunsets are exposed for luminance, so their red may: the bound holds for channels up to [`OVEREXPOSED`] times white.

use crate::math::interpolation::Place;
use crate::spectrum::RgbSpace;
use std::collections::HashMap;
use std::f64::consts::{FRAC_PI_2, PI};

/// Steps of a picture that a cell may span; the rest to 1 allows for changes between the nodes and for reused integrals.
const STEPS: f64 = 0.8;
/// Largest channel value relative to white.
const OVEREXPOSED: f64 = 8.0;
/// Slope of the sRGB curve at white relative to that of its linear part, for a channel of that value.
const DARK: f64 = 1.055 / 2.4 / 12.92 / OVEREXPOSED;
/// Number of nodes between which changes are measured.
const ELEVATIONS: usize = 32;
const ANGLES: usize = 64;
/// Largest number of stored colours.
const MAX_COLOURS: usize = 1 << 18;

/// Cells of both angles.
pub(super) struct Cells {
    elevation: Axis,
    angle: Axis,
}

/// Cells of one angle from 0 to `span`, uniform in the square root of the angle: number of cells up to each node.
struct Axis {
    span: f64,
    cells_below: Vec<f64>,
}

impl Axis {
    /// Cells from the changes between neighbouring nodes, in cells.
    fn new(span: f64, changes: &[f64]) -> Self {
        let mut cells_below = vec![0.0];
        let mut sum = 0.0;
        for change in changes {
            // A change of 0 would leave cells without a centre.
            sum += change.max(1e-6);
            cells_below.push(sum);
        }
        Self { span, cells_below }
    }

    fn node(span: f64, nodes: usize, i: usize) -> f64 {
        span * (i as f64 / nodes as f64).powi(2)
    }

    fn cell(&self, angle: f64) -> u32 {
        let part = (angle / self.span).clamp(0.0, 1.0);
        Place::evenly(part.sqrt(), self.cells_below.len()).value_in(&self.cells_below) as u32
    }

    fn middle(&self, cell: u32) -> f64 {
        let last = self.cells_below.len() - 1;
        let cells_below = (f64::from(cell) + 0.5).min(self.cells_below[last]);
        let Place { below, fraction } = Place::among(&self.cells_below, cells_below);
        self.span * ((below as f64 + fraction) / last as f64).powi(2)
    }
}

impl Cells {
    /// Cells for pictures with `bits` bits per channel of the colours `xyz(sin_elevation, cos_sun)`.
    pub fn new(bits: u32, mut xyz: impl FnMut(f64, f64) -> [f64; 3]) -> Self {
        let codes = 2f64.powi(bits as i32) - 1.0;
        let cell_change = STEPS / (codes * 1.055 / 2.4);
        let from_xyz = RgbSpace::Srgb.from_xyz_matrix();
        let colours: Vec<Vec<[f64; 3]>> = (0..=ELEVATIONS)
            .map(|i| {
                let sin_elevation = Axis::node(FRAC_PI_2, ELEVATIONS, i).sin();
                (0..=ANGLES)
                    .map(|k| {
                        let cos_sun = Axis::node(PI, ANGLES, k).cos();
                        crate::spectrum::rgb::apply(&from_xyz, xyz(sin_elevation, cos_sun))
                    })
                    .collect()
            })
            .collect();
        let most =
            |changes: &mut dyn Iterator<Item = f64>| changes.fold(0.0, f64::max) / cell_change;
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

/// Largest change of a channel: of its logarithm, or relative to the brightest channel if it is dark.
fn change(a: [f64; 3], b: [f64; 3]) -> f64 {
    let brightest = a.into_iter().chain(b).fold(0.0, f64::max);
    let floor = DARK * brightest;
    let of = |(a, b): (f64, f64)| (a.max(floor) / b.max(floor)).ln().abs();
    match brightest > 0.0 {
        true => a.into_iter().zip(b).map(of).fold(0.0, f64::max),
        false => 0.0,
    }
}

/// Evaluates pixels one after another, computing only colours of new cells.
pub(super) struct Walker<'a, F> {
    cells: &'a Cells,
    /// The colour by the sine of the elevation and the cosine of the angle to the sun.
    colour: F,
    known: HashMap<(u32, u32), [f64; 3]>,
    last: Option<((u32, u32), [f64; 3])>,
}

impl<'a, F: FnMut(f64, f64) -> [f64; 3]> Walker<'a, F> {
    pub fn new(cells: &'a Cells, colour: F) -> Self {
        Self {
            cells,
            colour,
            known: HashMap::new(),
            last: None,
        }
    }

    /// Colour of the cell that contains a direction.
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
        if self.known.len() >= MAX_COLOURS {
            self.known.clear();
        }
        let colour = &mut self.colour;
        let xyz = *self.known.entry(cell).or_insert_with(|| {
            let sin_elevation = elevation.middle(cell.0).sin();
            let cos_sun = angle.middle(cell.1).cos();
            colour(sin_elevation, cos_sun)
        });
        self.last = Some((cell, xyz));
        xyz
    }
}
