//! The diffuse light in a fog, and its scattering into rays.

use super::heights::{self, Weighted};
use super::legendre::{self, COUNT, DEGREES};
use super::ordinates::{self, Boundary, Cell};
use super::peak::{Kinds, PeakCell, PeakScattering, PeakSource, Rows, Solved};
use crate::atmosphere::DensityProfile;
use crate::atmosphere::RaySegment;
use crate::control::{Cancelled, Control};
use crate::fog::closed_forms::{Lanes, linear_source_mean, mean_attenuated_source};
use crate::fog::lighting::{FogLighting, Ground};
use crate::fog::ray_cuts::split_at_heights;
use crate::math::interpolation::{interval_of, lerp};
use crate::spectrum::Spectrum;
use crate::transfer::residual::STREAMS;
use std::f64::consts::PI;

/// Index of the cell below the ground, where pictures can have depth: the light there is that of endless fog of the lowest height.
const BELOW: usize = usize::MAX;

/// Optical depth of the cells of the solver.
const CELL_DEPTH: f64 = 0.05;

/// Input of the solver for a density profile: extinction and scattering without the forward peak.
#[derive(Clone, Debug)]
pub struct Reduced<const N: usize> {
    pub density: DensityProfile,
    /// Extinction without the peak, 1/m.
    pub extinction_per_m: Spectrum<N>,
    /// Scattering times its Legendre moments without the peak, 1/m.
    pub scattering_per_m: [Spectrum<N>; DEGREES],
    /// Scattering with the peak, 1/m.
    pub whole_scattering_per_m: Spectrum<N>,
    /// Scattering by the peak.
    pub peak: PeakScattering<N>,
}

impl<const N: usize> Reduced<N> {
    /// Column between two heights, m.
    fn column_between_m(&self, low_m: f64, high_m: f64) -> f64 {
        let up = RaySegment::flat(low_m, 1.0, high_m - low_m);
        self.density.column_along_m(&up)
    }

    /// Extinction of rays: all but scattering by the smallest angles, 1/m.
    #[inline(always)]
    fn seen_extinction_per_m(&self) -> Spectrum<N> {
        self.extinction_per_m + self.peak.moments[0]
    }
}

/// Factor of each moment in a direction.
pub type DirectionWeights = [f32; COUNT];

/// Source function of diffuse light by height and direction, and the light on the ground.
#[derive(Clone, Debug)]
pub struct Field<const N: usize> {
    layers: Vec<Reduced<N>>,
    /// Profiles with their mean extinctions, for interpolation between heights.
    weighted: Vec<Weighted>,
    heights_m: Vec<f64>,
    /// Optical depth above each height, by mean extinction.
    depths: Vec<f64>,
    /// Column above each height of the first profile, m.
    columns_m: Vec<f64>,
    /// Moments of the source function in each cell between two heights, at its lower and upper end.
    sources: Vec<[[Spectrum<N>; COUNT]; 2]>,
    /// Source function of what peaks scatter into rays.
    peaks: Option<PeakSource<N>>,
    /// One over the part of the extinction that rays see that is not by peaks, in the lowest cell.
    per_part_below: Spectrum<N>,
    /// Radiance of the ground.
    pub ground_radiance: Spectrum<N>,
    /// Irradiance on the ground, by sun and diffuse light.
    pub ground_irradiance: Spectrum<N>,
}

