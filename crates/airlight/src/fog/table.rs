//! Fog tabulated for the rays from one eye height, for pictures.

use super::closed_forms::{Lanes, OPAQUE};
use super::fog_lanes::FogLanes;
use super::layer::StreamedPhase;
use super::lighting::DirectionalLight;
use super::multiple::{self, DEGREES, Field, KEPT};
use super::ray_block::{RAYS, RayBlock, in_lanes, store};
use super::rays::Rays;
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
    /// Phase functions of the layers, each once.
    phases: Vec<StreamedPhase<N>>,
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
            phases: StreamedPhase::of(&fog.layers),
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
        let ray = RaySegment::flat(self.eye_height_m, direction.y, distance_m);
        let column_m = fog.layers[0].density.column_along_m(&ray).min(OPAQUE);
        let columns_m = Spectrum([column_m as f32]);
        let rays = self.along((table, field), columns_m, &[direction]);
        let first = |lanes: [Spectrum<1>; N]| Spectrum::from_fn(|lane| lanes[lane][0]);
        PathOptics {
            transmittance: first(rays.transmittance),
            path_radiance: first(rays.path_radiance),
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

    /// The rays of a block.
    #[inline(always)]
    fn block<T: From<PathOptics<N>>>(
        &self,
        parts: (&Table<N>, &Field<N>),
        directions: &[DVec3],
        distances_m: &[f64],
        out: &mut [T],
    ) {
        let rays = RayBlock::new(self.eye_height_m, directions, distances_m);
        let columns_m = rays.columns_m(&self.fog.layers[0].density);
        let rays = self.along(parts, columns_m, directions);
        store(&rays.transmittance, &rays.path_radiance, out);
    }

    /// Optics of at most R rays with columns of density.
    #[inline(always)]
    fn along<const R: usize>(
        &self,
        (table, field): (&Table<N>, &Field<N>),
        columns_m: Spectrum<R>,
        directions: &[DVec3],
    ) -> RayOptics<N, R> {
        let layer = &self.fog.layers[0];
        let opacity = in_lanes(
            layer.extinction_per_m,
            #[inline(always)]
            |extinction| {
                let depth = columns_m * extinction;
                depth * depth.mean_transmittance()
            },
        );
        let mut sin_elevation = [0.0; R];
        for (sine, direction) in sin_elevation.iter_mut().zip(directions) {
            *sine = direction.y;
        }
        let places = table.places(&sin_elevation, mean_of(&opacity));
        let mut sums = [*Node::<N>::ZERO; R];
        let has_sun = table.sun.is_some();
        let azimuths: [Values; R] = match &table.sun {
            Some(sun) => azimuth_factors(sun.horizontal, directions),
            None => [Values::ZERO; R],
        };
        let mut rows = Rows {
            side: &table.sides[0],
            first: usize::MAX,
            nodes: [&[]; 4],
        };
        for (i, sine) in sin_elevation.iter().enumerate().take(directions.len()) {
            let side = &table.sides[usize::from(*sine > 0.0)];
            let (first, node) = (places.first[i] as usize, places.node[i] as usize);
            if rows.first != first || !std::ptr::eq(rows.side, side) {
                rows = self.rows_at(table, field, side, first);
            }
            let (mut nodes, mut weights) = ([[Node::ZERO; 2]; 4], [[0.0; 2]; 4]);
            for r in 0..4 {
                if let [from, to, ..] = &rows.nodes[r][node..] {
                    nodes[r] = [from, to];
                }
                weights[r] = [places.weights[r][0][i], places.weights[r][1][i]];
            }
            // Whole vectors into memory: the compiler would otherwise compute the few numbers that are used one by one.
            let sum = &mut sums[i];
            for lane in 0..N {
                let mut modes = Values::ZERO;
                for r in 0..4 {
                    let [from, to] = nodes[r];
                    modes.add(&from.modes[lane], &to.modes[lane], weights[r]);
                }
                sum.modes[lane] = modes;
            }
            for lane in 0..if has_sun { N } else { 0 } {
                let mut sunlit = Values::ZERO;
                for r in 0..4 {
                    let [from, to] = nodes[r];
                    sunlit.add(&from.sunlit[lane], &to.sunlit[lane], weights[r]);
                }
                sum.sunlit[lane] = sunlit;
            }
        }
        let mut source = [Spectrum::<R>::ZERO; N];
        for lane in 0..N {
            for i in 0..R {
                source[lane][i] = match has_sun {
                    true => sums[i].modes[lane].dot(&azimuths[i]),
                    false => sums[i].modes[lane].0[0],
                };
            }
        }
        // As in the field, and as cubics between rows undershoot.
        for lane in &mut source {
            *lane = lane.max_scalar(0.0);
        }
        if let Some(sun) = &table.sun {
            let mut cos_sun = [0.0; R];
            for (cosine, direction) in cos_sun.iter_mut().zip(directions) {
                *cosine = direction.dot(sun.direction);
            }
            let streams = layer.streams_towards_eye_along(&cos_sun);
            for lane in 0..N {
                let mut sum = Spectrum::ZERO;
                for k in 0..STREAMS {
                    let mut logarithms = Spectrum::<R>::ZERO;
                    for i in 0..R {
                        logarithms[i] = sums[i].sunlit[lane].0[k];
                    }
                    sum = sum.mul_acc(streams[k][lane], logarithms.exp());
                }
                for k in 0..KEPT {
                    let mut again = Spectrum::<R>::ZERO;
                    for i in 0..R {
                        again[i] = sums[i].sunlit[lane].0[STREAMS + k];
                    }
                    sum = sum.mul_acc(streams[k][lane], again);
                }
                // Shares of the streams can be negative.
                source[lane] = source[lane].scale_acc(sum.max_scalar(0.0), sun.irradiance[lane]);
            }
        }
        for (light, opacity) in source.iter_mut().zip(opacity) {
            *light = opacity * *light;
        }
        RayOptics {
            transmittance: in_lanes(
                layer.extinction_per_m,
                #[inline(always)]
                |extinction| (columns_m * extinction).exp_neg(),
            ),
            path_radiance: source,
        }
    }

    /// Four rows from an index on.
    fn rows_at<'t>(
        &self,
        table: &Table<N>,
        field: &Field<N>,
        side: &'t Side<N>,
        first: usize,
    ) -> Rows<'t, N> {
        let mut nodes: [&[Node<N>]; 4] = [&[]; 4];
        for (row, nodes) in (first..).zip(&mut nodes) {
            *nodes = side.rows[row].get_or_init(|| self.row(table, field, side, row));
        }
        Rows { side, first, nodes }
    }

    /// Values of one elevation at all distances.
    fn row(&self, table: &Table<N>, field: &Field<N>, side: &Side<N>, row: usize) -> Vec<Node<N>> {
        let sin_elevation = side.sign * side.sin_elevations[row];
        let ray = RaySegment::flat(self.eye_height_m, sin_elevation, f64::INFINITY);
        let lengths_m = self.lengths_m(table, side, &ray);
        let ground = match side.sign < 0.0 {
            true => NODES - 1,
            false => usize::MAX,
        };
        self.nodes(field, &ray, &lengths_m, ground)
    }

    /// Parts of the path radiance that a layer adds, up to some distances (increasing, not beyond the ground) along rays of one elevation;
    /// `None` for fog without multiple scattering, without an upper end, or over round ground.
    pub fn parts(
        &self,
        layer: usize,
        sin_elevation: f64,
        distances_m: &[f64],
    ) -> Option<Vec<FogParts<N>>> {
        let fog = &*self.fog;
        let has_ends = fog.layers.iter().all(|layer| !layer.density.is_uniform());
        let is_tabulated = has_ends && fog.ground.is_flat() && layer < fog.layers.len();
        let field = fog.field.as_ref().filter(|_| is_tabulated)?;
        let ray = RaySegment::flat(self.eye_height_m, sin_elevation, f64::INFINITY);
        let mut lengths_m = distances_m.to_vec();
        // To the ground or through all fog, from where light arrives that the forward peak scatters into the ray.
        let falls = sin_elevation < 0.0;
        let end_m = match falls {
            true => self.above_ground_m() / -sin_elevation,
            false => f64::INFINITY,
        };
        let ground = if falls { lengths_m.len() } else { usize::MAX };
        lengths_m.push(lengths_m.last().map_or(end_m, |last| end_m.max(*last)));
        let rays = Rays::new(fog, field, &ray, &lengths_m, ground);
        let per_opacity = self.per_opacity(layer, &ray, &lengths_m);
        let dark = FogParts {
            modes: [Spectrum::ZERO; DEGREES],
            streams: vec![[Spectrum::ZERO; STREAMS]; self.phases.len()],
        };
        let mut all = vec![dark; distances_m.len()];
        let has_sun = self.sun().is_some();
        for m in 0..if has_sun { DEGREES } else { 1 } {
            for (parts, light) in all.iter_mut().zip(per_opacity(rays.diffuse(layer, m))) {
                parts.modes[m] = light;
            }
        }
        for k in 0..if has_sun { STREAMS } else { 0 } {
            let again = match k < KEPT {
                true => per_opacity(rays.scattered_again(layer, k)),
                false => vec![Spectrum::ZERO; lengths_m.len()],
            };
            for (index, phase) in self.phases.iter().map(StreamedPhase::phase).enumerate() {
                let once = rays.sunlit(layer, |layer| layer.scattering_with(phase), k);
                let once = per_opacity(once);
                let each = fog.layers.iter().zip(&fog.mean_weights);
                let mean = each.fold(Spectrum::<N>::ZERO, |sum, (layer, weight)| {
                    sum.mul_acc(layer.scattering_with(phase), *weight)
                });
                for ((parts, once), again) in all.iter_mut().zip(once).zip(&again) {
                    parts.streams[index][k] = once.mul_acc(mean, *again);
                }
            }
        }
        Some(all)
    }

    /// Number of different phase functions in the fog.
    pub fn phase_count(&self) -> usize {
        self.phases.len()
    }

    /// Sunlight times a phase function of the fog, by its index among the distinct ones, at a cosine of the angle to the sun, by stream. The
    /// sum of the products with [`FogParts::streams`] is not negative, but shares can be.
    pub fn sun_streams(&self, phase: usize, cos_sun: f64) -> [Spectrum<N>; STREAMS] {
        match (self.sun(), self.phases.get(phase)) {
            (Some(sun), Some(phase)) => phase
                .towards_eye(cos_sun)
                .map(|stream| stream * sun.irradiance),
            _ => [Spectrum::ZERO; STREAMS],
        }
    }

    /// The sun above the horizon.
    fn sun(&self) -> Option<&DirectionalLight<Spectrum<N>>> {
        let sun = self.fog.lighting.sun.as_ref();
        sun.filter(|sun| sun.direction.y > 0.0)
    }

    /// Values along a ray at some distances, of which one may be that of the ground.
    fn nodes(
        &self,
        field: &Field<N>,
        ray: &RaySegment,
        lengths_m: &[f64],
        ground: usize,
    ) -> Vec<Node<N>> {
        let rays = Rays::new(&self.fog, field, ray, lengths_m, ground);
        let per_opacity = self.per_opacity(0, ray, lengths_m);
        let mut nodes = vec![*Node::ZERO; lengths_m.len()];
        let has_sun = self.sun().is_some();
        for m in 0..if has_sun { DEGREES } else { 1 } {
            for (node, light) in nodes.iter_mut().zip(per_opacity(rays.diffuse(0, m))) {
                for (lane, modes) in node.modes.iter_mut().enumerate() {
                    modes.0[m] = light[lane];
                }
            }
        }
        for k in 0..if has_sun { STREAMS } else { 0 } {
            let light = rays.sunlit(0, |_| Spectrum::ONE, k);
            for (node, light) in nodes.iter_mut().zip(per_opacity(light)) {
                for (lane, sunlit) in node.sunlit.iter_mut().enumerate() {
                    sunlit.0[k] = light[lane].max(DARK.exp()).ln();
                }
            }
        }
        let mean = self.fog.mean_weights[0];
        for k in 0..if has_sun { KEPT } else { 0 } {
            for (node, light) in nodes
                .iter_mut()
                .zip(per_opacity(rays.scattered_again(0, k)))
            {
                for (lane, sunlit) in node.sunlit.iter_mut().enumerate() {
                    sunlit.0[STREAMS + k] = light[lane] * mean[lane];
                }
            }
        }
        nodes
    }

    /// Divides light up to distances along a ray by the opacity of a layer alone up to there.
    fn per_opacity(
        &self,
        layer: usize,
        ray: &RaySegment,
        lengths_m: &[f64],
    ) -> impl Fn(Vec<Spectrum<N>>) -> Vec<Spectrum<N>> + use<N> {
        let layer = &self.fog.layers[layer];
        let opacity = |&length_m: &f64| {
            let column_m = layer.density.column_along_m(&ray.part(0.0, length_m));
            let depth = layer.extinction_per_m * column_m.min(OPAQUE) as f32;
            depth * depth.mean_transmittance()
        };
        let opacities: Vec<Spectrum<N>> = lengths_m.iter().map(opacity).collect();
        move |light| {
            let each = light.into_iter().zip(&opacities);
            each.map(|(light, opacity)| {
                Spectrum::from_fn(|lane| match opacity[lane] > 0.0 {
                    true => light[lane] / opacity[lane],
                    false => 0.0,
                })
            })
            .collect()
        }
    }

    /// Distances of the nodes, m.
    fn lengths_m(&self, table: &Table<N>, side: &Side<N>, ray: &RaySegment) -> Vec<f64> {
        let opacity = |length_m: f64| {
            let depth = self.fog.optical_depth(&ray.part(0.0, length_m));
            mean(depth * depth.mean_transmittance())
        };
        let end = table.ends(&[ray.sin_elevation])[0];
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
                Side::new(-1.0, fog.optical_depth(&under)),
                Side::new(1.0, above),
            ],
            sun: sun.map(|sun| SunSide {
                irradiance: sun.irradiance,
                direction: sun.direction,
                horizontal: (sun.direction * DVec3::new(1.0, 0.0, 1.0)).normalize_or_zero(),
            }),
        }
    }

    /// Opacities to space or to the ground along several rays, mean over lanes.
    #[inline(always)]
    fn ends<const R: usize>(&self, sin_elevation: &[f64; R]) -> Spectrum<R> {
        let mut opacity = [Spectrum::<R>::ZERO; N];
        for lane in 0..if self.is_grey { 1 } else { N } {
            let [below, above] = [&self.sides[0], &self.sides[1]];
            let (below, above) = (f64::from(below.depth[lane]), f64::from(above.depth[lane]));
            let mut depth = Spectrum::<R>::ZERO;
            for i in 0..R {
                let vertical = if sin_elevation[i] > 0.0 { above } else { below };
                let per_sine = 1.0 / sin_elevation[i].abs().max(1e-20);
                depth[i] = (vertical * per_sine).min(OPAQUE) as f32;
            }
            opacity[lane] = depth * depth.mean_transmittance();
        }
        match self.is_grey {
            true => opacity[0],
            false => mean_of(&opacity),
        }
    }

    /// Positions of rays with these sines of the elevation and opacities.
    #[inline(always)]
    fn places<const R: usize>(&self, sin_elevation: &[f64; R], opacity: Spectrum<R>) -> Places<R> {
        const STEPS: f32 = (NODES - 1) as f32;
        let ends = self.ends(sin_elevation);
        let [below, above] = [&self.sides[0], &self.sides[1]];
        let mut sines = [0.0; R];
        let mut spacing = [Spacing::default(); R];
        for i in 0..R {
            sines[i] = sin_elevation[i].abs();
            spacing[i] = if sin_elevation[i] > 0.0 {
                above.spacing
            } else {
                below.spacing
            };
        }
        let rows = rows_of(&sines, &spacing);
        let mut places = Places {
            first: [0; R],
            node: [0; R],
            weights: [[Spectrum::ZERO; 2]; 4],
        };
        for i in 0..R {
            let (end, opacity) = (ends[i], opacity[i]);
            let rises = sin_elevation[i] > 0.0;
            let part = if opacity > 0.0 { opacity / end } else { 0.0 };
            let rest = if part < 1.0 { 1.0 - part } else { 0.0 };
            let before = STEPS * (1.0 - rest.sqrt().sqrt());
            // Beyond the ground evenly spaced in 1 / x.
            let nearest = if end > NEAREST { end } else { NEAREST };
            let farthest = 1.0 - end;
            let farthest = if farthest > f32::MIN_POSITIVE {
                farthest
            } else {
                f32::MIN_POSITIVE
            };
            let more = opacity - end;
            let inverse = more / (more + nearest) * ((farthest + nearest) / farthest);
            let along = if rises || opacity < end {
                before
            } else {
                STEPS * (1.0 + inverse)
            };
            let last = if rises { STEPS } else { 2.0 * STEPS } - 1.0;
            let node = if along < last { along } else { last };
            let node = node as i32;
            let far = along - node as f32;
            let far = if far < 1.0 { far } else { 1.0 };
            let first = (rows[i] as i32).clamp(1, ROWS as i32 - 3) - 1;
            let weights = cubic_weights(rows[i] - first as f32);
            (places.first[i], places.node[i]) = (first as u32, node as u32);
            for row in 0..4 {
                places.weights[row][0][i] = weights[row] * (1.0 - far);
                places.weights[row][1][i] = weights[row] * far;
            }
        }
        places
    }
}

