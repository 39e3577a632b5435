//! Wavelengths in blocks of as many lanes as vector instructions like, behind one interface.

use super::SkySettings;
use super::air::Air;
use super::field::{FieldGrid, RadianceField};
use super::orders;
use super::ray::Ray;
use super::shell::Shell;
use super::trace::Tracer;
use super::vector::vectorized;
use super::{Scattering, SkyError};
use crate::medium::Atmosphere;
use crate::spectrum::Spectrum;
use rayon::prelude::*;
use std::sync::Arc;

/// What a line of sight brings at the wavelengths of a block, per unit solar irradiance.
#[derive(Clone, Debug, Default)]
pub struct BlockLight {
    pub transmittance: Vec<f32>,
    pub single: Vec<f32>,
    pub multiple: Vec<f32>,
    pub ground: Vec<f32>,
    pub meets_ground: bool,
}

/// How the light of a block's lanes is summed into the channels of a table.
#[derive(Clone, Debug)]
pub struct ChannelMatrix {
    /// `weights[channel][lane]`, solar irradiance included.
    pub weights: Vec<Vec<f32>>,
}

/// A solved sky at some wavelengths.
pub trait Block: Send + Sync {
    /// Number of wavelengths.
    fn lanes(&self) -> usize;

    /// Light along one ray.
    fn trace(&self, ray: &Ray, limit_m: f64) -> BlockLight;

    /// Transmittance from a point to space along `mu`; 0 where the planet is in the way.
    fn transmittance_to_space(&self, radius_m: f64, mu: f64) -> Vec<f32>;

    /// The scatterers whose phase function is peaked, by their place among the constituents, with their phase function
    /// averaged over the lanes.
    fn peaked_phase(&self, constituent: usize, nu: f64) -> f64;

    /// Adds the light along each ray to `out`: for each ray first one value a channel of all smooth light, then for each
    /// of the `peaked` constituents one value a channel, to be multiplied by the mean of its phase function.
    fn fill(&self, rays: &[Ray], matrix: &ChannelMatrix, peaked: &[usize], out: &mut [f32]);
}

/// Solves for all `wavelengths_nm` in blocks of fitting width.
pub fn solve(
    atmosphere: &Atmosphere,
    shell: &Arc<Shell>,
    wavelengths_nm: &[f64],
    settings: &SkySettings,
) -> Result<Vec<Box<dyn Block>>, SkyError> {
    match wavelengths_nm.len() {
        0..=4 => Ok(vec![Solved::<4>::boxed(
            atmosphere,
            shell,
            wavelengths_nm,
            settings,
        )]),
        5..=8 => Ok(vec![Solved::<8>::boxed(
            atmosphere,
            shell,
            wavelengths_nm,
            settings,
        )]),
        _ => Ok(wavelengths_nm
            .chunks(16)
            .map(|chunk| match chunk.len() {
                0..=8 => Solved::<8>::boxed(atmosphere, shell, chunk, settings),
                _ => Solved::<16>::boxed(atmosphere, shell, chunk, settings),
            })
            .collect()),
    }
}

struct Solved<const N: usize> {
    air: Air<N>,
    field: Option<RadianceField<N>>,
    /// Lanes in use; those beyond repeat the last wavelength.
    lanes: usize,
}

impl<const N: usize> Solved<N> {
    fn boxed(
        atmosphere: &Atmosphere,
        shell: &Arc<Shell>,
        wavelengths_nm: &[f64],
        settings: &SkySettings,
    ) -> Box<dyn Block> {
        let lanes = wavelengths_nm.len();
        let padded = std::array::from_fn(|lane| wavelengths_nm[lane.min(lanes - 1)]);
        let air = Air::<N>::new(
            atmosphere,
            shell.clone(),
            padded,
            settings.orders.zonal_degree,
        );
        let field =
            (settings.scattering == Scattering::All && !air.scatterers.is_empty()).then(|| {
                let zeniths = settings
                    .suns
                    .sun_zeniths_deg(shell.ground_radius_m, shell.top_radius_m);
                let grid = FieldGrid::new(&air, settings.altitudes, &zeniths);
                orders::solve(&air, grid, &settings.orders)
            });
        Box::new(Self { air, field, lanes })
    }

