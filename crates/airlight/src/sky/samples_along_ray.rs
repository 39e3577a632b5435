//! Light at many distances along a view ray, from one march along the ray.
//!
//! Let `P(d) = integral of T' J'` be the light accumulated up to a sample in air without forward peaks, and `L'` all light
//! that reaches the eye along the whole ray in that air. The light from behind the sample is `(L' - P) / T'`, and the path
//! radiance of [`super::trace`], `S = P + (T' - T) (L' - P) / T'`, becomes
//!
//! ```text
//! S(d) = P(d) T/T' + (1 - T/T') L'
//! ```
//!
//! without cancellation and without a separate march for each sample, for each stream of singly scattered sunlight and for all
//! other light. As S is linear in P and L', it can be stored by scatterer and without phase functions, as in the sky's
//! tables.

use super::field::ground_irradiance;
use super::harmonics::Harmonics;
use super::trace::{Arriving, Tracer};
use crate::spectrum::Spectrum;
use crate::transfer::march::Marcher;
use crate::transfer::ray::Ray;
use crate::transfer::residual::{STREAMS, scattered_into_peaks};
use crate::transfer::shell::{MAX_CONSTITUENTS, PerConstituent};
use std::ops::ControlFlow;

/// Light from the eye to one sample, per unit solar irradiance (1/sr).
#[derive(Clone, Copy, Debug)]
pub struct RaySample<const N: usize> {
    /// Optical depth of the real air.
    pub depth: Spectrum<N>,
    /// Streams of singly scattered sunlight by scatterer, without its phase function.
    pub streams: [[Spectrum<N>; STREAMS]; MAX_CONSTITUENTS],
    /// All other path radiance.
    pub multiple_scatter: Spectrum<N>,
}

/// Columns and light accumulated up to a distance.
#[derive(Clone, Copy)]
struct Accumulated<const N: usize> {
    columns_m: PerConstituent,
    /// Light, with single scattering per unit scattering coefficient.
    path: Arriving<N>,
}

/// Number of quadrature nodes in a panel: panels between samples are short.
const NODES: usize = 3;

impl<const N: usize> Tracer<'_, N> {
    /// Light from the eye to each of the increasing distances `samples_m`, which are clamped to the end of the ray.
    #[inline(always)]
    pub fn samples_along_ray(&mut self, ray: &Ray, samples_m: &[f64]) -> Vec<RaySample<N>> {
        let mut accumulated = Accumulated {
            columns_m: [0.0; MAX_CONSTITUENTS],
            path: Arriving::NONE,
        };
        let Some(segment) = self.air.shell().segment(ray, f64::INFINITY) else {
            let none = self.sample(&accumulated, &accumulated.path);
            return vec![none; samples_m.len()];
        };
        let marcher = Marcher::new(
            &self.air.panel_radii_m,
            NODES,
            2.0,
            self.air.coefficients.max_extinction_per_m(),
        );
        let mut from_m = segment.start_m;
        let mut all = Vec::with_capacity(samples_m.len());
        for sample_m in samples_m {
            let to_m = sample_m.clamp(from_m, segment.end_m);
            if to_m > from_m {
                self.accumulate(&marcher, ray, (from_m, to_m), &mut accumulated);
            }
            from_m = to_m;
            all.push(accumulated);
        }
        // The light from beyond the samples matters only with forward peaks.
        if self.diffuse.is_some() {
            if segment.end_m > from_m {
                self.accumulate(&marcher, ray, (from_m, segment.end_m), &mut accumulated);
            }
            if segment.meets_ground {
                let irradiance =
                    ground_irradiance(self.air, self.diffuse, ray.advanced(segment.end_m).mu_sun);
                let arriving = self
                    .dimming
                    .coefficients
                    .transmittance(&accumulated.columns_m);
                accumulated.path.multiple_scatter = accumulated
                    .path
                    .multiple_scatter
                    .mul_acc(arriving, self.air.coefficients.reflected(irradiance));
            }
        }
        all.iter()
            .map(|one| self.sample(one, &accumulated.path))
            .collect()
    }

    /// Path radiance `S = P T/T' + (1 - T/T') L'` and optical depth of a sample.
    #[inline(always)]
    fn sample(&self, accumulated: &Accumulated<N>, whole: &Arriving<N>) -> RaySample<N> {
        let removed = self.dimming.peaks.extinction(&accumulated.columns_m);
        let replaced = scattered_into_peaks(removed);
        let mix = |near: Spectrum<N>, whole: Spectrum<N>, k: usize| {
            near.mul_acc(replaced[k], whole - near)
        };
        let near = &accumulated.path;
        let mut streams = [[Spectrum::ZERO; STREAMS]; MAX_CONSTITUENTS];
        for (s, scatterer) in self.air.scatterers.iter().enumerate() {
            streams[s] = std::array::from_fn(|k| {
                mix(near.streams[s][k], whole.streams[s][k], k) * scatterer.whole_scattering
            });
        }
        RaySample {
            depth: self.air.coefficients.extinction(&accumulated.columns_m),
            streams,
            multiple_scatter: mix(near.multiple_scatter, whole.multiple_scatter, 0),
        }
    }

    /// Adds the light between two distances to that accumulated up to the first.
    #[inline(always)]
    fn accumulate(
        &mut self,
        marcher: &Marcher,
        ray: &Ray,
        span: (f64, f64),
        accumulated: &mut Accumulated<N>,
    ) {
        let dimming = self.dimming;
        let transmittance_before = dimming.coefficients.transmittance(&accumulated.columns_m);
        let mut y = [0.0f32; Harmonics::MAX_COUNT];
        let mut edges = std::mem::take(&mut self.edges);
        let path = &mut accumulated.path;
        let before_m = accumulated.columns_m;
        marcher.march(
            self.air.shell(),
            ray,
            span,
            &mut edges,
            #[inline(always)]
            |step| {
                for node in step.nodes {
                    let transmittance =
                        transmittance_before * dimming.coefficients.transmittance(&node.columns_m);
                    let weight = transmittance * node.dt as f32;
                    let from_eye = std::array::from_fn(|c| before_m[c] + node.columns_m[c]);
                    self.add(node, weight, &from_eye, &mut y, path);
                }
                ControlFlow::Continue(())
            },
        );
        let columns_m = self.air.columns.along_m(ray, span, &mut edges);
        self.edges = edges;
        for (sum, column) in accumulated.columns_m.iter_mut().zip(columns_m) {
            *sum += column;
        }
    }
}
