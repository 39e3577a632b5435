//! Light that forward peaks scatter into a ray whose surroundings are not as bright as itself.
//!
//! The solver counts light in the forward peak as unscattered ([`crate::transfer::delta_m`]), which is right where the light
//! is uniform over the width of the peak. In thin fog it is not: level rays are bright and steeper ones dark, and the peak of a
//! phase function of asymmetry 0.8 is wider than the bright band along the horizon. So rays count as unscattered only what is
//! scattered by angles smaller than [`ORDERS`] moments resolve, with the coefficient `n`. With `I` the light in the fog in all
//! directions, `J` its source function in the solver, and `P` the operator that scatters by the rest of the peak,
//!
//! ```text
//! dI/ds = -(k - n) I + (k - f) J + P I
//! ```
//!
//! where `k` is the extinction and `f` the scattering by the whole peak. `P` multiplies the Legendre moments of `I` by `f - n` up
//! to the degrees that the solver keeps, and beyond them by those of the phase function, less `n`. It leaves uniform light as it is.
//!
//! `P I` is computed from the light in 96 directions of each azimuth mode, first that of the solver and then that of this equation.
//! Streams of singly scattered sunlight ([`crate::transfer::residual`]) are treated as the modes: of the part of a stream that the
//! peak keeps, scattering changes the elevation only.

use super::legendre::{self, COUNT, DEGREES};
use crate::fog::closed_forms::{Lanes, linear_source_mean, mean_attenuated_source};
use crate::math::quadrature::FixedRule;
use crate::math::simd::vectorized;
use crate::spectrum::Spectrum;
use crate::transfer::residual::{STREAMS, kept_by_peak};
use std::sync::LazyLock;

/// Number of moments of the peak.
pub const ORDERS: usize = 128;
/// Number of streams of which the peak keeps light.
pub const KEPT: usize = STREAMS - 1;
/// Kinds of light: azimuth modes, and streams of singly scattered sunlight.
pub const KINDS: usize = DEGREES + KEPT;
/// Number of elevations on each side of the horizontal.
const ELEVATIONS: usize = 48;
/// Number of directions, by increasing elevation.
const ROWS: usize = 2 * ELEVATIONS;
/// Smallest moment of a peak that matters, relative to the first.
const MIN_MOMENT: f32 = 1e-4;
/// Number of times that the light is computed with what the peak adds to it.
const ITERATIONS: usize = 2;

static RULE: FixedRule<ELEVATIONS> = FixedRule::fixed();

/// Lanes of a vector of degrees or of elevations.
const LANES: usize = 8;
/// Largest number of degrees of one parity.
const HALF: usize = ORDERS / 2;

/// Associated Legendre functions at the elevations above the horizontal, divided by the power of the cosine of the elevation, by
/// mode and by the parity of `l + m`, of which the even ones are even functions.
struct Basis {
    /// For each degree.
    values: Vec<[Spectrum<LANES>; ELEVATIONS / LANES]>,
    /// For each elevation, the weights of an integral over its sine of a function times `(2 l + 1) / 2` times the value.
    moments: Vec<[Spectrum<LANES>; HALF / LANES]>,
}

static BASIS: LazyLock<Basis> = LazyLock::new(|| {
    let mut basis = Basis {
        values: vec![[Spectrum::ZERO; ELEVATIONS / LANES]; DEGREES * 2 * HALF],
        moments: vec![[Spectrum::ZERO; HALF / LANES]; DEGREES * 2 * ELEVATIONS],
    };
    for (q, (mu, weight)) in RULE.iter().enumerate() {
        for m in 0..DEGREES {
            let power = (1.0 - mu * mu).powi(m as i32);
            let functions = legendre::degrees_of_mode(mu, m, ORDERS);
            for (l, y) in functions.into_iter().enumerate().skip(m) {
                let (block, j) = (2 * m + (l - m) % 2, (l - m) / 2);
                basis.values[block * HALF + j][q / LANES][q % LANES] = y as f32;
                let scale = 0.5 * (2 * l + 1) as f64 * weight * power;
                basis.moments[block * ELEVATIONS + q][j / LANES][j % LANES] = (scale * y) as f32;
            }
        }
    }
    basis
});

