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
//! This composes exactly: splitting the segment does not change the result.

use super::air::Air;
use super::field::{Diffuse, ground_irradiance};
use super::harmonics::Harmonics;
use crate::spectrum::Spectrum;
use crate::transfer::march::{Marcher, Node};
use crate::transfer::ray::Ray;
use crate::transfer::shell::MAX_CONSTITUENTS;
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
    /// Singly scattered sunlight by scatterer, without its phase function (dimensionless).
    pub single_scatter_without_phase: [Spectrum<N>; MAX_CONSTITUENTS],
    /// All other light, including that of the ground.
    pub multiple_scatter: Spectrum<N>,
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
            marcher: Self::marcher(air),
            edges: Vec::new(),
        }
    }

    /// Marcher with the step size for full accuracy.
    pub fn marcher(air: &'a Air<N>) -> Marcher<'a> {
        let extinction = air.coefficients.max_extinction_per_m();
        Marcher::new(&air.panel_radii_m, 4, 2.0, extinction)
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
        let (mut single, mut path) = (Spectrum::ZERO, Spectrum::ZERO);
        let mut y = [0.0f32; Harmonics::MAX_COUNT];
        let mut edges = std::mem::take(&mut self.edges);
        let span = (segment.start_m, segment.end_m);
        self.marcher
            .march(air.shell(), ray, span, &mut edges, |nodes| {
                let mut brightest = 0.0f32;
                for node in nodes {
                    let transmittance = dimming.coefficients.transmittance(&node.columns_m);
                    brightest = brightest.max(transmittance.max_element());
                    let mut source = self.source(node, &mut y);
                    if node.lit {
                        let mut scattering = Spectrum::ZERO;
                        for (s, phase) in air.scatterers.iter().zip(&phases) {
                            let density = node.densities[s.constituent] as f32;
                            scattering = scattering.scale_acc(s.whole_scattering * *phase, density);
                        }
                        let to_sun = air.columns.to_space_m(node.here.radius_m, node.here.mu_sun);
                        source =
                            source.mul_acc(scattering, dimming.coefficients.transmittance(&to_sun));
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
        let behind = match segment.meets_ground {
            true => ground,
            false if self.diffuse.is_some() => self.radiance(&end),
            false => Spectrum::ZERO,
        };
        let transmittance = air.coefficients.transmittance(&columns);
        // T' - T, without cancellation if both are close to 1, or overflow if both are close to 0.
        let into_peaks =
            air.coefficients.extinction(&columns) - dimming.coefficients.extinction(&columns);
        let difference =
            dimming.coefficients.transmittance(&columns) * into_peaks.map(|tau| -(-tau).exp_m1());
        path = path.mul_acc(difference, behind);
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

    /// Total light along the whole of `ray`.
    fn radiance(&mut self, ray: &Ray) -> Spectrum<N> {
        let arriving = self.arriving(ray);
        let mut sum = arriving.multiple_scatter;
        for (s, single_scatter_without_phase) in self
            .air
            .scatterers
            .iter()
            .zip(&arriving.single_scatter_without_phase)
        {
            sum = sum.mul_acc(*single_scatter_without_phase, s.phase(self.air, ray.nu));
        }
        sum
    }

    /// Light along the whole of `ray`.
    #[inline(always)]
    pub fn arriving(&mut self, ray: &Ray) -> Arriving<N> {
        let (air, dimming) = (self.air, self.dimming);
        let mut light = Arriving {
            single_scatter_without_phase: [Spectrum::ZERO; MAX_CONSTITUENTS],
            multiple_scatter: Spectrum::ZERO,
        };
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
            |nodes| {
                let mut brightest = 0.0f32;
                for node in nodes {
                    let transmittance = dimming.coefficients.transmittance(&node.columns_m);
                    brightest = brightest.max(transmittance.max_element());
                    let weight = transmittance * node.dt as f32;
                    self.add(node, weight, &mut y, &mut light);
                }
                if brightest < 1e-7 {
                    ControlFlow::Break(())
                } else {
                    ControlFlow::Continue(())
                }
            },
        );
        self.edges = edges;
        for (s, sum) in air
            .scatterers
            .iter()
            .zip(&mut light.single_scatter_without_phase)
        {
            *sum *= s.whole_scattering;
        }
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

    /// Adds the light scattered into the ray at a node, attenuated by `weight` (which includes the step length). Singly
    /// scattered sunlight is added per unit scattering coefficient. `y` is scratch space.
    #[inline(always)]
    pub(super) fn add(
        &self,
        node: &Node,
        weight: Spectrum<N>,
        y: &mut [f32],
        light: &mut Arriving<N>,
    ) {
        light.multiple_scatter = light.multiple_scatter.mul_acc(weight, self.source(node, y));
        if node.lit {
            let sunlight = weight
                * self
                    .dimming
                    .transmittance_to_sun(node.here.radius_m, node.here.mu_sun);
            for (s, sum) in self
                .air
                .scatterers
                .iter()
                .zip(&mut light.single_scatter_without_phase)
            {
                *sum = sum.scale_acc(sunlight, node.densities[s.constituent] as f32);
            }
        }
    }

    /// Light of the field scattered into the ray at a node, per metre. `y` is scratch space.
    #[inline(always)]
    fn source(&self, node: &Node, y: &mut [f32]) -> Spectrum<N> {
        let Some(Diffuse { field, air }) = self.diffuse else {
            return Spectrum::ZERO;
        };
        field
            .basis
            .evaluate(node.here.mu as f32, node.here.toward_sun() as f32, y);
        field.source(air, &node.here, &node.densities, y)
    }
}