/// Transmittance and path radiance of R rays, by lane.
struct RayOptics<const N: usize, const R: usize> {
    transmittance: [Spectrum<R>; N],
    path_radiance: [Spectrum<R>; N],
}

/// Positions of R rays in the table of a side.
struct Places<const R: usize> {
    /// First of four rows.
    first: [u32; R],
    /// The nearer of two nodes.
    node: [u32; R],
    /// Weights of the rows at the nearer and the farther node.
    weights: [[Spectrum<R>; 2]; 4],
}

/// Four rows of a side from the index `first` on.
struct Rows<'t, const N: usize> {
    side: &'t Side<N>,
    first: usize,
    nodes: [&'t [Node<N>]; 4],
}

/// `c^m cos(m azimuth)` of each ray for each mode `m`, where `c` is the cosine of the elevation and azimuths are from the
/// horizontal unit vector towards the sun.
#[inline(always)]
fn azimuth_factors<const R: usize>(towards_sun: DVec3, directions: &[DVec3]) -> [Values; R] {
    let mut factors = [Values::ZERO; R];
    for (Values(factors), direction) in factors.iter_mut().zip(directions) {
        let across = direction.dot(towards_sun) as f32;
        let square = (direction.x * direction.x + direction.z * direction.z) as f32;
        *factors = multiple::azimuth_factors(across, square);
    }
    factors
}