impl<const N: usize> Field<N> {
    /// Solves for the light in these layers. `sun_depth(height)` is the optical depth to the sun for each stream, of which the
    /// first has the reduced extinction; huge where the ground blocks it. Lanes from `lanes` on are copies of the last lane before.
    ///
    /// # Errors
    /// [`Cancelled`].
    pub fn solve(
        layers: Vec<Reduced<N>>,
        ground: &Ground,
        light: &FogLighting<Spectrum<N>>,
        sun_depth: impl Fn(f64) -> [Spectrum<N>; STREAMS],
        lanes: usize,
        control: Control<'_>,
    ) -> Result<Self, Cancelled> {
        let weighted: Vec<Weighted> = layers
            .iter()
            .map(|s| {
                let sum: f32 = s.extinction_per_m.0.iter().sum();
                (s.density.clone(), f64::from(sum) / N as f64)
            })
            .collect();
        let heights_m = heights::between(&weighted, ground.height_m);
        let depths = heights_m
            .iter()
            .map(|&height| heights::depth_above(&weighted, height))
            .collect();
        let column_m = |&height: &f64| layers[0].density.column_above_m(height);
        let columns_m = heights_m.iter().map(column_m).collect();
        let mut field = Self {
            columns_m,
            sources: vec![[[Spectrum::ZERO; COUNT]; 2]; heights_m.len() - 1],
            peaks: None,
            per_part_below: Spectrum::ONE,
            ground_radiance: Spectrum::ZERO,
            ground_irradiance: Spectrum::ZERO,
            layers,
            weighted,
            heights_m,
            depths,
        };
        let sun_depths: Vec<[Spectrum<N>; STREAMS]> =
            field.heights_m.iter().map(|&h| sun_depth(h)).collect();
        for lane in 0..lanes.min(N) {
            control.check()?;
            field.solve_lane(lane, light, &sun_depths);
        }
        for lane in lanes..N {
            field.copy_lane(lanes - 1, lane);
        }
        let cells = field.peak_cells();
        field.peaks = PeakSource::new(&Solved {
            cells: &cells,
            sources: &field.sources,
            sun_depths: light.sun.is_some().then_some(&sun_depths),
            ambient: light.ambient,
            ground: field.ground_radiance,
            is_one_layer: field.layers.len() == 1,
        });
        let part = cells[0].part_without_peaks();
        field.per_part_below = part.map(|part| if part > 0.0 { 1.0 / part } else { 0.0 });
        // Per optical depth that rays see.
        for (ends, cell) in field.sources.iter_mut().zip(&cells) {
            let part = cell.part_without_peaks();
            ends.iter_mut().flatten().for_each(|moment| *moment *= part);
        }
        Ok(field)
    }

    /// Heights between which the source function is interpolated, in increasing order, m.
    pub fn heights_m(&self) -> &[f64] {
        &self.heights_m
    }

    fn copy_lane(&mut self, from: usize, to: usize) {
        for moments in self.sources.iter_mut().flatten().flatten() {
            moments[to] = moments[from];
        }
        self.ground_irradiance[to] = self.ground_irradiance[from];
        self.ground_radiance[to] = self.ground_radiance[from];
    }

    fn solve_lane(
        &mut self,
        lane: usize,
        light: &FogLighting<Spectrum<N>>,
        sun_depths: &[[Spectrum<N>; STREAMS]],
    ) {
        let (sin_sun, irradiance) = match &light.sun {
            Some(sun) => (sun.direction.y, f64::from(sun.irradiance[lane])),
            None => (1.0, 0.0),
        };
        let cells: Vec<Cell> = (0..self.sources.len())
            .map(|k| self.cell(k, lane))
            .collect();
        let boundary = Boundary {
            sin_sun,
            sky: f64::from(light.ambient[lane]),
            albedo: f64::from(light.ground_albedo[lane]),
            sun_on_ground: irradiance
                * sin_sun.max(0.0)
                * f64::from(sun_depths[0][0][lane]).exp_neg(),
        };
        // The solver's cells are ordered from the top, and thinner than the stored ones.
        let mut thin = Vec::new();
        let mut stored = vec![0];
        for (k, cell) in cells.iter().enumerate().rev() {
            let [low, high] = [sun_depths[k][0][lane], sun_depths[k + 1][0][lane]].map(f64::from);
            let parts = (cell.extinction / CELL_DEPTH).ceil().clamp(1.0, 64.0);
            let step = (low - high) / parts;
            for part in 0..parts as usize {
                // Mean over the part of exponentially attenuated light.
                let depth = |part: usize| high + part as f64 * step;
                let sunlight = mean_attenuated_source(depth(part), depth(part + 1));
                thin.push(Cell {
                    extinction: cell.extinction / parts,
                    scattering: cell.scattering.map(|s| s / parts),
                    sunlight: irradiance * sunlight,
                });
            }
            stored.push(thin.len());
        }
        let solution = ordinates::solve(&thin, &boundary);
        // From the ground up.
        let at_heights: Vec<&[f64; COUNT]> =
            stored.iter().rev().map(|&k| &solution.moments[k]).collect();
        for (k, cell) in cells.iter().enumerate() {
            for (end, moments) in [at_heights[k], at_heights[k + 1]].into_iter().enumerate() {
                for m in 0..DEGREES {
                    for l in m..DEGREES {
                        let at = legendre::index(l, m);
                        let scattered = (2 * l + 1) as f64 * cell.scattering[l] * moments[at];
                        let source = if cell.extinction > 0.0 {
                            scattered / cell.extinction
                        } else {
                            0.0
                        };
                        self.sources[k][end][at][lane] = source as f32;
                    }
                }
            }
        }
        self.ground_irradiance[lane] = solution.ground_irradiance as f32;
        self.ground_radiance[lane] = (boundary.albedo * solution.ground_irradiance / PI) as f32;
    }

