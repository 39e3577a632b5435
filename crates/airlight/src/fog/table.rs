//! Fog tabulated for the rays from one eye height, for pictures.

use super::closed_forms::{Lanes, OPAQUE};
use super::fog_lanes::FogLanes;
use super::layer::MergedLayer;
use super::multiple::{self, DEGREES, Field};
use super::ray_block::{PerRay, RAYS, RayBlock, in_lanes, store};
use crate::atmosphere::RaySegment;
use crate::math::interpolation::cubic_weights;
use crate::math::simd::vectorized;
use crate::spectrum::Spectrum;
use crate::transfer::PathOptics;
use crate::transfer::residual::STREAMS;
use glam::DVec3;
use std::sync::{Arc, OnceLock};

/// Number of elevations on each side of the horizontal.
const ROWS: usize = 64;
/// Weight of the logarithm of the sine of the elevation in the spacing of rows; the rest is the weight of the sine.
const LOGARITHMIC: f32 = 0.6;
/// Number of distances up to the end of the fog or to the ground, and again beyond the ground.
const NODES: usize = 41;
/// Opacity of the first node relative to that of the last.
const NEAREST: f32 = 1e-5;
/// Logarithm of the smallest radiance.
const DARK: f32 = -80.0;

/// Fog tabulated for one eye height: [`FogLanes::path`] for many rays in a fraction of the time.
///
/// Transmittance is evaluated exactly. For the path radiance `S = (1 - T) J` the mean source function `J` is interpolated, which
/// is finite and smooth from the eye to infinity. It is the sum of multiple scattering, tabulated by azimuth mode, elevation
/// and distance, and of the streams of singly scattered sunlight ([`crate::transfer::residual`]), each a function of the angle
/// to the sun times one of elevation and distance. So neither the peak nor the azimuth needs nodes. The coordinate of distance is
/// `1 - (1 - x / x_end)^(1/4)`, where `x = 1 - T` is the opacity and `x_end` the opacity to space or to the ground.
///
/// Error compared with [`FogLanes::path`]: below 0.3 % of the path radiance (test `tables_match_direct_evaluation`). Rows are
/// computed on first use, by any thread; values do not depend on it. Fog of several profiles, over round ground, or without
/// multiple scattering is evaluated directly.
#[derive(Debug)]
pub(crate) struct TableLanes<const N: usize> {
    fog: Arc<FogLanes<N>>,
    eye_height_m: f64,
    table: Option<Table<N>>,
}

#[derive(Debug)]
struct Table<const N: usize> {
    /// Rays downwards and upwards.
    sides: [Side<N>; 2],
    /// Whether all lanes have the same extinction.
    is_grey: bool,
    sun: Option<SunSide<N>>,
}

/// The sun, prepared for the table.
#[derive(Debug)]
struct SunSide<const N: usize> {
    irradiance: Spectrum<N>,
    direction: DVec3,
    /// Horizontal unit vector towards the sun; 0 for a sun in the zenith.
    horizontal: DVec3,
}

impl<const N: usize> TableLanes<N> {
    /// Tabulates a fog for an eye height, m.
    pub fn new(fog: Arc<FogLanes<N>>, eye_height_m: f64) -> Self {
        let table = (fog.field.is_some() && fog.ground.is_flat() && fog.layers.len() == 1)
            .then(|| Table::new(&fog, eye_height_m));
        Self {
            fog,
            eye_height_m,
            table,
        }
    }

