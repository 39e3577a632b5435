//! A fog as it is seen from one height, tabulated: for pictures.

use super::{Fog, OPAQUE};
use crate::fog::lanes::Lanes;
use crate::fog::line::Line;
use crate::fog::multiple::{self, Field, STREAMS};
use crate::fog::strata::Stratum;
use crate::path::PathOptics;
use crate::spectrum::Spectrum;
use glam::DVec3;
use std::sync::OnceLock;

/// Elevations of each side of the level line.
const ROWS: usize = 64;
/// How far rows lie evenly in the logarithm of the climb, and not in the climb.
const LOGARITHMIC: f32 = 0.6;
/// Distances, to where the fog ends and to the ground, and from there on.
const NODES: usize = 41;
/// Parts of the forward peak that count as scattered at which light in it is tabulated.
const SHARES: usize = 7;
/// The smallest opacity of a node over the largest: there the source function is that at the eye.
const NEAREST: f32 = 1e-5;
/// The logarithm of what counts as dark.
const DARK: f32 = -80.0;

/// A [`Fog`] seen from one height: the same answers as [`Fog::along`], for many lines at a fraction of the time.
///
/// Transmittance is [`Fog`]'s own. Of the path radiance `S = (1 - T) J` the mean source function `J` is interpolated, which
/// is finite and smooth from the eye to infinity. It is the sum of light scattered often, tabulated by azimuth mode over
/// elevation and distance, and of sunlight scattered once, `p(Theta)` times a function of both (and, within the forward peak, of
/// the part of the peak that counts as not scattered), so that neither the peak nor the azimuth needs nodes. Distance
/// is told by opacity, `1 - (1 - x / x_end)^(1/4)`, where `x` is `1 - T` and `x_end` the same up to space or to the ground.
///
/// Error against [`Fog::along`]: below 0.3 % of the path radiance (the test `a_table_is_the_fog_itself`). Rows of the table are
/// computed when they are first looked at, by whichever thread does; the values do not depend on that. Fog of several profiles,
/// over round ground, or without light scattered many times is not tabulated, but evaluated as it is.
#[derive(Debug)]
pub struct FogTable<'a, const N: usize> {
    fog: &'a Fog<N>,
    eye_height_m: f64,
    table: Option<Table<'a, N>>,
}

#[derive(Debug)]
struct Table<'a, const N: usize> {
    stratum: &'a Stratum<N>,
    field: &'a Field<N>,
    /// Downwards and upwards.
    sides: [Side<N>; 2],
    /// The largest part of the forward peak that counts as scattered at any angle to the sun.
    most_of_peak: f32,
    sun: Option<SunSide<N>>,
}

/// The sun as the table needs it.
#[derive(Debug)]
struct SunSide<const N: usize> {
    irradiance: Spectrum<N>,
    direction: DVec3,
    /// Its horizontal part, of length 1; 0 of a sun in the zenith.
    level: DVec3,
}

/// All lines that go up, or all that go down.
#[derive(Debug)]
struct Side<const N: usize> {
    /// -1 or 1.
    sign: f64,
    /// Optical depth straight to space or to the ground.
    depth: Spectrum<N>,
    /// Climb up to which rows lie evenly; beyond, evenly in a mean of its logarithm and itself.
    even_to: f64,
    /// The climb (without its sign) of each row; of the first, next to nothing.
    climbs: Vec<f64>,
    rows: Vec<OnceLock<Row<N>>>,
    /// One over the logarithm of the steepest climb in units of `even_to`, and 1.
    per_logarithm: f32,
}

/// Light for a unit of opacity, along lines of one elevation, at each distance.
#[derive(Debug)]
struct Row<const N: usize> {
    /// Scattered often: the mean over azimuth.
    even: Vec<Spectrum<N>>,
    /// The further azimuth modes, over the cosine of the elevation to their power; of the first nothing. Lanes outside, so that
    /// modes add up in one vector.
    around: Vec<[[f32; STREAMS]; N]>,
    /// The logarithm of sunlight scattered once, by part of the peak.
    sunlit: Vec<[Spectrum<N>; SHARES]>,
}

impl<'a, const N: usize> FogTable<'a, N> {
    /// The fog as seen from a height (m).
    pub fn new(fog: &'a Fog<N>, eye_height_m: f64) -> Self {
        let table = match &fog.field {
            Some(field) if fog.ground.is_flat() && fog.strata.len() == 1 => {
                Some(Table::new(fog, field, eye_height_m))
            }
            _ => None,
        };
        Self {
            fog,
            eye_height_m,
            table,
        }
    }