impl Basis {
    /// `P I` at the elevations above the horizontal for the part of the light `I` there that is even or odd, in `mode`, with the
    /// moments of the peak by degree of that parity, of which the first `8 vectors` count.
    #[inline(always)]
    fn scattered(
        &self,
        mode: usize,
        parity: usize,
        light: &[f32; ELEVATIONS],
        peak: &[f32; HALF],
        vectors: usize,
    ) -> [Spectrum<LANES>; ELEVATIONS / LANES] {
        let block = 2 * mode + parity;
        let mut moments = [Spectrum::ZERO; HALF / LANES];
        for (weights, light) in self.moments[block * ELEVATIONS..].iter().zip(light) {
            for k in 0..vectors {
                moments[k] = moments[k].scale_acc(weights[k], *light);
            }
        }
        let mut sums = [Spectrum::ZERO; ELEVATIONS / LANES];
        for j in 0..vectors * LANES {
            let moment = moments[j / LANES][j % LANES] * peak[j];
            for (sum, values) in sums.iter_mut().zip(&self.values[block * HALF + j]) {
                *sum = sum.scale_acc(*values, moment);
            }
        }
        sums
    }
}

/// Scattering by the forward peaks of a layer, 1/m, or the optical depth by it in a cell.
#[derive(Clone, Debug)]
pub struct PeakScattering<const N: usize> {
    /// Legendre moments times scattering, from which [`Self::narrow`] is subtracted.
    pub moments: Vec<Spectrum<N>>,
    /// Scattering by angles that the moments do not resolve.
    pub narrow: Spectrum<N>,
}

impl<const N: usize> PeakScattering<N> {
    /// No scattering.
    pub fn none() -> Self {
        Self {
            moments: vec![Spectrum::ZERO; ORDERS],
            narrow: Spectrum::ZERO,
        }
    }

    /// Adds another one times a scattering coefficient or a column.
    pub fn add(&mut self, other: &Self, length_m: Spectrum<N>) {
        for (moment, other) in self.moments.iter_mut().zip(&other.moments) {
            *moment = moment.mul_acc(*other, length_m);
        }
        self.narrow = self.narrow.mul_acc(other.narrow, length_m);
    }

    /// All scattering by peaks.
    pub fn whole(&self) -> Spectrum<N> {
        self.moments[0] + self.narrow
    }
}

/// Number of vectors of degrees that hold the moments of all cells.
fn vectors_of<const N: usize>(cells: &[PeakCell<N>]) -> usize {
    let counts = |cell: &PeakCell<N>, l: usize| {
        let (all, moment) = (&cell.peak.moments[0], &cell.peak.moments[l]);
        (0..N).any(|lane| moment[lane].abs() > MIN_MOMENT * all[lane])
    };
    let degrees = (0..ORDERS)
        .rev()
        .find(|&l| cells.iter().any(|cell| counts(cell, l)))
        .map_or(0, |l| l + 1);
    degrees.div_ceil(2 * LANES)
}

/// Part of the light of a kind that the peak keeps.
const fn kept(kind: usize) -> f32 {
    match kind < DEGREES {
        true => 1.0,
        false => kept_by_peak(kind - DEGREES),
    }
}

/// Azimuth mode of a kind.
const fn mode(kind: usize) -> usize {
    if kind < DEGREES { kind } else { 0 }
}

/// Optical depths of a cell between two heights, along the vertical.
#[derive(Clone, Debug)]
pub struct PeakCell<const N: usize> {
    /// Extinction without peaks.
    pub reduced: Spectrum<N>,
    /// All scattering.
    pub scattering: Spectrum<N>,
    pub peak: PeakScattering<N>,
}