    /// Transmittance and path radiance between the eye and a point `distance_m` away (infinite for the sky) along the unit vector
    /// `direction`.
    #[inline]
    pub fn path(&self, direction: DVec3, distance_m: f64) -> PathOptics<N> {
        let fog = &*self.fog;
        let (Some(table), Some(field)) = (&self.table, &fog.field) else {
            return fog.path(self.eye_height_m, direction, distance_m);
        };
        let sun = table.sun.as_ref();
        let cos_sun = sun.map_or(0.0, |sun| direction.dot(sun.direction));
        let ray = RaySegment::flat(self.eye_height_m, direction.y, distance_m);
        let depth = fog.optical_depth(&ray);
        let opacity = opacity(depth, table.is_grey);
        let mut path_radiance = Spectrum::ZERO;
        let mean_opacity = mean(opacity);
        if mean_opacity > 0.0 {
            let side = &table.sides[usize::from(direction.y > 0.0)];
            let place = side.place(direction.y.abs(), mean_opacity);
            let rows = self.rows_at(table, field, side, &place);
            let mut source = place.interpolate(&rows, |node| node.mean);
            if let Some(sun) = sun {
                source += place.azimuth_modes(&rows, sun, direction);
            }
            // As in the field, and as cubics between rows undershoot.
            source = source.max_scalar(0.0);
            if let Some(sun) = sun {
                source += sunlit(&fog.layers[0], cos_sun, &place, &rows) * sun.irradiance;
            }
            path_radiance = opacity * source;
        }
        PathOptics {
            transmittance: match table.is_grey {
                true => Spectrum::splat(Spectrum([depth[0]]).exp_neg()[0]),
                false => depth.exp_neg(),
            },
            path_radiance,
        }
    }

    /// [`TableLanes::path`] for many rays, to rounding, in blocks.
    pub fn paths<T: From<PathOptics<N>>>(
        &self,
        directions: &[DVec3],
        distances_m: &[f64],
        out: &mut [T],
    ) {
        let (Some(table), Some(field)) = (&self.table, &self.fog.field) else {
            return self
                .fog
                .paths(self.eye_height_m, directions, distances_m, out);
        };
        vectorized(
            #[inline(always)]
            || {
                let rays = directions.chunks(RAYS).zip(distances_m.chunks(RAYS));
                for (out, (directions, distances_m)) in out.chunks_mut(RAYS).zip(rays) {
                    self.block((table, field), directions, distances_m, out);
                }
            },
        );
    }

    /// The rays of a block: [`Self::path`] in other lanes.
    #[inline(always)]
    fn block<T: From<PathOptics<N>>>(
        &self,
        (table, field): (&Table<N>, &Field<N>),
        directions: &[DVec3],
        distances_m: &[f64],
        out: &mut [T],
    ) {
        let layer = &self.fog.layers[0];
        let rays = RayBlock::new(self.eye_height_m, directions, distances_m);
        let columns_m = rays.columns_m(&layer.density);
        let opacity = in_lanes(
            layer.extinction_per_m,
            #[inline(always)]
            |extinction| {
                let depth = columns_m * extinction;
                depth * depth.mean_transmittance()
            },
        );
        let mean_opacity = mean_of(&opacity);
        let ends = table.ends(rays.sin_elevation());
        let rows = table.rows_of(rays.sin_elevation());
        let mut diffuse = [PerRay::ZERO; N];
        let mut logarithms = [[PerRay::ZERO; N]; STREAMS];
        for (i, &direction) in directions.iter().enumerate() {
            if mean_opacity[i] <= 0.0 {
                continue;
            }
            let side = &table.sides[usize::from(direction.y > 0.0)];
            let place = side.place_at(ends[i], rows[i], mean_opacity[i]);
            let rows = self.rows_at(table, field, side, &place);
            let mut source = place.interpolate(&rows, |node| node.mean);
            if let Some(sun) = &table.sun {
                source += place.azimuth_modes(&rows, sun, direction);
                for (k, logarithms) in logarithms.iter_mut().enumerate() {
                    let stream = place.interpolate(&rows, |node| node.sunlit[k]);
                    for lane in 0..N {
                        logarithms[lane][i] = stream[lane];
                    }
                }
            }
            for lane in 0..N {
                diffuse[lane][i] = source[lane];
            }
        }
        let mut source = diffuse;
        for lane in &mut source {
            *lane = lane.max_scalar(0.0);
        }
        if let Some(sun) = &table.sun {
            let mut cos_sun = [0.0; RAYS];
            for (cosine, direction) in cos_sun.iter_mut().zip(directions) {
                *cosine = direction.dot(sun.direction);
            }
            let streams = layer.streams_towards_eye_along(&cos_sun);
            for lane in 0..N {
                let mut sum = PerRay::ZERO;
                for (stream, logarithm) in streams.iter().zip(&logarithms) {
                    sum = sum.mul_acc(stream[lane], logarithm[lane].exp());
                }
                // Shares of the streams can be negative.
                source[lane] = source[lane].scale_acc(sum.max_scalar(0.0), sun.irradiance[lane]);
            }
        }
        let mut path_radiance = source;
        for (light, opacity) in path_radiance.iter_mut().zip(opacity) {
            *light = opacity * *light;
        }
        let transmittance = in_lanes(
            layer.extinction_per_m,
            #[inline(always)]
            |extinction| (columns_m * extinction).exp_neg(),
        );
        store(&transmittance, &path_radiance, out);
    }