    /// The cell between two heights at one wavelength.
    fn cell(&self, k: usize, lane: usize) -> Cell {
        let (low, high) = (self.heights_m[k], self.heights_m[k + 1]);
        let mut cell = Cell::default();
        for layer in &self.layers {
            let column = layer.column_between_m(low, high);
            cell.extinction += f64::from(layer.extinction_per_m[lane]) * column;
            for (sum, scattering) in cell.scattering.iter_mut().zip(&layer.scattering_per_m) {
                *sum += f64::from(scattering[lane]) * column;
            }
        }
        // Coefficients are rounded to f32: thick fog must not gain light by that.
        if cell.scattering[0] > cell.extinction {
            let part = cell.extinction / cell.scattering[0];
            cell.scattering.iter_mut().for_each(|s| *s *= part);
        }
        cell
    }

    /// The cells between heights.
    fn peak_cells(&self) -> Vec<PeakCell<N>> {
        let cell = |heights_m: &[f64]| {
            let mut cell = PeakCell {
                reduced: Spectrum::ZERO,
                scattering: Spectrum::ZERO,
                peak: PeakScattering::none(),
            };
            for layer in &self.layers {
                let column = layer.column_between_m(heights_m[0], heights_m[1]) as f32;
                cell.reduced = cell.reduced.scale_acc(layer.extinction_per_m, column);
                cell.scattering = cell
                    .scattering
                    .scale_acc(layer.whole_scattering_per_m, column);
                cell.peak.add(&layer.peak, Spectrum::splat(column));
            }
            cell
        };
        self.heights_m.windows(2).map(cell).collect()
    }

    /// Diffuse light scattered into a ray, attenuated by the extinction that rays see, of all layers (`uniform` is that of uniform
    /// layers, which are not part of the field): light scattered several times, and singly scattered sunlight that peaks scatter
    /// again. `weights` and `kinds` are those of a direction: of the moments of the source function, and of the kinds of light, for a
    /// mode `m` the `m`-th power of the cosine of the elevation times `cos(m azimuth)`, for a stream the phase function towards the
    /// eye times the irradiance.
    #[inline]
    pub fn scattered(
        &self,
        ray: &RaySegment,
        weights: &DirectionWeights,
        kinds: &Kinds<N>,
        uniform: Spectrum<N>,
    ) -> [Spectrum<N>; 2] {
        let solved = |cell: usize, end: usize| self.solved(cell, end, weights);
        let Some(peaks) = &self.peaks else {
            let [light] = self.along(ray, uniform, |cell, end| [solved(cell, end)]);
            return [light, Spectrum::ZERO];
        };
        let sum = |light: &[Spectrum<N>], weights: &[Spectrum<N>]| {
            let each = light.iter().zip(weights);
            each.fold(Spectrum::ZERO, |sum, (light, weight)| {
                sum.mul_acc(*light, *weight)
            })
        };
        let ((modes, streams), rows) = (kinds.split_at(DEGREES), Rows::at(ray.sin_elevation));
        self.along(ray, uniform, |cell, end| {
            if cell == BELOW {
                return [solved(cell, end), sum(&peaks.below, streams)];
            }
            let [several, once] = peaks.at(cell, end, &rows, |light| {
                let (of_modes, of_streams) = light.split_at(DEGREES);
                [sum(of_modes, modes), sum(of_streams, streams)]
            });
            [solved(cell, end) + several, once]
        })
    }