/// Mean over lanes of several rays.
#[inline(always)]
fn mean_of<const N: usize, const R: usize>(lanes: &[Spectrum<R>; N]) -> Spectrum<R> {
    let mut sum = Spectrum::ZERO;
    for lane in lanes {
        sum += *lane;
    }
    sum * (1.0 / N as f32)
}

/// All rising or all descending rays.
#[derive(Debug)]
struct Side<const N: usize> {
    /// -1 or 1.
    sign: f64,
    /// Vertical optical depth to space or to the ground.
    depth: Spectrum<N>,
    spacing: Spacing,
    /// Absolute sine of the elevation of each row; nearly 0 for the first.
    sin_elevations: Vec<f64>,
    rows: Vec<OnceLock<Vec<Node<N>>>>,
}

/// Spacing of the rows of a side: even up to an absolute sine of the elevation, beyond it partly logarithmic.
#[derive(Clone, Copy, Debug, Default)]
struct Spacing {
    /// One over that sine.
    per_sine: f64,
    /// `1 / ln(1 + per_sine)`.
    per_logarithm: f32,
}

/// Real indices of the rows of rays with these absolute sines of the elevation.
#[inline(always)]
fn rows_of<const R: usize>(sines: &[f64; R], spacing: &[Spacing; R]) -> Spectrum<R> {
    let mut logarithms = Spectrum::<R>::ZERO;
    for i in 0..R {
        logarithms[i] = (1.0 + sines[i] * spacing[i].per_sine) as f32;
    }
    let logarithms = logarithms.ln();
    let mut rows = Spectrum::ZERO;
    for i in 0..R {
        let logarithm = logarithms[i] * spacing[i].per_logarithm;
        let even = (1.0 - LOGARITHMIC) * sines[i] as f32;
        rows[i] = (ROWS - 1) as f32 * (LOGARITHMIC * logarithm + even);
    }
    rows
}