impl<const N: usize> PeakCell<N> {
    /// Extinction of a ray: what is not scattered by small angles.
    #[inline(always)]
    fn seen(&self) -> Spectrum<N> {
        self.reduced + self.peak.moments[0]
    }

    /// Extinction without peaks relative to that of a ray.
    pub fn part_without_peaks(&self) -> Spectrum<N> {
        let seen = self.seen();
        Spectrum::from_fn(|lane| match seen[lane] > 0.0 {
            true => self.reduced[lane] / seen[lane],
            false => 0.0,
        })
    }

    /// Extinction of a kind of light, where scattering `unscattered` by peaks counts as none as far as the peak keeps the light.
    #[inline(always)]
    fn extinction(&self, kind: usize, unscattered: Spectrum<N>) -> Spectrum<N> {
        self.reduced + self.peak.whole() - unscattered * kept(kind)
    }
}

/// The light that the solver found.
pub struct Solved<'a, const N: usize> {
    /// From the ground up.
    pub cells: &'a [PeakCell<N>],
    /// Moments of the source function in each cell, at its lower and upper end.
    pub sources: &'a [[[Spectrum<N>; COUNT]; 2]],
    /// Optical depth to the sun at each height, by stream; `None` without a sun.
    pub sun_depths: Option<&'a [[Spectrum<N>; STREAMS]]>,
    /// Radiance from above the fog.
    pub ambient: Spectrum<N>,
    /// Radiance of the ground.
    pub ground: Spectrum<N>,
    /// Whether all cells are of the same medium.
    pub is_one_layer: bool,
}

/// Light in a direction at a height, by kind; that of a mode `m` is divided by the `m`-th power of the cosine of the elevation.
pub type Kinds<const N: usize> = [Spectrum<N>; KINDS];

/// Source function of the light that peaks scatter into rays.
#[derive(Clone, Debug)]
pub struct PeakSource<const N: usize> {
    /// For each end of each cell and each row, per optical depth that rays see.
    values: Vec<Kinds<N>>,
    /// Of the streams, per optical depth, along endless rays at the lowest height.
    pub below: [Spectrum<N>; KEPT],
}

/// Weights of four rows around a direction.
#[derive(Clone, Copy, Debug)]
pub struct Rows {
    first: usize,
    weights: [f32; 4],
}

/// Sine of the elevation of a row.
fn sine_of(row: usize) -> f64 {
    match row < ELEVATIONS {
        true => -RULE.pairs()[ELEVATIONS - 1 - row].0,
        false => RULE.pairs()[row - ELEVATIONS].0,
    }
}

static SINES: LazyLock<[f64; ROWS]> = LazyLock::new(|| std::array::from_fn(sine_of));

impl Rows {
    /// Those of a cubic through the rows around the sine of an elevation.
    #[inline]
    pub fn at(sin_elevation: f64) -> Self {
        let sines = &*SINES;
        let x = sin_elevation.clamp(sines[0], sines[ROWS - 1]);
        let first = sines.partition_point(|sine| *sine <= x).clamp(2, ROWS - 2) - 2;
        let weight = |k: usize| -> f64 {
            let others = (0..4).filter(|&j| j != k);
            let factor = |j: usize| (x - sines[first + j]) / (sines[first + k] - sines[first + j]);
            others.map(factor).product()
        };
        Self {
            first,
            weights: std::array::from_fn(|k| weight(k) as f32),
        }
    }
}

impl<const N: usize> PeakSource<N> {
    /// The source in fog whose light is solved for; `None` if no moment of a peak matters.
    pub fn new(solved: &Solved<N>) -> Option<Self> {
        let vectors = vectors_of(solved.cells);
        (vectors > 0).then(|| {
            vectorized(
                #[inline(always)]
                || {
                    let mut source = Self {
                        values: vec![[Spectrum::ZERO; KINDS]; solved.cells.len() * 2 * ROWS],
                        below: solved.along_the_ground(),
                    };
                    source.scatter(solved, &solved.light(None), vectors);
                    for _ in 1..ITERATIONS {
                        let light = solved.light(Some(&source));
                        source.scatter(solved, &light, vectors);
                    }
                    source
                },
            )
        })
    }

