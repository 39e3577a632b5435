//! Light along a line, kept at many stops on the way: one walk tells what the air does up to each.
//!
//! With `P(d)` gathered up to a stop in air without forward peaks, `P(d) = integral of T' J'`, and `L'` all that arrives at
//! the eye along the whole line in that air, the light behind the stop is `(L' - P) / T'`; the path radiance of
//! [`super::trace`], `S = P + (T' - T) (L' - P) / T'`, becomes
//!
//! ```text
//! S(d) = P(d) T/T' + (1 - T/T') L'
//! ```
//!
//! in which nothing cancels and nothing has to be walked anew for each stop. As S is linear in P and L', it may be kept by
//! scatterer and without phase functions, like the sky's tables.

use super::harmonics::Harmonics;
use super::trace::{Arriving, Tracer, ground_irradiance};
use crate::spectrum::Spectrum;
use crate::transfer::march::Marcher;
use crate::transfer::ray::Ray;
use crate::transfer::shell::{MAX_CONSTITUENTS, PerConstituent};
use std::ops::ControlFlow;

/// What lies between the eye and one stop, per unit solar irradiance (1/sr).
#[derive(Clone, Copy, Debug)]
pub struct Stop<const N: usize> {
    /// Optical depth of the real air.
    pub depth: Spectrum<N>,
    /// Path radiance: sunlight scattered for the first time, by the scatterer that sent it here and before its phase
    /// function is applied, and all other light.
    pub path: Arriving<N>,
}

/// What has been gathered up to a distance.
#[derive(Clone, Copy)]
struct Gathered<const N: usize> {
    columns_m: PerConstituent,
    /// First scattering without its coefficients.
    path: Arriving<N>,
}

/// Quadrature nodes of a panel: stops are close to each other, so that panels are short.
const NODES: usize = 3;

impl<const N: usize> Tracer<'_, N> {
    /// What lies between the eye and each of the rising distances `stops_m`; those beyond the end of the line are held at
    /// it.
    #[inline(always)]
    pub fn stops(&mut self, ray: &Ray, stops_m: &[f64]) -> Vec<Stop<N>> {
        let mut gathered = Gathered {
            columns_m: [0.0; MAX_CONSTITUENTS],
            path: Arriving {
                single_scatter_without_phase: [Spectrum::ZERO; MAX_CONSTITUENTS],
                multiple_scatter: Spectrum::ZERO,
            },
        };
        let Some(stretch) = self.air.shell.stretch(ray, f64::INFINITY) else {
            return vec![self.stop(&gathered, &gathered.path); stops_m.len()];
        };
        let marcher = Marcher::new(NODES, 2.0, self.air.max_extinction_per_m());
        let mut from_m = stretch.start_m;
        let mut all = Vec::with_capacity(stops_m.len());
        for stop_m in stops_m {
            let to_m = stop_m.clamp(from_m, stretch.end_m);
            if to_m > from_m {
                self.gather(&marcher, ray, (from_m, to_m), &mut gathered);
            }
            from_m = to_m;
            all.push(gathered);
        }
        // Only forward peaks make the light from beyond the stops matter.
        if self.diffuse.is_some() {
            if stretch.end_m > from_m {
                self.gather(&marcher, ray, (from_m, stretch.end_m), &mut gathered);
            }
            if stretch.meets_ground {
                let irradiance =
                    ground_irradiance(self.air, self.diffuse, ray.advanced(stretch.end_m).mu_sun);
                let arriving = self.dimming.transmittance(&gathered.columns_m);
                gathered.path.multiple_scatter = gathered
                    .path
                    .multiple_scatter
                    .mul_acc(arriving, self.air.reflected(irradiance));
            }
        }
        all.iter()
            .map(|one| self.stop(one, &gathered.path))
            .collect()
    }

    /// `S = P T/T' + (1 - T/T') L'`.
    #[inline(always)]
    fn stop(&self, gathered: &Gathered<N>, whole: &Arriving<N>) -> Stop<N> {
        let depth = self.air.optical_depth(&gathered.columns_m);
        let into_peaks = depth - self.dimming.optical_depth(&gathered.columns_m);
        let replaced = into_peaks.map(|tau| -(-tau).exp_m1());
        let mix = |own: Spectrum<N>, whole: Spectrum<N>| own.mul_acc(replaced, whole - own);
        let (own, whole) = (&gathered.path, whole);
        let mut path = *own;
        path.multiple_scatter = mix(own.multiple_scatter, whole.multiple_scatter);
        for (s, scatterer) in self.air.scatterers.iter().enumerate() {
            path.single_scatter_without_phase[s] = mix(
                own.single_scatter_without_phase[s],
                whole.single_scatter_without_phase[s],
            ) * scatterer.whole_scattering;
        }
        Stop { depth, path }
    }

    /// Adds what lies between two distances to what has been gathered up to the first.
    #[inline(always)]
    fn gather(
        &mut self,
        marcher: &Marcher,
        ray: &Ray,
        span: (f64, f64),
        gathered: &mut Gathered<N>,
    ) {
        let dimming = self.dimming;
        let seen = dimming.transmittance(&gathered.columns_m);
        let mut y = [0.0f32; Harmonics::MAX_COUNT];
        let mut edges = std::mem::take(&mut self.edges);
        let path = &mut gathered.path;
        let columns_m = marcher.walk(
            &self.air.shell,
            ray,
            span,
            &mut edges,
            #[inline(always)]
            |nodes| {
                for node in nodes {
                    let transmittance = seen * dimming.transmittance(&node.columns_m);
                    let weight = transmittance * node.dt as f32;
                    self.add(node, weight, &mut y, path);
                }
                ControlFlow::Continue(())
            },
        );
        self.edges = edges;
        for (sum, column) in gathered.columns_m.iter_mut().zip(columns_m) {
            *sum += column;
        }
    }
}