/// Path radiance per unit of opacity along rays of one elevation to one distance.
#[derive(Clone, Copy, Debug)]
struct Node<const N: usize> {
    /// Multiple scattering, azimuth mode `m` divided by the `m`-th power of the cosine of the elevation.
    modes: [Values; N],
    /// Logarithm of singly scattered sunlight by stream, in the first places, then what peaks scatter of it again.
    sunlit: [Values; N],
}

/// Path radiance that a layer adds along rays of one elevation to one distance, per unit of its own opacity, in parts.
#[derive(Clone, Debug, PartialEq)]
pub(crate) struct FogParts<const N: usize> {
    /// Light scattered several times: the factor of `cos(m azimuth)`, divided by the `m`-th power of the cosine of the elevation.
    pub modes: [Spectrum<N>; DEGREES],
    /// Sunlight scattered once, by phase function and by stream, per unit of [`TableLanes::sun_streams`].
    pub streams: Vec<[Spectrum<N>; STREAMS]>,
}

/// Values that are interpolated as one vector.
#[derive(Clone, Copy, Debug)]
#[repr(C, align(32))]
struct Values([f32; DEGREES]);

const _: () = assert!(STREAMS + KEPT <= DEGREES);

impl<const N: usize> Node<N> {
    const ZERO: &Self = &Self {
        modes: [Values::ZERO; N],
        sunlit: [Values::ZERO; N],
    };
}