    fn tracer(&self) -> Tracer<'_, N> {
        Tracer::new(&self.air, self.field.as_ref())
    }

    fn used(&self, spectrum: &Spectrum<N>) -> Vec<f32> {
        spectrum.0[..self.lanes].to_vec()
    }
}

impl<const N: usize> Block for Solved<N> {
    fn lanes(&self) -> usize {
        self.lanes
    }

    fn trace(&self, ray: &Ray, limit_m: f64) -> BlockLight {
        let light = self.tracer().trace(ray, limit_m);
        BlockLight {
            transmittance: self.used(&light.transmittance),
            single: self.used(&light.single(&self.air, ray.nu)),
            multiple: self.used(&light.multiple),
            ground: self.used(&light.ground),
            meets_ground: light.meets_ground,
        }
    }

    fn transmittance_to_space(&self, radius_m: f64, mu: f64) -> Vec<f32> {
        let shell = &self.air.shell;
        let ray = Ray {
            radius_m,
            mu,
            mu_sun: 1.0,
            nu: mu,
        };
        if ray.distance_to_ground(shell.ground_radius_m).is_some() {
            return vec![0.0; self.lanes];
        }
        let Some(stretch) = shell.stretch(&ray, f64::INFINITY) else {
            return vec![1.0; self.lanes];
        };
        let entry = ray.advanced(stretch.start_m);
        self.used(
            &self
                .air
                .transmittance(&shell.columns_to_space_m(entry.radius_m, entry.mu)),
        )
    }

    fn peaked_phase(&self, constituent: usize, nu: f64) -> f64 {
        let scatterer = self
            .air
            .scatterers
            .iter()
            .find(|s| s.constituent == constituent);
        scatterer.map_or(0.0, |s| {
            let phase = s.phase(&self.air, nu);
            phase.0[..self.lanes]
                .iter()
                .map(|&p| f64::from(p))
                .sum::<f64>()
                / self.lanes as f64
        })
    }

    fn fill(&self, rays: &[Ray], matrix: &ChannelMatrix, peaked: &[usize], out: &mut [f32]) {
        const CHUNK: usize = 16;
        let channels = matrix.weights.len();
        let width = channels * (1 + peaked.len());
        let weights: Vec<Spectrum<N>> = matrix
            .weights
            .iter()
            .map(|row| Spectrum::from_fn(|lane| if lane < self.lanes { row[lane] } else { 0.0 }))
            .collect();
        out.par_chunks_mut(width * CHUNK)
            .zip(rays.par_chunks(CHUNK))
            .for_each(|(out, rays)| {
                vectorized(
                    #[inline(always)]
                    || {
                        let mut tracer = self.tracer();
                        for (ray, out) in rays.iter().zip(out.chunks_exact_mut(width)) {
                            let light = tracer.trace(ray, f64::INFINITY);
                            let (smooth, rest) = out.split_at_mut(channels);
                            let mut sum = light.multiple + light.ground;
                            for (s, unphased) in self.air.scatterers.iter().zip(&light.unphased) {
                                let phase = s.phase(&self.air, ray.nu);
                                match peaked.iter().position(|&c| c == s.constituent) {
                                    None => sum = sum.mul_acc(*unphased, phase),
                                    Some(place) => {
                                        let mean = self.peaked_phase(s.constituent, ray.nu) as f32;
                                        let value = *unphased * phase / mean;
                                        add_channels(
                                            &mut rest[place * channels..][..channels],
                                            &weights,
                                            &value,
                                        );
                                    }
                                }
                            }
                            add_channels(smooth, &weights, &sum);
                        }
                    },
                );
            });
    }
}

#[inline(always)]
fn add_channels<const N: usize>(out: &mut [f32], weights: &[Spectrum<N>], value: &Spectrum<N>) {
    for (out, weights) in out.iter_mut().zip(weights) {
        *out += (0..N).map(|lane| weights[lane] * value[lane]).sum::<f32>();
    }
}
