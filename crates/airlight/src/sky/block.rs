//! Solutions for blocks of 4, 8 or 16 wavelengths behind a common interface.

use super::air::{Air, Scatterer};
use super::between_azimuths::BetweenAzimuths;
use super::field::{Diffuse, FieldGrid, ground_irradiance};
use super::orders;
use super::peaked::{Part, Peaked, Scattered};
use super::ray_bundle::{Path, RayBundle, Scratch};
use super::samples_along_rays::RaySample;
use super::settings::{Scattering, SkyError, SkySettings};
use super::trace::Tracer;
use crate::atmosphere::Atmosphere;
use crate::control::{Cancelled, Control};
use crate::math::interpolation::lerp;
use crate::math::parallel;
use crate::math::rings::Ring;
use crate::math::simd::vectorized;
use crate::spectrum::Spectrum;
use crate::transfer::columns::SlantColumns;
use crate::transfer::ray::Ray;
use crate::transfer::residual::{HalfAngle, STREAMS, combined};
use std::f64::consts::PI;
use std::sync::Arc;

/// Light along a view ray at the wavelengths of a block, per unit solar irradiance.
#[derive(Clone, Debug, Default)]
pub struct BlockLight {
    pub transmittance: Vec<f32>,
    pub single: Vec<f32>,
    pub multiple: Vec<f32>,
    pub ground: Vec<f32>,
    pub meets_ground: bool,
}

/// Optical depth and path radiance from the eye to a sample on a view ray, at the wavelengths of a block.
#[derive(Clone, Debug)]
pub struct SampleLight {
    /// Optical depth.
    pub depth: Vec<f32>,
    /// Path radiance per unit solar irradiance: first the smooth light, then that of each part without its share.
    pub path: Vec<Vec<f32>>,
}

/// Weights that sum the lanes of a block into the channels of a table.
#[derive(Clone, Debug)]
pub struct ChannelMatrix {
    /// `weights[channel][lane]`, solar irradiance included.
    pub weights: Vec<Vec<f32>>,
}

/// A solved sky at some of the wavelengths.
pub trait Block: Send + Sync {
    /// Number of wavelengths.
    fn lanes(&self) -> usize;

    /// Estimated relative error of the iteration.
    fn iteration_error(&self) -> f32;

    /// Light along a ray, over at most `limit_m`.
    fn trace(&self, ray: &Ray, limit_m: f64) -> BlockLight;

    /// Q and U of the light along the whole of a ray, in the frame of [`super::polarised`], given the cosine of the azimuth between
    /// the ray and the sun.
    fn linear(&self, ray: &Ray, cos_azimuth: f64) -> [Vec<f32>; 2];

    /// Light from the eye to each of the increasing distances `samples_m`, along each ray of a row, and last the light of the whole ray
    /// with its ground: `[ray][sample]`.
    fn samples_along_rays(
        &self,
        row: &TableRow,
        samples_m: &[f64],
        parts: &[Part],
    ) -> Vec<Vec<SampleLight>>;

    /// Transmittance from a point to space along `mu`; 0 if the ray hits the planet.
    fn transmittance_to_space(&self, radius_m: f64, mu: f64) -> Vec<f32>;

    /// Number of streams of the light that a constituent scatters once.
    fn streams(&self, constituent: usize) -> usize;

    /// Scattering by a constituent at the cosine `nu` of the angle.
    fn scattered(&self, constituent: usize, nu: f64) -> Scattered;

    /// Mean over the azimuth of the light along the rays of a row, which is that of a ring, at even steps.
    fn mean_over_azimuth(&self, row: &TableRow, between: &BetweenAzimuths, ring: &Ring)
    -> Vec<f32>;

    /// Adds the light along each ray of `rows` to `out`. Each ray has `width` values: the smooth light in each channel, then each of
    /// the parts in each channel, divided by the mean phase function.
    ///
    /// # Errors
    /// [`Cancelled`].
    fn fill(
        &self,
        rows: (&[TableRow], &BetweenAzimuths),
        matrix: &ChannelMatrix,
        peaked: &Peaked,
        width: usize,
        out: &mut [f32],
        control: Control<'_>,
    ) -> Result<(), Cancelled>;
}

