//! Light along one view ray.
//!
//! Singly scattered sunlight is integrated with the exact phase functions; all other light comes from the solved field. As
//! in the field, light scattered into a forward peak counts as not scattered (delta-M), so all light on its way to the eye
//! is attenuated by the transmittance `T'` of the air without forward peaks. Using the exact phase function for single
//! scattering is the TMS correction of Nakajima & Tanaka (J. Quant. Spectrosc. Radiat. Transfer 40, 51, 1988). A background
//! with its own detail is attenuated by the real transmittance `T`: for a segment at whose end the light `L'` arrives from
//! behind, the path radiance is
//!
//! ```text
//! S = integral of T' J' + (T' - T) L'
//! ```
//!
//! This composes exactly: splitting the segment does not change the result. Singly scattered sunlight consists of streams
//! ([`crate::transfer::residual`]), for each of which the air without forward peaks has an extinction of its own.

use super::air::Air;
use super::field::{Diffuse, ground_irradiance};
use super::harmonics::Harmonics;
use super::polarised::{TensorHarmonics, scattering_plane};
use super::ray_bundle::linear_gain;
use crate::spectrum::Spectrum;
use crate::transfer::march::{Marcher, Node};
use crate::transfer::ray::Ray;
use crate::transfer::residual::{STREAMS, combined, scattered_into_peaks, stream_transmittances};
use crate::transfer::shell::{MAX_CONSTITUENTS, PerConstituent};
use std::ops::ControlFlow;

/// Light along a view ray, per unit solar irradiance (1/sr).
#[derive(Clone, Copy, Debug)]
pub struct Light<const N: usize> {
    /// Transmittance to the end of the ray.
    pub transmittance: Spectrum<N>,
    /// Singly scattered sunlight.
    pub single: Spectrum<N>,
    /// Light scattered or reflected more than once, last in the air along the ray.
    pub multiple: Spectrum<N>,
    /// Attenuated ground radiance, if the ray ends on the ground.
    pub ground: Spectrum<N>,
    /// True if the ray ends on the ground.
    pub meets_ground: bool,
}

/// All light along an unlimited view ray, per unit solar irradiance (1/sr).
#[derive(Clone, Copy, Debug)]
pub struct Arriving<const N: usize> {
    /// Singly scattered sunlight by scatterer and stream, each as if it held all light, per unit scattering coefficient
    /// and without the phase function, m.
    pub streams: [[Spectrum<N>; STREAMS]; MAX_CONSTITUENTS],
    /// All other light, including that of the ground.
    pub multiple_scatter: Spectrum<N>,
}

impl<const N: usize> Arriving<N> {
    /// No light.
    pub const NONE: Self = Self {
        streams: [[Spectrum::ZERO; STREAMS]; MAX_CONSTITUENTS],
        multiple_scatter: Spectrum::ZERO,
    };
}

/// Integrates light along view rays through air lit by the sun and by a solved field.
pub struct Tracer<'a, const N: usize> {
    /// The real air.
    pub(super) air: &'a Air<N>,
    /// The air that attenuates light on its way: that of the field if there is one, otherwise the real air.
    pub(super) dimming: &'a Air<N>,
    /// Multiply scattered light; `None` for single scattering.
    pub(super) diffuse: Option<&'a Diffuse<N>>,
    marcher: Marcher<'a>,
    pub(super) edges: Vec<f64>,
}

impl<'a, const N: usize> Tracer<'a, N> {
    /// Tracer with the step size for full accuracy.
    pub fn new(air: &'a Air<N>, diffuse: Option<&'a Diffuse<N>>) -> Self {
        Self {
            air,
            dimming: diffuse.map_or(air, |d| &d.air),
            diffuse,
            marcher: Self::marcher_along_ray(air),
            edges: Vec::new(),
        }
    }