    /// The rows of a place.
    #[inline(always)]
    fn rows_at<'t>(
        &self,
        table: &Table<N>,
        field: &Field<N>,
        side: &'t Side<N>,
        place: &Place,
    ) -> [&'t [Node<N>]; 4] {
        let mut rows: [&[Node<N>]; 4] = [&[]; 4];
        for (row, nodes) in (place.row..).zip(&mut rows) {
            *nodes = side.rows[row].get_or_init(|| self.row(table, field, side, row));
        }
        rows
    }

    /// Values of one elevation at all distances.
    fn row(&self, table: &Table<N>, field: &Field<N>, side: &Side<N>, row: usize) -> Vec<Node<N>> {
        let sin_elevation = side.sign * side.sin_elevations[row];
        let ray = RaySegment::flat(self.eye_height_m, sin_elevation, f64::INFINITY);
        let lengths_m = self.lengths_m(side, &ray);
        let ground = match side.sign < 0.0 {
            true => NODES - 1,
            false => usize::MAX,
        };
        let rays = Rays {
            fog: &self.fog,
            field,
            ray,
            lengths_m: &lengths_m,
            ground,
        };
        let opacities: Vec<Spectrum<N>> = lengths_m
            .iter()
            .map(|&length_m| {
                let depth = self.fog.optical_depth(&ray.part(0.0, length_m));
                depth * depth.mean_transmittance()
            })
            .collect();
        let per_opacity = |light: Vec<Spectrum<N>>| -> Vec<Spectrum<N>> {
            let each = light.into_iter().zip(&opacities);
            each.map(|(light, opacity)| {
                Spectrum::from_fn(|lane| match opacity[lane] > 0.0 {
                    true => light[lane] / opacity[lane],
                    false => 0.0,
                })
            })
            .collect()
        };
        let node = |mean| Node {
            mean,
            modes: [[0.0; DEGREES]; N],
            sunlit: [Spectrum::ZERO; STREAMS],
        };
        let mean = per_opacity(rays.diffuse(0));
        let mut nodes: Vec<Node<N>> = mean.into_iter().map(node).collect();
        if table.sun.is_some() {
            for m in 1..DEGREES {
                for (node, light) in nodes.iter_mut().zip(per_opacity(rays.diffuse(m))) {
                    for (lane, modes) in node.modes.iter_mut().enumerate() {
                        modes[m] = light[lane];
                    }
                }
            }
            for k in 0..STREAMS {
                for (node, light) in nodes.iter_mut().zip(per_opacity(rays.sunlit(k))) {
                    node.sunlit[k] = light.map(|v| v.max(DARK.exp()).ln());
                }
            }
        }
        nodes
    }

    /// Distances of the nodes, m.
    fn lengths_m(&self, side: &Side<N>, ray: &RaySegment) -> Vec<f64> {
        let opacity = |length_m: f64| {
            let depth = self.fog.optical_depth(&ray.part(0.0, length_m));
            mean(depth * depth.mean_transmittance())
        };
        let end = side.end(ray.sin_elevation.abs());
        let nearest = NEAREST * if end > 0.0 { end } else { 1.0 };
        let left = |node: usize| 1.0 - node as f32 / (NODES - 1) as f32;
        let mut lengths_m = vec![0.0];
        for node in 0..NODES {
            let fraction = 1.0 - left(node).powi(4);
            let from = lengths_m[lengths_m.len() - 1];
            let at = match (node == NODES - 1, side.sign > 0.0) {
                (true, true) => f64::INFINITY,
                (true, false) => (self.above_ground_m() / -ray.sin_elevation).max(from),
                _ => distance_of(&opacity, (end * fraction).max(nearest), from),
            };
            lengths_m.push(at);
        }
        if side.sign < 0.0 {
            for node in 1..NODES {
                let from = lengths_m[lengths_m.len() - 1];
                let inverse = (1.0 - left(node)) * (1.0 - end) / (1.0 - end + end.max(NEAREST));
                let target = end + inverse / (1.0 - inverse) * end.max(NEAREST);
                lengths_m.push(distance_of(&opacity, target, from));
            }
        }
        lengths_m.remove(0);
        lengths_m
    }

    fn above_ground_m(&self) -> f64 {
        (self.eye_height_m - self.fog.ground.height_m).max(0.0)
    }
}