    /// Diffuse light of one azimuth mode: [`Self::scattered`] with the weights of its moments.
    pub fn scattered_of_mode(
        &self,
        ray: &RaySegment,
        weights: &DirectionWeights,
        mode: usize,
    ) -> Spectrum<N> {
        let rows = Rows::at(ray.sin_elevation);
        let [light] = self.along(ray, Spectrum::ZERO, |cell, end| {
            let solved = self.solved(cell, end, weights);
            [match &self.peaks {
                Some(peaks) if cell != BELOW => {
                    solved + peaks.at(cell, end, &rows, |kinds| [kinds[mode]])[0]
                }
                _ => solved,
            }]
        });
        light
    }

    /// Source function of the solver at an end of a cell in the direction of weights.
    #[inline(always)]
    fn solved(&self, cell: usize, end: usize, weights: &DirectionWeights) -> Spectrum<N> {
        match cell {
            BELOW => weighted(&self.sources[0][0], weights) * self.per_part_below,
            _ => weighted(&self.sources[cell][end], weights),
        }
    }

    /// Light of one stream that peaks scatter into a ray, by its kind.
    pub fn scattered_by_peaks(&self, ray: &RaySegment, kind: usize) -> Spectrum<N> {
        let Some(peaks) = &self.peaks else {
            return Spectrum::ZERO;
        };
        let rows = Rows::at(ray.sin_elevation);
        let source = |cell, end| match cell {
            BELOW => [peaks.below[kind - DEGREES]],
            _ => peaks.at(cell, end, &rows, |kinds| [kinds[kind]]),
        };
        let [light] = self.along(ray, Spectrum::ZERO, source);
        light
    }

    /// Integrals along a ray of source functions, given at the lower and upper end of each cell, attenuated by the extinction that
    /// rays see, of the layers and of uniform fog.
    #[inline(always)]
    fn along<const K: usize>(
        &self,
        ray: &RaySegment,
        uniform: Spectrum<N>,
        source: impl Fn(usize, usize) -> [Spectrum<N>; K],
    ) -> [Spectrum<N>; K] {
        if let [layer] = &self.layers[..]
            && ray.curvature_per_m == 0.0
            && ray.sin_elevation.abs() > 1e-3
            && uniform == Spectrum::ZERO
        {
            return self.along_in_single_layer(layer, ray, source);
        }
        let mut path = [Spectrum::ZERO; K];
        let mut before = Spectrum::ZERO;
        split_at_heights(ray, &self.heights_m, |part| {
            let inside = part.height_at(0.5 * part.length_m.min(1e9));
            let k = interval_of(&self.heights_m, inside);
            let along = self.layers.iter().fold(Spectrum::ZERO, |sum, layer| {
                let column = layer.density.column_along_m(part).min(1e25);
                sum.scale_acc(layer.seen_extinction_per_m(), column as f32)
            });
            let [near, far] = match inside < self.heights_m[0] {
                true => [source(BELOW, 0); 2],
                false => [part.height_m, part.end_height_m()]
                    .map(|height_m| self.between_ends(k, height_m, &source)),
            };
            let whole = along.scale_acc(uniform, part.length_m.min(1e25) as f32);
            let (w_near, w_far) = linear_source_mean(whole);
            let scattered = before.exp_neg() * along;
            for k in 0..K {
                path[k] += scattered * (w_near * near[k] + w_far * far[k]);
            }
            before += whole;
            before.min_element() < 17.0
        });
        path
    }