/// The rays of one table row: one elevation, all azimuths.
pub struct TableRow {
    /// Radius of the eye, m, and cosine of the zenith angle.
    pub start: (f64, f64),
    pub bundle: RayBundle,
}

/// Whether there are blocks of 8 lanes. Web pages do without their code, and fill half of 16 lanes.
const HAS_EIGHT_LANES: bool = !cfg!(target_arch = "wasm32");

/// Solves for all `wavelengths_nm` in blocks.
///
/// # Errors
/// [`SkyError::Cancelled`] soon after cancellation; [`SkyError::NotConverged`].
pub fn solve(
    atmosphere: &Atmosphere,
    columns: &Arc<SlantColumns>,
    wavelengths_nm: &[f64],
    settings: &SkySettings,
    control: Control<'_>,
) -> Result<Vec<Box<dyn Block>>, SkyError> {
    let count = wavelengths_nm.len().div_ceil(16);
    let solved = wavelengths_nm.chunks(16).enumerate().map(|(place, chunk)| {
        let share = BlockProgress {
            control,
            place,
            count,
        };
        match chunk.len() {
            0..=4 if count == 1 => Solved::<4>::boxed(atmosphere, columns, chunk, settings, share),
            0..=8 if HAS_EIGHT_LANES => {
                Solved::<8>::boxed(atmosphere, columns, chunk, settings, share)
            }
            _ => Solved::<16>::boxed(atmosphere, columns, chunk, settings, share),
        }
    });
    solved.collect()
}

/// Reports the progress of one block.
struct BlockProgress<'a> {
    control: Control<'a>,
    place: usize,
    count: usize,
}

impl BlockProgress<'_> {
    /// Reports the fraction of the block that is done, in permille of a block.
    fn report(&self, fraction: f64) {
        let done = 1000 * self.place as u64 + (1000.0 * fraction) as u64;
        self.control.report(done, 1000 * self.count as u64);
    }
}

struct Solved<const N: usize> {
    air: Air<N>,
    diffuse: Option<Diffuse<N>>,
    /// Number of lanes in use; unused lanes repeat the last wavelength.
    lanes: usize,
}

impl<const N: usize> Solved<N> {
    fn boxed(
        atmosphere: &Atmosphere,
        columns: &Arc<SlantColumns>,
        wavelengths_nm: &[f64],
        settings: &SkySettings,
        share: BlockProgress<'_>,
    ) -> Result<Box<dyn Block>, SkyError> {
        let lanes = wavelengths_nm.len();
        let padded = std::array::from_fn(|lane| wavelengths_nm[lane.min(lanes - 1)]);
        let air = Air::<N>::new(
            atmosphere,
            columns.clone(),
            padded,
            settings.orders.peak_degree,
            &settings.suns.air_masses(),
        );
        let mut diffuse = None;
        if settings.scattering == Scattering::All && !air.scatterers.is_empty() {
            let bounds = (air.shell().ground_radius_m, air.shell().top_radius_m);
            let zeniths = settings
                .suns
                .sun_zeniths_deg(settings.sun_spacing, bounds.0, bounds.1);
            let grid = FieldGrid::new(&air, settings.altitudes, &zeniths);
            let eye_zenith = settings.suns.eye_zenith_deg(bounds.0, bounds.1);
            let eye_sun = eye_zenith.map(|zenith| grid.nearest_sun(zenith.to_radians().cos()));
            let report = |fraction| share.report(fraction);
            let polarised =
                settings.polarisation_correction && air.scatterers.iter().any(Scatterer::polarises);
            let orders = &settings.orders;
            let solved = orders::solve(
                &air,
                (grid, eye_sun),
                orders,
                polarised,
                share.control,
                report,
            )?;
            diffuse = Some(solved);
        }
        share.report(1.0);
        Ok(Box::new(Self {
            air,
            diffuse,
            lanes,
        }))
    }

