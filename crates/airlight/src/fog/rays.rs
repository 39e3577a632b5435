//! Path radiance along rays of one elevation to some distances, by the layer that scatters it.
//!
//! A layer removes light from the ray, and part of it, in the narrow forward peak, stays in the ray. With the extinction `k_i` and
//! the scattering `n_i` by the peak of a layer, its source function `J_i`, the transmittance `T` of all fog and the radiance `I` towards
//! the eye, in which that part counts as unscattered, a layer adds
//!
//! ```text
//! S_i(d) = int_0^d T (J_i + n_i I) ds,    sum over i of S_i = I(0) - T(d) I(d)
//! ```
//!
//! to the path radiance, which does not change where the ray is outside of the layer. In a part of a ray with the radiance `s` of its own
//! light, the transmittance `t` of all fog, and `u`, that without scattering by the peak, the sum grows by `T (s + (u - t) I)`, where `I` is
//! the radiance at the far end. Parts are short enough for the ratio of the layers to be that of their columns in each.

use super::closed_forms::{Lanes, OPAQUE};
use super::fog_lanes::FogLanes;
use super::layer::MergedLayer;
use super::multiple::{self, DEGREES, Field};
use super::ray_cuts::split_at_heights;
use crate::atmosphere::RaySegment;
use crate::spectrum::Spectrum;

/// Rays of one elevation over flat ground, in fog whose layers have an upper end.
pub(super) struct Rays<'a, const N: usize> {
    fog: &'a FogLanes<N>,
    field: &'a Field<N>,
    sin_elevation: f64,
    parts: Vec<Part<N>>,
    /// Number of parts up to each distance.
    ends: Vec<usize>,
    /// Number of parts up to the ground; `usize::MAX` for rays that do not reach it.
    ground: usize,
}

/// A part of a ray.
struct Part<const N: usize> {
    segment: RaySegment,
    /// Columns of the layers, m.
    columns_m: Vec<f32>,
    /// Transmittance of the fog before it.
    before: Spectrum<N>,
}

impl<'a, const N: usize> Rays<'a, N> {
    /// Rays to distances (m, increasing), of which one may be that of the ground: its index, `usize::MAX` if there is none.
    pub fn new(
        fog: &'a FogLanes<N>,
        field: &'a Field<N>,
        ray: &RaySegment,
        lengths_m: &[f64],
        ground: usize,
    ) -> Self {
        let mut rays = Self {
            fog,
            field,
            sin_elevation: ray.sin_elevation,
            parts: Vec::with_capacity(lengths_m.len()),
            ends: Vec::with_capacity(lengths_m.len()),
            ground: usize::MAX,
        };
        let heights_m = fog.heights_between_layers_m(field);
        let mut depth = Spectrum::ZERO;
        let mut from_m = 0.0;
        for (k, &length_m) in lengths_m.iter().enumerate() {
            let until_m = length_m.max(from_m);
            split_at_heights(&ray.part(from_m, until_m), &heights_m, |segment| {
                let columns_m = fog.columns_along_m(segment);
                let along = rays.sum(&columns_m, |layer| layer.extinction_per_m);
                rays.parts.push(Part {
                    segment: *segment,
                    columns_m,
                    before: depth.exp_neg(),
                });
                depth += along;
                true
            });
            rays.ends.push(rays.parts.len());
            if k == ground {
                rays.ground = rays.parts.len();
            }
            from_m = until_m;
        }
        rays
    }

    /// Light of one azimuth mode that a layer scatters, not counting sunlight that is scattered once, divided by the power of the cosine
    /// of the elevation: the terms of [`FogLanes::path`].
    pub fn diffuse(&self, layer: usize, mode: usize) -> Vec<Spectrum<N>> {
        let field = self.field;
        let weights = multiple::of_mode(self.sin_elevation, mode);
        let scattered = |part: &RaySegment| field.scattered_of_mode(part, &weights, mode);
        let (sky, ground) = match mode {
            0 => (self.fog.lighting.ambient, field.ground_radiance),
            _ => (Spectrum::ZERO, Spectrum::ZERO),
        };
        let beyond = match self.sin_elevation < 0.0 {
            true => ground,
            false => sky,
        };
        let seen = MergedLayer::seen_extinction;
        self.added(layer, seen, seen, scattered, beyond)
    }

    /// Sunlight that layers scatter once in a stream with coefficients towards the eye, as far as a layer adds it to the ray, per unit of
    /// irradiance.
    pub fn sunlit(
        &self,
        layer: usize,
        towards_eye: impl Fn(&MergedLayer<N>) -> Spectrum<N>,
        stream: usize,
    ) -> Vec<Spectrum<N>> {
        let extinctions = |s: &MergedLayer<N>| s.stream_extinctions().map(|all| [all[stream]]);
        let single = self
            .fog
            .single_scattering(extinctions, |s| [towards_eye(s)]);
        let scattered = |part: &RaySegment| single.along(part, &|_| Spectrum::ZERO).0[0];
        let extinction = |s: &MergedLayer<N>| extinctions(s)[0][0];
        self.added(layer, &towards_eye, extinction, scattered, Spectrum::ZERO)
    }