impl<const N: usize> Table<N> {
    /// An empty table for fog of one layer over flat ground.
    fn new(fog: &FogLanes<N>, eye_height_m: f64) -> Self {
        let sun = fog.lighting.sun.filter(|sun| sun.direction.y > 0.0);
        let layer = &fog.layers[0];
        let column_m = layer.density.column_above_m(eye_height_m).min(OPAQUE);
        let above = layer.extinction_per_m * column_m as f32;
        let under = RaySegment::flat(
            eye_height_m,
            -1.0,
            (eye_height_m - fog.ground.height_m).max(0.0),
        );
        let extinction = layer.extinction_per_m;
        let is_grey = extinction.0.iter().all(|&lane| lane == extinction[0]);
        Self {
            is_grey,
            sides: [
                Side::new(-1.0, fog.optical_depth(&under), is_grey),
                Side::new(1.0, above, is_grey),
            ],
            sun: sun.map(|sun| SunSide {
                irradiance: sun.irradiance,
                direction: sun.direction,
                horizontal: (sun.direction * DVec3::new(1.0, 0.0, 1.0)).normalize_or_zero(),
            }),
        }
    }

    /// [`Side::end`] of several rays.
    #[inline(always)]
    fn ends(&self, sin_elevation: &[f64; RAYS]) -> PerRay {
        let per_sine = |i: usize| 1.0 / sin_elevation[i].abs().max(1e-20);
        let mut opacity = [PerRay::ZERO; N];
        for lane in 0..if self.is_grey { 1 } else { N } {
            let [below, above] = [0, 1].map(|side| f64::from(self.sides[side].depth[lane]));
            let depth = PerRay::from_fn(|i| {
                let vertical = if sin_elevation[i] > 0.0 { above } else { below };
                (vertical * per_sine(i)).min(OPAQUE) as f32
            });
            opacity[lane] = depth * depth.mean_transmittance();
        }
        match self.is_grey {
            true => opacity[0],
            false => mean_of(&opacity),
        }
    }

    /// [`Side::row_of`] for several rays.
    #[inline(always)]
    fn rows_of(&self, sin_elevation: &[f64; RAYS]) -> PerRay {
        let sides = self.sides.each_ref();
        let even_to = sides.map(|side| 1.0 / side.even_to);
        let per_logarithm = sides.map(|side| side.per_logarithm);
        let up = |i: usize| usize::from(sin_elevation[i] > 0.0);
        let sines = PerRay::from_fn(|i| sin_elevation[i].abs() as f32);
        let logarithms =
            PerRay::from_fn(|i| (1.0 + sin_elevation[i].abs() * even_to[up(i)]) as f32).ln();
        PerRay::from_fn(|i| {
            let logarithm = logarithms[i] * per_logarithm[up(i)];
            (ROWS - 1) as f32 * (LOGARITHMIC * logarithm + (1.0 - LOGARITHMIC) * sines[i])
        })
    }
}

/// Mean over lanes of several rays.
#[inline(always)]
fn mean_of<const N: usize>(lanes: &[PerRay; N]) -> PerRay {
    let sum = lanes.iter().fold(PerRay::ZERO, |sum, lane| sum + *lane);
    sum * (1.0 / N as f32)
}