    fn tracer(&self) -> Tracer<'_, N> {
        Tracer::new(&self.air, self.diffuse.as_ref())
    }

    /// The air that attenuates light on its way: see `trace`.
    fn dimming(&self) -> &Air<N> {
        self.diffuse.as_ref().map_or(&self.air, |d| &d.air)
    }

    /// A constituent that scatters, in the air without forward peaks.
    fn scatterer(&self, constituent: usize) -> Option<&Scatterer<N>> {
        let mut scatterers = self.dimming().scatterers.iter();
        scatterers.find(|s| s.constituent == constituent)
    }

    fn used(&self, spectrum: &Spectrum<N>) -> Vec<f32> {
        spectrum.0[..self.lanes].to_vec()
    }
}

impl<const N: usize> Block for Solved<N> {
    fn lanes(&self) -> usize {
        self.lanes
    }

    fn iteration_error(&self) -> f32 {
        self.diffuse.as_ref().map_or(0.0, |diffuse| diffuse.error)
    }

    fn trace(&self, ray: &Ray, limit_m: f64) -> BlockLight {
        let light = self.tracer().trace(ray, limit_m);
        BlockLight {
            transmittance: self.used(&light.transmittance),
            single: self.used(&light.single),
            multiple: self.used(&light.multiple),
            ground: self.used(&light.ground),
            meets_ground: light.meets_ground,
        }
    }

    fn linear(&self, ray: &Ray, cos_azimuth: f64) -> [Vec<f32>; 2] {
        let light = vectorized(
            #[inline(always)]
            || self.tracer().linear(ray, cos_azimuth),
        );
        light.map(|part| self.used(&part))
    }

    fn samples_along_rays(
        &self,
        row: &TableRow,
        samples_m: &[f64],
        parts: &[Part],
    ) -> Vec<Vec<SampleLight>> {
        let samples = vectorized(
            #[inline(always)]
            || {
                self.tracer()
                    .samples_along_rays(row.start, &row.bundle, samples_m)
            },
        );
        let rays = samples.iter().zip(&row.bundle.nu);
        rays.map(|(samples, &nu)| {
            let scatterers = self.dimming().scatterers.iter();
            let phases = scatterers.map(|s| (s.phase(&self.air, nu), s.shares(nu)));
            let phases: Vec<_> = phases.collect();
            let of_sample = |sample: &RaySample<N>| {
                let mut path = vec![Spectrum::ZERO; 1 + parts.len()];
                path[0] = sample.multiple_scatter;
                let scatterers = self.dimming().scatterers.iter();
                for ((s, (phase, shares)), streams) in scatterers.zip(&phases).zip(&sample.streams)
                {
                    let mut peaked = false;
                    for (part, path) in parts.iter().zip(&mut path[1..]) {
                        if part.constituent == s.constituent {
                            *path = streams[part.stream] * *phase;
                            peaked = true;
                        }
                    }
                    if !peaked {
                        path[0] = path[0].mul_acc(combined(streams, shares), *phase);
                    }
                }
                SampleLight {
                    depth: self.used(&sample.depth),
                    path: path.iter().map(|part| self.used(part)).collect(),
                }
            };
            samples.iter().map(of_sample).collect()
        })
        .collect()
    }

    fn transmittance_to_space(&self, radius_m: f64, mu: f64) -> Vec<f32> {
        let shell = self.air.shell();
        let ray = Ray {
            radius_m,
            mu,
            mu_sun: 1.0,
            nu: mu,
        };
        if ray.distance_to_ground(shell.ground_radius_m).is_some() {
            return vec![0.0; self.lanes];
        }
        let Some(segment) = shell.segment(&ray, f64::INFINITY) else {
            return vec![1.0; self.lanes];
        };
        let entry = ray.advanced(segment.start_m);
        self.used(&self.air.transmittance_to_sun(entry.radius_m, entry.mu))
    }