    /// `P light` at the ends of all cells, per optical depth, from the first `vectors` of degrees.
    #[inline(always)]
    fn scatter(&mut self, solved: &Solved<N>, light: &[Kinds<N>], vectors: usize) {
        let basis = &*BASIS;
        let cells = solved.cells;
        for node in 0..=cells.len() {
            // The cell above the height, and the one below it.
            let sides = [(node, 0), (node.wrapping_sub(1), 1)];
            let mut first = None;
            for (cell, end) in sides.into_iter().filter(|(cell, _)| *cell < cells.len()) {
                let rows = (2 * cell + end) * ROWS;
                if let Some(first) = first.filter(|_| solved.is_one_layer) {
                    self.values.copy_within(first..first + ROWS, rows);
                    continue;
                }
                first = Some(rows);
                let (peak, seen) = (&cells[cell].peak, cells[cell].seen());
                let light = &light[node * ROWS..(node + 1) * ROWS];
                for kind in 0..KINDS {
                    let m = mode(kind);
                    for lane in 0..N {
                        let per_depth = match seen[lane] > 0.0 {
                            true => kept(kind) / seen[lane],
                            false => 0.0,
                        };
                        let [even, odd] = [0, 1].map(
                            #[inline(always)]
                            |parity| {
                                let sign = 1.0 - 2.0 * parity as f32;
                                let mut part = [0.0; ELEVATIONS];
                                for q in 0..ELEVATIONS {
                                    let [down, up] = both(q).map(|row| light[row][kind][lane]);
                                    part[q] = up + sign * down;
                                }
                                let mut moments = [0.0; HALF];
                                for (j, moment) in moments.iter_mut().enumerate() {
                                    *moment = match peak.moments.get(m + parity + 2 * j) {
                                        Some(moment) => moment[lane],
                                        None => 0.0,
                                    };
                                }
                                basis.scattered(m, parity, &part, &moments, vectors)
                            },
                        );
                        for q in 0..ELEVATIONS {
                            let [even, odd] = [even, odd].map(|sums| sums[q / LANES][q % LANES]);
                            let [down, up] = both(q);
                            self.values[rows + down][kind][lane] = (even - odd) * per_depth;
                            self.values[rows + up][kind][lane] = (even + odd) * per_depth;
                        }
                    }
                }
            }
        }
    }

    /// Sums over kinds of light of the source function at an end of a cell in a direction.
    #[inline(always)]
    pub fn at<const K: usize>(
        &self,
        cell: usize,
        end: usize,
        rows: &Rows,
        sums: impl Fn(&Kinds<N>) -> [Spectrum<N>; K],
    ) -> [Spectrum<N>; K] {
        let values = &self.values[(2 * cell + end) * ROWS + rows.first..][..4];
        let mut all = [Spectrum::ZERO; K];
        for (kinds, weight) in values.iter().zip(rows.weights) {
            for (all, sum) in all.iter_mut().zip(sums(kinds)) {
                *all = all.scale_acc(sum, weight);
            }
        }
        all
    }
}

/// Rows of an elevation below the horizontal and above it.
#[inline(always)]
const fn both(q: usize) -> [usize; 2] {
    [ELEVATIONS - 1 - q, ELEVATIONS + q]
}