/// Singly scattered sunlight by a layer per unit of irradiance and of opacity.
#[inline]
fn sunlit<const N: usize>(
    layer: &MergedLayer<N>,
    cos_sun: f64,
    place: &Place,
    rows: &[&[Node<N>]; 4],
) -> Spectrum<N> {
    let mut logarithms = [Spectrum::ZERO; STREAMS];
    for (row, [near, far]) in rows.iter().zip(place.weights) {
        let (from, to) = (&row[place.node].sunlit, &row[place.node + 1].sunlit);
        for (k, sum) in logarithms.iter_mut().enumerate() {
            *sum = sum.scale_acc(from[k], near).scale_acc(to[k], far);
        }
    }
    let streams = layer.streams_towards_eye(cos_sun);
    let mut sum = Spectrum::ZERO;
    for (stream, logarithm) in streams.into_iter().zip(logarithms) {
        sum = sum.mul_acc(stream, logarithm.exp());
    }
    // Shares of the streams can be negative.
    sum.max_scalar(0.0)
}

/// All rising or all descending rays.
#[derive(Debug)]
struct Side<const N: usize> {
    /// -1 or 1.
    sign: f64,
    /// Vertical optical depth to space or to the ground.
    depth: Spectrum<N>,
    is_grey: bool,
    /// Absolute sine of the elevation up to which the spacing of rows is even; beyond, it becomes partly logarithmic.
    even_to: f64,
    /// Absolute sine of the elevation of each row; nearly 0 for the first.
    sin_elevations: Vec<f64>,
    rows: Vec<OnceLock<Vec<Node<N>>>>,
    /// `1 / ln(1 + 1 / even_to)`.
    per_logarithm: f32,
}

/// Path radiance per unit of opacity along rays of one elevation to one distance.
#[derive(Debug)]
struct Node<const N: usize> {
    /// Multiple scattering, mean over azimuth.
    mean: Spectrum<N>,
    /// Multiple scattering, azimuth mode `m` divided by the `m`-th power of the cosine of the elevation; 0 for mode 0. Modes are
    /// the inner index, so that they are summed as one vector.
    modes: [[f32; DEGREES]; N],
    /// Logarithm of singly scattered sunlight by stream.
    sunlit: [Spectrum<N>; STREAMS],
}

/// Position of a ray in the table of a side.
struct Place {
    row: usize,
    node: usize,
    /// Weights of four rows at the nearer and the farther node.
    weights: [[f32; 2]; 4],
}

impl Place {
    /// Interpolates a value of the table.
    #[inline(always)]
    fn interpolate<const N: usize>(
        &self,
        rows: &[&[Node<N>]; 4],
        value: impl Fn(&Node<N>) -> Spectrum<N>,
    ) -> Spectrum<N> {
        let mut sum = Spectrum::ZERO;
        for (row, [near, far]) in rows.iter().zip(self.weights) {
            sum = sum
                .scale_acc(value(&row[self.node]), near)
                .scale_acc(value(&row[self.node + 1]), far);
        }
        sum
    }

    /// Sum of the azimuth modes above 0 in a direction.
    #[inline(always)]
    fn azimuth_modes<const N: usize>(
        &self,
        rows: &[&[Node<N>]; 4],
        sun: &SunSide<N>,
        direction: DVec3,
    ) -> Spectrum<N> {
        let mut sums = [[0.0f32; DEGREES]; N];
        for (row, [near, far]) in rows.iter().zip(self.weights) {
            let (from, to) = (&row[self.node].modes, &row[self.node + 1].modes);
            for lane in 0..N {
                for m in 0..DEGREES {
                    sums[lane][m] += near * from[lane][m] + far * to[lane][m];
                }
            }
        }
        // c^m cos(m azimuth), where c is the cosine of the elevation.
        let across = direction.dot(sun.horizontal) as f32;
        let square = (direction.x * direction.x + direction.z * direction.z) as f32;
        let mut factors = [0.0, across, 0.0, 0.0, 0.0, 0.0, 0.0, 0.0];
        let mut before = 1.0;
        for m in 2..DEGREES {
            let next = 2.0 * across * factors[m - 1] - square * before;
            (before, factors[m]) = (factors[m - 1], next);
        }
        Spectrum::from_fn(|lane| {
            let mut sum = 0.0;
            for m in 0..DEGREES {
                sum += sums[lane][m] * factors[m];
            }
            sum
        })
    }
}

