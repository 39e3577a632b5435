//! Light along one line of sight: exact single scattering, the solved field for all higher orders, the ground.

use super::air::Air;
use super::harmonics::Harmonics;
use super::march::Marcher;
use super::orders::Diffuse;
use super::ray::Ray;
use super::shell::{MAX_CONSTITUENTS, PerConstituent};
use crate::spectrum::Spectrum;
use std::ops::ControlFlow;

/// What a line of sight brings, per unit solar irradiance (1/sr).
#[derive(Clone, Copy, Debug)]
pub struct Light<const N: usize> {
    /// Transmittance to the end of the line.
    pub transmittance: Spectrum<N>,
    /// Sunlight scattered once, by scatterer and before its phase function is applied (no unit).
    pub unphased: [Spectrum<N>; MAX_CONSTITUENTS],
    /// The same for sunlight that forward peaks have scattered before, still going the sun's way.
    pub unphased_forward: [Spectrum<N>; MAX_CONSTITUENTS],
    /// Other light scattered or reflected before, scattered into the line of sight.
    pub diffuse: Spectrum<N>,
    /// What of the ground's own radiance arrives, where the line ends on the ground.
    pub ground: Spectrum<N>,
    /// Whether the line ends on the ground.
    pub meets_ground: bool,
}

impl<const N: usize> Light<N> {
    const NOTHING: Self = Self {
        transmittance: Spectrum::ONE,
        unphased: [Spectrum::ZERO; MAX_CONSTITUENTS],
        unphased_forward: [Spectrum::ZERO; MAX_CONSTITUENTS],
        diffuse: Spectrum::ZERO,
        ground: Spectrum::ZERO,
        meets_ground: false,
    };

    /// Sunlight scattered once, with the phase functions at the scattering angle whose cosine is `nu`.
    pub fn single(&self, air: &Air<N>, nu: f64) -> Spectrum<N> {
        phased(air, &self.unphased, nu)
    }

    /// Light scattered or reflected more than once, its last time on the way.
    pub fn multiple(&self, air: &Air<N>, nu: f64) -> Spectrum<N> {
        self.diffuse + phased(air, &self.unphased_forward, nu)
    }
}

fn phased<const N: usize>(air: &Air<N>, unphased: &[Spectrum<N>], nu: f64) -> Spectrum<N> {
    let mut sum = Spectrum::ZERO;
    for (s, unphased) in air.scatterers.iter().zip(unphased) {
        sum = sum.mul_acc(*unphased, s.phase(air, nu));
    }
    sum
}

/// Follows lines of sight through air lit by the sun and by a solved field.
pub struct Tracer<'a, const N: usize> {
    /// The air.
    pub air: &'a Air<N>,
    /// Multiply scattered light, if it is wanted.
    pub diffuse: Option<&'a Diffuse<N>>,
    /// How it walks.
    pub marcher: Marcher,
    edges: Vec<f64>,
}

impl<'a, const N: usize> Tracer<'a, N> {
    /// A tracer at full accuracy.
    pub fn new(air: &'a Air<N>, diffuse: Option<&'a Diffuse<N>>) -> Self {
        Self {
            air,
            diffuse,
            marcher: Marcher::new(4, 2.0, air.max_extinction_per_m()),
            edges: Vec::new(),
        }
    }

    /// The light along `ray`, over at most `limit_m`.
    #[inline(always)]
    pub fn trace(&mut self, ray: &Ray, limit_m: f64) -> Light<N> {
        let (air, shell) = (self.air, &self.air.shell);
        let mut light = Light::NOTHING;
        let Some(stretch) = shell.stretch(ray, limit_m) else {
            return light;
        };
        let mut y = [0.0f32; Harmonics::MAX_COUNT];
        let columns = self.marcher.walk(
            shell,
            ray,
            (stretch.start_m, stretch.end_m),
            &mut self.edges,
            #[inline(always)]
            |nodes| {
                let mut brightest = 0.0f32;
                for node in nodes {
                    let depth = air.optical_depth(&node.columns_m);
                    let transmittance = (Spectrum::ZERO - depth).exp();
                    brightest = brightest.max(transmittance.max_element());
                    if node.lit {
                        let to_sun = shell.columns_to_space_m(node.here.radius_m, node.here.mu_sun);
                        let single = (Spectrum::ZERO - depth - air.optical_depth(&to_sun)).exp();
                        add_scattered(air, &node.densities, node.dt, single, &mut light.unphased);
                        if let Some(diffuse) = self.diffuse {
                            let all =
                                (Spectrum::ZERO - depth - diffuse.air.optical_depth(&to_sun)).exp();
                            add_scattered(
                                air,
                                &node.densities,
                                node.dt,
                                all - single,
                                &mut light.unphased_forward,
                            );
                        }
                    }
                    if let Some(Diffuse { field, .. }) = self.diffuse {
                        field.basis.evaluate(
                            node.here.mu as f32,
                            node.here.toward_sun() as f32,
                            &mut y,
                        );
                        let source = field.source(air, &node.here, &node.densities, &y);
                        light.diffuse = light
                            .diffuse
                            .mul_acc(transmittance * node.dt as f32, source);
                    }
                }
                if brightest < 1e-7 {
                    ControlFlow::Break(())
                } else {
                    ControlFlow::Continue(())
                }
            },
        );
        for (k, s) in air.scatterers.iter().enumerate() {
            light.unphased[k] *= s.scattering;
            light.unphased_forward[k] *= s.scattering;
        }
        light.transmittance = air.transmittance(&columns);
        light.meets_ground = stretch.meets_ground;
        if stretch.meets_ground {
            light.ground =
                light.transmittance * self.ground_radiance(ray.advanced(stretch.end_m).mu_sun);
        }
        light
    }

    /// Radiance of the ground where the sun's cosine is `mu_sun`, per unit solar irradiance.
    #[inline(always)]
    pub fn ground_radiance(&self, mu_sun: f64) -> Spectrum<N> {
        self.air
            .reflected(ground_irradiance(self.air, self.diffuse, mu_sun))
    }
}

/// Irradiance of the ground where the sun's cosine is `mu_sun`, of sun and sky, per unit solar irradiance.
#[inline(always)]
pub fn ground_irradiance<const N: usize>(
    air: &Air<N>,
    diffuse: Option<&Diffuse<N>>,
    mu_sun: f64,
) -> Spectrum<N> {
    match diffuse {
        Some(diffuse) => {
            diffuse.field.ground_irradiance(mu_sun) + sun_on_ground(&diffuse.air, mu_sun)
        }
        None => sun_on_ground(air, mu_sun),
    }
}

/// Adds what is scattered of the light `arriving` at a node, per unit scattering coefficient.
#[inline(always)]
fn add_scattered<const N: usize>(
    air: &Air<N>,
    densities: &PerConstituent,
    dt: f64,
    arriving: Spectrum<N>,
    sums: &mut [Spectrum<N>],
) {
    for (s, sum) in air.scatterers.iter().zip(sums) {
        *sum = sum.scale_acc(arriving, (densities[s.constituent] * dt) as f32);
    }
}

/// Irradiance of the ground where the sun's cosine is `mu_sun`, of the sun alone, per unit solar irradiance.
#[inline(always)]
pub fn sun_on_ground<const N: usize>(air: &Air<N>, mu_sun: f64) -> Spectrum<N> {
    if mu_sun <= 0.0 {
        return Spectrum::ZERO;
    }
    let columns = air
        .shell
        .columns_to_space_m(air.shell.ground_radius_m, mu_sun);
    air.transmittance(&columns) * mu_sun as f32
}