    fn streams(&self, constituent: usize) -> usize {
        let scatterer = self.scatterer(constituent);
        scatterer.map_or(1, Scatterer::streams)
    }

    fn scattered(&self, constituent: usize, nu: f64) -> Scattered {
        let (coefficient, phase, shares) = match self.scatterer(constituent) {
            Some(s) => (s.whole_scattering, s.phase(&self.air, nu), s.shares(nu)),
            None => (Spectrum::ZERO, Spectrum::ZERO, [Spectrum::ZERO; STREAMS]),
        };
        Scattered {
            coefficient: self.used(&coefficient),
            phase: self.used(&phase),
            shares: shares.map(|share| self.used(&share)),
        }
    }

    fn mean_over_azimuth(
        &self,
        row: &TableRow,
        between: &BetweenAzimuths,
        ring: &Ring,
    ) -> Vec<f32> {
        let mean = vectorized(
            #[inline(always)]
            || self.row_mean(row, between, ring),
        );
        self.used(&mean)
    }

    fn fill(
        &self,
        (rows, between): (&[TableRow], &BetweenAzimuths),
        matrix: &ChannelMatrix,
        peaked: &Peaked,
        width: usize,
        out: &mut [f32],
        control: Control<'_>,
    ) -> Result<(), Cancelled> {
        let weights: Vec<Spectrum<N>> = matrix
            .weights
            .iter()
            .map(|row| Spectrum::from_fn(|lane| if lane < self.lanes { row[lane] } else { 0.0 }))
            .collect();
        let stride = width * rows[0].bundle.len();
        parallel::try_for_each_chunk(out, stride, |index, out| {
            control.check()?;
            let row = &rows[index];
            vectorized(
                #[inline(always)]
                || {
                    let light = self.row_light(row, between);
                    for (slot, cell) in out.chunks_exact_mut(width).enumerate() {
                        self.fill_cell(&light, row, slot, &weights, peaked, cell);
                    }
                },
            );
            Ok(())
        })
    }
}

/// Light along the rays of a table row.
struct RowLight<const N: usize> {
    /// Singly scattered sunlight without phase function, `[scatterer][stream][ray]`.
    streams: Vec<Spectrum<N>>,
    /// All other light.
    multiple_scatter: Vec<Spectrum<N>>,
}

impl<const N: usize> RowLight<N> {
    #[inline(always)]
    fn stream(&self, scatterer: usize, stream: usize, ray: usize) -> Spectrum<N> {
        self.streams[(scatterer * STREAMS + stream) * self.multiple_scatter.len() + ray]
    }
}

impl<const N: usize> Solved<N> {
    #[inline(always)]
    fn row_light(&self, row: &TableRow, between: &BetweenAzimuths) -> RowLight<N> {
        let (air, diffuse, rays) = (&self.air, self.diffuse.as_ref(), row.bundle.len());
        let grid = diffuse.map(|d| &d.field.grid);
        let degree = diffuse.map_or(0, |d| d.field.basis.degree());
        let dimming = self.dimming();
        let marcher = Tracer::marcher_along_ray(air);
        let path = Path::new(dimming, grid, &marcher, row.start, degree);
        let (all, few) = (&row.bundle, &row.bundle.evenly_spaced(between.few()));
        // Where the sun lights the whole path, and after the first scattering, light changes slowly with the azimuth.
        let mut streams = Vec::new();
        let is_lit = path.has_sun_above_horizon(all, 0..rays);
        let bundle = if is_lit { few } else { all };
        path.accumulate_sunlight::<STREAMS, false>(dimming, &marcher, bundle, &mut streams);
        if is_lit {
            streams = streams
                .chunks_exact(few.len())
                .flat_map(|light| between.of(light))
                .collect();
        }
        let mut multiple = vec![Spectrum::ZERO; few.len()];
        if let Some(Diffuse { field, .. }) = diffuse {
            let scratch = &mut Scratch::default();
            path.accumulate_scattered(field, &field.basis, few, scratch, &mut multiple, None);
        }
        let irradiance = |mu_sun| ground_irradiance(air, diffuse, mu_sun);
        path.accumulate_ground(air, few, irradiance, &mut multiple);
        let mut light = RowLight {
            streams,
            multiple_scatter: between.of(&multiple).collect(),
        };
        for (s, sums) in air
            .scatterers
            .iter()
            .zip(light.streams.chunks_exact_mut(STREAMS * rays))
        {
            for sum in sums {
                *sum *= s.whole_scattering;
            }
        }
        light
    }