impl<const N: usize> Side<N> {
    fn new(sign: f64, depth: Spectrum<N>, is_grey: bool) -> Self {
        let even_to = f64::from(0.1 * mean(depth)).clamp(1e-6, 0.05);
        let mut side = Self {
            sign,
            depth,
            is_grey,
            even_to,
            per_logarithm: (1.0 / (1.0 / even_to).ln_1p()) as f32,
            sin_elevations: Vec::new(),
            rows: std::iter::repeat_with(OnceLock::new).take(ROWS).collect(),
        };
        side.sin_elevations = (0..ROWS).map(|row| side.sin_elevation_at(row)).collect();
        side
    }

    /// Real index of the row of an absolute sine of the elevation.
    #[inline]
    fn row_of(&self, sin_elevation: f64) -> f32 {
        let logarithm = (1.0 + sin_elevation / self.even_to) as f32;
        let logarithm = logarithm.ln() * self.per_logarithm;
        (ROWS - 1) as f32 * (LOGARITHMIC * logarithm + (1.0 - LOGARITHMIC) * sin_elevation as f32)
    }

    /// Inverse of [`Side::row_of`], by bisection.
    fn sin_elevation_at(&self, row: usize) -> f64 {
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

    /// Opacity to space or to the ground at an absolute sine of the elevation.
    #[inline]
    fn end(&self, sin_elevation: f64) -> f32 {
        let per_sine = 1.0 / sin_elevation.max(1e-20);
        let depth = self
            .depth
            .map(|depth| (f64::from(depth) * per_sine).min(OPAQUE) as f32);
        mean(opacity(depth, self.is_grey))
    }

    /// Position of a ray with this absolute sine of the elevation and this opacity.
    #[inline]
    fn place(&self, sin_elevation: f64, opacity: f32) -> Place {
        self.place_at(self.end(sin_elevation), self.row_of(sin_elevation), opacity)
    }

    /// [`Self::place`] of a ray with the opacity `end` to space or to the ground, at the real index `row` of a row.
    #[inline(always)]
    fn place_at(&self, end: f32, row: f32, opacity: f32) -> Place {
        let even = |part: f32| 1.0 - (1.0 - part).max(0.0).sqrt().sqrt();
        let steps = (NODES - 1) as f32;
        let along = if opacity < end || self.sign > 0.0 {
            steps * even(opacity / end)
        } else {
            let (nearest, farthest) = (end.max(NEAREST), 1.0 - end);
            // Evenly spaced in 1 / x.
            let inverse = |more: f32| more / (more + nearest);
            steps * (1.0 + inverse(opacity - end) / inverse(farthest.max(f32::MIN_POSITIVE)))
        };
        let last = if self.sign > 0.0 { 1.0 } else { 2.0 } * steps - 1.0;
        let node = along.min(last).floor();
        let far = (along - node).clamp(0.0, 1.0);
        let first = (row as usize).clamp(1, ROWS - 3) - 1;
        let weights = cubic_weights(row - first as f32);
        Place {
            row: first,
            node: node as usize,
            weights: weights.map(|w| [w * (1.0 - far), w * far]),
        }
    }
}

/// `1 - e^-depth`, accurate for small depths.
#[inline]
fn opacity<const N: usize>(depth: Spectrum<N>, is_grey: bool) -> Spectrum<N> {
    let of = |depth: f32| depth * Spectrum([depth]).mean_transmittance()[0];
    match is_grey {
        true => Spectrum::splat(of(depth[0])),
        false => depth * depth.mean_transmittance(),
    }
}

/// Mean of all lanes.
#[inline]
fn mean<const N: usize>(lanes: Spectrum<N>) -> f32 {
    lanes.0.iter().sum::<f32>() / N as f32
}

/// Rays of one elevation to each distance of the table.
struct Rays<'a, const N: usize> {
    fog: &'a FogLanes<N>,
    field: &'a Field<N>,
    ray: RaySegment,
    lengths_m: &'a [f64],
    /// Index of the distance to the ground; `usize::MAX` for rising rays.
    ground: usize,
}