impl Values {
    const ZERO: Self = Self([0.0; DEGREES]);

    #[inline(always)]
    fn add(&mut self, from: &Self, to: &Self, [near, far]: [f32; 2]) {
        for k in 0..DEGREES {
            self.0[k] += near * from.0[k] + far * to.0[k];
        }
    }

    /// Sum of products, added in pairs for vector instructions.
    #[inline(always)]
    fn dot(&self, other: &Self) -> f32 {
        const HALF: usize = DEGREES / 2;
        let mut pairs = [0.0; HALF];
        for k in 0..HALF {
            pairs[k] = self.0[k] * other.0[k] + self.0[k + HALF] * other.0[k + HALF];
        }
        let mut sum = 0.0;
        for k in 0..HALF / 2 {
            sum += pairs[k] + pairs[k + HALF / 2];
        }
        sum
    }
}

impl<const N: usize> Side<N> {
    fn new(sign: f64, depth: Spectrum<N>) -> Self {
        let even_to = f64::from(0.1 * mean(depth)).clamp(1e-6, 0.05);
        let spacing = Spacing {
            per_sine: 1.0 / even_to,
            per_logarithm: (1.0 / (1.0 / even_to).ln_1p()) as f32,
        };
        Self {
            sign,
            depth,
            spacing,
            sin_elevations: (0..ROWS).map(|row| spacing.sine_at(row)).collect(),
            rows: std::iter::repeat_with(OnceLock::new).take(ROWS).collect(),
        }
    }
}

impl Spacing {
    /// Absolute sine of the elevation of a row: the inverse of [`rows_of`], by bisection.
    fn sine_at(self, row: usize) -> f64 {
        let row = if row == 0 { 1e-3 } else { row as f32 };
        let (mut low, mut high) = (0.0, 1.0);
        for _ in 0..60 {
            let middle = 0.5 * (low + high);
            if rows_of(&[middle], &[self])[0] < row {
                low = middle;
            } else {
                high = middle;
            }
        }
        high
    }
}

/// Mean of all lanes.
#[inline]
fn mean<const N: usize>(lanes: Spectrum<N>) -> f32 {
    lanes.0.iter().sum::<f32>() / N as f32
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