    /// Marcher along whole rays, for full accuracy.
    pub fn marcher_along_ray(air: &'a Air<N>) -> Marcher<'a> {
        Self::marcher(air, 4)
    }

    /// Marcher along rays that are divided at many distances: panels between them are short.
    pub fn marcher_between_distances(air: &'a Air<N>) -> Marcher<'a> {
        Self::marcher(air, 3)
    }

    /// Marcher with a number of nodes in each panel.
    fn marcher(air: &'a Air<N>, nodes: usize) -> Marcher<'a> {
        /// Largest optical depth of a panel.
        const DEPTH: f64 = 2.0;
        let extinction = air.coefficients.max_extinction_per_m();
        Marcher::new(&air.panel_radii_m, nodes, DEPTH, extinction)
    }

    /// Light along `ray`, over at most `limit_m`.
    pub fn trace(&mut self, ray: &Ray, limit_m: f64) -> Light<N> {
        let (air, dimming) = (self.air, self.dimming);
        let Some(segment) = air.shell().segment(ray, limit_m) else {
            return Light {
                transmittance: Spectrum::ONE,
                single: Spectrum::ZERO,
                multiple: Spectrum::ZERO,
                ground: Spectrum::ZERO,
                meets_ground: false,
            };
        };
        let phases: Vec<_> = air
            .scatterers
            .iter()
            .map(|s| s.phase(air, ray.nu))
            .collect();
        let shares = dimming.shares(ray.nu);
        let (mut single, mut path) = (Spectrum::ZERO, Spectrum::ZERO);
        let mut y = [0.0f32; Harmonics::MAX_COUNT];
        let mut edges = std::mem::take(&mut self.edges);
        let span = (segment.start_m, segment.end_m);
        self.marcher
            .march(air.shell(), ray, span, &mut edges, |step| {
                let mut brightest = 0.0f32;
                for node in step.nodes {
                    let transmittance = dimming.coefficients.transmittance(&node.columns_m);
                    brightest = brightest.max(transmittance.max_element());
                    let mut source = self.source(node, &mut y);
                    if node.lit {
                        let to_sun = air.columns.to_space_m(node.here.radius_m, node.here.mu_sun);
                        let streams = stream_transmittances(
                            dimming.peaks.extinction(&to_sun)
                                + dimming.peaks.extinction(&node.columns_m),
                        );
                        let (mut scattering, mut kept) = (Spectrum::ZERO, Spectrum::ZERO);
                        for ((s, phase), shares) in air.scatterers.iter().zip(&phases).zip(&shares)
                        {
                            let density = node.densities[s.constituent] as f32;
                            let scattered = s.whole_scattering * *phase * density;
                            scattering += scattered;
                            kept = kept.mul_acc(scattered, combined(&streams, shares));
                        }
                        source = source.mul_acc(kept, dimming.coefficients.transmittance(&to_sun));
                        let once = (Spectrum::ZERO
                            - air.coefficients.extinction(&node.columns_m)
                            - air.coefficients.extinction(&to_sun))
                        .exp();
                        single = single.mul_acc(scattering * node.dt as f32, once);
                    }
                    path = path.mul_acc(transmittance * node.dt as f32, source);
                }
                if brightest < 1e-7 {
                    ControlFlow::Break(())
                } else {
                    ControlFlow::Continue(())
                }
            });
        let columns = air.columns.along_m(ray, span, &mut edges);
        self.edges = edges;
        let end = ray.advanced(segment.end_m);
        let ground = match segment.meets_ground {
            true => air
                .coefficients
                .reflected(ground_irradiance(air, self.diffuse, end.mu_sun)),
            false => Spectrum::ZERO,
        };
        let transmittance = air.coefficients.transmittance(&columns);
        if self.diffuse.is_some() {
            // T' - T, without cancellation if both are close to 1, or overflow if both are close to 0.
            let removed = dimming.peaks.extinction(&columns);
            let through = dimming.coefficients.transmittance(&columns);
            let lost = scattered_into_peaks(removed);
            if segment.meets_ground {
                path = path.mul_acc(through * lost[0], ground);
            } else {
                let behind = self.arriving(&end);
                path = path.mul_acc(through * lost[0], behind.multiple_scatter);
                let relative = stream_transmittances(removed);
                let into_peaks: [_; STREAMS] =
                    std::array::from_fn(|k| through * relative[k] * lost[k]);
                for (((s, phase), shares), streams) in air
                    .scatterers
                    .iter()
                    .zip(&phases)
                    .zip(&shares)
                    .zip(&behind.streams)
                {
                    let streams = std::array::from_fn(|k| streams[k] * into_peaks[k]);
                    path = path.mul_acc(combined(&streams, shares), s.whole_scattering * *phase);
                }
            }
        }
        Light {
            transmittance,
            single,
            multiple: match self.diffuse {
                Some(_) => (path - single).max_scalar(0.0),
                None => Spectrum::ZERO,
            },
            ground: transmittance * ground,
            meets_ground: segment.meets_ground,
        }
    }

    /// Light along the whole of `ray`, singly scattered per unit scattering coefficient.
    #[inline(always)]
    pub fn arriving(&mut self, ray: &Ray) -> Arriving<N> {
        let (air, dimming) = (self.air, self.dimming);
        let mut light = Arriving::NONE;
        let Some(segment) = air.shell().segment(ray, f64::INFINITY) else {
            return light;
        };
        let mut y = [0.0f32; Harmonics::MAX_COUNT];
        let mut edges = std::mem::take(&mut self.edges);
        let span = (segment.start_m, segment.end_m);
        let columns = self.marcher.march(
            air.shell(),
            ray,
            span,
            &mut edges,
            #[inline(always)]
            |step| {
                let mut brightest = 0.0f32;
                for node in step.nodes {
                    let transmittance = dimming.coefficients.transmittance(&node.columns_m);
                    brightest = brightest.max(transmittance.max_element());
                    let weight = transmittance * node.dt as f32;
                    self.add(node, weight, &node.columns_m, &mut y, &mut light);
                }
                if brightest < 1e-7 {
                    ControlFlow::Break(())
                } else {
                    ControlFlow::Continue(())
                }
            },
        );
        self.edges = edges;
        if segment.meets_ground {
            let irradiance =
                ground_irradiance(air, self.diffuse, ray.advanced(segment.end_m).mu_sun);
            light.multiple_scatter = light.multiple_scatter.mul_acc(
                dimming.coefficients.transmittance(&columns),
                air.coefficients.reflected(irradiance),
            );
        }
        light
    }

    /// Q and U of the light along the whole of `ray`, in the frame of [`super::polarised`], given the cosine of the azimuth between
    /// the ray and the sun.
    pub fn linear(&mut self, ray: &Ray, cos_azimuth: f64) -> [Spectrum<N>; 2] {
        let mut linear = [Spectrum::ZERO; 2];
        let Some(segment) = self.air.shell().segment(ray, f64::INFINITY) else {
            return linear;
        };
        let (dimming, diffuse) = (self.dimming, self.diffuse);
        // Sunlight attenuated as natural and as polarised light.
        let [mut natural, mut polarised] = [Arriving::NONE.streams; 2];
        let mut edges = std::mem::take(&mut self.edges);
        let span = (segment.start_m, segment.end_m);
        let shell = self.air.shell();
        self.marcher.march(shell, ray, span, &mut edges, |step| {
            let mut brightest = 0.0f32;
            for node in step.nodes {
                let transmittance = dimming.coefficients.transmittance(&node.columns_m);
                brightest = brightest.max(transmittance.max_element());
                let weight = transmittance * node.dt as f32;
                self.add_sunlight(node, weight, &node.columns_m, &mut natural);
                let weight = weight * linear_gain(dimming, &node.columns_m);
                self.add_sunlight(node, weight, &node.columns_m, &mut polarised);
                if let Some(Diffuse { field, air, .. }) = diffuse {
                    let here = &node.here;
                    let sin = ((1.0 - here.mu) * (1.0 + here.mu)).max(0.0).sqrt();
                    let cosine = match sin > 1e-5 {
                        true => (here.toward_sun() / sin).clamp(-1.0, 1.0),
                        false => cos_azimuth,
                    };
                    let harmonics = TensorHarmonics::amplitudes(here.mu as f32).at(cosine as f32);
                    let source = field.linear_source(air, here, &node.densities, &harmonics);
                    for (sum, source) in linear.iter_mut().zip(source) {
                        *sum = sum.mul_acc(weight, source);
                    }
                }
            }
            match brightest < 1e-7 {
                true => ControlFlow::Break(()),
                false => ControlFlow::Continue(()),
            }
        });
        self.edges = edges;
        let scatterers = dimming.scatterers.iter();
        let mut parallel = Spectrum::ZERO;
        for (s, (natural, polarised)) in scatterers.zip(natural.iter().zip(&polarised)) {
            if let Some(f12) = s.f12(ray.nu) {
                let streams = match s.polarises_smoothly() {
                    true => polarised,
                    false => natural,
                };
                let once = combined(streams, &s.shares(ray.nu));
                parallel = parallel.mul_acc(once, s.whole_scattering * f12);
            }
        }
        let plane = scattering_plane(ray.mu as f32, ray.mu_sun as f32, cos_azimuth as f32);
        for (sum, proportion) in linear.iter_mut().zip(plane) {
            *sum = sum.scale_acc(parallel, proportion);
        }
        linear
    }

    /// Adds the light scattered into the ray at a node, attenuated by `weight` (which includes the step length), behind these
    /// columns. Singly scattered sunlight is added per unit scattering coefficient. `y` is scratch space.
    #[inline(always)]
    pub(super) fn add(
        &self,
        node: &Node,
        weight: Spectrum<N>,
        columns_m: &PerConstituent,
        y: &mut [f32],
        light: &mut Arriving<N>,
    ) {
        light.multiple_scatter = light.multiple_scatter.mul_acc(weight, self.source(node, y));
        self.add_sunlight(node, weight, columns_m, &mut light.streams);
    }

    /// Adds only the singly scattered sunlight.
    #[inline(always)]
    fn add_sunlight(
        &self,
        node: &Node,
        weight: Spectrum<N>,
        columns_m: &PerConstituent,
        streams: &mut [[Spectrum<N>; STREAMS]; MAX_CONSTITUENTS],
    ) {
        if node.lit {
            let dimming = self.dimming;
            let to_sun = dimming
                .columns
                .to_space_m(node.here.radius_m, node.here.mu_sun);
            let sunlight = weight * dimming.coefficients.transmittance(&to_sun);
            let removed = dimming.peaks.extinction(&to_sun) + dimming.peaks.extinction(columns_m);
            let sunlight = stream_transmittances(removed).map(|stream| sunlight * stream);
            for (s, sums) in self.air.scatterers.iter().zip(streams) {
                let density = node.densities[s.constituent] as f32;
                for (sum, sunlight) in sums.iter_mut().zip(&sunlight) {
                    *sum = sum.scale_acc(*sunlight, density);
                }
            }
        }
    }

    /// Light of the field scattered into the ray at a node, per metre. `y` is scratch space.
    #[inline(always)]
    fn source(&self, node: &Node, y: &mut [f32]) -> Spectrum<N> {
        let Some(Diffuse { field, air, .. }) = self.diffuse else {
            return Spectrum::ZERO;
        };
        field
            .basis
            .evaluate(node.here.mu as f32, node.here.toward_sun() as f32, y);
        field.source(air, &node.here, &node.densities, y)
    }
}