impl<const N: usize> Rays<'_, N> {
    /// Path radiance of multiple scattering for one azimuth mode, divided by the power of the cosine of the elevation: the terms
    /// of [`FogLanes::path`].
    fn diffuse(&self, mode: usize) -> Vec<Spectrum<N>> {
        let field = self.field;
        let weights = multiple::of_mode(self.ray.sin_elevation, mode);
        let scattered = |part: &RaySegment| field.scattered(part, &weights, Spectrum::ZERO);
        let (sky, ground) = match mode {
            0 => (self.fog.lighting.ambient, field.ground_radiance),
            _ => (Spectrum::ZERO, Spectrum::ZERO),
        };
        self.to_each(MergedLayer::reduced_extinction, scattered, sky, ground)
    }

    /// Path radiance of single scattering in a stream per unit of irradiance and of scattering towards the eye.
    fn sunlit(&self, stream: usize) -> Vec<Spectrum<N>> {
        let extinction = |s: &MergedLayer<N>| s.stream_extinction()[stream];
        let single = self
            .fog
            .single_scattering(|s| [extinction(s)], |_| [Spectrum::ONE]);
        let scattered = |part: &RaySegment| single.along(part, &|_| Spectrum::ZERO).0[0];
        self.to_each(extinction, scattered, Spectrum::ZERO, Spectrum::ZERO)
    }

    /// Path radiance up to each distance, from light scattered in segments and light from the sky or the ground, attenuated by an
    /// extinction: radiance at the eye minus the unscattered radiance from the far end.
    fn to_each(
        &self,
        extinction: impl Fn(&MergedLayer<N>) -> Spectrum<N>,
        scattered: impl Fn(&RaySegment) -> Spectrum<N>,
        sky: Spectrum<N>,
        ground: Spectrum<N>,
    ) -> Vec<Spectrum<N>> {
        let starts = std::iter::once(&0.0).chain(self.lengths_m);
        let parts: Vec<RaySegment> = starts
            .zip(self.lengths_m)
            .map(|(&from, &to)| self.ray.part(from, to.max(from)))
            .collect();
        let parts: Vec<(Spectrum<N>, Spectrum<N>)> = parts
            .iter()
            .map(|part| match part.length_m > 0.0 {
                true => (scattered(part), self.fog.depth_of(part, &extinction)),
                false => (Spectrum::ZERO, Spectrum::ZERO),
            })
            .collect();
        // Radiance at each distance from beyond it.
        let mut arriving = vec![
            if self.ray.sin_elevation < 0.0 {
                ground
            } else {
                sky
            };
            parts.len()
        ];
        for k in (0..parts.len() - 1).rev().filter(|&k| k < self.ground) {
            let (light, depth) = parts[k + 1];
            arriving[k] = light + depth.exp_neg() * arriving[k + 1];
        }
        let mut near = Spectrum::ZERO;
        let mut before = Spectrum::ZERO;
        let each = parts.iter().enumerate().map(|(k, (light, depth))| {
            near += before.exp_neg() * *light;
            before += *depth;
            let whole = self.ray.part(0.0, self.lengths_m[k]);
            let rest = self.fog.depth_of(&whole, &|s| {
                (s.extinction_per_m - extinction(s)).max_scalar(0.0)
            });
            near + before.exp_neg() * rest * rest.mean_transmittance() * arriving[k]
        });
        each.collect()
    }
}

/// Distance beyond `from` at which an increasing function reaches `target`, by false position (Illinois algorithm), to 1e-6 of
/// the target.
fn distance_of(rising: &impl Fn(f64) -> f32, target: f32, from: f64) -> f64 {
    let over = |at: f64| f64::from(rising(at) - target);
    let enough = 1e-6 * f64::from(target);
    let (mut low, mut below) = (from, over(from));
    if below >= -enough {
        return from;
    }
    let mut high = (2.0 * from).max(1e-6);
    let mut above = over(high);
    while above < 0.0 {
        if high > 1e12 {
            return f64::INFINITY;
        }
        (low, below) = (high, above);
        high *= 2.0;
        above = over(high);
    }
    let mut last = 0;
    for _ in 0..100 {
        if above <= enough {
            return high;
        }
        let at = ((low * above - high * below) / (above - below)).clamp(low, high);
        let here = over(at);
        if here.abs() <= enough || !(low < at && at < high) {
            return at;
        }
        if here > 0.0 {
            (high, above) = (at, here);
            if last == 1 {
                below *= 0.5;
            }
            last = 1;
        } else {
            (low, below) = (at, here);
            if last == -1 {
                above *= 0.5;
            }
            last = -1;
        }
    }
    high
}

#[cfg(test)]
mod tests;
