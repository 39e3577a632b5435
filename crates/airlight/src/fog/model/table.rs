//! A fog as it is seen from one height, tabulated: for pictures.

mod place;
mod rays;

use self::place::{NEAREST, NODES, Place, Row, SHARES, Side, mean, opacity};
use self::rays::{Rays, distance_of};
use super::{Fog, OPAQUE};
use crate::atmosphere::RaySegment;
use crate::fog::lanes::Lanes;
use crate::fog::merged_layers::MergedLayer;
use crate::fog::multiple::{Field, STREAMS};
use crate::math::interpolation::cubic_weights;
use crate::spectrum::Spectrum;
use crate::transfer::PathOptics;
use glam::DVec3;

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
    layer: &'a MergedLayer<N>,
    field: &'a Field<N>,
    /// Downwards and upwards.
    sides: [Side<N>; 2],
    /// Whether all lanes are dimmed alike, so that one need be looked at.
    is_grey: bool,
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

impl<'a, const N: usize> FogTable<'a, N> {
    /// The fog as seen from a height (m).
    pub fn new(fog: &'a Fog<N>, eye_height_m: f64) -> Self {
        let table = match &fog.field {
            Some(field) if fog.ground.is_flat() && fog.layers.len() == 1 => {
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
        let line = RaySegment::flat(self.eye_height_m, direction.y, length_m);
        let depth = fog.optical_depth(&line);
        let opacity = opacity(depth, table.is_grey);
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
            transmittance: match table.is_grey {
                true => Spectrum::splat(Spectrum([depth[0]]).exp_neg()[0]),
                false => depth.exp_neg(),
            },
            path_radiance,
        }
    }

    /// One elevation at all distances.
    fn row(&self, table: &Table<'_, N>, side: &Side<N>, row: usize) -> Row<N> {
        let sin_elevation = side.sign * side.climbs[row];
        let line = RaySegment::flat(self.eye_height_m, sin_elevation, f64::INFINITY);
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
    fn lengths_m(&self, side: &Side<N>, line: &RaySegment) -> Vec<f64> {
        let opacity = |length_m: f64| {
            let depth = self.fog.optical_depth(&line.part(0.0, length_m));
            mean(depth * depth.mean_transmittance())
        };
        let end = side.end(line.sin_elevation.abs());
        let nearest = NEAREST * if end > 0.0 { end } else { 1.0 };
        let left = |node: usize| 1.0 - node as f32 / (NODES - 1) as f32;
        let mut lengths_m = vec![0.0];
        for node in 0..NODES {
            let fraction = 1.0 - left(node).powi(4);
            let from = lengths_m[lengths_m.len() - 1];
            let at = match (node == NODES - 1, side.sign > 0.0) {
                (true, true) => f64::INFINITY,
                (true, false) => (self.above_ground_m() / -line.sin_elevation).max(from),
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
        let layer = &fog.layers[0];
        let column_m = layer.profile.column_above_m(eye_height_m).min(OPAQUE);
        let above = layer.extinction_per_m * column_m as f32;
        let under = RaySegment::flat(
            eye_height_m,
            -1.0,
            (eye_height_m - fog.ground.height_m).max(0.0),
        );
        let extinction = layer.extinction_per_m;
        let is_grey = extinction.0.iter().all(|&lane| lane == extinction[0]);
        Self {
            layer,
            field,
            is_grey,
            sides: [
                Side::new(-1.0, fog.optical_depth(&under), is_grey),
                Side::new(1.0, above, is_grey),
            ],
            most_of_peak: most_of_peak(layer),
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
        let layer = self.layer;
        let beam = |k: usize| place.sum_of(rows, |row, node| row.sunlit[node][k]);
        let (whole, once) = (layer.towards_eye(cos_sun), beam(0).exp());
        if !layer.in_peak(cos_sun) {
            return whole * once;
        }
        // All lanes take the same four of the nodes.
        let at = part_of_peak(layer, cos_sun).map(|share| self.place_of_share(share));
        let first = (mean(at) as usize).clamp(1, SHARES - 3) - 1;
        let logarithms: [Spectrum<N>; 4] = std::array::from_fn(|k| beam(first + k));
        let logarithm = Spectrum::from_fn(|lane| {
            let weights = cubic_weights(at[lane] - first as f32);
            (0..4).map(|k| weights[k] * logarithms[k][lane]).sum()
        });
        let beyond = whole - layer.smooth_towards_eye(cos_sun);
        whole * once + beyond * (logarithm.exp() - once)
    }
}

/// What of the forward peak counts as scattered at an angle to the sun.
#[inline]
fn part_of_peak<const N: usize>(layer: &MergedLayer<N>, cos_sun: f64) -> Spectrum<N> {
    let reduced = layer.reduced_extinction_per_m;
    let (part, whole) = (
        layer.residual_extinction(cos_sun) - reduced,
        layer.extinction_per_m - reduced,
    );
    Spectrum::from_fn(|lane| match whole[lane] > 0.0 {
        true => part[lane] / whole[lane],
        false => 0.0,
    })
}

/// The largest of it at any angle and in any lane.
fn most_of_peak<const N: usize>(layer: &MergedLayer<N>) -> f32 {
    let cosines = (0..=200).map(|k| 1.0 - 2.0 * (f64::from(k) / 200.0).powi(4));
    cosines
        .map(|cosine| part_of_peak(layer, cosine).max_element())
        .fold(0.0, f32::max)
}

#[cfg(test)]
mod tests;
