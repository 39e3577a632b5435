//! Light at many distances along view rays of one elevation, from one march along all of them.
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
//! tables. L' itself is the radiance of the whole ray, ground included.

use super::field::ground_irradiance;
use super::ray_bundle::{Path, RayBundle, Scratch};
use super::trace::{Arriving, Tracer};
use crate::spectrum::Spectrum;
use crate::transfer::residual::{STREAMS, scattered_into_peaks};
use crate::transfer::shell::{MAX_CONSTITUENTS, PerConstituent};

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

impl<const N: usize> Tracer<'_, N> {
    /// Light from the eye to each of the increasing distances `samples_m`, which are clamped to the end of the rays, along each ray of a
    /// bundle with this start (radius, m, and cosine of the zenith angle), and last the light of the whole ray with its ground:
    /// `[ray][sample]`.
    #[inline(always)]
    pub fn samples_along_rays(
        &self,
        start: (f64, f64),
        bundle: &RayBundle,
        samples_m: &[f64],
    ) -> Vec<Vec<RaySample<N>>> {
        let (air, dimming) = (self.air, self.dimming);
        let marcher = Self::marcher_between_distances(air);
        let field = self.diffuse.map(|diffuse| &diffuse.field);
        let pieces = Path::pieces(
            dimming,
            field.map(|field| &field.grid),
            &marcher,
            start,
            field.map_or(0, |field| field.basis.degree()),
            samples_m,
        );
        let mut scratch = Scratch::default();
        let mut streams = Vec::new();
        let mut multiple = vec![Spectrum::ZERO; bundle.len()];
        // Light from the eye to each sample, and along the whole of each ray: `[sample][ray]`.
        let mut light: Vec<Vec<Arriving<N>>> = Vec::with_capacity(pieces.len());
        for (_, piece) in &pieces {
            piece.accumulate_sunlight::<STREAMS, false>(dimming, &marcher, bundle, &mut streams);
            multiple.fill(Spectrum::ZERO);
            if let Some(field) = field {
                let (scratch, multiple) = (&mut scratch, &mut multiple[..]);
                piece.accumulate_scattered(field, &field.basis, bundle, scratch, multiple, None);
                let irradiance = |mu_sun| ground_irradiance(air, self.diffuse, mu_sun);
                piece.accumulate_ground(air, bundle, irradiance, multiple);
            }
            let mut sums = match light.last() {
                Some(before) => before.clone(),
                None => vec![Arriving::NONE; bundle.len()],
            };
            for (ray, (sum, multiple)) in sums.iter_mut().zip(&multiple).enumerate() {
                sum.multiple_scatter += *multiple;
                for (s, sums) in sum.streams[..dimming.scatterers.len()]
                    .iter_mut()
                    .enumerate()
                {
                    for (k, sum) in sums.iter_mut().enumerate() {
                        *sum += streams[(s * STREAMS + k) * bundle.len() + ray];
                    }
                }
            }
            light.push(sums);
        }
        let whole = &light[samples_m.len()];
        let of_ray = |ray: usize| {
            let columns = pieces[1..].iter().map(|(columns_m, _)| columns_m);
            let samples = columns.zip(&light);
            let samples =
                samples.map(|(columns_m, light)| self.sample(columns_m, &light[ray], &whole[ray]));
            let (columns_m, _) = &pieces[samples_m.len()];
            let all = self.sample(columns_m, &whole[ray], &whole[ray]);
            samples.chain([all]).collect()
        };
        (0..bundle.len()).map(of_ray).collect()
    }

    /// Path radiance `S = P T/T' + (1 - T/T') L'` and optical depth of a sample behind these columns, m.
    #[inline(always)]
    fn sample(
        &self,
        columns_m: &PerConstituent,
        near: &Arriving<N>,
        whole: &Arriving<N>,
    ) -> RaySample<N> {
        let removed = self.dimming.peaks.extinction(columns_m);
        let replaced = scattered_into_peaks(removed);
        let mix = |near: Spectrum<N>, whole: Spectrum<N>, k: usize| {
            near.mul_acc(replaced[k], whole - near)
        };
        let mut streams = [[Spectrum::ZERO; STREAMS]; MAX_CONSTITUENTS];
        for (s, scatterer) in self.air.scatterers.iter().enumerate() {
            streams[s] = std::array::from_fn(|k| {
                mix(near.streams[s][k], whole.streams[s][k], k) * scatterer.whole_scattering
            });
        }
        RaySample {
            depth: self.air.coefficients.extinction(columns_m),
            streams,
            multiple_scatter: mix(near.multiple_scatter, whole.multiple_scatter, 0),
        }
    }
}