    /// Mean of the light of a row over the azimuth.
    #[inline(always)]
    fn row_mean(&self, row: &TableRow, between: &BetweenAzimuths, ring: &Ring) -> Spectrum<N> {
        let light = self.row_light(row, between);
        let nus = &row.bundle.nu;
        let last = nus.len() - 1;
        let steps = ring.steps(last);
        let parts = steps / last;
        // The cosine of the angle to the sun is linear in that of the azimuth.
        let (middle, range) = (0.5 * (nus[0] + nus[last]), 0.5 * (nus[0] - nus[last]));
        let mut sum = Spectrum::ZERO;
        for step in 0..=steps {
            let (before, part) = (step / parts, step % parts);
            let (after, fraction) = ((before + 1).min(last), part as f32 / parts as f32);
            let nu = middle + range * (PI * step as f64 / steps as f64).cos();
            let multiple = &light.multiple_scatter;
            let mut all = lerp(multiple[before], multiple[after], fraction);
            for (place, s) in self.dimming().scatterers.iter().enumerate() {
                let streams = std::array::from_fn(
                    #[inline(always)]
                    |k| {
                        let ends = [before, after].map(|ray| light.stream(place, k, ray));
                        lerp(ends[0], ends[1], fraction)
                    },
                );
                let phase = s.phase(&self.air, nu);
                all = all.mul_acc(combined(&streams, &s.shares(nu)), phase);
            }
            let weight = if step == 0 || step == steps { 0.5 } else { 1.0 };
            sum = sum.scale_acc(all, weight / steps as f32);
        }
        sum
    }

    #[inline(always)]
    fn fill_cell(
        &self,
        light: &RowLight<N>,
        row: &TableRow,
        slot: usize,
        weights: &[Spectrum<N>],
        peaked: &Peaked,
        cell: &mut [f32],
    ) {
        let nu = row.bundle.nu[slot];
        let mut smooth = light.multiple_scatter[slot];
        for (place, s) in self.dimming().scatterers.iter().enumerate() {
            let phase = s.phase(&self.air, nu);
            let mut is_peaked = false;
            for (index, part) in peaked.parts.iter().enumerate() {
                if part.constituent != s.constituent {
                    continue;
                }
                is_peaked = true;
                let phases = peaked.phases(HalfAngle::of_cosine(nu));
                let out = &mut cell[(1 + index) * peaked.width..];
                let value = light.stream(place, part.stream, slot) * phase;
                for (channel, (out, weights)) in out.iter_mut().zip(weights).enumerate() {
                    let mean = phases.get(part.peaked, channel);
                    *out += sum_of_lanes(weights, &value) / mean;
                }
            }
            if !is_peaked {
                let streams = std::array::from_fn(|k| light.stream(place, k, slot));
                smooth = smooth.mul_acc(combined(&streams, &s.shares(nu)), phase);
            }
        }
        for (out, weights) in cell.iter_mut().zip(weights) {
            *out += sum_of_lanes(weights, &smooth);
        }
    }
}

#[inline(always)]
fn sum_of_lanes<const N: usize>(weights: &Spectrum<N>, values: &Spectrum<N>) -> f32 {
    (0..N).map(|lane| weights[lane] * values[lane]).sum()
}