    /// [`Self::along`] in one profile over flat ground. The coordinate of height is the vertical column: optical depth along a ray
    /// is linear in it, and so is the source function between two heights.
    #[inline(always)]
    fn along_in_single_layer<const K: usize>(
        &self,
        layer: &Reduced<N>,
        ray: &RaySegment,
        source: impl Fn(usize, usize) -> [Spectrum<N>; K],
    ) -> [Spectrum<N>; K] {
        let column_m = |height_m: f64| layer.density.column_above_m(height_m).min(1e25);
        let per_m = layer.seen_extinction_per_m() * (1.0 / ray.sin_elevation.abs()) as f32;
        let (from, to) = (column_m(ray.height_m), column_m(ray.end_height_m()));
        // Columns decrease with height: count the heights with a larger column than the start.
        let above = self.columns_m.partition_point(|&column| column > from);
        let last = self.columns_m.len() - 1;
        // At a height in the cell below it (above it at the ground).
        let node = |k: usize| match k {
            0 => source(0, 0),
            _ => source(k - 1, 1),
        };
        let between = |k: usize, column: f64| {
            // In the cell below height `k`, clamped to its ends.
            let (low, high) = (self.columns_m[k - 1], self.columns_m[k]);
            let up = match low > high {
                true => ((low - column) / (low - high)).clamp(0.0, 1.0) as f32,
                false => 0.0,
            };
            lerp_each(node(k - 1), node(k), up)
        };
        let mut path = [Spectrum::ZERO; K];
        let mut before = Spectrum::ZERO;
        let mut column = from;
        let mut near = between(above.clamp(1, last), from);
        let rises = ray.sin_elevation > 0.0;
        let mut next = if rises { above } else { above.wrapping_sub(1) };
        loop {
            // Continue to the next height or the end of the ray.
            let passes = match self.columns_m.get(next) {
                Some(&column) => (rises && column > to) || (!rises && column < to),
                None => false,
            };
            let (until, far) = if passes {
                (self.columns_m[next], node(next))
            } else {
                let k = if rises { next } else { next.wrapping_add(1) };
                (to, between(k.clamp(1, last), to))
            };
            let along = per_m * (column - until).abs() as f32;
            let (w_near, w_far) = linear_source_mean(along);
            let scattered = before.exp_neg() * along;
            let is_below = column.min(until) >= self.columns_m[0] && column != until;
            let [from, to] = match is_below {
                true => [source(BELOW, 0); 2],
                false => [near, far],
            };
            for k in 0..K {
                path[k] += scattered * (w_near * from[k] + w_far * to[k]);
            }
            before += along;
            if !passes || before.min_element() > 17.0 {
                return path;
            }
            (column, near) = (until, far);
            next = if rises {
                next + 1
            } else {
                next.wrapping_sub(1)
            };
        }
    }

    /// Source functions at a height in or next to cell `k`, given at the ends of cells.
    #[inline]
    fn between_ends<const K: usize>(
        &self,
        k: usize,
        height_m: f64,
        source: impl Fn(usize, usize) -> [Spectrum<N>; K],
    ) -> [Spectrum<N>; K] {
        let sum = |end: usize| source(k, end);
        let (low, high) = (self.heights_m[k], self.heights_m[k + 1]);
        let slack = 1e-7 * (high - low);
        if height_m <= low + slack {
            return sum(0);
        }
        if height_m >= high - slack {
            return sum(1);
        }
        let depth = heights::depth_above(&self.weighted, height_m);
        let whole = self.depths[k] - self.depths[k + 1];
        // Without fog between the heights the source function is 0 at both.
        let up = match whole > 0.0 {
            true => ((self.depths[k] - depth) / whole).clamp(0.0, 1.0),
            false => 0.0,
        };
        lerp_each(sum(0), sum(1), up as f32)
    }
}

/// Linear interpolation of each of several spectra.
#[inline(always)]
fn lerp_each<const N: usize, const K: usize>(
    near: [Spectrum<N>; K],
    far: [Spectrum<N>; K],
    fraction: f32,
) -> [Spectrum<N>; K] {
    std::array::from_fn(|k| lerp(near[k], far[k], fraction))
}

/// Source function in a direction: weighted sum of its moments.
#[inline]
fn weighted<const N: usize>(
    moments: &[Spectrum<N>; COUNT],
    weights: &DirectionWeights,
) -> Spectrum<N> {
    let mut sum = Spectrum::ZERO;
    for (moment, &weight) in moments.iter().zip(weights) {
        sum = sum.scale_acc(*moment, weight);
    }
    sum
}