impl<const N: usize> Solved<'_, N> {
    /// What the peak scatters of the streams into endless rays at the lowest height, per optical depth.
    fn along_the_ground(&self) -> [Spectrum<N>; KEPT] {
        let mut light = [Spectrum::ZERO; KEPT];
        let (Some(sun_depths), cell) = (self.sun_depths, &self.cells[0]) else {
            return light;
        };
        for (stream, light) in light.iter_mut().enumerate() {
            let kind = DEGREES + stream;
            let sunlight = sun_depths[0][stream].exp_neg();
            let extinction = cell.extinction(kind, cell.peak.whole());
            let scattered = cell.peak.moments[0] * kept(kind) * cell.scattering * sunlight;
            let attenuation = cell.seen() * extinction;
            *light = Spectrum::from_fn(|lane| match attenuation[lane] > 0.0 {
                true => scattered[lane] / attenuation[lane],
                false => 0.0,
            });
        }
        light
    }

    /// The light at all heights and in all directions: that of the solver, or that with a source by peaks.
    #[inline(always)]
    fn light(&self, peaks: Option<&PeakSource<N>>) -> Vec<Kinds<N>> {
        let basis = &*BASIS;
        let cells = self.cells;
        let mut all = vec![[Spectrum::ZERO; KINDS]; (cells.len() + 1) * ROWS];
        for row in 0..ROWS {
            let sine = SINES[row];
            let rises = sine > 0.0;
            let per_sine = (1.0 / sine.abs()) as f32;
            let q = if rises {
                row - ELEVATIONS
            } else {
                ELEVATIONS - 1 - row
            };
            // From the edge of the fog on.
            let mut light = [Spectrum::ZERO; KINDS];
            light[0] = if rises { self.ambient } else { self.ground };
            all[if rises { cells.len() } else { 0 } * ROWS + row] = light;
            for step in 0..cells.len() {
                // Ends near the eye and far from it.
                let (k, [near, far]) = match rises {
                    true => (cells.len() - 1 - step, [0, 1]),
                    false => (step, [1, 0]),
                };
                let cell = &cells[k];
                let unscattered = match peaks {
                    Some(_) => cell.peak.narrow,
                    None => cell.peak.whole(),
                };
                let by_peaks = |kind: usize, end: usize| match peaks {
                    Some(peaks) => peaks.values[(2 * k + end) * ROWS + row][kind],
                    None => Spectrum::ZERO,
                };
                let seen = cell.seen() * per_sine;
                let emitting = cell.reduced * per_sine;
                let depth = cell.extinction(0, unscattered) * per_sine;
                let (w_near, w_far) = linear_source_mean(depth);
                let transmittance = depth.exp_neg();
                for m in 0..DEGREES {
                    let source = |end: usize| {
                        let mut sum = Spectrum::ZERO;
                        for l in m..DEGREES {
                            let (parity, j) = ((l - m) % 2, (l - m) / 2);
                            let y = basis.values[(2 * m + parity) * HALF + j][q / LANES][q % LANES];
                            let y = if !rises && parity == 1 { -y } else { y };
                            sum = sum.scale_acc(self.sources[k][end][legendre::index(l, m)], y);
                        }
                        emitting * sum + seen * by_peaks(m, end)
                    };
                    let added = w_near * source(near) + w_far * source(far);
                    light[m] = added.mul_acc(light[m], transmittance);
                }
                for stream in 0..if self.sun_depths.is_some() { KEPT } else { 0 } {
                    let kind = DEGREES + stream;
                    let depth = cell.extinction(kind, unscattered) * per_sine;
                    let to_sun = |end: usize| match self.sun_depths {
                        Some(depths) => depths[k + end][stream],
                        None => Spectrum::ZERO,
                    };
                    let sunlight = mean_attenuated_source(to_sun(near), to_sun(far) + depth);
                    let (w_near, w_far) = linear_source_mean(depth);
                    let by_peaks = w_near * by_peaks(kind, near) + w_far * by_peaks(kind, far);
                    let added = cell.scattering * per_sine * sunlight + seen * by_peaks;
                    light[kind] = added.mul_acc(light[kind], depth.exp_neg());
                }
                all[(k + near) * ROWS + row] = light;
            }
        }
        all
    }
}