    /// What peaks scatter again of a stream, as far as a layer adds it to the ray, per unit of irradiance and of mean scattering towards
    /// the eye.
    pub fn scattered_again(&self, layer: usize, stream: usize) -> Vec<Spectrum<N>> {
        let kind = DEGREES + stream;
        let scattered = |part: &RaySegment| self.field.scattered_by_peaks(part, kind);
        let seen = MergedLayer::seen_extinction;
        self.added(layer, seen, seen, scattered, Spectrum::ZERO)
    }

    /// What a layer adds to the path radiance up to each distance: of the light that parts scatter, its share by a coefficient of the
    /// layers, attenuated by an extinction along the ray, and of light from `beyond` the fog.
    fn added(
        &self,
        layer: usize,
        scattering: impl Fn(&MergedLayer<N>) -> Spectrum<N>,
        extinction: impl Fn(&MergedLayer<N>) -> Spectrum<N>,
        scattered: impl Fn(&RaySegment) -> Spectrum<N>,
        beyond: Spectrum<N>,
    ) -> Vec<Spectrum<N>> {
        let unscattered = |s: &MergedLayer<N>| s.extinction_per_m - extinction(s);
        let light: Vec<[Spectrum<N>; 2]> = self
            .parts
            .iter()
            .map(|part| match part.segment.length_m > 0.0 {
                true => [
                    scattered(&part.segment),
                    self.sum(&part.columns_m, &extinction),
                ],
                false => [Spectrum::ZERO; 2],
            })
            .collect();
        // Radiance at the end of each part from beyond it; beyond the ground that of the ground.
        let mut arriving = vec![beyond; self.parts.len()];
        for k in (1..self.parts.len()).rev().filter(|&k| k < self.ground) {
            let [light, depth] = light[k];
            arriving[k - 1] = light + depth.exp_neg() * arriving[k];
        }
        // Share of the light from the end that all peaks scatter into the ray.
        let by_peaks = |seen: Spectrum<N>, kept: Spectrum<N>| {
            seen.exp_neg() * kept * kept.mean_transmittance()
        };
        let (mut sum, mut seen, mut kept) = (Spectrum::ZERO, Spectrum::ZERO, Spectrum::ZERO);
        let mut sums = vec![sum];
        for (k, part) in self.parts.iter().enumerate() {
            let [light, depth] = light[k];
            let kept_here = self.sum(&part.columns_m, |s| unscattered(s).max_scalar(0.0));
            let own_light = self.share(part, layer, &scattering);
            let own_peak = self.share(part, layer, unscattered);
            let (light, peak) = match k < self.ground {
                true => (
                    part.before * light,
                    part.before * by_peaks(depth, kept_here),
                ),
                // Below the ground the same light arrives at each place.
                false => (
                    seen.exp_neg() * light,
                    by_peaks(seen + depth, kept + kept_here) - by_peaks(seen, kept),
                ),
            };
            sum += own_light * light + own_peak * peak * arriving[k];
            sums.push(sum);
            (seen, kept) = (seen + depth, kept + kept_here);
        }
        self.ends.iter().map(|&end| sums[end]).collect()
    }

    /// Optical depth of columns by an extinction coefficient of the layers.
    fn sum(
        &self,
        columns_m: &[f32],
        extinction: impl Fn(&MergedLayer<N>) -> Spectrum<N>,
    ) -> Spectrum<N> {
        let each = self.fog.layers.iter().zip(columns_m);
        each.fold(Spectrum::ZERO, |sum, (layer, &column_m)| {
            sum.scale_acc(extinction(layer), column_m)
        })
    }

    /// Share of a layer in the optical depth of a part by a coefficient of the layers.
    fn share(
        &self,
        part: &Part<N>,
        layer: usize,
        coefficient: impl Fn(&MergedLayer<N>) -> Spectrum<N>,
    ) -> Spectrum<N> {
        if let [_] = &self.fog.layers[..] {
            return Spectrum::ONE;
        }
        let own = coefficient(&self.fog.layers[layer]) * part.columns_m[layer];
        let whole = self.sum(&part.columns_m, coefficient);
        Spectrum::from_fn(|lane| match whole[lane] > 0.0 {
            true => own[lane] / whole[lane],
            false => 0.0,
        })
    }
}

impl<const N: usize> FogLanes<N> {
    /// Columns of the layers along a ray, m.
    fn columns_along_m(&self, ray: &RaySegment) -> Vec<f32> {
        let column = |layer: &MergedLayer<N>| layer.density.column_along_m(ray).min(OPAQUE) as f32;
        self.layers.iter().map(column).collect()
    }

    /// Heights between which the ratio of the layers varies little, in increasing order, m; none for a single layer.
    fn heights_between_layers_m(&self, field: &Field<N>) -> Vec<f64> {
        if let [_] = &self.layers[..] {
            return Vec::new();
        }
        let mut heights_m = [field.heights_m(), &self.breakpoints_m].concat();
        heights_m.sort_by(f64::total_cmp);
        heights_m.dedup();
        heights_m
    }
}