    /// What the fog does between the eye and a point `length_m` away (infinite: the sky) in the unit direction `direction`.
    #[inline]
    pub fn along(&self, direction: DVec3, length_m: f64) -> PathOptics<N> {
        let Some(table) = &self.table else {
            return self.fog.along(self.eye_height_m, direction, length_m);
        };
        let fog = self.fog;
        let sun = table.sun.as_ref();
        let cos_sun = sun.map_or(0.0, |sun| direction.dot(sun.direction));
        let line = Line::flat(self.eye_height_m, direction.y, length_m);
        let depth = fog.optical_depth(&line);
        let opacity = depth * depth.mean_transmittance();
        let mut path_radiance = Spectrum::ZERO;
        let seen = mean(opacity);
        if seen > 0.0 {
            let side = &table.sides[usize::from(direction.y > 0.0)];
            let place = side.place(direction.y.abs(), seen);
            let rows: [&Row<N>; 4] = std::array::from_fn(|r| {
                let row = place.row + r;
                side.rows[row].get_or_init(|| self.row(table, side, row))
            });
            let mut source = place.sum_of(&rows, |row, node| row.even[node]);
            if let Some(sun) = sun {
                source += place.around(&rows, sun, direction);
                source += table.sunlit(cos_sun, &place, &rows) * sun.irradiance;
            }
            path_radiance = opacity * source;
        }
        PathOptics {
            transmittance: depth.exp_neg(),
            path_radiance,
        }
    }

