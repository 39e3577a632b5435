//! Light along one line of sight: exact single scattering, the solved field for all higher orders, the ground.

use super::air::Air;
use super::field::RadianceField;
use super::harmonics::Harmonics;
use super::march::Marcher;
use super::ray::Ray;
use super::shell::MAX_CONSTITUENTS;
use crate::spectrum::Spectrum;
use std::ops::ControlFlow;

/// What a line of sight brings, per unit solar irradiance (1/sr).
#[derive(Clone, Copy, Debug)]
pub struct Light<const N: usize> {
    /// Transmittance to the end of the line.
    pub transmittance: Spectrum<N>,
    /// Sunlight scattered once, by scatterer and before its phase function is applied (no unit).
    pub unphased: [Spectrum<N>; MAX_CONSTITUENTS],
    /// Light scattered or reflected before, scattered into the line of sight.
    pub multiple: Spectrum<N>,
    /// What of the ground's own radiance arrives, where the line ends on the ground.
    pub ground: Spectrum<N>,
    /// Whether the line ends on the ground.
    pub meets_ground: bool,
}

impl<const N: usize> Light<N> {
    const NOTHING: Self = Self {
        transmittance: Spectrum::ONE,
        unphased: [Spectrum::ZERO; MAX_CONSTITUENTS],
        multiple: Spectrum::ZERO,
        ground: Spectrum::ZERO,
        meets_ground: false,
    };

    /// Sunlight scattered once, with the phase functions at the scattering angle whose cosine is `nu`.
    pub fn single(&self, air: &Air<N>, nu: f64) -> Spectrum<N> {
        let mut sum = Spectrum::ZERO;
        for (s, unphased) in air.scatterers.iter().zip(&self.unphased) {
            sum = sum.mul_acc(*unphased, s.phase(air, nu));
        }
        sum
    }
}

/// Follows lines of sight through air lit by the sun and by a solved field.
pub struct Tracer<'a, const N: usize> {
    /// The air.
    pub air: &'a Air<N>,
    /// Multiply scattered light, if it is wanted.
    pub field: Option<&'a RadianceField<N>>,
    /// How it walks.
    pub marcher: Marcher,
    edges: Vec<f64>,
}

impl<'a, const N: usize> Tracer<'a, N> {
    /// A tracer at full accuracy.
    pub fn new(air: &'a Air<N>, field: Option<&'a RadianceField<N>>) -> Self {
        Self {
            air,
            field,
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
        if let Some(field) = self.field {
            field.basis.evaluate_zonal(ray.nu as f32, &mut y);
        }
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
                        let arriving = (Spectrum::ZERO - depth - air.optical_depth(&to_sun)).exp();
                        for (s, sum) in air.scatterers.iter().zip(&mut light.unphased) {
                            *sum = sum.scale_acc(
                                arriving,
                                (node.densities[s.constituent] * node.dt) as f32,
                            );
                        }
                    }
                    if let Some(field) = self.field {
                        let (mu, toward_sun) = (node.here.mu as f32, node.here.toward_sun() as f32);
                        field.basis.evaluate_local(mu, toward_sun, &mut y);
                        let source = field.source(air, &node.here, &node.densities, &y);
                        light.multiple = light
                            .multiple
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
        for (s, sum) in air.scatterers.iter().zip(&mut light.unphased) {
            *sum *= s.scattering;
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
            .reflected(ground_irradiance(self.air, self.field, mu_sun))
    }
}

/// Irradiance of the ground where the sun's cosine is `mu_sun`, of sun and sky, per unit solar irradiance.
#[inline(always)]
pub fn ground_irradiance<const N: usize>(
    air: &Air<N>,
    field: Option<&RadianceField<N>>,
    mu_sun: f64,
) -> Spectrum<N> {
    let diffuse = field.map_or(Spectrum::ZERO, |field| field.ground_irradiance(mu_sun));
    diffuse + sun_on_ground(air, mu_sun)
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
