//! What fog does along lines of one elevation: a row of a table.

use super::Table;
use crate::atmosphere::RaySegment;
use crate::fog::Fog;
use crate::fog::lanes::Lanes;
use crate::fog::merged_layers::MergedLayer;
use crate::fog::multiple;
use crate::spectrum::Spectrum;

/// Lines of one elevation up to each of their distances.
pub(super) struct Rays<'a, const N: usize> {
    pub fog: &'a Fog<N>,
    pub table: &'a Table<'a, N>,
    pub line: RaySegment,
    pub lengths_m: &'a [f64],
    /// The distance that ends on the ground; none of lines that rise.
    pub ground: usize,
}

impl<const N: usize> Rays<'_, N> {
    /// Path radiance of light scattered many times, of one azimuth mode over the cosine of the elevation to its power: what
    /// [`Fog::along`] adds up in one direction ([`Fog::multiple_scattering`]).
    pub fn diffuse(&self, mode: usize) -> Vec<Spectrum<N>> {
        let field = self.table.field;
        let weights = multiple::of_mode(self.line.sin_elevation, mode);
        let scattered = |part: &RaySegment| field.scattered(part, &weights, Spectrum::ZERO);
        let (sky, ground) = match mode {
            0 => (self.fog.light.ambient, field.ground_radiance),
            _ => (Spectrum::ZERO, Spectrum::ZERO),
        };
        self.to_each(|s| s.reduced_extinction_per_m, scattered, sky, ground)
    }

    /// The same of sunlight scattered once, for a unit of irradiance and of what is scattered towards the eye, where a part
    /// of the peak counts as scattered.
    pub fn sunlit(&self, index: usize) -> Vec<Spectrum<N>> {
        let share = self.table.share(index);
        let extinction = |s: &MergedLayer<N>| {
            let reduced = s.reduced_extinction_per_m;
            reduced.scale_acc(s.extinction_per_m - reduced, share)
        };
        let once = self.fog.once(extinction, |_| Spectrum::ONE);
        let scattered = |part: &RaySegment| once.along(part, &|_| Spectrum::ZERO).0;
        self.to_each(extinction, scattered, Spectrum::ZERO, Spectrum::ZERO)
    }

    /// Path radiance up to each distance, of what stretches scatter and of what arrives from the sky or the ground, dimmed by
    /// an extinction on its way: the light at the eye less the light at the far end that passes unscattered.
    pub fn to_each(
        &self,
        extinction: impl Fn(&MergedLayer<N>) -> Spectrum<N>,
        scattered: impl Fn(&RaySegment) -> Spectrum<N>,
        sky: Spectrum<N>,
        ground: Spectrum<N>,
    ) -> Vec<Spectrum<N>> {
        let starts = std::iter::once(&0.0).chain(self.lengths_m);
        let parts: Vec<RaySegment> = starts
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
        let mut arriving = vec![
            if self.line.sin_elevation < 0.0 {
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
pub(super) fn distance_of(rising: &impl Fn(f64) -> f32, target: f32, from: f64) -> f64 {
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