    /// One elevation at all distances.
    fn row(&self, table: &Table<'_, N>, side: &Side<N>, row: usize) -> Row<N> {
        let climb = side.sign * side.climbs[row];
        let line = Line::flat(self.eye_height_m, climb, f64::INFINITY);
        let lengths_m = self.lengths_m(side, &line);
        let ground = match side.sign < 0.0 {
            true => NODES - 1,
            false => usize::MAX,
        };
        let rays = Rays {
            fog: self.fog,
            table,
            line,
            lengths_m: &lengths_m,
            ground,
        };
        let opacities: Vec<Spectrum<N>> = lengths_m
            .iter()
            .map(|&length_m| {
                let depth = self.fog.optical_depth(&line.part(0.0, length_m));
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
        let mut values = Row {
            even: per_opacity(rays.diffuse(0)),
            around: Vec::new(),
            sunlit: Vec::new(),
        };
        if table.sun.is_some() {
            values.around = vec![[[0.0; STREAMS]; N]; lengths_m.len()];
            values.sunlit = vec![[Spectrum::ZERO; SHARES]; lengths_m.len()];
            for m in 1..STREAMS {
                let light = per_opacity(rays.diffuse(m));
                for (around, light) in values.around.iter_mut().zip(light) {
                    for (lane, modes) in around.iter_mut().enumerate() {
                        modes[m] = light[lane];
                    }
                }
            }
            for k in 0..SHARES {
                let light = per_opacity(rays.sunlit(k));
                for (sunlit, light) in values.sunlit.iter_mut().zip(light) {
                    sunlit[k] = light.map(|v| v.max(DARK.exp()).ln());
                }
            }
        }
        values
    }

    /// The distances of the nodes: by opacity.
    fn lengths_m(&self, side: &Side<N>, line: &Line) -> Vec<f64> {
        let opacity = |length_m: f64| {
            let depth = self.fog.optical_depth(&line.part(0.0, length_m));
            mean(depth * depth.mean_transmittance())
        };
        let end = side.end(line.climb.abs());
        let nearest = NEAREST * if end > 0.0 { end } else { 1.0 };
        let left = |node: usize| 1.0 - node as f32 / (NODES - 1) as f32;
        let mut lengths_m = vec![0.0];
        for node in 0..NODES {
            let fraction = 1.0 - left(node).powi(4);
            let from = lengths_m[lengths_m.len() - 1];
            let at = match (node == NODES - 1, side.sign > 0.0) {
                (true, true) => f64::INFINITY,
                (true, false) => (self.above_ground_m() / -line.climb).max(from),
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

impl<'a, const N: usize> Table<'a, N> {
    fn new(fog: &'a Fog<N>, field: &'a Field<N>, eye_height_m: f64) -> Self {
        let sun = fog.light.sun.filter(|sun| sun.direction.y > 0.0);
        let stratum = &fog.strata[0];
        let column_m = stratum.profile.column_above(eye_height_m).min(OPAQUE);
        let above = stratum.extinction_per_m * column_m as f32;
        let under = Line::flat(
            eye_height_m,
            -1.0,
            (eye_height_m - fog.ground.height_m).max(0.0),
        );
        Self {
            stratum,
            field,
            sides: [
                Side::new(-1.0, fog.optical_depth(&under)),
                Side::new(1.0, above),
            ],
            most_of_peak: most_of_peak(stratum),
            sun: sun.map(|sun| SunSide {
                irradiance: sun.irradiance,
                direction: sun.direction,
                level: (sun.direction * DVec3::new(1.0, 0.0, 1.0)).normalize_or_zero(),
            }),
        }
    }

    /// The part of the peak of a column of sunlight scattered once: close together towards the largest, where least of the
    /// sunlight is left.
    fn share(&self, index: usize) -> f32 {
        let left = 1.0 - index as f32 / (SHARES - 1) as f32;
        self.most_of_peak * (1.0 - left * left)
    }

    /// The inverse, in steps from 0.
    #[inline]
    fn place_of_share(&self, share: f32) -> f32 {
        let part = share / self.most_of_peak.max(f32::MIN_POSITIVE);
        (SHARES - 1) as f32 * (1.0 - (1.0 - part).max(0.0).sqrt())
    }

    /// Sunlight scattered once, for a unit of irradiance and of opacity.
    #[inline]
    fn sunlit(&self, cos_sun: f64, place: &Place, rows: &[&Row<N>; 4]) -> Spectrum<N> {
        let stratum = self.stratum;
        let beam = |k: usize| place.sum_of(rows, |row, node| row.sunlit[node][k]);
        let (whole, once) = (stratum.towards_eye(cos_sun), beam(0).exp());
        if !stratum.in_peak(cos_sun) {
            return whole * once;
        }
        // All lanes take the same four of the nodes.
        let at = part_of_peak(stratum, cos_sun).map(|share| self.place_of_share(share));
        let first = (mean(at) as usize).clamp(1, SHARES - 3) - 1;
        let logarithms: [Spectrum<N>; 4] = std::array::from_fn(|k| beam(first + k));
        let logarithm = Spectrum::from_fn(|lane| {
            let weights = third_degree(at[lane] - first as f32);
            (0..4).map(|k| weights[k] * logarithms[k][lane]).sum()
        });
        let beyond = whole - stratum.smooth_towards_eye(cos_sun);
        whole * once + beyond * (logarithm.exp() - once)
    }
}

/// What of the forward peak counts as scattered at an angle to the sun.
#[inline]
fn part_of_peak<const N: usize>(stratum: &Stratum<N>, cos_sun: f64) -> Spectrum<N> {
    let reduced = stratum.reduced_extinction_per_m;
    let (part, whole) = (
        stratum.residual_extinction(cos_sun) - reduced,
        stratum.extinction_per_m - reduced,
    );
    Spectrum::from_fn(|lane| match whole[lane] > 0.0 {
        true => part[lane] / whole[lane],
        false => 0.0,
    })
}

/// The largest of it at any angle and in any lane.
fn most_of_peak<const N: usize>(stratum: &Stratum<N>) -> f32 {
    let cosines = (0..=200).map(|k| 1.0 - 2.0 * (f64::from(k) / 200.0).powi(4));
    cosines
        .map(|cosine| part_of_peak(stratum, cosine).max_element())
        .fold(0.0, f32::max)
}

/// Where a line lies in a side's table.
struct Place {
    row: usize,
    node: usize,
    /// Of four rows, at the nearer and the farther node.
    weights: [[f32; 2]; 4],
}

impl Place {
    /// A value of the table.
    #[inline]
    fn sum_of<const N: usize>(
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
    fn around<const N: usize>(
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
    fn new(sign: f64, depth: Spectrum<N>) -> Self {
        let even_to = f64::from(0.1 * mean(depth)).clamp(1e-6, 0.05);
        let mut side = Self {
            sign,
            depth,
            even_to,
            per_logarithm: (1.0 / (1.0 / even_to).ln_1p()) as f32,
            climbs: Vec::new(),
            rows: std::iter::repeat_with(OnceLock::new).take(ROWS).collect(),
        };
        side.climbs = (0..ROWS).map(|row| side.climb_at(row)).collect();
        side
    }

    /// Where a climb (without its sign) lies among the rows.
    #[inline]
    fn row_of(&self, climb: f64) -> f32 {
        let logarithm = (1.0 + climb / self.even_to) as f32;
        let logarithm = logarithm.ln() * self.per_logarithm;
        (ROWS - 1) as f32 * (LOGARITHMIC * logarithm + (1.0 - LOGARITHMIC) * climb as f32)
    }

    /// The inverse: by halving.
    fn climb_at(&self, row: usize) -> f64 {
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
    fn end(&self, climb: f64) -> f32 {
        let depth = self.depth.map(|d| d / climb.max(1e-20) as f32);
        mean(depth * depth.mean_transmittance())
    }

    #[inline]
    fn place(&self, climb: f64, seen: f32) -> Place {
        let end = self.end(climb);
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
        let row = self.row_of(climb);
        let first = (row as usize).clamp(1, ROWS - 3) - 1;
        let weights = third_degree(row - first as f32);
        Place {
            row: first,
            node: node as usize,
            weights: weights.map(|w| [w * (1.0 - far), w * far]),
        }
    }
}

/// Lines of one elevation up to each of their distances.
struct Rays<'a, const N: usize> {
    fog: &'a Fog<N>,
    table: &'a Table<'a, N>,
    line: Line,
    lengths_m: &'a [f64],
    /// The distance that ends on the ground; none of lines that rise.
    ground: usize,
}

impl<const N: usize> Rays<'_, N> {
    /// Path radiance of light scattered many times, of one azimuth mode over the cosine of the elevation to its power: what
    /// [`Fog::along`] adds up in one direction ([`Fog::scattered_often`]).
    fn diffuse(&self, mode: usize) -> Vec<Spectrum<N>> {
        let field = self.table.field;
        let weights = multiple::of_mode(self.line.climb, mode);
        let scattered = |part: &Line| field.scattered(part, &weights, Spectrum::ZERO);
        let (sky, ground) = match mode {
            0 => (self.fog.light.ambient, field.ground_radiance),
            _ => (Spectrum::ZERO, Spectrum::ZERO),
        };
        self.to_each(|s| s.reduced_extinction_per_m, scattered, sky, ground)
    }

    /// The same of sunlight scattered once, for a unit of irradiance and of what is scattered towards the eye, where a part
    /// of the peak counts as scattered.
    fn sunlit(&self, index: usize) -> Vec<Spectrum<N>> {
        let share = self.table.share(index);
        let extinction = |s: &Stratum<N>| {
            let reduced = s.reduced_extinction_per_m;
            reduced.scale_acc(s.extinction_per_m - reduced, share)
        };
        let once = self.fog.once(extinction, |_| Spectrum::ONE);
        let scattered = |part: &Line| once.along(part, &|_| Spectrum::ZERO).0;
        self.to_each(extinction, scattered, Spectrum::ZERO, Spectrum::ZERO)
    }

    /// Path radiance up to each distance, of what stretches scatter and of what arrives from the sky or the ground, dimmed by
    /// an extinction on its way: the light at the eye less the light at the far end that passes unscattered.
    fn to_each(
        &self,
        extinction: impl Fn(&Stratum<N>) -> Spectrum<N>,
        scattered: impl Fn(&Line) -> Spectrum<N>,
        sky: Spectrum<N>,
        ground: Spectrum<N>,
    ) -> Vec<Spectrum<N>> {
        let starts = std::iter::once(&0.0).chain(self.lengths_m);
        let parts: Vec<Line> = starts
            .zip(self.lengths_m)
            .map(|(&from, &to)| self.line.part(from, to.max(from)))
            .collect();
        let parts: Vec<(Spectrum<N>, Spectrum<N>)> = parts
            .iter()
            .map(|part| match part.length_m > 0.0 {
                true => (scattered(part), self.fog.depth_of(part, &extinction)),
                false => (Spectrum::ZERO, Spectrum::ZERO),
            })
            .collect();
        // Light at each distance that comes from beyond it.
        let mut arriving = vec![if self.line.climb < 0.0 { ground } else { sky }; parts.len()];
        for k in (0..parts.len() - 1).rev().filter(|&k| k < self.ground) {
            let (light, depth) = parts[k + 1];
            arriving[k] = light + depth.exp_neg() * arriving[k + 1];
        }
        let mut near = Spectrum::ZERO;
        let mut before = Spectrum::ZERO;
        let each = parts.iter().enumerate().map(|(k, (light, depth))| {
            near += before.exp_neg() * *light;
            before += *depth;
            let whole = self
                .fog
                .optical_depth(&self.line.part(0.0, self.lengths_m[k]));
            let rest = (whole - before).map(|d| if d > 0.0 { d } else { 0.0 });
            near + before.exp_neg() * rest * rest.mean_transmittance() * arriving[k]
        });
        each.collect()
    }
}

/// The distance, beyond `from`, at which something that rises with it from 0 reaches `target`: by false position
/// (the Illinois algorithm), to 1e-6 of the target.
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

/// Lagrange's weights of values at 0, 1, 2 and 3.
#[inline]
fn third_degree(x: f32) -> [f32; 4] {
    let [a, b, c, d] = [x, x - 1.0, x - 2.0, x - 3.0];
    [
        -b * c * d / 6.0,
        0.5 * a * c * d,
        -0.5 * a * b * d,
        a * b * c / 6.0,
    ]
}

#[inline]
fn mean<const N: usize>(lanes: Spectrum<N>) -> f32 {
    lanes.0.iter().sum::<f32>() / N as f32
}

#[cfg(test)]
mod tests;
